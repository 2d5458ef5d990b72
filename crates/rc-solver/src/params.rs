//! Parameters of a solve.

/// How accurately, and within which limits, a contact problem is solved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct IterationParams {
    /// Bound on [`crate::Certificate::complementarity`] and [`crate::Certificate::penetration`]; both are relative to the
    /// peak-to-valley height h_max - h_min.
    pub tolerance: f64,
    /// Largest number of iterations on any one level.
    pub max_iterations: usize,
}

impl IterationParams {
    /// The smallest tolerance that can be certified: below it the rounding of L p in double precision decides.
    pub(crate) const SMALLEST_TOLERANCE: f64 = 1e-13;

    /// Certified to 1e-6 of the peak-to-valley height: area and rms pressure are then exact to about five digits.
    #[must_use]
    pub(crate) fn certified() -> Self {
        Self { tolerance: 1e-6, max_iterations: 2000 }
    }
}
