//! Changes of the input with a known effect on the result, or without effect.

use anyhow::Result;
use rc_core::{DVec2, Field, Grid, HeightField};
use rc_figures::Preset;
use rc_fractal::{SpectrumParams, Surface};
use rc_solver::Control;

use super::heights::{mapped, rough};
use super::row::{Row, Rows, guarded};
use super::solved::{Method, Solved, solve};

/// Tolerance of the solutions that are compared with each other.
///
/// The allowed differences of pressures and of numbers follow. Pressures vary with the slope of the gap, so they differ
/// much more than gaps.
const TIGHT: f64 = 1e-10;
const SAME_PRESSURE: f64 = 1e-6;
const SAME_NUMBER: f64 = 1e-8;

const LOAD: Control = Control::MeanPressure(1e-3);

/// Checks one group of invariances.
type Check = fn(&mut Rows, Preset) -> Result<()>;

#[expect(clippy::unnecessary_wraps, reason = "as the other groups")]
pub(crate) fn rows(preset: Preset) -> Result<Vec<Row>> {
    let mut rows = Rows::of("invariances");
    let checks: [(&str, Check); 8] = [
        ("scaling", scaling),
        ("motions", motions),
        ("copies", copies),
        ("fractions of an element", fractions),
        ("surfaces", surfaces),
        ("round trips", round_trips),
        ("slopes", slopes),
        ("monotony", monotony),
    ];
    for (name, check) in checks {
        if let Err(error) = guarded(|| check(&mut rows, preset)) {
            rows.holds(name, "can be compared", "solutions", format!("{error:#}"), false);
        }
    }
    Ok(rows.finish())
}

fn tight(method: Method) -> f64 {
    if method == Method::Adaptive { 1e-8 } else { TIGHT }
}

fn side(method: Method) -> usize {
    if method == Method::Adaptive { 128 } else { 64 }
}

/// Heights and load times a power of two give the same digits.
///
/// Times another factor they give the same result up to rounding.
fn scaling(rows: &mut Rows, _: Preset) -> Result<()> {
    for method in [Method::Uniform, Method::Spectral, Method::Adaptive] {
        let heights = rough(8, 0.8, 11, side(method))?;
        let plain = solve(&heights, method, LOAD, 1e-6)?;
        for exponent in [-400, -40, 40, 400] {
            let factor = 2.0_f64.powi(exponent);
            let scaled = solve(&mapped(&heights, |h| h * factor), method, Control::MeanPressure(1e-3 * factor), 1e-6)?;
            let pairs = scaled.pressure.values().iter().zip(plain.pressure.values());
            let n_different = pairs.filter(|(a, b)| a.to_bits() != (*b * factor).to_bits()).count();
            let scene = format!("{} heights and load times 2^{exponent}", method.name());
            rows.at_most(&scene, "pressures with other digits", n_different as f64, 0.0);
            let stiffness = scaled.stiffness / plain.stiffness - 1.0;
            rows.at_most(&scene, "stiffness", stiffness.abs(), 1e-12);
        }
        let plain = solve(&heights, method, LOAD, tight(method))?;
        for factor in [1e-7, 0.3, 1e5] {
            let control = Control::MeanPressure(1e-3 * factor);
            let scaled = solve(&mapped(&heights, |h| h * factor), method, control, tight(method))?;
            let back = mapped(&scaled.pressure, |p| p / factor);
            let scene = format!("{} heights and load times {factor}", method.name());
            rows.at_most(&scene, "pressure", plain.distance(&back), SAME_PRESSURE);
        }
    }
    Ok(())
}

