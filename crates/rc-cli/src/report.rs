//! Results for people: a few aligned lines, small tables and bars.

use std::path::Path;

use rc_core::quantity::{digits, engineering};
use rc_heights::AreaParameters;

use crate::statistics::{HeightStatistics, Histogram, PressureStatistics, SpectrumRow, TreatmentRow};
use rc_sweep::Summary;

/// A few aligned lines about a solved problem; `side` is λ in m, `e_star` E* in Pa.
#[must_use]
pub fn solved(summary: &Summary, sides: [f64; 2], e_star: f64) -> String {
    headline(summary) + &aligned(&solved_lines(summary, sides, e_star))
}

/// The stiffness of the contact.
pub(crate) fn stiffness(s: &Summary) -> String {
    s.contact_stiffness.map_or_else(|| "infinite".into(), |value| engineering(value, "Pa/m"))
}

/// The lines of [`solved`]: names and values.
pub(crate) fn solved_lines(summary: &Summary, sides: [f64; 2], e_star: f64) -> Vec<(&'static str, String)> {
    let s = summary;
    let percent = |fraction: f64| digits(100.0 * fraction, 4);
    let mut lines = vec![
        ("method", s.method_reason.as_ref().unwrap_or(&s.method).clone()),
        (
            "cell",
            format!("{} with {} x {} elements, E* = {}", cell(sides), s.grid[0], s.grid[1], engineering(e_star, "Pa")),
        ),
        (
            "surface",
            format!(
                "rms height {}, rms slope {}, highest point {}",
                engineering(s.rms_height, "m"),
                digits(s.rms_slope, 4),
                engineering(s.h_max, "m")
            ),
        ),
        (
            "contact area",
            format!(
                "({}) % of the nominal area, {} % by counting",
                with_error(100.0 * s.area_fraction, 100.0 * s.area_fraction_error),
                percent(s.area_fraction_cells)
            ),
        ),
        (
            "mean pressure",
            format!("{} ({} E*)", engineering(s.mean_pressure, "Pa"), digits(s.mean_pressure / e_star, 4)),
        ),
        ("rms, max pressure", format!("{}, {}", engineering(s.rms_pressure, "Pa"), engineering(s.max_pressure, "Pa"))),
        (
            "penetration",
            format!(
                "{} of {} at full contact",
                engineering(s.penetration, "m"),
                engineering(s.penetration_full_contact, "m")
            ),
        ),
        ("mean gap", engineering(s.mean_gap, "m")),
        ("stiffness", stiffness(s)),
        ("elastic energy", engineering(s.elastic_energy, "J")),
        (
            "certificate",
            format!(
                "complementarity {:.1e}, penetration {:.1e}, load {:.1e}",
                s.complementarity_error, s.penetration_error, s.load_error
            ),
        ),
    ];
    if let (Some(evaluated), Some(proven)) = (s.cells_evaluated, s.cells_proven) {
        lines.push(("cells", format!("{evaluated} evaluated, {proven} proven out of contact")));
    }
    lines
}

fn levels(n: usize) -> &'static str {
    if n == 1 { "level" } else { "levels" }
}

/// `7.183 ± 0.008`: both with the last digit that the error leaves certain.
pub(crate) fn with_error(value: f64, error: f64) -> String {
    if error > 0.0 && error.is_finite() {
        let decimals = (-error.log10().floor()).clamp(0.0, 12.0) as usize;
        format!("{value:.decimals$} ± {error:.decimals$}")
    } else {
        digits(value, 6)
    }
}

/// Lines of a name and a value, aligned.
pub(crate) fn aligned(lines: &[(&str, String)]) -> String {
    lines.iter().fold(String::new(), |text, (name, value)| text + &format!("  {name:<19}{value}\n"))
}

/// Where results went, if anywhere.
#[must_use]
pub fn written(target: Option<&Path>) -> String {
    target.map_or_else(String::new, |target| format!("\nwritten to {}\n", target.display()))
}

fn headline(s: &Summary) -> String {
    let memory = s.peak_memory_bytes.map_or_else(String::new, |bytes| format!(", {} MB", bytes / 1_000_000));
    let how = match s.status.as_str() {
        "full_contact" if s.iterations == 0 => "full contact, solved exactly".to_owned(),
        "full_contact" => format!("full contact, {}", converged(s)),
        "not_converged" => format!("NOT CONVERGED after {} fine iterations", s.iterations),
        _ => converged(s),
    };
    format!("{how}: {} s, {} threads{memory}\n", digits(s.wall_seconds, 3), s.threads)
}

fn converged(s: &Summary) -> String {
    format!("converged in {} fine iterations, {} nested {}", s.iterations, s.levels, levels(s.levels))
}

/// The size of a cell: one side of a square, both of a rectangle (m).
#[must_use]
pub fn cell([x, y]: [f64; 2]) -> String {
    let side = engineering(x, "m");
    if (x - y).abs() <= 1e-12 * x { side } else { format!("{side} by {}", engineering(y, "m")) }
}

/// Statistics of a height map, with a short table of its spectrum and its distribution.
#[must_use]
pub fn heights(statistics: &HeightStatistics) -> String {
    let s = statistics;
    let lines = [
        ("cell", format!("{} with {} x {} elements", cell([s.cell, s.cell_y]), s.grid[0], s.grid[1])),
        (
            "heights",
            format!(
                "from {} to {}, mean {}",
                engineering(s.h_min, "m"),
                engineering(s.h_max, "m"),
                engineering(s.mean, "m")
            ),
        ),
        ("rms height", engineering(s.rms_height, "m")),
        ("rms slope", digits(s.rms_slope, 4)),
        ("rms curvature", format!("{} 1/m", digits(s.rms_curvature, 4))),
        ("Nayak parameter", digits(s.nayak, 4)),
        ("skewness, kurtosis", format!("{}, {}", digits(s.skewness, 3), digits(s.kurtosis, 4))),
    ];
    let heading = "\n  height about mean   density\n";
    treatments(&s.treatments)
        + &aligned(&lines)
        + &area_parameters(&s.parameters)
        + &spectrum_lines(s)
        + &spectrum_table(&s.spectrum)
        + heading
        + &bars(&s.distribution, "m")
}

