//! Command lines that repeat a result, from the keys of its scene.

use serde::Serialize;
use serde_json::Value;

/// The flags of the keys: ` --key value`, or ` --key` for a key that is true.
pub(crate) fn flags(keys: &impl Serialize) -> String {
    let keys = serde_json::to_value(keys).unwrap_or(Value::Null);
    let keys = keys.as_object().cloned().unwrap_or_default();
    let flag = |(key, value): (&String, &Value)| match value {
        Value::Bool(given) => given.then(|| format!(" --{}", key.replace('_', "-"))),
        value => Some(format!(" --{} {}", key.replace('_', "-"), word(value)?)),
    };
    keys.iter().filter_map(flag).collect()
}

/// A value as one word of a shell; `None` for a key without a value.
fn word(value: &Value) -> Option<String> {
    match value {
        Value::Null => None,
        Value::String(text) => Some(quoted(text)),
        Value::Array(values) if values.iter().all(Value::is_number) => Some(quoted(&list(values))),
        // Its fields are in the order of the flag's list.
        Value::Object(fields) => Some(quoted(&list(fields.values()))),
        other => Some(quoted(&other.to_string())),
    }
}

/// Numbers as the list that a flag takes.
fn list<'a>(values: impl IntoIterator<Item = &'a Value>) -> String {
    values.into_iter().map(Value::to_string).collect::<Vec<_>>().join(",")
}

/// `text` as one word of a shell.
pub(crate) fn quoted(text: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "._-/:=,+".contains(c);
    if !text.is_empty() && text.chars().all(plain) {
        text.to_owned()
    } else {
        format!("'{}'", text.replace('\'', "'\\''"))
    }
}

#[cfg(test)]
mod tests {
    use clap::{Args as _, FromArgMatches as _};

    use super::*;
    use crate::scene::file;
    use crate::scene::keys::Scene;

    /// The flags keep every digit, so that the command repeats the result bit by bit.
    #[test]
    fn the_flags_of_a_scene_are_that_scene() {
        let scenes = [
            "cell = 0.012345678901234567\nwaves = 8\nhurst = 0.7000000000000001\ntruncation = \"square\"\ngrid = \"64x32\"\n\
             e_star = 1e9\npressure = 446394.9843260188\nkernel = \"spectral\"\nmethod = \"gauss-seidel\"\ntolerance = \"auto\"\nleakage = true\n",
            "waves = 8\ne_star = 1e9\nhardness = 3e6\nhistory = [1e6, 0, 5e5]\nconductivity = \"400,50\"\n",
            "waves = 8\npressure = 1e6\nspeed = 0.1\nfractional = { alpha = 0.2, glassy_ratio = 10, tau = 1e-3 }\n",
        ];
        for scene in scenes {
            let scene = file::parse(scene).expect("a scene");
            let line = format!("solve{}{}", flags(&scene.surface), flags(&scene.contact));
            let matches = Scene::augment_args(clap::Command::new("solve")).get_matches_from(line.split(' '));
            assert_eq!(Scene::from_arg_matches(&matches).expect("a command line"), scene, "{line}");
        }
    }

    #[test]
    fn words_are_quoted_where_a_shell_would_split_them() {
        for (text, expected) in [("a/b.toml", "a/b.toml"), ("my map", "'my map'"), ("it's", "'it'\\''s'"), ("", "''")] {
            assert_eq!(quoted(text), expected);
        }
    }
}
