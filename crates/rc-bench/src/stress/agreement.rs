//! Agreement of different ways to the same result: operators, methods, kernels, threads.

use anyhow::{Context, Result};
use rc_core::testing::quasi_random;
use rc_core::{Grid, Operator};
use rc_figures::Preset;
use rc_kernel::{Love, Spectral};
use rc_solver::{Control, DirectSum, MultilevelOperator, UniformOperator};

use super::audit::multilevel;
use super::heights::rough;
use super::invariances::verdict;
use super::row::{Row, Rows};
use super::solved::{Method, Solved, eliminated, solve};

const LOAD: Control = Control::MeanPressure(1e-3);

/// Allowed difference of the adaptive method, whose operator has an error of its own.
const SAME_BY_ADAPTIVE: f64 = 1e-3;

pub(crate) fn rows(preset: Preset) -> Result<Vec<Row>> {
    let mut rows = Rows::of("agreement");
    operators(&mut rows)?;
    levels(&mut rows)?;
    methods(&mut rows)?;
    limits(&mut rows, preset)?;
    threads(&mut rows)?;
    Ok(rows.finish())
}

/// L is linear and symmetric, gives displacements of zero mean, and moves with the load.
fn operators(rows: &mut Rows) -> Result<()> {
    let grid = Grid::square(32)?;
    let places = (0..4).flat_map(|row| (0..4).map(move |column| [column, row])).collect();
    let multilevel = MultilevelOperator::new(16, 32, places, 1e-9)?;
    let (love, waves) = (UniformOperator::new(grid, &Love), UniformOperator::new(grid, &Spectral));
    let direct = DirectSum::new(grid, &Love);
    let all: [(&str, &dyn Operator, f64); 4] = [
        ("fourier transform", &love, 1e-13),
        ("fourier transform of waves", &waves, 1e-13),
        ("direct sum", &direct, 1e-13),
        ("multilevel", &multilevel, 1e-8),
    ];
    let n = grid.len();
    let (a, b): (Vec<f64>, Vec<f64>) = (0..n).map(|i| (quasi_random(i) - 0.5, quasi_random(5 * i + 2) - 0.5)).unzip();
    for (name, operator, rounding) in all {
        let apply = |p: &[f64]| {
            let (mut v, mut scratch) = (vec![0.0; n], vec![0.0; operator.scratch_len()]);
            operator.apply(p, &mut v, &mut scratch);
            v
        };
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let (la, lb) = (apply(&a), apply(&b));
        let scale = la.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
        let sum: Vec<f64> = a.iter().zip(&b).map(|(a, b)| a + 3.0 * b).collect();
        let of_sum = apply(&sum);
        let differences = of_sum.iter().zip(la.iter().zip(&lb)).map(|(s, (a, b))| (s - a - 3.0 * b).abs());
        rows.at_most(name, "superposition", differences.fold(0.0, f64::max) / scale, 1e-13);
        rows.at_most(name, "symmetry", (dot(&a, &lb) - dot(&b, &la)).abs() / dot(&a, &la), rounding);
        rows.at_most(name, "mean displacement", la.iter().sum::<f64>().abs() / n as f64 / scale, rounding);
        let uniform = apply(&vec![1.0; n]).iter().fold(0.0_f64, |most, v| most.max(v.abs()));
        rows.at_most(name, "displacement of a uniform load", uniform / scale, rounding);
        rows.holds(name, "energy", "> 0", format!("{:.3e}", dot(&a, &la)), dot(&a, &la) > 0.0);
    }
    Ok(())
}

/// The multilevel operator gives the same as a Fourier transform, for any number of levels.
fn levels(rows: &mut Rows) -> Result<()> {
    for (base, side) in [(16, 32), (16, 64), (16, 128), (32, 256)] {
        let grid = Grid::square(side)?;
        let p: Vec<f64> = (0..grid.len()).map(|i| quasi_random(i) - 0.5).collect();
        let (mut v, transformed) = (multilevel(grid, &p, base)?, UniformOperator::new(grid, &Love));
        let mut expected = vec![0.0; p.len()];
        transformed.apply(&p, &mut expected, &mut []);
        let square = |v: &[f64]| v.iter().map(|v| v * v).sum::<f64>();
        v.iter_mut().zip(&expected).for_each(|(v, expected)| *v -= expected);
        let scene = format!("multilevel, {base} to {side} elements");
        rows.at_most(&scene, "difference to a Fourier transform", (square(&v) / square(&expected)).sqrt(), 1e-8);
    }
    Ok(())
}

