//! How the kernel is split.

/// How the kernel is split.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SplitParams {
    /// Cutoff of the short-range stencil, in elements of its level.
    pub cutoff: usize,
    /// Shape β of the Kaiser-Bessel window: the larger, the faster the remainder's spectrum falls, and the later.
    pub shape: f64,
    /// Taps of the filter between two levels, an even number.
    pub taps: usize,
}

impl SplitParams {
    /// The smallest error that [`SplitParams::for_error`] promises.
    pub const SMALLEST_ERROR: f64 = 1e-10;

    /// For corrections of a pressure that is known otherwise: relative error of v below 2e-3 on the pressures of
    /// contacts, and of a few percent on pressures as rough as corrections are.
    #[must_use]
    pub fn quick() -> Self {
        Self { cutoff: 3, shape: 3.0, taps: 4 }
    }

    /// Relative error of v below 1e-6 on the pressures of contacts.
    #[must_use]
    pub fn certified() -> Self {
        Self { cutoff: 8, shape: 10.0, taps: 16 }
    }

    /// The cheapest split whose error of v, relative to its rms, is below `bound` on pressures of contacts: with
    /// square-root edges, on random meshes of up to three levels above a base grid on which contacts are a few elements
    /// wide (test `one_application_agrees_with_exact_sums` of rc-solver). On white noise it is 4 to 7 times the bound
    /// for 1e-6, 10 to 20 times for 2e-9. `None` when the bound is below [`SplitParams::SMALLEST_ERROR`] or not a
    /// number.
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
