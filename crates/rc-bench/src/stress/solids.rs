//! Solids other than the periodic half-space.
//!
//! They are layers on a rigid base, and patches with free borders.

use std::f64::consts::PI;

use anyhow::{Context, Result};
use rc_core::{DVec2, Field, Grid, Kernel, Operator, Silent};
use rc_figures::Preset;
use rc_kernel::{FreeLove, Layer, LoveLayer, SpectralLayer};
use rc_solver::{ContactProblem, Control, Method, Solution, SolveParams, Tolerance, UniformOperator, solve_dense};
use rc_theory::hertz::Hertz;

use super::heights::rough;
use super::row::{Row, Rows};

pub(crate) fn rows(preset: Preset) -> Result<Vec<Row>> {
    let mut rows = Rows::of("layers and patches");
    let side = if preset == Preset::Full { 96 } else { 64 };
    for (thickness, poisson) in [(2.0, 0.3), (0.2, 0.0), (0.1, 0.49), (0.05, 0.3), (0.05, 0.5), (0.02, -0.9)] {
        let layer = Layer { thickness, poisson };
        let scene = format!("a layer of {thickness} with a Poisson's ratio of {poisson}");
        common(&mut rows, &scene, &LoveLayer(layer), side)?;
        if poisson < 0.5 {
            compressed(&mut rows, &scene, layer, side)?;
        }
    }
    common(&mut rows, "a patch with free borders", &FreeLove, side)?;
    spheres(&mut rows, preset)?;
    Ok(rows.finish())
}

fn solve<'a>(heights: &'a Field, kernel: &'a dyn Kernel, control: Control, energy: f64) -> Result<Solution<'a>> {
    // Patches on adaptive meshes are among the meshes.
    let params = SolveParams { tolerance: Tolerance::Energy(energy), ..SolveParams::default().by(Method::Uniform) };
    let problem = ContactProblem::new(heights, control).with_kernel(kernel);
    problem.solve(&params, &Silent).with_context(|| format!("{control:?} to {energy:e}"))
}

fn off(value: f64, reference: f64) -> f64 {
    (value / reference - 1.0).abs()
}

/// Checks that every solid must pass, from light to heavy loads.
fn common(rows: &mut Rows, scene: &str, kernel: &dyn Kernel, side: usize) -> Result<()> {
    let heights = rough(8, 0.8, 4, side)?;
    let small = rough(4, 0.8, 4, 20)?;
    let range = small.max() - small.min();
    let [mut worst, mut round_trip, mut gaps, mut bounds] = [0.0_f64; 4];
    // These depths are below full contact. Beyond it the problem of an incompressible layer has no solution.
    for depth in [0.1 * range, 0.2 * range, 0.3 * range] {
        let exact = solve_dense(&small, kernel, depth)?.context("elimination found no contact")?;
        let found = solve(&small, kernel, Control::Penetration(depth), 1e-5)?;
        let differences = found.pressure().values().iter().zip(exact.values()).map(|(a, b)| (a - b).powi(2));
        let size: f64 = exact.values().iter().map(|p| p * p).sum();
        worst = worst.max((differences.sum::<f64>() / size).sqrt());
    }
    for load in [1e-5, 1e-3, 2e-2] {
        let exact = solve(&heights, kernel, Control::MeanPressure(load), 1e-5)?;
        let by_depth = solve(&heights, kernel, Control::Penetration(exact.info().penetration), 1e-5)?;
        round_trip = round_trip.max(off(by_depth.info().mean_pressure, load));
        let mean_gap = exact.observables().mean_gap;
        gaps = gaps.max((exact.gap().mean() - mean_gap).abs() / (heights.max() - heights.min()));
        let loose = solve(&heights, kernel, Control::MeanPressure(load), 0.3)?;
        bounds = bounds.max(distance(&loose, &exact, kernel, load) / loose.certificate().energy);
    }
    rows.at_most(scene, "pressure against elimination", worst, 1e-4);
    rows.at_most(scene, "load to penetration and back", round_trip, 1e-5);
    rows.at_most(scene, "mean gap against that of the field, over the height range", gaps, 1e-12);
    rows.at_most(scene, "error in the energy norm over its bound", bounds, 1.0);
    Ok(())
}

/// Difference of a loose pressure from an exact one in the energy norm.
///
/// It is relative to the energy without the part of the mean pressure.
fn distance(loose: &Solution<'_>, exact: &Solution<'_>, kernel: &dyn Kernel, load: f64) -> f64 {
    let pressures = loose.pressure().values().iter().zip(exact.pressure().values());
    let difference: Vec<f64> = pressures.map(|(a, b)| a - b).collect();
    let mut displaced = vec![0.0; difference.len()];
    UniformOperator::new(loose.grid(), kernel).apply(&difference, &mut displaced, &mut []);
    let work: f64 = difference.iter().zip(&displaced).map(|(a, b)| a * b).sum();
    let uniform = 0.5 * kernel.uniform_displacement().unwrap_or(0.0) * load * load;
    (work / difference.len() as f64 / (exact.info().elastic_energy - uniform)).sqrt()
}

/// A penetration beyond full contact compresses a layer with the kernel of waves.
fn compressed(rows: &mut Rows, scene: &str, layer: Layer, side: usize) -> Result<()> {
    let heights = rough(4, 0.8, 4, side)?;
    let kernel = SpectralLayer(layer);
    let load = 0.5;
    let depth = heights.max() - heights.mean() + load * layer.uniform_displacement();
    let solution = solve(&heights, &kernel, Control::Penetration(depth), 1e-5)?;
    rows.at_most(scene, "load that closes all gaps", off(solution.info().mean_pressure, load), 1e-9);
    let stiffness = off(solution.stiffness(), layer.uniform_displacement().recip());
    rows.at_most(scene, "stiffness of full contact", stiffness, 1e-9);
    Ok(())
}

/// Hertz contacts of a sphere at any place of the patch.
fn spheres(rows: &mut Rows, preset: Preset) -> Result<()> {
    let side = if preset == Preset::Full { 512 } else { 256 };
    let (theory, radius) = (Hertz { radius: 1.0 }, 0.15);
    for place in [[0.5, 0.5], [0.16, 0.5], [0.17, 0.84]] {
        let place = DVec2::from(place);
        let heights = Field::from_fn(Grid::square(side)?, |at| -0.5 * (at - place).length_squared());
        let load = theory.load(radius);
        let solution = solve(&heights, &FreeLove, Control::MeanPressure(load), 1e-4)?;
        let scene = format!("a sphere at {place} of a patch of {side} x {side}");
        let penetration = solution.info().penetration - heights.max();
        rows.at_most(&scene, "penetration against Hertz", off(penetration, theory.penetration(radius)), 1e-3);
        let peak = off(solution.pressure().max(), theory.peak_pressure(radius));
        rows.at_most(&scene, "peak pressure against Hertz", peak, 1e-3);
        let found = (solution.area().fraction / PI).sqrt();
        rows.at_most(&scene, "radius against Hertz", off(found, radius), 1e-3);
        let stiffness = off(solution.stiffness(), 2.0 * radius);
        rows.at_most(&scene, "stiffness against Hertz", stiffness, 3e-3);
        let energy = off(solution.info().elastic_energy, theory.energy(radius));
        rows.at_most(&scene, "energy against Hertz", energy, 2e-3);
    }
    Ok(())
}
