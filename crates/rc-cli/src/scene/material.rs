//! Materials that relax, as keys: a Prony series and a fractional solid.

use std::fmt;
use std::path::PathBuf;
use std::str::FromStr;

use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserializer, Error, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Serialize, Serializer};

use super::quantity::time;

/// A Prony series: its file, or its terms.
#[derive(Clone, Debug, PartialEq)]
pub enum PronySpec {
    /// A text of lines g τ.
    File(PathBuf),
    /// Pairs of g, relative to the relaxed modulus, and τ (s).
    Terms(Vec<[f64; 2]>),
}

impl PronySpec {
    /// The name of its file, if it is in one.
    pub(crate) fn path(&mut self) -> Option<&mut PathBuf> {
        if let Self::File(path) = self { Some(path) } else { None }
    }
}

impl FromStr for PronySpec {
    type Err = String;

    /// Reads the name of a file, or a list such as `[[3,0.001],[6,0.1]]`.
    fn from_str(text: &str) -> Result<Self, String> {
        if !text.trim_start().starts_with('[') {
            return Ok(Self::File(text.into()));
        }
        let terms = serde_json::from_str(text);
        terms
            .map(Self::Terms)
            .map_err(|_| format!("must be a file, or a list such as [[3,0.001],[6,0.1]], not '{text}'"))
    }
}

impl Serialize for PronySpec {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::File(path) => path.serialize(serializer),
            Self::Terms(terms) => terms.serialize(serializer),
        }
    }
}

impl<'de> Deserialize<'de> for PronySpec {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct PronyVisitor;
        impl<'de> Visitor<'de> for PronyVisitor {
            type Value = PronySpec;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("the name of a file in quotes, or a list of pairs [g, tau]")
            }

            fn visit_str<E: Error>(self, text: &str) -> Result<PronySpec, E> {
                text.parse().map_err(E::custom)
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<PronySpec, A::Error> {
                let mut terms = Vec::new();
                while let Some(Pair(term)) = list.next_element()? {
                    terms.push(term);
                }
                Ok(PronySpec::Terms(terms))
            }
        }
        deserializer.deserialize_any(PronyVisitor)
    }
}

/// A pair of numbers.
struct Pair([f64; 2]);

impl<'de> Deserialize<'de> for Pair {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct PairVisitor;
        impl<'de> Visitor<'de> for PairVisitor {
            type Value = Pair;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a list of pairs [g, tau]")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Pair, A::Error> {
                let mut values = Vec::new();
                while let Some(value) = list.next_element::<f64>()? {
                    values.push(value);
                }
                let pair = values.try_into();
                pair.map(Pair).map_err(|values: Vec<f64>| {
                    A::Error::custom(format_args!(
                        "must be a list of pairs [g, tau]; one of them has {}",
                        rc_core::quantity::count(values.len(), "number")
                    ))
                })
            }
        }
        deserializer.deserialize_any(PairVisitor)
    }
}

/// A fractional Zener solid: the table `{ alpha = 0.2, glassy_ratio = 10, tau = 1e-3 }`, or the text `0.2,10,1e-3`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FractionalSpec {
    /// Exponent α, in (0, 1].
    pub alpha: f64,
    /// E0/E∞.
    pub glassy_ratio: f64,
    /// Relaxation time (s).
    pub tau: f64,
}

impl fmt::Display for FractionalSpec {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{},{},{}", self.alpha, self.glassy_ratio, self.tau)
    }
}

impl FromStr for FractionalSpec {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong =
            || format!("must be alpha, glassy ratio and relaxation time (s), such as 0.2,10,1e-3, not '{text}'");
        let words: Vec<&str> = text.split(',').map(str::trim).collect();
        let [alpha, glassy_ratio, tau] = words[..] else { return Err(wrong()) };
        let number = |word: &str| word.parse().map_err(|_| wrong());
        Ok(Self { alpha: number(alpha)?, glassy_ratio: number(glassy_ratio)?, tau: time::parse(tau)? })
    }
}

impl Serialize for FractionalSpec {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl<'de> Deserialize<'de> for FractionalSpec {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(deny_unknown_fields)]
        struct Table {
            alpha: f64,
            glassy_ratio: f64,
            tau: f64,
        }
        struct FractionalVisitor;
        impl<'de> Visitor<'de> for FractionalVisitor {
            type Value = FractionalSpec;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a table such as { alpha = 0.2, glassy_ratio = 10, tau = 1e-3 }")
            }

            fn visit_str<E: Error>(self, text: &str) -> Result<FractionalSpec, E> {
                text.parse().map_err(E::custom)
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<FractionalSpec, A::Error> {
                let Table { alpha, glassy_ratio, tau } = Table::deserialize(MapAccessDeserializer::new(map))?;
                Ok(FractionalSpec { alpha, glassy_ratio, tau })
            }
        }
        deserializer.deserialize_any(FractionalVisitor)
    }
}
