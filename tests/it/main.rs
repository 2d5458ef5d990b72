//! Tests that cross crates, in one binary.
//!
//! They cover exact solutions, independent programs, the paper's statistics, and swapped crates.

mod adaptive;
mod bisinusoidal;
mod conductance;
mod contact_area;
mod contact_spots;
mod error_bars;
mod examples;
mod free;
mod free_adaptive;
mod front_door;
mod full_contact;
mod fuzz;
mod gauss_seidel;
mod hardness;
mod hertz;
mod inequalities;
mod interchange;
mod layer;
mod leakage;
mod line;
mod penetration;
mod perimeter;
mod pits;
mod ranks;
mod reference;
mod rough;
mod shear;
mod sliding;
mod stress_distribution;
mod suspicions;
mod swap;
mod sweep;
mod westergaard;

use std::path::{Path, PathBuf};

use rc_core::{Field, Kernel, Silent};
use rc_solver::{ContactProblem, Control, Method, Solution, SolveParams};

/// Path of a file in the repository's `data/`.
fn data_path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../data").join(name)
}

/// The solution on the uniform grid to `tolerance`.
///
/// Fails the test if there is no solution.
fn solved(heights: &Field, kernel: &dyn Kernel, control: Control, tolerance: f64) -> Solution<'static> {
    let params = SolveParams::to_tolerance(tolerance).by(Method::Uniform);
    let solution = ContactProblem::new(heights, control).with_kernel(kernel).solve(&params, &Silent);
    solution.unwrap_or_else(|error| panic!("{control:?}: {error}")).into_owned()
}

/// Fails unless `value` equals `reference` within a relative difference of `relative`.
#[track_caller]
fn assert_close(what: &str, value: f64, reference: f64, relative: f64) {
    let error = (value / reference - 1.0).abs();
    assert!(
        error <= relative,
        "{what}: {value:e}, reference {reference:e}, off by {error:.1e} (allowed {relative:.1e})"
    );
}
