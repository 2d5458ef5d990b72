//! Records of numbers with fields x, y and z, as NumPy writes structured arrays.

use npyz::{DType, Endianness, Field, TypeChar};

use super::endian::Endian;
use super::fields::shown;
use crate::FormatError;

/// Places of x, y and z in a record.
pub(super) struct Record {
    /// Bytes of a record.
    pub(super) size: usize,
    fields: [Number; 3],
}

#[derive(Clone, Copy)]
struct Number {
    at: usize,
    kind: TypeChar,
    size: usize,
    order: Endian,
}

impl Record {
    /// The fields called x, y and z.
    ///
    /// # Errors
    /// The names of all fields if one of them is missing or not a real number.
    pub(super) fn of(fields: &[Field]) -> Result<Self, String> {
        let names = || {
            let names: Vec<String> = fields.iter().take(8).map(|field| shown(&field.name)).collect();
            format!("records of {}", names.join(", "))
        };
        let size = |field: &Field| field.dtype.num_bytes().ok_or_else(names);
        let (mut at, mut found) = (0_usize, [None; 3]);
        for field in fields {
            let axis = ["x", "y", "z"].iter().position(|name| field.name.eq_ignore_ascii_case(name));
            if let (Some(axis), DType::Plain(plain)) = (axis, &field.dtype) {
                let order = if plain.endianness() == Endianness::Big { Endian::Big } else { Endian::Little };
                let (kind, size) = (plain.type_char(), size(field)?);
                let is_real =
                    matches!((kind, size), (TypeChar::Float, 4 | 8) | (TypeChar::Int | TypeChar::Uint, 1 | 2 | 4 | 8));
                found[axis] = is_real.then_some(Number { at, kind, size, order });
            }
            at = at.checked_add(size(field)?).ok_or_else(names)?;
        }
        match found {
            [Some(x), Some(y), Some(z)] => Ok(Self { size: at, fields: [x, y, z] }),
            _ => Err(names()),
        }
    }

    /// The point in the bytes of a record.
    pub(super) fn point(&self, bytes: &[u8]) -> [f64; 3] {
        self.fields.map(|number| number.value(bytes))
    }
}

impl Number {
    fn value(self, bytes: &[u8]) -> f64 {
        // The lowest eight bytes of the number, in little-endian order.
        let mut stored = [0; 8];
        for (i, byte) in bytes[self.at..self.at + self.size].iter().enumerate() {
            stored[if self.order == Endian::Big { self.size - 1 - i } else { i }] = *byte;
        }
        let [a, b, c, d, ..] = stored;
        let shift = 64 - 8 * self.size;
        match (self.kind, self.size) {
            (TypeChar::Float, 4) => f64::from(f32::from_le_bytes([a, b, c, d])),
            (TypeChar::Float, _) => f64::from_le_bytes(stored),
            (TypeChar::Int, _) => (i64::from_le_bytes(stored) << shift >> shift) as f64,
            _ => u64::from_le_bytes(stored) as f64,
        }
    }
}

/// Points of `n` records.
///
/// # Errors
/// Those of `file`.
pub(super) fn points(record: &Record, mut file: impl std::io::Read, n: usize) -> std::io::Result<Vec<[f64; 3]>> {
    let (mut points, mut bytes) = (Vec::new(), vec![0; record.size]);
    for _ in 0..n {
        file.read_exact(&mut bytes)?;
        points.push(record.point(&bytes));
    }
    Ok(points)
}

/// Error of a header whose records are not points.
pub(super) fn refused(found: String) -> FormatError {
    let expected = "that of real numbers (f2, f4, f8 or an integer type), or of records with fields x, y and z";
    FormatError::Field { format: super::Format::Npy, field: "descr", found, expected }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_records_are_read_in_both_byte_orders() {
        let number = |kind, size, order| Number { at: 1, kind, size, order };
        let cases = [
            (number(TypeChar::Int, 2, Endian::Big), vec![0, 0xff, 0xfe], -2.0),
            (number(TypeChar::Int, 1, Endian::Little), vec![0, 0x80], -128.0),
            (number(TypeChar::Uint, 2, Endian::Little), vec![0, 1, 2], 513.0),
            (number(TypeChar::Float, 4, Endian::Big), [vec![0], 1.5_f32.to_be_bytes().to_vec()].concat(), 1.5),
            (number(TypeChar::Float, 8, Endian::Little), [vec![0], 2.5_f64.to_le_bytes().to_vec()].concat(), 2.5),
        ];
        for (number, bytes, expected) in cases {
            assert_eq!(number.value(&bytes).to_bits(), f64::to_bits(expected), "{bytes:?}");
        }
    }
}
