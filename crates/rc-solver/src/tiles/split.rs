//! The splits of the kernel for fresh gaps, and their errors.

use rc_kernel::SplitParams;

/// A split of the kernel with bounds on its error.
///
/// The bounds are measured, with a margin, by the tests of `operator_error/` and of `operator/tests.rs`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct GapSplit {
    pub(crate) params: SplitParams,
    /// Bound on the error of a displacement, for each level above the base grid.
    ///
    /// It holds at any element, and is relative to the maximum displacement.
    pub(crate) error: f64,
    /// Bound on the error of a displacement, relative to the pressure's [`crate::tiles::roughness::roughness`].
    ///
    /// It holds at any element.
    pub(crate) error_of_roughness: f64,
    /// Index among the splits, fastest first.
    index: usize,
}

/// Number of splits.
pub(crate) const N_SPLITS: usize = 3;

/// Splits, fastest first: the error that chooses the split, and two bounds on its errors.
///
/// The error is that of [`SplitParams::for_error`]. The bounds are for smooth and for rough displacements. On solved
/// contacts, the error was 0.1 to 0.8 of the sum of both bounds.
const SPLITS: [(f64, [f64; 2]); N_SPLITS] = [(1e-6, [1e-6, 4e-5]), (2e-9, [1e-8, 1.2e-7]), (1e-10, [2e-10, 6e-9])];

/// Maximum cutoff for which single precision is accurate enough.
const SINGLE_PRECISION_CUTOFF: usize = 8;

impl GapSplit {
    /// The fastest split whose error of a displacement is at most `bound`.
    ///
    /// `None` if there is no such split.
    pub(crate) fn for_error(bound: f64) -> Option<Self> {
        let index = SPLITS.iter().position(|(error, _)| *error <= bound)?;
        let (chosen_by, [error, error_of_roughness]) = SPLITS[index];
        Some(Self { params: SplitParams::for_error(chosen_by)?, error, error_of_roughness, index })
    }

    /// Index among the splits, fastest first.
    pub(crate) fn index(self) -> usize {
        self.index
    }

    /// The fastest split, in single precision.
    pub(crate) fn fastest() -> Self {
        Self::for_error(SPLITS[0].0).expect("a split for the largest error")
    }

    /// The most accurate split.
    pub(crate) fn most_accurate() -> Self {
        Self::for_error(SplitParams::SMALLEST_ERROR).expect("a split for the smallest error")
    }

    /// The next more accurate split.
    pub(crate) fn finer(self) -> Option<Self> {
        let mut splits = SPLITS.into_iter().filter_map(|(error, _)| Self::for_error(error));
        splits.find(|split| split.params.cutoff > self.params.cutoff)
    }

    /// Whether single precision is enough for the split.
    pub(crate) fn is_single_precision(self) -> bool {
        self.params.cutoff <= SINGLE_PRECISION_CUTOFF
    }
}
