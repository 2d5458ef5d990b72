//! Contact sets for the tests, and brute-force inspection of a mask.

use rc_core::{DVec2, Grid};

use crate::paper::{Mask, Mesh, MeshParams};

/// A disc with centre (x, y) and radius in λ.
pub(super) type Disc = (f64, f64, f64);

/// Distance of the nearest images of two coordinates.
fn apart(a: f64, b: f64) -> f64 {
    let d = (a - b).rem_euclid(1.0);
    d.min(1.0 - d)
}

/// A mask with contact in any of the `spots` except in the `holes`.
///
/// Discs continue around the periodic cell.
pub(super) fn discs(side: usize, spots: &[Disc], holes: &[Disc]) -> Mask {
    let inside = |x: f64, y: f64, &(cx, cy, r): &Disc| apart(x, cx).hypot(apart(y, cy)) < r;
    let contact = |x: f64, y: f64| spots.iter().any(|d| inside(x, y, d)) && !holes.iter().any(|d| inside(x, y, d));
    let grid = Grid::square(side).expect("a side of a test is small");
    let centres = (0..grid.len()).map(|i| grid.centre(i % side, i / side));
    Mask::new(side, centres.map(|DVec2 { x, y }| contact(x, y)).collect()).expect("a value for each cell")
}

/// Value of the mask at a cell of the periodically continued plane.
pub(super) fn at(mask: &Mask, ix: i64, iy: i64) -> bool {
    let side = mask.side() as i64;
    mask.cells()[(iy.rem_euclid(side) * side + ix.rem_euclid(side)) as usize]
}

/// Cells of a grid that the mesh covers, row-major.
///
/// The grid has `side` cells per side. Each element is painted separately.
pub(super) fn painted(mesh: &Mesh, side: usize) -> Vec<bool> {
    let mut cells = vec![false; side * side];
    for key in mesh.keys() {
        let size = side / (mesh.base() << key.level());
        assert!(size > 0, "{key:?} is smaller than a cell of {side}");
        for iy in 0..size {
            for ix in 0..size {
                let cell = &mut cells[(key.iy() as usize * size + iy) * side + key.ix() as usize * size + ix];
                assert!(!*cell, "{key:?} overlaps another element");
                *cell = true;
            }
        }
    }
    cells
}

/// Cells within `reach` rows and columns of contact.
pub(super) fn with_halo(mask: &Mask, reach: i64) -> Vec<bool> {
    let side = mask.side() as i64;
    let near = |ix: i64, iy: i64| (-reach..=reach).any(|dy| (-reach..=reach).any(|dx| at(mask, ix + dx, iy + dy)));
    (0..side * side).map(|i| near(i % side, i / side)).collect()
}

/// The default parameters with the smallest base for a grid of `side` cells per side.
///
/// This base is the odd part of `side`.
pub(super) fn params_for(side: usize) -> MeshParams {
    MeshParams { base: side >> side.trailing_zeros(), ..MeshParams::default() }
}

impl Mesh {
    /// Total load Σ p·side² of a pressure per element, in units of E*·λ².
    ///
    /// It is summed in Morton order.
    pub(super) fn load(&self, pressure: &[f64]) -> f64 {
        assert_eq!(pressure.len(), self.len(), "one pressure for each element");
        self.elements().zip(pressure).map(|(element, p)| p * element.area()).sum()
    }
}
