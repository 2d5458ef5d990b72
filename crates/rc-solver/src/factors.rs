//! Sides of grids that Fourier transforms are fast on.

/// Whether no prime factor of a side is above `greatest`.
pub(crate) fn has_small_factors(mut side: usize, greatest: usize) -> bool {
    for factor in 2..=greatest {
        while side.is_multiple_of(factor) {
            side /= factor;
        }
    }
    side == 1
}
