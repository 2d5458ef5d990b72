//! Pressures between zero and a hardness: bounds, an audit, and the contact turned inside out.

use anyhow::Result;
use rc_core::Field;
use rc_figures::Preset;
use rc_solver::Control;

use super::audit::{displacement, gaps};
use super::heights::{mapped, rough, shapes};
use super::row::{Row, Rows, guarded};
use super::scene::TOLERANCE;
use super::solved::{Method, Solved, solve, solve_hard};

/// Allowed overlaps and gaps in an audit, as multiples of the tolerance.
///
/// The gaps of elements with large pressures are ten times less exact than overlaps (`scene.rs`).
const AUDIT: [f64; 2] = [1.1, 10.0];

/// Tolerance of solves that are compared, relative to the height range.
///
/// The allowed differences of their pressures and of their penetrations follow.
const TIGHT: f64 = 1e-9;
const SAME_PRESSURE: f64 = 1e-5;
const SAME_NUMBER: f64 = 1e-7;

/// Maximum number of iterations on the finest level.
///
/// It is three times the number on rough surfaces of 512² elements.
const MOST_ITERATIONS: f64 = 60.0;

/// A surface, its load or penetration, and its hardness.
struct Scene<'a> {
    name: String,
    heights: &'a Field,
    control: Control,
    hardness: f64,
}

pub(crate) fn rows(preset: Preset) -> Result<Vec<Row>> {
    let mut rows = Rows::of("hardness");
    let full = preset == Preset::Full;
    let hardnesses: &[f64] = if full { &[1e-3, 4e-3, 1e-2, 2e-2] } else { &[1e-3, 1e-2] };
    let parts: &[f64] = if full { &[0.01, 0.1, 0.5, 0.9, 0.999] } else { &[0.05, 0.5, 0.99] };
    for method in [Method::Uniform, Method::Spectral, Method::Adaptive] {
        let heights = rough(8, 0.8, 51, 128)?;
        for &hardness in hardnesses {
            for part in parts {
                let control = Control::MeanPressure(part * hardness);
                let name = format!("{} hardness {hardness:.0e} load {part} of it", method.name());
                check(&mut rows, method, &Scene { name, heights: &heights, control, hardness });
            }
        }
    }
    for shape in shapes(64)? {
        let load = 0.3 * shape.heights.rms();
        let (heights, control) = (&shape.heights, Control::MeanPressure(load));
        let scene = Scene { name: format!("uniform {}", shape.name), heights, control, hardness: 2.0 * load };
        check(&mut rows, Method::Uniform, &scene);
    }
    turned_inside_out(&mut rows)?;
    unreached(&mut rows)?;
    Ok(rows.finish())
}

/// Solves a scene, solves it again under its penetration, and audits both with another operator.
fn check(rows: &mut Rows, method: Method, scene: &Scene<'_>) {
    let Scene { name, heights, control, hardness } = scene;
    let solved = guarded(|| {
        let by_load = solve_hard(heights, method, (*control, *hardness), TOLERANCE)?;
        let depth = Control::Penetration(by_load.info.penetration);
        // When all elements are in contact, a uniform pressure can be added without a displacement. Then a penetration
        // does not determine the pressure.
        let touches_everywhere = by_load.pressure.values().iter().all(|p| *p > 0.0);
        let by_depth =
            if touches_everywhere { None } else { Some(solve_hard(heights, method, (depth, *hardness), TOLERANCE)?) };
        Ok((by_load, by_depth))
    });
    let (by_load, by_depth) = match solved {
        Ok(solved) => solved,
        Err(error) => return rows.holds(name, "solved", "converged", format!("{error:#}"), false),
    };
    if let Control::MeanPressure(mean) = control {
        rows.at_most(name, "load", (by_load.pressure.mean() / mean - 1.0).abs(), 1e-10);
    }
    audit(rows, name, method, (heights, *hardness, &by_load));
    if let Some(by_depth) = by_depth {
        audit(rows, &format!("{name} by penetration"), method, (heights, *hardness, &by_depth));
    }
}

