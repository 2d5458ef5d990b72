//! `rc plot` of a sweep: its curves, and the contacts of its rows under one scale of colours.

use std::path::Path;

use plotters::prelude::DrawingBackend;
use plotters::style::RGBColor;
use rc_plot::{
    Area, CURVES, ContactPicture, LinePlot, LineStyle, LogAxes, Picture, PictureError, Series, draw_lines_on, save_png,
    save_svg,
};
use rc_sweep::files::Staged;

use super::axis::{Axis, ROUNDING};
use super::columns::{PRESSURE, QUANTITIES, Quantity};
use super::means::{AtLoad, Mean};
use super::table::{Row, SweepTable};
use super::theory::persson;
use crate::error::CliError;
use crate::files::result::ResultFolder;

/// Size of the text, in pixels.
const TEXT: f64 = 26.0;

/// Ratio of values from which their axis is logarithmic.
const DECADES: f64 = 100.0;

/// Writes the pictures of the sweep in `folder` to `target`, and returns their names.
///
/// # Errors
/// [`CliError`].
pub(crate) fn write(folder: &Path, target: &Path) -> Result<Vec<String>, CliError> {
    let table = SweepTable::read(folder)?;
    let mut staged = Staged::new(target)?;
    for picture in QUANTITIES.iter().filter_map(|quantity| CurvePicture::of(&table, *quantity)) {
        staged.add(&format!("{}.png", picture.name), |path| save_png(&picture, path))?;
        staged.add(&format!("{}.svg", picture.name), |path| save_svg(&picture, path))?;
    }
    let greatest = table.rows.iter().filter_map(|row| row.number("max_pressure")).fold(0.0, f64::max);
    for (row, place) in table.rows.iter().filter_map(|row| Some((row, row.place.as_ref()?))) {
        let Some(fields) = &place.fields else { continue };
        let picture = contact(fields, row, greatest)?;
        let number = fields.file_name().unwrap_or_default().to_string_lossy();
        staged.add(&format!("contact-{number}.png"), |path| save_png(&picture, path))?;
    }
    let names = staged.names().to_vec();
    staged.commit()?;
    Ok(names)
}

/// The contact of a row, whose fields are in `fields`, with colours up to the pressure `greatest` (Pa).
fn contact(fields: &Path, row: &Row, greatest: f64) -> Result<ContactPicture, CliError> {
    let result = ResultFolder::read_finite(fields)?;
    let greatest = greatest.max(row.number("max_pressure").unwrap_or_default());
    let caption = [row.surface(), load(row)].into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(", ");
    let picture = ContactPicture::of(&result.pressure, 1.0, result.side).up_to(greatest);
    let picture = picture.captioned(caption).sliding(result.direction);
    Ok(if result.is_of_elements() { picture } else { picture.of_blocks() })
}

/// The prescribed load in words.
fn load(row: &Row) -> String {
    format!("{} {}", row.control, row.load_in_words())
}

/// A point of a curve with the errors of both coordinates, in SI units.
type Point = [Mean; 2];

/// A quantity against the mean pressure, the speed or the time.
struct CurvePicture {
    name: &'static str,
    title: String,
    x: Axis,
    y: Axis,
    /// Name and points of each scene.
    scenes: Vec<(String, Vec<Point>)>,
    /// Lines of the theory, with the index of their scene.
    theory: Vec<(usize, Vec<[f64; 2]>)>,
}

impl CurvePicture {
    /// The picture of `quantity`; `None` if no row has it.
    fn of(table: &SweepTable, quantity: Quantity) -> Option<Self> {
        let against = table.against;
        let of_scene = |rows| curve(rows, [against, quantity]);
        let scenes: Vec<(String, Vec<Point>)> = table.scenes().into_iter().map(of_scene).collect();
        if scenes.iter().all(|(_, points)| points.is_empty()) {
            return None;
        }
        let is_log = table.is_geometric();
        let lines = if quantity.name == "area" { persson(table) } else { Vec::new() };
        let theory: Vec<_> = lines.into_iter().map(|line| (line.scene, line.points)).collect();
        // The gap falls with the logarithm of the load.
        let log_y = quantity.name != "gap" && (is_log && against == PRESSURE || spans_decades(&scenes));
        // Nothing is drawn at a zero of a logarithmic axis.
        let is_shown = |at: &&Point| !log_y || at[1].value > 0.0;
        let points = || scenes.iter().flat_map(|(_, points)| points).filter(is_shown);
        let ends = |i: usize, is_log: bool| {
            points().flat_map(move |at| {
                let (value, error) = (at[i].value, at[i].error());
                // A bar that reaches zero ends at the border of a logarithmic axis.
                let low = if is_log { (value - error).max(0.5 * value) } else { value - error };
                [low, value, value + error]
            })
        };
        let seeds = table.surfaces().len() / table.scenes().len().max(1);
        let of_seeds = if seeds > 1 { ", means over seeds" } else { "" };
        let title = quantity.words;
        Some(Self {
            name: if quantity.name == "of_bodies" { "conductance-of-bodies" } else { quantity.name },
            title: format!("{}{}{of_seeds}", title[..1].to_uppercase(), &title[1..]),
            x: Axis::of(against.words, against.unit, is_log.then_some(0.0), ends(0, is_log)),
            y: Axis::of(quantity.words, quantity.unit, log_y.then_some(ROUNDING), ends(1, log_y)),
            scenes,
            theory,
        })
    }

