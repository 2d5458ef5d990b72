//! Height maps that are hard to solve on purpose, in units of λ.

use std::f64::consts::TAU;

use anyhow::Result;
use rc_core::testing::quasi_random;
use rc_core::{DVec2, Field, Grid};
use rc_fractal::{SpectrumParams, Surface};

/// Peak-to-valley height of the shapes.
const RANGE: f64 = 1e-2;

/// A named height map.
pub(crate) struct Shape {
    pub(crate) name: &'static str,
    pub(crate) heights: Field,
}

/// The paper's surface with `waves` waves.
pub(crate) fn rough(waves: usize, hurst: f64, seed: u64, side: usize) -> Result<Field> {
    let params = SpectrumParams { hurst, ..SpectrumParams::paper(waves, seed) };
    Ok(Surface::new(&params)?.sample_on(Grid::square(side)?)?)
}

/// The field with `map` applied to every value of `heights`.
pub(crate) fn mapped(heights: &Field, map: impl Fn(f64) -> f64) -> Field {
    let mut mapped = heights.clone();
    mapped.values_mut().iter_mut().for_each(|h| *h = map(*h));
    mapped
}

/// Shapes without roughness or with too much roughness, on `side` × `side` elements.
pub(crate) fn shapes(side: usize) -> Result<Vec<Shape>> {
    let grid = Grid::square(side)?;
    let n = side as f64;
    let from = |name, height: &dyn Fn(DVec2) -> f64| Shape { name, heights: Field::from_fn(grid, height) };
    // Distance of two points on the periodic cell.
    let distance = |a: DVec2, b: DVec2| {
        let wrap = |t: f64| t - t.round();
        f64::hypot(wrap(a.x - b.x), wrap(a.y - b.y))
    };
    let middle = DVec2::splat(0.5 + 0.5 / n);
    let one = |at: DVec2| distance(at, middle) < 0.25 / n;
    let bump = |at: DVec2, centre: DVec2| (1.0 - 40.0 * distance(at, centre).powi(2)).max(0.0);
    let noise = |at: DVec2| quasi_random((n * at.y) as usize * side + (n * at.x) as usize + 7);
    let peaks = [-0.25, 0.25].map(|dx| middle + DVec2::new(dx, 0.0));
    Ok(vec![
        from("one spike", &|at: DVec2| if one(at) { RANGE } else { 0.0 }),
        from("one pit", &|at: DVec2| if one(at) { -RANGE } else { 0.0 }),
        from("two equal peaks", &|at: DVec2| RANGE * bump(at, peaks[0]).max(bump(at, peaks[1]))),
        from("plateau without curvature", &|at: DVec2| RANGE * (2.0 * bump(at, middle)).min(1.0)),
        from("square punch", &|at: DVec2| if (at - 0.5).abs().max_element() < 0.2 { RANGE } else { 0.0 }),
        from("round punch", &|at: DVec2| if distance(at, DVec2::splat(0.5)) < 0.2 { RANGE } else { 0.0 }),
        from("strip punch", &|at: DVec2| if (at.x - 0.5).abs() < 0.1 { RANGE } else { 0.0 }),
        from("cone", &|at: DVec2| -RANGE * distance(at, middle)),
        from("ridge of one wave", &|at: DVec2| 0.5 * RANGE * (TAU * at.x).cos()),
        from("chequered", &|at: DVec2| {
            if ((n * at.x) as usize + (n * at.y) as usize).is_multiple_of(2) { RANGE } else { 0.0 }
        }),
        from("white noise", &|at: DVec2| RANGE * noise(at)),
        from("bump across the corner", &|at: DVec2| RANGE * bump(at, DVec2::ZERO)),
        from("bump across the seam", &|at: DVec2| RANGE * bump(at, DVec2::new(0.0, middle.y))),
        from("step of two levels", &|at: DVec2| if at.x < 0.5 { 0.0 } else { RANGE }),
    ])
}
