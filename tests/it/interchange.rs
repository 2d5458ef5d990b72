//! Plain data that serde writes and reads.

use rc_core::{Elasticity, Grid, PeriodicCell, Units};
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

/// Data that a constructor refuses cannot be read either.
#[test]
fn plain_data_is_checked_when_it_is_read() {
    assert_eq!(serde_json::from_str::<Grid>(r#"{"nx":3,"ny":3}"#).ok(), Grid::square(3).ok());
    assert!(serde_json::from_str::<Grid>(r#"{"nx":0,"ny":3}"#).is_err());
    assert!(serde_json::from_str::<PeriodicCell>(r#"{"side":-1.0}"#).is_err());
    assert!(serde_json::from_str::<Elasticity>(r#"{"e_star":0.0}"#).is_err());
}
