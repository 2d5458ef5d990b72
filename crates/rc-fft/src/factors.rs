//! Lengths whose Fourier transforms are fast.

/// Whether every prime factor of a length is at most `greatest`.
///
/// Fourier transforms of lengths with small factors are fast. A length of 0 has no such factors.
#[must_use]
pub fn has_small_factors(mut length: usize, greatest: usize) -> bool {
    if length == 0 {
        return false;
    }
    for factor in 2..=greatest {
        while length.is_multiple_of(factor) {
            length /= factor;
        }
    }
    length == 1
}
