//! Isotropic spectra that are given as tables.

use thiserror::Error;

use crate::MAX_WAVES;

/// Relative difference of wavenumbers that are the same.
///
/// A wave at the first or last wavenumber of a table is inside, whatever the rounding of units.
const SAME: f64 = 1e-9;

/// An isotropic spectrum C(|k|) as a table, in units of λ.
///
/// Between two rows the spectrum is a power law (linear where one of the two is 0). It is zero outside the table. Hence
/// the last wavenumber is the cut-off.
#[derive(Clone, Debug, PartialEq)]
pub struct SpectrumTable {
    /// |k| (waves per λ) and C (λ⁴), with rising |k|.
    rows: Vec<[f64; 2]>,
}

/// A table that is not the spectrum of a surface.
///
/// Rows are counted from 1.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum TableError {
    /// There is at most one row.
    #[error("a spectrum needs at least two rows, not {rows}")]
    TooShort {
        /// Number of rows.
        rows: usize,
    },
    /// A wavenumber is not positive, not finite, or not above the one before.
    #[error("row {row}: the wavenumber {value:e} must be positive, finite and above that of the row before")]
    Wavenumber {
        /// Number of the row.
        row: usize,
        /// The wavenumber as given.
        value: f64,
    },
    /// A value of C is negative or not finite.
    #[error("row {row}: the spectrum is {value:e}; it must be finite and at least 0")]
    Density {
        /// Number of the row.
        row: usize,
        /// The value as given.
        value: f64,
    },
    /// The last wavenumber is beyond [`MAX_WAVES`].
    #[error(
        "the table ends at {waves} waves per cell; at most {MAX_WAVES} are possible, so end it earlier or take a smaller cell"
    )]
    TooManyWaves {
        /// The last wavenumber, in waves per cell, rounded down.
        waves: f64,
    },
    /// No wave of the cell has a wavenumber inside the table and an amplitude above 0.
    #[error("the cell has no wave from {from} to {to} waves per cell, where the spectrum is; take another cell")]
    NoWaves {
        /// First wavenumber of the table, in waves per cell.
        from: f64,
        /// Last wavenumber of the table, in waves per cell.
        to: f64,
    },
}

impl SpectrumTable {
    /// Checks `rows` of |k| (waves per λ) and C (λ⁴).
    ///
    /// # Errors
    /// [`TableError`] when a value is out of range, wavenumbers do not rise, or the unit cell has no such wave.
    pub fn new(rows: Vec<[f64; 2]>) -> Result<Self, TableError> {
        let (Some(first), Some(last), true) = (rows.first(), rows.last(), rows.len() > 1) else {
            return Err(TableError::TooShort { rows: rows.len() });
        };
        let ([from, _], [to, _]) = (*first, *last);
        let mut before = 0.0;
        for (i, &[wavenumber, density]) in rows.iter().enumerate() {
            if !(wavenumber > before && wavenumber.is_finite()) {
                return Err(TableError::Wavenumber { row: i + 1, value: wavenumber });
            }
            if !(density >= 0.0 && density.is_finite()) {
                return Err(TableError::Density { row: i + 1, value: density });
            }
            before = wavenumber;
        }
        if to >= (MAX_WAVES + 1) as f64 {
            return Err(TableError::TooManyWaves { waves: to.floor() });
        }
        let table = Self { rows };
        if table.has_wave() { Ok(table) } else { Err(TableError::NoWaves { from, to }) }
    }

    /// Whether the unit cell has a wave with an amplitude.
    ///
    /// Waves along an axis are as long as any, so they decide unless the table is narrow.
    fn has_wave(&self) -> bool {
        let waves = self.waves();
        let is_wave = |kx: usize, ky: usize| self.density((kx as f64).hypot(ky as f64)) > 0.0;
        (1..=waves).any(|k| is_wave(k, 0)) || (1..=waves).any(|kx| (1..=kx).any(|ky| is_wave(kx, ky)))
    }

    /// The largest |kx| or |ky| of a wave, in waves per cell.
    #[must_use]
    pub fn waves(&self) -> usize {
        self.cut_off().floor() as usize
    }

    /// The last wavenumber, and what rounding adds.
    fn cut_off(&self) -> f64 {
        self.rows.last().map_or(0.0, |row| row[0]) * (1.0 + SAME)
    }

    /// C(|k|) in λ⁴.
    #[must_use]
    pub fn density(&self, wavenumber: f64) -> f64 {
        let rows = &self.rows;
        let (Some(&[first, of_first]), Some(&[last, of_last])) = (rows.first(), rows.last()) else { return 0.0 };
        if wavenumber < first * (1.0 - SAME) || wavenumber > last * (1.0 + SAME) {
            return 0.0;
        }
        let next = rows.partition_point(|row| row[0] <= wavenumber);
        match (next.checked_sub(1).map(|i| rows[i]), rows.get(next)) {
            (None, _) => of_first,
            (_, None) => of_last,
            (Some([k0, c0]), Some(&[k1, c1])) if c0 == 0.0 || c1 == 0.0 => {
                c0 + (c1 - c0) * (wavenumber - k0) / (k1 - k0)
            }
            (Some([k0, c0]), Some(&[k1, c1])) => c0 * (wavenumber / k0).powf((c1 / c0).ln() / (k1 / k0).ln()),
        }
    }

    /// Largest ky of the waves with this kx.
    pub(crate) fn reach(&self, kx: usize) -> usize {
        (self.cut_off().powi(2) - (kx * kx) as f64).max(0.0).sqrt().floor() as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bad_tables_are_refused() {
        let error = |rows: &[[f64; 2]]| SpectrumTable::new(rows.to_vec()).expect_err("a bad table");
        assert_eq!(error(&[[1.0, 1.0]]), TableError::TooShort { rows: 1 });
        assert_eq!(error(&[[1.0, 1.0], [1.0, 1.0]]), TableError::Wavenumber { row: 2, value: 1.0 });
        assert_eq!(error(&[[0.0, 1.0], [1.0, 1.0]]), TableError::Wavenumber { row: 1, value: 0.0 });
        assert_eq!(error(&[[1.0, 1.0], [2.0, -1.0]]), TableError::Density { row: 2, value: -1.0 });
        assert_eq!(error(&[[1.0, 1.0], [5000.0, 1.0]]), TableError::TooManyWaves { waves: 5000.0 });
        assert_eq!(error(&[[0.2, 1.0], [0.9, 1.0]]), TableError::NoWaves { from: 0.2, to: 0.9 });
        assert_eq!(error(&[[1.1, 1.0], [1.2, 1.0]]), TableError::NoWaves { from: 1.1, to: 1.2 });
        assert!(SpectrumTable::new(vec![[1.4, 1.0], [1.5, 1.0]]).is_ok(), "the wave (1, 1) is inside");
    }

    #[test]
    fn rows_are_joined_by_power_laws_and_nothing_is_outside() {
        let table = SpectrumTable::new(vec![[1.0, 8.0], [4.0, 8.0], [16.0, 0.5], [20.0, 0.0]]).expect("a table");
        for (k, c) in [(0.99, 0.0), (1.0, 8.0), (2.0, 8.0), (8.0, 2.0), (16.0, 0.5), (18.0, 0.25), (20.1, 0.0)] {
            assert!((table.density(k) - c).abs() < 1e-12, "C({k}) = {}, not {c}", table.density(k));
        }
        assert_eq!(table.waves(), 20);
    }
}
