//! The treatments, as plain data.

use std::fmt;

use rc_core::Grid;

/// One treatment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Treatment {
    /// Keep a part of the map.
    Crop(Crop),
    /// Mirror the map.
    Flip(Flip),
    /// Replace isolated points far from their neighbours ([`crate::suspicion::spike_points`]).
    Despike {
        /// Robust standard deviations from the median of the neighbours that make a spike, 3 or more.
        sigma: f64,
    },
    /// Give heights to missing points.
    Fill(Fill),
    /// Remove a form.
    Level(Level),
    /// Make opposite borders match.
    Periodic(Periodic),
    /// Remove short waves with a Gaussian filter (ISO 16610-61).
    ///
    /// The filter halves waves of length `wavelength`, which must be at least four points. Weights at points cannot
    /// represent shorter waves.
    LowPass {
        /// Cut-off wavelength, in the unit of the sides.
        wavelength: f64,
    },
    /// Remove long waves: the map minus its mean by the same filter (L-filter of ISO 25178-3).
    ///
    /// Waves of length `wavelength` keep half of their amplitude.
    HighPass {
        /// Cut-off wavelength, in the unit of the sides.
        wavelength: f64,
    },
    /// Change the numbers of points on the same rectangle.
    Resample(Grid),
    /// Keep every second point along both axes, as of a measurement with twice the spacing.
    ///
    /// A last point without a successor goes too.
    EverySecond,
    /// Put copies beside each other.
    Repeat(Repeat),
}

impl fmt::Display for Treatment {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Crop(crop) => write!(f, "crop {crop}"),
            Self::Flip(axis) => write!(f, "flip {axis}"),
            Self::Despike { sigma } => write!(f, "despike {sigma}"),
            Self::Fill(how) => write!(f, "fill {how}"),
            Self::Level(form) => write!(f, "level {form}"),
            Self::Periodic(how) => write!(f, "periodic {how}"),
            Self::LowPass { wavelength } => write!(f, "low-pass {wavelength:e}"),
            Self::HighPass { wavelength } => write!(f, "high-pass {wavelength:e}"),
            Self::Resample(grid) => write!(f, "resample {grid}"),
            Self::EverySecond => f.write_str("every second point"),
            Self::Repeat(repeat) => write!(f, "repeat {repeat}"),
        }
    }
}

/// The part that is kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Crop {
    /// The measured rectangle: border rows and columns with more missing than measured points are cut.
    Measured,
    /// The largest square in the middle, by its lengths. Every method accepts it.
    Square,
    /// A number of points, in the middle or from a first point on.
    Points {
        /// Points along x.
        nx: usize,
        /// Points along y.
        ny: usize,
        /// The first point along x and y, or `None` for the middle.
        from: Option<[usize; 2]>,
    },
}

impl fmt::Display for Crop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Measured => f.write_str("measured"),
            Self::Square => f.write_str("square"),
            Self::Points { nx, ny, from: None } => write!(f, "{nx}x{ny}"),
            Self::Points { nx, ny, from: Some([x, y]) } => write!(f, "{nx}x{ny}+{x}+{y}"),
        }
    }
}

/// Method that gives heights to missing points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fill {
    /// A smooth membrane through the points around (∇²h = 0), without new peaks or valleys.
    Laplace,
    /// The height of the measured point at the smallest distance.
    Nearest,
    /// The lowest measured height.
    ///
    /// Points that were too deep or too steep to be measured then have no contact.
    Lowest,
}

impl fmt::Display for Fill {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Laplace => "laplace",
            Self::Nearest => "nearest",
            Self::Lowest => "lowest",
        })
    }
}

/// The axis that is reversed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Flip {
    /// Left and right.
    X,
    /// Top and bottom.
    Y,
    /// Peaks and valleys, as for a replica.
    Z,
}

impl fmt::Display for Flip {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::X => "x",
            Self::Y => "y",
            Self::Z => "z",
        })
    }
}

/// Method that makes opposite borders match.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Periodic {
    /// The borders match already.
    AsIs,
    /// The map and its mirror images, with twice the sides and four times the points.
    ///
    /// Every height and the distribution of heights stay the same. Slopes change sign at the old borders. A contact
    /// there is twice as wide.
    Mirror,
    /// Heights above the lowest one decrease to 0 towards the borders (Tukey's window).
    ///
    /// Sides stay the same. No height increases, and the border is the last to touch.
    Window {
        /// Part of each side at each end where heights decrease, above 0 and at most 0.5.
        taper: f64,
    },
}

impl fmt::Display for Periodic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::AsIs => f.write_str("as-is"),
            Self::Mirror => f.write_str("mirror"),
            Self::Window { taper } => write!(f, "window, taper {taper}"),
        }
    }
}

/// Number of copies of a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Repeat {
    /// The smallest numbers of copies that make the cell a square.
    ///
    /// There are at most [`MOST_COPIES`] copies along a side. The contact is the same, and every method accepts the
    /// cell.
    Square,
    /// Given numbers of copies along x and along y.
    Times([usize; 2]),
}

/// Maximum number of copies along a side.
pub const MOST_COPIES: usize = 16;

impl fmt::Display for Repeat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Square => f.write_str("square"),
            Self::Times([x, y]) => write!(f, "{x}x{y}"),
        }
    }
}

/// The form that is removed. Each form includes those before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// The mean height.
    Mean,
    /// A plane, the tilt of the sample.
    Plane,
    /// A polynomial of degree two, tilt and curvature.
    Quadratic,
}

impl fmt::Display for Level {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Mean => "mean",
            Self::Plane => "plane",
            Self::Quadratic => "quadratic",
        })
    }
}
