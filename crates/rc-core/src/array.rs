//! Fields as arrays of `ndarray`, and back (feature `ndarray`).

use ndarray::{Array2, ArrayView2};

use crate::{Field, Grid, GridError};

impl Field {
    /// Converts an array of shape (ny, nx) to a field. Index (iy, ix) is row iy and column ix.
    ///
    /// The side of the cell along y is `cell_ratio` times the side along x. Nothing is copied when the array is
    /// contiguous and row-major.
    ///
    /// # Errors
    /// Those of [`Grid::in_cell`].
    #[expect(clippy::missing_panics_doc, reason = "an array has as many values as its grid")]
    pub fn from_array(array: Array2<f64>, cell_ratio: f64) -> Result<Self, GridError> {
        let (ny, nx) = array.dim();
        let grid = Grid::in_cell(nx, ny, cell_ratio)?;
        let array = if array.is_standard_layout() { array } else { array.as_standard_layout().into_owned() };
        let (mut values, offset) = array.into_raw_vec_and_offset();
        // The array may be a part of the vector that it owns.
        values.drain(..offset.unwrap_or(0));
        values.truncate(grid.len());
        Ok(Self::new(grid, values).expect("an array has as many values as its grid"))
    }

    /// The values as an array of shape (ny, nx), without a copy.
    #[must_use]
    #[expect(clippy::missing_panics_doc, reason = "a field has as many values as its grid")]
    pub fn into_array(self) -> Array2<f64> {
        let shape = (self.grid().ny(), self.grid().nx());
        Array2::from_shape_vec(shape, self.into_values()).expect("a field has as many values as its grid")
    }

    /// The values as a view of shape (ny, nx).
    #[must_use]
    #[expect(clippy::missing_panics_doc, reason = "a field has as many values as its grid")]
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

/// Converts an array of shape (ny, nx) to a field on the square cell.
impl TryFrom<Array2<f64>> for Field {
    type Error = GridError;

    fn try_from(array: Array2<f64>) -> Result<Self, GridError> {
        Self::from_array(array, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use ndarray::s;

    use super::*;

    #[test]
    fn a_field_becomes_an_array_and_a_field_again_without_a_copy() {
        let grid = Grid::in_cell(5, 3, 0.5).expect("a grid");
        let field = Field::from_fn(grid, |at| at.x + 10.0 * at.y);
        let place = field.values().as_ptr();
        assert_eq!(field.as_array()[[2, 4]].to_bits(), field.at(4, 2).to_bits(), "row, then column");
        let array = Array2::from(field.clone());
        assert_eq!(array.dim(), (3, 5));
        assert_eq!(Field::from_array(array, 0.5).as_ref(), Ok(&field));
        let moved = Field::from_array(field.into_array(), 0.5).expect("a grid");
        assert_eq!(moved.values().as_ptr(), place, "nothing is copied");
    }

    #[test]
    fn arrays_of_any_layout_become_fields() {
        let array = Array2::from_shape_fn((4, 6), |(iy, ix)| (10 * iy + ix) as f64);
        let transposed = Field::try_from(array.clone().reversed_axes()).expect("a grid");
        assert_eq!((transposed.grid().nx(), transposed.at(3, 5)), (4, 35.0));
        let part = Field::try_from(array.slice_move(s![1..3, ..])).expect("a grid");
        assert_eq!((part.grid().ny(), part.values()[0], part.values().len()), (2, 10.0, 12));
        assert!(Field::try_from(Array2::zeros((0, 4))).is_err());
    }
}
