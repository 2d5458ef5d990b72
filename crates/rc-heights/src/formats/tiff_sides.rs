//! Sizes of TIFF images, as ImageJ, microscopes (OME) and programs for maps (GeoTIFF) write them.

use std::io::Cursor;

use rc_core::Grid;
use roxmltree::Document;
use tiff::decoder::Decoder;
use tiff::decoder::ifd::Value;
use tiff::tags::Tag;

use super::unit;
use crate::{FormatError, LengthUnit, Unit};

/// Points per metre above which they are those of a measurement: 10 µm. Screens and printers have fewer.
const FINEST_PRINT: f64 = 1e5;

/// Tag of keys of coordinates in GeoTIFF.
const GEO_KEYS: u16 = 34735;
/// Key of the kind of coordinates, and its value for a projection, whose unit is a length.
const MODEL: (u16, u16) = (1024, 1);
/// Key of the unit of a projection, and its value for metres.
const LINEAR_UNIT: (u16, u16) = (3076, 9001);

/// A decoder at an image.
pub(super) type Image<'a> = Decoder<Cursor<&'a [u8]>>;

/// Distances of points along x and y, and their unit.
type Spacing = ([f64; 2], Unit);

/// Sides of an image of `size` points, if it has them.
pub(super) fn of(image: &mut Image<'_>, size: [u32; 2]) -> Result<Option<Spacing>, FormatError> {
    let grid = Grid::new(size[0] as usize, size[1] as usize)?;
    let description = image.find_tag(Tag::ImageDescription).ok().flatten().and_then(|value| value.into_string().ok());
    let description = description.unwrap_or_default();
    let found = of_ome(&description)
        .or_else(|| of_imagej(image, &description))
        .or_else(|| of_geography(image))
        .or_else(|| of_density(image));
    let is_length = |length: &f64| *length > 0.0 && length.is_finite();
    let found = found.filter(|(spacing, _)| spacing.iter().all(is_length));
    Ok(found.map(|([x, y], unit)| ([x * grid.nx() as f64, y * grid.ny() as f64], unit)))
}

/// Attributes `PhysicalSizeX` and `PhysicalSizeY` of a description in OME-XML. They are in µm unless a unit is named.
fn of_ome(description: &str) -> Option<Spacing> {
    if !description.contains("PhysicalSizeX") {
        return None;
    }
    let document = Document::parse(description.trim_end_matches('\0')).ok()?;
    let pixels = document.descendants().find(|node| node.has_attribute("PhysicalSizeX"))?;
    let spacing = |axis: &str| {
        let unit = pixels.attribute(format!("PhysicalSize{axis}Unit").as_str()).unwrap_or("um");
        let length: f64 = pixels.attribute(format!("PhysicalSize{axis}").as_str())?.trim().parse().ok()?;
        Some(length * unit::length(unit)?.metres())
    };
    Some(([spacing("X")?, spacing("Y")?], Unit::Metre))
}

/// Points per unit, which a description of ImageJ names.
fn of_imagej(image: &mut Image<'_>, description: &str) -> Option<Spacing> {
    let value = |name: &str| {
        let line = description.lines().find_map(|line| line.trim().strip_prefix(name));
        line.and_then(|rest| rest.strip_prefix('=')).map(str::trim)
    };
    value("ImageJ")?;
    let unit = value("unit")?.replace("\\u00B5", "µ");
    let metres = unit::length(&unit)?.metres();
    let [x, y] = densities(image)?;
    Some(([metres / x, metres / y], Unit::Metre))
}

/// Distances of points of GeoTIFF. They have no unit if the file does not say that they are lengths.
fn of_geography(image: &mut Image<'_>) -> Option<Spacing> {
    let scale = image.find_tag(Tag::ModelPixelScaleTag).ok()??.into_f64_vec().ok()?;
    let [x, y, ..] = *scale.as_slice() else { return None };
    let keys = image.find_tag(Tag::Unknown(GEO_KEYS)).ok().flatten().and_then(|value| value.into_u16_vec().ok());
    let Some(keys) = keys else { return Some(([x, y], Unit::Unnamed)) };
    let key = |name: u16| keys.chunks_exact(4).skip(1).find(|key| key[0] == name).map(|key| key[3]);
    // Degrees are no lengths, and feet are not read.
    let is_metre = key(MODEL.0) == Some(MODEL.1) && key(LINEAR_UNIT.0).is_none_or(|unit| unit == LINEAR_UNIT.1);
    is_metre.then_some(([x, y], Unit::Metre))
}

/// Points per inch or centimetre, if they are finer than those of any printer.
fn of_density(image: &mut Image<'_>) -> Option<Spacing> {
    let metres = match image.find_tag_unsigned::<u16>(Tag::ResolutionUnit).ok()?.unwrap_or(2) {
        2 => 2.54 * LengthUnit::Centimetre.metres(),
        3 => LengthUnit::Centimetre.metres(),
        _ => return None,
    };
    let [x, y] = densities(image)?;
    (x.min(y) / metres >= FINEST_PRINT).then_some(([metres / x, metres / y], Unit::Metre))
}

fn densities(image: &mut Image<'_>) -> Option<[f64; 2]> {
    let mut density = |tag| match image.find_tag(tag).ok()?? {
        Value::Rational(points, units) => Some(f64::from(points) / f64::from(units)),
        _ => None,
    };
    Some([density(Tag::XResolution)?, density(Tag::YResolution)?])
}
