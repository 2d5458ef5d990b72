//! Doubts about a surface: units, slopes, and values of a map that are no heights.

use std::path::Path;

use rc_core::quantity::{count, digits, engineering};
use rc_core::{Field, Grid, PeriodicCell};
use rc_fractal::{Texture, height_and_slope_of_grid, height_and_slope_of_patch};
use rc_heights::suspicion::{Counter, Suspicions};
use rc_heights::{BorderStep, Effect, HeightMap, Level, Periodic, Treatment, hann};
use rc_sweep::WarningCode::{
    Assumed, Border, Columns, Counter as CounterCode, Marks, Mirror, Missing, Slope, Spikes, Tilt, Units,
};
use rc_sweep::{Warning, WarningCode};

use crate::files::beside;
use crate::scene::origin;

/// rms slope above which a surface is hardly a rough one.
///
/// Ground, milled, blasted and fractured surfaces have at most 0.5 at the resolution of instruments. A wrong unit of
/// heights is wrong by a factor of 1000 or more.
const STEEPEST: f64 = 1.0;

/// Range of heights relative to the shorter side above which a map is hardly a roughness.
const DEEPEST: f64 = 1.0 / 3.0;

/// Range of heights (m) below which a map is no surface: an atom has 1e-10.
const SHALLOWEST: f64 = 1e-10;

/// rms slope below which a map is no surface. That of the best mirrors is about 1e-6.
const FLATTEST: f64 = 1e-7;

/// rms slope above which the theory is inaccurate.
///
/// The theory of the half-space neglects the squares of slopes, here about a tenth.
const SMALL_SLOPE: f64 = 0.3;

/// Part of filled points above which their heights matter.
///
/// Contact areas are known to a percent or so. Filled points follow their neighbours, so that only a part of them is
/// wrong.
const FEW_FILLED: f64 = 0.02;

/// Part of the mean square height above which a tilt is not that of long waves of the surface.
const TILTED: f64 = 0.5;

/// Range of heights of a sum of many waves, in rms heights.
const RANGE_OF_WAVES: f64 = 6.0;

/// What is known of a surface besides its values.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shape {
    /// rms slope.
    pub(crate) rms_slope: f64,
    /// Range of heights (m).
    pub(crate) range: f64,
    /// Sides of the cell (m).
    pub(crate) sides: [f64; 2],
}

impl Shape {
    /// The shape of a sum of waves with this rms height (m).
    pub(crate) fn of_waves(rms_height: f64, rms_slope: f64, sides: [f64; 2]) -> Self {
        Self { rms_slope, range: RANGE_OF_WAVES * rms_height, sides }
    }

    /// The shape of heights (m) in a cell, which continue across its borders if they are periodic.
    pub(crate) fn of_heights(heights: &Field, cell: PeriodicCell) -> Self {
        // Slopes are per λ.
        let is_periodic = BorderStep::of(heights).is_periodic();
        let of = if is_periodic { height_and_slope_of_grid } else { height_and_slope_of_patch };
        let [_, slope] = of(heights);
        Self { rms_slope: slope / cell.side(), range: heights.max() - heights.min(), sides: cell.sides() }
    }

    /// Doubts about units and slopes.
    pub(crate) fn warnings(self) -> Vec<Warning> {
        let (slope, shorter) = (digits(self.rms_slope, 3), self.sides[0].min(self.sides[1]));
        let mut found = Vec::new();
        let is_rough = self.rms_slope > STEEPEST || self.range > DEEPEST * shorter;
        let is_smooth = self.range < SHALLOWEST || self.rms_slope < FLATTEST;
        if is_rough || is_smooth {
            let what = if is_rough { "hardly a rough surface" } else { "smoother than any surface" };
            let text = format!(
                "heights over a range of {} on a side of {}, with an rms slope of {slope}, are {what}; check the units of heights \
                 (--unit, --height-unit, --height-scale) and the size (--cell)",
                engineering(self.range, "m"),
                engineering(shorter, "m")
            );
            found.push(Warning::new(Units, text));
        }
        found.extend(steep(self.rms_slope));
        found
    }
}

/// The doubt about a slope that the theory takes for small.
pub(crate) fn steep(rms_slope: f64) -> Option<Warning> {
    let text = || {
        format!(
            "an rms slope of {} is too steep for the theory, which neglects squares of slopes; expect errors of \
             some 10 %, or remove short waves (rc surface --low-pass)",
            digits(rms_slope, 3)
        )
    };
    (rms_slope > SMALL_SLOPE).then(|| Warning::new(Slope, text()))
}

/// Doubts about the values of a map in metres, which may have missing points.
pub(crate) fn of_map(map: &HeightMap) -> Vec<Warning> {
    let Suspicions { spikes, marks, counter, thin } = Suspicions::of(&map.heights);
    let mut found = Vec::new();
    if let Some(marks) = marks {
        let text = format!(
            "{} of {} m, far from all others, {} like a mark of missing points; if so, give --missing with the number in the \
             file",
            count(marks.count, "height"),
            digits(marks.value, 8),
            if marks.count == 1 { "looks" } else { "look" }
        );
        found.push(Warning::new(Marks, text));
    }
    if let Some(counter) = counter {
        let (what, part) = match counter {
            Counter::Row => ("row", "a heading"),
            Counter::Column => ("column", "line numbers"),
        };
        let text =
            format!("the first {what} is evenly spaced, like coordinates or {part}; if so, remove it from the file");
        found.push(Warning::new(CounterCode, text));
    }
    if thin {
        let (grid, text) = (map.heights.grid(), "may be a table of something else, as of profiles or points");
        found.push(Warning::new(Columns, format!("a map of {} x {} points {text}", grid.nx(), grid.ny())));
    }
    if let Some(spikes) = spikes {
        let text = format!(
            "{} {} far from all neighbours, by up to {}; if measured wrongly, they carry a light load alone, so remove them \
             before (rc surface FILE --despike --out DIR)",
            count(spikes.count, "point"),
            if spikes.count == 1 { "stands" } else { "stand" },
            engineering(spikes.largest, "m")
        );
        found.push(Warning::new(Spikes, text));
    }
    found
}

