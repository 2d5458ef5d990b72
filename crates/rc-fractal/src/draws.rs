//! Random numbers that belong to wave vectors.
//!
//! They are the same for every N, grid, truncation and kind of amplitude.
//!
//! `ChaCha8` is a function of key, stream and position, and portable by its definition. The key is the seed
//! (little-endian, then zeros). Stream 2kx holds the phases, and stream 2kx + 1 the sizes, of the waves with this kx
//! ≥ 0. The words of 64 bits of a stream belong to ky = 0, 1, -1, 2, -2, …, in this order. So a column of any length is
//! read from front to back.

use std::f64::consts::TAU;

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rc_fft::Complex64;

use crate::Amplitudes;

/// One complex number of mean square 1 for each of ky = -reach, …, reach.
///
/// The number is exp(iφ), Eq. (14). For [`Amplitudes::Random`] it has another factor with Rayleigh's distribution. In
/// the column kx = 0 the waves ky and -ky are conjugate, and the mean height is 0.
pub(crate) fn draw_column(seed: u64, kx: usize, reach: usize, amplitudes: Amplitudes) -> Vec<Complex64> {
    let mut column = vec![Complex64::ZERO; 2 * reach + 1];
    let mut phases = stream(seed, 2 * kx as u64);
    for place in 0..column.len() {
        column[index_of_place(place, reach)] = Complex64::cis(TAU * uniform(&mut phases));
    }
    if amplitudes == Amplitudes::Random {
        let mut sizes = stream(seed, 2 * kx as u64 + 1);
        for place in 0..column.len() {
            // |a|² of a complex Gaussian number is exponentially distributed. 1 - u is never 0.
            column[index_of_place(place, reach)] *= (-(1.0 - uniform(&mut sizes)).ln()).sqrt();
        }
    }
    if kx == 0 {
        column[reach] = Complex64::ZERO;
        for ky in 1..=reach {
            column[reach - ky] = column[reach + ky].conj();
        }
    }
    column
}

fn stream(seed: u64, number: u64) -> ChaCha8Rng {
    let mut key = [0; 32];
    key[..8].copy_from_slice(&seed.to_le_bytes());
    let mut words = ChaCha8Rng::from_seed(key);
    words.set_stream(number);
    words
}

/// Uniform number in [0, 1), from the upper 53 bits of the next word.
fn uniform(words: &mut ChaCha8Rng) -> f64 {
    (words.next_u64() >> 11) as f64 * f64::EPSILON / 2.0
}

/// Index, in a column from -reach to reach, of the draw at `place`.
///
/// Places 0, 1, 2, 3, 4, … belong to ky = 0, 1, -1, 2, -2, ….
fn index_of_place(place: usize, reach: usize) -> usize {
    let magnitude = place.div_ceil(2);
    if place % 2 == 1 { reach + magnitude } else { reach - magnitude }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_cover_a_column_once() {
        let mut seen: Vec<usize> = (0..9).map(|place| index_of_place(place, 4)).collect();
        assert_eq!(seen[..5], [4, 5, 3, 6, 2]);
        seen.sort_unstable();
        assert_eq!(seen, (0..9).collect::<Vec<_>>());
    }

    #[test]
    fn a_longer_column_has_the_same_middle() {
        for amplitudes in [Amplitudes::Fixed, Amplitudes::Random] {
            for kx in [0, 3] {
                let (short, long) = (draw_column(9, kx, 5, amplitudes), draw_column(9, kx, 12, amplitudes));
                assert_eq!(short[..], long[7..18], "kx = {kx}, {amplitudes:?}");
            }
        }
    }

    #[test]
    fn the_kind_of_amplitude_does_not_shift_phases() {
        let (fixed, random) = (draw_column(4, 7, 30, Amplitudes::Fixed), draw_column(4, 7, 30, Amplitudes::Random));
        for (f, r) in fixed.iter().zip(&random) {
            let turned = (r / f).arg().abs();
            assert!(turned < 1e-14, "phases differ by {turned:e}");
        }
    }
}
