//! Colour maps with visually even steps.
//!
//! They are viridis and magma of matplotlib, CC0, by N. Smith and S. van der Walt, and the ends of ColorBrewer's RdBu.
//!
//! [`CURVES`] are colours of lines.

use plotters::style::RGBColor;

/// A sequence of colours for values from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Palette {
    /// White to black through yellow, red and purple. Zero has the colour of the paper.
    Heat,
    /// Dark blue through green to yellow.
    Viridis,
    /// Light grey to black.
    Ink,
    /// Blue through white to red, for differences: 1/2 is none.
    Difference,
}

/// Ten colours of lines that are also told apart by people with a colour deficiency.
///
/// Source: M. A. Petroff, *Accessible color sequences for data visualization*, arXiv 2107.02270 (2021).
pub const CURVES: [RGBColor; 10] = [
    RGBColor(63, 144, 218),
    RGBColor(255, 169, 14),
    RGBColor(189, 31, 1),
    RGBColor(148, 164, 162),
    RGBColor(131, 45, 182),
    RGBColor(169, 107, 89),
    RGBColor(231, 99, 0),
    RGBColor(185, 172, 112),
    RGBColor(113, 117, 129),
    RGBColor(146, 218, 221),
];

const HEAT: [(u8, u8, u8); 17] = [
    (255, 255, 255),
    (254, 224, 161),
    (254, 194, 135),
    (254, 165, 113),
    (251, 135, 97),
    (244, 105, 92),
    (229, 80, 100),
    (207, 64, 112),
    (183, 55, 121),
    (156, 46, 127),
    (131, 38, 129),
    (106, 28, 129),
    (81, 18, 124),
    (54, 16, 107),
    (29, 17, 71),
    (10, 8, 34),
    (0, 0, 4),
];

const VIRIDIS: [(u8, u8, u8); 17] = [
    (68, 1, 84),
    (72, 24, 106),
    (71, 45, 123),
    (66, 64, 134),
    (59, 82, 139),
    (51, 99, 141),
    (44, 114, 142),
    (38, 130, 142),
    (33, 145, 140),
    (31, 159, 136),
    (39, 173, 129),
    (61, 188, 116),
    (92, 200, 99),
    (129, 211, 77),
    (170, 220, 50),
    (213, 226, 26),
    (253, 231, 37),
];

const DIFFERENCE: [(u8, u8, u8); 5] = [(5, 48, 97), (67, 147, 195), (255, 255, 255), (214, 96, 77), (103, 0, 31)];

const INK: [(u8, u8, u8); 2] = [(238, 240, 242), (23, 28, 40)];

impl Palette {
    /// Colours (red, green, blue) at equal steps of the value.
    ///
    /// The first is at 0 and the last at 1, and colours are linear between them.
    #[must_use]
    pub fn anchors(self) -> &'static [(u8, u8, u8)] {
        match self {
            Self::Heat => &HEAT,
            Self::Viridis => &VIRIDIS,
            Self::Ink => &INK,
            Self::Difference => &DIFFERENCE,
        }
    }

    /// The colour of `value`.
    ///
    /// Values outside [0, 1] get the colour of the nearest end, and `NaN` the colour of 0.
    #[must_use]
    pub fn colour(self, value: f64) -> RGBColor {
        let table = self.anchors();
        let place = value.clamp(0.0, 1.0) * (table.len() - 1) as f64;
        let below = (place as usize).min(table.len() - 2);
        let part = if place.is_nan() { 0.0 } else { place - below as f64 };
        let (a, b) = (table[below], table[below + 1]);
        let mix = |a: u8, b: u8| (f64::from(a) + part * (f64::from(b) - f64::from(a))).round() as u8;
        RGBColor(mix(a.0, b.0), mix(a.1, b.1), mix(a.2, b.2))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_and_values_beyond_have_the_colours_of_the_ends() {
        for palette in [Palette::Heat, Palette::Viridis, Palette::Ink] {
            assert_eq!(palette.colour(-1.0), palette.colour(0.0));
            assert_eq!(palette.colour(7.0), palette.colour(1.0));
            assert_eq!(palette.colour(f64::NAN), palette.colour(0.0));
        }
        assert_eq!(Palette::Heat.colour(0.0), RGBColor(255, 255, 255));
    }
}
