//! Archives: recognition of zip archives by their members, and decompression of gzip.

use std::io::Cursor;
use std::path::Path;

use zip::ZipArchive;

use super::Format;
use super::fields::shown;
use crate::FormatError;

/// The first bytes of a zip archive.
pub(super) const ZIP: &[u8] = b"PK\x03\x04";
/// The first bytes of a gzip file.
pub(super) const GZIP: &[u8] = b"\x1f\x8b\x08";

/// Formats by the ends of the names of members.
const FORMATS: &[(&str, Format)] = &[("main.xml", Format::X3p), ("index.xml", Format::Plux), ("Vk4File", Format::Vk4)];

/// Other archives by the names of members, or by their ends from a dot on, with a description.
const OTHERS: &[(&str, &str)] = &[
    ("xl/workbook.xml", "an Excel workbook; save the sheet as .csv"),
    ("[Content_Types].xml", "an Office document; save the numbers as .csv"),
    ("META-INF/manifest.xml", "an OpenDocument file; save the numbers as .csv"),
    ("header.properties", "a JPK measurement of force curves, not a map of heights; give the image of the heights"),
    ("3D/3dmodel.model", "a 3MF mesh, not a map; give its heights on a regular grid, as points x y z or as a map"),
    ("Index/Document.iwa", "a document of Apple Numbers or Pages; save the numbers as .csv"),
    (
        ".oir",
        "an Olympus measurement (.poir); such files are not read: export .x3p, .sur or text from the instrument's program",
    ),
    (".npy", "an archive of NumPy arrays (.npz); save one of them with numpy.save, as .npy"),
    ("meta.yml", "a container with several maps; unpack it and give one of them"),
];

/// Names of the members of an archive. Names that are not text are omitted.
pub(super) fn names(archive: &ZipArchive<Cursor<&[u8]>>) -> Vec<String> {
    archive.file_names().filter_map(|name| Some(name.ok()?.into_owned())).collect()
}

/// The format of a zip archive, from its members.
///
/// For a damaged archive, the name of the file determines the format in the error.
pub(super) fn format_of_zip(path: &Path, bytes: &[u8]) -> Result<Format, FormatError> {
    let Ok(archive) = ZipArchive::new(Cursor::new(bytes)) else { return Err(damaged(path)) };
    let names = names(&archive);
    // Members may be in a folder of the archive.
    let has = |end: &str| {
        let is = |name: &String| {
            let whole = |folder: &str| folder.is_empty() || folder.ends_with('/') || end.starts_with('.');
            name.strip_suffix(end).is_some_and(whole)
        };
        names.iter().any(is)
    };
    if let Some((_, format)) = FORMATS.iter().find(|(name, _)| has(name)) {
        return Ok(*format);
    }
    let arrays: Option<Vec<&str>> = names.iter().map(|name| name.strip_suffix(".npy")).collect();
    if let Some(arrays) = arrays.filter(|arrays| !arrays.is_empty()) {
        let first: Vec<String> = arrays.iter().take(5).map(|name| shown(name)).collect();
        let first = first.join(", ") + if arrays.len() > 5 { ", …" } else { "" };
        let what = format!("a NumPy archive (.npz) of {first}; save the array of heights with numpy.save, as .npy");
        return Err(FormatError::Other { what });
    }
    let other = OTHERS.iter().find(|(name, _)| has(name)).map(|(_, what)| (*what).to_owned());
    let listed = || {
        let more = if names.len() > 3 { ", …" } else { "" };
        let first: Vec<String> = names.iter().take(3).map(|name| shown(name)).collect();
        format!("a zip archive with {}{more}; unpack it and give one of its files", first.join(", "))
    };
    Err(FormatError::Other { what: other.unwrap_or_else(listed) })
}

/// The error for a zip archive that cannot be opened.
fn damaged(path: &Path) -> FormatError {
    let extension = path.extension().map(|extension| extension.to_string_lossy().to_ascii_lowercase());
    let format = match extension.as_deref() {
        Some("x3p") => Format::X3p,
        Some("plux") => Format::Plux,
        _ => return FormatError::Other { what: "a zip archive that is cut off or damaged".to_owned() },
    };
    FormatError::Container { format, reason: "the archive is cut off or damaged".to_owned() }
}

/// The folder of the archive that contains `member`, with a slash at its end.
///
/// Some programs compress the folder, not its members. If there are several such folders, the result is the outermost
/// one.
pub(super) fn folder_of(names: &[String], member: &str) -> String {
    let folders = names.iter().filter_map(|name| name.strip_suffix(member));
    let folders = folders.filter(|folder| folder.is_empty() || folder.ends_with('/'));
    folders.min_by_key(|folder| folder.len()).unwrap_or_default().to_owned()
}
