//! Statistics as text: aligned lines, small tables and bars.

use rc_core::Histogram;
use rc_core::quantity::{digits, engineering};
use rc_heights::ChannelInfo;
use rc_solver::PressureStatistics;

use super::record::{EndsRow, SpectrumRow, SurfaceRecord, TreatmentRow};
use crate::text::{aligned, cell};

/// Maximum number of channels that are listed.
const MOST: usize = 20;

/// The channels of a file, one per line.
pub(crate) fn channels(channels: &[ChannelInfo]) -> String {
    let read = channels.iter().position(|channel| channel.is_height);
    let lines = channels.iter().enumerate().filter(|(i, _)| *i < MOST || Some(*i) == read).map(|(i, channel)| {
        let kind = if channel.is_height { "heights" } else { "not heights" };
        let default = if Some(i) == read { ", read unless --channel says otherwise" } else { "" };
        format!("  {kind:<13}{}{default}\n", channel.shown_name())
    });
    "  channel      name\n".to_owned() + &lines.collect::<String>() + &more("  ", channels, "\n") + "\n"
}

/// The names of channels in one line.
pub(crate) fn names(channels: &[ChannelInfo]) -> String {
    let names: Vec<String> = channels.iter().take(MOST).map(ChannelInfo::shown_name).collect();
    names.join(", ") + &more(" ", channels, "")
}

/// A note about the number of channels that are not listed.
fn more(before: &str, channels: &[ChannelInfo], after: &str) -> String {
    match channels.len().saturating_sub(MOST) {
        0 => String::new(),
        left => format!("{before}and {left} more{after}"),
    }
}

/// Statistics of a height map, with a short table of its spectrum and its distribution.
#[must_use]
pub(crate) fn heights(s: &SurfaceRecord) -> String {
    let heading = "\n  height about mean   density\n";
    treatments(&s.treatments)
        + &aligned(&surface_lines(s))
        + &area_parameters(s)
        + &spectrum_lines(s)
        + &spectrum_table(&s.spectrum)
        + heading
        + &bars(&s.distribution, "m")
}

/// Names and values of the statistics of a surface.
pub(crate) fn surface_lines(s: &SurfaceRecord) -> Vec<(&'static str, String)> {
    let lines = [
        ("cell", cell_line(s)),
        ("missing", missing(s)),
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
        ("rms slope", slope(s)),
        ("rms curvature", s.rms_curvature.map_or_else(not_known, |curvature| format!("{} 1/m", digits(curvature, 4)))),
        ("Nayak parameter", s.nayak.map_or_else(not_known, |nayak| digits(nayak, 4))),
        ("skewness, kurtosis", format!("{}, {}", digits(s.skewness, 3), digits(s.kurtosis, 4))),
    ];
    lines.into_iter().filter(|(name, _)| *name != "missing" || s.missing > 0).collect()
}

/// Text of the rms slope. Of a map that is not periodic, the step across its border is no slope of the surface.
fn slope(s: &SurfaceRecord) -> String {
    let [inside, whole] = [s.shape().rms_slope, s.rms_slope].map(|slope| digits(slope, 4));
    if inside == whole {
        whole
    } else {
        format!("{inside} between neighbours, {whole} with the step across the border")
    }
}

/// Text of the cell with its elements. A profile has one row.
fn cell_line(s: &SurfaceRecord) -> String {
    match s.grid {
        [nx, 1] => format!("a profile of {} with {nx} elements", engineering(s.cell, "m")),
        [nx, ny] => format!("{} with {nx} x {ny} elements", cell([s.cell, s.cell_y])),
    }
}

/// Text of the number of missing points.
fn missing(s: &SurfaceRecord) -> String {
    let all = s.grid[0] * s.grid[1];
    let part = digits(100.0 * s.missing as f64 / all as f64, 3);
    format!("{} of {all} points ({part} %); all that follows is of the others", s.missing)
}

/// Text of what needs all points.
fn not_known() -> String {
    "needs all points: rc surface --fill".to_owned()
}

/// One line for each state of a treated map.
pub(crate) fn treatments(rows: &[TreatmentRow]) -> String {
    if rows.is_empty() {
        return String::new();
    }
    let name = "treatment";
    let width = rows.iter().map(|row| row.treatment.chars().count()).fold(name.len(), usize::max) + 2;
    let heading =
        format!("  {name:<width$}changed    points         missing   rms height   rms slope (Sdq)   border step\n");
    let text = rows.iter().fold(heading, |text, row| {
        let points = format!("{} x {}", row.grid[0], row.grid[1]);
        let (height, slope) = (engineering(row.rms_height, "m"), digits(row.rms_slope, 3));
        let step = row.border_step.map_or_else(|| "-".to_owned(), |ratio| digits(ratio, 3));
        text + &format!(
            "  {:<width$}{:<11}{points:<15}{:<10}{height:<13}{slope:<18}{step}\n",
            row.treatment,
            changed(row),
            row.missing
        )
    });
    text + "\n"
}

/// Text of the number of points that a treatment changed.
fn changed(row: &TreatmentRow) -> String {
    match row.changed {
        0 => "-".to_owned(),
        changed if changed == row.grid[0] * row.grid[1] && !row.treatment.starts_with("crop") => "all".to_owned(),
        changed => changed.to_string(),
    }
}

/// Lines of the parameters of ISO 25178-2.
fn area_parameters(s: &SurfaceRecord) -> String {
    "\n  ISO 25178-2, from differences of neighbours, no filter\n".to_owned() + &aligned(&parameter_lines(s))
}

