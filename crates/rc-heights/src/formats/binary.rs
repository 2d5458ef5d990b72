//! Little-endian bytes: a cursor that cannot leave them, and arrays of numbers.

use rc_core::Grid;

use crate::{Format, FormatError};

/// The part of a file that is not read yet.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bytes<'a> {
    rest: &'a [u8],
    format: Format,
}

impl<'a> Bytes<'a> {
    pub(crate) fn new(rest: &'a [u8], format: Format) -> Self {
        Self { rest, format }
    }

    /// The next `n` bytes of the header.
    pub(crate) fn take(&mut self, n: usize) -> Result<&'a [u8], FormatError> {
        let cut = FormatError::HeaderCutShort { format: self.format };
        let (taken, rest) = self.rest.split_at_checked(n).ok_or(cut)?;
        self.rest = rest;
        Ok(taken)
    }

    fn array<const N: usize>(&mut self) -> Result<[u8; N], FormatError> {
        let mut array = [0; N];
        array.copy_from_slice(self.take(N)?);
        Ok(array)
    }

    pub(crate) fn u8(&mut self) -> Result<u8, FormatError> {
        Ok(self.array::<1>()?[0])
    }

    pub(crate) fn u16(&mut self) -> Result<u16, FormatError> {
        Ok(u16::from_le_bytes(self.array()?))
    }

    pub(crate) fn u32(&mut self) -> Result<u32, FormatError> {
        Ok(u32::from_le_bytes(self.array()?))
    }

    pub(crate) fn f64(&mut self) -> Result<f64, FormatError> {
        Ok(f64::from_le_bytes(self.array()?))
    }

    /// All remaining bytes.
    pub(crate) fn rest(self) -> &'a [u8] {
        self.rest
    }
}

/// A type of the numbers in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Number {
    U8,
    U16,
    U32,
    I8,
    I16,
    I32,
    F32,
    F64,
}

impl Number {
    pub(crate) fn size(self) -> usize {
        match self {
            Self::U8 | Self::I8 => 1,
            Self::U16 | Self::I16 => 2,
            Self::U32 | Self::I32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// Number of bytes of the values of `grid`, which has at most 2^40 points.
    pub(crate) fn bytes_of(self, grid: Grid) -> u64 {
        grid.len() as u64 * self.size() as u64
    }

    /// The values of `grid` at the start of `bytes`.
    ///
    /// # Errors
    /// [`FormatError::CutShort`] when there are too few bytes. It is returned before memory is taken.
    pub(crate) fn values(self, bytes: &[u8], grid: Grid) -> Result<Vec<f64>, FormatError> {
        let needed = self.bytes_of(grid);
        let cut_short = FormatError::CutShort { grid, needed, found: bytes.len() as u64 };
        let stored = usize::try_from(needed).ok().and_then(|needed| bytes.get(..needed)).ok_or(cut_short)?;
        Ok(self.all(stored))
    }

    /// All values in `stored`.
    pub(crate) fn all(self, stored: &[u8]) -> Vec<f64> {
        match self {
            Self::U8 => stored.iter().map(|value| f64::from(*value)).collect(),
            Self::I8 => each(stored, |b| f64::from(i8::from_le_bytes(b))),
            Self::U16 => each(stored, |b| f64::from(u16::from_le_bytes(b))),
            Self::I16 => each(stored, |b| f64::from(i16::from_le_bytes(b))),
            Self::U32 => each(stored, |b| f64::from(u32::from_le_bytes(b))),
            Self::I32 => each(stored, |b| f64::from(i32::from_le_bytes(b))),
            Self::F32 => each(stored, |b| f64::from(f32::from_le_bytes(b))),
            Self::F64 => each(stored, f64::from_le_bytes),
        }
    }

    /// The values of `grid`, which must be all of `bytes`.
    ///
    /// # Errors
    /// - [`FormatError::CutShort`] when there are too few bytes. It is returned before memory is taken.
    /// - [`FormatError::Surplus`] when there are more bytes.
    pub(crate) fn values_alone(self, bytes: &[u8], grid: Grid) -> Result<Vec<f64>, FormatError> {
        let (needed, found) = (self.bytes_of(grid), bytes.len() as u64);
        if found > needed {
            return Err(FormatError::Surplus { grid, needed, found });
        }
        self.values(bytes, grid)
    }
}

fn each<const N: usize>(bytes: &[u8], number: impl Fn([u8; N]) -> f64) -> Vec<f64> {
    let (chunks, _) = bytes.as_chunks::<N>();
    chunks.iter().map(|chunk| number(*chunk)).collect()
}
