//! Height maps that are hard on purpose, in units of λ.

use std::f64::consts::TAU;

use anyhow::Result;
use rc_core::testing::quasi_random;
use rc_core::{Field, Grid};
use rc_fractal::{SpectrumParams, Surface};

/// Peak-to-valley height of the shapes.
const RANGE: f64 = 1e-2;

/// A scene's heights with their name.
pub(crate) struct Shape {
    pub(crate) name: &'static str,
    pub(crate) heights: Field,
}

/// The paper's surface with this many waves.
pub(crate) fn rough(waves: usize, hurst: f64, seed: u64, side: usize) -> Result<Field> {
    let params = SpectrumParams { hurst, ..SpectrumParams::paper(waves, seed) };
    Ok(Surface::new(&params)?.sample_on(Grid::square(side)?)?)
}

/// Every value of `heights` through `map`.
pub(crate) fn mapped(heights: &Field, map: impl Fn(f64) -> f64) -> Field {
    let mut mapped = heights.clone();
    mapped.values_mut().iter_mut().for_each(|h| *h = map(*h));
    mapped
}

/// Shapes without roughness or with too much of it, on `side` × `side` elements.
pub(crate) fn shapes(side: usize) -> Result<Vec<Shape>> {
    let grid = Grid::square(side)?;
    let n = side as f64;
    let from = |name, height: &dyn Fn(f64, f64) -> f64| Shape { name, heights: Field::from_fn(grid, height) };
    // Distance to (a, b) on the periodic cell.
    let distance = |x: f64, y: f64, a: f64, b: f64| {
        let wrap = |t: f64| t - t.round();
        f64::hypot(wrap(x - a), wrap(y - b))
    };
    let middle = (0.5 + 0.5 / n, 0.5 + 0.5 / n);
    let one = |x: f64, y: f64| distance(x, y, middle.0, middle.1) < 0.25 / n;
    let bump = move |x: f64, y: f64, a: f64, b: f64| (1.0 - 40.0 * distance(x, y, a, b).powi(2)).max(0.0);
    let noise = |x: f64, y: f64| quasi_random((n * y) as usize * side + (n * x) as usize + 7);
    let peaks = [middle.0 - 0.25, middle.0 + 0.25];
    Ok(vec![
        from("one spike", &|x, y| if one(x, y) { RANGE } else { 0.0 }),
        from("one pit", &|x, y| if one(x, y) { -RANGE } else { 0.0 }),
        from("two equal peaks", &|x, y| RANGE * bump(x, y, peaks[0], middle.1).max(bump(x, y, peaks[1], middle.1))),
        from("plateau without curvature", &|x, y| RANGE * (2.0 * bump(x, y, middle.0, middle.1)).min(1.0)),
        from("square punch", &|x, y| if (x - 0.5).abs().max((y - 0.5).abs()) < 0.2 { RANGE } else { 0.0 }),
        from("round punch", &|x, y| if distance(x, y, 0.5, 0.5) < 0.2 { RANGE } else { 0.0 }),
        from("strip punch", &|x, _| if (x - 0.5).abs() < 0.1 { RANGE } else { 0.0 }),
        from("cone", &|x, y| -RANGE * distance(x, y, middle.0, middle.1)),
        from("ridge of one wave", &|x, _| 0.5 * RANGE * (TAU * x).cos()),
        from("chequered", &|x, y| if ((n * x) as usize + (n * y) as usize).is_multiple_of(2) { RANGE } else { 0.0 }),
        from("white noise", &|x, y| RANGE * noise(x, y)),
        from("bump across the corner", &|x, y| RANGE * bump(x, y, 0.0, 0.0)),
        from("bump across the seam", &|x, y| RANGE * bump(x, y, 0.0, middle.1)),
        from("step of two levels", &|x, _| if x < 0.5 { 0.0 } else { RANGE }),
    ])
}
