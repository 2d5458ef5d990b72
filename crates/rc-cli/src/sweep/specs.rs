//! Values of flags of `rc sweep`: a shard, a number of commands, a quantity.

use std::num::NonZeroUsize;
use std::str::FromStr;

use rc_sweep::Shard;

/// Quantities that can be averaged.
///
/// They are numbers that converge as grids become finer. Every row has them, but for the friction, which needs a speed.
pub(crate) const QUANTITIES: [&str; 10] = [
    "area_fraction",
    "penetration",
    "mean_pressure",
    "mean_gap",
    "rms_pressure_corrected",
    "contact_perimeter",
    "contact_stiffness",
    "elastic_energy",
    "h_max",
    "friction",
];

/// The shard in its written form: `2/8`, `auto`, or `auto/8`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ShardSpec {
    /// The shard with this number.
    Given(Shard),
    /// The shard that the job system or MPI launcher tells.
    ///
    /// The number is that of all shards, if it is given.
    Auto(Option<usize>),
}

impl FromStr for ShardSpec {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let Some(rest) = text.strip_prefix("auto") else {
            return text.parse().map(Self::Given).map_err(|_| {
                format!("a shard is i/n with i from 1 to n, such as 2/8; or auto, or auto/8, not '{text}'")
            });
        };
        let count = rest.strip_prefix('/').map(|count| count.trim().parse().ok().filter(|&count| count > 0));
        match (rest, count) {
            ("", _) => Ok(Self::Auto(None)),
            (_, Some(Some(count))) => Ok(Self::Auto(Some(count))),
            _ => Err(format!("auto may be followed by the number of parts, as auto/8, not '{text}'")),
        }
    }
}

/// The number of commands in its written form: a number, or `rows`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ListSpec {
    /// One command for each row.
    EachRow,
    /// This number of commands.
    Parts(NonZeroUsize),
}

impl ListSpec {
    /// Text of the default, one command for each row.
    pub(crate) const ROWS: &'static str = "rows";

    /// The number of commands for a sweep of `rows` rows.
    pub(super) fn count(self, rows: usize) -> usize {
        match self {
            Self::EachRow => rows,
            Self::Parts(count) => count.get(),
        }
    }
}

impl FromStr for ListSpec {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let refuse =
            |_| format!("give a number of parts, such as 64, or the word 'rows' (one part per row), not '{text}'");
        if text == Self::ROWS { Ok(Self::EachRow) } else { text.parse().map(Self::Parts).map_err(refuse) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_is_given_or_found_out() {
        assert_eq!("2/8".parse(), Ok(ShardSpec::Given(Shard { index: 2, count: 8 })));
        assert_eq!("auto".parse(), Ok(ShardSpec::Auto(None)));
        assert_eq!("auto/8".parse(), Ok(ShardSpec::Auto(Some(8))));
        for text in ["", "9/8", "auto/", "auto/0", "auto/x", "auto8", "automatic"] {
            let error = text.parse::<ShardSpec>().expect_err(text);
            assert!(error.contains("auto/8"), "'{text}': {error}");
        }
    }
}
