//! Grayscale TIFF of 16 bits or more: integers and floats.
//!
//! Each image is a channel, with rows from top to bottom. Numbers are read as stored, also where white is
//! zero. Points with the value that GDAL marks are missing.

use std::borrow::Cow;
use std::io::Cursor;

use rc_core::Grid;
use tiff::ColorType;
use tiff::decoder::{Decoder, DecodingResult, Limits};
use tiff::tags::Tag;

use super::channel::{Channel, Channels};
use super::field::field;
use super::fields::shown_as_line;
use super::tiff_sides::{self, Image};
use super::{limit, park, tiff_ifd};
use crate::{Format, FormatError, HeightMap, Unit};

/// Maximum number of bytes that LZW makes of one byte, since 12 bits may represent 4096 bytes.
///
/// Deflate makes fewer.
const MOST_INFLATION: u64 = 2731;

/// Maximum number of images that are channels.
const MOST_IMAGES: usize = 256;

/// Maximum length of a tag. Descriptions of microscopes are long.
const LONGEST_TAG: usize = 16 << 20;

pub(super) fn channels(bytes: &[u8], max_bytes: u64) -> Channels<'_> {
    if park::is_park(bytes) {
        return park::channels(bytes, max_bytes);
    }
    let mut image = opened(bytes)?;
    let mut are_heights = vec![is_of_heights(&mut image)];
    while image.more_images() && are_heights.len() < MOST_IMAGES && image.next_image().is_ok() {
        are_heights.push(is_of_heights(&mut image));
    }
    // An image that cannot be heights says why when it is read.
    let none = !are_heights.contains(&true);
    let channel = |(page, is_height): (usize, bool)| Channel {
        name: String::new(),
        is_height: is_height || none,
        read: Box::new(move || read(bytes, page, max_bytes)),
    };
    Ok(are_heights.into_iter().enumerate().map(channel).collect())
}

/// Whether the first image says the size of the measured rectangle.
pub(super) fn says_sides(bytes: &[u8]) -> bool {
    park::is_park(bytes)
        || opened(bytes).is_ok_and(|mut image| {
            let size = image.dimensions().unwrap_or_default();
            tiff_sides::of(&mut image, size.into()).is_ok_and(|sides| sides.is_some())
        })
}

fn opened(bytes: &[u8]) -> Result<Image<'_>, FormatError> {
    if !tiff_ifd::texts_fit(bytes) {
        let reason = "a text in it is longer than the file".to_owned();
        return Err(FormatError::Container { format: Format::Tiff, reason });
    }
    let mut limits = Limits::default();
    limits.ifd_value_size = LONGEST_TAG;
    // Texts are decoded within this limit.
    limits.decoding_buffer_size = bytes.len();
    Ok(Decoder::new(Cursor::new(bytes)).map_err(|cause| invalid(&cause))?.with_limits(limits))
}

fn invalid(cause: &tiff::TiffError) -> FormatError {
    FormatError::Container { format: Format::Tiff, reason: shown_as_line(&cause.to_string()) }
}

fn unsupported(what: String, cure: &'static str) -> FormatError {
    FormatError::Unsupported { format: Format::Tiff, what, cure }
}

/// Bytes of a level.
fn size_of(image: &mut Image<'_>) -> Result<u64, FormatError> {
    match image.colortype().map_err(|cause| invalid(&cause))? {
        ColorType::Gray(bits @ (16 | 32 | 64)) => Ok(u64::from(bits) / 8),
        other => Err(unsupported(
            format!("a {other:?} image"),
            "save it as 16-bit grayscale; 8 bits are too few for heights",
        )),
    }
}

/// Whether an image has enough levels for heights, and is not a small copy of another.
fn is_of_heights(image: &mut Image<'_>) -> bool {
    let kind = image.find_tag_unsigned::<u32>(Tag::NewSubfileType).ok().flatten().unwrap_or(0);
    kind & 1 == 0 && size_of(image).is_ok()
}

fn read(bytes: &[u8], page: usize, max_bytes: u64) -> Result<HeightMap, FormatError> {
    let stored = tiff_ifd::as_stored(bytes);
    let mut image = opened(&stored)?;
    image.seek_to_image(page).map_err(|cause| invalid(&cause))?;
    let (width, height) = image.dimensions().map_err(|cause| invalid(&cause))?;
    let grid = Grid::new(width as usize, height as usize)?;
    let size = size_of(&mut image)?;
    let (needed, found) = (size * grid.len() as u64, (bytes.len() as u64).saturating_mul(MOST_INFLATION));
    if found < needed {
        return Err(FormatError::CutShort { grid, needed, found });
    }
    let copies = if matches!(stored, Cow::Owned(_)) { 2 } else { 1 };
    limit::check_map(grid, size, copies * bytes.len() as u64, max_bytes)?;
    let (sides, mark) = (tiff_sides::of(&mut image, [width, height])?, missing(&mut image));
    let mut limits = Limits::default();
    limits.ifd_value_size = LONGEST_TAG;
    limits.decoding_buffer_size = usize::try_from(needed).unwrap_or(usize::MAX);
    // Limit of the stored bytes of a strip or tile. A tile may be larger than the image, but not than the file.
    limits.intermediate_buffer_size = bytes.len().max(1 << 20);
    let mut image = image.with_limits(limits);
    let mut values = levels(image.read_image().map_err(|cause| invalid(&cause))?)?;
    if values.len() != grid.len() {
        return Err(FormatError::CutShort { grid, needed, found: size * values.len() as u64 });
    }
    if let Some(mark) = mark {
        values.iter_mut().filter(|value| is_mark(**value, mark)).for_each(|value| *value = f64::NAN);
    }
    let (sides, side_unit) = sides.map_or((None, Unit::Unnamed), |(sides, unit)| (Some(sides), unit));
    Ok(HeightMap::new(field(grid, values), Unit::GreyLevel, sides, side_unit))
}

fn levels(decoded: DecodingResult) -> Result<Vec<f64>, FormatError> {
    Ok(match decoded {
        DecodingResult::U16(levels) => levels.into_iter().map(f64::from).collect(),
        DecodingResult::I16(levels) => levels.into_iter().map(f64::from).collect(),
        DecodingResult::U32(levels) => levels.into_iter().map(f64::from).collect(),
        DecodingResult::I32(levels) => levels.into_iter().map(f64::from).collect(),
        DecodingResult::U64(levels) => levels.into_iter().map(|level| level as f64).collect(),
        DecodingResult::I64(levels) => levels.into_iter().map(|level| level as f64).collect(),
        DecodingResult::F32(levels) => levels.into_iter().map(f64::from).collect(),
        DecodingResult::F64(levels) => levels,
        _ => return Err(unsupported("this type of numbers".to_owned(), "save it as 16-bit grayscale")),
    })
}

/// The value of missing points that GDAL writes.
fn missing(image: &mut Image<'_>) -> Option<f64> {
    let text = image.find_tag(Tag::GdalNodata).ok()??.into_string().ok()?;
    text.trim_end_matches('\0').trim().parse().ok()
}

/// Whether a value is the mark, which may have more digits than 32 bits.
#[expect(clippy::float_cmp, reason = "the mark is one value of the stored type")]
fn is_mark(value: f64, mark: f64) -> bool {
    value == mark || value == f64::from(mark as f32)
}
