//! The formats, and functions that read a file.

mod al3d;
mod archive;
mod axes;
mod bcr;
mod binary;
mod brackets;
mod channel;
mod cloud;
mod datx;
mod decode;
mod endian;
mod esri;
mod field;
mod fields;
mod format;
mod frt;
pub mod gsf;
mod gwy;
mod heading;
mod ibw;
mod instrument;
mod layout;
mod limit;
mod lines;
mod marks;
mod mask;
mod mat;
mod mat_maps;
mod metropro;
mod names;
mod nanoscope;
pub mod nc_writer;
mod netcdf;
mod netcdf_axes;
mod netcdf_beside;
mod netcdf_lines;
mod netcdf_maps;
mod nid;
pub mod npy;
mod opd;
mod opdx;
mod opdx_profile;
mod opened;
mod order;
mod other;
mod params;
mod park;
mod plu;
mod plux;
mod png;
mod points;
mod profile;
mod quantity;
mod records;
mod scalings;
mod sdf;
mod sniff;
mod sur;
mod surfer;
mod table;
pub mod text;
mod tiff;
mod tiff_ifd;
mod tiff_sides;
mod titles;
mod unit;
mod vk4;
mod vk6;
mod wsxm;
mod x3p;
mod xyz;
mod zygo;

use std::path::Path;

pub use channel::ChannelInfo;
pub(crate) use decode::{decoded, is_text};
pub(crate) use fields::shown;
pub use format::Format;
pub use layout::{Layout, LayoutError};
pub use limit::DEFAULT_MAX_BYTES;
pub(crate) use limit::{check as check_size, check_text};
pub(crate) use lines::{data_lines, number, words};
pub use mask::{Mask, MaskError};
pub use mat::{MatArray, mat_arrays};
pub(crate) use netcdf::hdf5_table;
pub use params::ReadParams;
pub use points::of_points;

use self::channel::{Channels, chosen, named, only};
use self::opened::Opened;
use crate::{FormatError, HeightMap, ReadError, ReadNote, Unit};

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
    let format = layout::format(file.format, params.layout);
    if matches!(format, Format::Png | Format::Tiff) {
        // Their sizes may be behind the levels.
        let says_sides = if format == Format::Png { png::says_sides } else { tiff::says_sides };
        let bytes = file.whole(format, params);
        return bytes.map(|bytes| says_sides(&bytes)).map_err(|problem| ReadError { path: path.to_owned(), problem });
    }
    Ok(match format {
        Format::Npy => npy::has_points(&file.start, params.layout),
        // Only the last line tells the step of a profile.
        Format::Csv | Format::Xyz if params.is_profile => true,
        Format::Csv => text::may_have_sides(&file.start),
        format => format.has_sides(),
    })
}

/// Reads the height map at `path`, in the units of the file ([`HeightMap::in_metres`]).
///
/// Row `iy` of the file is row `iy` of the field, unless the format has its top first ([`Format::first_row_is_top`]):
/// then rows are reversed, so that y points up, and a note says so. A missing point is `NaN`. If the file has several
/// channels, the first with heights is read.
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
    if file.format == Format::Npy && params.channel.is_none() {
        // Arrays may be as large as memory, so they are not read as bytes first.
        let max_bytes = file.limit(params);
        let (stream, bytes) = file.stream();
        return npy::map(stream, bytes, params, max_bytes).and_then(|map| checked(map, &params.missing)).map_err(fail);
    }
    let format = layout::format(file.format, params.layout);
    let bytes = file.whole(format, params);
    bytes.and_then(|bytes| parse_with(&bytes, format, params)).map_err(fail)
}

/// The profile of a text. Units and marks are those of its columns.
fn profile_of_text(bytes: &[u8], params: &ReadParams) -> Result<HeightMap, FormatError> {
    let map = checked(profile::parse(bytes, &params.missing)?, &[])?;
    let is_unused = !params.missing.is_empty() && map.missing() == 0;
    Ok(if is_unused { map.with_note(ReadNote::NoMark) } else { map })
}

/// Whether the file at `path` has a profile: a text of one or two columns, an array of one row, a profile of an
/// instrument.
///
/// # Errors
/// Those of [`read`], as far as they follow from the first bytes.
pub fn has_profile(path: &Path, params: &ReadParams) -> Result<bool, ReadError> {
    let file = Opened::new(path, params.max_bytes)?;
    let format = layout::format(file.format, params.layout);
    Ok(match format {
        _ if params.layout.is_some() => false,
        Format::Csv | Format::Xyz => profile::looks_like_profile(&file.start),
        Format::Npy => npy::has_profile(&file.start),
        Format::Sur => {
            let fail = |problem: FormatError| ReadError { path: path.to_owned(), problem };
            file.whole(format, params).map(|bytes| sur::has_profile(&bytes)).map_err(fail)?
        }
        Format::Opdx => {
            let fail = |problem: FormatError| ReadError { path: path.to_owned(), problem };
            file.whole(format, params).map(|bytes| opdx::has_profile(&bytes)).map_err(fail)?
        }
        _ => false,
    })
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
    let channels = file.whole(format, params).and_then(|bytes| channels_of(&bytes, format, params));
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
    if params.is_profile {
        let is_text = matches!(format, Format::Csv | Format::Xyz);
        return if is_text {
            profile_of_text(bytes, params)
        } else {
            profile::of_map(chosen_map(bytes, format, params)?)
        };
    }
    chosen_map(bytes, format, params)
}

