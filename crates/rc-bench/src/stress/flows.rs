//! Flows through gaps that are hard to solve on purpose.

use anyhow::Result;
use rc_core::testing::quasi_random;
use rc_core::{Field, Grid};
use rc_figures::Preset;
use rc_leakage::{LeakageParams, leakage};

use super::heights::{mapped, rough};
use super::row::{Row, Rows, guarded};

/// Maximum relative difference of the flows through two sections.
const CONSERVATION: f64 = 1e-10;

/// Maximum difference of the bounds of the permeance, relative to the permeance.
const BOUNDS: f64 = 1e-9;

/// Maximum relative difference of one flow that is computed in two ways.
const SAME: f64 = 1e-8;

pub(crate) fn rows(preset: Preset) -> Result<Vec<Row>> {
    let mut rows = Rows::of("flows");
    let side = if preset == Preset::Full { 512 } else { 128 };
    let heights = rough(8, 0.8, 7, side)?;
    for level in [-1.0, -0.5, 0.0, 0.5] {
        // The surface above a level is contact. The gap opens as at the edge of a contact.
        let gap = mapped(&heights, |h| (level - h / heights.rms()).max(0.0).powf(1.5));
        check(&mut rows, &format!("rough; contact above {level} rms"), &gap);
    }
    let grid = Grid::square(side)?;
    let noise = Field::new(grid, (0..grid.len()).map(|i| if quasi_random(i) < 0.2 { 0.0 } else { 1.0 }).collect())?;
    check(&mut rows, "walls at random", &noise);
    let hard = (0..grid.len()).map(|i| {
        if quasi_random(7919 * (i + 1)) < 0.38 {
            0.0
        } else {
            10.0_f64.powf(-4.0 * quasi_random(7919 * (i + 1_000_003)))
        }
    });
    check(
        &mut rows,
        "walls at random close to the threshold, gaps over four decades",
        &Field::new(grid, hard.collect())?,
    );
    check(&mut rows, "plates", &Field::from_fn(grid, |_| 1.0));
    check(&mut rows, "a slot along x", &Field::from_fn(grid, |at| if at.y < 0.5 { 1.0 } else { 0.0 }));
    Ok(rows.finish())
}

/// Checks conservation, and compares with the flow of the transposed gap in other units.
///
/// These units make the gap 1e-3 times as large.
fn check(rows: &mut Rows, scene: &str, gap: &Field) {
    let n = gap.grid().nx();
    let values = (0..n * n).map(|i| 1e-3 * gap.at(i / n, i % n)).collect();
    let solved = guarded(|| {
        let params = LeakageParams { half_grid: false, ..LeakageParams::default() };
        Ok([leakage(gap, &params)?, leakage(&Field::new(gap.grid(), values)?, &params)?])
    });
    match solved {
        Err(error) => rows.holds(scene, "solved", "converged", format!("{error:#}"), false),
        Ok([flow, turned]) => {
            for axis in [0, 1] {
                let (flow, turned) = (&flow.flows[axis], &turned.flows[1 - axis]);
                let [name, bounds] =
                    [["flow along x", "flow along y"], ["bounds along x", "bounds along y"]].map(|names| names[axis]);
                rows.at_most(scene, name, flow.info.conservation, CONSERVATION);
                rows.at_most(scene, bounds, flow.info.error, BOUNDS);
                let agrees = flow.percolates == turned.percolates && flow.percolates == (flow.permeance > 0.0);
                rows.holds(scene, "percolation", "that of the transposed gap", flow.percolates.to_string(), agrees);
                let scale = flow.permeance.max(f64::MIN_POSITIVE);
                rows.at_most(scene, "transposed", (1e9 * turned.permeance - flow.permeance).abs() / scale, SAME);
            }
        }
    }
}
