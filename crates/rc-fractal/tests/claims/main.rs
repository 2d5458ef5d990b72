//! Tests of the claims of `rc-fractal`, from outside.

mod ends;
mod moments;
mod parameters;
mod profile;
mod sampling;
mod spectrum;
mod table;
mod twin;
mod waves;

use rc_fractal::{SpectrumParams, Surface};

/// The surface of valid parameters.
fn surface(params: SpectrumParams) -> Surface {
    Surface::new(&params).expect("valid parameters")
}

/// Fails unless the relative error of `value` against `reference` is within `tolerance`.
fn assert_close(what: &str, value: f64, reference: f64, tolerance: f64) {
    let error = ((value - reference) / reference).abs();
    assert!(
        error <= tolerance,
        "{what}: {value:e}, reference {reference:e}, relative error {error:.2e} > {tolerance:e}"
    );
}