/// A motion of the n × n grid onto itself.
///
/// It has a name, and a function from an element (x, y) to the element that moves there.
type Motion = (&'static str, fn(usize, usize, usize) -> (usize, usize));

const MOTIONS: [Motion; 8] = [
    ("moved by one element along x", |x, y, n| ((x + 1) % n, y)),
    ("moved by one element along y", |x, y, n| (x, (y + 1) % n)),
    ("moved by 17 and 5 elements", |x, y, n| ((x + 17) % n, (y + 5) % n)),
    ("moved by half the cell", |x, y, n| ((x + n / 2) % n, (y + n / 2) % n)),
    ("transposed", |x, y, _| (y, x)),
    ("reflected in x", |x, y, n| (n - 1 - x, y)),
    ("reflected in y", |x, y, n| (x, n - 1 - y)),
    ("turned by a quarter", |x, y, n| (n - 1 - y, x)),
];

fn moved(field: &Field, motion: Motion) -> Result<Field> {
    let n = field.grid().nx();
    let value = |i: usize| {
        let (x, y) = motion.1(i % n, i / n, n);
        field.at(x, y)
    };
    Ok(Field::new(field.grid(), (0..n * n).map(value).collect())?)
}

/// A rectangular cell has the same pressure as the square of its copies.
fn copies(rows: &mut Rows, _: Preset) -> Result<()> {
    for method in [Method::Uniform, Method::Spectral] {
        for (nx, ny, n) in [(64, 32, 2), (40, 24, 3), (128, 16, 8)] {
            let wave = |t: f64| (std::f64::consts::TAU * t).cos();
            let bumps = |x: f64, y: f64| 1e-2 * (wave(x + y + 0.1) + wave(2.0 * x - y) + 0.4 * wave(3.0 * x + 0.3));
            // y is relative to the rectangle's side.
            let times = n as f64;
            let part = Field::from_fn(Grid::in_cell(nx, ny, 1.0 / times)?, |DVec2 { x, y }| bumps(x, times * y));
            let whole = Field::from_fn(Grid::new(nx, n * ny)?, |DVec2 { x, y }| bumps(x, times * y));
            let [part, whole] = [solve(&part, method, LOAD, TIGHT)?, solve(&whole, method, LOAD, TIGHT)?];
            let copied = Field::new(whole.pressure.grid(), part.pressure.values().repeat(n))?;
            let scene = format!("{} {n} copies of {nx} x {ny} elements", method.name());
            rows.at_most(&scene, "pressure", whole.distance(&copied), SAME_PRESSURE);
            let penetration = (part.info.penetration / whole.info.penetration - 1.0).abs();
            rows.at_most(&scene, "penetration", penetration, SAME_NUMBER);
        }
    }
    Ok(())
}

/// Motions of the heights move the pressure, and constants added to the heights change nothing.
fn motions(rows: &mut Rows, _: Preset) -> Result<()> {
    for method in [Method::Uniform, Method::Spectral, Method::Adaptive] {
        let heights = rough(8, 0.8, 12, side(method))?;
        let plain = solve(&heights, method, LOAD, tight(method))?;
        let mut compare = |scene: String, other: &Solved, wanted: &Field| {
            rows.at_most(&scene, "pressure", other.distance(wanted), SAME_PRESSURE.max(100.0 * tight(method)));
            let penetration = (other.info.penetration / plain.info.penetration - 1.0).abs();
            rows.at_most(&scene, "penetration", penetration, SAME_NUMBER.max(10.0 * tight(method)));
        };
        for motion in MOTIONS {
            let other = solve(&moved(&heights, motion)?, method, LOAD, tight(method))?;
            compare(format!("{} {}", method.name(), motion.0), &other, &moved(&plain.pressure, motion)?);
        }
        for constant in [1.0, -1.0, 1024.0] {
            let other = solve(&mapped(&heights, |h| h + constant), method, LOAD, tight(method))?;
            compare(format!("{} heights plus {constant}", method.name()), &other, &plain.pressure);
        }
    }
    Ok(())
}

/// A surface that moves by a part of an element keeps its contact.
///
/// The differences are discretisation errors.
fn fractions(rows: &mut Rows, _: Preset) -> Result<()> {
    struct Moved<'a>(&'a Surface, DVec2);
    impl HeightField for Moved<'_> {
        fn height(&self, at: DVec2) -> f64 {
            self.0.height(at + self.1)
        }
        fn band_limit(&self) -> Option<usize> {
            self.0.band_limit()
        }
    }
    let surface = Surface::new(&SpectrumParams::paper(4, 13))?;
    let n = 128;
    let grid = Grid::square(n)?;
    let plain = solve(&surface.sample_on(grid)?, Method::Uniform, LOAD, 1e-8)?;
    for (dx, dy) in [(0.5, 0.0), (0.25, 0.75), (1e-6, 0.3)] {
        let scene = format!("moved by {dx} and {dy} elements");
        let heights = Moved(&surface, DVec2::new(dx, dy) / n as f64).sample(grid);
        let other = solve(&heights, Method::Uniform, LOAD, 1e-8)?;
        let ratio = |of: fn(&Solved) -> f64| (of(&other) / of(&plain) - 1.0).abs();
        // These are discretisation errors at 32 elements for the shortest wave.
        rows.at_most(&scene, "area", ratio(|solved| solved.observables.area.fraction), 1e-2);
        rows.at_most(&scene, "rms pressure", ratio(|solved| solved.observables.rms_pressure), 2e-3);
        rows.at_most(&scene, "penetration", ratio(|solved| solved.info.penetration), 2e-3);
    }
    Ok(())
}

