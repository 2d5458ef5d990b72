//! Changes of the input with a known effect on the result.

use anyhow::Result;
use rc_core::Field;
use rc_figures::Preset;
use rc_solver::Control;

use super::heights::{mapped, rough};
use super::row::{Row, Rows};
use super::solved::{Method, solve, solve_hard};

/// Tolerance of plastic contacts that are compared, and the allowed differences of their pressures and of numbers.
///
/// Pressures vary with the slope of the gap, so they differ much more than gaps.
const TIGHT: f64 = 1e-9;
const SAME_PRESSURE: f64 = 1e-5;
const SAME_NUMBER: f64 = 1e-7;

const LOAD: f64 = 1e-3;

pub(crate) fn rows(_: Preset) -> Result<Vec<Row>> {
    let mut rows = Rows::of("invariances");
    for method in [Method::Uniform, Method::Spectral, Method::Adaptive] {
        scaling(&mut rows, method)?;
        motions(&mut rows, method)?;
    }
    for method in [Method::Uniform, Method::Spectral] {
        turned_inside_out(&mut rows, method)?;
    }
    Ok(rows.finish())
}

/// Heights and load times a power of two give the same digits.
fn scaling(rows: &mut Rows, method: Method) -> Result<()> {
    let heights = rough(8, 0.8, 11, 128)?;
    let plain = solve(&heights, method, Control::MeanPressure(LOAD), 1e-6)?;
    for exponent in [-400, -40, 40, 400] {
        let factor = 2.0_f64.powi(exponent);
        let scaled = solve(&mapped(&heights, |h| h * factor), method, Control::MeanPressure(LOAD * factor), 1e-6)?;
        let pairs = scaled.pressure.values().iter().zip(plain.pressure.values());
        let n_different = pairs.filter(|(a, b)| a.to_bits() != (*b * factor).to_bits()).count();
        let scene = format!("{} heights and load times 2^{exponent}", method.name());
        rows.at_most(&scene, "pressures with other digits", n_different as f64, 0.0);
        rows.at_most(&scene, "stiffness", (scaled.stiffness / plain.stiffness - 1.0).abs(), 1e-12);
    }
    Ok(())
}

/// A motion of the n × n grid onto itself.
///
/// It has a name, and a function from an element (x, y) to the element that moves there.
type Motion = (&'static str, fn(usize, usize, usize) -> (usize, usize));

const MOTIONS: [Motion; 6] = [
    ("moved by one element along x", |x, y, n| ((x + 1) % n, y)),
    ("moved by 17 and 5 elements", |x, y, n| ((x + 17) % n, (y + 5) % n)),
    ("transposed", |x, y, _| (y, x)),
    ("reflected in x", |x, y, n| (n - 1 - x, y)),
    ("reflected in y", |x, y, n| (x, n - 1 - y)),
    ("turned by a quarter", |x, y, n| (n - 1 - y, x)),
];

fn moved(field: &Field, (_, from): Motion) -> Result<Field> {
    let n = field.grid().nx();
    let value = |i: usize| {
        let (x, y) = from(i % n, i / n, n);
        field.at(x, y)
    };
    Ok(Field::new(field.grid(), (0..n * n).map(value).collect())?)
}

/// Motions of the heights move the pressure.
fn motions(rows: &mut Rows, method: Method) -> Result<()> {
    let tight = if method == Method::Adaptive { 1e-8 } else { 1e-10 };
    let heights = rough(8, 0.8, 12, 128)?;
    let plain = solve(&heights, method, Control::MeanPressure(LOAD), tight)?;
    for motion in MOTIONS {
        let other = solve(&moved(&heights, motion)?, method, Control::MeanPressure(LOAD), tight)?;
        let scene = format!("{} {}", method.name(), motion.0);
        rows.at_most(&scene, "pressure", other.distance(&moved(&plain.pressure, motion)?), 1e-6);
        let penetration = (other.info.penetration / plain.info.penetration - 1.0).abs();
        rows.at_most(&scene, "penetration", penetration, f64::max(1e-8, 10.0 * tight));
    }
    Ok(())
}

/// A contact with a hardness H and the contact of the surface upside down have pressures p and H - p.
///
/// A uniform pressure displaces nothing. So the pressure H - p, with the rest of the load, solves the problem of the
/// surface upside down, and gaps change their sign.
fn turned_inside_out(rows: &mut Rows, method: Method) -> Result<()> {
    let heights = rough(8, 0.8, 52, 64)?;
    let upside_down = mapped(&heights, |h| -h);
    for (hardness, part) in [(1e-2, 0.1), (4e-3, 0.4), (4e-2, 0.5)] {
        let scene = format!("{} hardness {hardness:.0e} load {part} of it inside out", method.name());
        let load = |part: f64| (Control::MeanPressure(part * hardness), hardness);
        let plain = solve_hard(&heights, method, load(part), TIGHT)?;
        let turned = solve_hard(&upside_down, method, load(1.0 - part), TIGHT)?;
        let back = mapped(&turned.pressure, |q| hardness - q);
        rows.at_most(&scene, "pressure", plain.distance(&back), SAME_PRESSURE);
        // Both are h_max - Δ, the gap of elements in contact.
        let approach = (heights.max() - plain.info.penetration) + (upside_down.max() - turned.info.penetration);
        rows.at_most(&scene, "gap of contact", approach.abs() / heights.rms(), SAME_NUMBER);
        let energy = (plain.info.elastic_energy / turned.info.elastic_energy - 1.0).abs();
        rows.at_most(&scene, "elastic energy", energy, SAME_PRESSURE);
        rows.at_most(&scene, "stiffness", (plain.stiffness / turned.stiffness - 1.0).abs(), 5e-3);
    }
    Ok(())
}
