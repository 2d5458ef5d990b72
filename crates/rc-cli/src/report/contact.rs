//! The page of one solved contact.

use std::path::Path;

use rc_core::{Boundary, EdgeBias};
use rc_solver::StressDistribution;
use rc_theory::persson::Persson;
use serde::Serialize;

use super::certificate::Certificate;
use super::command::{flags, quoted};
use super::embedded::{Bits, EmbeddedField, MOST_PIXELS, pixel_means};
use super::flow_picture::FlowPicture;
use super::kappa::kappa;
use super::page::{Command, Page, Text, Tile, made};
use super::result_surface::{ResultSurface, peak};
use super::spot_sizes::SpotSizes;
use crate::error::CliError;
use crate::files::result::ResultFolder;
use crate::scene::file;
use crate::scene::keys::{KernelName, Scene};
use crate::scene::resolve::{self, shear};
use crate::text;
use rc_core::quantity::{digits, engineering};
use rc_plot::Palette;
use rc_sweep::{FrictionSummary, Summary};

/// Value of an element that slips on the map of stick and slip, on which 1 sticks.
const SLIPPING: f64 = 0.4;

/// Number of bins of the stress distribution.
const BINS: usize = 80;

/// Ratio of a gap to the maximum height below which the gap counts as zero.
const ROUNDING: f64 = 1e-9;

/// The data of a page of a contact, without those of all pages.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Contact {
    maps: Maps,
    /// The surface and sections through both bodies, or why there are none.
    surface: Option<ResultSurface>,
    no_surface: Option<String>,
    /// κ beside theory.
    kappa: Option<String>,
    stress: Option<Stress>,
    certificate: Certificate,
    /// Names and values, as `rc solve` prints them.
    lines: Vec<(&'static str, String)>,
    spots: Option<SpotSizes>,
    leakage: Option<FlowPicture>,
    /// Direction of a surface that slides, as a unit vector.
    direction: Option<[f64; 2]>,
}

#[derive(Clone, Debug, Serialize)]
struct Maps {
    /// Sides of the cell along x and y (m).
    sides: [f64; 2],
    /// Pressure (Pa).
    pressure: EmbeddedField,
    /// Gap (m).
    gap: EmbeddedField,
    /// Fraction of each pixel in contact, or fraction of its stored means that are above 0.
    contact: EmbeddedField,
    /// Stick (1) and slip (between) of a sheared contact, with the direction of the shear as a unit vector.
    slip: Option<(EmbeddedField, [f64; 2])>,
    /// Whether the contact is that of a profile.
    line: bool,
    /// Whether the fields have one value for each element.
    of_elements: bool,
    /// Place of the maximum pressure, in fractions of the cell.
    peak: [f64; 2],
    /// Explanation of the meaning of a pixel.
    averaged: String,
}

/// Stress distribution P(σ) over the whole nominal area.
#[derive(Clone, Debug, Serialize)]
struct Stress {
    /// Middles of bins (Pa).
    values: Vec<f64>,
    /// Density (1/Pa) in each bin.
    density: Vec<f64>,
    fit: Vec<f64>,
    notes: Vec<String>,
}

