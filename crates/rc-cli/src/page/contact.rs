//! The page of one solved contact.

use std::path::Path;

use rc_core::{Field, Kernel};
use rc_solver::{ContactSpot, StressDistribution};
use rc_theory::persson::Persson;
use serde::Serialize;

use super::command::{flags, quoted};
use super::embedded::{Bits, EmbeddedField, MOST_PIXELS, pixel_means};
use super::spot_sizes::SpotSizes;
use super::{Body, Command, Page, Text, Tile, made};
use crate::error::CliError;
use crate::picture::Palette;
use crate::quantity::{digits, engineering};
use crate::result::ResultFolder;
use crate::scene::{KernelName, Scene};
use crate::summary::Summary;
use crate::{report, resolve, scene_file};

/// Bins of the stress distribution.
const BINS: usize = 80;

/// Gaps below this part of the highest point's height are none.
const ROUNDING: f64 = 1e-9;

/// What the load must be carried to, whatever the tolerance.
const LOAD_LIMIT: f64 = 1e-10;

/// The data of the page that are of this kind only.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Contact {
    maps: Maps,
    stress: Option<Stress>,
    spots: Option<SpotSizes>,
    certificate: Certificate,
    /// Names and values, as `rc solve` prints them.
    lines: Vec<(&'static str, String)>,
}

#[derive(Clone, Debug, Serialize)]
struct Maps {
    /// Side of the cell (m).
    side: f64,
    /// Pa.
    pressure: EmbeddedField,
    /// m.
    gap: EmbeddedField,
    /// Part of each pixel in contact.
    contact: EmbeddedField,
    /// Where the pressure is greatest, in parts of the cell.
    peak: [f64; 2],
    /// What a pixel is.
    averaged: String,
}

/// P(σ) over the whole nominal area.
#[derive(Clone, Debug, Serialize)]
struct Stress {
    /// Middles of bins (Pa).
    values: Vec<f64>,
    /// 1/Pa.
    density: Vec<f64>,
    fit: Vec<f64>,
    notes: Vec<String>,
}

#[derive(Clone, Debug, Serialize)]
struct Certificate {
    rows: Vec<CertificateRow>,
    note: &'static str,
}

#[derive(Clone, Debug, Serialize)]
struct CertificateRow {
    name: &'static str,
    value: String,
    limit: String,
    holds: bool,
}

/// The page of the result in `folder`.
///
/// # Errors
/// [`CliError::Input`] when it is no result folder.
pub(super) fn page(folder: &Path) -> Result<Page, CliError> {
    let result = ResultFolder::read_finite(folder)?;
    let scene_path = folder.join("scene.toml");
    let scene_text = std::fs::read_to_string(&scene_path)
        .map_err(|cause| CliError::in_file(&scene_path, format_args!("cannot read this scene file: {cause}")))?;
    let scene = scene_file::parse(&scene_text).map_err(|message| CliError::in_file(&scene_path, message))?;
    let summary = &result.summary;
    let load = match summary.control.as_str() {
        "penetration" => format!("at a penetration of {}", engineering(summary.penetration, "m")),
        _ => format!("under {}", engineering(summary.mean_pressure, "Pa")),
    };
    Ok(Page {
        title: format!("Contact {load}"),
        subtitle: subtitle(&scene, &result),
        status: summary.status.replace('_', " "),
        good: summary.status != "not_converged",
        tiles: tiles(summary),
        commands: commands(folder, &scene),
        files: vec![
            Text { title: "scene.toml", text: scene_text },
            Text { title: "summary.json", text: summary.to_json() },
        ],
        made: made(),
        body: Body::Result(Box::new(Contact {
            maps: maps(&result),
            stress: stress(&result),
            spots: spots(&result, resolve::kernel(scene.contact.kernel.unwrap_or(KernelName::Love))),
            certificate: certificate(summary),
            lines: report::solved_lines(summary, result.side, result.e_star),
        })),
    })
}

fn subtitle(scene: &Scene, result: &ResultFolder) -> String {
    let keys = &scene.surface;
    let surface = match (&keys.heights, keys.waves, keys.hurst, keys.seed) {
        (Some(_), ..) => "a height map".to_owned(),
        (None, Some(waves), Some(hurst), Some(seed)) => format!("{waves} waves, H = {hurst}, seed {seed}"),
        _ => "a random surface".to_owned(),
    };
    let s = &result.summary;
    format!(
        "{surface}: rms height {}, rms slope {}, in a cell of {}; E* = {}; {} x {} elements, kernel {}, method {}",
        engineering(s.rms_height, "m"),
        digits(s.rms_slope, 4),
        engineering(result.side, "m"),
        engineering(result.e_star, "Pa"),
        s.grid[0],
        s.grid[1],
        s.kernel,
        s.method
    )
}

fn tiles(s: &Summary) -> Vec<Tile> {
    let area = format!("{} %", report::with_error(100.0 * s.area_fraction, 100.0 * s.area_fraction_error));
    let tile = |name, value| Tile { name, value };
    vec![
        tile("contact area", area),
        tile("mean pressure", engineering(s.mean_pressure, "Pa")),
        tile("penetration", engineering(s.penetration, "m")),
        tile("mean gap", engineering(s.mean_gap, "m")),
        tile("greatest pressure", engineering(s.max_pressure, "Pa")),
        tile("stiffness", report::stiffness(s)),
    ]
}

