//! Sensofar files.
//!
//! The format has a header without a mark, then layers of 32-bit floats in µm with rows from top to bottom. The
//! documentation of Gwyddion describes it.

use rc_core::Grid;

use super::binary::Number;
use super::channel::{Channel, Channels, each};
use super::fields::refused;
use super::instrument::{Places, map, scale_measured, sides};
use crate::{Format, FormatError, HeightMap};

/// Place of the calibration, after a date, a time and a comment.
const CALIBRATION: usize = 388;
/// Place of the configuration of the measurement.
const CONFIGURATION: usize = 428;
/// Place of the first layer.
const LAYERS: usize = 500;

/// The type of a measurement that is a map of heights.
const TOPOGRAPHY: usize = 3;

/// The height of a missing point.
const MISSING: f64 = 1_000_001.0;

const MICROMETRE: f64 = 1e-6;

pub(super) fn channels(bytes: &[u8]) -> Channels<'_> {
    let header = Places::new(bytes, Format::Plu);
    let kind = header.size(CONFIGURATION)?;
    if kind != TOPOGRAPHY {
        return Err(refused(Format::Plu, "type of measurement", &kind, "3, a map of heights"));
    }
    let spacing = [header.f32(CALIBRATION + 16)? * MICROMETRE, header.f32(CALIBRATION + 20)? * MICROMETRE];
    let [_, layers, _, _] = header.array(LAYERS - 12)?;
    let [images] = header.array(LAYERS - 8)?;
    let (mut channels, mut at) = (Vec::new(), LAYERS);
    // Of truncated layers, the first is an error and the others are omitted.
    while channels.is_empty() || channels.len() < usize::from(layers) && header.rest(at).len() > 8 {
        let name = format!("layer {}", channels.len() + 1);
        let (grid, sides) = match layer(header, at, spacing) {
            Ok(layer) => layer,
            // It is not known where the next layers begin.
            Err(error) => {
                channels.push((name, Err(error)));
                break;
            }
        };
        let heights = header.rest(at + 8);
        let read = Box::new(move || read(heights, grid, sides));
        channels.push((name.clone(), Ok(Channel { name, is_height: true, read })));
        // Heights, the minimum and the maximum, and images of three bytes for each point.
        at = at.saturating_add(16).saturating_add(grid.len() * (Number::F32.size() + 3 * usize::from(images)));
    }
    let mut channels = each(channels);
    if let [only] = &mut channels[..] {
        only.name.clear();
    }
    Ok(channels)
}

/// Numbers of points and sides of the layer at `at`.
fn layer(header: Places<'_>, at: usize, spacing: [f64; 2]) -> Result<(Grid, [f64; 2]), FormatError> {
    let grid = Grid::new(header.size(at.saturating_add(4))?, header.size(at)?)?;
    let fields = ["distance of points along x", "distance of points along y"];
    Ok((grid, sides(Format::Plu, fields, grid, spacing)?))
}

fn read(heights: &[u8], grid: Grid, sides: [f64; 2]) -> Result<HeightMap, FormatError> {
    let mut values = Number::F32.values(heights, grid)?;
    scale_measured(&mut values, MICROMETRE, |value| value == MISSING);
    Ok(map(grid, values, true, Some(sides)).of_numbers(MICROMETRE))
}
