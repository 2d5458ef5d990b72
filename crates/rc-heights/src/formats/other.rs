//! Kinds of files that are not read, so that a message names them and says what to do instead.

use super::decode::is_text;
use crate::FormatError;

/// What to do with a file of a microscope that Gwyddion reads.
const GWYDDION: &str = "Gwyddion reads it: save the heights there as .gwy or .gsf";
/// What to do with a file of another instrument.
const EXPORT: &str = "such files are not read: export .x3p, .sur or text from the instrument's program";
/// What to do with force curves.
const CURVES: &str = "give the image of the heights";
/// What to do with a mesh.
const MESH: &str = "heights on a regular grid are needed: sample them, as points x y z or as a map";
/// What to do with a picture.
const PICTURE: &str = "it has colours, not heights: export the heights, or levels of grey as 16-bit .png or .tif";
/// What to do with a packed file.
const UNPACK: &str = "unpack it, and give the file inside";
/// What to do with a table.
const TABLE: &str = "save the numbers as .csv";
/// What to do with an array.
const ARRAY: &str = "save the heights as .npy (numpy.save) or .csv";

/// A kind of files: marks at a place, extensions, what it is, and what to do.
///
/// A file is of the kind if it has one of the marks, or one of the extensions if there are no marks.
struct Kind {
    at: usize,
    marks: &'static [&'static [u8]],
    extensions: &'static [&'static str],
    what: &'static str,
    cure: &'static str,
}

const fn kind(
    at: usize,
    marks: &'static [&'static [u8]],
    extensions: &'static [&'static str],
    what: &'static str,
    cure: &'static str,
) -> Kind {
    Kind { at, marks, extensions, what, cure }
}

/// Containers whose contents only the name tells. Their marks are those of formats that are read.
const CONTAINERS: [Kind; 2] =
    [kind(0, TIFF, &["jpk"], "a JPK image", GWYDDION), kind(0, TIFF, &["lext"], "an Olympus LEXT file", GWYDDION)];

const TIFF: &[&[u8]] = &[b"II*\0", b"MM\0*"];