fn commands(folder: &Path, scene: &Scene) -> Vec<Command> {
    let path = quoted(&folder.join("scene.toml").display().to_string());
    let mut commands = vec![Command {
        note: "From its folder, digit by digit:".to_owned(),
        text: format!("rc solve {path} --out again"),
    }];
    if scene.surface.heights.is_none() {
        let text = format!("rc solve{}{} --out again", flags(&scene.surface), flags(&scene.contact));
        commands.push(Command { note: "Without any file:".to_owned(), text });
    }
    commands
}

fn maps(result: &ResultFolder) -> Maps {
    let ResultFolder { side, pressure, gap, summary, .. } = result;
    let [pressures, gaps] = [pressure, gap].map(|field| pixel_means(field, |value| value));
    let contact = pixel_means(pressure, |value| f64::from(u8::from(value > 0.0)));
    let pixels = pressures.grid();
    let peak = (0..pixels.len()).max_by(|a, b| pressures.values()[*a].total_cmp(&pressures.values()[*b])).unwrap_or(0);
    let (x, y) = pixels.centre(peak % pixels.nx(), peak / pixels.nx());
    // In full contact, gaps are rounding.
    let widest = Some(gaps.max()).filter(|gap| *gap > ROUNDING * summary.penetration_full_contact).unwrap_or(0.0);
    let grid = pressure.grid();
    let averaged = if grid == pixels {
        "Every element is a pixel.".to_owned()
    } else {
        format!("At most {MOST_PIXELS} x {MOST_PIXELS} pixels: each is the mean over its elements, of {grid}.")
    };
    Maps {
        side: *side,
        pressure: EmbeddedField::new(&pressures, pressures.max(), Bits::Sixteen, Palette::Heat),
        gap: EmbeddedField::new(&gaps, widest, Bits::Sixteen, Palette::Viridis),
        contact: EmbeddedField::new(&contact, 1.0, Bits::Eight, Palette::Ink),
        peak: [x, y],
        averaged,
    }
}

/// P(σ) and the Λ of Eq. 7 that fits it; `None` without contact.
fn stress(result: &ResultFolder) -> Option<Stress> {
    let ResultFolder { pressure, e_star, summary, .. } = result;
    let max = pressure.max();
    if max <= 0.0 {
        return None;
    }
    let edges: Vec<f64> = (0..=BINS).map(|k| max * k as f64 / BINS as f64).collect();
    let distribution = StressDistribution::of(pressure, &edges);
    let stress: Vec<f64> = edges.windows(2).map(|edge| 0.5 * (edge[0] + edge[1])).collect();
    let points: Vec<(f64, f64)> = stress.iter().copied().zip(distribution.density.iter().copied()).collect();
    let fit = Persson::fit(summary.mean_pressure, &points);
    let theory = Persson::from_rms_slope(summary.mean_pressure / e_star, summary.rms_slope);
    let notes = vec![
        "Over the whole nominal area, resolved below the element at contact edges, where it begins at zero.".to_owned(),
        format!(
            "The fit of one constant: Λ = {} E*², {} of the theory's g²/8 with the rms slope g. Its area, erf(σ0/2√Λ) = {} %, is \
             what the fit says; solved were {} %.",
            digits(fit.lambda / (e_star * e_star), 4),
            digits(fit.lambda / (e_star * e_star) / theory.lambda, 3),
            digits(100.0 * fit.area_fraction(), 3),
            digits(100.0 * summary.area_fraction, 3)
        ),
    ];
    let fitted = stress.iter().map(|&s| fit.density(s)).collect();
    Some(Stress { values: stress, density: distribution.density, fit: fitted, notes })
}

/// Spots of the stored fields, in the units in which their edges are located.
fn spots(result: &ResultFolder, kernel: &dyn Kernel) -> Option<SpotSizes> {
    let ResultFolder { side, e_star, pressure, gap, .. } = result;
    let over = |field: &Field, unit: f64| {
        let mut field = field.clone();
        field.values_mut().iter_mut().for_each(|value| *value /= unit);
        field
    };
    let spots = ContactSpot::all(&over(pressure, *e_star), &over(gap, *side), kernel.edge_bias());
    SpotSizes::of(&spots, pressure.grid(), *side)
}

fn certificate(s: &Summary) -> Certificate {
    let row = |name, value: f64, limit: Option<f64>| CertificateRow {
        name,
        value: format!("{value:.1e}"),
        limit: limit.map_or_else(|| "not known".to_owned(), |limit| format!("{limit:.0e}")),
        holds: limit.is_none_or(|limit| value <= limit),
    };
    Certificate {
        rows: vec![
            row("pressure where there is a gap", s.complementarity_error, s.tolerance),
            row("deepest overlap", s.penetration_error, s.tolerance),
            row("load", s.load_error, Some(LOAD_LIMIT)),
        ],
        note: "From a fresh application of the elastic operator to the pressure that is shown, not from what the iteration \
               believed; relative to the range of heights and to the load. It bounds how far the pressure is from solving the \
               discrete problem; how far that is from the continuous one is the error bar of the area.",
    }
}
