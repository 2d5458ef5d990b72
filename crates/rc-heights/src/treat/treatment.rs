//! The treatments, as plain data.

use std::fmt;

use rc_core::Grid;

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
    /// Take short waves away with a Gaussian filter that halves waves of this length (ISO 16610-61), which must be four
    /// points or more: weights at points cannot tell shorter waves from longer ones.
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

/// The part that is kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Crop {
    /// The largest square in the middle, by its lengths: what every method takes.
    Square,
    /// So many points, in the middle or from a first point on.
    Points {
        /// Points along x.
        nx: usize,
        /// Points along y.
        ny: usize,
        /// The first point along x and y; `None` for the middle.
        from: Option<[usize; 2]>,
    },
}

impl fmt::Display for Crop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Square => f.write_str("square"),
            Self::Points { nx, ny, from: None } => write!(f, "{nx}x{ny}"),
            Self::Points { nx, ny, from: Some([x, y]) } => write!(f, "{nx}x{ny}+{x}+{y}"),
        }
    }
}

/// How missing points get heights.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fill {
    /// The smoothest membrane through the points around (∇²h = 0): no new peaks, no new valleys.
    Laplace,
    /// The height of the nearest measured point, by length.
    Nearest,
    /// The lowest measured height: what was too deep or too steep to be measured does not touch.
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
    /// Peaks and valleys, as of a replica.
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

/// How opposite borders are made to meet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Periodic {
    /// They meet already.
    AsIs,
    /// The map and its mirror images: twice the sides, four times the points. Every height stays, and their
    /// distribution; slopes change sign at the old borders, and what touches there touches twice as wide.
    Mirror,
    /// Heights fade to their mean towards the borders (Tukey's window). Sides stay; the outer part of the map is
    /// flatter than the surface was.
    Window {
        /// The part of each side that fades, at each of its ends: above 0, at most 0.5.
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

/// How often a map is repeated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Repeat {
    /// As often as makes the cell a square, at most [`MOST_COPIES`] times along a side: the same contact, in a cell
    /// that every method takes.
    Square,
    /// So often along x and along y.
    Times([usize; 2]),
}

/// Most copies along a side.
pub const MOST_COPIES: usize = 16;

impl fmt::Display for Repeat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Square => f.write_str("square"),
            Self::Times([x, y]) => write!(f, "{x}x{y}"),
        }
    }
}

/// The form that is taken away; each holds the ones before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// The mean height.
    Mean,
    /// A plane: the tilt of the sample.
    Plane,
    /// A polynomial of degree two: tilt and curvature.
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