/// The page of the result in `folder`.
///
/// # Errors
/// [`CliError::Input`] when it is not a result folder.
pub(super) fn page(folder: &Path) -> Result<Page<Contact>, CliError> {
    let result = ResultFolder::read_finite(folder)?;
    let scene_path = folder.join("scene.toml");
    let scene_text = std::fs::read_to_string(&scene_path)
        .map_err(|cause| CliError::in_file(&scene_path, format_args!("cannot read this scene file: {cause}")))?;
    let scene = file::parse(&scene_text).map_err(|message| CliError::in_file(&scene_path, message))?;
    let kernel = resolve::kernel(scene.contact.kernel.unwrap_or(KernelName::Love));
    let bias = kernel.map_or_else(EdgeBias::default, |kernel| kernel.edge_bias(result.pressure.grid()));
    let summary = &result.summary;
    let direction = result.direction.map(|direction| direction.to_array());
    let load = match summary.control.as_str() {
        "penetration" => format!("at a penetration of {}", engineering(summary.penetration, "m")),
        "force" => {
            let force = engineering(summary.force.unwrap_or(f64::NAN), "N");
            format!("under {force}, which are {}", engineering(summary.mean_pressure, "Pa"))
        }
        _ => format!("under {}", engineering(summary.mean_pressure, "Pa")),
    };
    let (surface, no_surface) = match ResultSurface::of(&scene_path, &result) {
        Ok(surface) => (Some(surface), None),
        Err(cause) => (None, Some(cause.to_string())),
    };
    // Theory knows random surfaces at rest, without a fluid that bends them.
    let is_other = scene.surface.has_shape() || direction.is_some() || summary.mean_fluid_pressure.is_some();
    Ok(Page {
        title: format!("Contact {load}"),
        subtitle: subtitle(&scene, &result),
        status: summary.status.replace('_', " "),
        good: summary.status != "not_converged",
        warnings: summary.warnings.iter().map(|warning| warning.text.clone()).collect(),
        tiles: tiles(summary),
        commands: commands(folder, &scene),
        files: vec![
            Text { title: "scene.toml", text: scene_text },
            Text { title: "summary.json", text: summary.to_json() },
        ],
        made: made(),
        kind: "result",
        body: Contact {
            maps: Maps { slip: slip_map(&result, &scene), ..maps(&result) },
            kappa: surface.as_ref().filter(|_| !is_other).and_then(|surface| {
                kappa(summary, result.e_star, surface.nayak().filter(|_| scene.contact.layer_thickness.is_none()))
            }),
            surface,
            no_surface,
            stress: stress(&result),
            certificate: Certificate::of(summary),
            lines: text::solved_lines(summary, result.sides(), result.e_star, &scene.contact),
            direction,
            leakage: FlowPicture::of(folder, summary),
            // This comes last, since it takes the fields.
            spots: SpotSizes::of_result(result, bias, scene.contact.boundary.unwrap_or_default()),
        },
    })
}

fn subtitle(scene: &Scene, result: &ResultFolder) -> String {
    let keys = &scene.surface;
    let surface = match (keys.file(), keys.waves, keys.hurst, keys.seed) {
        (Some(("spectrum", _)), ..) => "a surface of given waves".to_owned(),
        (Some(("psd", _)), _, _, Some(seed)) => format!("a surface of a tabulated spectrum, seed {seed}"),
        (Some(_), ..) if result.is_line() => "a profile".to_owned(),
        (Some(_), ..) => "a height map".to_owned(),
        (None, None, ..) if keys.is_shape() => "a shape".to_owned(),
        (None, Some(waves), Some(hurst), Some(seed)) => format!("{waves} waves, H = {hurst}, seed {seed}"),
        _ => "a random surface".to_owned(),
    };
    let s = &result.summary;
    let place = match (scene.contact.boundary, scene.contact.layer_thickness) {
        (Some(Boundary::Free), _) => "on a free patch of".to_owned(),
        (_, Some(thickness)) => {
            let of = engineering(thickness, "m");
            match scene.contact.substrate_young {
                Some(young) => {
                    format!("on a coating of {of} (substrate E = {}), in a cell of", engineering(young, "Pa"))
                }
                None => format!("on a layer of {of}, in a cell of"),
            }
        }
        _ if result.is_line() => "periodic with".to_owned(),
        _ => "in a cell of".to_owned(),
    };
    let [nx, ny] = s.grid;
    let elements =
        if result.is_line() { format!("{nx} elements, line contact") } else { format!("{nx} x {ny} elements") };
    format!(
        "{surface}: rms height {}, rms slope {}, {place} {}; E* = {}; {elements}, kernel {}, method {}",
        engineering(s.rms_height, "m"),
        digits(s.rms_slope, 4),
        text::cell(result.sides()),
        engineering(result.e_star, "Pa"),
        s.kernel,
        s.method
    )
}

