//! Scenes at the ends of every range.
//!
//! The ranges are of loads, penetrations, Hurst exponents, waves, offsets, sizes of numbers, shapes and grids.

use anyhow::Result;
use rc_core::{DVec2, Field, Grid};
use rc_figures::Preset;
use rc_solver::Control;

use super::heights::{mapped, rough, shapes};
use super::row::Row;
use super::scene::{Group, Scene, check};
use super::solved::{Method, solve};

/// Sides of the grids: the smallest of the adaptive method, and one without coarser levels.
const ADAPTIVE_SIDE: usize = 128;
const UNIFORM_SIDE: usize = 64;

/// Allowed ratios of iterations to the median, for scenes that are known to be slow.
///
/// `NEAR_FULL_CONTACT` is for scenes whose mean pressure is found on a grid without coarser grids, and where this
/// pressure hardly changes the penetration. The others are for the adaptive method, whose approximate inverse is the
/// rougher one. `SINGLE_ELEMENT` is for a plane with one element that stands out or is missing. `WHITE_NOISE` is for
/// heights where every element is a peak. `PUNCH` is for a flat punch, whose pressure is all at the edge. Each value is
/// a tenth above the measured ratio to the smaller median of the two sets.
const NEAR_FULL_CONTACT: f64 = 3.0;
const SINGLE_ELEMENT: f64 = 2.75;
const WHITE_NOISE: f64 = 3.3;
const PUNCH: f64 = 2.5;

/// The rows of all scenes of a preset.
pub(crate) fn rows(preset: Preset) -> Result<Vec<Row>> {
    let full = preset == Preset::Full;
    let methods: &[Method] = if full {
        &[Method::Uniform, Method::Spectral, Method::Adaptive]
    } else {
        &[Method::Uniform, Method::Adaptive]
    };
    let mut groups: Vec<Group> = Vec::new();
    for (name, make) in GROUPS {
        let scenes: Vec<Vec<Scene>> = methods.iter().map(|&method| make(method, full)).collect::<Result<_>>()?;
        groups.push((name, scenes.concat()));
    }
    groups.push(("grids", grids(full)?));
    groups.push(("gauss-seidel", gauss_seidel()?));
    Ok(check(&groups))
}

