//! Pressures between zero and a hardness: bounds, what an audit finds, and the contact turned inside out.

use anyhow::Result;
use rc_core::Field;
use rc_figures::Preset;
use rc_solver::Control;

use super::audit::{displacement, gaps};
use super::heights::{mapped, rough, shapes};
use super::row::{Row, Rows, guarded};
use super::scene::TOLERANCE;
use super::solved::{Method, Solved, solve, solve_hard};

/// Overlaps and gaps that an audit may find over the tolerance: those of pressures well inside are a tenth as exact
/// (`scene.rs`).
const AUDIT: [f64; 2] = [1.1, 10.0];

/// Difference of two pressures of one problem, solved to 1e-9 of the height range, and of their penetrations.
const TIGHT: f64 = 1e-9;
const SAME_PRESSURE: f64 = 1e-5;
const SAME_NUMBER: f64 = 1e-7;

/// Iterations on the finest level, at most: three times what rough surfaces of 512² elements took.
const MOST_ITERATIONS: f64 = 60.0;

/// A surface, what presses it, and how hard it is.
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

/// Whether a scene is solved, and again under its penetration, and how well by another operator's word.
fn check(rows: &mut Rows, method: Method, scene: &Scene<'_>) {
    let Scene { name, heights, control, hardness } = scene;
    let solved = guarded(|| {
        let by_load = solve_hard(heights, method, (*control, *hardness), TOLERANCE)?;
        let depth = Control::Penetration(by_load.info.penetration);
        // Where everything touches, a pressure more or less displaces nothing: no penetration tells them apart.
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

/// A uniform pressure displaces nothing: what is left to the hardness, H - p, is the pressure under the surface upside
/// down and the rest of the load, and gaps change their sign.
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
            // Of h_max - Δ, the gap of contact.
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
