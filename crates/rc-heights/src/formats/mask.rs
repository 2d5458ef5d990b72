//! Masks of points, as files of Gwyddion have them.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Deserializer, Serialize, Serializer};
use thiserror::Error;

/// What a mask in a file means.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mask {
    /// Masked points are missing.
    #[default]
    Use,
    /// The mask is ignored.
    Ignore,
}

/// An unknown name of a [`Mask`].
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("'{name}' is not a use of a mask; give use (masked points are missing) or ignore")]
pub struct MaskError {
    /// The name as written.
    pub name: String,
}

impl fmt::Display for Mask {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Use => "use",
            Self::Ignore => "ignore",
        })
    }
}

impl FromStr for Mask {
    type Err = MaskError;

    fn from_str(text: &str) -> Result<Self, MaskError> {
        match text {
            "use" => Ok(Self::Use),
            "ignore" => Ok(Self::Ignore),
            other => Err(MaskError { name: other.to_owned() }),
        }
    }
}

impl Serialize for Mask {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl<'de> Deserialize<'de> for Mask {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        String::deserialize(deserializer)?.parse().map_err(serde::de::Error::custom)
    }
}
