//! Values of a scene that are more than a number: grids, tolerances, fractions.

use std::f64::consts::TAU;
use std::fmt;
use std::str::FromStr;

use clap::ValueEnum;
use rc_heights::npy::Precision;
use rc_solver::Tolerance;
use rc_sweep::number_or_text;
use serde::de::{self, Deserializer, Visitor};
use serde::{Deserialize, Serialize, Serializer};

/// Elements per side in their written form: `512`, or `512x256` (along x, along y).
///
/// The numbers are checked when the scene is resolved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GridSpec {
    /// Elements along x.
    pub nx: usize,
    /// Elements along y.
    pub ny: usize,
}

impl GridSpec {
    /// `n` elements along both sides.
    #[must_use]
    pub fn square(n: usize) -> Self {
        Self { nx: n, ny: n }
    }
}

impl fmt::Display for GridSpec {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.nx == self.ny { write!(f, "{}", self.nx) } else { write!(f, "{}x{}", self.nx, self.ny) }
    }
}

impl FromStr for GridSpec {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let expected = || format!("a grid is a number of elements per side such as 512, or 512x256, not '{text}'");
        let side = |side: &str| side.trim().parse::<usize>().map_err(|_| expected());
        match text.split_once('x') {
            Some((nx, ny)) => Ok(Self { nx: side(nx)?, ny: side(ny)? }),
            None => Ok(Self::square(side(text)?)),
        }
    }
}

impl Serialize for GridSpec {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if self.nx == self.ny { serializer.serialize_u64(self.nx as u64) } else { serializer.collect_str(self) }
    }
}

impl<'de> Deserialize<'de> for GridSpec {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct GridVisitor;
        impl Visitor<'_> for GridVisitor {
            type Value = GridSpec;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a number of elements per side such as 512, or \"512x256\"")
            }

            fn visit_i64<E: de::Error>(self, value: i64) -> Result<GridSpec, E> {
                let n = usize::try_from(value).map_err(|_| E::invalid_value(de::Unexpected::Signed(value), &self))?;
                Ok(GridSpec::square(n))
            }

            fn visit_str<E: de::Error>(self, value: &str) -> Result<GridSpec, E> {
                value.parse().map_err(E::custom)
            }
        }
        deserializer.deserialize_any(GridVisitor)
    }
}

/// Values that mark missing points in their written form: `-9999`, or `-9999,1e30`.
#[derive(Clone, Debug, PartialEq)]
pub struct Marks(pub Vec<f64>);

impl fmt::Display for Marks {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0.iter().map(f64::to_string).collect::<Vec<_>>().join(","))
    }
}

impl FromStr for Marks {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let mark = |word: &str| {
            let number = word.trim().parse::<f64>().ok().filter(|number| number.is_finite());
            number.ok_or_else(|| {
                format!("marks of missing points are numbers such as -9999, or -9999,1e30, not '{text}'")
            })
        };
        text.split(',').map(mark).collect::<Result<_, _>>().map(Self)
    }
}

impl Serialize for Marks {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl<'de> Deserialize<'de> for Marks {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        number_or_text(deserializer, "a number such as -9999, or \"-9999,1e30\"")
    }
}

/// The conductivities of both bodies in their written form: `400`, or `400,50`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conductivity(pub [f64; 2]);

impl Conductivity {
    /// Their harmonic mean 2 k1 k2/(k1 + k2), which the conductance of spots between the bodies is proportional to.
    #[must_use]
    pub fn mean(self) -> f64 {
        let [k1, k2] = self.0;
        2.0 / (k1.recip() + k2.recip())
    }
}

impl fmt::Display for Conductivity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{},{}", self.0[0], self.0[1])
    }
}

impl FromStr for Conductivity {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let value = |word: &str| word.trim().parse::<f64>().ok().filter(|k| k.is_normal() && *k > 0.0);
        let (k1, k2) = text.split_once(',').unwrap_or((text, text));
        value(k1).zip(value(k2)).map(|(k1, k2)| Self([k1, k2])).ok_or_else(|| {
            format!("conductivities are one or two positive numbers such as 400, or 400,50, not '{text}'")
        })
    }
}

impl Serialize for Conductivity {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl<'de> Deserialize<'de> for Conductivity {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        number_or_text(deserializer, "a number such as 400, or \"400,50\"")
    }
}

