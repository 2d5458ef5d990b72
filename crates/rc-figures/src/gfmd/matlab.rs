//! Arrays of numbers from MATLAB files (version 5), as the published reference has them.
//!
//! Format: *MAT-File Format*, The `MathWorks`. Little-endian files, real numeric arrays, compressed or not; other variables are passed over.

use std::collections::BTreeMap;
use std::io::Read as _;

use anyhow::{Context, Result, ensure};
use flate2::read::ZlibDecoder;

/// Bytes before the first element.
const HEADER: usize = 128;
/// Types of elements.
const MATRIX: u32 = 14;
const COMPRESSED: u32 = 15;
/// More than any array of the reference unpacks to.
const LARGEST: u64 = 1 << 28;

/// An array, column by column.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Array {
    /// Rows.
    pub(super) rows: usize,
    pub(super) values: Vec<f64>,
}

impl Array {
    /// The columns.
    pub(super) fn columns(&self) -> impl Iterator<Item = &[f64]> {
        self.values.chunks(self.rows.max(1))
    }
}

/// The arrays of a file by name.
///
/// # Errors
/// When it is not such a file, or is cut off.
pub(super) fn arrays(bytes: &[u8]) -> Result<BTreeMap<String, Array>> {
    ensure!(bytes.get(126..HEADER) == Some(b"IM"), "not a little-endian MATLAB file of version 5");
    let mut rest = bytes.get(HEADER..).unwrap_or_default();
    let mut arrays = BTreeMap::new();
    while !rest.is_empty() {
        let (kind, data, after) = element(rest)?;
        let mut unpacked = Vec::new();
        let matrix = if kind == COMPRESSED {
            ZlibDecoder::new(data).take(LARGEST).read_to_end(&mut unpacked).context("a compressed variable")?;
            let (kind, data, _) = element(&unpacked)?;
            (kind == MATRIX).then_some(data)
        } else {
            (kind == MATRIX).then_some(data)
        };
        arrays.extend(matrix.map(array).transpose()?.flatten());
        rest = after;
    }
    Ok(arrays)
}

/// Type and data of the first element, and what follows it.
fn element(bytes: &[u8]) -> Result<(u32, &[u8], &[u8])> {
    let word = |at: usize| -> Result<u32> {
        let four = bytes.get(at..at + 4).context("the file is cut off")?;
        Ok(u32::from_le_bytes(four.try_into()?))
    };
    let first = word(0)?;
    // Up to four bytes stand in the tag itself.
    let (kind, start, length, end) = if first >> 16 == 0 {
        let length = word(4)? as usize;
        let padded = if first == COMPRESSED { length } else { length.next_multiple_of(8) };
        (first, 8, length, 8 + padded)
    } else {
        (first & 0xffff, 4, (first >> 16) as usize, 8)
    };
    let data = bytes.get(start..start + length).context("the file is cut off")?;
    Ok((kind, data, bytes.get(end..).unwrap_or_default()))
}

/// Name and values of a matrix; nothing for what is not numeric.
fn array(bytes: &[u8]) -> Result<Option<(String, Array)>> {
    let (_, flags, rest) = element(bytes)?;
    let (_, dimensions, rest) = element(rest)?;
    let (_, name, rest) = element(rest)?;
    // Classes 6 to 15 are numbers.
    if !flags.first().is_some_and(|class| (6..=15).contains(class)) {
        return Ok(None);
    }
    let (kind, data, _) = element(rest)?;
    let rows = dimensions.get(..4).context("an array without dimensions")?;
    let rows = usize::try_from(i32::from_le_bytes(rows.try_into()?))?;
    let name = String::from_utf8_lossy(name).into_owned();
    let values =
        numbers(kind, data).with_context(|| format!("the array {name} is of type {kind}, which is not read"))?;
    Ok(Some((name, Array { rows, values })))
}

fn numbers(kind: u32, data: &[u8]) -> Option<Vec<f64>> {
    /// Numbers of a type of fixed size.
    macro_rules! all {
        ($number:ty) => {
            data.chunks_exact(size_of::<$number>())
                .map(|bytes| bytes.try_into().ok().map(|bytes| f64::from(<$number>::from_le_bytes(bytes))))
                .collect()
        };
    }
    match kind {
        1 => all!(i8),
        2 => all!(u8),
        3 => all!(i16),
        4 => all!(u16),
        5 => all!(i32),
        6 => all!(u32),
        7 => all!(f32),
        9 => all!(f64),
        _ => None,
    }
}

#[cfg(test)]
pub(super) mod tests {
    use std::io::Write as _;

    use flate2::Compression;
    use flate2::write::ZlibEncoder;

    use super::*;

    fn tagged(kind: u32, data: &[u8]) -> Vec<u8> {
        let mut bytes = [kind.to_le_bytes(), (data.len() as u32).to_le_bytes()].concat();
        bytes.extend(data);
        bytes.resize(bytes.len().next_multiple_of(8), 0);
        bytes
    }

    /// A file with one array of doubles, compressed.
    pub(in crate::gfmd) fn file(arrays: &[(&str, usize, &[f64])]) -> Vec<u8> {
        let mut bytes = vec![b' '; 124];
        bytes.extend(b"\0\x01IM");
        for (name, rows, values) in arrays {
            let dimensions: Vec<u8> =
                [*rows as i32, (values.len() / rows) as i32].iter().flat_map(|n| n.to_le_bytes()).collect();
            let values: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
            let parts = [
                tagged(6, &[6, 0, 0, 0, 0, 0, 0, 0]),
                tagged(5, &dimensions),
                tagged(1, name.as_bytes()),
                tagged(9, &values),
            ];
            let mut encoder = ZlibEncoder::new(Vec::new(), Compression::fast());
            encoder.write_all(&tagged(MATRIX, &parts.concat())).expect("memory");
            let packed = encoder.finish().expect("memory");
            bytes.extend([COMPRESSED.to_le_bytes(), (packed.len() as u32).to_le_bytes()].concat());
            bytes.extend(packed);
        }
        bytes
    }

    #[test]
    fn arrays_are_read_by_name() {
        let read = arrays(&file(&[("p_bar", 2, &[1.0, 2.5]), ("table", 2, &[1.0, 2.0, 3.0, 4.0])])).expect("a file");
        assert_eq!(read["p_bar"].values, [1.0, 2.5]);
        assert_eq!(read["table"].columns().collect::<Vec<_>>(), [&[1.0, 2.0], &[3.0, 4.0]]);
    }

    #[test]
    fn small_elements_stand_in_their_tag() {
        let mut parts = tagged(6, &[6, 0, 0, 0, 0, 0, 0, 0]);
        parts.extend(tagged(5, &[3, 0, 0, 0, 1, 0, 0, 0]));
        parts.extend([1, 0, 1, 0, b'x', 0, 0, 0]);
        parts.extend([2, 0, 3, 0, 7, 8, 9, 0]);
        let bytes = [vec![0; 126], b"IM".to_vec(), tagged(MATRIX, &parts)].concat();
        assert_eq!(arrays(&bytes).expect("a file")["x"], Array { rows: 3, values: vec![7.0, 8.0, 9.0] });
    }

    #[test]
    fn what_is_cut_off_is_an_error() {
        let whole = file(&[("p_bar", 2, &[1.0, 2.5])]);
        for length in (0..whole.len()).filter(|length| *length != HEADER) {
            assert!(arrays(&whole[..length]).is_err(), "{length} of {} bytes", whole.len());
        }
    }
}
