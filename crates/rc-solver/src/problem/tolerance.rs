//! The user's tolerance, and the bound on the certificate.
//!
//! The bound follows from the tolerance.

/// The accuracy to which a contact problem is solved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tolerance {
    /// Bound on [`crate::Certificate::energy`], from [`Tolerance::SMALLEST_ENERGY`] to 1.
    ///
    /// It does not depend on the height range. A pit, a raised surface and a light load are solved as accurately as any
    /// other scene.
    Energy(f64),
    /// Bound on [`crate::Certificate::complementarity`] and [`crate::Certificate::penetration`].
    ///
    /// They are relative to the peak-to-valley height. The bound is a number between [`Tolerance::SMALLEST`] and 1.
    /// Many other programs use such a tolerance. A single deep point in the heights makes it less strict.
    Relative(f64),
    /// An energy error well below the error of the discretisation.
    ///
    /// It is 0.06 (m/8)^(-3/4) for m elements per shortest wave, and 0.03 for a height map.
    Auto,
}

impl Tolerance {
    /// The smallest relative tolerance that can be certified.
    ///
    /// Below it, rounding of L p in double precision is larger than the tolerance.
    pub const SMALLEST: f64 = 1e-13;

    /// The smallest energy error that can be certified. Rounding bounds its square.
    pub const SMALLEST_ENERGY: f64 = 1e-5;

    /// The default tolerance: an energy error of 1e-2.
    ///
    /// The iteration goes to three tenths of the bound. Area, rms pressure and penetration are then those of the
    /// discrete problem to about 1e-5.
    pub const DEFAULT: Self = Self::Energy(1e-2);

    /// The bound on the certificate, for a grid with this many elements per shortest wave.
    ///
    /// `None` stands for a height map, whose waves are not known.
    #[must_use]
    pub fn bound(self, elements_per_wave: Option<f64>) -> ErrorBound {
        match self {
            Self::Energy(value) => ErrorBound::Energy(value),
            Self::Relative(value) => ErrorBound::Relative(value),
            Self::Auto => ErrorBound::Energy(auto_tolerance(elements_per_wave)),
        }
    }
}

impl From<ErrorBound> for Tolerance {
    /// The tolerance with this bound on every grid.
    fn from(bound: ErrorBound) -> Self {
        match bound {
            ErrorBound::Energy(value) => Self::Energy(value),
            ErrorBound::Relative(value) => Self::Relative(value),
        }
    }
}

/// The bound that a certificate must meet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ErrorBound {
    /// Bound on [`crate::Certificate::energy`].
    Energy(f64),
    /// Bound on [`crate::Certificate::complementarity`] and [`crate::Certificate::penetration`].
    Relative(f64),
}

impl ErrorBound {
    /// The bound as a number.
    #[must_use]
    pub fn value(self) -> f64 {
        match self {
            Self::Energy(value) | Self::Relative(value) => value,
        }
    }

    /// The smallest bound of this kind that can be certified.
    #[must_use]
    pub fn smallest(self) -> f64 {
        match self {
            Self::Energy(_) => Tolerance::SMALLEST_ENERGY,
            Self::Relative(_) => Tolerance::SMALLEST,
        }
    }

    /// The length that the deepest overlap is compared with.
    pub(crate) fn measure(self) -> Measure {
        match self {
            Self::Energy(_) => Measure::Energy,
            Self::Relative(_) => Measure::HeightRange,
        }
    }

    /// The bound on the deepest overlap δ, in units of the length of the [`Measure`].
    ///
    /// G/U = σ0 δ/U is the square of the energy error.
    pub(crate) fn overlap(self) -> f64 {
        match self {
            Self::Energy(value) => value * value,
            Self::Relative(value) => value,
        }
    }

