//! ISO 5436-2 (now ISO 25178-72) files.
//!
//! The format is a zip archive with `main.xml`, heights as binary numbers, and a mask of measured points. Few heights
//! may be in `main.xml`, where an empty element is a missing point. Lengths are in metres. The checksums of the archive are verified. The MD5 sums in it are not.

use std::io::{Cursor, Read as _};

use rc_core::Grid;
use roxmltree::{Document, Node};
use zip::ZipArchive;

use super::archive::folder_of;
use super::binary::Number;
use super::channel::{Channel, only};
use super::field::field;
use super::fields::{factor, positive, refused, shown_as_line};
use super::limit;
use crate::{Format, FormatError, HeightMap, Unit};

/// Maximum length of `main.xml`, which may contain heights.
const LONGEST_XML: u64 = 256 << 20;

/// Bytes of memory for a byte of `main.xml` of the shortest elements.
const XML_MEMORY: u64 = 24;

/// Maximum number of bytes that deflate makes of one byte. Claims beyond that are false.
const MOST_INFLATION: u64 = 1032;

type Archive<'a> = ZipArchive<Cursor<&'a [u8]>>;

pub(super) fn channels(bytes: &[u8], max_bytes: u64) -> Vec<Channel<'_>> {
    only(move || parse(bytes, max_bytes))
}

fn parse(bytes: &[u8], max_bytes: u64) -> Result<HeightMap, FormatError> {
    let mut archive = ZipArchive::new(Cursor::new(bytes)).map_err(|cause| container(&cause))?;
    let folder = folder_of(&super::archive::names(&archive), "main.xml");
    let xml = xml(&mut archive, &format!("{folder}main.xml"), max_bytes)?;
    let xml = String::from_utf8_lossy(&xml);
    let document = Document::parse(&xml).map_err(|cause| container(&cause))?;
    let root = document.root_element();
    let (number, increments, offset) = axes(root)?;
    let grid = grid(root)?;
    let sides = Some([increments[0] * grid.nx() as f64, increments[1] * grid.ny() as f64]);
    let map = |mut values: Vec<f64>| {
        for value in &mut values {
            // In ISO 5436-2, infinite values mark missing points too.
            *value = if value.is_infinite() { f64::NAN } else { *value * increments[2] + offset };
        }
        HeightMap::new(field(grid, values), Unit::Metre, sides, Unit::Metre)
    };
    let Ok(link) = text(root, "DataLink", "PointDataLink") else {
        return listed(root, grid).map(map);
    };
    let needed = number.bytes_of(grid);
    let found = (bytes.len() as u64).saturating_mul(MOST_INFLATION);
    if found < needed {
        return Err(FormatError::CutShort { grid, needed, found });
    }
    limit::check_map(grid, number.size() as u64, bytes.len() as u64, max_bytes)?;
    let mut values = number.values(&member(&mut archive, &format!("{folder}{link}"), needed)?, grid)?;
    if let Ok(link) = text(root, "DataLink", "ValidPointsLink") {
        mask(&mut values, &member(&mut archive, &format!("{folder}{link}"), needed)?)?;
    }
    Ok(map(values))
}

/// The bytes of `main.xml`.
fn xml(archive: &mut Archive<'_>, name: &str, max_bytes: u64) -> Result<Vec<u8>, FormatError> {
    let size = archive.by_name(name).map_err(|cause| container(&format_args!("{name}: {cause}")))?.size();
    limit::check(size.saturating_mul(XML_MEMORY), max_bytes)?;
    member(archive, name, size.min(LONGEST_XML))
}

/// The heights in `main.xml`, in the order of the binary numbers.
fn listed(root: Node<'_, '_>, grid: Grid) -> Result<Vec<f64>, FormatError> {
    let list = root.descendants().find(|node| is_called("DataList", node));
    let list = list.ok_or(FormatError::Missing { format: Format::X3p, field: "PointDataLink or DataList" })?;
    let mut values = Vec::new();
    for datum in list.children().filter(|node| is_called("Datum", node)) {
        let text = datum.text().unwrap_or_default().trim();
        let value = if text.is_empty() { Ok(f64::NAN) } else { text.parse() };
        values.push(value.map_err(|_| refused(Format::X3p, "Datum", text, "a height, or empty"))?);
    }
    if values.len() == grid.len() {
        return Ok(values);
    }
    let found = format!("{} elements for {grid} points", values.len());
    Err(refused(Format::X3p, "DataList", &found, "an element Datum for each point"))
}

