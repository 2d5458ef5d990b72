//! Mirrored maps.

use std::str::FromStr;

use super::error::TreatError;
use super::treatment::Flip;
use crate::HeightMap;

impl FromStr for Flip {
    type Err = TreatError;

    fn from_str(text: &str) -> Result<Self, TreatError> {
        let axis = [Self::X, Self::Y, Self::Z].into_iter().find(|axis| axis.to_string() == text);
        axis.ok_or_else(|| TreatError::Unknown { found: text.to_owned(), expected: "an axis: x, y or z" })
    }
}

pub(super) fn flip(mut map: HeightMap, axis: Flip) -> HeightMap {
    let nx = map.heights.grid().nx();
    let values = map.heights.values_mut();
    match axis {
        Flip::X => values.chunks_exact_mut(nx).for_each(<[f64]>::reverse),
        Flip::Y => {
            values.reverse();
            values.chunks_exact_mut(nx).for_each(<[f64]>::reverse);
        }
        Flip::Z => values.iter_mut().for_each(|height| *height = -*height),
    }
    map
}
