//! Grayscale PNG of 16 bits, with levels of grey in rows from top to bottom.

use std::io::Cursor;

use png::{BitDepth, ColorType, Decoder, Limits, Transformations};
use rc_core::Grid;

use super::field::field;
use super::fields::shown_as_line;
use crate::{Format, FormatError, HeightMap, Unit};

/// Maximum number of bytes that deflate makes of one byte. Claims beyond that are false.
const MOST_INFLATION: u64 = 1032;

pub(super) fn parse(bytes: &[u8]) -> Result<HeightMap, FormatError> {
    let invalid = |cause: png::DecodingError| FormatError::Container {
        format: Format::Png,
        reason: shown_as_line(&cause.to_string()),
    };
    // Rows are decoded one by one. The total size of the image is checked below.
    let mut decoder = Decoder::new_with_limits(Cursor::new(bytes), Limits { bytes: 64 << 20 });
    decoder.set_transformations(Transformations::IDENTITY);
    let mut image = decoder.read_info().map_err(invalid)?;
    let info = image.info();
    let grid = Grid::new(info.width as usize, info.height as usize)?;
    let alpha = match (info.color_type, info.bit_depth) {
        (ColorType::Grayscale, BitDepth::Sixteen) => 1,
        (ColorType::GrayscaleAlpha, BitDepth::Sixteen) => 2,
        (colour, depth) => {
            let what = format!("a {}-bit {colour:?} image", depth as u8);
            let cure = "save it as 16-bit grayscale; 8 bits are too few for heights";
            return Err(FormatError::Unsupported { format: Format::Png, what, cure });
        }
    };
    if info.interlaced {
        let what = "an interlaced image".to_owned();
        return Err(FormatError::Unsupported { format: Format::Png, what, cure: "save it without interlacing" });
    }
    let (needed, found) = (2 * alpha * grid.len() as u64, (bytes.len() as u64).saturating_mul(MOST_INFLATION));
    if found < needed {
        return Err(FormatError::CutShort { grid, needed, found });
    }
    let mut values = Vec::with_capacity(grid.len());
    while let Some(row) = image.next_row().map_err(invalid)? {
        let samples = row.data().chunks_exact(2 * alpha as usize);
        values.extend(samples.map(|sample| f64::from(u16::from_be_bytes([sample[0], sample[1]]))));
    }
    if values.len() != grid.len() {
        return Err(FormatError::CutShort { grid, needed, found: 2 * alpha * values.len() as u64 });
    }
    let heights = field(grid, values);
    Ok(HeightMap::new(heights, Unit::GreyLevel, None, Unit::Unnamed))
}
