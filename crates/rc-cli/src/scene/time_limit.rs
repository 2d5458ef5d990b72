//! Time limits in the form that people write: `90`, `90s`, `5min`, `1h 30m`.

use std::fmt;
use std::str::FromStr;
use std::time::Duration;

use rc_sweep::number_or_text;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// A time above zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TimeLimit(pub Duration);

impl fmt::Display for TimeLimit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        humantime::format_duration(self.0).fmt(f)
    }
}

impl FromStr for TimeLimit {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let seconds = text.trim().parse().ok().and_then(|seconds: f64| Duration::try_from_secs_f64(seconds).ok());
        let time = seconds.or_else(|| humantime::parse_duration(text).ok()).filter(|time| !time.is_zero());
        time.map(Self).ok_or_else(|| {
            format!("a time is a number of seconds above 0, or has units, such as 90s, 5min or 1h 30m, not '{text}'")
        })
    }
}

impl Serialize for TimeLimit {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_f64(self.0.as_secs_f64())
    }
}

impl<'de> Deserialize<'de> for TimeLimit {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        number_or_text(deserializer, "a number of seconds above 0, or \"90s\", \"5min\", \"1h 30m\"")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_numbers_or_have_units() {
        for (text, seconds) in [("90", 90.0), ("0.5", 0.5), ("90s", 90.0), ("5min", 300.0), ("1h 30m", 5400.0)] {
            assert_eq!(text.parse(), Ok(TimeLimit(Duration::from_secs_f64(seconds))), "{text}");
        }
        for text in ["", "0", "-1", "nan", "inf", "1e300", "5 parsecs", "0s"] {
            assert!(text.parse::<TimeLimit>().is_err(), "'{text}' was read as a time");
        }
    }
}