/// Kinds with marks.
const MARKED: [Kind; 47] = [
    kind(0, OLE, &["xls"], "an old Excel workbook (.xls)", TABLE),
    kind(0, OLE, &["mnt"], "a document of Mountains (.mnt)", "such files are not read: save the surface in it as .sur"),
    kind(0, OLE, &[], "a document of Office or of another program", TABLE),
    kind(0, &[b"\xff\xd8\xff"], &[], "a JPEG picture", PICTURE),
    kind(0, &[b"GIF87a", b"GIF89a"], &[], "a GIF picture", PICTURE),
    kind(0, &[b"BM"], &["bmp", "dib"], "a BMP picture", PICTURE),
    kind(8, &[b"WEBP"], &[], "a WebP picture", PICTURE),
    kind(0, &[b"II+\0", b"MM\0+"], &[], "a BigTIFF", "save it as TIFF of less than 4 GB, or as .npy"),
    kind(0, &[b"%PDF"], &[], "a PDF", TABLE),
    kind(0, &[b"{\\rtf"], &[], "a formatted text (.rtf)", TABLE),
    kind(0, &[b"<!DOCTYPE html", b"<!doctype html", b"<html"], &[], "a web page", "download the file itself"),
    kind(0, &[b"version https://git-lfs"], &[], "a pointer of Git LFS, not the file", "fetch it: git lfs pull"),
    kind(0, &[b"\x28\xb5\x2f\xfd"], &[], "packed by zstd", UNPACK),
    kind(0, &[b"\xfd7zXZ\0"], &[], "packed by xz", UNPACK),
    kind(0, &[b"BZh1", b"BZh5", b"BZh6", b"BZh9"], &[], "packed by bzip2", UNPACK),
    kind(0, &[b"7z\xbc\xaf\x27\x1c"], &[], "an archive (7z)", UNPACK),
    kind(0, &[b"Rar!\x1a\x07"], &[], "an archive (rar)", UNPACK),
    kind(0, &[b"\x04\x22\x4d\x18"], &[], "packed by lz4", UNPACK),
    kind(257, &[b"ustar"], &[], "an archive (tar)", UNPACK),
    kind(0, &[b"\x80\x04\x95", b"\x80\x05\x95"], &[], "a Python pickle", ARRAY),
    kind(0, &[b"\x80\x02", b"\x80\x03"], &["pkl", "pickle", "p"], "a Python pickle", ARRAY),
    kind(0, &[b"CPYA", b"CPYUA"], &[], "an Origin project", "export the matrix as text (.csv)"),
    kind(0, &[b"PAR1"], &[], "a Parquet table", TABLE),
    kind(0, &[b"ARROW1"], &[], "an Arrow or Feather table", TABLE),
    kind(0, &[b"SIMPLE  ="], &[], "a FITS image", ARRAY),
    kind(0, &[b"\x0e\x03\x13\x01"], &[], "an HDF4 file", "convert it to HDF5 or NetCDF"),
    kind(0, &[b"GWYO"], &[], "a file of Gwyddion 1", "open it in Gwyddion 2 and save it again"),
    kind(0, &[b"# vtk DataFile", b"<VTKFile"], &[], "a VTK file", ARRAY),
    kind(0, &[b"ply\n", b"ply\r"], &[], "a PLY mesh", MESH),
    kind(0, &[b"OFF\n", b"OFF\r"], &[], "an OFF mesh", MESH),
    kind(0, &[b"# .PCD"], &[], "a point cloud (.pcd)", "save the points as text, x y z in each line"),
    kind(0, &[b"LASF"], &[], "a point cloud (.las)", "save the points as text, x y z in each line"),
    kind(0, &[b"KPK0", b"KPK1"], &[], "a Keyence file (.zon)", EXPORT),
    kind(0, &[b"OLYMPUSRAWFORMAT"], &[], "an Olympus file (.oir)", EXPORT),
    kind(0, &[b"OmniSurf3D"], &[], "an OmniSurf3D file", EXPORT),
    kind(0, &[b"Binary TrueMap"], &[], "a TrueMap file (.tmd)", EXPORT),
    kind(0, &[b"Zeta-Instruments"], &[], "a Zeta file (.zmg)", EXPORT),
    kind(0, &[b":NANONIS_VERSION:"], &[], "a Nanonis file (.sxm)", GWYDDION),
    kind(0, &[b"\x01\xb0\x93\xff"], &[], "an NT-MDT file (.mdt)", GWYDDION),
    kind(2, &[b"S\0T\0i\0M\0a\0g\0e\0"], &[], "an RHK file (.sm4)", GWYDDION),
    kind(0, &[b"ONTMATRX"], &[], "an Omicron Matrix file", GWYDDION),
    kind(0, &[b"[Param"], &[], "a Createc file (.dat)", GWYDDION),
    kind(0, &[b"fileType      Image"], &[], "a PicoScan file (.mi)", GWYDDION),
    kind(0, &[b"ZISRAWFILE"], &[], "a Zeiss file (.czi)", EXPORT),
    kind(0, &[b"#VRML"], &[], "a VRML mesh", MESH),
    kind(0, &[b"ISO-10303-21"], &[], "a body of CAD (STEP)", MESH),
    kind(0, &[b"#!JPK", b"#R3F"], &[], "a file of force curves, not a map", CURVES),
];