/// A seed gives the same surface on every grid, and another seed gives another surface.
fn surfaces(rows: &mut Rows, _: Preset) -> Result<()> {
    for waves in [1, 8, 16] {
        let (coarse, fine) = (rough(waves, 0.8, 14, 40)?, rough(waves, 0.8, 14, 120)?);
        let differences = (0..40 * 40).map(|i| {
            let (x, y) = (i % 40, i / 40);
            // Centres of the coarse grid are also centres of the grid that is three times as fine.
            (coarse.at(x, y) - fine.at(3 * x + 1, 3 * y + 1)).abs()
        });
        let worst = differences.fold(0.0, f64::max) / coarse.rms();
        rows.at_most(&format!("N = {waves}"), "heights on two grids", worst, 1e-12);
        let again = rough(waves, 0.8, 14, 40)?;
        rows.holds(&format!("N = {waves}"), "the same seed", "equal", verdict(again == coarse), again == coarse);
        let other = rough(waves, 0.8, 15, 40)?;
        rows.holds(&format!("N = {waves}"), "another seed", "different", verdict(other == coarse), other != coarse);
    }
    Ok(())
}

pub(super) fn verdict(equal: bool) -> &'static str {
    if equal { "equal" } else { "different" }
}

/// Solves a load and then its penetration, and a penetration and then its load.
fn round_trips(rows: &mut Rows, _: Preset) -> Result<()> {
    for method in [Method::Uniform, Method::Spectral, Method::Adaptive] {
        let heights = rough(8, 0.8, 16, side(method))?;
        let tolerance = tight(method);
        let solve = |control| solve(&heights, method, control, tolerance);
        for load in [1e-6, 1e-4, 1e-3, 1e-2] {
            let there = solve(Control::MeanPressure(load))?;
            let back = solve(Control::Penetration(there.info.penetration))?;
            let scene = format!("{} load {load:.0e} E*", method.name());
            // Near first touch the load changes faster than the penetration from which it is found.
            let bound = 1e3 * tolerance * (heights.max() - heights.min()) / there.info.penetration.min(1e-3);
            rows.at_most(
                &scene,
                "load to penetration and back",
                (back.info.mean_pressure / load - 1.0).abs(),
                bound.max(1e-7),
            );
        }
        let deepest = heights.max() - heights.mean();
        for part in [0.05, 0.3, 0.7] {
            let there = solve(Control::Penetration(part * deepest))?;
            let back = solve(Control::MeanPressure(there.info.mean_pressure))?;
            let scene = format!("{} {part} of full contact", method.name());
            let error = (back.info.penetration / (part * deepest) - 1.0).abs();
            rows.at_most(&scene, "penetration to load and back", error, 1e2 * tolerance);
        }
    }
    Ok(())
}

/// The stiffness is the derivative of the load with respect to the penetration.
fn slopes(rows: &mut Rows, _: Preset) -> Result<()> {
    for method in [Method::Uniform, Method::Spectral, Method::Adaptive] {
        let heights = rough(8, 0.8, 16, side(method))?;
        for load in [1e-4, 1e-3, 1e-2] {
            let at = |factor: f64| solve(&heights, method, Control::MeanPressure(factor * load), tight(method));
            let (less, here, more) = (at(0.999)?, at(1.0)?, at(1.001)?);
            let rise = more.info.penetration - less.info.penetration;
            let slope = (more.info.mean_pressure - less.info.mean_pressure) / rise;
            let scene = format!("{} load {load:.0e} E*", method.name());
            // The contact changes by whole elements between the two loads.
            rows.at_most(&scene, "stiffness against slope", (here.stiffness / slope - 1.0).abs(), 6e-3);
        }
    }
    Ok(())
}

/// Load and contact grow with the penetration.
///
/// Elements in contact need not stay in contact, so only their number is compared.
fn monotony(rows: &mut Rows, preset: Preset) -> Result<()> {
    let steps = if preset == Preset::Full { 40 } else { 12 };
    for method in [Method::Uniform, Method::Adaptive] {
        let heights = rough(8, 0.5, 17, side(method))?;
        let deepest = heights.max() - heights.mean();
        let mut last: Option<Solved> = None;
        let (mut load_falls, mut area_falls, mut gap_grows) = (0, 0, 0);
        for step in 1..steps {
            let penetration = deepest * f64::from(step) / f64::from(steps);
            let solved = solve(&heights, method, Control::Penetration(penetration), tight(method))?;
            if let Some(last) = &last {
                load_falls += usize::from(solved.info.mean_pressure <= last.info.mean_pressure);
                area_falls += usize::from(solved.observables.area.cells < last.observables.area.cells);
                gap_grows += usize::from(solved.observables.mean_gap >= last.observables.mean_gap);
            }
            last = Some(solved);
        }
        let scene = format!("{} {steps} penetrations", method.name());
        rows.at_most(&scene, "steps with less load", load_falls as f64, 0.0);
        rows.at_most(&scene, "steps with less area", area_falls as f64, 0.0);
        rows.at_most(&scene, "steps with more gap", gap_grows as f64, 0.0);
    }
    Ok(())
}
