//! The tolerance of a solve, and `auto`: as accurate as the discretisation deserves.

/// Bound on the certificate's complementarity and penetration errors, both relative to the peak-to-valley height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tolerance {
    /// A number between [`Tolerance::SMALLEST`] and 1.
    Relative(f64),
    /// Well below the error of the discretisation: 3e-5 (m/8)^(-3/2) for m elements per shortest wave, 1e-5 for a height map.
    Auto,
}

impl Tolerance {
    /// The smallest tolerance that can be certified: below it the rounding of L p in double precision decides.
    pub const SMALLEST: f64 = 1e-13;

    /// The tolerance as a number, for a grid with this many elements per shortest wave (`None` for a height map, whose waves are not
    /// known).
    #[must_use]
    pub fn relative(self, elements_per_wave: Option<f64>) -> f64 {
        match self {
            Self::Relative(value) => value,
            Self::Auto => auto_tolerance(elements_per_wave),
        }
    }
}

/// Tolerance at [`REFERENCE`] elements per shortest wave.
const AT_REFERENCE: f64 = 3e-5;

/// Elements per shortest wave to which [`AT_REFERENCE`] belongs.
const REFERENCE: f64 = 8.0;

/// Order in the element side at which the error of the discretisation falls.
const ORDER: f64 = 1.5;

/// Bounds: what any picture needs, and what a grid that fits into memory is never as accurate as.
const LARGEST: f64 = 1e-3;
const SMALLEST: f64 = 1e-8;

/// For a height map, whose shortest wave is not known.
const OF_MAP: f64 = 1e-5;

/// The tolerance, relative to the peak-to-valley height, at which the error of the iteration is well below that of the
/// discretisation: 3e-5 (m/8)^(-3/2) with m elements per shortest wave, from 1e-8 to 1e-3; 1e-5 for a height map
/// (`None`).
///
/// Errors of rms pressure and area fall about as the power 1.5 of the element side, which the model follows. Measured for
/// N = 16, 4 to 32 elements per wave and 1 % and 7 % contact, summed over four surfaces: the iteration changes area, rms
/// pressure and penetration by at most 0.15 of what halving the elements changes. (With 1e-4 for 3e-5 it is 0.30, and about one
/// iteration less.) Test `auto_stops_well_below_the_error_of_the_grid` of the command line repeats part of it.
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
        let cases = [(Some(32.0), 3.75e-6), (Some(0.1), LARGEST), (Some(1e6), SMALLEST), (None, OF_MAP)];
        for (elements, expected) in cases {
            let relative = Tolerance::Auto.relative(elements) / expected - 1.0;
            assert!(relative.abs() < 1e-12, "{elements:?} elements: off by {relative:e}");
        }
    }
}
