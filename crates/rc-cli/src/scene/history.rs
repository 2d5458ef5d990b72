//! Loads one after the other, as a key.

use std::fmt;
use std::str::FromStr;

use serde::de::{Deserializer, Error, SeqAccess, Visitor};
use serde::{Deserialize, Serialize};

use super::quantity::pressure;

/// Mean pressures (Pa) that follow each other: the text `10MPa,0`, or the list `[1e7, 0]`, of numbers or text.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct HistorySpec(pub Vec<f64>);

impl FromStr for HistorySpec {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        text.split(',').map(pressure::parse).collect::<Result<_, _>>().map(Self)
    }
}

impl<'de> Deserialize<'de> for HistorySpec {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct HistoryVisitor;
        impl<'de> Visitor<'de> for HistoryVisitor {
            type Value = HistorySpec;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a list of pressures (Pa) such as [1e7, 0], or \"10MPa,0\"")
            }

            fn visit_i64<E: Error>(self, load: i64) -> Result<HistorySpec, E> {
                Ok(HistorySpec(vec![load as f64]))
            }

            fn visit_f64<E: Error>(self, load: f64) -> Result<HistorySpec, E> {
                Ok(HistorySpec(vec![load]))
            }

            fn visit_str<E: Error>(self, text: &str) -> Result<HistorySpec, E> {
                text.parse().map_err(E::custom)
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<HistorySpec, A::Error> {
                let mut loads = Vec::new();
                while let Some(Load(load)) = list.next_element()? {
                    loads.extend(load);
                }
                Ok(HistorySpec(loads))
            }
        }
        deserializer.deserialize_any(HistoryVisitor)
    }
}

/// A pressure (Pa) of a list.
#[derive(Deserialize)]
struct Load(#[serde(deserialize_with = "pressure::read")] Option<f64>);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn loads_are_a_text_or_a_list_with_or_without_units() {
        let loads = HistorySpec(vec![1e7, 0.0, 5e6]);
        assert_eq!("10MPa, 0,5e6".parse(), Ok(loads.clone()));
        for text in ["x = '10MPa,0,5e6'", "x = [1e7, 0, '5MPa']"] {
            let table: std::collections::HashMap<String, HistorySpec> = toml::from_str(text).expect(text);
            assert_eq!(table["x"], loads, "{text}");
        }
        for text in ["", "1e7,", "1e7;0", "10m"] {
            assert!(text.parse::<HistorySpec>().is_err(), "'{text}' was read as loads");
        }
    }
}
