//! Doubts about an input or a result, each with a code.
//!
//! This is the data of a warning. Who computes the numbers decides when one is due.

use std::fmt;

use serde::{Deserialize, Serialize};

/// A doubt about an input or a result.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Warning {
    /// The kind of doubt, for programs.
    pub code: WarningCode,
    /// What is doubtful and what would help, in one line.
    pub text: String,
}

/// The kind of a [`Warning`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum WarningCode {
    /// Heights are probably in another unit than the cell.
    Units,
    /// Slopes are too large for the theory of small slopes.
    Slope,
    /// Pressures are too large for the theory of small strains.
    Load,
    /// Single points stand out from all their neighbours.
    Spikes,
    /// Many points were not measured, but filled.
    Missing,
    /// Values look like marks of missing points.
    Marks,
    /// A row or column looks like line numbers.
    Counter,
    /// A map has so few columns or rows that it may be a table of something else.
    Columns,
    /// A unit, a size or a spacing was assumed.
    Assumed,
    /// The map does not repeat itself, but is solved as if it did.
    Border,
    /// A map with a lay was mirrored.
    Mirror,
    /// The twin of a map that is tilted.
    Tilt,
    /// The grid is too coarse.
    Coarse,
    /// Heights jump at the edges of contacts.
    Edges,
    /// A solid that creeps would have to pull.
    Creep,
}

impl Warning {
    /// A warning with this code and text.
    #[must_use]
    pub fn new(code: WarningCode, text: impl Into<String>) -> Self {
        Self { code, text: text.into() }
    }
}

impl WarningCode {
    /// All codes.
    pub const ALL: [Self; 15] = [
        Self::Units,
        Self::Slope,
        Self::Load,
        Self::Spikes,
        Self::Missing,
        Self::Marks,
        Self::Counter,
        Self::Columns,
        Self::Assumed,
        Self::Border,
        Self::Mirror,
        Self::Tilt,
        Self::Coarse,
        Self::Edges,
        Self::Creep,
    ];

    /// What the code means, in a few words.
    #[must_use]
    pub fn meaning(self) -> &'static str {
        match self {
            Self::Units => "units of heights or the size are doubtful",
            Self::Slope => "slopes are too steep for the theory",
            Self::Load => "pressures are too large for the theory",
            Self::Spikes => "single points stand far from all neighbours",
            Self::Missing => "many points were filled",
            Self::Marks => "heights look like marks of missing points",
            Self::Counter => "a row or column looks like line numbers",
            Self::Columns => "the map has very few rows or columns",
            Self::Assumed => "a unit, a size or a spacing was assumed",
            Self::Border => "the map does not repeat itself",
            Self::Mirror => "a map with a lay was mirrored",
            Self::Tilt => "a twin has the tilt of its map",
            Self::Coarse => "the grid is too coarse",
            Self::Edges => "heights jump at contact edges",
            Self::Creep => "pressure falls somewhere while the contact grows",
        }
    }

    /// The code as text.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Units => "units",
            Self::Slope => "slope",
            Self::Load => "load",
            Self::Spikes => "spikes",
            Self::Missing => "missing",
            Self::Marks => "marks",
            Self::Counter => "counter",
            Self::Columns => "columns",
            Self::Assumed => "assumed",
            Self::Border => "border",
            Self::Mirror => "mirror",
            Self::Tilt => "tilt",
            Self::Coarse => "coarse",
            Self::Edges => "edges",
            Self::Creep => "creep",
        }
    }
}

impl fmt::Display for WarningCode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_code_is_written_as_its_name() {
        let warning = Warning::new(WarningCode::Spikes, "8 points");
        let json = serde_json::to_string(&warning).expect("JSON");
        assert_eq!(json, r#"{"code":"spikes","text":"8 points"}"#);
        assert_eq!(serde_json::from_str::<Warning>(&json).expect("a warning"), warning);
        assert_eq!(warning.code.to_string(), "spikes");
    }
}
