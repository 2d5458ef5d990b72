//! The treatments.

use std::fmt;

use rc_core::Grid;

use super::crop::Crop;
use super::fill::Fill;
use super::flip::Flip;
use super::level::Level;
use super::periodic::Periodic;
use super::repeat::Repeat;

/// One treatment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Treatment {
    /// Keep a part.
    Crop(Crop),
    /// Mirror.
    Flip(Flip),
    /// Give missing points heights.
    Fill(Fill),
    /// Take a form away.
    Level(Level),
    /// Make opposite borders meet.
    Periodic(Periodic),
    /// Take short waves away with a Gaussian filter that halves waves of this length (ISO 16610-61), which must be four points or
    /// more: weights at points cannot tell shorter waves from longer ones.
    LowPass {
        /// In the unit of the sides.
        wavelength: f64,
    },
    /// Other numbers of points on the same rectangle.
    Resample(Grid),
    /// Copies beside each other.
    Repeat(Repeat),
}

impl fmt::Display for Treatment {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Crop(crop) => write!(f, "crop {crop}"),
            Self::Flip(axis) => write!(f, "flip {axis}"),
            Self::Fill(how) => write!(f, "fill {how}"),
            Self::Level(form) => write!(f, "level {form}"),
            Self::Periodic(how) => write!(f, "periodic {how}"),
            Self::LowPass { wavelength } => write!(f, "low-pass {wavelength:e}"),
            Self::Resample(grid) => write!(f, "resample {grid}"),
            Self::Repeat(repeat) => write!(f, "repeat {repeat}"),
        }
    }
}
