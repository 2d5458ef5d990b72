//! The formats, and functions that read a file.

mod al3d;
mod archive;
mod axes;
mod binary;
mod channel;
mod cloud;
mod decode;
mod endian;
mod esri;
mod field;
mod fields;
mod format;
mod gsf;
mod gwy;
mod heading;
mod ibw;
mod instrument;
mod layout;
mod lines;
mod marks;
mod mask;
mod mat;
mod metropro;
mod names;
mod nanoscope;
mod netcdf;
pub mod npy;
mod opd;
mod plu;
mod plux;
mod png;
mod quantity;
mod sdf;
mod sniff;
mod strangers;
mod sur;
mod surfer;
mod table;
pub mod text;
mod tiff;
mod titles;
mod unit;
mod vk4;
mod x3p;
mod xyz;
mod zygo;

use std::fs::File;
use std::io::Read as _;
use std::path::Path;

pub use channel::ChannelInfo;
pub(crate) use decode::{decoded, is_text};
pub(crate) use fields::shown;
pub use format::Format;
pub use layout::{Layout, LayoutError};
pub(crate) use lines::{data_lines, number, words};
pub use mask::{Mask, MaskError};
pub use mat::{MatArray, mat_arrays};
pub(crate) use netcdf::hdf5_table;

use self::channel::{Channels, chosen, named, only};
use crate::{FormatError, HeightMap, ReadError};

/// Choices for files that can be read in several ways.
#[derive(Clone, Debug, PartialEq)]
pub struct ReadParams {
    /// Name of a channel. `None` means the first channel with heights.
    pub channel: Option<String>,
    /// Layout of a text. `None` means the layout that its first lines suggest.
    pub layout: Option<Layout>,
    /// Values that mark missing points, in the numbers of the file.
    pub missing: Vec<f64>,
    /// What a mask in the file means.
    pub mask: Mask,
    /// Maximum number of bytes of anything that a file unpacks to, and of the map itself.
    pub max_bytes: u64,
}

impl Default for ReadParams {
    fn default() -> Self {
        Self { channel: None, layout: None, missing: Vec::new(), mask: Mask::default(), max_bytes: DEFAULT_MAX_BYTES }
    }
}

/// Default of [`ReadParams::max_bytes`]: a map of 16384² points.
///
/// A program that knows its machine gives its own.
pub const DEFAULT_MAX_BYTES: u64 = 4 << 30;

/// The format of the file at `path`. For a gzip file, it is the format of the contents.
///
/// # Errors
/// Those of [`read`], as far as they follow from the first bytes.
pub fn format_of(path: &Path) -> Result<Format, ReadError> {
    Opened::new(path, DEFAULT_MAX_BYTES).map(|file| file.format)
}

/// Whether the file at `path` may contain the size of the measured rectangle.
///
/// False for a format without sizes, and for a text whose first lines do not contain the size.
///
/// # Errors
/// Those of [`read`], as far as they follow from the first bytes.
pub fn may_have_sides(path: &Path, params: &ReadParams) -> Result<bool, ReadError> {
    let file = Opened::new(path, params.max_bytes)?;
    Ok(match layout::format(file.format, params.layout) {
        Format::Csv => text::may_have_sides(&file.bytes),
        format => format.has_sides(),
    })
}

/// A file whose format is known.
struct Opened {
    format: Format,
    /// The first bytes, or all bytes.
    bytes: Vec<u8>,
    /// Source of the other bytes.
    rest: Option<File>,
}

impl Opened {
    /// Opens a file that unpacks to at most `max_bytes`.
    fn new(path: &Path, max_bytes: u64) -> Result<Self, ReadError> {
        Self::open(path, max_bytes).map_err(|problem| ReadError { path: path.to_owned(), problem })
    }

