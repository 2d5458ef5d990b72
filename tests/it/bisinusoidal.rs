//! The bi-sinusoidal surface of Johnson, Greenwood and Higginson.
//!
//! The reference is a table of independent solutions.

use std::f64::consts::TAU;

use rc_core::{DVec2, Field, Grid};
use rc_kernel::Love;
use rc_solver::Control;
use rc_theory::bisinusoidal::BiSinusoidal;

use crate::{assert_close, data_path, solved};

const AMPLITUDE: f64 = 1e-2;

#[test]
fn bisinusoidal_contact_matches_the_table() {
    let grid = Grid::square(512).expect("grid");
    let heights = Field::from_fn(grid, |DVec2 { x, y }| AMPLITUDE * (TAU * x).cos() * (TAU * y).cos());
    let full_contact = BiSinusoidal { amplitude: AMPLITUDE }.full_contact_pressure();
    let text = std::fs::read_to_string(data_path("reference/bisinusoidal.csv")).expect("table");
    let rows: Vec<Vec<f64>> =
        text.lines().skip(1).map(|line| line.split(',').map(|f| f.parse().expect("number")).collect()).collect();
    assert_eq!(rows.len(), 18, "the table is complete");
    for row in rows {
        let [fraction, area, mean_gap, peak] = row[..] else { panic!("four columns") };
        let solution = solved(&heights, &Love, Control::MeanPressure(fraction * full_contact), 1e-8);
        let observed = solution.observables();
        let gap_error = (observed.mean_gap / AMPLITUDE - mean_gap).abs();
        assert!(gap_error <= 1e-3, "P = {fraction}: mean gap {} D, table {mean_gap} D", observed.mean_gap / AMPLITUDE);
        assert_close(&format!("P = {fraction}: peak pressure"), observed.max_pressure / full_contact, peak, 2e-3);
        assert_close(&format!("P = {fraction}: area by counting"), observed.area.cells, area, 0.015);
        assert_close(&format!("P = {fraction}: corrected area"), observed.area.fraction, area, 6e-3);
    }
}
