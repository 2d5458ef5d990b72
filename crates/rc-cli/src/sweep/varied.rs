//! `--vary`: keys that take several values in a sweep.

use std::str::FromStr;

use rc_sweep::Loads;
use serde_json::{Value, json};
use toml::Table;

use crate::error::CliError;
use crate::scene::keys::Scene;
use crate::scene::{file, quantity};

/// A key and its values.
#[derive(Clone, Debug, PartialEq)]
pub struct Variation {
    /// The key, as in scene files.
    key: String,
    list: List,
    /// The flag that gives the list.
    flag: &'static str,
}

/// The values of a key, as a scene file has them.
#[derive(Clone, Debug, PartialEq)]
enum List {
    Values(Vec<toml::Value>),
    /// First value, last value, and the rest of a range.
    Range([toml::Value; 2], String),
}

/// A value of each varied key, in SI units, by the name of the key.
pub(super) type Varied = Vec<(String, Value)>;

/// Keys that a sweep has other lists for.
const NOT_VARIED: [(&str, &str); 3] =
    [("pressure", "--pressures"), ("penetration", "--penetrations"), ("seed", "--seeds")];

impl FromStr for Variation {
    type Err = String;

    /// Reads `hardness=5MPa,1e7`, or a range such as `layer-thickness=10um:1mm:8`.
    fn from_str(text: &str) -> Result<Self, String> {
        let expected = || format!("must be a key and its values, such as hardness=5MPa,1e7, not '{text}'");
        let (key, list) = text.split_once('=').ok_or_else(expected)?;
        let key = key.trim().trim_start_matches("--").replace('-', "_");
        let list = match list.splitn(3, ':').collect::<Vec<_>>()[..] {
            [first, last, rest] => List::Range([first, last].map(value_of), rest.to_owned()),
            _ => List::Values(list.split(',').map(value_of).collect()),
        };
        Self::checked(key, list)
    }
}

impl Variation {
    /// A key and its values.
    ///
    /// # Errors
    /// One line about a key that has a list of its own, or a value that occurs twice.
    pub fn new(key: String, values: Vec<toml::Value>) -> Result<Self, String> {
        Self::checked(key, List::Values(values))
    }

    /// The list of `--speeds`.
    ///
    /// # Errors
    /// One line about a value that is no speed, or occurs twice.
    pub fn speeds(text: &str) -> Result<Self, String> {
        quantity::check_speeds(text)?;
        Ok(Self { flag: "speeds", ..format!("speed={text}").parse()? })
    }

    /// The key, as in scene files.
    pub(super) fn key(&self) -> &str {
        &self.key
    }

    fn checked(key: String, list: List) -> Result<Self, String> {
        if let Some((_, flag)) = NOT_VARIED.iter().find(|(name, _)| *name == key) {
            return Err(format!("{key} has a list of its own; give {flag}"));
        }
        if let List::Values(values) = &list {
            let twice = values.iter().enumerate().find(|(i, value)| values[..*i].contains(value));
            if let Some((_, value)) = twice {
                return Err(format!("{key} has the value {value} twice"));
            }
        }
        Ok(Self { key, list, flag: "vary" })
    }

    /// The scenes with each of the values, and the values in SI units.
    fn of(&self, scene: &Scene) -> Result<Vec<(Value, Scene)>, CliError> {
        let values = match &self.list {
            List::Values(values) => values.clone(),
            List::Range([first, last], rest) => {
                let [first, last] = [first, last].map(|end| self.with(end, scene).map(|(value, _)| value));
                let loads = format!("{}:{}:{rest}", first?, last?).parse();
                let Loads(values) = loads.map_err(|error| self.refused(error))?;
                values.into_iter().map(toml::Value::Float).collect()
            }
        };
        values.iter().map(|value| self.with(value, scene)).collect()
    }