/// The convention of a tabulated spectrum.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub enum PsdConvention {
    /// ⟨h²⟩ = ∫ C d²q, as that of `c0` and `rc inspect`.
    #[default]
    Plain,
    /// ⟨h²⟩ = ∫ C d²q/4π².
    Fourier,
}

impl PsdConvention {
    /// C of this convention for C = 1 of `Plain`.
    #[must_use]
    pub fn factor(self) -> f64 {
        match self {
            Self::Plain => 1.0,
            Self::Fourier => TAU * TAU,
        }
    }
}

/// The height distribution of a twin.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub enum HeightsLike {
    /// Gaussian, from random phases.
    Gaussian,
    /// That of the map.
    Map,
}

/// Type of the numbers in files of fields.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub enum FilePrecision {
    /// `float32`.
    Single,
    /// `float64`.
    #[default]
    Double,
}

impl From<FilePrecision> for Precision {
    fn from(precision: FilePrecision) -> Self {
        match precision {
            FilePrecision::Single => Self::Single,
            FilePrecision::Double => Self::Double,
        }
    }
}

/// The tolerance in its written form: a number or `auto`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ToleranceSpec {
    /// Tolerance relative to the peak-to-valley height.
    Relative(f64),
    /// An energy error well below the error of the grid.
    Auto,
}

impl From<ToleranceSpec> for Tolerance {
    fn from(spec: ToleranceSpec) -> Self {
        match spec {
            ToleranceSpec::Relative(value) => Self::Relative(value),
            ToleranceSpec::Auto => Self::Auto,
        }
    }
}

impl FromStr for ToleranceSpec {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "auto" => Ok(Self::Auto),
            _ => text
                .parse()
                .map(Self::Relative)
                .map_err(|_| format!("a tolerance is a number such as 1e-6, or auto, not '{text}'")),
        }
    }
}

impl Serialize for ToleranceSpec {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Relative(value) => serializer.serialize_f64(*value),
            Self::Auto => serializer.serialize_str("auto"),
        }
    }
}

impl<'de> Deserialize<'de> for ToleranceSpec {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        number_or_text(deserializer, "a number such as 1e-6, or \"auto\"")
    }
}

/// A fraction in its written form, `0.5%` or `0.005`; above 0 and below 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fraction(pub f64);

impl FromStr for Fraction {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (number, unit) = text.strip_suffix('%').map_or((text, 1.0), |number| (number, 0.01));
        let value = number.trim().parse().map_or(f64::NAN, |value: f64| value * unit);
        let expected = || format!("a fraction is a number above 0 and below 1, such as 0.005 or 0.5%, not '{text}'");
        (value > 0.0 && value < 1.0).then_some(Self(value)).ok_or_else(expected)
    }
}

impl Serialize for Fraction {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_f64(self.0)
    }
}

impl<'de> Deserialize<'de> for Fraction {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        number_or_text(deserializer, "a number above 0 and below 1 such as 0.005, or \"0.5%\"")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fraction_is_a_number_or_a_percentage() {
        for (text, value) in [("0.005", 0.005), ("0.5%", 0.005), ("12 %", 0.12)] {
            let Fraction(read) = text.parse().expect("a fraction");
            assert!((read / value - 1.0).abs() < 1e-15, "{text} is {read}");
        }
        for text in ["", "%", "0", "1", "100%", "-1%", "nan", "inf%", "x"] {
            assert!(text.parse::<Fraction>().is_err(), "'{text}' was read as a fraction");
        }
    }

    #[test]
    fn marks_are_numbers_with_commas_between_them() {
        assert_eq!("-9999, 1e30".parse(), Ok(Marks(vec![-9999.0, 1e30])));
        assert_eq!(Marks(vec![-9999.0, 0.5]).to_string(), "-9999,0.5");
        for text in ["", "x", "1,,2", "inf"] {
            assert!(text.parse::<Marks>().is_err(), "'{text}' was read as marks");
        }
    }

    #[test]
    fn a_grid_reads_back_as_it_is_written() {
        for text in ["512", "512x256"] {
            let grid: GridSpec = text.parse().expect("a grid");
            assert_eq!(grid.to_string(), text);
        }
        for text in ["", "x", "5.5", "-4", "4x", "4x4x4"] {
            assert!(text.parse::<GridSpec>().is_err(), "'{text}' was read as a grid");
        }
    }
}
