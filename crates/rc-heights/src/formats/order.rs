//! The order of rows.
//!
//! Row 0 of a field is the lowest: y points up, in pictures too. Files of many instruments begin with the row that
//! their pictures have at the top. The rows of such files are reversed, once, here.

use super::decode::decoded;
use super::field::flip;
use super::heading::Heading;
use super::park::is_park;
use crate::{Format, HeightMap, ReadNote};

impl Format {
    /// Whether the first row of a file of this format is the top of its picture.
    ///
    /// | format | first row | according to |
    /// |---|---|---|
    /// | PNG, TIFF | top | PNG (third edition) and TIFF 6.0: the first row of an image is the top |
    /// | `.gwy`, `.gsf` | top | the guide of Gwyddion, "Format of Gwyddion Files" |
    /// | `.sur` | top | Gwyddion (surffile) and SurfaceTopography show it so |
    /// | `.al3d`, `.plu`, `.plux`, `.vk4`, `.opdx`, BCR-STM, MetroPro, texts of Zygo | top | the same for alicona, sensofar, keyence, dektakvca, bcrfile, metropro |
    /// | `.sdf`, `.x3p` | bottom | ISO 25178-71 and -72: the first profile has the lowest y (Gwyddion draws it at the top) |
    /// | ESRI grids | top | help of ArcGIS: the first row of the data is at the top |
    /// | Nanoscope | bottom | Gwyddion (nanoscope) and SurfaceTopography turn the image for their pictures |
    /// | Igor, Wyko, Nanosurf, WSxM, MicroProf, TIFF of Park | bottom | the same for igorfile, opdfile, ezdfile, wsxmfile, microprof, psia |
    /// | Surfer | bottom | help of Golden Software: the first row has the lowest y |
    /// | arrays, tables, points | none | arrays have no picture; y of the points and coordinates counts |
    #[must_use]
    pub fn first_row_is_top(self) -> bool {
        match self {
            Self::Png
            | Self::Tiff
            | Self::Gwy
            | Self::Gsf
            | Self::Sur
            | Self::Al3d
            | Self::Plu
            | Self::Plux
            | Self::Vk4
            | Self::Opdx
            | Self::Bcr
            | Self::MetroPro
            | Self::EsriGrid
            | Self::Zygo => true,
            Self::Nanoscope
            | Self::Sdf
            | Self::X3p
            | Self::Ibw
            | Self::Opd
            | Self::Nid
            | Self::Wsxm
            | Self::Frt
            | Self::Surfer
            | Self::Npy
            | Self::Csv
            | Self::Xyz
            | Self::Hdf5
            | Self::Mat
            | Self::NetCdf => false,
        }
    }
}

/// The map with its lowest row first, and a note if that changed the order.
pub(super) fn bottom_first(mut map: HeightMap, bytes: &[u8], format: Format) -> HeightMap {
    let is_top_first = match format {
        Format::Csv => is_exported_by_gwyddion(bytes),
        Format::Tiff => !is_park(bytes),
        format => format.first_row_is_top(),
    };
    // A reader that already turned its rows has said so. A single row has no order.
    if !is_top_first || map.heights.grid().ny() == 1 || map.notes.contains(&ReadNote::RowsReversed) {
        return map;
    }
    let grid = map.heights.grid();
    flip(map.heights.values_mut(), grid, [false, true]);
    map.with_note(ReadNote::RowsReversed)
}

/// Whether a text is a table as Gwyddion exports it: comments with the name of the channel and its size, then rows.
fn is_exported_by_gwyddion(bytes: &[u8]) -> bool {
    // The titles are in the first lines, in any language and encoding.
    let start = decoded(&bytes[..bytes.len().min(4096)]);
    let comments = start.lines().take(3).filter(|line| line.starts_with('#') && line.contains(':'));
    comments.count() == 3
        && Heading::of(&start).is_ok_and(|heading| heading.says_sides() && !heading.channel.is_empty())
}
