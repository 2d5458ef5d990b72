//! TIFF of Park Systems.
//!
//! The picture is a thumbnail. The measurement is in private tags: a header, and numbers, whose first row has the
//! lowest y. The documentation of Gwyddion describes them.

use rc_core::Grid;

use super::binary::Number;
use super::channel::{Channel, Channels};
use super::fields::{factor, positive, refused, shown};
use super::instrument::{Places, map, metres};
use super::{limit, tiff_ifd};
use crate::{Format, FormatError, HeightMap};

/// Tags of the mark, of the version, of the numbers, and of the header.
const MARK: u16 = 50432;
const VERSION: u16 = 50433;
const DATA: u16 = 50434;
const HEADER: u16 = 50435;

/// From this version on, the header has a type of numbers.
const WITH_TYPE: u32 = 0x0100_0002;

const MICROMETRE: f64 = 1e-6;

/// Form of the numbers.
struct Image {
    grid: Grid,
    number: Number,
    sides: [f64; 2],
    /// The value of the number 1 without offset, and of the number 0, in m if they are heights.
    scale: [f64; 2],
    is_height: bool,
    /// Whether lines run along y.
    is_turned: bool,
}

/// Whether a TIFF is of Park Systems.
pub(super) fn is_park(bytes: &[u8]) -> bool {
    tiff_ifd::stored(bytes, MARK).is_some()
}

pub(super) fn channels(bytes: &[u8], max_bytes: u64) -> Channels<'_> {
    let missing = |field| FormatError::Missing { format: Format::Tiff, field };
    let header = tiff_ifd::stored(bytes, HEADER).ok_or_else(|| missing("the tag 50435 of Park Systems"))?;
    let data = tiff_ifd::stored(bytes, DATA).ok_or_else(|| missing("the tag 50434 of Park Systems"))?;
    let version = tiff_ifd::stored(bytes, VERSION).and_then(|version| version.first_chunk());
    let header = Places::new(header, Format::Tiff);
    let image = image(header, version.map_or(0, |version| u32::from_le_bytes(*version)))?;
    let others = bytes.len() as u64;
    Ok(vec![Channel {
        name: wide(&header.array::<64>(4)?),
        is_height: image.is_height,
        read: Box::new(move || {
            // A promise of more numbers than there are is refused as such.
            if image.number.bytes_of(image.grid) <= others {
                limit::check_map(image.grid, if image.is_turned { 8 } else { 0 }, others, max_bytes)?;
            }
            image.read(data)
        }),
    }])
}

fn image(header: Places<'_>, version: u32) -> Result<Image, FormatError> {
    let what = match header.u32(0)? {
        0 => None,
        1 => Some("a profile of a Park AFM"),
        _ => Some("spectra of a Park AFM"),
    };
    if let Some(what) = what {
        let cure = "choose a file with an image";
        return Err(FormatError::Unsupported { format: Format::Tiff, what: what.to_owned(), cure });
    }
    let number = match if version < WITH_TYPE { 0 } else { header.u32(348)? } {
        0 => Number::I16,
        1 => Number::I32,
        2 => Number::F32,
        other => return Err(refused(Format::Tiff, "type of numbers of Park Systems", &other, "0, 1 or 2")),
    };
    let side = |field, at| positive(Format::Tiff, field, header.f64(at)? * MICROMETRE);
    let unit = wide(&header.array::<16>(244)?);
    let length = if unit.is_empty() { Some(MICROMETRE) } else { metres(&unit) };
    let gain = header.f64(220)? * length.unwrap_or(1.0);
    // Some programs leave out the scale, which is 1.
    let scale = Some(header.f64(228)?).filter(|scale| *scale != 0.0).unwrap_or(1.0);
    let zero = header.f64(236)? * gain;
    if !zero.is_finite() {
        return Err(refused(Format::Tiff, "offset of heights of Park Systems", &zero, "finite"));
    }
    Ok(Image {
        grid: Grid::new(header.size(100)?, header.size(104)?)?,
        number,
        sides: [side("side along x of Park Systems", 140)?, side("side along y of Park Systems", 148)?],
        scale: [factor(Format::Tiff, "scale of heights of Park Systems", gain * scale)?, zero],
        is_height: length.is_some(),
        is_turned: header.u32(136)? != 0,
    })
}

impl Image {
    fn read(&self, data: &[u8]) -> Result<HeightMap, FormatError> {
        let mut values = self.number.values_alone(data, self.grid)?;
        let [scale, zero] = self.scale;
        for value in &mut values {
            *value = *value * scale + zero;
        }
        if !self.is_turned {
            return Ok(map(self.grid, values, self.is_height, Some(self.sides)));
        }
        // Lines along y, from the last one on.
        let (nx, ny) = (self.grid.nx(), self.grid.ny());
        let turned = (0..nx).flat_map(|ix| (0..ny).rev().map(move |iy| (ix, iy)));
        let turned = turned.map(|(ix, iy)| values[iy * nx + ix]).collect();
        let [x, y] = self.sides;
        Ok(map(Grid::new(ny, nx)?, turned, self.is_height, Some([y, x])))
    }
}

/// A text of UTF-16 that ends at a zero.
fn wide(bytes: &[u8]) -> String {
    let (units, _) = bytes.as_chunks::<2>();
    let units = units.iter().map(|unit| u16::from_le_bytes(*unit)).take_while(|unit| *unit != 0);
    let text: String = char::decode_utf16(units).map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER)).collect();
    shown(text.trim())
}
