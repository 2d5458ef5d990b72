//! Reader of scene files, which are TOML.
//!
//! Its errors name the line and the most similar known key.

use std::path::Path;
use std::sync::LazyLock;

use clap::Args as _;
use serde::{Deserialize, Serialize};
use toml::Table;
use toml::de::DeTable;

use crate::error::CliError;
use crate::scene::keys::{ContactKeys, EXAMPLE, RunKeys, Scene, SurfaceKeys};

/// Reads a scene file. Relative paths in it are relative to its folder.
///
/// # Errors
/// [`CliError::Input`] when the file cannot be read, is not TOML, has an unknown key or a value of the wrong type.
pub fn read(path: &Path) -> Result<Scene, CliError> {
    let bytes = std::fs::read(path)
        .map_err(|cause| CliError::in_file(path, format_args!("cannot read this scene file: {cause}")))?;
    let text = String::from_utf8(bytes).map_err(|error| {
        let message = if error.as_bytes().contains(&0) {
            format!("not a scene file, which is text (TOML); for a height map give --heights {}", path.display())
        } else {
            "not text in UTF-8; save it as UTF-8".to_owned()
        };
        CliError::in_file(path, message)
    })?;
    let scene = parse(&text).map_err(|message| CliError::in_file(path, message))?;
    Ok(scene.relative_to(path.parent().unwrap_or(Path::new(""))))
}

/// The scene of the embedded example.
///
/// # Panics
/// Never, since a test reads it.
#[must_use]
pub fn example() -> Scene {
    static SCENE: LazyLock<Scene> = LazyLock::new(|| parse(EXAMPLE).expect("the embedded example is a valid scene"));
    SCENE.clone()
}

/// Parses a scene.
///
/// # Errors
/// One line that says where, what, and what would be right. It does not have the name of the file.
pub fn parse(text: &str) -> Result<Scene, String> {
    let table = DeTable::parse(text).map_err(|error| at_line(text, &error))?;
    for key in table.get_ref().keys() {
        if !known_keys().iter().any(|k| k == key.get_ref()) {
            let line = line_of(text, key.span().start);
            return Err(format!("line {line}: {}", unknown_key(key.get_ref(), known_keys())));
        }
    }
    Ok(Scene {
        surface: group::<SurfaceKeys>(text)?,
        contact: group::<ContactKeys>(text)?,
        run: group::<RunKeys>(text)?,
    })
}

/// A scene from a table of keys and values, for programs.
///
/// # Errors
/// [`CliError::Input`] with the key that is unknown or whose value has the wrong type.
pub fn from_table(table: &Table) -> Result<Scene, CliError> {
    if let Some(key) = table.keys().find(|key| !known_keys().contains(key)) {
        return Err(CliError::input(unknown_key(key, known_keys())));
    }
    Ok(Scene { surface: group_of(table)?, contact: group_of(table)?, run: group_of(table)? })
}

/// A group of keys as TOML, without the keys that have no value.
///
/// # Panics
/// Never for checked keys. TOML cannot hold a seed above 2^63, which is refused earlier.
#[must_use]
pub fn to_toml(group: &impl Serialize) -> String {
    toml::to_string(group).expect("checked keys are numbers and text that TOML holds")
}

/// One group of keys, without the keys of other groups.
///
/// Three passes take the place of serde's `flatten`, which would lose the line of a wrong value.
fn group<T: for<'de> Deserialize<'de>>(text: &str) -> Result<T, String> {
    toml::from_str(text).map_err(|error| at_value(text, &error))
}

/// One group of keys from a table.
fn group_of<T: for<'de> Deserialize<'de>>(table: &Table) -> Result<T, CliError> {
    T::deserialize(table.clone()).map_err(|error| {
        // The wrong key is the one that fails alone.
        let is_wrong = |key: &str, value: &toml::Value| {
            T::deserialize(Table::from_iter([(key.to_owned(), value.clone())])).is_err()
        };
        let wrong = table.iter().find(|(key, value)| is_wrong(key, value));
        let key = wrong.map_or("scene", |(key, _)| key.as_str());
        CliError::input(format_args!("{key}: {}", in_words(error.message())))
    })
}

/// The keys of a scene file, which are the flags of the command line.
#[must_use]
pub fn known_keys() -> &'static [String] {
    static KEYS: LazyLock<Vec<String>> = LazyLock::new(|| {
        let command = Scene::augment_args(clap::Command::new("scene"));
        command.get_arguments().map(|argument| argument.get_id().to_string()).collect()
    });
    &KEYS
}

