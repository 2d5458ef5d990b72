//! The claims of `rc-fractal`, checked from outside.

mod moments;
mod parameters;
mod sampling;
mod spectrum;
mod waves;

use rc_fractal::{SpectrumParams, Surface};

/// The surface of valid parameters.
fn surface(params: SpectrumParams) -> Surface {
    Surface::new(&params).expect("valid parameters")
}

/// Fails unless `value` is within `tolerance` of `reference`, relative.
fn assert_close(what: &str, value: f64, reference: f64, tolerance: f64) {
    let error = ((value - reference) / reference).abs();
    assert!(
        error <= tolerance,
        "{what}: {value:e}, reference {reference:e}, relative error {error:.2e} > {tolerance:e}"
    );
}
