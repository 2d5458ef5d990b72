//! Pictures of a profile: heights and spectrum.

use plotters::prelude::DrawingBackend;
use plotters::style::RGBColor;
use rc_core::quantity::Scale;
use rc_plot::{Area, LinePlot, LineStyle, Picture, PictureError, Series, draw_lines, save_png, save_svg};
use rc_sweep::files::{FileError, Staged};

use super::profile_row::ProfileRow;

const BLUE: RGBColor = RGBColor(38, 92, 158);

/// Size of the text, in pixels.
const TEXT: f64 = 26.0;

/// Parts of a long profile of which a picture shows the lowest and the highest point.
const MOST: usize = 2000;

/// Adds `profile` and `spectrum` as PNG and SVG, of heights (m) at this spacing (m).
///
/// # Errors
/// [`FileError::Write`].
pub(super) fn add(
    staged: &mut Staged,
    (heights, spacing): (&[f64], f64),
    spectrum: &[ProfileRow],
) -> Result<(), FileError> {
    let profile = Lines { title: "Profile", points: outline(heights, spacing), of: Of::Heights };
    let rows = spectrum.iter().filter(|row| row.psd_profile > 0.0);
    let points = rows.map(|row| (row.wavenumber.log10(), row.psd_profile.log10())).collect();
    let spectrum = Lines { title: "Power spectral density of the profile (Hann window)", points, of: Of::Spectrum };
    let pictures = [("profile", profile), ("spectrum", spectrum)];
    for (name, lines) in pictures.into_iter().filter(|(_, lines)| !lines.points.is_empty()) {
        staged.add(&format!("{name}.png"), |path| save_png(&lines, path))?;
        staged.add(&format!("{name}.svg"), |path| save_svg(&lines, path))?;
    }
    Ok(())
}

/// The points of a profile, or the lowest and the highest of each of its parts.
fn outline(values: &[f64], spacing: f64) -> Vec<(f64, f64)> {
    let part = values.len().div_ceil(MOST);
    let place = |i: usize| (i as f64 + 0.5) * spacing;
    let mut points = Vec::new();
    for first in (0..values.len()).step_by(part) {
        let here = first..(first + part).min(values.len());
        let measured = || here.clone().filter(|&i| values[i].is_finite());
        let ends = [
            measured().min_by(|&a, &b| values[a].total_cmp(&values[b])),
            measured().max_by(|&a, &b| values[a].total_cmp(&values[b])),
        ];
        let [Some(a), Some(b)] = ends else { continue };
        points.extend([a.min(b), a.max(b)].map(|i| (place(i), values[i])));
    }
    points.dedup();
    points
}

/// What a picture shows.
#[derive(Clone, Copy)]
enum Of {
    Heights,
    Spectrum,
}

struct Lines {
    title: &'static str,
    points: Vec<(f64, f64)>,
    of: Of,
}

impl Picture for Lines {
    fn size(&self) -> (u32, u32) {
        (1400, 800)
    }

    fn draw<B: DrawingBackend>(&self, area: &Area<B>) -> Result<(), PictureError> {
        let largest = |of: fn(&(f64, f64)) -> f64| self.points.iter().map(of).fold(0.0, |a: f64, b| a.max(b.abs()));
        let [x, y] = match self.of {
            Of::Heights => [Scale::of(largest(|point| point.0), "m"), Scale::of(largest(|point| point.1), "m")]
                .map(|scale| (scale.factor, scale.unit())),
            Of::Spectrum => [(1.0, String::new()), (1.0, String::new())],
        };
        let points: Vec<(f64, f64)> = self.points.iter().map(|point| (point.0 / x.0, point.1 / y.0)).collect();
        let (x_label, y_label) = match self.of {
            Of::Heights => (format!("x ({})", x.1), format!("height ({})", y.1)),
            Of::Spectrum => ("log10 of q (rad/m)".to_owned(), "log10 of C1 (m³)".to_owned()),
        };
        let plot = LinePlot {
            title: self.title,
            x_label: &x_label,
            y_label: &y_label,
            x: range(points.iter().map(|point| point.0)),
            y: range(points.iter().map(|point| point.1)),
            series: vec![Series { name: "", points, colour: BLUE, style: LineStyle::Solid }],
        };
        draw_lines(area, &plot, TEXT)
    }
}

/// The range of values, with a margin.
fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
    let margin = 0.03 * (high - low);
    if margin > 0.0 { (low - margin, high + margin) } else { (low - 0.5, high + 0.5) }
}
