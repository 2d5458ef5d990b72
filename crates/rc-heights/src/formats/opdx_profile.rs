//! Profiles in Dektak files: heights beside their places.

use super::channel::Channel;
use super::fields::{factor, refused};
use super::instrument::metres;
use super::profile;
use crate::{Format, FormatError, HeightMap, Unit};

/// First bytes of an array of 64-bit floats: its type, and the length of a number.
const DOUBLES: [u8; 5] = [0x0d, 8, 0, 0, 0];

/// Digits behind the point of a number that is not rounded.
const EXACT: usize = 17;

/// What the items of one container say of a profile.
#[derive(Default)]
pub(super) struct ProfileItems<'a> {
    /// Name of the container.
    pub(super) name: String,
    /// Bytes of the heights, as numbers, and of their places along the profile.
    pub(super) heights: Option<&'a [u8]>,
    pub(super) places: Option<&'a [u8]>,
    /// Height of a number of 1, and extent of the places, each with the symbol of its unit.
    pub(super) scale: Option<(f64, String)>,
    pub(super) extent: Option<(f64, String)>,
}

/// The numbers in the bytes of an array. `None` for other types of numbers.
fn numbers(bytes: &[u8], unit: f64) -> Option<Vec<f64>> {
    let (numbers, []) = bytes.strip_prefix(&DOUBLES)?.as_chunks::<8>() else { return None };
    Some(numbers.iter().map(|number| unit * f64::from_le_bytes(*number)).collect())
}

/// The profile, unless it has no heights.
pub(super) fn channel(items: ProfileItems<'_>) -> Option<Result<Channel<'_>, FormatError>> {
    let data = items.heights?;
    let missing = |field| FormatError::Missing { format: Format::Opdx, field };
    let scale_and_places = || {
        let (scale, of_heights) = items.scale.ok_or_else(|| missing("DataScale"))?;
        let (_, of_places) = items.extent.ok_or_else(|| missing("Extent"))?;
        let places = items.places.ok_or_else(|| missing("PositionArray"))?;
        let Some(along) = metres(&of_places) else {
            return Err(refused(Format::Opdx, "Extent", &of_places, "a length"));
        };
        let unit = metres(&of_heights);
        let scale = factor(Format::Opdx, "DataScale", scale * unit.unwrap_or(1.0))?;
        Ok((scale, unit.is_some(), (places, along)))
    };
    let name = items.name;
    Some(scale_and_places().map(|(scale, is_height, places)| {
        let read = move || read((data, scale), places, is_height);
        Channel { name, is_height, read: Box::new(read) }
    }))
}

fn read((data, scale): (&[u8], f64), (places, along): (&[u8], f64), is_height: bool) -> Result<HeightMap, FormatError> {
    let doubles = |field, bytes, unit| {
        numbers(bytes, unit).ok_or_else(|| refused(Format::Opdx, field, &"another type", "an array of 64-bit floats"))
    };
    let (heights, places) = (doubles("Array", data, scale)?, doubles("PositionArray", places, along)?);
    if heights.len() != places.len() {
        return Err(refused(Format::Opdx, "number of places", &places.len(), "the number of heights"));
    }
    let map = profile::of_points(Some(places.into_iter().map(|place| (place, EXACT)).collect()), heights)?;
    let height_unit = if is_height { Unit::Metre } else { Unit::Unnamed };
    Ok(HeightMap { side_unit: Unit::Metre, height_unit, ..map })
}
