//! Grayscale TIFF of 16 bits, or of 32-bit floats.
//!
//! The first image is read, with rows from top to bottom.

use std::io::Cursor;

use rc_core::Grid;
use tiff::ColorType;
use tiff::decoder::{Decoder, DecodingResult, Limits};
use tiff::tags::Tag;

use super::field::field;
use super::fields::shown_as_line;
use crate::{Format, FormatError, HeightMap, Unit};

/// Maximum number of bytes that LZW makes of one byte, since 12 bits may represent 4096 bytes.
///
/// Deflate makes fewer.
const MOST_INFLATION: u64 = 2731;

/// A tag that only files of Park Systems have. Their heights are in other tags.
const PARK: u16 = 50432;

pub(super) fn parse(bytes: &[u8]) -> Result<HeightMap, FormatError> {
    let invalid = |cause: tiff::TiffError| FormatError::Container {
        format: Format::Tiff,
        reason: shown_as_line(&cause.to_string()),
    };
    let mut decoder = Decoder::new(Cursor::new(bytes)).map_err(invalid)?;
    let (width, height) = decoder.dimensions().map_err(invalid)?;
    if decoder.find_tag(Tag::Unknown(PARK)).map_err(invalid)?.is_some() {
        let what = "a file from a Park AFM, whose picture is a thumbnail,".to_owned();
        let cure = "export its heights as text or save it as .gwy with Gwyddion";
        return Err(FormatError::Unsupported { format: Format::Tiff, what, cure });
    }
    let grid = Grid::new(width as usize, height as usize)?;
    let size = match decoder.colortype().map_err(invalid)? {
        ColorType::Gray(16) => 2,
        ColorType::Gray(32) => 4,
        other => {
            let cure = "save it as 16-bit grayscale; 8 bits are too few for heights";
            return Err(FormatError::Unsupported { format: Format::Tiff, what: format!("a {other:?} image"), cure });
        }
    };
    let (needed, found) = (size * grid.len() as u64, (bytes.len() as u64).saturating_mul(MOST_INFLATION));
    if found < needed {
        return Err(FormatError::CutShort { grid, needed, found });
    }
    let mut limits = Limits::default();
    limits.decoding_buffer_size = usize::try_from(needed).unwrap_or(usize::MAX);
    // Limit of the stored bytes of a strip or tile. A tile may be larger than the image, but not than the file.
    limits.intermediate_buffer_size = bytes.len().max(1 << 20);
    let levels = decoder.with_limits(limits).read_image().map_err(invalid)?;
    let values: Vec<f64> = match levels {
        DecodingResult::U16(levels) => levels.into_iter().map(f64::from).collect(),
        DecodingResult::I16(levels) => levels.into_iter().map(f64::from).collect(),
        DecodingResult::U32(levels) => levels.into_iter().map(f64::from).collect(),
        DecodingResult::I32(levels) => levels.into_iter().map(f64::from).collect(),
        DecodingResult::F32(levels) => levels.into_iter().map(f64::from).collect(),
        _ => {
            let what = "this type of numbers".to_owned();
            return Err(FormatError::Unsupported { format: Format::Tiff, what, cure: "save it as 16-bit grayscale" });
        }
    };
    if values.len() != grid.len() {
        return Err(FormatError::CutShort { grid, needed, found: size * values.len() as u64 });
    }
    let heights = field(grid, values);
    Ok(HeightMap::new(heights, Unit::GreyLevel, None, Unit::Unnamed))
}