fn unknown_key(key: &str, known: &[String]) -> String {
    let nearest = known.iter().max_by(|a, b| strsim::jaro_winkler(key, a).total_cmp(&strsim::jaro_winkler(key, b)));
    match nearest {
        Some(nearest) => format!("unknown key '{key}'; the nearest known key is '{nearest}'"),
        None => format!("unknown key '{key}'"),
    }
}

fn at_line(text: &str, error: &toml::de::Error) -> String {
    let message = error.message();
    match error.span() {
        Some(span) => format!("line {}: {message}", line_of(text, span.start)),
        None => message.to_owned(),
    }
}

/// The message about a value of the wrong type, with its line and key.
fn at_value(text: &str, error: &toml::de::Error) -> String {
    let said = in_words(error.message());
    let Some(span) = error.span() else { return said };
    let number = line_of(text, span.start);
    let line = text.lines().nth(number - 1).unwrap_or_default();
    match line.split_once('=') {
        Some((key, _)) => format!("line {number}: {}: {said}", key.trim()),
        None => format!("line {number}: {said}"),
    }
}

/// The message of serde about a value, without the names of Rust types.
///
/// `invalid type: string "1e5", expected f64` becomes `must be a number without quotes, not "1e5"`. Other messages stay
/// as they are.
fn in_words(message: &str) -> String {
    if message == "wanted string or table" {
        return "must be text in quotes".to_owned();
    }
    let Some((found, expected)) = message.rsplit_once(", expected ") else { return message.to_owned() };
    if let Some(name) = found.strip_prefix("unknown variant ") {
        // The name of a kernel that is a function appears in results only.
        let names = expected.split('`').skip(1).step_by(2).filter(|name| *name != "own");
        let names: Vec<String> = names.map(|name| format!("'{name}'")).collect();
        return format!("must be {}, not {}", names.join(" or "), name.replace('`', "'"));
    }
    let Some(value) = found.strip_prefix("invalid type: ").or_else(|| found.strip_prefix("invalid value: ")) else {
        return message.to_owned();
    };
    let kinds = ["integer ", "floating point ", "boolean ", "string "];
    let value = kinds.iter().fold(value, |value, kind| value.trim_start_matches(kind)).replace('`', "");
    let expected = match expected {
        "usize" | "u64" | "u32" => "a whole number of at least 0",
        "f64" => "a number without quotes",
        "a string" | "path string" | "string only" => "text in quotes",
        "a boolean" => "true or false",
        other => other,
    };
    match &*value {
        "unit variant" => format!("must be {expected}"),
        "sequence" => format!("must be {expected}, not a list"),
        "map" => format!("must be {expected}, not a table"),
        value => format!("must be {expected}, not {value}"),
    }
}

fn line_of(text: &str, offset: usize) -> usize {
    1 + text.bytes().take(offset).filter(|byte| *byte == b'\n').count()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::values::GridSpec;
    use rc_solver::Tolerance;

    #[test]
    fn the_example_is_the_scene_of_the_paper() {
        let scene = example();
        let e_star = 0.4e9 / (1.0 - 0.45 * 0.45);
        let pressure = scene.contact.pressure.expect("pressure control");
        assert!((pressure / e_star - 8.9e-4).abs() < 1e-16, "σ0/E* = {}", pressure / e_star);
        assert_eq!(scene.surface.waves, Some(64));
        assert_eq!(scene.surface.grid, Some(GridSpec::square(2048)));
        assert_eq!(scene.contact.energy_tolerance.map(Tolerance::Energy), Some(Tolerance::DEFAULT));
    }

    #[test]
    fn an_unknown_key_is_answered_with_the_nearest_and_its_line() {
        for (key, nearest) in
            [("presure", "pressure"), ("e-star", "e_star"), ("Hurst", "hurst"), ("rolloff", "roll_off")]
        {
            let message = parse(&format!("waves = 8\n{key} = 1\n")).expect_err("the key is unknown");
            assert!(message.starts_with("line 2:") && message.contains(&format!("'{nearest}'")), "{message}");
        }
    }

    #[test]
    fn a_wrong_type_names_its_line() {
        for text in ["seed = 1\ncell = \"a\"\n", "\ngrid = -4", "\ngrid = 1.5", "\nkernel = \"lave\"", "\nquiet = 1"] {
            let message = parse(text).expect_err("the type is wrong");
            assert!(message.starts_with("line 2:"), "{message}");
        }
    }

    #[test]
    fn a_syntax_error_names_its_line() {
        let message = parse("cell = 1\nwaves = = 2\n").expect_err("no TOML");
        assert!(message.starts_with("line 2:"), "{message}");
    }
}
