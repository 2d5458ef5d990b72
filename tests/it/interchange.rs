//! Plain data through serde, and fields through ndarray.

use ndarray::{Array2, s};
use rc_core::{Elasticity, Field, Grid, PeriodicCell, Units};
use rc_fractal::{Amplitudes, SpectrumParams, Truncation};
use serde::Serialize;
use serde::de::DeserializeOwned;

fn there_and_back<T: Serialize + DeserializeOwned + PartialEq + std::fmt::Debug>(value: &T) -> String {
    let text = serde_json::to_string(value).expect("plain data");
    assert_eq!(&serde_json::from_str::<T>(&text).expect("what was written"), value, "{text}");
    text
}

#[test]
fn plain_data_is_read_as_it_is_written() {
    let cell = PeriodicCell::rectangle(0.01, 0.005).expect("a cell");
    let solid = Elasticity::from_young_poisson(210e9, 0.3).expect("steel");
    there_and_back(&Units::new(cell, solid));
    let grid = there_and_back(&Grid::in_cell(8, 4, 0.5).expect("a grid"));
    assert_eq!(grid, r#"{"nx":8,"ny":4,"cell_ratio":0.5}"#);
    let spectrum = SpectrumParams {
        truncation: Truncation::Square,
        amplitudes: Amplitudes::Random,
        ..SpectrumParams::paper(64, 1)
    };
    let text = there_and_back(&spectrum);
    assert!(text.contains(r#""truncation":"square","amplitudes":"random""#), "{text}");
}

/// What a constructor refuses cannot be read either.
#[test]
fn plain_data_is_checked_when_it_is_read() {
    assert_eq!(serde_json::from_str::<Grid>(r#"{"nx":3,"ny":3}"#).ok(), Grid::square(3).ok());
    assert!(serde_json::from_str::<Grid>(r#"{"nx":0,"ny":3}"#).is_err());
    assert!(serde_json::from_str::<PeriodicCell>(r#"{"side":-1.0}"#).is_err());
    assert!(serde_json::from_str::<Elasticity>(r#"{"e_star":0.0}"#).is_err());
}

#[test]
fn a_field_becomes_an_array_and_a_field_again_without_a_copy() {
    let grid = Grid::in_cell(5, 3, 0.5).expect("a grid");
    let field = Field::from_fn(grid, |at| at.x + 10.0 * at.y);
    let place = field.values().as_ptr();
    assert_eq!(field.as_array()[[2, 4]], field.at(4, 2), "row, then column");
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
