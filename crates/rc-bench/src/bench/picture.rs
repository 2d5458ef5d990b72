//! The picture of the benchmark: error against time.
//!
//! It has panels for area, rms pressure and penetration.

use plotters::prelude::DrawingBackend;
use plotters::style::RGBColor;
use rc_plot::{Area, LinePlot, LineStyle, Picture, PictureError, Series, draw_lines};

use super::levels::{Results, families};
use super::readings::{Reading, answers};
use super::record::{Family, OURS};
use super::reference::Quantity;

const TEXT: f64 = 24.0;

/// Error against time in one scene.
pub(super) struct ErrorAgainstTime<'a> {
    pub(super) results: Results<'a>,
    pub(super) scene: &'a str,
}

/// A program in the picture: the family, its colour, and how the quantities are read.
///
/// The colours are those of Okabe and Ito, which colour-blind readers can tell apart. Solid lines are best estimates,
/// or what users compute from a peer's results. Dashed lines are counted areas.
struct DrawnFamily {
    name: &'static str,
    of: fn(&Family) -> bool,
    colour: RGBColor,
    reading: Reading,
}

const DRAWN: [DrawnFamily; 9] = [
    DrawnFamily {
        name: "rc, adaptive",
        of: |f| f.program == OURS && f.method == "adaptive" && f.border_level == 0 && f.tolerance == "auto",
        colour: RGBColor(0, 114, 178),
        reading: Reading::Reported,
    },
    DrawnFamily {
        name: "rc, border level 2",
        of: |f| f.program == OURS && f.border_level == 2,
        colour: RGBColor(0, 0, 0),
        reading: Reading::Reported,
    },
    DrawnFamily {
        name: "rc, uniform, spectral",
        of: |f| f.program == OURS && f.kernel == "spectral" && f.tolerance == "auto",
        colour: RGBColor(86, 180, 233),
        reading: Reading::Reported,
    },
    DrawnFamily {
        name: "ASPHER, counted",
        of: |f| f.program == "aspher" && f.tolerance == "auto",
        colour: RGBColor(213, 94, 0),
        reading: Reading::Reported,
    },
    DrawnFamily {
        name: "ASPHER, corrected, 0.1013",
        of: |f| f.program == "aspher" && f.tolerance == "auto",
        colour: RGBColor(213, 94, 0),
        reading: Reading::Calibrated,
    },
    DrawnFamily {
        name: "ASPHER, extrapolated",
        of: |f| f.program == "aspher" && f.tolerance == "auto",
        colour: RGBColor(230, 159, 0),
        reading: Reading::Extrapolated,
    },
    DrawnFamily {
        name: "Tamaas, counted",
        of: |f| f.program == "tamaas",
        colour: RGBColor(0, 158, 115),
        reading: Reading::Reported,
    },
    DrawnFamily {
        name: "Tamaas, corrected, 0.1013",
        of: |f| f.program == "tamaas",
        colour: RGBColor(0, 158, 115),
        reading: Reading::Calibrated,
    },
    DrawnFamily {
        name: "ContactMechanics, counted",
        of: |f| f.program == "contactmechanics",
        colour: RGBColor(204, 121, 167),
        reading: Reading::Reported,
    },
];

impl ErrorAgainstTime<'_> {
    /// Decimal logarithms of times and of absolute relative errors.
    fn points(&self, family: &DrawnFamily, quantity: Quantity) -> Vec<(f64, f64)> {
        let rows = self.results.of(self.scene, true).chain(self.results.of(self.scene, false));
        let of_family = families(rows).into_iter().filter(|(other, _)| (family.of)(other));
        let point = |seconds: f64, value: f64| {
            let error = self.results.references.error(self.scene, quantity, value)?.abs();
            // An error of zero, when the last digits agree, would have no logarithm.
            Some((seconds.log10(), error.max(1e-9).log10()))
        };
        let answers = of_family.flat_map(|(_, rows)| answers(&rows, quantity, family.reading));
        answers.filter_map(|answer| point(answer.seconds, answer.value)).collect()
    }

    fn panel(&self, quantity: Quantity, title: &'static str) -> LinePlot<'static> {
        let mut series = Vec::new();
        for family in &DRAWN {
            if !family.reading.applies_to(quantity) {
                continue;
            }
            let points = self.points(family, quantity);
            if points.is_empty() {
                continue;
            }
            let counted = family.name.ends_with("counted") && quantity == Quantity::Area;
            let style = if counted { LineStyle::Dashed } else { LineStyle::Solid };
            // The legend is in the panel of the area; all panels have the same colours.
            let name = if quantity == Quantity::Area { family.name } else { "" };
            series.push(Series { name: "", points: points.clone(), colour: family.colour, style: LineStyle::Dots });
            series.push(Series { name, points, colour: family.colour, style });
        }
        let (x, y) = (range(&series, |at| at.0, 0.1), range(&series, |at| at.1, 0.2));
        // The panel needs space for the legend above the lines.
        let top = if quantity == Quantity::Area { y.1 + 0.6 * (y.1 - y.0) } else { y.1 };
        LinePlot { title, x_label: "log10 of time (s)", y_label: "log10 of relative error", x, y: (y.0, top), series }
    }
}

/// The range of the points of all series, with a margin.
fn range(series: &[Series<'_>], of: impl Fn(&(f64, f64)) -> f64, margin: f64) -> (f64, f64) {
    let values: Vec<f64> = series.iter().flat_map(|series| series.points.iter().map(&of)).collect();
    let (low, high) = values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &v| (l.min(v), h.max(v)));
    if low <= high { (low - margin, high + margin) } else { (-1.0, 1.0) }
}

impl Picture for ErrorAgainstTime<'_> {
    fn size(&self) -> (u32, u32) {
        (2100, 800)
    }

    fn draw<B: DrawingBackend>(&self, area: &Area<B>) -> Result<(), PictureError> {
        let titles = ["error of the contact area", "error of the rms pressure", "error of the penetration"];
        let panels = area.split_evenly((1, 3));
        for ((panel, quantity), title) in panels.iter().zip(Quantity::COMPARED).zip(titles) {
            draw_lines(panel, &self.panel(quantity, title), TEXT)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use rc_plot::{save_png, save_svg};

    use super::*;
    use crate::bench::levels::tests::rows;
    use crate::bench::reference::tests::references;

    #[test]
    fn the_picture_has_every_program_that_ran() {
        let (rows, references) = (rows(), references("paper", [0.07, 4e-3, 1.0]));
        let picture = ErrorAgainstTime { results: Results { rows: &rows, references: &references }, scene: "paper" };
        let names: Vec<&str> = picture.panel(Quantity::Area, "area").series.iter().map(|series| series.name).collect();
        assert_eq!(names, ["", "rc, adaptive", "", "Tamaas, counted", "", "Tamaas, corrected, 0.1013"]);
        let folder = tempfile::tempdir().expect("a temporary folder");
        for name in ["bench.png", "bench.svg"] {
            let path = folder.path().join(name);
            if name.ends_with("png") { save_png(&picture, &path) } else { save_svg(&picture, &path) }.expect("drawn");
            assert!(path.metadata().expect("a file").len() > 4096, "{name}");
        }
    }
}
