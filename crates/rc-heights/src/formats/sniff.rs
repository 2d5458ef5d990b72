//! Recognition of formats by the first bytes or by the name.
//!
//! The name is used if the format has no mark.

use std::path::Path;

use super::archive::{self, ZIP};
use super::decode::{decoded, is_text};
use super::{
    Format, al3d, bcr, esri, frt, gsf, gwy, ibw, mat, metropro, nanoscope, nid, opd, opdx, other, sur, vk4, vk6, wsxm,
};
use super::{xyz, zygo};
use crate::FormatError;

/// The signature of HDF5.
///
/// It is at the start, or after a user block of 512 bytes or that times a power of two.
const HDF5: &[u8] = b"\x89HDF\r\n\x1a\n";

/// First bytes of a file that determine its format.
const MARKS: &[(&[u8], Format)] = &[
    (b"\x93NUMPY", Format::Npy),
    (b"DSAA", Format::Surfer),
    (b"DSBB", Format::Surfer),
    (b"DSRB", Format::Surfer),
    (gsf::MARK, Format::Gsf),
    (gwy::MARK, Format::Gwy),
    (HDF5, Format::Hdf5),
    (mat::MARK, Format::Mat),
    (b"CDF\x01", Format::NetCdf),
    (b"CDF\x02", Format::NetCdf),
    (b"CDF\x05", Format::NetCdf),
    (b"aISO-1.0", Format::Sdf),
    (b"bISO-1.0", Format::Sdf),
    (b"aISO-2.0", Format::Sdf),
    (b"bISO-2.0", Format::Sdf),
    (b"aBCR-1.0", Format::Sdf),
    (b"bBCR-1.0", Format::Sdf),
    // The same marks as written by Gwyddion.
    (b"aBCR-0.0", Format::Sdf),
    (b"bBCR-0.0", Format::Sdf),
    (b"\x89PNG\r\n\x1a\n", Format::Png),
    (b"II*\0", Format::Tiff),
    (b"MM\0*", Format::Tiff),
    // BigTIFF.
    (b"II+\0", Format::Tiff),
    (b"MM\0+", Format::Tiff),
    (sur::PLAIN, Format::Sur),
    (sur::COMPRESSED, Format::Sur),
    (nanoscope::MARK, Format::Nanoscope),
    (opd::MARK, Format::Opd),
    (metropro::MARKS[0], Format::MetroPro),
    (metropro::MARKS[1], Format::MetroPro),
    (metropro::MARKS[2], Format::MetroPro),
    (al3d::MARK, Format::Al3d),
    (vk4::MARKS[0], Format::Vk4),
    (vk4::MARKS[1], Format::Vk4),
    (vk6::MARKS[0], Format::Vk4),
    (vk6::MARKS[1], Format::Vk4),
    (nid::MARK, Format::Nid),
    (opdx::MARK, Format::Opdx),
    (frt::MARK, Format::Frt),
    (bcr::MARKS[0], Format::Bcr),
    (bcr::MARKS[1], Format::Bcr),
];

impl Format {
    /// Whether files of this format may contain the size of the measured rectangle.
    ///
    /// Texts contain it in lines before the numbers.
    #[must_use]
    pub fn has_sides(self) -> bool {
        !matches!(self, Self::Npy)
    }

    /// The format of a file with name `path` and first bytes `start`.
    ///
    /// The first 4096 bytes are enough, except for zip archives, which are needed completely. The first bytes take
    /// precedence over the name.
    ///
    /// # Errors
    /// - [`FormatError::Mark`] when the name belongs to a format with other first bytes.
    /// - [`FormatError::Container`] or [`FormatError::Other`] for a zip archive that is damaged or not a height map.
    /// - [`FormatError::Other`] for a file of a known kind that is not read.
    /// - [`FormatError::ZeroBytes`] when the name is that of a text, and the bytes are not a text.
    /// - [`FormatError::Unknown`] when the format cannot be determined.
    pub fn of(path: &Path, start: &[u8]) -> Result<Self, FormatError> {
        let extension = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
        let extension = extension.as_deref();
        if let Some(other) = other::in_container(extension, start) {
            return Err(other);
        }
        if let Some((_, format)) = MARKS.iter().find(|(mark, _)| start.starts_with(mark)) {
            return Ok(*format);
        }
        if start.starts_with(ZIP) {
            return archive::format_of_zip(path, start);
        }
        if ibw::order(start).is_some() {
            return Ok(Self::Ibw);
        }
        if wsxm::is_image(start) {
            return Ok(Self::Wsxm);
        }
        if [512, 1024, 2048].iter().any(|at| start.get(*at..).is_some_and(|rest| rest.starts_with(HDF5))) {
            return Ok(Self::Hdf5);
        }
        if let Some(other) = other::marked(extension, start) {
            return Err(other);
        }
        if let Some(format) = of_text(start) {
            return Ok(format);
        }
        Self::of_extension(extension, start)
    }