    /// Line, dots and error bars of scene `i`.
    fn series(&self, i: usize) -> Vec<Series<'_>> {
        let (name, points) = &self.scenes[i];
        let colour = colour(i);
        let style = if (i / CURVES.len()).is_multiple_of(2) { LineStyle::Solid } else { LineStyle::Dashed };
        let place = |at: &Point| Some((self.x.place(at[0].value)?, self.y.place(at[1].value)?));
        let line: Vec<(f64, f64)> = points.iter().filter_map(place).collect();
        let bar = |at: &Point| {
            let (x, y) = place(at)?;
            let ends = |axis: &Axis, mean: Mean| [-1.0, 1.0].map(|s| axis.clamped(mean.value + s * mean.error()));
            let ([left, right], [low, high]) = (ends(&self.x, at[0]), ends(&self.y, at[1]));
            Some([vec![(left, y), (right, y)], vec![(x, low), (x, high)]])
        };
        let bars = points.iter().filter_map(bar).flatten();
        let bars = bars.map(|points| Series { name: "", points, colour, style: LineStyle::Solid });
        let dots = Series { name: "", points: line.clone(), colour, style: LineStyle::Dots };
        [Series { name, points: line, colour, style }, dots].into_iter().chain(bars).collect()
    }
}

/// Whether values differ by a factor above [`DECADES`], so that a linear axis would show only the largest.
fn spans_decades(scenes: &[(String, Vec<Point>)]) -> bool {
    let values = scenes.iter().flat_map(|(_, points)| points).map(|at| at[1].value).filter(|value| *value > 0.0);
    let (low, high) = values.fold((f64::INFINITY, 0.0_f64), |(low, high), value| (low.min(value), high.max(value)));
    high > DECADES * low
}

/// The curve of a scene: means over the seeds at loads that all have, with their errors; if there is no such load, of
/// those that are there.
fn curve(rows: &[Row], [against, quantity]: [Quantity; 2]) -> (String, Vec<Point>) {
    let common = AtLoad::of_all_seeds(rows);
    let loads = if common.is_empty() { AtLoad::all(rows) } else { common };
    let points = loads.iter().filter_map(|at| Some([at.mean(against)?, at.mean(quantity)?]));
    (rows.first().map(|row| row.label.clone()).unwrap_or_default(), points.collect())
}

fn colour(i: usize) -> RGBColor {
    CURVES[i % CURVES.len()]
}

impl Picture for CurvePicture {
    fn size(&self) -> (u32, u32) {
        (1300, 850)
    }

    fn draw<B: DrawingBackend>(&self, area: &Area<B>) -> Result<(), PictureError> {
        let several = self.theory.len() > 1;
        let line = |(n, (scene, points)): (usize, &(usize, Vec<[f64; 2]>))| Series {
            name: if n == 0 { "Persson's theory" } else { "" },
            points: points.iter().filter_map(|[x, y]| Some((self.x.place(*x)?, self.y.place(*y)?))).collect(),
            colour: if several { colour(*scene) } else { INK_LINE },
            style: LineStyle::Dashed,
        };
        let theory = self.theory.iter().enumerate().map(line);
        let plot = LinePlot {
            title: &self.title,
            x_label: &self.x.label,
            y_label: &self.y.label,
            x: self.x.range,
            y: self.y.range,
            series: theory.chain((0..self.scenes.len()).flat_map(|i| self.series(i))).collect(),
        };
        draw_lines_on(area, &plot, LogAxes { x: self.x.is_log, y: self.y.is_log }, TEXT)
    }
}

/// The colour of a line of the theory that belongs to all scenes.
const INK_LINE: RGBColor = RGBColor(27, 35, 48);

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    /// The film closes above the second load. Zeros and their bars would take most of the axes.
    #[test]
    fn the_axes_of_a_flow_are_those_of_its_positive_values() {
        let row = |(load, flow): (f64, f64)| {
            let cells = json!({ "mean_pressure": load, "permeance_x": flow, "permeance_y": flow,
                "permeance_error_x": 1e-22, "permeance_error_y": 1e-22 });
            Row { load, seed: Some(1), cells: cells.as_object().expect("an object").clone(), ..Row::default() }
        };
        let rows = [(1e5, 1e-17), (2e5, 2e-20), (3e5, 0.0), (1e7, 0.0)].map(row).to_vec();
        let table = SweepTable { rows, settings: None, against: PRESSURE };
        let quantity = QUANTITIES.into_iter().find(|one| one.name == "permeance").expect("a quantity");
        let CurvePicture { x, y, .. } = CurvePicture::of(&table, quantity).expect("flows");
        assert!(y.is_log && y.range.0 > 5e-21 && y.range.1 < 2e-17, "{y:?}");
        assert!(x.place(1e5).is_some() && x.place(2e5).is_some() && x.place(1e7).is_none(), "{x:?}");
    }
}
