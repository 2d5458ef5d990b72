//! `cargo xtask kernel-error`: errors and times of the truncated sums of Eq. 5 and 6.

use std::hint::black_box;
use std::time::{Duration, Instant};

use anyhow::Result;
use plotters::prelude::{BLACK, DrawingBackend, RGBColor};
use rc_core::DVec2;
use rc_kernel::{LoadForm, PeriodicLove, truncated_coefficient, truncation_error_bound};
use rc_plot::{Area, LinePlot, LineStyle, Picture, PictureError, Series, draw_lines};

use rc_figures::{Figure, Preset, Rule, Table, number};

const FORMS: [(LoadForm, &str, RGBColor); 2] =
    [(LoadForm::Plain, "plain", RGBColor(30, 90, 160)), (LoadForm::Printed, "printed", RGBColor(200, 60, 30))];
/// The lines of the drawing: name, form, offset and colour.
const LINES: [(&str, &str, &str, RGBColor); 6] = [
    ("plain, near", "plain", "near", RGBColor(30, 90, 160)),
    ("plain, mid", "plain", "mid", RGBColor(90, 150, 210)),
    ("plain, far", "plain", "far", RGBColor(160, 195, 230)),
    ("printed, near", "printed", "near", RGBColor(200, 60, 30)),
    ("printed, mid", "printed", "mid", RGBColor(230, 130, 60)),
    ("printed, far", "printed", "far", RGBColor(245, 195, 140)),
];
/// Half side of the source in the drawing, for elements of λ/64.
const DRAWN: f64 = 1.0 / 128.0;
/// Documented accuracy of the exact coefficients, relative to the area of the source.
const EXACT: f64 = 1e-12;
/// Size of the text, in pixels.
const TEXT: f64 = 24.0;
/// Duration of the timing of one coefficient.
const SAMPLE: Duration = Duration::from_millis(20);

/// Sizes of the source, and numbers of shells.
#[derive(Clone, Debug)]
pub struct Params {
    half_sides: Vec<f64>,
    shells: Vec<usize>,
}

/// One truncated coefficient. Errors are relative to the area (2d)² of the source.
#[derive(Clone, Copy, Debug)]
struct Case {
    form: &'static str,
    half_side: f64,
    offset: Offset,
    shells: usize,
    error: f64,
    bound: f64,
}

/// Position of the target relative to the source.
#[derive(Clone, Copy, Debug)]
struct Offset {
    name: &'static str,
    at: DVec2,
}

impl Offset {
    /// The offsets of a neighbour, a point midway, and the corner of the cell.
    fn all(half_side: f64) -> [Self; 3] {
        [
            Self { name: "near", at: DVec2::new(2.0 * half_side, 0.0) },
            Self { name: "mid", at: DVec2::new(0.25, 0.1) },
            Self { name: "far", at: DVec2::splat(0.5) },
        ]
    }
}

/// Time of one coefficient; `shells` is `None` for the exact one.
#[derive(Clone, Copy, Debug)]
struct Timing {
    half_side: f64,
    offset: &'static str,
    shells: Option<usize>,
    nanoseconds: f64,
}

/// Truncation errors and times of the coefficients.
#[derive(Clone, Debug)]
pub struct KernelErrors {
    cases: Vec<Case>,
    timings: Vec<Timing>,
}

impl Figure for KernelErrors {
    const NAME: &'static str = "kernel-error";
    type Params = Params;

    fn params(preset: Preset) -> Result<Params> {
        let shells = match preset {
            Preset::Full => vec![1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128],
            Preset::Quick => vec![1, 2, 4, 8],
        };
        Ok(Params { half_sides: vec![0.125, DRAWN, 1.0 / 2048.0], shells })
    }

