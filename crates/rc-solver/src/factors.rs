//! Sides of grids whose Fourier transforms are fast.

/// Whether every prime factor of a side is at most `greatest`.
pub(crate) fn has_small_factors(mut side: usize, greatest: usize) -> bool {
    for factor in 2..=greatest {
        while side.is_multiple_of(factor) {
            side /= factor;
        }
    }
    side == 1
}
