//! The heights of a file, bit by bit, from heights in λ.

use rayon::prelude::*;

/// Number of heights per task.
const CHUNK: usize = 1 << 14;

/// Data that turn heights in λ into the heights of the file (m).
///
/// They are the length by which the heights were divided, and the changes by rounding. A result is repeated bit for bit
/// only from the heights in the file. The data take one byte per element instead of eight.
#[derive(Clone, Debug)]
pub struct AsRead {
    unit: f64,
    rounding: Rounding,
}

#[derive(Clone, Debug)]
enum Rounding {
    /// Numbers to add to the products, in units of the last digit.
    Digits(Vec<i8>),
    /// The heights themselves, if a product is farther off. This happens for numbers close to the smallest ones.
    Kept(Vec<f64>),
}

impl AsRead {
    /// Divides `heights` (m) by `unit`, and returns what restores them.
    pub(super) fn divide(heights: &mut [f64], unit: f64) -> Self {
        let mut of_product = vec![0; heights.len()];
        let are_near = heights.par_chunks(CHUNK).zip(of_product.par_chunks_mut(CHUNK)).all(|(heights, of_product)| {
            heights.iter().zip(of_product).all(|(&height, of_product)| {
                let digits = digits(height, (height / unit) * unit);
                *of_product = digits.unwrap_or(0);
                digits.is_some()
            })
        });
        let rounding = if are_near { Rounding::Digits(of_product) } else { Rounding::Kept(heights.to_vec()) };
        heights.par_chunks_mut(CHUNK).for_each(|heights| heights.iter_mut().for_each(|height| *height /= unit));
        Self { unit, rounding }
    }

    /// Restores heights in λ to those of the file, from element `first` on.
    pub fn restore(&self, first: usize, heights: &mut [f64]) {
        match &self.rounding {
            Rounding::Digits(digits) => {
                for (height, digits) in heights.iter_mut().zip(&digits[first..]) {
                    *height = f64::from_bits((*height * self.unit).to_bits().wrapping_add_signed((*digits).into()));
                }
            }
            Rounding::Kept(kept) => heights.copy_from_slice(&kept[first..][..heights.len()]),
        }
    }
}

/// Difference from `product` to `height` in units of the last digit.
///
/// `None` if the two are far apart or have different signs.
fn digits(height: f64, product: f64) -> Option<i8> {
    i8::try_from(height.to_bits().wrapping_sub(product.to_bits()).cast_signed()).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_height_comes_back_bit_by_bit() {
        let noise = |i: u64| f64::from_bits(0x3f00_0000_0000_0000 | i.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 12);
        let usual: Vec<f64> = (0..5000).map(|i| if i % 3 == 0 { -noise(i) } else { noise(i) }).collect();
        let extreme = vec![0.0, -0.0, 5e-324, 1e-310, f64::MAX, -1e-5];
        for (heights, is_kept) in [(usual, false), (extreme, true)] {
            for unit in [1e-2, 3.7e-5, 1.0, 7e3] {
                let mut in_cell = heights.clone();
                let as_read = AsRead::divide(&mut in_cell, unit);
                assert!(is_kept || matches!(as_read.rounding, Rounding::Digits(_)), "{unit}");
                for (i, (height, divided)) in heights.iter().zip(&in_cell).enumerate() {
                    let mut restored = [*divided];
                    as_read.restore(i, &mut restored);
                    assert_eq!(restored[0].to_bits(), height.to_bits(), "{height:e} by {unit:e}");
                    assert_eq!(divided.to_bits(), (height / unit).to_bits());
                }
            }
        }
    }
}