    fn open(path: &Path, max_bytes: u64) -> Result<Self, FormatError> {
        let mut file = File::open(path).map_err(unreadable)?;
        if file.metadata().map_err(unreadable)?.is_dir() {
            return Err(FormatError::Unreadable("it is a folder, not a height map such as .npy or .csv".into()));
        }
        let mut bytes = Vec::new();
        // Enough for a mark, and for the first lines of a text.
        file.by_ref().take(4096).read_to_end(&mut bytes).map_err(unreadable)?;
        if bytes.starts_with(archive::GZIP) {
            file.read_to_end(&mut bytes).map_err(unreadable)?;
            let bytes = archive::unzipped(&bytes, max_bytes)?;
            let is_gz = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("gz"));
            let name = if is_gz { path.with_extension("") } else { path.to_owned() };
            return Ok(Self { format: Format::of(&name, &bytes)?, bytes, rest: None });
        }
        if bytes.starts_with(archive::ZIP) {
            file.read_to_end(&mut bytes).map_err(unreadable)?;
            return Ok(Self { format: Format::of(path, &bytes)?, bytes, rest: None });
        }
        let mut format = Format::of(path, &bytes)?;
        // The first numbers of a text determine its layout. Many lines may precede them.
        while matches!(format, Format::Csv | Format::Xyz) && !xyz::has_numbers(&bytes) {
            let as_many = bytes.len() as u64;
            if file.by_ref().take(as_many).read_to_end(&mut bytes).map_err(unreadable)? == 0 {
                break;
            }
            format = Format::of(path, &bytes)?;
        }
        Ok(Self { format, bytes, rest: Some(file) })
    }

    /// Reads all bytes.
    fn whole(mut self) -> Result<Vec<u8>, FormatError> {
        if let Some(mut rest) = self.rest.take() {
            rest.read_to_end(&mut self.bytes).map_err(unreadable)?;
        }
        Ok(self.bytes)
    }
}

#[expect(clippy::needless_pass_by_value, reason = "the shape that map_err wants")]
fn unreadable(cause: std::io::Error) -> FormatError {
    FormatError::Unreadable(cause.to_string())
}

/// Reads the height map at `path`, in the units of the file ([`HeightMap::in_metres`]).
///
/// Row `iy` of the file is row `iy` of the field, and a missing point is `NaN`. If the file has several channels, the
/// first with heights is read.
///
/// # Errors
/// [`ReadError`] when the file cannot be read, has an unknown format, is damaged, has no measured point, or has an
/// infinite height.
pub fn read(path: &Path) -> Result<HeightMap, ReadError> {
    read_with(path, &ReadParams::default())
}

/// Reads the channel and layout that `params` select, as [`read`].
///
/// # Errors
/// Those of [`read`], and [`FormatError::NoChannel`] for a channel that the file does not have.
pub fn read_with(path: &Path, params: &ReadParams) -> Result<HeightMap, ReadError> {
    let fail = |problem: FormatError| ReadError { path: path.to_owned(), problem };
    let file = Opened::new(path, params.max_bytes)?;
    if file.format == Format::Npy && file.rest.is_some() && params.channel.is_none() {
        // Arrays may be as large as memory, so they are not read as bytes first.
        return checked(HeightMap::bare(npy::read(path)?), &params.missing).map_err(fail);
    }
    let format = layout::format(file.format, params.layout);
    file.whole().and_then(|bytes| parse_with(&bytes, format, params)).map_err(fail)
}

/// The channels of the file at `path`, in its order. Their values are not read.
///
/// Of `params`, only the layout and the limit of memory matter.
///
/// # Errors
/// [`ReadError`] when the file cannot be read, has an unknown format, or is damaged.
pub fn channels(path: &Path, params: &ReadParams) -> Result<Vec<ChannelInfo>, ReadError> {
    let file = Opened::new(path, params.max_bytes)?;
    let format = layout::format(file.format, params.layout);
    if format == Format::Npy {
        // The file has one array, which may be as large as memory.
        return Ok(vec![ChannelInfo { name: String::new(), is_height: true }]);
    }
    let channels = file.whole().and_then(|bytes| channels_of(&bytes, format, params));
    channels.map_err(|problem| ReadError { path: path.to_owned(), problem })
}