fn tiles(s: &Summary) -> Vec<Tile> {
    let area = format!("{} %", text::with_error(100.0 * s.area_fraction, 100.0 * s.area_fraction_error));
    let tile = |name, value| Tile { name, value };
    let mut tiles = vec![
        tile("contact area", area),
        tile("mean pressure", engineering(s.mean_pressure, "Pa")),
        tile("penetration", engineering(s.penetration, "m")),
        tile("mean gap", engineering(s.mean_gap, "m")),
        tile("maximum pressure", engineering(s.max_pressure, "Pa")),
        tile("stiffness", text::stiffness(s)),
    ];
    if let Some(FrictionSummary { friction, friction_error, .. }) = s.friction {
        tiles.insert(1, tile("friction", text::coefficient(friction, friction_error)));
    }
    if let Some(shear) = &s.shear {
        tiles.insert(1, tile("slip area", format!("{} %", digits(100.0 * shear.slip_area_fraction, 4))));
        tiles.insert(2, tile("shear displacement", engineering(shear.shear_displacement, "m")));
    }
    if let (Some(fraction), Some(error)) = (s.plastic_area_fraction, s.plastic_area_fraction_error) {
        tiles.insert(1, tile("plastic area", format!("{} %", text::with_error(100.0 * fraction, 100.0 * error))));
    }
    tiles
}

fn commands(folder: &Path, scene: &Scene) -> Vec<Command> {
    let path = quoted(&folder.join("scene.toml").display().to_string());
    let mut commands = vec![Command {
        note: "With the scene file of the result folder, to the last digit:".to_owned(),
        text: format!("rc solve {path} --out again"),
    }];
    if scene.surface.file().is_none() && scene.contact.fluid_pressure.is_none() {
        let text = format!("rc solve{}{} --out again", flags(&scene.surface), flags(&scene.contact));
        commands.push(Command { note: "Without any file:".to_owned(), text });
    }
    commands
}

fn maps(result: &ResultFolder) -> Maps {
    let ResultFolder { pressure, gap, summary, .. } = result;
    let (grid, of_elements) = (pressure.grid(), result.is_of_elements());
    let (p, g) = (pressure.values(), gap.values());
    let pressures = pixel_means(grid, |i| p[i]);
    // In contact, the solver's small remaining gap counts as zero. A mean over elements may have both pressure and gap.
    let gaps = pixel_means(grid, |i| if of_elements && p[i] > 0.0 { 0.0 } else { g[i] });
    let contact = pixel_means(grid, |i| f64::from(u8::from(p[i] > 0.0)));
    let pixels = pressures.grid();
    let peak = peak(pressure);
    let peak_at = grid.centre(peak % grid.nx(), peak / grid.nx());
    // In full contact, gaps are only rounding.
    let widest = Some(gaps.max()).filter(|gap| *gap > ROUNDING * summary.penetration_full_contact).unwrap_or(0.0);
    let what = if of_elements { "element" } else { "stored value" };
    let pixel = if grid == pixels {
        format!("Every {what} is a {}.", if grid.ny() > 1 { "pixel" } else { "point" })
    } else if grid.ny() == 1 {
        format!("The curves have {} points, each a mean over a block of the {} {what}s.", pixels.nx(), grid.nx())
    } else {
        format!(
            "The maps have at most {MOST_PIXELS} x {MOST_PIXELS} pixels. Each pixel is a mean over a block of the {grid} {what}s."
        )
    };
    let [nx, ny] = summary.grid;
    let averaged = if of_elements {
        pixel
    } else {
        format!(
            "The files have {grid} means over blocks (output_grid) instead of values on {nx} x {ny} elements. A block is touched if any of its \
             elements is in contact. Stress distribution and contact spots need the elements, and are not shown. The numbers \
             on this page are from before averaging. {pixel}"
        )
    };
    Maps {
        sides: result.sides(),
        line: grid.ny() == 1,
        pressure: EmbeddedField::of_contact(&pressures, pressures.max(), Bits::Sixteen, Palette::Heat),
        gap: EmbeddedField::of_gap(&gaps, widest, Bits::Sixteen, Palette::Viridis),
        contact: EmbeddedField::of_contact(&contact, 1.0, Bits::Eight, Palette::Ink),
        slip: None,
        of_elements,
        peak: [peak_at.x, peak_at.y / grid.cell_ratio()],
        averaged,
    }
}

