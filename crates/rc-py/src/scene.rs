//! Scenes from keyword arguments.

use std::path::Path;

use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyString};
use rc_cli::scene::keys::{Scene, SurfaceKeys};
use rc_cli::scene::{file, resolve};
use rc_core::Dimension;
use rc_sweep::{Loads, Seeds};
use toml::{Table, Value};

use crate::errors::{bad_input, raised, wrong_value};

/// Names of the keys of a scene file.
#[pyfunction]
pub(crate) fn known_keys() -> Vec<String> {
    file::known_keys().to_vec()
}

/// Loads of a sweep: `first:last:count`, or values with commas between them. They are pressures or penetrations.
///
/// The command line reads them in the same way.
#[pyfunction]
pub(crate) fn loads(text: &str, penetrations: bool) -> PyResult<Vec<f64>> {
    let dimension = if penetrations { Dimension::Length } else { Dimension::Pressure };
    Loads::with_units(text, dimension).map(|Loads(values)| values).map_err(bad_input)
}

/// Seeds of a sweep: `1..7`, or a list with commas.
///
/// The command line reads them in the same way.
#[pyfunction]
pub(crate) fn seeds(text: &str) -> PyResult<Vec<u64>> {
    text.parse().map(|Seeds(values)| values).map_err(bad_input)
}

/// The scene of keyword arguments, laid over a scene file if there is one.
///
/// A keyword with the value `None` counts as absent.
pub(crate) fn scene_of(keys: &Bound<'_, PyDict>, path: Option<&Path>) -> PyResult<Scene> {
    resolve::layers(path, scene_of_keys(keys)?).map_err(raised)
}

fn scene_of_keys(keys: &Bound<'_, PyDict>) -> PyResult<Scene> {
    let mut table = Table::new();
    for (key, value) in keys {
        let key: String = key.extract()?;
        if let Some(value) = value_of(&key, &value)? {
            table.insert(key, value);
        }
    }
    file::from_table(&table).map_err(wrong_value)
}

/// The scene as in [`scene_of`], for a call that may have a height map.
///
/// The map replaces the surface of a scene file, as a file of heights would. Other keys of the call that describe a
/// surface are refused later.
pub(crate) fn with_map(keys: &Bound<'_, PyDict>, path: Option<&Path>, holds_map: bool) -> PyResult<Scene> {
    let of_keys = scene_of_keys(keys)?;
    let call = of_keys.surface.clone();
    let mut scene = resolve::layers(path, of_keys).map_err(raised)?;
    if holds_map {
        let kept = &mut scene.surface;
        if call.heights.is_none() && !call.generates() {
            let added = kept.clone().added();
            *kept = SurfaceKeys { grid: call.grid, ..call.over(added) };
        }
    }
    Ok(scene)
}

/// The value of a key; `None` for Python's `None`.
pub(crate) fn value_of(key: &str, value: &Bound<'_, PyAny>) -> PyResult<Option<Value>> {
    if value.is_none() {
        return Ok(None);
    }
    let value = if let Ok(flag) = value.cast::<PyBool>() {
        Value::Boolean(flag.is_true())
    } else if let Ok(text) = value.cast::<PyString>() {
        Value::String(text.to_str()?.to_owned())
    } else if let Ok(number) = value.cast::<PyFloat>() {
        Value::Float(number.value())
    } else if let Ok(number) = value.cast::<PyInt>() {
        Value::Integer(number.extract().map_err(|_| bad_input(format_args!("{key}: {number} is too large")))?)
    } else if let ("prony", Ok(terms)) = (key, value.extract::<Vec<[f64; 2]>>()) {
        let term = |term: [f64; 2]| Value::Array(term.map(Value::Float).to_vec());
        Value::Array(terms.into_iter().map(term).collect())
    } else {
        let kind = value.get_type().name()?;
        let instead = match key {
            "cell" => "; the other side is cell_y",
            "pressure" | "penetration" | "seed" => "; roughcontact.sweep solves for several",
            "heights" => "; an array is the argument heights",
            "add" => "; an array needs an array of heights",
            _ => "",
        };
        let expected = match key {
            "prony" => "a file or pairs (g, tau)",
            "grid" | "output_grid" => "a whole number, a pair (nx, ny), or text such as '512x256'",
            _ => "a number or text",
        };
        return Err(PyTypeError::new_err(format!("{key}: must be {expected}, not {kind}{instead}")));
    };
    Ok(Some(value))
}
