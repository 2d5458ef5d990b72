//! The first difference between the settings of two sweeps.

use serde_json::Value;

/// The first setting that differs, such as `surfaces[0].surface.waves is 8 there and 16 here`.
pub(crate) fn difference(there: &Value, here: &Value) -> Option<String> {
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
    use serde_json::json;

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
