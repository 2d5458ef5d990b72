//! Zygo MetroPro files (MetroPro Reference Guide OMP-0347, "Data format").
//!
//! The format has a big-endian header, intensities, and phases as 32-bit integers with rows from top to bottom.

use rc_core::Grid;

use super::channel::{Channels, only};
use super::fields::{factor, refused};
use super::instrument::{Places, map, scale_measured, sides};
use crate::{Format, FormatError, HeightMap};

/// The first bytes. The last of them says which header follows.
pub(super) const MARKS: [&[u8]; 3] = [b"\x88\x1b\x03\x6f", b"\x88\x1b\x03\x70", b"\x88\x1b\x03\x71"];

/// The possible lengths of a header.
const HEADERS: [usize; 2] = [834, 4096];

/// Phases from this value on are missing points.
const MISSING: f64 = 2_147_483_640.0;

const BYTES: usize = 4;

pub(super) fn channels(bytes: &[u8]) -> Channels<'_> {
    let header = Places::new(bytes, Format::MetroPro);
    let short = |at| Ok::<_, FormatError>(usize::from(u16::from_be_bytes(header.array(at)?)));
    let float = |at| Ok::<_, FormatError>(f64::from(f32::from_be_bytes(header.array(at)?)));
    let size = u32::from_be_bytes(header.array(6)?) as usize;
    if !HEADERS.contains(&size) {
        return Err(refused(Format::MetroPro, "size of the header", &size, "834 or 4096 bytes"));
    }
    let [phases, intensities] = [[short(68)?, short(70)?], [short(52)?, short(54)?]];
    let intensities = 2 * short(56)? * intensities[0] * intensities[1];
    let grid = Grid::new(phases[0], phases[1])?;
    let of_phase = match short(218)? {
        0 => 4096.0,
        1 => 32768.0,
        2 => 131_072.0,
        other => return Err(refused(Format::MetroPro, "resolution of phases", &other, "0, 1 or 2")),
    };
    // Interferometric scale factor, obliquity factor and wavelength (m).
    let scale = factor(Format::MetroPro, "scale of heights", float(164)? * float(176)? * float(168)? / of_phase)?;
    let scale = if short(232)? == 0 { scale } else { -scale };
    let lateral = float(184)?;
    // A value of 0 means that the instrument was not calibrated along x and y.
    let sides = if lateral == 0.0 {
        None
    } else {
        Some(sides(Format::MetroPro, ["lateral resolution"; 2], grid, [lateral; 2])?)
    };
    Ok(only(move || read(header.rest(size + intensities), grid, scale, sides)))
}

fn read(phases: &[u8], grid: Grid, scale: f64, sides: Option<[f64; 2]>) -> Result<HeightMap, FormatError> {
    let (chunks, _) = phases.as_chunks::<BYTES>();
    let cut_short = || {
        let needed = (BYTES * grid.len()) as u64;
        FormatError::CutShort { grid, needed, found: phases.len() as u64 }
    };
    let stored = chunks.get(..grid.len()).ok_or_else(cut_short)?;
    let mut values: Vec<f64> = stored.iter().map(|chunk| f64::from(i32::from_be_bytes(*chunk))).collect();
    scale_measured(&mut values, scale, |phase| phase >= MISSING);
    Ok(map(grid, values, true, sides).of_numbers(scale))
}