fn audit(rows: &mut Rows, name: &str, method: Method, (heights, hardness, solved): (&Field, f64, &Solved)) {
    let pressure = &solved.pressure;
    let outside = pressure.values().iter().filter(|p| !(0.0..=hardness).contains(*p)).count();
    rows.at_most(name, "pressures beyond a bound", outside as f64, 0.0);
    rows.at_most(name, "iterations", solved.info.fine_iterations() as f64, MOST_ITERATIONS);
    let range = heights.max() - heights.min();
    let gaps = match guarded(|| displacement(pressure, method)) {
        Ok(displacement) => gaps(heights, &displacement),
        Err(error) => return rows.holds(name, "audit", "possible", format!("{error:#}"), false),
    };
    let contact = solved.info.penetration;
    let of = |wanted: &dyn Fn(f64) -> bool, gap: &dyn Fn(f64) -> f64| {
        let pairs = pressure.values().iter().zip(&gaps).filter(|(p, _)| wanted(**p));
        pairs.map(|(_, g)| gap(*g)).fold(0.0, f64::max)
    };
    let length = if range > 0.0 { range } else { 1.0 };
    let overlap = of(&|p| p < hardness, &|g| contact - g) / length;
    let gap = of(&|p| p > 0.1 * pressure.max(), &|g| g - contact) / length;
    rows.at_most(name, "overlap of what could press more", overlap, AUDIT[0] * TOLERANCE);
    rows.at_most(name, "gap of what could press less", gap, AUDIT[1] * TOLERANCE);
}

/// A contact and the contact turned inside out have pressures p and H - p.
///
/// A uniform pressure displaces nothing. So the pressure H - p, with the rest of the load, solves the problem of the
/// surface upside down, and gaps change their sign.
fn turned_inside_out(rows: &mut Rows) -> Result<()> {
    for method in [Method::Uniform, Method::Spectral] {
        let heights = rough(8, 0.8, 52, 64)?;
        let upside_down = mapped(&heights, |h| -h);
        for (hardness, part) in [(1e-2, 0.1), (4e-3, 0.4), (4e-2, 0.5)] {
            let name = format!("{} hardness {hardness:.0e} load {part} of it inside out", method.name());
            let load = |part: f64| (Control::MeanPressure(part * hardness), hardness);
            let plain = solve_hard(&heights, method, load(part), TIGHT)?;
            let turned = solve_hard(&upside_down, method, load(1.0 - part), TIGHT)?;
            let back = mapped(&turned.pressure, |q| hardness - q);
            rows.at_most(&name, "pressure", plain.distance(&back), SAME_PRESSURE);
            // Both are h_max - Δ, the gap of elements in contact.
            let approach = (heights.max() - plain.info.penetration) + (upside_down.max() - turned.info.penetration);
            rows.at_most(&name, "gap of contact", approach.abs() / heights.rms(), SAME_NUMBER);
            let energy = (plain.info.elastic_energy / turned.info.elastic_energy - 1.0).abs();
            rows.at_most(&name, "elastic energy", energy, SAME_PRESSURE);
            let stiffness = (plain.stiffness / turned.stiffness - 1.0).abs();
            rows.at_most(&name, "stiffness", stiffness, 5e-3);
        }
    }
    Ok(())
}

/// A hardness that no pressure reaches changes no digit.
fn unreached(rows: &mut Rows) -> Result<()> {
    for method in [Method::Uniform, Method::Spectral, Method::Adaptive] {
        let heights = rough(8, 0.8, 53, 128)?;
        for control in [Control::MeanPressure(1e-4), Control::MeanPressure(4e-3), Control::Penetration(heights.rms())] {
            let name = format!("{} {control:?} without a pressure at the hardness", method.name());
            let elastic = solve(&heights, method, control, TOLERANCE)?;
            let hard = solve_hard(&heights, method, (control, 1e3), TOLERANCE)?;
            let pairs = elastic.pressure.values().iter().zip(hard.pressure.values());
            let different = pairs.filter(|(a, b)| a.to_bits() != b.to_bits()).count();
            rows.at_most(&name, "pressures with other digits", different as f64, 0.0);
            let work = elastic.info == hard.info;
            rows.holds(&name, "work and certificate", "equal", super::invariances::verdict(work), work);
        }
    }
    Ok(())
}