/// Applies a mask with a bit for each point, lowest bit first. Points whose bit is 0 were not measured.
fn mask(values: &mut [f64], bits: &[u8]) -> Result<(), FormatError> {
    let needed = values.len().div_ceil(8);
    if bits.len() < needed {
        let found = format!("{} bytes", bits.len());
        return Err(refused(Format::X3p, "ValidPointsLink", &found, "a bit for each point"));
    }
    for (i, value) in values.iter_mut().enumerate() {
        if bits[i / 8] >> (i % 8) & 1 == 0 {
            *value = f64::NAN;
        }
    }
    Ok(())
}

/// A file of the archive, of at most `most` bytes.
fn member(archive: &mut Archive<'_>, name: &str, most: u64) -> Result<Vec<u8>, FormatError> {
    let file = archive.by_name(name).map_err(|cause| container(&format_args!("{name}: {cause}")))?;
    let mut bytes = Vec::new();
    let read = file.take(most.saturating_add(1)).read_to_end(&mut bytes);
    read.map_err(|cause| container(&format_args!("{name}: {cause}")))?;
    if bytes.len() as u64 > most {
        return Err(container(&format_args!("{name} has more than the {most} bytes that it should have")));
    }
    Ok(bytes)
}

/// Type of the heights, increments along x, y and z, and offset of the heights.
fn axes(root: Node<'_, '_>) -> Result<(Number, [f64; 3], f64), FormatError> {
    for axis in ["CX", "CY"] {
        if text(root, axis, "AxisType")? != "I" {
            return Err(unsupported("points at coordinates of their own", "save the map on a regular grid"));
        }
    }
    let number = match text(root, "CZ", "DataType")? {
        "I" => Number::I16,
        "L" => Number::I32,
        "F" => Number::F32,
        "D" => Number::F64,
        other => return Err(refused(Format::X3p, "CZ DataType", other, "I, L, F or D")),
    };
    let length = |axis, field: &'static str, default: Option<f64>| match text(root, axis, field) {
        Ok(text) => text.parse::<f64>().map_err(|_| refused(Format::X3p, field, text, "a number")),
        Err(error) => default.ok_or(error),
    };
    let x = positive(Format::X3p, "CX Increment", length("CX", "Increment", None)?)?;
    let y = positive(Format::X3p, "CY Increment", length("CY", "Increment", None)?)?;
    let z = factor(Format::X3p, "CZ Increment", length("CZ", "Increment", Some(1.0))?)?;
    Ok((number, [x, y, z], length("CZ", "Offset", Some(0.0))?))
}

fn grid(root: Node<'_, '_>) -> Result<Grid, FormatError> {
    let size = |field: &'static str| {
        let text = text(root, "MatrixDimension", field)?;
        text.parse::<usize>().map_err(|_| refused(Format::X3p, field, text, "a number of points"))
    };
    let grid = Grid::new(size("SizeX")?, size("SizeY")?)?;
    match size("SizeZ") {
        Ok(layers) if layers != 1 => Err(unsupported("more than one layer", "save one layer")),
        _ => Ok(grid),
    }
}

/// The text of `field` in the first element called `parent`.
fn text<'a>(root: Node<'a, '_>, parent: &str, field: &'static str) -> Result<&'a str, FormatError> {
    let parent = root.descendants().find(|node| is_called(parent, node));
    let field_of = parent.and_then(|parent| parent.children().find(|node| is_called(field, node)));
    let text = field_of.and_then(|node| node.text()).map(str::trim).filter(|text| !text.is_empty());
    text.ok_or(FormatError::Missing { format: Format::X3p, field })
}

fn is_called(name: &str, node: &Node<'_, '_>) -> bool {
    node.is_element() && node.tag_name().name() == name
}

fn container(reason: &(impl ToString + ?Sized)) -> FormatError {
    FormatError::Container { format: Format::X3p, reason: shown_as_line(&reason.to_string()) }
}

fn unsupported(what: &str, cure: &'static str) -> FormatError {
    FormatError::Unsupported { format: Format::X3p, what: what.to_owned(), cure }
}
