//! Checks of the invariants of a mesh.

use super::key::{Key, MAX_LEVEL};
use super::mesh::Mesh;

impl Mesh {
    /// Checks every invariant, for tests.
    ///
    /// - Squares are inside the cell and aligned.
    /// - They are strictly sorted and do not overlap.
    /// - Their total area is at most the area of the cell.
    /// - They are 2:1 balanced at edges and corners, also across the periodic seam.
    ///
    /// *Cost*: about 10 binary searches for each element.
    ///
    /// # Panics
    /// When an invariant does not hold. The message says which one and where.
    pub fn assert_well_formed(&self) {
        self.assert_squares();
        for &key in self.keys() {
            self.assert_balanced(key);
        }
    }

    fn assert_squares(&self) {
        for &key in self.keys() {
            assert!(key.level() <= MAX_LEVEL, "{key:?} is too deep");
            let per_side = (self.base() as u64) << key.level();
            let (ix, iy) = (u64::from(key.ix()), u64::from(key.iy()));
            assert!(ix < per_side && iy < per_side, "{key:?} is outside the cell of {per_side} squares per side");
            assert_eq!(Key::new(key.level(), key.ix(), key.iy()), key, "{key:?} is not aligned to its size");
        }
        for pair in self.keys().windows(2) {
            assert!(pair[0].end() <= pair[1].start(), "{:?} and {:?} overlap or are not in order", pair[0], pair[1]);
        }
        assert!(self.area() <= 1.0, "the elements cover {} cells", self.area());
    }

    fn assert_balanced(&self, key: Key) {
        for block in touching_blocks(self.base(), key) {
            let Some(other) = self.find(block).map(|j| self.keys()[j]) else { continue };
            assert!(other.level() + 1 >= key.level(), "{key:?} touches {other:?}: not 2:1 balanced");
        }
    }

    /// Index of the element that is the square `block` or contains it.
    pub(super) fn find(&self, block: Key) -> Option<usize> {
        let index = self.keys().partition_point(|key| key.start() <= block.start()).checked_sub(1)?;
        (block.end() <= self.keys()[index].end()).then_some(index)
    }

    /// Ratio of the area of all elements to the area of the cell.
    ///
    /// It is exact up to the rounding of one division.
    pub(super) fn area(&self) -> f64 {
        let cell = (self.base() as u64).pow(2) << (2 * MAX_LEVEL);
        self.keys().iter().map(|key| key.span()).sum::<u64>() as f64 / cell as f64
    }
}

/// The eight squares of the same size that touch `key`, also at corners.
///
/// They continue around the periodic cell.
fn touching_blocks(base: usize, key: Key) -> impl Iterator<Item = Key> {
    let steps = [(-1, -1), (0, -1), (1, -1), (-1, 0), (1, 0), (-1, 1), (0, 1), (1, 1)];
    steps.into_iter().map(move |(dx, dy)| step(base, key, dx, dy))
}

/// The square of the same size, `dx` columns and `dy` rows away.
///
/// It continues around the periodic cell of `base` root squares.
fn step(base: usize, key: Key, dx: i64, dy: i64) -> Key {
    let per_side = (base as i64) << key.level();
    let [ix, iy] = [i64::from(key.ix()) + dx, i64::from(key.iy()) + dy].map(|i| i.rem_euclid(per_side) as u32);
    Key::new(key.level(), ix, iy)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Message of `assert_well_formed` for an invalid mesh.
    fn complaint(mesh: &Mesh) -> String {
        let panic = std::panic::catch_unwind(|| mesh.assert_well_formed()).expect_err("the mesh is ill-formed");
        panic.downcast_ref::<String>().cloned().unwrap_or_default()
    }

    #[test]
    fn unbalanced_corner_across_the_seam_is_found() {
        // The lower left root touches the upper right root only at a corner, across the periodic border.
        let keys = vec![Key::new(0, 0, 0), Key::new(2, 11, 11)];
        let complaint = complaint(&Mesh::from_sorted(3, keys));
        assert!(complaint.contains("not 2:1 balanced"), "{complaint}");
    }

    #[test]
    fn overlap_is_found() {
        let complaint = complaint(&Mesh::from_sorted(1, vec![Key::new(1, 0, 0), Key::new(2, 1, 1)]));
        assert!(complaint.contains("overlap"), "{complaint}");
    }

    #[test]
    fn square_outside_the_cell_is_found() {
        let complaint = complaint(&Mesh::from_sorted(3, vec![Key::new(1, 6, 0)]));
        assert!(complaint.contains("outside the cell"), "{complaint}");
    }

    #[test]
    fn steps_wrap_around_a_cell_of_three_roots() {
        assert_eq!(step(3, Key::new(1, 0, 5), -1, 1), Key::new(1, 5, 0));
    }
}
