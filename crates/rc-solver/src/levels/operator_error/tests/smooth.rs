//! The smooth part of the displacement against exact sums.

use rc_core::DVec2;
use rc_kernel::PeriodicLove;

use crate::levels::operator_error::tests::*;

#[test]
fn the_smooth_displacement_is_as_exact_as_the_others() {
    let exact = PeriodicLove::new();
    let mut places = 0;
    for_each_scene(&ENERGY, |name, scene, audited| {
        let side = scene.map.grid().nx();
        let base = audited.base.grid();
        let pressed: Vec<(DVec2, f64)> = (0..side * side)
            .filter(|&i| audited.pressure[i] > 0.0)
            .map(|i| (DVec2::new((i % side) as f64 + 0.5, (i / side) as f64 + 0.5) / side as f64, audited.pressure[i]))
            .collect();
        let reach = 0.5 * audited.solved.certified.params.cutoff as f64 / base.nx() as f64;
        let bound = audited.error().displacement;
        let smooth = audited.certified(audited.base, |operator, _| operator.base_displacement());
        let mut far = 0;
        for (cell, v) in smooth.iter().enumerate().step_by(37) {
            let per_side = base.nx() / TILE;
            let (tile, cell) = (cell / CELLS, cell % CELLS);
            let centre = DVec2::new(
                (tile % per_side * TILE + cell % TILE) as f64 + 0.5,
                (tile / per_side * TILE + cell / TILE) as f64 + 0.5,
            ) / base.nx() as f64;
            let distance = |at: &DVec2| (centre - *at - (centre - *at).round()).length();
            // Nearer to a pressure, the short-range parts are missing. They are not negative.
            if pressed.iter().all(|(at, _)| distance(at) > reach) {
                let sum: f64 =
                    pressed.iter().map(|(at, p)| p * exact.coefficient(centre - *at, 0.5 / side as f64)).sum();
                let spacing = 1.0 / base.nx() as f64;
                let value = |dx: i64, dy: i64| {
                    let n = base.nx() as i64;
                    let place = |i: usize, d: i64| (i as i64 + d).rem_euclid(n) as usize;
                    let (x, y) = (tile % per_side * TILE + cell % TILE, tile / per_side * TILE + cell / TILE);
                    let (x, y) = (place(x, dx), place(y, dy));
                    smooth[(y / TILE * per_side + x / TILE) * CELLS + y % TILE * TILE + x % TILE]
                };
                let ring = |d: i64| value(d, 0) + value(-d, 0) + value(0, d) + value(0, -d);
                let laplacian = (4.0 / 3.0 * ring(1) - ring(2) / 12.0 - 5.0 * v) / (spacing * spacing);
                // The filter to the finest level holds the square root of the mean over an element.
                let v = v + laplacian / (48.0 * (side * side) as f64);
                assert!((v - sum).abs() < bound, "{name}: {v:e} for {sum:e}, bound {bound:e}");
                far += 1;
            }
        }
        places += far;
    });
    assert!(places > 100, "{places} places are far enough from contact");
}
