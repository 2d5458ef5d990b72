//! Keyence files.
//!
//! The format has a table of places, the conditions of the measurement, and images with rows from top to bottom. Up to
//! three images have heights, as integers in a unit of picometres that the conditions give. The documentation of
//! Gwyddion describes the format.

use rc_core::Grid;

use super::binary::Number;
use super::channel::{Channel, Channels};
use super::fields::{factor, refused};
use super::instrument::{Places, map, sides};
use crate::map::scale;
use crate::{Format, FormatError, HeightMap};

/// The first bytes. The table in files of version 3 has one place fewer.
pub(super) const MARKS: [&[u8]; 2] = [b"VK4_", b"VK3_"];

/// Place of the table, after mark, version and four zero bytes.
const TABLE: usize = 12;
/// Places in the table of the three images of heights.
const HEIGHTS: [usize; 3] = [TABLE + 24, TABLE + 28, TABLE + 32];

/// Bytes of the header of an image with a palette.
const IMAGE_HEADER: usize = 28 + 768;

const PICOMETRE: f64 = 1e-12;

/// An image of heights: its number from 1, its place, and the lengths (m) of a pixel and of a digit.
#[derive(Clone, Copy)]
pub(super) struct Image {
    number: usize,
    place: usize,
    spacing: [f64; 2],
    unit: f64,
}

pub(super) fn channels(bytes: &[u8]) -> Channels<'_> {
    let channel = |image: Image| {
        let read = Box::new(move || image.read(bytes));
        Channel { name: image.name(), is_height: true, read }
    };
    Ok(images(bytes)?.into_iter().map(channel).collect())
}

/// The images of heights in a file.
pub(super) fn images(bytes: &[u8]) -> Result<Vec<Image>, FormatError> {
    if !MARKS.iter().any(|mark| bytes.starts_with(mark)) {
        return Err(FormatError::Mark { format: Format::Vk4, expected: "it must begin with VK4_" });
    }
    let file = Places::new(bytes, Format::Vk4);
    let conditions = Places::new(file.rest(file.size(TABLE)?), Format::Vk4);
    let length = |at| Ok::<_, FormatError>(conditions.size(at)? as f64 * PICOMETRE);
    let (spacing, unit) = ([length(168)?, length(172)?], length(176)?);
    let unit = factor(Format::Vk4, "length of a digit along z", unit)?;
    let mut images = Vec::new();
    for (number, at) in (1..).zip(HEIGHTS) {
        let place = file.size(at)?;
        // A place of 0 means that the file does not have this image.
        if place != 0 {
            images.push(Image { number, place, spacing, unit });
        }
    }
    Ok(images)
}

impl Image {
    pub(super) fn name(&self) -> String {
        if self.number == 1 { "Height".to_owned() } else { format!("Height {}", self.number) }
    }

    /// Reads the image from the bytes of its file.
    pub(super) fn read(&self, bytes: &[u8]) -> Result<HeightMap, FormatError> {
        let image = Places::new(Places::new(bytes, Format::Vk4).rest(self.place), Format::Vk4);
        let grid = Grid::new(image.size(0)?, image.size(4)?)?;
        let number = match image.size(8)? {
            8 => Number::U8,
            16 => Number::U16,
            32 => Number::U32,
            other => return Err(refused(Format::Vk4, "bits of a height", &other, "8, 16 or 32")),
        };
        if image.size(12)? != 0 {
            let what = "compressed heights".to_owned();
            return Err(FormatError::Unsupported { format: Format::Vk4, what, cure: "save them without compression" });
        }
        let fields = ["length of a pixel along x", "length of a pixel along y"];
        let sides = sides(Format::Vk4, fields, grid, self.spacing)?;
        let mut values = number.values(image.rest(IMAGE_HEADER), grid)?;
        scale(&mut values, self.unit);
        Ok(map(grid, values, true, Some(sides)))
    }
}