/// Elimination, the uniform grid, the adaptive mesh and the paper's procedure find the same contact.
fn methods(rows: &mut Rows) -> Result<()> {
    let small = rough(4, 0.8, 18, 16)?;
    let deepest = small.max() - small.mean();
    for part in [0.01, 0.2, 0.6, 0.95] {
        let scene = format!("16 x 16 elements {part} of full contact");
        let exact = eliminated(&small, part * deepest)?;
        for (method, property) in [
            (Method::Uniform, "uniform against elimination"),
            (Method::GaussSeidel, "gauss-seidel against elimination"),
        ] {
            let tolerance = if method == Method::Uniform { 1e-10 } else { 1e-9 };
            let other = solve(&small, method, Control::Penetration(part * deepest), tolerance)?;
            rows.at_most(&scene, property, other.distance(&exact), 1e4 * tolerance);
        }
    }
    let heights = rough(8, 0.8, 19, 128)?;
    for load in [1e-6, 1e-4, 1e-3, 1e-2] {
        let control = Control::MeanPressure(load);
        let uniform = solve(&heights, Method::Uniform, control, 1e-8)?;
        let adaptive = solve(&heights, Method::Adaptive, control, 1e-8)?;
        let scene = format!("128 x 128 elements load {load:.0e} E*");
        rows.at_most(
            &scene,
            "adaptive against uniform pressure",
            adaptive.distance(&uniform.pressure),
            SAME_BY_ADAPTIVE,
        );
        let penetration = (adaptive.info.penetration / uniform.info.penetration - 1.0).abs();
        rows.at_most(&scene, "adaptive against uniform penetration", penetration, 1e-6);
        let area = (adaptive.observables.area.cells / uniform.observables.area.cells - 1.0).abs();
        rows.at_most(&scene, "adaptive against uniform area", area, 2e-3);
        let stiffness = (adaptive.stiffness / uniform.stiffness - 1.0).abs();
        rows.at_most(&scene, "adaptive against uniform stiffness", stiffness, 1e-2);
    }
    Ok(())
}

/// The kernels of squares and waves have one limit.
///
/// Their results come closer as the grid is refined.
fn limits(rows: &mut Rows, preset: Preset) -> Result<()> {
    let sides: &[usize] = if preset == Preset::Full { &[32, 64, 128, 256, 512] } else { &[32, 64, 128] };
    let mut last: Option<f64> = None;
    for &side in sides {
        let heights = rough(4, 0.8, 20, side)?;
        let [love, waves] = [Method::Uniform, Method::Spectral].map(|method| solve(&heights, method, LOAD, 1e-8));
        let distance = (love?.observables.rms_pressure / waves?.observables.rms_pressure - 1.0).abs();
        let bound = last.map_or(0.05, |last| 0.7 * last);
        rows.at_most(&format!("{side} elements"), "rms pressure of squares against waves", distance, bound);
        last = Some(distance);
    }
    Ok(())
}

/// The digits do not depend on the number of threads.
fn threads(rows: &mut Rows) -> Result<()> {
    for method in [Method::Uniform, Method::Adaptive] {
        let heights = rough(8, 0.8, 21, 128)?;
        let with = |n: usize| -> Result<Solved> {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(n).build().context("threads")?;
            pool.install(|| solve(&heights, method, LOAD, 1e-6))
        };
        let one = with(1)?;
        for n in [2, 3, 7] {
            let other = with(n)?;
            let same = other.pressure == one.pressure && other.info == one.info;
            let scene = format!("{} {n} threads", method.name());
            rows.holds(&scene, "digits of one thread", "equal", verdict(same), same);
        }
    }
    Ok(())
}
