//! The splits of the kernel that fresh gaps are computed with, and their errors.

use rc_kernel::SplitParams;

/// A split of the kernel with bounds on its error, which are measured, with a margin, by the tests of `operator_error/`
/// and of `operator/tests.rs`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct GapSplit {
    pub(super) params: SplitParams,
    /// Of a displacement at any element, for each level above the base grid, relative to the greatest displacement.
    pub(super) error: f64,
    /// Of a displacement at any element, relative to the [`super::roughness::roughness`] of the pressure.
    pub(super) error_of_roughness: f64,
    /// Its place among the splits, fastest first.
    index: usize,
}

/// Number of splits.
pub(super) const N_SPLITS: usize = 3;

/// Errors that splits are chosen by ([`SplitParams::for_error`]), and bounds on their errors of displacements, smooth
/// and rough: fastest first. On solved contacts the error was 0.1 to 0.8 of the sum of both bounds.
const SPLITS: [(f64, [f64; 2]); N_SPLITS] = [(1e-6, [1e-6, 4e-5]), (2e-9, [1e-8, 1.2e-7]), (1e-10, [2e-10, 6e-9])];

/// Cutoffs up to this one are accurate enough for single precision only.
const SINGLE_PRECISION_CUTOFF: usize = 8;

impl GapSplit {
    /// The fastest split whose error of a displacement is at most `bound`; `None` when there is none.
    pub(super) fn for_error(bound: f64) -> Option<Self> {
        let index = SPLITS.iter().position(|(error, _)| *error <= bound)?;
        let (chosen_by, [error, error_of_roughness]) = SPLITS[index];
        Some(Self { params: SplitParams::for_error(chosen_by)?, error, error_of_roughness, index })
    }

    /// Its place among the splits, fastest first.
    pub(super) fn index(self) -> usize {
        self.index
    }

    /// The fastest one, in single precision.
    pub(super) fn fastest() -> Self {
        Self::for_error(SPLITS[0].0).expect("a split for the largest error")
    }

    /// The most accurate one.
    pub(super) fn most_accurate() -> Self {
        Self::for_error(SplitParams::SMALLEST_ERROR).expect("a split for the smallest error")
    }

    /// The next more accurate one.
    pub(super) fn finer(self) -> Option<Self> {
        let mut splits = SPLITS.into_iter().filter_map(|(error, _)| Self::for_error(error));
        splits.find(|split| split.params.cutoff > self.params.cutoff)
    }

    /// Whether single precision is enough for it.
    pub(super) fn is_single_precision(self) -> bool {
        self.params.cutoff <= SINGLE_PRECISION_CUTOFF
    }
}
