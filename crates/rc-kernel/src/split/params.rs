//! Parameters of the split of the kernel.

/// Parameters of the split of the kernel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SplitParams {
    /// Cutoff of the short-range stencil, in elements of its level.
    pub cutoff: usize,
    /// Shape β of the Kaiser-Bessel window.
    ///
    /// With a larger β the spectrum of the remainder decreases faster, but starts to decrease later.
    pub shape: f64,
    /// Number of taps of the filter between two levels, even.
    pub taps: usize,
}

impl SplitParams {
    /// The smallest error that [`SplitParams::for_error`] guarantees.
    pub const SMALLEST_ERROR: f64 = 1e-10;

    /// Parameters for corrections of a pressure that is known by other means.
    ///
    /// The relative error of v is below 2e-3 on the pressures of contacts. It is a few percent on pressures as rough as
    /// corrections.
    #[must_use]
    pub fn quick() -> Self {
        Self { cutoff: 3, shape: 3.0, taps: 4 }
    }

    /// Parameters with a relative error of v below 1e-6 on the pressures of contacts.
    #[must_use]
    pub fn certified() -> Self {
        Self { cutoff: 8, shape: 10.0, taps: 16 }
    }

    /// The cheapest split with an error of v, relative to its rms, below `bound`.
    ///
    /// The bound holds for pressures of contacts, which have square-root edges. It was tested on random meshes of up to
    /// three levels above a base grid on which contacts are a few elements wide (test
    /// `one_application_agrees_with_exact_sums` of rc-solver). On white noise the error is 4 to 7 times the bound for
    /// 1e-6, and 10 to 20 times for 2e-9.
    ///
    /// `None` when the bound is below [`SplitParams::SMALLEST_ERROR`] or not a number.
    #[must_use]
    pub fn for_error(bound: f64) -> Option<Self> {
        match bound {
            2e-3.. => Some(Self::quick()),
            1e-6.. => Some(Self::certified()),
            2e-9.. => Some(Self { cutoff: 12, shape: 15.0, taps: 22 }),
            Self::SMALLEST_ERROR.. => Some(Self { cutoff: 16, shape: 19.0, taps: 26 }),
            _ => None,
        }
    }
}