/// The channels in the bytes of a file of the given format, as [`channels`].
///
/// # Errors
/// [`FormatError`] when the bytes are not valid.
pub fn channels_of(bytes: &[u8], format: Format, params: &ReadParams) -> Result<Vec<ChannelInfo>, FormatError> {
    Ok(named(in_bytes(bytes, format, params)?).iter().map(ChannelInfo::from).collect())
}

/// Reads a height map from the bytes of a file of the given format.
///
/// # Errors
/// [`FormatError`] when the bytes are not valid, as for [`read`].
pub fn parse(bytes: &[u8], format: Format) -> Result<HeightMap, FormatError> {
    parse_with(bytes, format, &ReadParams::default())
}

/// Reads the channel that `params` select, as [`parse`].
///
/// # Errors
/// [`FormatError`] when the bytes are not valid, as for [`read_with`].
pub fn parse_with(bytes: &[u8], format: Format, params: &ReadParams) -> Result<HeightMap, FormatError> {
    let channel = chosen(named(in_bytes(bytes, format, params)?), params.channel.as_deref())?;
    // Readers of texts compare the marks of the user with numbers as they are written, before any unit.
    let is_text = matches!(format, Format::Csv | Format::EsriGrid | Format::Xyz | Format::Zygo)
        || format == Format::Nanoscope && is_text(bytes);
    checked((channel.read)()?, if is_text { &[] } else { &params.missing })
}

/// The channels of a file of the given format.
fn in_bytes<'a>(bytes: &'a [u8], format: Format, params: &ReadParams) -> Channels<'a> {
    Ok(match format {
        Format::Al3d => al3d::channels(bytes)?,
        Format::Csv => text::channels(bytes, params.layout, &params.missing)?,
        Format::EsriGrid => esri::channels(bytes, &params.missing)?,
        Format::Gsf => only(move || gsf::parse(bytes)),
        Format::Gwy => gwy::channels(bytes)?,
        Format::Hdf5 | Format::NetCdf => netcdf::channels(bytes, format)?,
        Format::Ibw => ibw::channels(bytes)?,
        Format::Mat => mat::channels(bytes)?,
        Format::MetroPro => metropro::channels(bytes)?,
        // Exports as text have the same header.
        Format::Nanoscope if is_text(bytes) => text::channels(bytes, params.layout, &params.missing)?,
        Format::Nanoscope => nanoscope::channels(bytes)?,
        Format::Npy => only(move || npy::read_from(bytes, bytes.len() as u64).map(HeightMap::bare)),
        Format::Opd => opd::channels(bytes)?,
        Format::Plu => plu::channels(bytes)?,
        Format::Plux => plux::channels(bytes)?,
        Format::Png => only(move || png::parse(bytes)),
        Format::Sdf => only(move || sdf::parse(bytes)),
        Format::Sur => sur::channels(bytes)?,
        Format::Surfer => only(move || surfer::parse(bytes)),
        Format::Tiff => only(move || tiff::parse(bytes)),
        Format::Vk4 => vk4::channels(bytes)?,
        Format::X3p => only(move || x3p::parse(bytes)),
        Format::Xyz => xyz::channels(bytes, &params.missing),
        Format::Zygo => zygo::channels(bytes, &params.missing),
    })
}

/// Makes the points missing that have a mark of the user, one of `missing`.
///
/// Refuses infinite heights and maps without a measured point.
fn checked(mut map: HeightMap, missing: &[f64]) -> Result<HeightMap, FormatError> {
    marks::Marks::new(missing, &[]).erase(map.heights.values_mut());
    let (values, nx) = (map.heights.values(), map.heights.grid().nx());
    if let Some(i) = values.iter().position(|height| height.is_infinite()) {
        return Err(FormatError::Infinite { row: i / nx, column: i % nx, value: values[i] });
    }
    if values.iter().all(|height| height.is_nan()) {
        return Err(FormatError::Empty(values.len()));
    }
    Ok(map)
}
