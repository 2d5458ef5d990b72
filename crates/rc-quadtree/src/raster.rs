//! From values per element to a field on a uniform grid, and back.

use rc_core::{Field, Grid};

use crate::{
    Key, Mesh, MeshError,
    error::{check_length, depth_of},
};

impl Mesh {
    /// Mean of a field over each element; elements smaller than a cell get the value of the cell.
    ///
    /// # Errors
    /// [`MeshError::NotSquare`]; [`MeshError::Side`] when the field has not `base · 2^k` cells per side.
    pub fn from_field(&self, field: &Field) -> Result<Vec<f64>, MeshError> {
        let depth = self.depth_of_grid(field.grid())?;
        let mean = |key: &Key| {
            let cells = Cells::of(*key, depth);
            let rows = (cells.iy..cells.iy + cells.side).map(|iy| &field.row(iy)[cells.ix..cells.ix + cells.side]);
            rows.map(|row| row.iter().sum::<f64>()).sum::<f64>() / (cells.side * cells.side) as f64
        };
        Ok(self.keys().iter().map(mean).collect())
    }

    /// The field of values per element on a uniform grid, 0 outside: each cell is the mean over its area, so the mean
    /// of the field is the load of the values (see [`Mesh::load`]) to rounding.
    ///
    /// # Errors [`MeshError::Length`] when there is not one value an element; [`MeshError::NotSquare`];
    /// [`MeshError::Side`] when the grid has not `base · 2^k` cells per side.
    pub fn to_field(&self, values: &[f64], grid: Grid) -> Result<Field, MeshError> {
        check_length(self.len(), values.len())?;
        let depth = self.depth_of_grid(grid)?;
        let mut field = Field::zeros(grid);
        for (&key, value) in self.keys().iter().zip(values) {
            let cells = Cells::of(key, depth);
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

    fn depth_of_grid(&self, grid: Grid) -> Result<u32, MeshError> {
        if grid.is_square() { depth_of(grid.nx(), self.base()) } else { Err(MeshError::NotSquare { grid }) }
    }
}

/// The cells of a uniform grid that an element covers, or the one cell that it is a part of.
struct Cells {
    ix: usize,
    iy: usize,
    side: usize,
    /// Area of the element within a cell over the area of the cell.
    part_of_cell: f64,
}

impl Cells {
    /// The cells of element `key` on the grid of the squares of level `depth`.
    fn of(key: Key, depth: u32) -> Self {
        let (ix, iy) = (key.ix() as usize, key.iy() as usize);
        if key.level() <= depth {
            let finer = depth - key.level();
            Self { ix: ix << finer, iy: iy << finer, side: 1 << finer, part_of_cell: 1.0 }
        } else {
            let coarser = key.level() - depth;
            // A power of two: exact.
            let part_of_cell = 1.0 / (1_u64 << (2 * coarser)) as f64;
            Self { ix: ix >> coarser, iy: iy >> coarser, side: 1, part_of_cell }
        }
    }
}
