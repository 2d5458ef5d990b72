//! Pictures of a height map: heights, spectrum with its power law, distribution.

use std::path::Path;

use plotters::prelude::DrawingBackend;
use plotters::style::RGBColor;
use rc_core::Field;

use super::record::SurfaceRecord;
use rc_core::quantity::{Scale, digits};
use rc_plot::{
    Area, LinePlot, LineStyle, Map, MapPicture, Picture, PictureError, Series, Shade, draw_lines, save_png, save_svg,
};
use rc_sweep::files::{FileError, Staged};

const BLUE: RGBColor = RGBColor(38, 92, 158);
const RED: RGBColor = RGBColor(190, 60, 50);

/// Size of the text, in pixels.
const TEXT: f64 = 26.0;

/// Writes pictures of `heights` (in λ) and of the statistics in `record`.
///
/// They are `surface.png`, and `spectrum`, `distribution` and `material_ratio` as PNG and SVG. A map with missing points has no spectrum.
/// The result has the names of the pictures.
///
/// # Errors
/// [`FileError::Write`].
pub(crate) fn write(folder: &Path, heights: &Field, record: &SurfaceRecord) -> Result<Vec<String>, FileError> {
    let mut staged = Staged::new(folder)?;
    add(&mut staged, heights, record)?;
    let names = staged.names().to_vec();
    staged.commit()?;
    Ok(names)
}

/// Adds the pictures to `staged`.
fn add(staged: &mut Staged, heights: &Field, record: &SurfaceRecord) -> Result<(), FileError> {
    let shade = Shade::of_heights(heights, record.cell);
    let title = if record.missing > 0 { "Height (red: missing)" } else { "Height" };
    let map = MapPicture(Map { title, field: heights, shade, side: record.cell });
    staged.add("surface.png", |path| save_png(&map, path))?;
    let (spectrum, distribution) = (Spectrum(record), Distribution(record));
    if !record.spectrum.is_empty() {
        staged.add("spectrum.png", |path| save_png(&spectrum, path))?;
        staged.add("spectrum.svg", |path| save_svg(&spectrum, path))?;
    }
    staged.add("distribution.png", |path| save_png(&distribution, path))?;
    staged.add("distribution.svg", |path| save_svg(&distribution, path))?;
    let curve = MaterialCurve(record);
    staged.add("material_ratio.png", |path| save_png(&curve, path))?;
    staged.add("material_ratio.svg", |path| save_svg(&curve, path))
}

/// The spectrum C(q) with decimal logarithms on both axes.
struct Spectrum<'a>(&'a SurfaceRecord);

impl Picture for Spectrum<'_> {
    fn size(&self) -> (u32, u32) {
        (1400, 1000)
    }

    fn draw<B: DrawingBackend>(&self, area: &Area<B>) -> Result<(), PictureError> {
        let highest = self.0.spectrum.iter().fold(0.0_f64, |most, row| most.max(row.psd));
        // Beyond the shortest wave of a generated surface there is only rounding.
        let rows = self.0.spectrum.iter().filter(|row| row.psd > 1e-20 * highest);
        let points: Vec<(f64, f64)> = rows.map(|row| (row.wavenumber.log10(), row.psd.log10())).collect();
        let mut series =
            vec![Series { name: "radial mean", points: points.clone(), colour: BLUE, style: LineStyle::Solid }];
        let law = self.0.hurst_fit.map(|fit| {
            let ends = [fit.from_waves, fit.to_waves].map(|waves| std::f64::consts::TAU * waves / self.0.cell);
            let points = ends.map(|wavenumber| (wavenumber.log10(), fit.psd(wavenumber).log10())).to_vec();
            (format!("H = {}", digits(fit.hurst, 3)), points)
        });
        if let Some((name, points)) = &law {
            series.push(Series { name, points: points.clone(), colour: RED, style: LineStyle::Dashed });
        }
        let title = if self.0.windowed { "Power spectral density (Hann window)" } else { "Power spectral density" };
        let plot = LinePlot {
            title,
            x_label: "log10 of q (rad/m)",
            y_label: "log10 of C (m⁴)",
            x: range(points.iter().map(|point| point.0)),
            y: range(points.iter().map(|point| point.1)),
            series,
        };
        draw_lines(area, &plot, TEXT)
    }
}

/// The probability density of heights.
struct Distribution<'a>(&'a SurfaceRecord);

impl Picture for Distribution<'_> {
    fn size(&self) -> (u32, u32) {
        (1400, 1000)
    }

    fn draw<B: DrawingBackend>(&self, area: &Area<B>) -> Result<(), PictureError> {
        let scale = Scale::of(self.0.rms_height, "m");
        let bins = self.0.distribution.bins();
        let points: Vec<(f64, f64)> = bins.map(|(h, density)| (h / scale.factor, density * scale.factor)).collect();
        let plot = LinePlot {
            title: "Distribution of heights",
            x_label: &format!("height about the mean ({})", scale.unit()),
            y_label: &format!("density (1/{})", scale.unit()),
            x: range(points.iter().map(|point| point.0)),
            y: (0.0, 1.05 * points.iter().fold(0.0_f64, |most, point| most.max(point.1))),
            series: vec![Series { name: "", points, colour: BLUE, style: LineStyle::Solid }],
        };
        draw_lines(area, &plot, TEXT)
    }
}

/// The material ratio curve with the equivalent line of its core.
struct MaterialCurve<'a>(&'a SurfaceRecord);

impl Picture for MaterialCurve<'_> {
    fn size(&self) -> (u32, u32) {
        (1400, 1000)
    }

    fn draw<B: DrawingBackend>(&self, area: &Area<B>) -> Result<(), PictureError> {
        let (scale, areal) = (Scale::of(self.0.rms_height, "m"), &self.0.areal);
        let points: Vec<(f64, f64)> = areal.curve.iter().map(|(r, h)| (100.0 * r, h / scale.factor)).collect();
        let line = areal.equivalent_line().map(|(ratio, height)| (100.0 * ratio, height / scale.factor)).to_vec();
        let heights = points.iter().chain(&line).map(|point| point.1);
        let plot = LinePlot {
            title: "Material ratio (Abbott curve)",
            x_label: "material ratio (%)",
            y_label: &format!("height about the mean ({})", scale.unit()),
            x: (0.0, 100.0),
            y: range(heights),
            series: vec![
                Series { name: "", points, colour: BLUE, style: LineStyle::Solid },
                Series { name: "core", points: line, colour: RED, style: LineStyle::Dashed },
            ],
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
