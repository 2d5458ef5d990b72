//! Wyko files.
//!
//! The format has a directory of blocks, then the blocks in the same order. Heights are multiples of the wavelength
//! (nm) divided by `Mult`. Points are stored column by column, each from the lowest y on. The documentation of Gwyddion
//! describes the format.

use rc_core::Grid;

use super::binary::{Bytes, Number};
use super::channel::{Channel, Channels};
use super::field::transposed;
use super::fields::{factor, refused};
use super::instrument::{Places, map, scale_measured, sides, text};
use crate::{Format, FormatError, HeightMap};

/// The first bytes.
pub(super) const MARK: &[u8] = b"\x01\x00Directory";

/// Bytes of an entry of the directory: a name, a type, a length and flags.
const ENTRY: usize = 24;

/// The type of a block that is an array.
const ARRAY: u16 = 3;

/// Names of the arrays that have heights. Other arrays are intensities.
const HEIGHTS: [&str; 5] = ["RAW_DATA", "RAW DATA", "OPD", "Raw", "SAMPLE_DATA"];

/// Integers from this value on are missing points.
const MISSING_INTEGER: f64 = 32766.0;
/// Floats from this value on are missing points. They are 1e38 or the next value in 32 bits.
const MISSING_FLOAT: f64 = 9.9999e37;

struct Block<'a> {
    name: String,
    kind: u16,
    bytes: &'a [u8],
}

pub(super) fn channels(bytes: &[u8]) -> Channels<'_> {
    let blocks = blocks(bytes)?;
    let scale = scale(&blocks)?;
    let spacing = spacing(&blocks)?;
    let arrays = blocks.into_iter().filter(|block| block.kind == ARRAY);
    let channels = arrays.map(|block| {
        let scale = HEIGHTS.contains(&block.name.as_str()).then_some(scale);
        Channel {
            name: block.name,
            is_height: scale.is_some(),
            read: Box::new(move || read(block.bytes, scale, spacing)),
        }
    });
    Ok(channels.collect())
}

/// The blocks of the directory. The last blocks of a truncated file have fewer or zero bytes.
fn blocks(bytes: &[u8]) -> Result<Vec<Block<'_>>, FormatError> {
    let mut directory = Bytes::new(bytes, Format::Opd);
    directory.take(2)?;
    let mut entry = || -> Result<_, FormatError> {
        let (name, kind, length) = (text(directory.take(16)?), directory.u16()?, directory.u32()?);
        directory.take(2)?; // Flags.
        // A negative length counts as 0.
        Ok((name, kind, usize::try_from(length as i32).unwrap_or(0)))
    };
    let (name, _, length) = entry()?;
    if name != "Directory" || length < ENTRY {
        return Err(refused(Format::Opd, "first block", &name, "a Directory with entries"));
    }
    let mut at = 2 + length;
    let mut blocks = Vec::new();
    for _ in 1..length / ENTRY {
        let (name, kind, length) = entry()?;
        let rest = Places::new(bytes, Format::Opd).rest(at);
        blocks.push(Block { name, kind, bytes: &rest[..length.min(rest.len())] });
        at = at.saturating_add(length);
    }
    Ok(blocks)
}

fn block<'a>(blocks: &[Block<'a>], name: &str) -> Option<Places<'a>> {
    let block = blocks.iter().find(|block| block.name == name && !block.bytes.is_empty());
    block.map(|block| Places::new(block.bytes, Format::Opd))
}

/// Metres for a height of 1.
fn scale(blocks: &[Block<'_>]) -> Result<f64, FormatError> {
    let wavelength =
        block(blocks, "Wavelength").ok_or(FormatError::Missing { format: Format::Opd, field: "Wavelength" })?;
    let mult = block(blocks, "Mult").map_or(Ok(1), |mult| mult.u16(0))?;
    factor(Format::Opd, "Wavelength / Mult", wavelength.f32(0)? / f64::from(mult) * 1e-9)
}

/// Distances of points (m), or `None` if the file does not have them.
fn spacing(blocks: &[Block<'_>]) -> Result<Option<[f64; 2]>, FormatError> {
    let Some(pixel) = block(blocks, "Pixel_size") else { return Ok(None) };
    let aspect = block(blocks, "Aspect").map_or(Ok(1.0), |aspect| aspect.f32(0))?;
    let millimetres = pixel.f32(0)?;
    Ok(Some([millimetres * 1e-3, millimetres * aspect * 1e-3]))
}

/// An array of heights, or of intensities if `scale` is `None`.
fn read(bytes: &[u8], scale: Option<f64>, spacing: Option<[f64; 2]>) -> Result<HeightMap, FormatError> {
    let mut bytes = Bytes::new(bytes, Format::Opd);
    let (nx, ny, size) = (bytes.u16()?, bytes.u16()?, bytes.u16()?);
    let grid = Grid::new(usize::from(nx), usize::from(ny))?;
    let (number, missing) = match size {
        1 => (Number::U8, f64::INFINITY),
        2 => (Number::I16, MISSING_INTEGER),
        4 => (Number::F32, MISSING_FLOAT),
        other => return Err(refused(Format::Opd, "bytes of a point", &other, "1, 2 or 4")),
    };
    let sides =
        spacing.map(|spacing| sides(Format::Opd, ["Pixel_size", "Pixel_size x Aspect"], grid, spacing)).transpose()?;
    let mut values = transposed(&number.values(bytes.rest(), grid)?, grid);
    let number = scale.unwrap_or(1.0);
    scale_measured(&mut values, number, |value| value >= missing);
    Ok(map(grid, values, scale.is_some(), sides).of_numbers(number))
}
