//! Keys of a scene, from keyword arguments.

use std::path::Path;

use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyString};
use rc_cli::scene::keys::Scene;
use rc_cli::scene::{file, resolve};
use rc_sweep::{Loads, Seeds};
use toml::{Table, Value};

use crate::errors::{bad_input, raised};

/// The keys of a scene file.
#[pyfunction]
pub(crate) fn known_keys() -> Vec<String> {
    file::known_keys().to_vec()
}

/// Loads of a sweep, as the command line reads them: `first:last:count`, or values with commas between them.
#[pyfunction]
pub(crate) fn loads(text: &str) -> PyResult<Vec<f64>> {
    text.parse().map(|Loads(values)| values).map_err(bad_input)
}

/// Seeds of a sweep, as the command line reads them: `1..7`, or a list with commas.
#[pyfunction]
pub(crate) fn seeds(text: &str) -> PyResult<Vec<u64>> {
    text.parse().map(|Seeds(values)| values).map_err(bad_input)
}

/// The scene of keyword arguments, laid over a scene file if there is one. `None` is no value.
pub(crate) fn scene_of(keys: &Bound<'_, PyDict>, path: Option<&Path>) -> PyResult<Scene> {
    let mut table = Table::new();
    for (key, value) in keys {
        let key: String = key.extract()?;
        if let Some(value) = value_of(&key, &value)? {
            table.insert(key, value);
        }
    }
    let scene = file::from_table(&table).map_err(raised)?;
    resolve::layers(path, scene).map_err(raised)
}

/// The value of a key; none for `None`.
fn value_of(key: &str, value: &Bound<'_, PyAny>) -> PyResult<Option<Value>> {
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
        Value::Integer(number.extract().map_err(|_| bad_input(format_args!("{key}: {number} is out of range")))?)
    } else {
        let kind = value.get_type().name()?;
        return Err(PyTypeError::new_err(format!("{key}: must be a number or text, not {kind}")));
    };
    Ok(Some(value))
}