/// Where the contact slips and sticks, and the direction of the shear; `None` without a shear.
fn slip_map(result: &ResultFolder, scene: &Scene) -> Option<(EmbeddedField, [f64; 2])> {
    let slip = result.slip.as_ref().filter(|_| result.is_of_elements())?.values();
    let pressure = result.pressure.values();
    let value = |i: usize| match pressure[i] {
        p if p <= 0.0 => 0.0,
        _ if slip[i] > 0.0 => SLIPPING,
        _ => 1.0,
    };
    let pixels = pixel_means(result.pressure.grid(), value);
    let direction = shear::direction(&scene.contact).to_array();
    Some((EmbeddedField::of_contact(&pixels, 1.0, Bits::Eight, Palette::Heat), direction))
}

/// P(σ), and the fit of Eq. 7 with its Λ.
///
/// `None` without contact, or without values for the elements.
fn stress(result: &ResultFolder) -> Option<Stress> {
    let ResultFolder { pressure, e_star, summary, .. } = result;
    let max = pressure.max();
    if max <= 0.0 || !result.is_of_elements() {
        return None;
    }
    // In full contact P is a peak far from zero, which bins from zero on would not resolve.
    let least = pressure.min().max(0.0);
    let edges: Vec<f64> = (0..=BINS).map(|k| least + (max - least) * k as f64 / BINS as f64).collect();
    let distribution = StressDistribution::with_area(pressure, &edges, summary.area_fraction);
    let stress: Vec<f64> = edges.windows(2).map(|edge| 0.5 * (edge[0] + edge[1])).collect();
    let points: Vec<(f64, f64)> = stress.iter().copied().zip(distribution.density.iter().copied()).collect();
    let mean_pressure = summary.mean_contact_pressure.unwrap_or(summary.mean_pressure);
    let fit = Persson::fit(mean_pressure, &points);
    let theory = Persson::from_rms_slope(mean_pressure / e_star, summary.rms_slope);
    let over = if least > 0.0 {
        "The density is over the whole nominal area. Every element is in contact, and the first bin begins at the minimum pressure."
    } else {
        "The density is over the whole nominal area. The pressure falls to zero at contact edges, which are located within elements. The density is therefore zero at zero stress."
    };
    let notes = vec![
        over.to_owned(),
        format!(
            "The fit has one constant: Λ = {} E*², {} times the theory's (E* h')²/8{}, with the rms slope h'. The area of the fit is \
             erf(σ0/2√Λ) = {} %, and the solved area is {} %.",
            digits(fit.lambda / (e_star * e_star), 4),
            digits(fit.lambda / (e_star * e_star) / theory.lambda, 3),
            if summary.friction.is_some() { " of the relaxed solid" } else { "" },
            digits(100.0 * fit.area_fraction(), 3),
            digits(100.0 * summary.area_fraction, 3)
        ),
    ];
    let fitted = stress.iter().map(|&s| fit.density(s)).collect();
    Some(Stress { values: stress, density: distribution.density, fit: fitted, notes })
}

#[cfg(test)]
pub(super) mod tests {
    use rc_core::{Field, Grid};

    use super::*;

