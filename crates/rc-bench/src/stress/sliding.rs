//! Scenes of surfaces that slide, at the ends of the ranges of speed, loss and time.
//!
//! Each ends converged, or says that it did not. Sums over waves, without the solver's transforms, then audit it.

use std::f64::consts::TAU;

use anyhow::Result;
use rc_core::{Complex64, DVec2, Field, Grid, Kernel, Silent};
use rc_figures::Preset;
use rc_kernel::{Layer, Love, LoveLayer, Relaxation, Spectral, Viscoelastic};
use rc_solver::{ContactProblem, Control, Solution, SolveError, SolveParams};

use super::extremes::full_contact_pressure;
use super::heights::rough;
use super::row::{Row, Rows, guarded};
use super::solved::Method;

/// Elements per side.
const SIDE: usize = 64;

/// Bound of √(G/U), the default of a solve.
const ENERGY: f64 = 0.01;

/// Allowed difference of √(G/U) to the audit's, which is that of rounding where the iteration went on.
const SAME_ENERGY: f64 = 1e-5;

/// A surface that slides.
struct Scene {
    name: String,
    heights: Field,
    kernel: Box<dyn Kernel + Send + Sync>,
    load: f64,
    hardness: f64,
    method: Option<rc_solver::Method>,
}

impl Scene {
    /// A scene on `heights`, with the kernel love, along x.
    fn new(name: impl Into<String>, heights: &Field, material: &Relaxation, speed: f64) -> Self {
        let kernel = Box::new(Viscoelastic::new(Love, material, speed * DVec2::X));
        let (heights, method) = (heights.clone(), Some(rc_solver::Method::Uniform));
        Self { name: name.into(), heights, kernel, load: 2e-3, hardness: f64::INFINITY, method }
    }

    fn of(self, kernel: impl Kernel + Send + 'static) -> Self {
        Self { kernel: Box::new(kernel), ..self }
    }

    fn under(self, load: f64) -> Self {
        Self { load, ..self }
    }

    fn check(&self, rows: &mut Rows) {
        let problem = ContactProblem::new(&self.heights, Control::MeanPressure(self.load)).with_kernel(&*self.kernel);
        let params = SolveParams { method: self.method, ..SolveParams::certified() };
        let solved = guarded(|| match problem.with_hardness(self.hardness).solve(&params, &Silent) {
            Ok(solution) => Ok((solution.into_owned(), true)),
            Err(SolveError::NotConverged { solution, .. }) => Ok((*solution, false)),
            Err(error) => Err(error.into()),
        });
        let name = &self.name;
        match solved {
            Ok((solution, converged)) => {
                let state = if converged { "converged" } else { "not converged" };
                rows.holds(name, "solved", "converged or not converged", state, true);
                self.audit(rows, &solution, converged);
            }
            Err(error) => rows.holds(name, "solved", "converged or not converged", format!("{error:#}"), false),
        }
    }

    fn audit(&self, rows: &mut Rows, solution: &Solution<'_>, converged: bool) {
        let (name, pressure) = (&self.name, solution.pressure());
        let n_bad = pressure.values().iter().filter(|p| !(**p >= 0.0 && **p <= self.hardness)).count();
        rows.at_most(name, "pressures not finite or beyond their bounds", n_bad as f64, 0.0);
        let n_bad = numbers_of(solution).iter().filter(|value| !value.is_finite()).count();
        rows.at_most(name, "observables not finite", n_bad as f64, 0.0);
        rows.at_most(name, "load by audit", (pressure.mean() / self.load - 1.0).abs(), 1e-9);
        let claimed = solution.info().certificate.energy;
        if converged {
            rows.at_most(name, "energy error", claimed, ENERGY);
        }
        // With a hardness, the bound is another one.
        if self.hardness.is_infinite() {
            let found = energy_error(pressure, &self.heights, &*self.kernel).unwrap_or(f64::NAN);
            rows.at_most(name, "energy error by audit", found, claimed + SAME_ENERGY);
        }
    }
}

/// All numbers of a solution that a summary has.
fn numbers_of(solution: &Solution<'_>) -> Vec<f64> {
    let (info, observables) = (solution.info(), solution.observables());
    let friction = info.friction.map(|friction| {
        [
            friction.coefficient,
            friction.error,
            friction.bound,
            friction.lateral,
            friction.power,
            friction.max_loss_tangent,
        ]
    });
    let stiffness = solution.stiffness();
    let others = [
        info.penetration,
        info.elastic_energy,
        observables.area.fraction,
        observables.area.error,
        observables.mean_gap,
        observables.rms_pressure,
        // It is infinite in full contact.
        if stiffness == f64::INFINITY { 0.0 } else { stiffness },
    ];
    friction.map_or(vec![f64::NAN], |friction| [&friction[..], &others].concat())
}

