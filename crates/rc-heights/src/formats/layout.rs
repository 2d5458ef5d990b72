//! Layout of the numbers of a text.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Deserializer, Serialize, Serializer};
use thiserror::Error;

use super::Format;

/// Layout of the numbers of a text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// Each line is a row of the map.
    Matrix,
    /// Each line is a point: x, y, height.
    Xyz,
}

/// An unknown name of a layout.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("'{name}' is not a layout; give matrix (each line is a row of the map) or xyz (each line is a point)")]
pub struct LayoutError {
    /// The name as written.
    pub name: String,
}

impl fmt::Display for Layout {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Matrix => "matrix",
            Self::Xyz => "xyz",
        })
    }
}

impl FromStr for Layout {
    type Err = LayoutError;

    fn from_str(text: &str) -> Result<Self, LayoutError> {
        match text {
            "matrix" => Ok(Self::Matrix),
            "xyz" => Ok(Self::Xyz),
            other => Err(LayoutError { name: other.to_owned() }),
        }
    }
}

impl Serialize for Layout {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl<'de> Deserialize<'de> for Layout {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        String::deserialize(deserializer)?.parse().map_err(serde::de::Error::custom)
    }
}

/// The format of a text in the layout that the user gives. Other formats stay as they are.
pub(super) fn format(known: Format, layout: Option<Layout>) -> Format {
    match (known, layout) {
        (Format::Csv | Format::Xyz, Some(Layout::Matrix)) => Format::Csv,
        (Format::Csv | Format::Xyz, Some(Layout::Xyz)) => Format::Xyz,
        (known, _) => known,
    }
}
