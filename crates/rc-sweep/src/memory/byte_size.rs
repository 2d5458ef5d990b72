//! Sizes of memory in readable form: `500MB`, `2 GiB`, `1000000`.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::number_or_text::number_or_text;

/// A number of bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct ByteSize(pub u64);

/// Units by their names in lower case. Decimal units are first, for writing.
const UNITS: [(&str, f64); 10] = [
    ("", 1.0),
    ("b", 1.0),
    ("kb", 1e3),
    ("mb", 1e6),
    ("gb", 1e9),
    ("tb", 1e12),
    ("kib", 1024.0),
    ("mib", 1048576.0),
    ("gib", 1073741824.0),
    ("tib", 1099511627776.0),
];

impl fmt::Display for ByteSize {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let bytes = self.0 as f64;
        let (name, factor) = match bytes {
            ..1e6 => ("kB", 1e3),
            1e6..1e9 => ("MB", 1e6),
            1e9..1e12 => ("GB", 1e9),
            _ => ("TB", 1e12),
        };
        write!(f, "{} {name}", rc_core::quantity::digits(bytes / factor, 3))
    }
}

impl FromStr for ByteSize {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong =
            || format!("a size is a number of bytes, or one with a unit, such as 500MB, 2GB or 1GiB, not '{text}'");
        let text = text.trim();
        let end = text.find(|c: char| c.is_ascii_alphabetic()).unwrap_or(text.len());
        let (number, unit) = (text[..end].trim(), text[end..].to_ascii_lowercase());
        let number: f64 = number.parse().map_err(|_| wrong())?;
        let (_, factor) = UNITS.iter().find(|(name, _)| *name == unit).ok_or_else(wrong)?;
        let bytes = number * factor;
        // Beyond 2^53 a count of bytes is not exact, and no machine has such memory.
        if (1.0..=9e15).contains(&bytes) { Ok(Self(bytes as u64)) } else { Err(wrong()) }
    }
}

impl Serialize for ByteSize {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_u64(self.0)
    }
}

impl<'de> Deserialize<'de> for ByteSize {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        number_or_text(deserializer, "a number of bytes, or a size as \"500MB\"")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_read_with_and_without_unit() {
        let cases = [
            ("1000", 1000),
            ("500MB", 500_000_000),
            ("500 mb", 500_000_000),
            ("1.5GB", 1_500_000_000),
            ("2GiB", 2 << 30),
            ("7kB", 7000),
            ("1TB", 1_000_000_000_000),
        ];
        for (text, bytes) in cases {
            assert_eq!(text.parse(), Ok(ByteSize(bytes)), "{text}");
        }
        for text in ["", "MB", "-1", "0", "1XB", "nan", "inf", "1e99", "1 2MB", "µ"] {
            assert!(text.parse::<ByteSize>().is_err(), "'{text}' was read as a size");
        }
    }

    #[test]
    fn sizes_are_written_with_three_digits() {
        for (bytes, text) in [(500_000_000, "500 MB"), (23_400_000_000, "23.4 GB"), (1500, "1.5 kB")] {
            assert_eq!(ByteSize(bytes).to_string(), text);
        }
    }
}
