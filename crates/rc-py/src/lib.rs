//! The extension module `roughcontact._core`: conversions between Python and the libraries.
//!
//! Users call the package in `python/roughcontact`, which has the documentation. A call takes the keys of a scene and
//! perhaps heights (`scene`). It solves without the lock of the interpreter (`running`) and returns a `Solved`. The
//! arrays of a `Solved` are made when they are asked for.

#![expect(clippy::needless_pass_by_value, reason = "Python hands arguments in by value")]

use pyo3::prelude::*;

mod arrays;
mod errors;
mod fields;
mod kernel;
mod maps;
mod pools;
mod running;
mod scene;
mod solve;
mod solved;
mod study;
mod sweep;

/// Runs the command `rc` with these arguments and returns its exit code.
///
/// The first argument is the name of the program.
#[pyfunction]
fn main(py: Python<'_>, words: Vec<String>) -> u8 {
    py.detach(|| rc_cli::main_with(words.into_iter().map(Into::into)))
}

/// The extension module.
#[pymodule]
fn _core(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<solved::Solved>()?;
    module.add_class::<solved::Unfinished>()?;
    module.add_function(wrap_pyfunction!(main, module)?)?;
    module.add_function(wrap_pyfunction!(scene::known_keys, module)?)?;
    module.add_function(wrap_pyfunction!(scene::loads, module)?)?;
    module.add_function(wrap_pyfunction!(scene::seeds, module)?)?;
    module.add_function(wrap_pyfunction!(solve::solve, module)?)?;
    module.add_class::<sweep::Planned>()?;
    module.add_function(wrap_pyfunction!(sweep::plan_sweep, module)?)?;
    module.add_function(wrap_pyfunction!(study::study, module)?)?;
    module.add_function(wrap_pyfunction!(arrays::points, module)?)?;
    module.add_function(wrap_pyfunction!(arrays::metres, module)?)?;
    module.add_function(wrap_pyfunction!(maps::channels, module)?)?;
    module.add_function(wrap_pyfunction!(maps::read, module)?)?;
    module.add_function(wrap_pyfunction!(maps::surface, module)?)?;
    module.add_function(wrap_pyfunction!(maps::inspect_surface, module)?)?;
    module.add_function(wrap_pyfunction!(maps::inspect_map, module)?)?;
    module.add_function(wrap_pyfunction!(maps::inspect_result, module)?)?;
    module.add_function(wrap_pyfunction!(maps::treat, module)?)?;
    module.add_function(wrap_pyfunction!(maps::resolved_surface, module)?)?;
    module.add_function(wrap_pyfunction!(fields::stress_distribution, module)?)?;
    module.add_function(wrap_pyfunction!(fields::spots, module)?)?;
    module.add_function(wrap_pyfunction!(fields::scene_numbers, module)?)?;
    module.add_function(wrap_pyfunction!(fields::cells, module)?)?;
    module.add_function(wrap_pyfunction!(fields::run, module)?)?;
    Ok(())
}
