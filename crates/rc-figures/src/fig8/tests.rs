//! Tests of Fig. 8: the quick figure, and the claims that the full one makes.

use rc_core::Grid;

use super::*;
use crate::figure::tests::{assert_reviewed, assert_written};

#[test]
fn a_histogram_counts_elements() {
    let grid = Grid::square(2).expect("a grid");
    let pressure = Field::new(grid, vec![0.0, 0.5, 1.5, 9.0]).expect("four values");
    assert_eq!(histogram(&pressure, &[0.0, 1.0, 3.0]), vec![1, 1]);
}

#[test]
fn quick_figure_8_is_as_reviewed_and_can_be_drawn() {
    let params = Fig8::params(Preset::Quick).expect("paper values");
    let figure = Fig8::compute(&params).expect("the quick figure is solved");
    for curve in &figure.curves {
        let waves = curve.waves;
        // The integral of stress must be the load, and the integral of P the area, for any bins.
        let load = curve.mean_stress.mean / params.load - 1.0;
        assert!(load.abs() < 3e-3, "N = {waves}: the mean stress of the distribution is off by {load:e}");
        let area = curve.integral.mean / curve.area.mean - 1.0;
        assert!(area.abs() < 1e-2, "N = {waves}: the area of the distribution is off by {area:e}");
        // P is linear in σ here, and counting elements would not show it.
        let slope = curve.small_slope(DECADES[1], |bin| bin.density.mean);
        assert!((slope - 1.0).abs() < 0.1, "N = {waves}: P grows as σ^{slope}");
    }
    assert_reviewed(&figure, &params, &["fig8-summary", "fig8-bins", "fig8-small", "fig8-refined"]);
    assert_written(&figure);
}
