//! The settings that determine the rows of a sweep: its fingerprint, kept in plain text so that a difference can be named.

use std::path::Path;

use serde::Serialize;
use serde_json::{Value, json};

use super::plan::{Plan, PlannedSurface};
use crate::error::CliError;
use crate::scene::{ContactKeys, SurfaceKeys};
use crate::surface::Source;

/// What determines the rows of one surface. Where it lies does not, so of a height map name and content count.
#[derive(Serialize)]
struct SurfaceSettings<'a> {
    scene: &'a str,
    surface: SurfaceKeys,
    contact: ContactKeys,
    loads: &'a [f64],
    map: Option<MapMark>,
}

/// By which a height map is known again.
#[derive(Serialize)]
struct MapMark {
    bytes: u64,
    crc32: u32,
}

/// The settings of a sweep.
///
/// # Errors
/// [`CliError::Input`] when a height map cannot be read.
pub(super) fn of(plan: &Plan) -> Result<Value, CliError> {
    let surfaces: Vec<SurfaceSettings<'_>> =
        plan.surfaces.iter().map(|s| of_surface(plan, s)).collect::<Result<_, _>>()?;
    Ok(json!({
        "version": env!("CARGO_PKG_VERSION"),
        "control": plan.control.key(),
        "fields": plan.fields,
        "surfaces": surfaces,
    }))
}

fn of_surface<'a>(plan: &Plan, planned: &'a PlannedSurface) -> Result<SurfaceSettings<'a>, CliError> {
    let mut surface = planned.problem.keys.clone();
    let map = match &planned.problem.source {
        Source::Random { .. } => None,
        Source::File { path, .. } => {
            surface.heights = path.file_name().map(Into::into);
            Some(mark(path)?)
        }
    };
    let contact = plan.control.with_load(&planned.contact, None);
    Ok(SurfaceSettings { scene: &planned.scene, surface, contact, loads: &planned.loads, map })
}

fn mark(path: &Path) -> Result<MapMark, CliError> {
    let fail = |cause| CliError::in_file(path, format_args!("cannot read: {cause}"));
    let mut file = std::fs::File::open(path).map_err(fail)?;
    let mut sum = Crc(crc32fast::Hasher::new());
    let bytes = std::io::copy(&mut file, &mut sum).map_err(fail)?;
    Ok(MapMark { bytes, crc32: sum.0.finalize() })
}

/// A checksum that is written to.
struct Crc(crc32fast::Hasher);

impl std::io::Write for Crc {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0.update(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

/// The first setting that differs, as `surfaces[0].surface.waves is 8 there and 16 here`.
pub(super) fn difference(there: &Value, here: &Value) -> Option<String> {
    find_difference("", there, here)
}

fn find_difference(path: &str, there: &Value, here: &Value) -> Option<String> {
    match (there, here) {
        (Value::Object(a), Value::Object(b)) => {
            let keys = a.keys().chain(b.keys().filter(|key| !a.contains_key(*key)));
            let at = |key: &str| if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") };
            keys.into_iter().find_map(|key| {
                let value = |map: &serde_json::Map<String, Value>| map.get(key).cloned().unwrap_or(Value::Null);
                find_difference(&at(key), &value(a), &value(b))
            })
        }
        (Value::Array(a), Value::Array(b)) if a.len() == b.len() => {
            let mut pairs = a.iter().zip(b).enumerate();
            pairs.find_map(|(i, (a, b))| find_difference(&format!("{path}[{i}]"), a, b))
        }
        (Value::Array(a), Value::Array(b)) => Some(format!("{path} are {} there and {} here", a.len(), b.len())),
        (a, b) if a == b => None,
        (a, b) => Some(format!("{path} is {a} there and {b} here")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_difference_is_named_with_both_values() {
        let there = json!({"version": "1", "surfaces": [{"waves": 8, "loads": [1.0, 2.0]}]});
        assert_eq!(difference(&there, &there), None);
        for (change, expected) in [
            (json!({"version": "2"}), "version is \"1\" there and \"2\" here"),
            (json!({"surfaces": [{"waves": 9, "loads": [1.0, 2.0]}]}), "surfaces[0].waves is 8 there and 9 here"),
            (json!({"surfaces": [{"waves": 8, "loads": [1.0]}]}), "surfaces[0].loads are 2 there and 1 here"),
            (json!({"more": 1}), "more is null there and 1 here"),
        ] {
            let mut here = there.clone();
            for (key, value) in change.as_object().expect("an object") {
                here[key] = value.clone();
            }
            assert_eq!(difference(&there, &here).as_deref(), Some(expected));
        }
    }

    #[test]
    fn numbers_are_the_same_after_writing_and_reading() {
        let numbers: Vec<f64> = (1..2000).map(|i| (f64::from(i) * 0.7).exp().recip() * 1.1e-4).collect();
        let written = json!(numbers);
        let read: Value = serde_json::from_str(&written.to_string()).expect("valid JSON");
        assert_eq!(difference(&written, &read), None);
    }
}
