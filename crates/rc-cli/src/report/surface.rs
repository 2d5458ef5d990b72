//! The page of a surface without a contact.

use std::path::Path;

use rc_core::quantity::{digits, engineering};
use rc_core::{Field, Grid};
use rc_heights::ProfileParameters;
use rc_plot::{Palette, range_of_most};
use serde::Serialize;

use super::command::quoted;
use super::embedded::{Bits, EmbeddedField, MOST_PIXELS, pixel_means};
use super::page::{Command, Page, Text, Tile, made};
use crate::error::CliError;
use crate::inspect::record::SurfaceRecord;
use crate::inspect::text::{parameter_lines, surface_lines};
use crate::inspect::{Inspected, of_surface};
use crate::scene::keys::{RunKeys, Scene};
use crate::warnings::shown::tell;
use rc_sweep::{MapOrigin, to_json};

/// The data of a page of a surface, without those of all pages.
#[derive(Clone, Debug, Serialize)]
pub(super) struct SurfaceBody {
    /// Sides of the cell along x and y (m).
    sides: [f64; 2],
    /// Height above the lowest point (m).
    heights: EmbeddedField,
    /// Heights above the lowest point at the ends of the colours (m).
    span: (f64, f64),
    /// The lowest height (m).
    lowest: f64,
    note: String,
    /// Whether only a quarter (half of a profile) is measured, and the rest is its mirror images.
    mirrored: bool,
    /// Whether the surface is a profile, of one row.
    line: bool,
    /// Wavenumber (rad/m) and spectrum C (m⁴).
    spectrum: Vec<(f64, f64)>,
    /// Ends of the power law in the spectrum, if there is one, and its Hurst exponent.
    law: Option<(Vec<(f64, f64)>, String)>,
    /// Height about the mean (m) and density (1/m).
    distribution: Vec<(f64, f64)>,
    /// Material ratio and height about the mean (m), and the same at the ends of the line of the core.
    material_ratio: Vec<(f64, f64)>,
    core: [(f64, f64); 2],
    lines: Vec<(&'static str, String)>,
    parameters: Vec<(&'static str, String)>,
}

/// The page of the scene at `path`, or of the folder with one. Its warnings are told unless `quiet`.
///
/// # Errors
/// [`CliError::Input`].
pub(super) fn page(path: &Path, quiet: bool) -> Result<Page<SurfaceBody>, CliError> {
    let Inspected { heights, record } = of_surface(path, Scene::default())?;
    tell(&record.warnings, &RunKeys { quiet, ..RunKeys::default() });
    let tile = |name, value| Tile { name, value };
    let command = format!("rc solve {} --e-star ... --pressure ... --out result", quoted(&path.display().to_string()));
    Ok(Page {
        title: "Surface".to_owned(),
        subtitle: match record.grid {
            [nx, 1] => format!("a profile of {nx} points, nothing presses on it"),
            [nx, ny] => format!("{nx} x {ny} points, nothing presses on it"),
        },
        status: "surface".to_owned(),
        good: true,
        warnings: record.warnings.iter().map(|warning| warning.text.clone()).collect(),
        tiles: vec![
            tile("rms height", engineering(record.rms_height, "m")),
            tile("rms slope", digits(record.rms_slope, 4)),
            tile("range of heights", engineering(record.h_max - record.h_min, "m")),
        ],
        commands: vec![Command { note: "This presses it:".to_owned(), text: command }],
        files: vec![Text { title: "Statistics", text: to_json(&record) }],
        made: made(),
        kind: "surface",
        body: SurfaceBody::of(&heights, &record),
    })
}

impl SurfaceBody {
    /// The surface of `heights` (in λ) with its statistics, which may be from fewer points.
    pub(super) fn of(heights: &Field, record: &SurfaceRecord) -> Self {
        let lowest = heights.min();
        let pixels = pixel_means(heights.grid(), |i| (heights.values()[i] - lowest) * record.cell);
        let is_line = heights.grid().ny() == 1;
        let mirrored = record.source.as_ref().is_some_and(is_mirrored);
        Self {
            sides: [record.cell, record.cell_y],
            heights: EmbeddedField::of_gap(&pixels, pixels.max(), Bits::Sixteen, Palette::Viridis),
            span: range_of_most(&pixels),
            lowest: lowest * record.cell,
            note: note(heights.grid(), pixels.grid(), mirrored) + &of_fewer(heights.grid(), record.grid),
            mirrored,
            line: is_line,
            spectrum: spectrum(record),
            law: law(record),
            distribution: record.distribution.bins().collect(),
            material_ratio: record.areal.curve.clone(),
            core: record.areal.equivalent_line(),
            lines: record.source.iter().map(source).chain(surface_lines(record)).collect(),
            parameters: if is_line { profile_lines(heights, record.cell) } else { parameter_lines(record) },
        }
    }
}

/// Names and values of the parameters of the profile `heights` (in λ), as `rc inspect` of a profile has them.
fn profile_lines(heights: &Field, side: f64) -> Vec<(&'static str, String)> {
    let ProfileParameters { a, q, sk, ku, p, v, z, .. } = ProfileParameters::of(heights.values());
    let [a, q, p, v, z] = [a, q, p, v, z].map(|length| engineering(length * side, "m"));
    vec![
        ("Pa, Pq", format!("{a}, {q}")),
        ("Psk, Pku", format!("{}, {}", digits(sk, 3), digits(ku, 4))),
        ("Pp, Pv, Pz", format!("{p}, {v}, {z}")),
    ]
}

/// Whether the map was made periodic by its mirror images, with nothing that moves them since.
fn is_mirrored(source: &MapOrigin) -> bool {
    source.treatments.iter().any(|treatment| treatment == "periodic mirror")
        && !source.treatments.iter().any(|treatment| {
            treatment.starts_with("twin") || treatment.starts_with("repeat") || treatment.contains(" added")
        })
}

/// What the map shows.
fn note(grid: Grid, pixels: Grid, mirrored: bool) -> String {
    let is_line = grid.ny() == 1;
    let pixel = match (pixels == grid, is_line) {
        (true, true) => "The curve has every point.".to_owned(),
        (true, false) => "Every point is a pixel.".to_owned(),
        (false, true) => format!("The curve has {} points, each a mean of the {} points.", pixels.nx(), grid.nx()),
        (false, false) => format!(
            "The map has at most {MOST_PIXELS} x {MOST_PIXELS} pixels. Each pixel is a mean of the {grid} points."
        ),
    };
    let measured = if is_line {
        "The measured half is shown. The rest is its mirror image (periodic mirror). "
    } else {
        "The map shows the measured quarter of the cell. The rest is its mirror images (periodic mirror). "
    };
    if mirrored { measured.to_owned() + &pixel } else { pixel }
}

/// A note about statistics from fewer points than the map's.
fn of_fewer(grid: Grid, points: [usize; 2]) -> String {
    if [grid.nx(), grid.ny()] == points {
        return String::new();
    }
    let number = if points[1] == 1 { points[0].to_string() } else { format!("{} x {}", points[0], points[1]) };
    format!(" The statistics are of {number} points, except the exact rms height and slope.")
}

/// The line about the file of the map.
fn source(source: &MapOrigin) -> (&'static str, String) {
    let channel = source.channel.iter().map(|channel| format!(", channel {channel}"));
    let treatments = source.treatments.join(", ");
    let treated = Some(treatments).filter(|list| !list.is_empty()).map(|list| format!("; treatments: {list}"));
    ("source", source.file.clone() + &channel.chain(treated).collect::<String>())
}

/// The spectrum where it is more than rounding.
fn spectrum(record: &SurfaceRecord) -> Vec<(f64, f64)> {
    let highest = record.spectrum.iter().fold(0.0_f64, |most, row| most.max(row.psd));
    record.spectrum.iter().filter(|row| row.psd > 1e-20 * highest).map(|row| (row.wavenumber, row.psd)).collect()
}

fn law(record: &SurfaceRecord) -> Option<(Vec<(f64, f64)>, String)> {
    let fit = record.hurst_fit?;
    let ends = [fit.from_waves, fit.to_waves].map(|waves| std::f64::consts::TAU * waves / record.cell);
    let [from, to] = [fit.from_waves, fit.to_waves].map(|waves| engineering(record.cell / waves, "m"));
    let label = format!("Hurst exponent H = {}, for wavelengths from {from} to {to}", digits(fit.hurst, 3));
    Some((ends.map(|q| (q, fit.psd(q))).to_vec(), label))
}
