//! The picture of the benchmark: time against the stated error, in panels for area, rms pressure and mean gap.

use plotters::prelude::DrawingBackend;
use plotters::style::RGBColor;
use rc_plot::{Area, LinePlot, LineStyle, Picture, PictureError, Series, draw_lines};

use super::peers::PEERS;
use super::record::OURS;
use super::reference::Quantity;
use super::times::Results;

const TEXT: f64 = 24.0;

/// Median time over all scenes by the error that a program states.
pub(super) struct TimeAgainstError<'a>(pub(super) Results<'a>);

/// The colours of rc and of the peers, those of Okabe and Ito, which colour-blind readers can tell apart.
const COLOURS: [RGBColor; 4] =
    [RGBColor(0, 0, 0), RGBColor(213, 94, 0), RGBColor(0, 158, 115), RGBColor(204, 121, 167)];

/// Decimal logarithm of the largest error, and the number of errors to the decade and in all.
const LARGEST: f64 = -1.0;
const PER_DECADE: usize = 8;
const N_ERRORS: usize = 33;

impl TimeAgainstError<'_> {
    /// Decimal logarithms of stated errors and of times. Errors that half of the scenes do not reach have no point.
    fn points(&self, program: &str, quantity: Quantity) -> Vec<(f64, f64)> {
        let point = |i: usize| {
            let error = LARGEST - i as f64 / PER_DECADE as f64;
            let asked = (quantity, 10.0_f64.powf(error));
            let reached = if program == OURS { self.0.ours(asked) } else { self.0.peer(program, asked).0 };
            reached.seconds.is_finite().then(|| (error, reached.seconds.log10()))
        };
        (0..N_ERRORS).filter_map(point).collect()
    }

    fn panel(&self, quantity: Quantity) -> LinePlot<'static> {
        let programs = [(OURS, "rc")].into_iter().chain(PEERS.map(|kind| (kind.name, kind.title)));
        // The legend is in the first panel; all panels have the same colours.
        let series = programs.zip(COLOURS).map(|((program, title), colour)| {
            let name = if quantity == Quantity::Area { title } else { "" };
            Series { name, points: self.points(program, quantity), colour, style: LineStyle::Solid }
        });
        LinePlot {
            title: quantity.name(),
            x_label: "log10 of stated relative error",
            y_label: "log10 of time (s)",
            x: (LARGEST - (N_ERRORS / PER_DECADE) as f64, LARGEST),
            y: (-2.5, 1.5),
            series: series.filter(|series| !series.points.is_empty()).collect(),
        }
    }
}

impl Picture for TimeAgainstError<'_> {
    fn size(&self) -> (u32, u32) {
        (2100, 800)
    }

    fn draw<B: DrawingBackend>(&self, area: &Area<B>) -> Result<(), PictureError> {
        let panels = area.split_evenly((1, Quantity::ALL.len()));
        panels.iter().zip(Quantity::ALL).try_for_each(|(panel, of)| draw_lines(panel, &self.panel(of), TEXT))
    }
}

#[cfg(test)]
mod tests {
    use rc_plot::save_png;

    use super::*;
    use crate::bench::record::tests::rows;
    use crate::bench::reference::tests::references;

    #[test]
    fn the_picture_has_every_program_that_states_errors() {
        let (rows, references) = (rows(), references("paper", [0.07, 4e-3, 2.5]));
        let picture = TimeAgainstError(Results { rows: &rows, references: &references });
        let panel = picture.panel(Quantity::RmsPressure);
        // Our bar is a thousandth. The peer's pressures are the same on both meshes, so it states no error at all.
        let points: Vec<usize> = panel.series.iter().map(|series| series.points.len()).collect();
        assert_eq!(points, [2 * PER_DECADE + 1, N_ERRORS], "{panel:?}");
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("bench.png");
        save_png(&picture, &path).expect("drawn");
        assert!(path.metadata().expect("a file").len() > 4096);
    }
}
