//! Numbers of either byte order.

use rc_core::Grid;

use super::binary::Number;
use crate::FormatError;

/// A byte order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Endian {
    Little,
    Big,
}

impl Endian {
    fn ordered<const N: usize>(self, mut bytes: [u8; N]) -> [u8; N] {
        if self == Self::Big {
            bytes.reverse();
        }
        bytes
    }

    /// The `N` bytes from `at` on, in little-endian order. Bytes beyond the end are zero.
    fn at<const N: usize>(self, bytes: &[u8], at: usize) -> [u8; N] {
        let stored = bytes.get(at..).and_then(|rest| rest.first_chunk::<N>());
        self.ordered(stored.copied().unwrap_or([0; N]))
    }

    pub(super) fn u16(self, bytes: [u8; 2]) -> u16 {
        u16::from_le_bytes(self.ordered(bytes))
    }

    pub(super) fn i16_at(self, bytes: &[u8], at: usize) -> i16 {
        i16::from_le_bytes(self.at(bytes, at))
    }

    pub(super) fn u32_at(self, bytes: &[u8], at: usize) -> u32 {
        u32::from_le_bytes(self.at(bytes, at))
    }

    pub(super) fn i32_at(self, bytes: &[u8], at: usize) -> i32 {
        i32::from_le_bytes(self.at(bytes, at))
    }

    pub(super) fn i64_at(self, bytes: &[u8], at: usize) -> i64 {
        i64::from_le_bytes(self.at(bytes, at))
    }

    pub(super) fn f64_at(self, bytes: &[u8], at: usize) -> f64 {
        f64::from_le_bytes(self.at(bytes, at))
    }

    /// The values of `grid` at the start of `bytes`.
    ///
    /// # Errors
    /// [`FormatError::CutShort`] when there are too few bytes. It is returned before memory is taken.
    pub(super) fn values(self, number: Number, bytes: &[u8], grid: Grid) -> Result<Vec<f64>, FormatError> {
        let (needed, size) = (number.bytes_of(grid), number.size());
        if self == Self::Little || size == 1 || (bytes.len() as u64) < needed {
            return number.values(bytes, grid);
        }
        Ok(self.all(number, &bytes[..grid.len() * size]))
    }

    /// All values in `bytes`.
    pub(super) fn all(self, number: Number, bytes: &[u8]) -> Vec<f64> {
        if self == Self::Little || number.size() == 1 {
            return number.all(bytes);
        }
        let mut swapped = bytes.to_vec();
        swapped.chunks_exact_mut(number.size()).for_each(<[u8]>::reverse);
        number.all(&swapped)
    }
}