/// √(G/U) of a pressure, by plain sums over waves.
///
/// G = ⟨p (g - min g)⟩ for the gap g = L p - h, and U = ⟨p L p⟩/2.
fn energy_error(pressure: &Field, heights: &Field, kernel: &dyn Kernel) -> Option<f64> {
    let displacement = displacement(pressure, kernel)?;
    let gap: Vec<f64> = displacement.iter().zip(heights.values()).map(|(u, h)| u - h).collect();
    let least = gap.iter().copied().fold(f64::INFINITY, f64::min);
    let (p, n) = (pressure.values(), gap.len() as f64);
    let missing = p.iter().zip(&gap).map(|(p, g)| p * (g - least)).sum::<f64>() / n;
    let energy = p.iter().zip(&displacement).map(|(p, u)| p * u).sum::<f64>() / (2.0 * n);
    Some((missing / energy).sqrt())
}

/// L p without its mean.
fn displacement(pressure: &Field, kernel: &dyn Kernel) -> Option<Vec<f64>> {
    let grid = pressure.grid();
    let (nx, ny) = (grid.nx(), grid.ny());
    let symbol = kernel.sliding_symbol(grid)?;
    // The mean would leave its rounding in all waves.
    let mean = pressure.mean();
    let values: Vec<Complex64> = pressure.values().iter().map(|&p| (p - mean).into()).collect();
    let mut waves = transformed(&values, [nx, ny], -1.0);
    // A wave of half the elements along a side is the same wave in both directions.
    let both = |k: usize, n: usize| {
        let k = if 2 * k > n { k as i64 - n as i64 } else { k as i64 };
        if 2 * k.unsigned_abs() as usize == n { [k, -k] } else { [k, k] }
    };
    for (i, wave) in waves.iter_mut().enumerate().skip(1) {
        let (columns, rows) = (both(i % nx, nx), both(i / nx, ny));
        let of_all = columns.into_iter().flat_map(|kx| rows.map(|ky| symbol(kx, ky)));
        *wave *= 0.25 * of_all.sum::<Complex64>();
    }
    waves[0] = Complex64::default();
    let scale = (grid.len() as f64).recip();
    Some(transformed(&waves, [nx, ny], 1.0).iter().map(|u| scale * u.re).collect())
}

/// The sums of `values` times exp(± i q·x), rows first and then columns.
fn transformed(values: &[Complex64], [nx, ny]: [usize; 2], sign: f64) -> Vec<Complex64> {
    let turns = |n: usize| -> Vec<Complex64> {
        (0..n).map(|i| Complex64::from_polar(1.0, sign * TAU * i as f64 / n as f64)).collect()
    };
    let [along, across] = [turns(nx), turns(ny)];
    let rows: Vec<Complex64> = values
        .chunks(nx)
        .flat_map(|row| (0..nx).map(|k| row.iter().enumerate().map(|(i, v)| v * along[i * k % nx]).sum::<Complex64>()))
        .collect();
    let of = |(k, ix): (usize, usize)| (0..ny).map(|iy| rows[iy * nx + ix] * across[iy * k % ny]).sum();
    (0..ny).flat_map(|k| (0..nx).map(move |ix| (k, ix))).map(of).collect()
}

/// The rows of all scenes of a preset.
pub(crate) fn rows(preset: Preset) -> Result<Vec<Row>> {
    let mut rows = Rows::of("sliding");
    for scene in [speeds(preset)?, materials()?, loads()?, others()?].into_iter().flatten() {
        scene.check(&mut rows);
    }
    Ok(rows.finish())
}

fn surface() -> Result<Field> {
    rough(8, 0.8, 11, SIDE)
}

/// Speeds from rest to where nothing relaxes but waves across, for several losses.
fn speeds(preset: Preset) -> Result<Vec<Scene>> {
    let (heights, step) = (surface()?, if preset == Preset::Full { 1 } else { 3 });
    let mut scenes = Vec::new();
    // The maximum loss tangent is (κ - 1)/(2 √κ): 1.4, 4.95 and 15.8.
    for ratio in [10.0, 100.0, 1e3] {
        let material = Relaxation::single(ratio, 1.0)?;
        for speed in [0.0, 1e-9, 1e-6, 1e-4, 1e-3, 1e-2, 0.03, 0.1, 1.0, 1e3, 1e9].into_iter().step_by(step) {
            let name = format!("E0 = {ratio} at a speed of {speed:e}");
            scenes.push(Scene::new(name, &heights, &material, speed));
        }
    }
    Ok(scenes)
}