/// The map in the channel that `params` select.
fn chosen_map(bytes: &[u8], format: Format, params: &ReadParams) -> Result<HeightMap, FormatError> {
    let channels = named(in_bytes(bytes, format, params)?);
    let of_heights = channels.iter().filter(|channel| channel.is_height).count();
    let is_first_of_several = params.channel.is_none() && of_heights > 1;
    let channel = chosen(channels, params.channel.as_deref())?;
    let name = channel.name.clone();
    // Readers of texts compare the marks of the user with numbers as they are written, before any unit.
    let is_text = matches!(format, Format::Csv | Format::EsriGrid | Format::Xyz | Format::Zygo)
        || format == Format::Nanoscope && is_text(bytes);
    let missing: &[f64] = if is_text { &[] } else { &params.missing };
    let map = checked((channel.read)()?, missing).map(|map| order::bottom_first(map, bytes, format))?;
    // Channels with a unit of length are heights, or at least deviations of heights.
    let map = if is_first_of_several && matches!(map.height_unit, Unit::Unnamed | Unit::Array) {
        map.with_note(ReadNote::FirstOfSeveral { name: fields::shown(&name), of: of_heights })
    } else {
        map
    };
    let is_unused = !params.missing.is_empty() && map.missing() == 0;
    Ok(if is_unused { map.with_note(ReadNote::NoMark) } else { map })
}

/// The channels of a file of the given format.
fn in_bytes<'a>(bytes: &'a [u8], format: Format, params: &'a ReadParams) -> Channels<'a> {
    Ok(match format {
        Format::Al3d => al3d::channels(bytes)?,
        Format::Bcr => bcr::channels(bytes)?,
        Format::Csv => text::channels(bytes, params.layout, &params.missing)?,
        Format::EsriGrid => esri::channels(bytes, &params.missing)?,
        Format::Frt => frt::channels(bytes)?,
        Format::Gsf => only(move || gsf::parse(bytes)),
        Format::Gwy => gwy::channels(bytes, params.mask)?,
        Format::Hdf5 | Format::NetCdf => netcdf_maps::channels(bytes, format, params)?,
        Format::Ibw => ibw::channels(bytes)?,
        Format::Mat => mat_maps::channels(bytes, params.layout, params.max_bytes)?,
        Format::MetroPro => metropro::channels(bytes)?,
        // Exports as text have the same header.
        Format::Nanoscope if is_text(bytes) => text::channels(bytes, params.layout, &params.missing)?,
        Format::Nanoscope => nanoscope::channels(bytes)?,
        Format::Nid => nid::channels(bytes)?,
        Format::Npy => npy::channels(bytes, params),
        Format::Opd => opd::channels(bytes)?,
        Format::Opdx => opdx::channels(bytes, params)?,
        Format::Plu => plu::channels(bytes)?,
        Format::Plux => plux::channels(bytes, params.max_bytes)?,
        Format::Png => png::channels(bytes, params.max_bytes),
        Format::Sdf => only(move || sdf::parse(bytes)),
        Format::Sur => sur::channels(bytes, params)?,
        Format::Surfer => only(move || surfer::parse(bytes)),
        Format::Tiff => tiff::channels(bytes, params.max_bytes)?,
        Format::Vk4 if vk6::is_archive(bytes) => vk6::channels(bytes, params.max_bytes)?,
        Format::Vk4 => vk4::channels(bytes)?,
        Format::Wsxm => wsxm::channels(bytes)?,
        Format::X3p => x3p::channels(bytes, params.max_bytes),
        Format::Xyz => xyz::channels(bytes, &params.missing),
        Format::Zygo => zygo::channels(bytes, &params.missing),
    })
}

/// Makes the points missing that have a mark of the user, one of `missing` in the numbers of the file.
///
/// Refuses infinite heights and maps without a measured point.
fn checked(mut map: HeightMap, missing: &[f64]) -> Result<HeightMap, FormatError> {
    let number = map.number;
    marks::Marks::new(missing, &[]).erase_scaled(map.heights.values_mut(), number);
    let (values, nx) = (map.heights.values(), map.heights.grid().nx());
    if let Some(i) = values.iter().position(|height| height.is_infinite()) {
        return Err(FormatError::Infinite { row: i / nx, column: i % nx, value: values[i] });
    }
    if values.iter().all(|height| height.is_nan()) {
        return Err(FormatError::Empty(values.len()));
    }
    Ok(map)
}