    /// The overlap of the computed gap at which an iteration ends.
    ///
    /// For a bound on the energy error, the iteration continues to [`AIM`] times the bound. Area, pressure and
    /// penetration have errors of its square, which two or three more iterations reduce to a tenth. The rest of the
    /// bound is left to the error of the operator.
    pub(crate) fn aim(self) -> f64 {
        match self {
            Self::Energy(value) => (AIM * value).powi(2),
            Self::Relative(value) => value,
        }
    }
}

impl std::fmt::Display for ErrorBound {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Energy(value) => write!(f, "an energy error of {value:e}"),
            Self::Relative(value) => write!(f, "{value:e} of the height range"),
        }
    }
}

/// Ratio of the aim of an iteration to the bound on its energy error ([`ErrorBound::aim`]).
const AIM: f64 = 0.3;

/// The length that the deepest overlap is compared with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Measure {
    /// H = h_max - h_min.
    HeightRange,
    /// U/σ0, the ratio of elastic energy to mean pressure.
    Energy,
}

impl Measure {
    /// Tolerance of a coarser level. `below` is 0 for the level below the finest.
    ///
    /// The discretisation error of that level is far above its tolerance. Levels further down only prepare the next
    /// one. Each may be solved less accurately by [`COARSENING`], up to a limit.
    pub(crate) fn coarse_tolerance(self, below: usize) -> f64 {
        let (tolerance, coarsest) = match self {
            Self::HeightRange => (1e-4, 1e-3),
            // U/σ0 is 0.02 to 0.08 H on rough surfaces.
            Self::Energy => (2e-3, 2e-2),
        };
        (tolerance * COARSENING.powi(below as i32)).min(coarsest)
    }

    /// An overlap as users know it, from one in units of the measure's length.
    pub(crate) fn shown(self, overlap: f64) -> f64 {
        match self {
            Self::HeightRange => overlap,
            Self::Energy => overlap.sqrt(),
        }
    }
}

/// Ratio of the tolerances of a level and the next finer one ([`Measure::coarse_tolerance`]).
const COARSENING: f64 = 3.0;

/// Energy error at [`REFERENCE`] elements per shortest wave.
const AT_REFERENCE: f64 = 6e-2;

/// Elements per shortest wave to which [`AT_REFERENCE`] belongs.
const REFERENCE: f64 = 8.0;

/// Order of the energy error in the element side.
///
/// Area and pressure change by the square of the energy error, and the error of the discretisation falls with the power
/// 1.5.
const ORDER: f64 = 0.75;

/// Bounds of the tolerance.
///
/// The largest is enough for any picture. No grid that fits into memory is as accurate as the smallest.
const LARGEST: f64 = 0.15;
const SMALLEST: f64 = 3e-3;

/// Energy error for a height map. Its shortest wave is not known.
const OF_MAP: f64 = 3e-2;

/// The energy error at which the iteration is well below the error of the discretisation.
///
/// It is 0.06 (m/8)^(-3/4) with m elements per shortest wave, from 3e-3 to 0.15. It is 0.03 for a height map (`None`).
///
/// Errors of area and rms pressure were measured to be less than the square of the energy error that is aimed at.
/// Errors of the discretisation fall about as the power 1.5 of the element side. The model follows this power. Test
/// `auto_stops_well_below_the_error_of_the_grid` of the command line compares the two.
fn auto_tolerance(elements_per_wave: Option<f64>) -> f64 {
    match elements_per_wave {
        Some(elements) => (AT_REFERENCE * (elements / REFERENCE).powf(-ORDER)).clamp(SMALLEST, LARGEST),
        None => OF_MAP,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tolerance_falls_with_the_elements_within_its_bounds() {
        let at_128 = AT_REFERENCE / 8.0;
        for (elements, expected) in [(Some(128.0), at_128), (Some(0.1), LARGEST), (Some(1e6), SMALLEST), (None, OF_MAP)]
        {
            let bound = Tolerance::Auto.bound(elements);
            assert_eq!(bound.measure(), Measure::Energy, "{elements:?} elements");
            assert!((bound.value() / expected - 1.0).abs() < 1e-12, "{elements:?} elements: {bound}");
        }
    }
}
