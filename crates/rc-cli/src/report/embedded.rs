//! Fields that are small enough to be in a page.
//!
//! They are means over at most 512 x 512 pixels, as integers.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use rc_core::{Field, Grid};
use serde::Serialize;

use rc_plot::{Palette, PixelMean};

/// Maximum number of pixels per side.
pub(super) const MOST_PIXELS: usize = 512;

/// Number of bits of the integers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Bits {
    Eight,
    Sixteen,
}

/// A field in the form that the script reads.
#[derive(Clone, Debug, Serialize)]
pub(super) struct EmbeddedField {
    nx: usize,
    ny: usize,
    /// Bits of a number, 8 or 16. A value is its number times `max`, divided by the largest number of so many bits.
    bits: u8,
    /// Maximum value.
    max: f64,
    /// The numbers in base64, little-endian, row by row from y = 0.
    data: String,
    /// Colours of the scale from 0 to `max`.
    colours: &'static [(u8, u8, u8)],
}

/// The mean of `value` over the elements of each pixel.
///
/// The argument of `value` is the index of an element.
pub(super) fn pixel_means(grid: Grid, value: impl Fn(usize) -> f64) -> Field {
    let mut means = PixelMean::new(grid, MOST_PIXELS);
    for iy in 0..grid.ny() {
        means.take(|ix| value(grid.index(ix, iy)));
    }
    means.finish()
}

impl EmbeddedField {
    /// The field of `pixels` with values from 0 to `max`, for pressure or contact.
    ///
    /// A value above 0 becomes 1 or more, so that contact is still seen as contact.
    pub(super) fn of_contact(pixels: &Field, max: f64, bits: Bits, palette: Palette) -> Self {
        Self::new(pixels, max, bits, palette, 1.0)
    }

    /// The field of `pixels` with values from 0 to `max`, for gaps.
    ///
    /// Each value is rounded to the nearest number.
    pub(super) fn of_gap(pixels: &Field, max: f64, bits: Bits, palette: Palette) -> Self {
        Self::new(pixels, max, bits, palette, 0.0)
    }

    /// The field of `pixels`, where a value above 0 becomes `least` or more.
    fn new(pixels: &Field, max: f64, bits: Bits, palette: Palette, least: f64) -> Self {
        let greatest = match bits {
            Bits::Eight => f64::from(u8::MAX),
            Bits::Sixteen => f64::from(u16::MAX),
        };
        let number = |value: &f64| {
            let part = if max > 0.0 && *value > 0.0 { (value / max * greatest).round().max(least) } else { 0.0 };
            part.min(greatest) as u16
        };
        let numbers = pixels.values().iter().map(number);
        let bytes: Vec<u8> = match bits {
            Bits::Eight => numbers.map(|number| number as u8).collect(),
            Bits::Sixteen => numbers.flat_map(u16::to_le_bytes).collect(),
        };
        Self {
            nx: pixels.grid().nx(),
            ny: pixels.grid().ny(),
            bits: if bits == Bits::Eight { 8 } else { 16 },
            max,
            data: STANDARD.encode(bytes),
            colours: palette.anchors(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_within_half_a_step_and_contact_stays_contact() {
        let grid = Grid::new(3, 2).expect("a grid");
        let values = vec![0.0, 1e-12, 0.3, 1.0, 2.0, 1.999];
        let field = Field::new(grid, values.clone()).expect("a field");
        for (bits, steps) in [(Bits::Eight, 255.0), (Bits::Sixteen, 65535.0)] {
            let numbers = |embedded: &EmbeddedField| -> Vec<u16> {
                let bytes = STANDARD.decode(&embedded.data).expect("base64");
                match bits {
                    Bits::Eight => bytes.iter().map(|byte| u16::from(*byte)).collect(),
                    Bits::Sixteen => bytes.chunks(2).map(|pair| u16::from_le_bytes([pair[0], pair[1]])).collect(),
                }
            };
            let gaps = numbers(&EmbeddedField::of_gap(&field, 2.0, bits, Palette::Ink));
            let numbers = numbers(&EmbeddedField::of_contact(&field, 2.0, bits, Palette::Ink));
            assert_eq!((numbers[0], numbers[1], f64::from(numbers[4])), (0, 1, steps));
            assert_eq!((gaps[1], &gaps[2..]), (0, &numbers[2..]), "a gap of nothing is none");
            for (number, value) in numbers.iter().zip(&values).skip(2) {
                let read = f64::from(*number) * 2.0 / steps;
                assert!((read - value).abs() <= 1.0 / steps, "{value} became {read}");
            }
        }
    }

    #[test]
    fn an_empty_field_is_all_zeros_and_a_large_one_is_averaged() {
        let zero = Field::zeros(Grid::square(2).expect("a grid"));
        assert_eq!(EmbeddedField::of_contact(&zero, 0.0, Bits::Eight, Palette::Ink).data, STANDARD.encode([0; 4]));
        let large = Field::from_fn(Grid::new(2048, 100).expect("a grid"), |at| at.x);
        let means = pixel_means(large.grid(), |i| large.values()[i]);
        assert_eq!((means.grid().nx(), means.grid().ny()), (512, 100));
        assert!((means.mean() - large.mean()).abs() < 1e-12, "{} against {}", means.mean(), large.mean());
    }
}
