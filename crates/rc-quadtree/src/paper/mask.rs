//! The contact set on the finest uniform grid.

use rc_core::{Field, Grid};

use super::error::{MeshError, check_length};

/// The cells of a uniform grid of `side` × `side` cells that are in contact.
///
/// They are row-major, with one byte for each cell.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mask {
    side: usize,
    cells: Vec<bool>,
}

impl Mask {
    /// A mask from its cells, `cells[iy * side + ix]`.
    ///
    /// # Errors
    /// - [`MeshError::Grid`] when `side` is 0 or above [`Grid::MAX_SIDE`].
    /// - [`MeshError::Length`] when there are not `side · side` cells.
    pub fn new(side: usize, cells: Vec<bool>) -> Result<Self, MeshError> {
        check_length(Grid::square(side)?.len(), cells.len())?;
        Ok(Self { side, cells })
    }

    /// The cells where a field (a pressure) is positive. NaN is not positive.
    ///
    /// # Errors
    /// [`MeshError::NotSquare`] when the cells of the field are rectangles.
    pub fn positive(field: &Field) -> Result<Self, MeshError> {
        let grid = field.grid();
        if !grid.is_square() {
            return Err(MeshError::NotSquare { grid });
        }
        Ok(Self { side: grid.nx(), cells: field.values().iter().map(|&v| v > 0.0).collect() })
    }

    /// Number of cells per side.
    #[must_use]
    pub fn side(&self) -> usize {
        self.side
    }

    /// The cells, row-major.
    #[must_use]
    pub fn cells(&self) -> &[bool] {
        &self.cells
    }

    /// Number of cells in contact.
    #[must_use]
    pub fn count(&self) -> usize {
        self.cells.iter().filter(|&&c| c).count()
    }

    /// The cells within `reach` rows and columns of contact, around the periodic cell.
    pub(super) fn widened(&self, reach: usize) -> Vec<bool> {
        if reach == 0 {
            return self.cells.clone();
        }
        let free: Vec<bool> = self.cells.iter().map(|&c| !c).collect();
        eroded(&free, self.side, reach).into_iter().map(|far| !far).collect()
    }
}

/// The cells for which all cells within `ring` rows and columns are set.
///
/// The window continues around the periodic cell. It is the product of a window along x and a window along y. Each is a
/// running count of unset cells, so the cost does not depend on `ring`.
pub(super) fn eroded(cells: &[bool], side: usize, ring: usize) -> Vec<bool> {
    // A window that extends by half the side in each direction covers everything.
    let ring = ring.min(side / 2);
    let mut along_x = vec![false; cells.len()];
    let mut padded = vec![false; side + 2 * ring];
    for (row, out) in cells.chunks_exact(side).zip(along_x.chunks_exact_mut(side)) {
        padded[..ring].copy_from_slice(&row[side - ring..]);
        padded[ring..ring + side].copy_from_slice(row);
        padded[ring + side..].copy_from_slice(&row[..ring]);
        erode_row(&padded, ring, out);
    }

    let row_of = |iy: usize| &along_x[(iy % side) * side..][..side];
    let mut unset = vec![0_u32; side];
    for iy in 0..2 * ring {
        unset.iter_mut().zip(row_of(iy + side - ring)).for_each(|(u, &c)| *u += u32::from(!c));
    }
    let mut result = vec![false; cells.len()];
    for (iy, out) in result.chunks_exact_mut(side).enumerate() {
        let (entering, leaving) = (row_of(iy + ring), row_of(iy + side - ring));
        for (((o, u), &e), &l) in out.iter_mut().zip(&mut unset).zip(entering).zip(leaving) {
            *u += u32::from(!e);
            *o = *u == 0;
            *u -= u32::from(!l);
        }
    }
    result
}

/// Sets `out[i]` if cells i to i + 2·ring of the padded row are set.
fn erode_row(padded: &[bool], ring: usize, out: &mut [bool]) {
    let mut unset: u32 = padded[..2 * ring].iter().map(|&c| u32::from(!c)).sum();
    for ((o, &entering), &leaving) in out.iter_mut().zip(&padded[2 * ring..]).zip(padded) {
        unset += u32::from(!entering);
        *o = unset == 0;
        unset -= u32::from(!leaving);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A pseudo-random pattern of mostly set cells, from the bits of a multiplicative hash.
    fn pattern(side: usize) -> Vec<bool> {
        (0..side * side).map(|i| !(i as u32).wrapping_mul(2654435761).rotate_left(9).is_multiple_of(23)).collect()
    }

    #[test]
    fn erosion_matches_the_window_cell_by_cell() {
        for (side, ring) in [(1, 3), (2, 1), (3, 1), (12, 2), (13, 6), (10, 40)] {
            let cells = pattern(side);
            let fast = eroded(&cells, side, ring);
            let reach = ring as i64;
            let wrap = |i: i64| i.rem_euclid(side as i64) as usize;
            for (i, &cell) in fast.iter().enumerate() {
                let (ix, iy) = ((i % side) as i64, (i / side) as i64);
                let slow =
                    (-reach..=reach).all(|dy| (-reach..=reach).all(|dx| cells[wrap(iy + dy) * side + wrap(ix + dx)]));
                assert_eq!(cell, slow, "side {side}, ring {ring}, cell ({ix}, {iy})");
            }
        }
    }

    #[test]
    fn widening_one_cell_gives_a_square_across_the_seam() {
        let mask = Mask::new(8, (0..64).map(|i| i == 0).collect()).expect("8 is a side");
        let wide = mask.widened(2);
        assert_eq!(wide.iter().filter(|&&c| c).count(), 25);
        assert!(wide[7 * 8 + 6], "cell (6, 7) is within two of (0, 0) across the corner");
    }

    #[test]
    fn wrong_masks_are_typed_errors() {
        assert!(matches!(Mask::new(0, vec![]), Err(MeshError::Grid(_))));
        assert_eq!(Mask::new(2, vec![true; 3]), Err(MeshError::Length { expected: 4, actual: 3 }));
        let grid = Grid::new(2, 3).expect("a grid");
        assert_eq!(Mask::positive(&Field::zeros(grid)), Err(MeshError::NotSquare { grid }));
    }
}
