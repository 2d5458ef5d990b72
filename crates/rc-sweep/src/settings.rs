//! The first difference between the settings of two sweeps.

use serde_json::Value;

/// The first setting that differs, such as `waves of surface 1 is 8 in one and 16 in two`.
///
/// Each value comes with words that say where it is, such as `in one`.
pub(crate) fn difference(there: (&Value, &str), here: (&Value, &str)) -> Option<String> {
    find_difference("", [there.0, here.0], [there.1, here.1])
}

fn find_difference(path: &str, [there, here]: [&Value; 2], places: [&str; 2]) -> Option<String> {
    let [in_there, in_here] = places;
    match (there, here) {
        (Value::Object(a), Value::Object(b)) => {
            let keys = a.keys().chain(b.keys().filter(|key| !a.contains_key(*key)));
            let at = |key: &str| if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") };
            keys.into_iter().find_map(|key| {
                let value = |map: &serde_json::Map<String, Value>| map.get(key).cloned().unwrap_or(Value::Null);
                find_difference(&at(key), [&value(a), &value(b)], places)
            })
        }
        (Value::Array(a), Value::Array(b)) if a.len() == b.len() => {
            let mut pairs = a.iter().zip(b).enumerate();
            pairs.find_map(|(i, (a, b))| find_difference(&format!("{path}[{i}]"), [a, b], places))
        }
        (Value::Array(a), Value::Array(b)) => {
            Some(format!("the number of {} is {} {in_there} and {} {in_here}", in_words(path), a.len(), b.len()))
        }
        (a, b) if a == b => None,
        (a, b) => Some(format!("{} is {a} {in_there} and {b} {in_here}", in_words(path))),
    }
}

/// The name of a setting: `waves of surface 1` for `surfaces[0].surface.waves`.
fn in_words(path: &str) -> String {
    let of_surface = path.strip_prefix("surfaces[").and_then(|rest| rest.split_once("]."));
    let Some((index, key)) = of_surface else { return path.to_owned() };
    let load = key.strip_prefix("loads[").and_then(|rest| rest.strip_suffix(']')?.parse::<usize>().ok());
    let name = match load {
        Some(load) => format!("load {}", load + 1),
        None if key == "map.crc32" => "checksum of the file".to_owned(),
        None => key.rsplit('.').next().unwrap_or(key).to_owned(),
    };
    index.parse::<usize>().map_or_else(|_| path.to_owned(), |i| format!("{name} of surface {}", i + 1))
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn the_first_difference_is_named_with_both_values() {
        let there = json!({"version": "1", "surfaces": [{"waves": 8, "loads": [1.0, 2.0]}]});
        assert_eq!(difference((&there, "in one"), (&there, "in two")), None);
        for (change, expected) in [
            (json!({"version": "2"}), "version is \"1\" in one and \"2\" in two"),
            (json!({"surfaces": [{"waves": 9, "loads": [1.0, 2.0]}]}), "waves of surface 1 is 8 in one and 9 in two"),
            (
                json!({"surfaces": [{"waves": 8, "loads": [1.0]}]}),
                "the number of loads of surface 1 is 2 in one and 1 in two",
            ),
            (json!({"more": 1}), "more is null in one and 1 in two"),
        ] {
            let mut here = there.clone();
            for (key, value) in change.as_object().expect("an object") {
                here[key] = value.clone();
            }
            assert_eq!(difference((&there, "in one"), (&here, "in two")).as_deref(), Some(expected));
        }
    }

    #[test]
    fn numbers_are_the_same_after_writing_and_reading() {
        let numbers: Vec<f64> = (1..2000).map(|i| (f64::from(i) * 0.7).exp().recip() * 1.1e-4).collect();
        let written = json!(numbers);
        let read: Value = serde_json::from_str(&written.to_string()).expect("valid JSON");
        assert_eq!(difference((&written, "written"), (&read, "read")), None);
    }
}