/// Names and values of the parameters of ISO 25178-2.
pub(crate) fn parameter_lines(s: &SurfaceRecord) -> Vec<(&'static str, String)> {
    let (p, length) = (&s.parameters, |value| engineering(value, "m"));
    let mut lines = vec![
        ("Sa, Sq", format!("{}, {}", length(p.sa), length(p.sq))),
        ("Ssk, Sku", format!("{}, {}", digits(p.ssk, 3), digits(p.sku, 4))),
        ("Sp, Sv, Sz", format!("{}, {}, {}", length(p.sp), length(p.sv), length(p.sz))),
        ("Sdq, Sdr", format!("{}, {} %", digits(p.sdq, 4), digits(100.0 * p.sdr, 4))),
    ];
    lines.extend(s.areal.lines());
    lines
}

/// Lines about the periodicity of the map and the power law in its spectrum.
fn spectrum_lines(s: &SurfaceRecord) -> String {
    let Some(border_step) = s.border_step else { return aligned(&[("spectrum", not_known())]) };
    let state = if s.of_part {
        ": mirrored, so the spectrum is that of the measured part, whose mirror images change it"
    } else if s.windowed {
        ": not periodic (rc surface --periodic), so the spectrum is under a Hann window"
    } else if s.spectrum.is_empty() {
        ""
    } else {
        ": periodic"
    };
    let border = format!("{} times the step between neighbours{state}", digits(border_step, 3));
    let law = match &s.hurst_fit {
        None => "no part of the spectrum follows a power law over a factor of 4 in wave number".to_owned(),
        Some(fit) => format!(
            "H = {} ± {} from {} to {} waves per cell ({} to {}), C(q) = {} m^{} q^{}, rms deviation of ln C {}",
            digits(fit.hurst, 3),
            digits(s.ends.hurst_error.unwrap_or_default(), 1),
            digits(fit.from_waves, 3),
            digits(fit.to_waves, 3),
            engineering(s.cell / fit.from_waves, "m"),
            engineering(s.cell / fit.to_waves, "m"),
            digits(fit.c0, 3),
            digits(2.0 - 2.0 * fit.hurst, 3),
            digits(-2.0 * (1.0 + fit.hurst), 3),
            digits(fit.deviation, 2)
        ),
    };
    if s.spectrum.is_empty() {
        return aligned(&[("border step", border)]);
    }
    let mut lines = vec![("border step", border), ("Hurst exponent", law)];
    if s.hurst_fit.is_some() {
        lines.extend(end_lines(&s.ends));
    }
    "\n".to_owned() + &aligned(&lines)
}

/// Names and values of the ends of the power law.
fn end_lines(ends: &EndsRow) -> [(&'static str, String); 3] {
    let shown = |wavelength: Option<f64>| wavelength.map_or_else(|| "not seen".to_owned(), |at| engineering(at, "m"));
    let reason = ends.resolution_reason.map_or_else(String::new, |reason| format!(": {reason}"));
    [
        ("roll-off", shown(ends.roll_off_wavelength)),
        ("cut-off", shown(ends.cut_off_wavelength)),
        ("resolution", shown(ends.resolution_wavelength) + &reason),
    ]
}

/// Statistics of a pressure field, with its distribution.
///
/// `elements` are those of the solve along x and y. A coarser grid has means over blocks of them.
#[must_use]
pub(crate) fn pressure(statistics: &PressureStatistics, elements: [usize; 2]) -> String {
    let s = statistics;
    let [nx, ny] = s.grid;
    let percent = digits(100.0 * s.area_fraction_cells, 4);
    let of_elements = [
        ("grid", format!("{nx} x {ny} elements")),
        ("contact area", format!("{percent} % of the elements")),
        ("mean in contact", engineering(s.mean_contact_pressure, "Pa")),
    ];
    let of_blocks = [
        ("grid", format!("{nx} x {ny} means over blocks of {} x {} elements", elements[0] / nx, elements[1] / ny)),
        ("touched blocks", format!("{percent} %, those with an element in contact")),
        ("mean in touched", engineering(s.mean_contact_pressure, "Pa")),
    ];
    let (title, [grid, area, mean_in_contact]) =
        if s.grid == elements { ("contact pressure", of_elements) } else { ("block pressure  ", of_blocks) };
    let lines = [
        grid,
        area,
        ("mean pressure", engineering(s.mean_pressure, "Pa")),
        mean_in_contact,
        ("rms, max pressure", format!("{}, {}", engineering(s.rms_pressure, "Pa"), engineering(s.max_pressure, "Pa"))),
    ];
    aligned(&lines) + &format!("\n  {title}    density\n") + &bars(&s.distribution, "Pa")
}

/// About a dozen rows of the spectrum, at equal ratios of the wavenumber.
fn spectrum_table(spectrum: &[SpectrumRow]) -> String {
    if spectrum.is_empty() {
        return String::new();
    }
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

/// The density as bars, two bins per line.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_channels_are_shown_in_a_line_and_not_all_of_many() {
        let named = |name: &str| ChannelInfo { name: name.to_owned(), is_height: false };
        let mut list: Vec<ChannelInfo> = (0..24).map(|i| named(&format!("c{i}"))).collect();
        list[1] = named("\u{1b}[31m\nred");
        list.push(ChannelInfo { name: "h".to_owned(), is_height: true });
        let text = channels(&list);
        assert!(!text.contains('\u{1b}') && text.contains("and 5 more"), "{text}");
        assert!(text.contains("heights      h, read unless") && !text.contains("c21"), "{text}");
        assert!(names(&list).ends_with("c19 and 5 more"), "{}", names(&list));
    }
}