fn materials() -> Result<Vec<Scene>> {
    let heights = surface()?;
    let equal = vec![[0.3, 1.0]; 30];
    let nearly: Vec<[f64; 2]> = (0..30).map(|i| [0.3, 1.0 + 1e-12 * f64::from(i)]).collect();
    let decades: Vec<[f64; 2]> = (-30..30).map(|i| [0.5, 10_f64.powi(i)]).collect();
    let of = |name: &str, terms: &[[f64; 2]]| -> Result<Scene> {
        Ok(Scene::new(name, &heights, &Relaxation::prony(terms)?, 0.1))
    };
    let fractional = |alpha: f64, ratio: f64| -> Result<Scene> {
        let material = Relaxation::fractional(alpha, ratio, 1.0)?;
        Ok(Scene::new(format!("fractional {alpha} to {ratio:e}"), &heights, &material, 0.1))
    };
    Ok(vec![
        of("a mode of tiny weight", &[[1e-14, 1.0]])?,
        of("a mode of tiny weight beside a large one", &[[1e-14, 0.1], [9.0, 1.0]])?,
        of("30 equal modes", &equal)?,
        of("30 nearly equal modes", &nearly)?,
        of("60 decades", &decades)?,
        of("a short relaxation time", &[[9.0, 1e-300]])?,
        of("a long relaxation time", &[[9.0, 1e300]])?,
        of("short and long relaxation times", &[[9.0, 1e-200], [9.0, 1.0], [9.0, 1e200]])?,
        fractional(0.01, 10.0)?,
        fractional(0.2, 1e4)?,
        fractional(1.0, 10.0)?,
    ])
}

fn loads() -> Result<Vec<Scene>> {
    let (heights, material) = (surface()?, Relaxation::single(10.0, 1.0)?);
    let of_full = full_contact_pressure(&heights, Method::Uniform)?;
    let scene = |name: &str, load: f64| Scene::new(name, &heights, &material, 0.03).under(load);
    Ok(vec![
        scene("one element in contact", 1e-12),
        scene("a load of 1e-6", 1e-6),
        scene("0.9 times the relaxed load of full contact", 0.9 * of_full),
        scene("the relaxed load of full contact", of_full),
        scene("3 times the relaxed load of full contact", 3.0 * of_full),
        scene("9.9 times the relaxed load of full contact", 9.9 * of_full),
        scene("far beyond full contact", 1e3 * of_full),
    ])
}

/// Layers, a hardness, lines, directions, the adaptive method, and surfaces without roughness.
fn others() -> Result<Vec<Scene>> {
    let (heights, material) = (surface()?, Relaxation::prony(&[[4.0, 0.1], [50.0, 1.0]])?);
    let scene = |name: &str| Scene::new(name, &heights, &material, 0.05);
    let layer = |name: &str, thickness: f64, poisson: f64| {
        scene(name).of(Viscoelastic::new(
            LoveLayer(Layer { thickness, poisson, substrate: None }),
            &material,
            DVec2::new(0.05, 0.0),
        ))
    };
    let oblique = |name: &str, velocity: DVec2| scene(name).of(Viscoelastic::new(Spectral, &material, velocity));
    let line = Field::from_fn(Grid::new(1024, 1)?, |at| 1e-3 * ((TAU * at.x).cos() + 0.3 * (7.0 * TAU * at.x).sin()));
    let flat = Field::from_fn(Grid::square(SIDE)?, |_| 0.25);
    let wide = rough(8, 0.8, 11, 2 * SIDE)?;
    let adaptive =
        Scene { method: Some(rc_solver::Method::Adaptive), ..Scene::new("adaptive", &wide, &material, 0.05) };
    Ok(vec![
        layer("a layer of 0.1", 0.1, 0.3),
        layer("an incompressible layer of 0.05", 0.05, 0.5),
        Scene { hardness: 0.02, ..scene("hardness 10 times the load") },
        Scene { hardness: 2.1e-3, ..scene("hardness just above the load") },
        oblique("oblique", DVec2::new(0.03, 0.04)),
        oblique("nearly along y", DVec2::new(1e-12, 0.05)),
        Scene::new("a line", &line, &material, 0.05),
        Scene::new("a line the other way and fast", &line, &material, -1e9),
        Scene::new("a flat surface", &flat, &material, 0.05),
        adaptive,
    ])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plain_sums_find_the_friction_of_the_solver() {
        let (heights, material) = (surface().expect("a surface"), Relaxation::single(10.0, 1.0).expect("a material"));
        let scene = Scene::new("one", &heights, &material, 0.03);
        let problem = ContactProblem::new(&heights, Control::MeanPressure(2e-3)).with_kernel(&*scene.kernel);
        let solution = problem.solve(&SolveParams::certified(), &Silent).expect("a solution");
        let found = energy_error(solution.pressure(), &heights, &*scene.kernel).expect("it slides");
        let claimed = solution.info().certificate.energy;
        assert!((found / claimed - 1.0).abs() < 1e-3, "{found} for {claimed}");
    }
}