    /// The scene with this value, and the value in SI units.
    fn with(&self, value: &toml::Value, scene: &Scene) -> Result<(Value, Scene), CliError> {
        // JSON has no such number.
        if let Some(number) = value.as_float().filter(|number| !number.is_finite()) {
            return Err(self.refused(format_args!("must be finite, not {number}")));
        }
        let table = Table::from_iter([(self.key.clone(), value.clone())]);
        let upper =
            file::from_table(&table).map_err(|error| CliError::input(format_args!("{}: {error}", self.flag)))?;
        let groups = [json!(upper.surface), json!(upper.contact)];
        let in_si = groups.iter().filter_map(|group| group.get(&self.key)).find(|value| !value.is_null());
        match in_si {
            Some(in_si) => Ok((in_si.clone(), upper.over(scene.clone()))),
            None => Err(self.refused("is not a key of the surface or the contact, so it does not change the rows")),
        }
    }

    fn refused(&self, message: impl std::fmt::Display) -> CliError {
        CliError::input(format_args!("{}: {}: {message}", self.flag, self.key))
    }
}

/// A value as a scene file has it: a number, true or false, or text.
fn value_of(text: &str) -> toml::Value {
    let text = text.trim();
    let whole = || text.parse().map(toml::Value::Integer).ok();
    let number = || text.parse().map(toml::Value::Float).ok();
    let flag = || text.parse().map(toml::Value::Boolean).ok();
    whole().or_else(number).or_else(flag).unwrap_or_else(|| toml::Value::String(text.to_owned()))
}

/// The scene with all combinations of the values, the last key changing fastest.
///
/// # Errors
/// [`CliError::Input`] for an unknown key, one that is given twice, or a value of the wrong type.
pub(super) fn scenes(variations: &[Variation], scene: &Scene) -> Result<Vec<(Varied, Scene)>, CliError> {
    let mut scenes = vec![(Varied::new(), scene.clone())];
    for (i, variation) in variations.iter().enumerate() {
        if variations[..i].iter().any(|other| other.key == variation.key) {
            return Err(variation.refused("is given twice; give one list"));
        }
        let mut next = Vec::new();
        for (varied, scene) in &scenes {
            for (value, changed) in variation.of(scene)? {
                next.push((varied.iter().cloned().chain([(variation.key.clone(), value)]).collect(), changed));
            }
        }
        scenes = next;
    }
    Ok(scenes)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn varied(lists: &[&str]) -> Result<Vec<Varied>, String> {
        let variations = lists.iter().map(|list| list.parse()).collect::<Result<Vec<Variation>, _>>()?;
        let scenes = scenes(&variations, &Scene::default()).map_err(|error| error.to_string())?;
        Ok(scenes.into_iter().map(|(varied, _)| varied).collect())
    }

    #[test]
    fn values_are_in_si_units_and_combined() {
        let found = varied(&["hardness=5MPa,1e7", "layer-thickness=1um:100um:3"]).expect("scenes");
        let expected = [(5e6, 1e-6), (5e6, 1e-5), (5e6, 1e-4), (1e7, 1e-6), (1e7, 1e-5), (1e7, 1e-4)];
        let expected = expected.map(|(hardness, thickness)| {
            vec![("hardness".to_owned(), json!(hardness)), ("layer_thickness".to_owned(), json!(thickness))]
        });
        assert_eq!(found, expected);
        assert_eq!(varied(&["kernel=love,spectral"]).expect("scenes")[1], [("kernel".to_owned(), json!("spectral"))]);
        assert_eq!(varied(&["grid=64,128x64"]).expect("scenes")[0], [("grid".to_owned(), json!(64))]);
        assert_eq!(varied(&[]).expect("one scene"), [Varied::new()]);
    }

    #[test]
    fn what_cannot_be_varied_is_named() {
        for (lists, expected) in [
            (&["hardness"][..], "must be a key and its values"),
            (&["pressure=1,2"], "pressure has a list of its own; give --pressures"),
            (&["hardnes=1,2"], "unknown key 'hardnes'; the nearest known key is 'hardness'"),
            (&["hardness=5mm"], "must be a pressure"),
            (&["hardness=1mm:2mm:3"], "must be a pressure"),
            (&["hardness=1:2"], "must be a pressure"),
            (&["hardness=1,1"], "hardness has the value 1 twice"),
            (&["hardness="], "must be a pressure"),
            (&["hardness=1", "hardness=2"], "hardness: is given twice"),
            (&["threads=1,2"], "threads: is not a key of the surface or the contact"),
        ] {
            let error = varied(lists).expect_err(expected);
            assert!(error.contains(expected), "{lists:?}: {error}");
        }
    }
}
