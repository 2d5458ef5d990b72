//! Digital Surf files ("Surface file format", Digital Surf).
//!
//! The format has objects one after the other. Each has a header of 512 bytes, a comment, private bytes, and integers,
//! plain or compressed by zlib. Rows are from top to bottom. The documentation of Gwyddion and of RosettaSciIO
//! describes the header too. Heights are offset + spacing x integer. Some programs count integers from the lowest.

use std::io::Read as _;

use flate2::read::ZlibDecoder;
use rc_core::Grid;

use super::binary::Number;
use super::channel::{Channel, Channels, each};
use super::field::flip;
use super::fields::{factor, refused, shown_as_line};
use super::instrument::{Places, map, metres, scale_measured, sides};
use super::limit;
use super::params::ReadParams;
use crate::{Format, FormatError, HeightMap};

/// The first bytes of an object with integers that are not compressed.
pub(super) const PLAIN: &[u8] = b"DIGITAL SURF";
/// The first bytes of an object with compressed integers.
pub(super) const COMPRESSED: &[u8] = b"DSCOMPRESSED";

const HEADER: usize = 512;

/// The type of objects that are profiles. Gwyddion gives it to surfaces too.
const PROFILE: u16 = 1;

/// The types of objects with a spectrum at each point.
const SPECTRA: [u16; 2] = [20, 21];

/// Types of objects whose values are levels of grey or colours: a binary image, images of intensity and of colours.
const PICTURES: [u16; 4] = [3, 10, 12, 18];

/// Types of objects that are not maps on a rectangle, with a description.
///
/// The types are those of Digital Surf, as RosettaSciIO lists them.
const OTHERS: [(u16, &str); 7] = [
    (4, "a series of profiles, not a map"),
    (6, "a disc in polar coordinates"),
    (7, "a profile of several layers, not a map"),
    (9, "a disc in polar coordinates"),
    (14, "a force curve, not a map"),
    (15, "a series of force curves, not a map"),
    (17, "a contour, not a map"),
];

/// Maximum number of bytes that deflate makes of one byte. Claims beyond that are false.
const MOST_INFLATION: u64 = 1032;

/// An object, with its header and the bytes from its integers on.
struct Object<'a> {
    name: String,
    grid: Grid,
    number: Number,
    kind: u16,
    /// Number of values at a point: 1, or the length of its spectrum.
    values: usize,
    compressed: bool,
    /// The integer of a missing point.
    missing: Option<f64>,
    /// The height of an integer of 1 without offset, and the height of an integer of 0.
    scale: [f64; 2],
    is_height: bool,
    /// Sides (m), or `None` if the axes are not lengths.
    sides: Option<[f64; 2]>,
    inversion: u16,
    data: &'a [u8],
}

/// Whether the first object is a profile.
pub(super) fn has_profile(bytes: &[u8]) -> bool {
    object(bytes).is_ok_and(|object| object.is_profile())
}

pub(super) fn channels<'a>(bytes: &'a [u8], params: &ReadParams) -> Channels<'a> {
    let (max_bytes, takes_profiles) = (params.max_bytes, params.is_profile);
    let mut channels = Vec::new();
    let mut rest = bytes;
    loop {
        let object = match object(rest) {
            Ok(object) => object,
            // It is not known where the next objects begin.
            Err(error) => {
                channels.push((String::new(), Err(error)));
                return Ok(each(channels));
            }
        };
        let stored = object.stored();
        let data = object.data;
        let (name, is_height) = (object.name.clone(), object.is_height && !PICTURES.contains(&object.kind));
        let channel = object.is_map(takes_profiles).map(|()| {
            let read = Box::new(move || object.read(is_height, max_bytes));
            Channel { name: name.clone(), is_height, read }
        });
        channels.push((name, channel));
        rest = stored.and_then(|stored| data.get(stored..)).unwrap_or_default();
        // A later object that is cut off before its integers does not prevent reading the others.
        if !(rest.starts_with(PLAIN) || rest.starts_with(COMPRESSED)) || rest.len() < HEADER {
            return Ok(each(channels));
        }
    }
}

fn object(bytes: &[u8]) -> Result<Object<'_>, FormatError> {
    let header = Places::new(bytes, Format::Sur);
    if !(bytes.starts_with(PLAIN) || bytes.starts_with(COMPRESSED)) {
        let expected = "it must begin with DIGITAL SURF or DSCOMPRESSED";
        return Err(FormatError::Mark { format: Format::Sur, expected });
    }
    let field = |field, found: u16, expected| Err(refused(Format::Sur, field, &found, expected));
    let number = match (header.u16(12)?, header.u16(98)?) {
        (0, 8) => Number::U8,
        (0, 16) => Number::I16,
        (0, 32) => Number::I32,
        (0, bits) => return field("bits of a point", bits, "8, 16 or 32"),
        (format, _) => return field("format", format, "0, the byte order of a PC"),
    };
    let count = |at| header.i32(at).map(|n| usize::try_from(n).unwrap_or(0));
    let grid = Grid::new(count(108)?, count(112)?)?;
    if count(116)? != grid.len() {
        return Err(refused(Format::Sur, "number of points", &header.i32(116)?, "points of a line x lines"));
    }
    let units = [header.text::<16>(180)?, header.text::<16>(196)?, header.text::<16>(212)?];
    let [x, y, z] = [metres(&units[0]), metres(&units[1]), metres(&units[2])];
    let sides = match (x, y) {
        // A profile has no axis y.
        (Some(x), _) if header.u16(18)? == PROFILE && grid.ny() == 1 => {
            let spacing = [x * header.f32(120)?; 2];
            Some(sides(Format::Sur, ["spacing along x"; 2], grid, spacing)?)
        }
        (Some(x), Some(y)) => {
            let spacing = [x * header.f32(120)?, y * header.f32(124)?];
            Some(sides(Format::Sur, ["spacing along x", "spacing along y"], grid, spacing)?)
        }
        _ => None,
    };
    let scale = factor(Format::Sur, "spacing along z", header.f32(128)? * z.unwrap_or(1.0))?;
    let name = [header.text::<30>(20)?, header.text::<16>(164)?].into_iter().find(|name| !name.is_empty());
    Ok(Object {
        name: name.unwrap_or_default(),
        grid,
        number,
        kind: header.u16(18)?,
        values: if SPECTRA.contains(&header.u16(18)?) { header.size(94)?.max(1) } else { 1 },
        compressed: bytes.starts_with(COMPRESSED),
        missing: if header.u16(86)? == 1 { Some(f64::from(header.i32(100)?) - 2.0) } else { None },
        scale: [scale, header.f32(474)? * z.unwrap_or(1.0)],
        is_height: z.is_some(),
        sides,
        inversion: header.u16(290)?,
        data: header.rest(HEADER + usize::from(header.u16(334)?) + usize::from(header.u16(336)?)),
    })
}