/// A group's name, and the function that makes its scenes for a method.
///
/// The function's second argument selects the full or the reduced set.
type Maker = (&'static str, fn(Method, bool) -> Result<Vec<Scene>>);

const GROUPS: [Maker; 5] = [
    ("loads", loads),
    ("penetrations", penetrations),
    ("surfaces", surfaces),
    ("sizes of numbers", sizes),
    ("shapes", shape_scenes),
];

fn side(method: Method) -> usize {
    if method == Method::Adaptive { ADAPTIVE_SIDE } else { UNIFORM_SIDE }
}

/// All values for the full set, every other value for the reduced set.
fn thinned<T: Copy>(values: &[T], full: bool) -> Vec<T> {
    values.iter().copied().step_by(if full { 1 } else { 2 }).collect()
}

/// The mean pressure above which contact is full.
///
/// At this pressure the minimum of σ0 + L⁻¹h is zero.
pub(crate) fn full_contact_pressure(heights: &Field, method: Method) -> Result<f64> {
    let method = if method == Method::Spectral { Method::Spectral } else { Method::Uniform };
    // Far above it the pressure is σ0 + L⁻¹h. A load of about the size of L⁻¹h does not cost digits.
    let load = 1e3 * (heights.max() - heights.min());
    Ok(load - solve(heights, method, Control::MeanPressure(load), 1e-6)?.pressure.min())
}

fn loads(method: Method, full: bool) -> Result<Vec<Scene>> {
    let heights = rough(8, 0.8, 1, side(method))?;
    let of_full = full_contact_pressure(&heights, method)?;
    let small = [1e-12, 1e-10, 1e-8, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2];
    let large = [0.5, 0.9, 0.999, 1.0 - 1e-9, 1.0 + 1e-9, 1.1, 10.0, 1e3, 1e9];
    let small = thinned(&small, full).into_iter().map(|load| (format!("load {load:.0e} E*"), load));
    let large = thinned(&large, full)
        .into_iter()
        .map(|part| (format!("{part} times the load of full contact"), part * of_full));
    let scene = |(name, load): (String, f64)| {
        let scene = Scene::new(name, &heights, method, Control::MeanPressure(load));
        match method {
            Method::Adaptive => scene,
            // Within rounding of full contact either answer is right.
            _ if load > 1.05 * of_full => scene.exact(),
            _ => scene,
        }
    };
    Ok(small.chain(large).map(scene).collect())
}

fn penetrations(method: Method, full: bool) -> Result<Vec<Scene>> {
    let heights = rough(8, 0.8, 2, side(method))?;
    let deepest = heights.max() - heights.mean();
    let parts = [1e-9, 1e-6, 1e-3, 0.1, 0.3, 0.6, 0.9, 0.99, 1.0 - 1e-4, 1.0 - 1e-6, 1.0 - 1e-9];
    let scene = |part: f64| {
        let name = if part > 0.995 {
            format!("full contact less {:.0e}", 1.0 - part)
        } else {
            format!("{part:e} of full contact")
        };
        let scene = Scene::new(name, &heights, method, Control::Penetration(part * deepest));
        if part > 0.995 && method != Method::Adaptive { scene.slow(NEAR_FULL_CONTACT) } else { scene }
    };
    Ok(thinned(&parts, full).into_iter().map(scene).collect())
}

fn surfaces(method: Method, full: bool) -> Result<Vec<Scene>> {
    let mut scenes = Vec::new();
    for hurst in thinned(&[0.01, 0.1, 0.3, 0.5, 0.8, 1.0], full) {
        let heights = rough(16, hurst, 3, 128)?;
        // The load is proportional to the slope, so that about 5 % are in contact.
        let load = 0.02 * slope(&heights);
        scenes.push(Scene::new(format!("H = {hurst}"), &heights, method, Control::MeanPressure(load)));
    }
    let mut waves = vec![1, 2, 4, 16, 32];
    if full {
        waves.extend([64, 128]);
        waves.extend((method == Method::Adaptive).then_some(256));
        waves.extend((method == Method::Uniform).then_some(1024));
    }
    for waves in waves {
        let side = match waves {
            1024 => 2304,
            _ => (4 * waves).max(128),
        };
        let heights = rough(waves, 0.8, 4, side)?;
        let load = 0.02 * slope(&heights);
        let scene = Scene::new(format!("N = {waves}"), &heights, method, Control::MeanPressure(load));
        scenes.push(scene);
    }
    Ok(scenes)
}

/// Rms slope from differences of neighbours along x.
fn slope(heights: &Field) -> f64 {
    let nx = heights.grid().nx();
    let rows = heights.values().chunks_exact(nx);
    let squares = rows.flat_map(|row| (0..nx).map(move |ix| (row[(ix + 1) % nx] - row[ix]).powi(2)));
    nx as f64 * (2.0 * squares.sum::<f64>() / heights.grid().len() as f64).sqrt()
}

/// The same surface with heights of every size and with large constants added.
fn sizes(method: Method, full: bool) -> Result<Vec<Scene>> {
    let heights = rough(8, 0.8, 5, side(method))?;
    let (rms, load) = (heights.rms(), 1e-3);
    let mut scenes = Vec::new();
    for size in thinned(&[1e-15, 1e-12, 1e-6, 1e-3, 1e-1, 1e3, 1e30, 1e-30, 1e125, 1e-125], full) {
        let scaled = mapped(&heights, |h| h / rms * size);
        let control = Control::MeanPressure(load / rms * size);
        scenes.push(Scene::new(format!("rms height {size:.0e}"), &scaled, method, control));
    }
    for offset in thinned(&[1.0, 1e4, -1e4, 1e8, -1e8], full) {
        let raised = mapped(&heights, |h| h + offset * rms);
        let name = format!("heights raised by {offset:.0e} rms");
        scenes.push(Scene::new(name.clone(), &raised, method, Control::MeanPressure(load)));
        let penetration = 0.3 * (raised.max() - raised.mean());
        scenes.push(Scene::new(name + " to a penetration", &raised, method, Control::Penetration(penetration)));
    }
    Ok(scenes)
}

fn shape_scenes(method: Method, full: bool) -> Result<Vec<Scene>> {
    let mut scenes = Vec::new();
    for shape in shapes(side(method))? {
        let range = shape.heights.max() - shape.heights.min();
        let mut add = |name: String, control| {
            let scene = Scene::new(name, &shape.heights, method, control);
            scenes.push(match shape.name {
                "white noise" if method == Method::Adaptive => scene.slow(WHITE_NOISE),
                "one spike" | "one pit" if method == Method::Adaptive => scene.slow(SINGLE_ELEMENT),
                name if name.ends_with("punch") && method == Method::Adaptive => scene.slow(PUNCH),
                _ => scene,
            });
        };
        for part in thinned(&[1e-2, 1e-6, 1.0], full) {
            add(format!("{} at a load of {part:.0e} H", shape.name), Control::MeanPressure(part * range));
        }
        let deepest = shape.heights.max() - shape.heights.mean();
        add(format!("{} pressed to half of full contact", shape.name), Control::Penetration(0.5 * deepest));
    }
    Ok(scenes)
}

/// Grids with an odd number of elements, with one row, or with one element.
fn grids(full: bool) -> Result<Vec<Scene>> {
    let square = [(1, 1), (2, 2), (1, 64), (64, 1), (3, 5), (63, 63), (48, 80), (61, 7), (128, 2), (2, 128)];
    let rectangles = [
        (64, 32, 0.5),
        (32, 32, 0.5),
        (24, 72, 3.0),
        (40, 10, 7.3),
        (64, 1, 1e-2),
        (16, 256, 16.0),
        (256, 16, 1.0 / 16.0),
        (16, 512, 1e2),
    ];
    let grids = thinned(&square, full).into_iter().map(|(nx, ny)| (nx, ny, 1.0)).chain(thinned(&rectangles, full));
    let mut scenes = Vec::new();
    for (nx, ny, ratio) in grids {
        let grid = Grid::in_cell(nx, ny, ratio)?;
        let wave = |t: f64| (std::f64::consts::TAU * t).cos();
        let heights =
            Field::from_fn(grid, |DVec2 { x, y }| 1e-3 * (wave(x + 0.1) + wave(y / ratio + 0.2) + 0.3 * wave(2.0 * x)));
        let control = Control::MeanPressure(1e-3);
        for method in [Method::Uniform, Method::Spectral] {
            let cell = if grid.has_square_cell() { String::new() } else { format!(", cell of 1 x {ratio}") };
            let scene = Scene::new(format!("grid {grid}{cell}"), &heights, method, control);
            scenes.push(scene);
        }
    }
    let flat = Field::from_fn(Grid::square(32)?, |_| 0.25);
    scenes.push(Scene::new("flat surface", &flat, Method::Uniform, Control::MeanPressure(1e-3)));
    Ok(scenes)
}

fn gauss_seidel() -> Result<Vec<Scene>> {
    let heights = rough(4, 0.8, 6, 32)?;
    let deepest = heights.max() - heights.mean();
    let load = |load: f64| {
        Scene::new(format!("load {load:.0e} E*"), &heights, Method::GaussSeidel, Control::MeanPressure(load))
    };
    let depth = |part: f64| {
        let name = format!("{part} of full contact");
        Scene::new(name, &heights, Method::GaussSeidel, Control::Penetration(part * deepest))
    };
    Ok(vec![load(1e-6), load(1e-4), load(1e-3), depth(1e-3), depth(0.3), depth(0.6)])
}
