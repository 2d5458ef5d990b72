//! MicroProf files of FRT.
//!
//! The format has blocks, each with a type and a length. Lengths are in metres. Images are integers, whose first row
//! has the lowest y. The documentation of Gwyddion describes the format.
//!
//! A height is integer x scale. The integer 1 is a missing point, and so are 16-bit integers outside the valid range.

use rc_core::Grid;

use super::binary::{Bytes, Number};
use super::channel::{Channel, Channels, each};
use super::fields::{factor, positive, refused};
use super::instrument::{Places, map, scale_measured};
use crate::{Format, FormatError, HeightMap};

/// The first bytes. A version of four characters follows, and a number of blocks.
pub(super) const MARK: &[u8] = b"FRTM_GLIDERV";

/// Types of blocks: an image of heights, its size, the sides, the scale of heights, the valid integers, all images.
const HEIGHTS: u16 = 0x0b;
const SIZE: u16 = 0x66;
const SIDES: u16 = 0x67;
const SCALE: u16 = 0x6c;
const VALID: u16 = 0x70;
const IMAGES: u16 = 0x7d;

/// Types of images, with their names. The first four have heights.
const KINDS: [(u32, &str); 15] = [
    (0x0004, "Topography"),
    (0x0080, "Thickness"),
    (0x0800, "Sample thickness"),
    (0x1000, "AFM"),
    (0x0001, "Piezo"),
    (0x0002, "Intensity"),
    (0x0008, "Real part"),
    (0x0010, "Imaginary part"),
    (0x0040, "Camera"),
    (0x0100, "Picture"),
    (0x0200, "Absolute value"),
    (0x0400, "Phase"),
    (0x2000, "Quality"),
    (0x4000, "Fit"),
    (0x8000, "Slope"),
];
/// Number of types with heights.
const OF_HEIGHTS: usize = 4;

/// Bits of a type that are not the kind of its image.
const KIND: u32 = 0xffdf;
const BOTTOM_SENSOR: u32 = 0x1000_0000;

/// The integer of a missing point.
const MISSING: f64 = 1.0;

/// An image: its type, its points, and the bytes from its integers on.
#[derive(Clone, Copy)]
struct Image<'a> {
    kind: u32,
    grid: Grid,
    number: Number,
    data: &'a [u8],
}

/// What all images have in common.
#[derive(Clone, Copy)]
struct Common {
    sides: [f64; 2],
    scale: f64,
    /// The least and the greatest valid 16-bit integer.
    valid: [f64; 2],
}

pub(super) fn channels(bytes: &[u8]) -> Channels<'_> {
    let blocks = blocks(bytes)?;
    let block = |kind, field| {
        let block = blocks.iter().find(|(other, _)| *other == kind).map(|(_, block)| *block);
        block.ok_or(FormatError::Missing { format: Format::Frt, field })
    };
    let sides = Places::new(block(SIDES, "block 0x67 of the sides")?, Format::Frt);
    let scale = Places::new(block(SCALE, "block 0x6c of the scale of heights")?, Format::Frt);
    let common = Common {
        sides: [
            positive(Format::Frt, "side along x", sides.f64(0)?)?,
            positive(Format::Frt, "side along y", sides.f64(8)?)?,
        ],
        scale: factor(Format::Frt, "scale of heights", scale.f64(4)?)?,
        valid: match block(VALID, "valid integers") {
            Ok(block) => {
                let places = Places::new(block, Format::Frt);
                [places.size(0)? as f64, places.size(4)? as f64]
            }
            Err(_) => [0.0, f64::INFINITY],
        },
    };
    let images = if let Ok(block) = block(IMAGES, "images") {
        images(block)
    } else {
        let size = Places::new(block(SIZE, "block 0x66 of the number of points")?, Format::Frt);
        let heights = block(HEIGHTS, "block 0x0b of the heights")?;
        vec![image([KINDS[0].0, size.u32(0)?, size.u32(4)?, size.u32(8)?], heights)]
    };
    let mut channels = Vec::new();
    for image in images {
        let name = image.as_ref().map(Image::name).unwrap_or_default();
        channels.push((name, image.map(|image| image.channel(common))));
    }
    Ok(each(channels))
}

/// Types and contents of the blocks.
fn blocks(bytes: &[u8]) -> Result<Vec<(u16, &[u8])>, FormatError> {
    let mut bytes = Bytes::new(bytes, Format::Frt);
    bytes.take(MARK.len())?;
    let version = bytes.take(4)?;
    let is_long = match version {
        b"1.00" => false,
        b"1.01" => true,
        other => return Err(refused(Format::Frt, "version", &String::from_utf8_lossy(other), "1.00 or 1.01")),
    };
    let count = bytes.u16()?;
    let mut blocks = Vec::new();
    for _ in 0..count {
        let kind = bytes.u16()?;
        let low = u64::from(bytes.u32()?);
        let length = if is_long { low | u64::from(bytes.u32()?) << 32 } else { low };
        blocks.push((kind, bytes.take(usize::try_from(length).unwrap_or(usize::MAX))?));
    }
    Ok(blocks)
}

/// The images in a block, up to the first that is not valid.
fn images(block: &[u8]) -> Vec<Result<Image<'_>, FormatError>> {
    let header = |at: usize| {
        let places = Places::new(block, Format::Frt);
        Some([places.u32(at).ok()?, places.u32(at + 4).ok()?, places.u32(at + 8).ok()?, places.u32(at + 12).ok()?])
    };
    let (mut at, mut images) = (8, Vec::new());
    while let Some(header) = header(at) {
        at += 16;
        let image = image(header, &block[at..]);
        let length = image.as_ref().ok().and_then(|image| usize::try_from(image.number.bytes_of(image.grid)).ok());
        images.push(image);
        let Some(next) = length.and_then(|length| at.checked_add(length)) else { break };
        at = next;
    }
    images
}

fn image([kind, nx, ny, bits]: [u32; 4], data: &[u8]) -> Result<Image<'_>, FormatError> {
    let grid = Grid::new(nx as usize, ny as usize)?;
    let number = match bits {
        16 => Number::U16,
        32 => Number::I32,
        other => return Err(refused(Format::Frt, "bits of a point", &other, "16 or 32")),
    };
    Ok(Image { kind, grid, number, data })
}

impl<'a> Image<'a> {
    fn name(&self) -> String {
        let name = KINDS.iter().find(|(kind, _)| *kind == self.kind & KIND).map_or("Other", |(_, name)| *name);
        let sensor = if self.kind & BOTTOM_SENSOR == 0 { "" } else { " of the bottom sensor" };
        format!("{name}{sensor}")
    }

    fn channel(self, common: Common) -> Channel<'a> {
        let is_height = KINDS[..OF_HEIGHTS].iter().any(|(kind, _)| *kind == self.kind & KIND);
        Channel { name: self.name(), is_height, read: Box::new(move || self.read(is_height, common)) }
    }

    fn read(self, is_height: bool, common: Common) -> Result<HeightMap, FormatError> {
        let mut values = self.number.values(self.data, self.grid)?;
        let scale = if is_height { common.scale } else { 1.0 };
        let [low, high] =
            if is_height && self.number == Number::U16 { common.valid } else { [f64::NEG_INFINITY, f64::INFINITY] };
        scale_measured(&mut values, scale, |value| value == MISSING || value < low || value > high);
        Ok(map(self.grid, values, is_height, Some(common.sides)).of_numbers(scale))
    }
}