    /// The format of a file without a mark.
    fn of_extension(extension: Option<&str>, start: &[u8]) -> Result<Self, FormatError> {
        let mark = |format, expected| Err(FormatError::Mark { format, expected });
        match extension {
            Some("xyz") => Ok(Self::Xyz),
            // Lines of three numbers are points. Few maps have only three columns.
            Some("csv" | "txt" | "tsv" | "dat" | "asc" | "hfm") if is_text(start) => {
                Ok(if xyz::looks_like_points(start) { Self::Xyz } else { Self::Csv })
            }
            Some("csv" | "txt" | "tsv" | "asc" | "hfm") => Err(FormatError::ZeroBytes),
            Some("npy") => mark(Self::Npy, "it must begin with \\x93NUMPY; numpy.save writes such files"),
            Some("grd") => mark(Self::Surfer, "it must begin with DSAA, DSBB or DSRB"),
            Some("gsf") => mark(Self::Gsf, "it must begin with the line 'Gwyddion Simple Field 1.0'"),
            Some("gwy") => mark(Self::Gwy, "it must begin with GWYP"),
            Some("h5" | "hdf5" | "nc4") => mark(Self::Hdf5, "it must begin with \\x89HDF"),
            Some("ibw") => mark(Self::Ibw, "it must begin with the headers of version 5, 384 bytes"),
            Some("mat") => mark(
                Self::Mat,
                "it must begin with 'MATLAB 5.0 MAT-file' or be HDF5; save one of version 4 again with -v6, -v7 or -v7.3",
            ),
            Some("nc") => mark(Self::NetCdf, "it must begin with CDF or be HDF5"),
            Some("sdf") => mark(Self::Sdf, "it must begin with aISO-1.0 or bISO-1.0"),
            Some("x3p") => mark(Self::X3p, "it must be a zip archive"),
            Some("png") => mark(Self::Png, "it must begin with \\x89PNG"),
            Some("tif" | "tiff") => mark(Self::Tiff, "it must begin with II or MM and 42 or 43"),
            Some("sur") => mark(Self::Sur, "it must begin with DIGITAL SURF or DSCOMPRESSED"),
            Some("spm") => mark(Self::Nanoscope, "it must begin with the line '\\*File list'"),
            Some("opd") => mark(Self::Opd, "it must begin with a block called Directory"),
            Some("al3d") => mark(Self::Al3d, "it must begin with AliconaImaging"),
            Some("plu") => Ok(Self::Plu),
            Some("plux") => mark(Self::Plux, "it must be a zip archive"),
            Some("vk4") => mark(Self::Vk4, "it must begin with VK4_"),
            Some("vk6" | "vk7") => mark(Self::Vk4, "it must begin with VK6 or VK7"),
            Some("nid" | "ezd") => mark(Self::Nid, "it must begin with the line [DataSet]"),
            Some("stp" | "top") => mark(Self::Wsxm, "it must begin with 'WSxM file copyright' and 'SxM Image file'"),
            Some("opdx") => mark(Self::Opdx, "it must begin with VCA DATA"),
            Some("bcr" | "bcrf") => mark(Self::Bcr, "it must begin with 'fileformat = bcrstm' or 'fileformat = bcrf'"),
            Some("frt") => mark(Self::Frt, "it must begin with FRTM_GLIDERV"),
            _ => Err(extension.and_then(other::named).unwrap_or(FormatError::Unknown)),
        }
    }
}

/// The format of a text that its first words determine, whatever its name.
fn of_text(start: &[u8]) -> Option<Format> {
    // A file that was unpacked is here completely.
    let start = &start[..start.len().min(4096)];
    // A binary file may begin with a text.
    let text = decoded(if is_text(start) { start } else { start.split(|byte| *byte == 0).next().unwrap_or_default() });
    let begins = |words: &str| text.trim_start().starts_with(words);
    if begins(zygo::XYZ) || begins(zygo::ASCII) {
        return Some(Format::Zygo);
    }
    esri::is_grid(&text).then_some(Format::EsriGrid)
}
