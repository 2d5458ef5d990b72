//! Fields as arrays of `ndarray`, and back (feature `ndarray`).

use ndarray::{Array2, ArrayView2};

use crate::{Field, Grid, GridError};

impl Field {
    /// A field from an array of shape (ny, nx), row iy and column ix, on a cell whose side along y is `cell_ratio` times that along x.
    ///
    /// Nothing is copied where the array is contiguous, row by row.
    ///
    /// # Errors
    /// As [`Grid::in_cell`].
    pub fn from_array(array: Array2<f64>, cell_ratio: f64) -> Result<Self, GridError> {
        let (ny, nx) = array.dim();
        let grid = Grid::in_cell(nx, ny, cell_ratio)?;
        let array = if array.is_standard_layout() { array } else { array.as_standard_layout().into_owned() };
        let (mut values, offset) = array.into_raw_vec_and_offset();
        // The array may be a part of what it owns.
        values.drain(..offset.unwrap_or(0));
        values.truncate(grid.len());
        Ok(Self::new(grid, values).expect("an array has as many values as its grid"))
    }

    /// The values as an array of shape (ny, nx), without a copy.
    #[must_use]
    pub fn into_array(self) -> Array2<f64> {
        let shape = (self.grid().ny(), self.grid().nx());
        Array2::from_shape_vec(shape, self.into_values()).expect("a field has as many values as its grid")
    }

    /// The values as a view of shape (ny, nx).
    #[must_use]
    pub fn as_array(&self) -> ArrayView2<'_, f64> {
        let shape = (self.grid().ny(), self.grid().nx());
        ArrayView2::from_shape(shape, self.values()).expect("a field has as many values as its grid")
    }
}

impl From<Field> for Array2<f64> {
    fn from(field: Field) -> Self {
        field.into_array()
    }
}

/// On a square cell.
impl TryFrom<Array2<f64>> for Field {
    type Error = GridError;

    fn try_from(array: Array2<f64>) -> Result<Self, GridError> {
        Self::from_array(array, 1.0)
    }
}