/// Doubts about the values of the map in metres that was read from `path`.
///
/// Points of a coarser map stand far from their neighbours more easily. Spikes of a map that `rc` has despiked and then
/// resampled are those of its record, from before the resampling.
pub(crate) fn of_file(path: &Path, map: &HeightMap) -> Vec<Warning> {
    let found = of_map(map);
    let treatments = origin::of(path, None).treatments;
    let at = |name: &str| treatments.iter().rposition(|treatment| treatment.starts_with(name));
    if at("despike").zip(at("resample")).is_none_or(|(despike, resample)| despike > resample) {
        return found;
    }
    let others = found.into_iter().filter(|warning| warning.code != Spikes);
    others.chain(recorded(path, |code| code == Spikes)).collect()
}

/// A doubt about a map that is tilted, of which a twin is made.
pub(crate) fn tilted(map: &HeightMap) -> Option<Warning> {
    let before = Effect::of(map, "").rms_height;
    let (_, effects) = rc_heights::apply(map.clone(), &[Treatment::Level(Level::Plane)]).ok()?;
    let part = 1.0 - (effects.last()?.rms_height / before).powi(2);
    let text = || {
        format!(
            "{} % of the mean square height of the map are a tilt, which its twin has as heights and as long waves; \
             level the map first (rc prepare)",
            digits(100.0 * part, 2)
        )
    };
    (part > TILTED).then(|| Warning::new(Tilt, text()))
}

/// One doubt about everything that was assumed; none if nothing was.
#[must_use]
pub fn assumed(assumptions: &[String]) -> Option<Warning> {
    let text = || format!("assumed: {}", assumptions.join("; "));
    (!assumptions.is_empty()).then(|| Warning::new(Assumed, text()))
}

/// A doubt about filled points, when `missing` of `all` points were filled.
pub(crate) fn filled(missing: usize, all: usize) -> Option<Warning> {
    let part = missing as f64 / all as f64;
    let text = || {
        format!(
            "{} % of the points ({missing} of {all}) were missing and filled, so that their heights are invented",
            digits(100.0 * part, 3)
        )
    };
    (part > FEW_FILLED).then(|| Warning::new(Missing, text()))
}

/// The doubts about treatments in the record of a folder of `rc surface` or `rc solve`, when `path` is the map in it.
///
/// The map itself does not show which points were filled, or that it was mirrored.
pub(crate) fn of_record(path: &Path) -> Vec<Warning> {
    recorded(path, |code| matches!(code, Missing | Mirror))
}

/// The warnings with these codes in the record beside the map at `path`.
fn recorded(path: &Path, is_meant: fn(WarningCode) -> bool) -> Vec<Warning> {
    #[derive(serde::Deserialize)]
    struct Record {
        warnings: Vec<Warning>,
    }
    let first = beside::records(path).next();
    first.map_or_else(Vec::new, |Record { warnings }| {
        warnings.into_iter().filter(|warning| is_meant(warning.code)).collect()
    })
}

/// A doubt about a measured map with a lay, which is a quarter of `map` after its `treatments`.
///
/// With the lay, its mirror images make roofs and valleys across the borders, along which a flow may run or end.
pub(crate) fn mirrored(map: &HeightMap, treatments: &[Treatment]) -> Option<Warning> {
    let at = treatments.iter().position(|treatment| *treatment == Treatment::Periodic(Periodic::Mirror))?;
    if treatments[at..].iter().any(|treatment| matches!(treatment, Treatment::Repeat(_))) {
        return None;
    }
    let (heights, all) = (&map.heights, map.heights.grid());
    let ratio = map.sides.map_or(all.cell_ratio(), |[x, y]| y / x);
    let measured = Grid::in_cell(all.nx() / 2, all.ny() / 2, ratio).ok()?;
    let values = (0..measured.ny()).flat_map(|iy| heights.row(iy)[..measured.nx()].iter().copied()).collect();
    let measured = Field::new(measured, values).ok()?;
    let texture = Texture::of(&measured, &hann(&measured));
    let aspect = texture.aspect.filter(|_| texture.has_lay())?;
    let text = format!(
        "the map has a lay (Str {} {}), which its mirror images turn or double at the borders, so that flows and conductances \
         across them are not those of the surface; a patch with --boundary free has no mirror images",
        if aspect.is_bound { "below" } else { "=" },
        digits(aspect.ratio, 2)
    );
    Some(Warning::new(Mirror, text))
}

/// A doubt about a map that is solved as if it repeated itself.
pub(crate) fn border(grid: Grid, step: BorderStep) -> Option<Warning> {
    let is_profile = grid.ny() == 1;
    let text = || {
        format!(
            "the heights do not repeat themselves: the step across the border is {} times that between neighbours; {}",
            digits(step.ratio(), 3),
            if is_profile {
                "make the profile periodic (rc surface --line --periodic mirror)"
            } else {
                "solve the map with --boundary free, or make it periodic (rc surface --periodic mirror)"
            }
        )
    };
    (!step.is_periodic()).then(|| Warning::new(Border, text()))
}