/// A line for each state of a map that was treated.
fn treatments(rows: &[TreatmentRow]) -> String {
    if rows.is_empty() {
        return String::new();
    }
    let heading = "  treatment           points         missing   rms height   rms slope   border step\n".to_owned();
    let text = rows.iter().fold(heading, |text, row| {
        let points = format!("{} x {}", row.grid[0], row.grid[1]);
        let (height, slope) = (engineering(row.rms_height, "m"), digits(row.rms_slope, 3));
        let step = row.border_step.map_or_else(|| "-".to_owned(), |ratio| digits(ratio, 3));
        text + &format!("  {:<20}{points:<15}{:<10}{height:<13}{slope:<12}{step}\n", row.treatment, row.missing)
    });
    text + "\n"
}

/// Parameters of ISO 25178-2.
fn area_parameters(p: &AreaParameters) -> String {
    let length = |value| engineering(value, "m");
    let lines = [
        ("Sa, Sq", format!("{}, {}", length(p.sa), length(p.sq))),
        ("Ssk, Sku", format!("{}, {}", digits(p.ssk, 3), digits(p.sku, 4))),
        ("Sp, Sv, Sz", format!("{}, {}, {}", length(p.sp), length(p.sv), length(p.sz))),
        ("Sdq, Sdr", format!("{}, {} %", digits(p.sdq, 4), digits(100.0 * p.sdr, 4))),
    ];
    "\n  ISO 25178-2, from differences of neighbours, no filter\n".to_owned() + &aligned(&lines)
}

/// Whether the map is periodic, and the power law in its spectrum.
fn spectrum_lines(s: &HeightStatistics) -> String {
    let state = if s.windowed {
        "not periodic (rc surface --periodic), so the spectrum is under a Hann window"
    } else {
        "periodic"
    };
    let border = format!("{} times the step between neighbours: {state}", digits(s.border_step, 3));
    let law = match &s.hurst_fit {
        None => "no part of the spectrum is a power law over a factor 4".to_owned(),
        Some(fit) => format!(
            "H = {} from {} to {} waves per cell ({} to {}), C0 = {} m^{}, {} off in ln C",
            digits(fit.hurst, 3),
            digits(fit.from_waves, 3),
            digits(fit.to_waves, 3),
            engineering(s.cell / fit.from_waves, "m"),
            engineering(s.cell / fit.to_waves, "m"),
            digits(fit.c0, 3),
            digits(2.0 - 2.0 * fit.hurst, 3),
            digits(fit.deviation, 2)
        ),
    };
    "\n".to_owned() + &aligned(&[("border step", border), ("Hurst exponent", law)])
}

/// Statistics of a pressure field, with its distribution.
#[must_use]
pub fn pressure(statistics: &PressureStatistics) -> String {
    let s = statistics;
    let lines = [
        ("grid", format!("{} x {} elements", s.grid[0], s.grid[1])),
        ("contact area", format!("{} % of the elements", digits(100.0 * s.area_fraction_cells, 4))),
        ("mean pressure", engineering(s.mean_pressure, "Pa")),
        ("mean in contact", engineering(s.mean_contact_pressure, "Pa")),
        ("rms, max pressure", format!("{}, {}", engineering(s.rms_pressure, "Pa"), engineering(s.max_pressure, "Pa"))),
    ];
    aligned(&lines) + "\n  pressure in contact density\n" + &bars(&s.distribution, "Pa")
}

/// About a dozen rows of the spectrum, evenly spaced in the logarithm of the wavenumber.
fn spectrum_table(spectrum: &[SpectrumRow]) -> String {
    let mut text = "\n  waves per cell      C(q) (m^4)     modes\n".to_owned();
    // Beyond the shortest wave of a surface there is only rounding.
    let noise = spectrum.iter().fold(0.0_f64, |highest, row| highest.max(row.psd)) * 1e-20;
    let mut next = 0.0;
    for row in spectrum.iter().filter(|row| row.psd > noise) {
        if row.waves >= next {
            let line = format!("  {:<20}{:<15.4e}{}\n", digits(row.waves, 4), row.psd, row.modes);
            text.push_str(&line);
            next = (row.waves * 1.5).max(row.waves + 1.0) - 0.5;
        }
    }
    text
}

/// The density as bars, two bins a line.
fn bars(histogram: &Histogram, unit: &'static str) -> String {
    let bins: Vec<(f64, f64)> = histogram.bins().collect();
    let lines: Vec<(f64, f64)> = bins.chunks(2).map(mean_of).collect();
    let highest = lines.iter().fold(0.0_f64, |highest, line| highest.max(line.1));
    lines.iter().fold(String::new(), |text, (middle, density)| {
        let length = if highest > 0.0 { (40.0 * density / highest).round() as usize } else { 0 };
        text + format!("  {:<20}{}", engineering(*middle, unit), "#".repeat(length)).trim_end() + "\n"
    })
}

fn mean_of(pairs: &[(f64, f64)]) -> (f64, f64) {
    let n = pairs.len() as f64;
    (pairs.iter().map(|pair| pair.0).sum::<f64>() / n, pairs.iter().map(|pair| pair.1).sum::<f64>() / n)
}
