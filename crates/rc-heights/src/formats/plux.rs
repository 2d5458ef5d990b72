//! Newer Sensofar files, which are zip archives.
//!
//! The archive has `index.xml`, and for each layer a file of 32-bit floats in µm with rows from top to bottom. A
//! missing point is NaN.

use std::io::{Cursor, Read as _};

use rc_core::Grid;
use roxmltree::{Document, Node};
use zip::ZipArchive;

use super::archive::{folder_of, names};
use super::binary::Number;
use super::channel::{Channel, Channels};
use super::fields::{refused, shown_as_line};
use super::instrument::{map, sides};
use super::limit;
use crate::{Format, FormatError, HeightMap};

/// Maximum length of `index.xml`. It does not contain heights.
const LONGEST_XML: u64 = 16 << 20;

/// Maximum number of bytes that deflate makes of one byte. Claims beyond that are false.
const MOST_INFLATION: u64 = 1032;

const MICROMETRE: f64 = 1e-6;

pub(super) fn channels(bytes: &[u8], max_bytes: u64) -> Channels<'_> {
    let archive = ZipArchive::new(Cursor::new(bytes)).map_err(|cause| container(&cause))?;
    let folder = folder_of(&names(&archive), "index.xml");
    let xml = member(bytes, &format!("{folder}index.xml"), LONGEST_XML)?;
    let xml = String::from_utf8_lossy(&xml);
    let document = Document::parse(&xml).map_err(|cause| container(&cause))?;
    let root = document.root_element();
    let general = child(root, "GENERAL").ok_or(FormatError::Missing { format: Format::Plux, field: "GENERAL" })?;
    let grid = Grid::new(number(general, "IMAGE_SIZE_X")?, number(general, "IMAGE_SIZE_Y")?)?;
    // Despite their names, these are the sides of a pixel.
    let spacing = [number::<f64>(general, "FOV_X")? * MICROMETRE, number::<f64>(general, "FOV_Y")? * MICROMETRE];
    let sides = sides(Format::Plux, ["FOV_X", "FOV_Y"], grid, spacing)?;
    let layers = root.children().filter(|node| node.tag_name().name().starts_with("LAYER_"));
    let mut channels = Vec::new();
    for layer in layers {
        // Layers without heights have only an image.
        if let Some(file) = text(layer, "FILENAME_Z") {
            let file = format!("{folder}{}", file.trim_start_matches("./"));
            channels.push(Channel {
                name: layer.tag_name().name().to_owned(),
                is_height: true,
                read: Box::new(move || read(bytes, &file, grid, sides, max_bytes)),
            });
        }
    }
    Ok(channels)
}

fn read(bytes: &[u8], file: &str, grid: Grid, sides: [f64; 2], max_bytes: u64) -> Result<HeightMap, FormatError> {
    let needed = Number::F32.bytes_of(grid);
    let found = (bytes.len() as u64).saturating_mul(MOST_INFLATION);
    if found < needed {
        return Err(FormatError::CutShort { grid, needed, found });
    }
    limit::check_map(grid, Number::F32.size() as u64, bytes.len() as u64, max_bytes)?;
    let mut values = Number::F32.values(&member(bytes, file, needed)?, grid)?;
    crate::map::scale(&mut values, MICROMETRE);
    Ok(map(grid, values, true, Some(sides)).of_numbers(MICROMETRE))
}

/// A file of the archive, of at most `most` bytes.
///
/// Some names begin with `./` in the archive, and others do not.
fn member(bytes: &[u8], name: &str, most: u64) -> Result<Vec<u8>, FormatError> {
    let mut archive = ZipArchive::new(Cursor::new(bytes)).map_err(|cause| container(&cause))?;
    let bare = name.trim_start_matches("./");
    let dotted = format!("./{bare}");
    let name = [name, bare, &dotted].into_iter().find(|name| archive.index_for_name(name).is_some()).unwrap_or(name);
    let file = archive.by_name(name).map_err(|cause| container(&format_args!("{name}: {cause}")))?;
    let mut content = Vec::new();
    let read = file.take(most.saturating_add(1)).read_to_end(&mut content);
    read.map_err(|cause| container(&format_args!("{name}: {cause}")))?;
    if content.len() as u64 > most {
        return Err(container(&format_args!("{name} has more than the {most} bytes that it should have")));
    }
    Ok(content)
}

fn child<'a, 'input>(node: Node<'a, 'input>, name: &str) -> Option<Node<'a, 'input>> {
    node.children().find(|child| child.tag_name().name() == name)
}

fn text<'a>(node: Node<'a, '_>, name: &str) -> Option<&'a str> {
    child(node, name).and_then(|node| node.text()).map(str::trim).filter(|text| !text.is_empty())
}

fn number<T: std::str::FromStr>(node: Node<'_, '_>, name: &'static str) -> Result<T, FormatError> {
    let text = text(node, name).ok_or(FormatError::Missing { format: Format::Plux, field: name })?;
    text.parse().map_err(|_| refused(Format::Plux, name, text, "a number"))
}

fn container(reason: &(impl ToString + ?Sized)) -> FormatError {
    FormatError::Container { format: Format::Plux, reason: shown_as_line(&reason.to_string()) }
}