impl Object<'_> {
    fn is_profile(&self) -> bool {
        self.kind == PROFILE && self.grid.ny() == 1
    }

    /// An error for an object that is neither a map nor a profile that is asked for.
    fn is_map(&self, takes_profiles: bool) -> Result<(), FormatError> {
        let other = OTHERS.iter().find(|(kind, _)| *kind == self.kind).map(|(_, what)| *what);
        let (what, cure) = if self.is_profile() && takes_profiles {
            return Ok(());
        } else if self.is_profile() {
            ("a profile, not a map,".to_owned(), "save the surface, or give --line for the contact of a profile")
        } else if let Some(what) = other {
            (what.to_owned(), "a map of heights is needed: save the surface")
        } else if self.values > 1 {
            (format!("an object of {} values a point", self.values), "save a map of one of them")
        } else {
            return Ok(());
        };
        Err(FormatError::Unsupported { format: Format::Sur, what, cure })
    }

    fn read(&self, is_height: bool, max_bytes: u64) -> Result<HeightMap, FormatError> {
        self.check_size(max_bytes)?;
        let inflated = if self.compressed { Some(self.inflated()?) } else { None };
        let mut values = self.number.values(inflated.as_deref().unwrap_or(self.data), self.grid)?;
        // Heights of a replica are negative. The file says so, and along which axis the replica is mirrored.
        let [scale, offset] = self.scale;
        let scale = if matches!(self.inversion, 1..=3) { -scale } else { scale };
        scale_measured(&mut values, scale, |value| Some(value) == self.missing);
        if offset != 0.0 {
            for value in &mut values {
                *value += offset;
            }
        }
        flip(&mut values, self.grid, [self.inversion == 2, self.inversion == 3]);
        // With an offset, heights are not numbers of the file times a factor.
        let number = if offset == 0.0 { scale } else { 1.0 };
        Ok(map(self.grid, values, is_height, self.sides).of_numbers(number))
    }

    /// Refuses integers that are there and need too much memory.
    fn check_size(&self, max_bytes: u64) -> Result<(), FormatError> {
        let (unpacked, inflation) = if self.compressed { (self.number.size() as u64, MOST_INFLATION) } else { (0, 1) };
        let (stored, needed) = (self.data.len() as u64, self.number.bytes_of(self.grid));
        if needed > stored.saturating_mul(inflation) {
            return Err(FormatError::CutShort { grid: self.grid, needed, found: stored });
        }
        limit::check_map(self.grid, unpacked, stored, max_bytes)
    }

    /// The number of streams, and for each its length after and before decompression.
    ///
    /// The streams follow in the file.
    fn streams(&self) -> Result<(Vec<[usize; 2]>, usize), FormatError> {
        let directory = Places::new(self.data, Format::Sur);
        let count = directory.size(0)?;
        if count > self.data.len() / 8 {
            return Err(FormatError::HeaderCutShort { format: Format::Sur });
        }
        let lengths = |i| Ok([directory.size(4 + 8 * i)?, directory.size(8 + 8 * i)?]);
        Ok(((0..count).map(lengths).collect::<Result<_, FormatError>>()?, 4 + 8 * count))
    }

    /// Number of bytes of the integers in the file, or `None` if unknown.
    fn stored(&self) -> Option<usize> {
        if !self.compressed {
            return usize::try_from(self.number.bytes_of(self.grid)).ok()?.checked_mul(self.values);
        }
        let (lengths, start) = self.streams().ok()?;
        lengths.iter().try_fold(start, |end, [_, stored]| end.checked_add(*stored))
    }

    /// The integers of all streams.
    fn inflated(&self) -> Result<Vec<u8>, FormatError> {
        let needed = self.number.bytes_of(self.grid);
        let (lengths, mut at) = self.streams()?;
        let mut integers = Vec::new();
        for [_, stored] in lengths {
            let stream = Places::new(self.data, Format::Sur).rest(at);
            let stream = &stream[..stored.min(stream.len())];
            // One byte more than needed is read, because the checksum of a stream is verified at its end.
            let room = (needed + 1).saturating_sub(integers.len() as u64);
            let read = ZlibDecoder::new(stream).take(room).read_to_end(&mut integers);
            read.map_err(|cause| FormatError::Container {
                format: Format::Sur,
                reason: shown_as_line(&cause.to_string()),
            })?;
            at = at.saturating_add(stored);
        }
        let found = integers.len() as u64;
        if found > needed {
            return Err(FormatError::Surplus { grid: self.grid, needed, found });
        }
        Ok(integers)
    }
}
