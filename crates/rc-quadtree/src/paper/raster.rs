//! Conversion of values per element to a field on a uniform grid.

use rc_core::{Field, Grid};

use super::error::{MeshError, check_length, depth_of};
use super::key::Key;
use super::mesh::Mesh;

impl Mesh {
    /// The field of values per element on a uniform grid, 0 where there is no element.
    ///
    /// The value of a grid cell is the mean over its area. So the mean of the field is the load Σ value·area, up to
    /// rounding.
    ///
    /// # Errors
    /// - [`MeshError::Length`] when there is not one value for each element.
    /// - [`MeshError::NotSquare`] when the elements of the grid are rectangles.
    /// - [`MeshError::Side`] when the grid does not have `base · 2^k` cells per side.
    pub fn to_field(&self, values: &[f64], grid: Grid) -> Result<Field, MeshError> {
        check_length(self.len(), values.len())?;
        if !grid.is_square() {
            return Err(MeshError::NotSquare { grid });
        }
        let depth = depth_of(grid.nx(), self.base())?;
        let mut field = Field::zeros(grid);
        for (&key, value) in self.keys().iter().zip(values) {
            let cells = CoveredCells::of(key, depth);
            for iy in cells.iy..cells.iy + cells.side {
                let start = grid.index(cells.ix, iy);
                let row = &mut field.values_mut()[start..start + cells.side];
                for cell in row {
                    *cell += value * cells.part_of_cell;
                }
            }
        }
        Ok(field)
    }
}

/// The cells of a uniform grid that an element covers, or the one cell that contains it.
struct CoveredCells {
    ix: usize,
    iy: usize,
    side: usize,
    /// Area of the element within a cell, relative to the area of the cell.
    part_of_cell: f64,
}

impl CoveredCells {
    /// The cells of element `key` on the grid of the squares of level `depth`.
    fn of(key: Key, depth: u32) -> Self {
        let (ix, iy) = (key.ix() as usize, key.iy() as usize);
        if key.level() <= depth {
            let finer = depth - key.level();
            Self { ix: ix << finer, iy: iy << finer, side: 1 << finer, part_of_cell: 1.0 }
        } else {
            let coarser = key.level() - depth;
            // The ratio is a power of two, so it is exact.
            let part_of_cell = 1.0 / (1_u64 << (2 * coarser)) as f64;
            Self { ix: ix >> coarser, iy: iy >> coarser, side: 1, part_of_cell }
        }
    }
}
