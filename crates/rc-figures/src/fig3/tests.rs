//! Tests of Fig. 3: the quick figure, and the tolerance of its solves.

use super::*;
use crate::figure::tests::{assert_reviewed, assert_written};

fn quick(tolerance: f64) -> Fig3 {
    let params = Fig3::params(Preset::Quick).expect("paper values");
    Fig3::compute(&Params { tolerance, ..params }).expect("the quick figure is solved")
}

#[test]
fn a_tolerance_of_1e_5_is_enough_for_counts() {
    let (coarse, fine) = (quick(1e-5), quick(1e-8));
    // The axis ends at the number of elements of the uniform grid. A thousandth of it is below the size of a dot.
    let visible = 1e-3 * fine.states[0].elements[0];
    for (a, b) in coarse.states.iter().zip(&fine.states) {
        for ((a, b), (_, name, ..)) in a.elements.iter().zip(b.elements).zip(MESHES) {
            assert!((a - b).abs() < visible, "{name}: {a} against {b}, {visible} would be visible");
        }
    }
    let [a, b] = [coarse, fine].map(|figure| figure.at_fraction(TWO_THIRDS).expect("a range with two thirds"));
    for ((a, b), (_, name, ..)) in a.elements.iter().zip(b.elements).zip(MESHES) {
        let difference = a / b - 1.0;
        // Ratios of counts are stated with three digits.
        assert!(difference.abs() < 1e-3, "{name} at two thirds: {a} against {b}, relative {difference:e}");
    }
}

#[test]
fn quick_figure_3_is_as_reviewed_and_can_be_drawn() {
    let params = Fig3::params(Preset::Quick).expect("paper values");
    let figure = Fig3::compute(&params).expect("the quick figure is solved");
    assert_reviewed(&figure, &params, &["fig3-summary", "fig3-counts"]);
    assert_written(&figure);
}
