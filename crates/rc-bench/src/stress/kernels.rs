//! The kernels against 100-digit arithmetic over 20 decades of distance and size, and condition numbers.

use std::f64::consts::SQRT_2;

use anyhow::{Context, Result, ensure};
use rc_core::{DVec2, Grid, Kernel};
use rc_figures::Preset;
use rc_figures::repository;
use rc_kernel::{Love, PeriodicLove, Spectral, love_alias_sum, love_displacement};

use super::row::{Row, Rows};

/// Error bounds that the documentation of the kernels states.
const FREE: f64 = 1.2e-15;
const PERIODIC: f64 = 1e-12;
const SYMBOL: f64 = 4e-15;

pub(crate) fn rows(preset: Preset) -> Result<Vec<Row>> {
    let mut rows = Rows::of("kernels");
    free(&mut rows)?;
    periodic(&mut rows)?;
    symbols(&mut rows, preset)?;
    conditions(&mut rows, preset)?;
    Ok(rows.finish())
}

/// Lines of the table `name` in `data/reference`.
fn table(name: &str) -> Result<Vec<[f64; 4]>> {
    let path = repository::root().join("data/reference").join(name);
    let text = std::fs::read_to_string(&path).with_context(|| format!("could not read {}", path.display()))?;
    let line = |line: &str| -> Result<[f64; 4]> {
        let values: Vec<f64> = line.split(',').map(str::parse).collect::<Result<_, _>>()?;
        values.try_into().ok().with_context(|| format!("{name}: not four numbers: {line}"))
    };
    let lines: Vec<[f64; 4]> = text.lines().skip(1).map(line).collect::<Result<_>>()?;
    ensure!(lines.len() > 30, "{name} has only {} lines", lines.len());
    Ok(lines)
}

/// The decade of a positive number.
fn decade(value: f64) -> i32 {
    value.log10().floor() as i32
}

/// Adds a row with the largest error of each scene.
///
/// The rows are in the order in which scenes first appear.
fn worst(rows: &mut Rows, property: &'static str, bound: f64, errors: impl Iterator<Item = (String, f64)>) {
    let mut scenes: Vec<(String, f64)> = Vec::new();
    for (scene, error) in errors {
        // A NaN counts as the largest error.
        let error = if error.is_nan() { f64::INFINITY } else { error };
        match scenes.iter_mut().find(|(name, _)| *name == scene) {
            Some((_, most)) => *most = most.max(error),
            None => scenes.push((scene, error)),
        }
    }
    for (scene, error) in scenes {
        rows.at_most(&scene, property, error, bound);
    }
}

fn free(rows: &mut Rows) -> Result<()> {
    let lines = table("kernel-decades.csv")?;
    let errors = lines.iter().map(|&[x, y, half_side, reference]| {
        let scene = if (half_side - 1.0).abs() < f64::EPSILON {
            format!("distances of 1e{} half sides", decade(x))
        } else {
            format!("squares of half side 1e{}", half_side.log10().round())
        };
        (scene, (love_displacement(DVec2::new(x, y), half_side) / reference - 1.0).abs())
    });
    worst(rows, "Love's square", FREE, errors);
    Ok(())
}

fn periodic(rows: &mut Rows) -> Result<()> {
    let love = PeriodicLove::new();
    let lines = table("periodic-decades.csv")?;
    let errors = lines.iter().map(|&[dx, dy, half_side, reference]| {
        // Where the coefficient changes its sign, only an error relative to the area of the source has a meaning.
        let scale = reference.abs().max(4.0 * half_side * half_side);
        let error = (love.coefficient(DVec2::new(dx, dy), half_side) - reference).abs() / scale;
        (format!("all images of half side {half_side:e}"), error)
    });
    worst(rows, "periodic sum", PERIODIC, errors);
    let images = lines.iter().map(|&[dx, dy, half_side, _]| {
        let here = love.coefficient(DVec2::new(dx, dy), half_side);
        let there = [(-dx, dy), (dx, -dy), (dy, dx)].map(|image| love.coefficient(image.into(), half_side));
        (format!("all images of half side {half_side:e}"), there.iter().map(|v| (v - here).abs()).fold(0.0, f64::max))
    });
    worst(rows, "symmetry of the periodic sum", 0.0, images);
    Ok(())
}

/// Compares the fast symbol with the alias sum, value by value.
fn symbols(rows: &mut Rows, preset: Preset) -> Result<()> {
    let sides: &[(usize, usize)] = if preset == Preset::Full {
        &[(4, 4), (16, 16), (64, 64), (256, 256), (1024, 1024), (31, 31), (16, 64), (7, 100)]
    } else {
        &[(16, 16), (64, 64), (16, 24)]
    };
    for &(nx, ny) in sides {
        let grid = Grid::new(nx, ny)?;
        let symbol = Love.symbol(grid);
        let mut most = 0.0_f64;
        for (kx, ky) in waves(nx, ny) {
            most = most.max((symbol(kx, ky) / love_alias_sum(grid, kx, ky) - 1.0).abs());
        }
        rows.at_most(&format!("grid {grid}"), "symbol against alias sum", most, SYMBOL);
    }
    Ok(())
}

/// Wavenumbers of a grid: all small ones, and large ones at increasing distances.
fn waves(nx: usize, ny: usize) -> Vec<(usize, usize)> {
    let along = |n: usize| {
        let steps = std::iter::successors(Some(1_usize), |k| Some(k + 1 + k / 3));
        [0].into_iter().chain(steps.take_while(move |k| *k < n / 2)).chain([n / 2])
    };
    along(nx).flat_map(|kx| along(ny).map(move |ky| (kx, ky))).filter(|&k| k != (0, 0)).collect()
}

/// Condition numbers: the ratio of the maximum to the minimum eigenvalue of L.
///
/// The preconditioner removes this ratio.
fn conditions(rows: &mut Rows, preset: Preset) -> Result<()> {
    let sides: &[usize] = if preset == Preset::Full { &[16, 64, 256, 1024, 4096] } else { &[16, 256] };
    for &side in sides {
        let grid = Grid::square(side)?;
        let of_waves = SQRT_2 * (side / 2) as f64;
        for kernel in [&Love as &dyn Kernel, &Spectral] {
            let symbol = kernel.symbol(grid);
            let condition = symbol(1, 0) / symbol(side / 2, side / 2);
            // For the kernel of waves it is the ratio of the maximum to the minimum wavenumber. Squares are stiffer at
            // the shortest wave because of aliases.
            let (low, high) = if kernel.name() == "love" { (0.5, 1.0) } else { (1.0 - 1e-14, 1.0 + 1e-14) };
            let passed = (low * of_waves..=high * of_waves).contains(&condition);
            let scene = format!("{} on {grid}", kernel.name());
            let expected = format!("{:.1} to {:.1}", low * of_waves, high * of_waves);
            rows.holds(&scene, "condition number", &expected, format!("{condition:.3}"), passed);
        }
    }
    Ok(())
}
