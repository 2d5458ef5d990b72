//! The commands that repeat a sweep, from the settings in its journal.

use serde_json::{Map, Value};

use super::command::{flags, quoted};
use super::page::{Command, WITHOUT_FILES};

/// Files that a surface is made from: key, and name in a sentence.
const FILES: [(&str, &str); 4] = [
    ("heights", "the height map "),
    ("spectrum", "the file of waves "),
    ("psd", "the table of a spectrum "),
    ("like", ""),
];

/// Varied keys with which loads follow from the contact: a force, and the constant load of a solid that creeps.
const LOADS: [&str; 2] = ["force", "time"];

/// Keys of a surface or a contact.
type Keys = Map<String, Value>;

/// Surfaces of a sweep that one command solves.
struct Part<'a> {
    /// Keys of the surface and of the contact, without those that vary.
    keys: [Keys; 2],
    /// The keys that vary, and their values.
    varied: Vec<(&'a str, Vec<&'a Value>)>,
    loads: &'a Value,
    /// The seeds, each once.
    seeds: Vec<&'a Value>,
}

/// The command lines of the sweep. `settings` is the first line of its journal.
///
/// A scene has one command, or one for each variation if a variation changes more than its own keys.
pub(super) fn commands(settings: &Value) -> Vec<Command> {
    let surfaces = settings["surfaces"].as_array().map_or(&[][..], Vec::as_slice);
    let of_scene = |scene: &[Value]| -> Vec<Command> {
        let name = scene[0]["scene"].as_str().unwrap_or_default();
        if let Some(part) = Part::of(scene) {
            return vec![part.command(settings, name)];
        }
        let variations = scene.chunk_by(|a, b| a["varied"] == b["varied"]).enumerate();
        let single = |(i, surfaces): (usize, &[Value])| {
            let dash = if name.is_empty() { "" } else { "-" };
            Part::of_one(surfaces).command(settings, &format!("{name}{dash}{}", i + 1))
        };
        variations.map(single).collect()
    };
    surfaces.chunk_by(|a, b| a["scene"] == b["scene"]).flat_map(of_scene).collect()
}

/// The varied keys of a surface with their values.
fn varied_of(surface: &Value) -> Vec<(&str, &Value)> {
    let pairs = surface["varied"].as_array().map_or(&[][..], Vec::as_slice);
    pairs.iter().filter_map(|pair| Some((pair[0].as_str()?, &pair[1]))).collect()
}

/// The keys of surface and contact, without the seed and without the keys of `names`.
fn keys_without(surface: &Value, names: &[&str]) -> [Keys; 2] {
    ["surface", "contact"].map(|group| {
        let keys = surface[group].as_object().cloned().unwrap_or_default();
        keys.into_iter().filter(|(key, _)| key != "seed" && !names.contains(&key.as_str())).collect()
    })
}

impl<'a> Part<'a> {
    /// The surfaces of a scene, if a list for each varied key gives them.
    fn of(scene: &'a [Value]) -> Option<Self> {
        let mut varied: Vec<_> = varied_of(&scene[0]).into_iter().map(|(key, _)| (key, Vec::new())).collect();
        let names: Vec<&str> = varied.iter().map(|(key, _)| *key).collect();
        let keys = keys_without(&scene[0], &names);
        for surface in scene {
            let has_loads = names.iter().any(|name| LOADS.contains(name)) || surface["loads"] == scene[0]["loads"];
            if !has_loads || keys_without(surface, &names) != keys {
                return None;
            }
            for ((_, values), (_, value)) in varied.iter_mut().zip(varied_of(surface)) {
                if !values.contains(&value) {
                    values.push(value);
                }
            }
        }
        // On the command line, a comma ends a value, and colons make a range.
        let is_word = |value: &&Value| value.as_str().is_none_or(|text| !text.contains([',', ':']));
        let are_words = varied.iter().flat_map(|(_, values)| values).all(is_word);
        are_words.then(|| Self { keys, varied, ..Self::of_one(scene) })
    }

    /// Surfaces that differ in their seeds alone.
    fn of_one(surfaces: &'a [Value]) -> Self {
        let mut seeds = Vec::new();
        for seed in surfaces.iter().map(|one| &one["surface"]["seed"]) {
            if !seed.is_null() && !seeds.contains(&seed) {
                seeds.push(seed);
            }
        }
        Self { keys: keys_without(&surfaces[0], &[]), varied: Vec::new(), loads: &surfaces[0]["loads"], seeds }
    }

    fn command(&self, settings: &Value, name: &str) -> Command {
        let [surface, contact] = &self.keys;
        let list = |values: &mut dyn Iterator<Item = &Value>| values.map(text_of).collect::<Vec<_>>().join(",");
        let vary = self.varied.iter().map(|(key, values)| {
            if *key == "time" {
                return format!(" --times {}", list(&mut values.iter().copied()));
            }
            let key = key.replace('_', "-");
            format!(" --vary {}", quoted(&format!("{key}={}", list(&mut values.iter().copied()))))
        });
        let control = settings["control"].as_str().unwrap_or("pressure");
        let loads = if self.varied.iter().any(|(key, _)| LOADS.contains(key)) {
            String::new()
        } else {
            format!(" --{control}s {}", list(&mut self.loads.as_array().into_iter().flatten()))
        };
        let seeds = list(&mut self.seeds.iter().copied());
        let seeds = if seeds.is_empty() { String::new() } else { format!(" --seeds {seeds}") };
        let fields = if settings["fields"] == true { " --fields" } else { "" };
        let out = quoted(&format!("again{}{name}", if name.is_empty() { "" } else { "-" }));
        let (surface, contact) = (flags(surface) + &flags(contact), vary.collect::<String>());
        Command { note: self.note(), text: format!("rc sweep{surface}{contact}{loads}{seeds}{fields} --out {out}") }
    }

    /// Where the command is to be run.
    fn note(&self) -> String {
        let mut files = FILES.iter().filter_map(|(key, kind)| Some((kind, self.keys[0].get(*key)?.as_str()?)));
        files.next().map_or_else(|| WITHOUT_FILES.to_owned(), |(kind, file)| format!("In the folder of {kind}{file}:"))
    }
}

/// A value as in a list of the command line.
fn text_of(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), Into::into)
}
