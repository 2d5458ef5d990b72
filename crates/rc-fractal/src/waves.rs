//! Surfaces of waves that are given one by one.

use rc_fft::Complex64;
use thiserror::Error;

use crate::MAX_WAVES;

/// Maximum difference between the amplitudes of k and -k, relative to the amplitude.
///
/// The second number is relative to the largest amplitude and is added.
const SAME: f64 = 1e-6;
const SAME_AS_LARGEST: f64 = 1e-12;

/// A wave a exp(2πi k·x) of a surface on the unit cell.
///
/// The sum of the wave and its conjugate at -k is real.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wave {
    /// Waves per cell along x.
    pub kx: i64,
    /// Waves per cell along y.
    pub ky: i64,
    /// Amplitude `a_k` of Eq. 10, in λ.
    pub amplitude: Complex64,
}

/// Waves that do not define a surface. Messages name the wave and say what would be right.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum WaveError {
    /// A component of the wave vector is beyond [`MAX_WAVES`].
    #[error("wave ({kx}, {ky}): kx and ky must be from -{MAX_WAVES} to {MAX_WAVES} waves per cell")]
    TooShort {
        /// Waves per cell along x.
        kx: i64,
        /// Waves per cell along y.
        ky: i64,
    },
    /// The amplitude is `NaN` or infinite.
    #[error("wave ({kx}, {ky}): its amplitude is {re} + {im}i; it must be finite")]
    NotFinite {
        /// Waves per cell along x.
        kx: i64,
        /// Waves per cell along y.
        ky: i64,
        /// Real part of the amplitude.
        re: f64,
        /// Imaginary part.
        im: f64,
    },
    /// One wave vector has two amplitudes.
    #[error("wave ({kx}, {ky}) is given twice; give it once")]
    Twice {
        /// Waves per cell along x.
        kx: i64,
        /// Waves per cell along y.
        ky: i64,
    },
    /// The sum of a wave and its opposite is not real.
    #[error(
        "wave ({kx}, {ky}) is {re} + {im}i, and its opposite, -k, is {} + {}i; a real surface needs the conjugate, so correct or omit one of them",
        .of_opposite.re, .of_opposite.im
    )]
    NotConjugate {
        /// Waves per cell along x.
        kx: i64,
        /// Waves per cell along y.
        ky: i64,
        /// Real part of the amplitude.
        re: f64,
        /// Imaginary part.
        im: f64,
        /// Amplitude of the opposite wave.
        of_opposite: Complex64,
    },
    /// There is no wave, or only waves of amplitude zero.
    #[error("all waves are zero; a flat surface has no contact problem")]
    Flat,
}

/// A wave of the half plane kx > 0, or kx = 0 and ky ≥ 0.
///
/// It also says whether the opposite wave was given.
#[derive(Clone, Copy)]
struct Half {
    k: (i64, i64),
    amplitude: Complex64,
    is_opposite: bool,
}

impl Half {
    fn of(Wave { kx, ky, amplitude }: Wave) -> Self {
        if (kx, ky) < (0, 0) {
            Self { k: (-kx, -ky), amplitude: amplitude.conj(), is_opposite: true }
        } else {
            Self { k: (kx, ky), amplitude, is_opposite: false }
        }
    }
}

/// Amplitudes column by column, and the largest |kx| or |ky|.
///
/// `columns[kx][reach + ky]` is the amplitude of (kx, ky) for 0 ≤ kx.
pub(crate) fn columns_of_waves(waves: Vec<Wave>) -> Result<(Vec<Vec<Complex64>>, usize), WaveError> {
    waves.iter().try_for_each(check)?;
    let largest = waves.iter().map(|wave| wave.amplitude.norm()).fold(0.0, f64::max);
    let mut halves: Vec<Half> = waves.into_iter().map(Half::of).collect();
    halves.sort_by_key(|half| (half.k, half.is_opposite));
    let mut columns: Vec<Vec<Complex64>> = Vec::new();
    let mut most = 0;
    for column in halves.chunk_by(|a, b| a.k.0 == b.k.0) {
        let mut merged = Vec::with_capacity(column.len());
        for same in column.chunk_by(|a, b| a.k == b.k) {
            merged.extend(merge(same, largest)?);
        }
        let reach = merged.iter().map(|half: &Half| half.k.1.unsigned_abs() as usize).max();
        let (Some(reach), Some(first)) = (reach, merged.first()) else { continue };
        let kx = first.k.0.unsigned_abs() as usize;
        // A column between two given ones holds only the wave ky = 0, which is zero.
        columns.resize(kx, vec![Complex64::ZERO]);
        columns.push(column_of(kx, reach, &merged));
        most = most.max(kx).max(reach);
    }
    if most == 0 { Err(WaveError::Flat) } else { Ok((columns, most)) }
}

fn check(&Wave { kx, ky, amplitude }: &Wave) -> Result<(), WaveError> {
    if kx.unsigned_abs().max(ky.unsigned_abs()) > MAX_WAVES as u64 {
        return Err(WaveError::TooShort { kx, ky });
    }
    if !amplitude.is_finite() {
        return Err(WaveError::NotFinite { kx, ky, re: amplitude.re, im: amplitude.im });
    }
    Ok(())
}

/// The amplitude of a wave that is given by k, by -k, or by both.
///
/// If both are given, it is their mean. `None` for zeros and for the mean height.
fn merge(same: &[Half], largest: f64) -> Result<Option<Half>, WaveError> {
    let near = |a: Complex64, b: Complex64| (a - b).norm() <= SAME * a.norm() + SAME_AS_LARGEST * largest;
    let failed = |half: &Half, of_opposite: Complex64| {
        let ((kx, ky), Complex64 { re, im }) = (half.k, half.amplitude);
        Err(WaveError::NotConjugate { kx, ky, re, im, of_opposite })
    };
    let merged = match same {
        // The wave k = 0 is its own opposite.
        [half] if half.k == (0, 0) => {
            return if near(half.amplitude, half.amplitude.conj()) { Ok(None) } else { failed(half, half.amplitude) };
        }
        [half] => *half,
        [half, opposite] if half.is_opposite != opposite.is_opposite => {
            if !near(half.amplitude, opposite.amplitude) {
                return failed(half, opposite.amplitude.conj());
            }
            Half { amplitude: 0.5 * (half.amplitude + opposite.amplitude), ..*half }
        }
        [first, ..] => {
            let sign = if same.iter().filter(|half| half.is_opposite).count() > 1 { -1 } else { 1 };
            return Err(WaveError::Twice { kx: sign * first.k.0, ky: sign * first.k.1 });
        }
        [] => return Ok(None),
    };
    Ok(Some(merged).filter(|half| half.amplitude != Complex64::ZERO))
}

/// The column of the waves with this kx. The column kx = 0 includes their opposites.
fn column_of(kx: usize, reach: usize, waves: &[Half]) -> Vec<Complex64> {
    let mut column = vec![Complex64::ZERO; 2 * reach + 1];
    for &Half { k: (_, ky), amplitude, .. } in waves {
        let place = |ky: i64| (reach as i64 + ky).unsigned_abs() as usize;
        column[place(ky)] = amplitude;
        if kx == 0 {
            column[place(-ky)] = amplitude.conj();
        }
    }
    column
}