const OLE: &[&[u8]] = &[b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"];

/// Kinds that only the name tells.
const NAMED: [Kind; 17] = [
    kind(0, &[], &["stl"], "an STL mesh", MESH),
    kind(0, &[], &["obj", "3mf", "wrl", "vrml", "step", "iges", "igs"], "a mesh or a body of CAD", MESH),
    kind(0, &[], &["las", "laz", "e57"], "a point cloud", "save the points as text, x y z in each line"),
    kind(0, &[], &["jpk-force", "jpk-qi-data", "jpk-force-map"], "a JPK file of force curves, not a map", CURVES),
    kind(0, &[], &["jpk"], "a JPK image", GWYDDION),
    kind(0, &[], &["tom", "gsi", "mpp"], "a WSxM file", GWYDDION),
    kind(0, &[], &["mdt", "sxm", "sm4", "mi", "hdf"], "a file of a microscope", GWYDDION),
    kind(0, &[], &["pro", "mnt"], "a Digital Surf file, but not a surface", "save the surface as .sur"),
    kind(0, &[], &["lext", "oir", "poir"], "an Olympus file", EXPORT),
    kind(0, &[], &["zon"], "a Keyence file", EXPORT),
    kind(0, &[], &["nms", "os3d", "tmd", "zmg", "czi"], INSTRUMENT, EXPORT),
    kind(0, &[], &["npz", "pkl", "pickle", "pt"], "an archive of arrays", ARRAY),
    kind(0, &[], &["zarr", "n5", "parquet", "feather", "arrow"], "a table or array of another kind", ARRAY),
    kind(0, &[], &["vtk", "vti", "vtu", "vtp", "vts", "vtr", "pvd"], "a VTK file", ARRAY),
    kind(0, &[], &["jpg", "jpeg", "bmp", "gif", "webp", "svg", "heic"], "a picture", PICTURE),
    kind(0, &[], &["opj", "opju", "ogw", "ogm"], "an Origin file", "export the matrix as text (.csv)"),
    kind(0, &[], &["xls", "xlsx", "ods", "doc", "docx"], "a document of Office", TABLE),
];

const INSTRUMENT: &str = "a file of an instrument";

/// The error for a file that is `what`, with what to do.
fn other(what: &str, cure: &str) -> FormatError {
    FormatError::Other { what: format!("{what}; {cure}") }
}

impl Kind {
    fn error(&self) -> FormatError {
        other(self.what, self.cure)
    }

    fn has_mark(&self, start: &[u8]) -> bool {
        let rest = start.get(self.at..).unwrap_or_default();
        self.marks.iter().any(|mark| rest.starts_with(mark))
    }

    fn has_extension(&self, extension: Option<&str>) -> bool {
        extension.is_some_and(|extension| self.extensions.contains(&extension))
    }
}

/// The error for a file with the mark of a format that is read, but whose name says that it has something else.
pub(super) fn in_container(extension: Option<&str>, start: &[u8]) -> Option<FormatError> {
    CONTAINERS.iter().find(|kind| kind.has_mark(start) && kind.has_extension(extension)).map(Kind::error)
}

/// The error for a file whose first bytes are those of a kind that is not read.
pub(super) fn marked(extension: Option<&str>, start: &[u8]) -> Option<FormatError> {
    let is = |kind: &&Kind| kind.has_mark(start) && (kind.extensions.is_empty() || kind.has_extension(extension));
    if let Some(kind) = MARKED.iter().find(is) {
        return Some(kind.error());
    }
    let first = &start[..start.len().min(200)];
    let contains = |part: &[u8]| first.windows(part.len()).any(|window| window == part);
    if contains(b"<VTKFile") {
        return Some(other("a VTK file", ARRAY));
    }
    if start.starts_with(b"<?xml") {
        return Some(other("an XML text", "give points x y z, or a row of heights in each line"));
    }
    let is_stl = start.starts_with(b"solid") && is_text(start) && contains(b"facet");
    is_stl.then(|| other("an STL mesh", MESH))
}

/// The error for a file whose name is that of a kind that is not read.
pub(super) fn named(extension: &str) -> Option<FormatError> {
    NAMED.iter().find(|kind| kind.has_extension(Some(extension))).map(Kind::error)
}