    /// A summary with equal numbers, except those that a test is about.
    pub(in crate::report) fn summary(
        grid: Grid,
        mean_pressure: f64,
        rms_slope: f64,
        tolerance: Option<f64>,
    ) -> Summary {
        let mut keys = serde_json::Map::new();
        for text in ["status", "control", "kernel", "method", "version"] {
            keys.insert(text.to_owned(), "love".into());
        }
        let numbers = [
            "penetration",
            "penetration_full_contact",
            "area_fraction",
            "area_fraction_cells",
            "area_fraction_error",
            "rms_pressure",
            "max_pressure",
            "mean_gap",
            "elastic_energy",
            "rms_height",
            "h_max",
            "complementarity_error",
            "penetration_error",
            "load_error",
            "wall_seconds",
        ];
        for number in numbers {
            keys.insert(number.to_owned(), 0.5.into());
        }
        for count in ["elements", "levels", "iterations", "operator_applications", "threads"] {
            keys.insert(count.to_owned(), 1.into());
        }
        keys.insert("grid".to_owned(), vec![grid.nx(), grid.ny()].into());
        keys.insert("mean_pressure".to_owned(), mean_pressure.into());
        keys.insert("rms_slope".to_owned(), rms_slope.into());
        keys.insert("tolerance".to_owned(), tolerance.into());
        serde_json::from_value(keys.into()).expect("a summary")
    }

    /// A result at rest on a cell of 1 m, with E* = 1 Pa.
    fn folder(summary: Summary, pressure: Field, gap: Field) -> ResultFolder {
        let [side, e_star] = [1.0; 2];
        ResultFolder { summary, side, e_star, direction: None, pressure, gap, plastic_gap: None, slip: None }
    }

    /// In full contact the stress is normal about its mean, with the variance 2Λ.
    ///
    /// This holds for any mean.
    #[test]
    fn the_fit_of_full_contact_finds_the_variance_of_the_pressure() {
        let grid = Grid::new(512, 4).expect("a grid");
        // The values are quantiles of the normal distribution at equal steps of probability. Along x they increase and
        // then decrease.
        let spread = 1e-3;
        let quantile = |part: f64| {
            // Bisection finds the quantile, since only erf is available.
            let (mut low, mut high) = (-5.0_f64, 5.0);
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if 0.5 * (1.0 + libm::erf(middle / 2_f64.sqrt())) < part { low = middle } else { high = middle }
            }
            0.5 * (low + high)
        };
        for mean_pressure in [1e-2, 1e-1, 5.0] {
            let pressure = Field::from_fn(grid, |at| mean_pressure + spread * quantile(1.0 - (2.0 * at.x - 1.0).abs()));
            let gap = Field::zeros(grid);
            // With this slope the variance of full contact is spread².
            let summary = summary(grid, mean_pressure, 2.0 * spread, None);
            let result = folder(summary, pressure, gap);
            let stress = stress(&result).expect("contact");
            let note = &stress.notes[1];
            let (_, part) = note.split_once("E*², ").expect("the part of the theory");
            let part: f64 = part.split(' ').next().expect("a number").parse().expect("a number");
            // The ends beyond 2.9 widths are missing, which raises the rest by 0.4 %. A bin is 7 % of a width.
            assert!((part - 1.0).abs() < 0.02, "mean {mean_pressure}: {note}");
            assert!(stress.values[0] > 0.5 * mean_pressure, "bins from {}", stress.values[0]);
        }
    }

    #[test]
    fn a_gap_in_contact_is_none_on_the_map() {
        let grid = Grid::square(2).expect("a grid");
        let pressure = Field::new(grid, vec![1.0, 0.0, 0.0, 2.0]).expect("a field");
        let gap = Field::new(grid, vec![1e-14, 1e-15, 1.0, 1e-2]).expect("a field");
        let result = |n| {
            let summary = summary(Grid::square(n).expect("a grid"), 1.0, 0.1, None);
            let (pressure, gap) = (pressure.clone(), gap.clone());
            folder(summary, pressure, gap)
        };
        let numbers = |result: &ResultFolder| serde_json::to_value(&maps(result).gap).expect("JSON")["data"].clone();
        let encoded = |numbers: [u16; 4]| {
            use base64::Engine as _;
            let bytes: Vec<u8> = numbers.into_iter().flat_map(u16::to_le_bytes).collect();
            serde_json::Value::from(base64::engine::general_purpose::STANDARD.encode(bytes))
        };
        assert_eq!(numbers(&result(2)), encoded([0, 0, u16::MAX, 0]));
        assert_eq!(numbers(&result(4)), encoded([0, 0, u16::MAX, 655]), "a mean over elements has pressure and gap");
    }
}