    fn compute(params: &Params) -> Result<Self> {
        let love = PeriodicLove::new();
        let mut cases = Vec::new();
        let mut timings = Vec::new();
        for &half_side in &params.half_sides {
            for offset in Offset::all(half_side) {
                for (form, name, _) in FORMS {
                    for &shells in &params.shells {
                        cases.push(case(love, half_side, offset, shells, (form, name))?);
                    }
                }
                timings.push(exact_time(love, half_side, offset));
            }
        }
        for &shells in &params.shells {
            timings.push(truncated_time(shells)?);
        }
        Ok(Self { cases, timings })
    }

    fn tables(&self) -> Vec<Table> {
        vec![self.errors(), self.times()]
    }
}

fn case(
    love: PeriodicLove,
    half_side: f64,
    offset: Offset,
    shells: usize,
    (form, name): (LoadForm, &'static str),
) -> Result<Case> {
    let area = 4.0 * half_side * half_side;
    let exact = love.try_coefficient(offset.at, half_side)?;
    let truncated = truncated_coefficient(offset.at, half_side, shells, form)?;
    let bound = truncation_error_bound(half_side, shells, form) / area;
    Ok(Case { form: name, half_side, offset, shells, error: (truncated - exact).abs() / area, bound })
}

fn exact_time(love: PeriodicLove, half_side: f64, offset: Offset) -> Timing {
    // The targets are a thousand points in a small square around the offset.
    let targets: Vec<DVec2> =
        (0..1000).map(|i| offset.at + 1e-5 * DVec2::new(f64::from(i % 32), f64::from(i / 32))).collect();
    let row = || targets.iter().map(|&at| love.coefficient(at, black_box(half_side))).sum::<f64>();
    Timing { half_side, offset: offset.name, shells: None, nanoseconds: nanoseconds(row) / targets.len() as f64 }
}

fn truncated_time(shells: usize) -> Result<Timing> {
    let [_, offset, _] = Offset::all(DRAWN);
    let of = |at: DVec2| truncated_coefficient(at, DRAWN, shells, LoadForm::Plain);
    of(offset.at)?;
    let nanoseconds = nanoseconds(|| of(black_box(offset.at)));
    Ok(Timing { half_side: DRAWN, offset: offset.name, shells: Some(shells), nanoseconds })
}

/// Nanoseconds of one call, the fastest of many.
fn nanoseconds<T>(call: impl Fn() -> T) -> f64 {
    let start = Instant::now();
    let mut fastest = Duration::MAX;
    while start.elapsed() < SAMPLE {
        let before = Instant::now();
        black_box(call());
        fastest = fastest.min(before.elapsed());
    }
    fastest.as_secs_f64() * 1e9
}

impl KernelErrors {
    fn errors(&self) -> Table {
        let header = ["form", "half_side", "offset", "dx", "dy", "shells", "error_over_area", "bound_over_area"];
        let rows = self.cases.iter().map(|case| {
            let Offset { name, at } = case.offset;
            let [half_side, dx, dy, error, bound] = [case.half_side, at.x, at.y, case.error, case.bound].map(number);
            vec![case.form.to_owned(), half_side, name.to_owned(), dx, dy, case.shells.to_string(), error, bound]
        });
        // Small errors are differences of large sums with rounding.
        Table::new("errors", &header, rows).rest(Rule::STRICT.plus(1e-9))
    }

    fn times(&self) -> Table {
        let header = ["shells", "half_side", "offset", "ns_per_coefficient"];
        let rows = self.timings.iter().map(|timing| {
            let shells = timing.shells.map_or("all (exact)".to_owned(), |shells| shells.to_string());
            vec![shells, number(timing.half_side), timing.offset.to_owned(), number(timing.nanoseconds)]
        });
        Table::new("times", &header, rows)
    }

    /// Shells, error and bound of one form at one offset, for the drawn size.
    fn line(&self, form: &str, offset: &str) -> Vec<(f64, f64, f64)> {
        let is_drawn = |case: &&Case| case.form == form && case.offset.name == offset && case.half_side == DRAWN;
        self.cases.iter().filter(is_drawn).map(|case| (case.shells as f64, case.error, case.bound)).collect()
    }

    /// Time and error of one form midway in the cell, for the drawn size.
    fn timed_line(&self, form: &str) -> Vec<(f64, f64)> {
        let times = self.timings.iter().filter(|timing| timing.shells.is_some()).map(|timing| timing.nanoseconds);
        times.zip(self.line(form, "mid")).map(|(time, (_, error, _))| (time, error)).collect()
    }
}

impl Picture for KernelErrors {
    fn size(&self) -> (u32, u32) {
        (1800, 800)
    }

    /// Draws error against shells on the left, and error against time on the right.
    ///
    /// The elements are λ/64, and both axes are logarithmic.
    fn draw<B: DrawingBackend>(&self, area: &Area<B>) -> Result<(), PictureError> {
        let (left, right) = area.split_horizontally(self.size().0 / 2);
        draw_lines(&left, &self.against_shells(), TEXT)?;
        draw_lines(&right, &self.against_time(), TEXT)
    }
}

impl KernelErrors {
    fn against_shells(&self) -> LinePlot<'static> {
        let bounds = FORMS.map(|(_, form, colour)| Series {
            name: if form == "plain" { "bound, plain" } else { "bound, printed" },
            points: decades(self.line(form, "near").into_iter().map(|(shells, _, bound)| (shells, bound))),
            colour,
            style: LineStyle::Dashed,
        });
        let errors = LINES.map(|(name, form, offset, colour)| {
            let points = decades(self.line(form, offset).into_iter().map(|(shells, error, _)| (shells, error)));
            Series { name, points, colour, style: LineStyle::Solid }
        });
        LinePlot {
            title: "truncation error, elements of λ/64",
            x_label: "log10 of K, the shells of images",
            y_label: "log10 of error / (2d)²",
            x: (0.0, 2.2),
            y: (-4.0, 2.0),
            series: bounds.into_iter().chain(errors).collect(),
        }
    }

    fn against_time(&self) -> LinePlot<'static> {
        let truncated = FORMS.map(|(_, form, colour)| {
            let points = decades(self.timed_line(form).into_iter());
            let name = if form == "plain" { "K shells, plain" } else { "K shells, printed" };
            Series { name, points, colour, style: LineStyle::Solid }
        });
        let exact = self.timings.iter().filter(|timing| timing.shells.is_none());
        let exact = Series {
            name: "all images: 1e-12 guaranteed",
            points: decades(exact.map(|timing| (timing.nanoseconds, EXACT))),
            colour: BLACK,
            style: LineStyle::Dots,
        };
        LinePlot {
            title: "error against time per coefficient, target at (0.25, 0.1)",
            x_label: "log10 of time (ns)",
            y_label: "log10 of error / (2d)²",
            x: (1.0, 8.0),
            y: (-14.0, 2.0),
            series: truncated.into_iter().chain([exact]).collect(),
        }
    }
}

/// Decimal logarithms of both coordinates.
fn decades(points: impl Iterator<Item = (f64, f64)>) -> Vec<(f64, f64)> {
    points.map(|(x, y)| (x.log10(), y.log10())).collect()
}

#[cfg(test)]
mod tests {
    use rc_figures::snapshot::assert_table;
    use rc_figures::write;
    use std::path::Path;

    use super::*;

    #[test]
    fn quick_kernel_errors_are_as_reviewed_and_can_be_drawn() {
        let params = KernelErrors::params(Preset::Quick).expect("constants");
        let figure = KernelErrors::compute(&params).expect("valid requests");
        for case in &figure.cases {
            assert!(case.error <= case.bound, "{case:?}");
        }
        // The table of times is not compared, since times differ from run to run.
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/snapshots");
        assert_table(&folder, "kernel-error-errors", &figure.errors(), &format!("{params:?}"));
        let folder = tempfile::tempdir().expect("a temporary folder");
        let files = write(&figure, folder.path()).expect("the figure is written");
        for file in files {
            let length = file.metadata().expect("a written file").len();
            assert!(length > 200, "{} has only {length} bytes", file.display());
        }
    }
}
