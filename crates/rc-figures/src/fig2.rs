//! Fig. 2: the self-balanced load on the elementary cell and its displacement L (Eq. 3-6).
//!
//! The load is σ = 1 on a square of half side d minus the constant (2d/λ)². So it has no net force, and its
//! displacement has a mean of zero.

use anyhow::Result;
use plotters::prelude::DrawingBackend;
use plotters::style::{BLACK, RGBColor};
use rc_core::DVec2;
use rc_kernel::{PeriodicLove, ewald_phi};
use rc_plot::{Area, Picture, PictureError};

use crate::chart::{BLUE, GREY, Panel, Pen, RED, Side, draw_panels};
use crate::table::Rows;
use crate::{Figure, Preset, Rule, Table, number};

const COLOURS: [RGBColor; 2] = [BLUE, RED];
/// Range of the response per load in the drawing. It cuts the peaks off, which grow as 1/d.
const SHOWN: (f64, f64) = (-0.75, 6.25);

/// Parameters of Fig. 2.
#[derive(Clone, Debug)]
pub struct Params {
    /// λ/d for each half side d of the loaded squares.
    inverse_half_sides: Vec<usize>,
    /// Number of intervals along the cell. It is a power of two, so that the edges of the squares are points.
    n_intervals: usize,
}

/// One load.
#[derive(Clone, Debug)]
struct Case {
    /// λ/d.
    inverse_half_side: usize,
    /// σ at each x. L E*/λ follows.
    stress: Vec<f64>,
    response: Vec<f64>,
    /// Mean of σ over the cell. The mean of L follows.
    mean_stress: f64,
    mean_response: f64,
}

/// The loads with their responses along the centre line of the cell, λ = 1 and E* = 1.
#[derive(Clone, Debug)]
pub struct Fig2 {
    x: Vec<f64>,
    cases: Vec<Case>,
}

impl Figure for Fig2 {
    const NAME: &'static str = "fig2";
    type Params = Params;

    /// Half sides of λ/8 and λ/32.
    ///
    /// The first is easy to see, and the second is closer to the method. The preset changes only the number of points.
    fn params(preset: Preset) -> Result<Params> {
        let n_intervals = match preset {
            Preset::Full => 1024,
            Preset::Quick => 64,
        };
        Ok(Params { inverse_half_sides: vec![8, 32], n_intervals })
    }

    fn compute(params: &Params) -> Result<Self> {
        let n = params.n_intervals;
        let x: Vec<f64> = (0..=n).map(|i| i as f64 / n as f64 - 0.5).collect();
        let cases = params.inverse_half_sides.iter().map(|&inverse| Case::of(inverse, &x)).collect();
        Ok(Self { x, cases })
    }

    fn tables(&self) -> Vec<Table> {
        vec![self.summary(), self.lines()]
    }
}

impl Picture for Fig2 {
    fn size(&self) -> (u32, u32) {
        (1500, 1950)
    }

    fn draw<B: DrawingBackend>(&self, area: &Area<B>) -> Result<(), PictureError> {
        draw_panels(area, (3, 1), &[self.load_panel(), self.response_panel(), self.per_load_panel()])
    }
}

impl Case {
    fn of(inverse_half_side: usize, x: &[f64]) -> Self {
        let half_side = (inverse_half_side as f64).recip();
        let kernel = PeriodicLove::new();
        let area = (2.0 * half_side).powi(2);
        let stress = |x: f64| if x.abs() <= half_side { 1.0 - area } else { -area };
        Self {
            inverse_half_side,
            stress: x.iter().map(|&x| stress(x)).collect(),
            response: x.iter().map(|&x| kernel.coefficient(DVec2::new(x, 0.0), half_side)).collect(),
            mean_stress: area * stress(0.0) + (1.0 - area) * stress(0.5),
            mean_response: mean_response(kernel, inverse_half_side),
        }
    }

    fn half_side(&self) -> f64 {
        (self.inverse_half_side as f64).recip()
    }

    /// Force of the loaded square, in σ λ².
    fn load(&self) -> f64 {
        (2.0 * self.half_side()).powi(2)
    }

    fn name(&self) -> String {
        format!("d = λ/{}", self.inverse_half_side)
    }
}

/// The mean of L over the cell, without an error of quadrature.
///
/// Squares of side 2d tile the cell, and equal loads on all of them are a uniform load, which displaces nothing. The
/// mean of L over the cell is therefore the average over one tile of (2d)² Σ_j L_ij, where the sum is over all tiles.
/// The result is the largest such sum on a few points of a tile, which bounds the mean.
fn mean_response(kernel: PeriodicLove, inverse_half_side: usize) -> f64 {
    let half_side = (inverse_half_side as f64).recip();
    let (side, n_tiles) = (2.0 * half_side, inverse_half_side / 2);
    let sum_at = |at: DVec2| {
        let tiles = (0..n_tiles).flat_map(|i| (0..n_tiles).map(move |j| DVec2::new(i as f64, j as f64) * side));
        tiles.map(|tile| kernel.coefficient(at + tile, half_side)).sum::<f64>()
    };
    let points = (0..4).flat_map(|i| (0..4).map(move |j| DVec2::new(f64::from(i), f64::from(j)) * side / 4.0));
    let sums = points.map(|at| side * side * sum_at(at));
    sums.fold(0.0, |largest: f64, sum| if sum.abs() > largest.abs() { sum } else { largest })
}

/// The displacement of a unit point load, in E* λ²: 𝓛 of Eq. 3.
fn point_response(x: f64) -> f64 {
    std::f64::consts::FRAC_1_PI * ewald_phi(DVec2::new(x, 0.0))
}

impl Fig2 {
    fn summary(&self) -> Table {
        let kernel = PeriodicLove::new();
        let at = |x: f64, case: &Case| kernel.coefficient(DVec2::new(x, 0.0), case.half_side());
        // Means are zero up to rounding.
        let rounding = Rule::absolute(1e-13);
        Rows::of(&self.cases)
            .column("half_side", |case| case.half_side())
            .column("load", |case| case.load())
            .within("mean_stress", rounding, |case| case.mean_stress)
            .within("mean_response", rounding, |case| case.mean_response)
            .column("response_at_centre", |case| at(0.0, case))
            .column("at_edge", |case| at(case.half_side(), case))
            .column("at_half_cell", |case| at(0.5, case))
            .table("summary")
    }

    fn lines(&self) -> Table {
        let names = self
            .cases
            .iter()
            .flat_map(|case| ["stress", "response"].map(|quantity| format!("{quantity}_{}", case.inverse_half_side)));
        let header: Vec<String> = ["x".to_owned()].into_iter().chain(names).collect();
        let header: Vec<&str> = header.iter().map(String::as_str).collect();
        let rows = self.x.iter().enumerate().map(|(i, &x)| {
            let values = self.cases.iter().flat_map(|case| [case.stress[i], case.response[i]]);
            [x].into_iter().chain(values).map(number).collect()
        });
        Table::new("lines", &header, rows).rest(Rule::of_scale(1e-6))
    }

    /// Step between drawn points, since shorter pieces of a line look rough.
    fn stride(&self) -> usize {
        (self.x.len() / 256).max(1)
    }

    fn load_panel(&self) -> Panel {
        let mut panel = panel("load / σ", (-0.2, 1.15));
        for (case, colour) in self.cases.iter().zip(COLOURS) {
            let (d, mean) = (case.half_side(), case.load());
            let corners = [(-0.5, -mean), (-d, -mean), (-d, 1.0 - mean), (d, 1.0 - mean), (d, -mean), (0.5, -mean)];
            panel.line(corners, Pen::new(colour, 3));
        }
        for (case, (height, colour)) in self.cases.iter().zip([(0.45, COLOURS[0]), (0.8, COLOURS[1])]) {
            let text = format!("{}, outside −{:.4}", case.name(), case.load());
            panel.text((0.13, height), Side::Right, text, colour);
        }
        panel.note((-0.5, 1.05), "(a)");
        panel
    }

    fn response_panel(&self) -> Panel {
        let mut panel = panel("v E* / (σ λ)", (-0.05, 0.25));
        for ((case, colour), at) in self.cases.iter().zip(COLOURS).zip([(0.13, 0.125), (0.05, 0.03)]) {
            let line = self.x.iter().copied().zip(case.response.iter().copied()).step_by(self.stride());
            panel.line(line, Pen::new(colour, 3));
            panel.text(at, Side::Right, case.name(), colour);
        }
        panel.note((-0.5, 0.228), "(b)");
        panel
    }

    fn per_load_panel(&self) -> Panel {
        let mut panel = panel("v E* λ / F", SHOWN);
        for (case, colour) in self.cases.iter().zip(COLOURS) {
            let line = self.x.iter().zip(&case.response).step_by(self.stride()).map(|(&x, &v)| (x, v / case.load()));
            for piece in line.collect::<Vec<_>>().chunk_by(|a, b| (a.1 < SHOWN.1) == (b.1 < SHOWN.1)) {
                if piece[0].1 < SHOWN.1 {
                    panel.line(piece.iter().copied(), Pen::new(colour, 3));
                }
            }
        }
        for sign in [-1.0, 1.0] {
            let line = (1..=500).map(|i| 0.001 * f64::from(i)).map(|x| (sign * x, point_response(x)));
            panel.line(line.filter(|at| at.1 < SHOWN.1), Pen::new(BLACK, 2).dashed(8, 6));
        }
        for (case, (at, colour)) in self.cases.iter().zip([((0.0, 3.3), COLOURS[0]), ((0.055, 5.0), COLOURS[1])]) {
            let side = if at.0 > 0.0 { Side::Right } else { Side::Above };
            panel.text(at, side, case.name(), colour);
        }
        panel.note((0.13, 1.9), "dashed: point load, Eq. 3");
        panel.note((-0.5, 0.93 * SHOWN.1), "(c)");
        panel
    }
}

/// A panel along the cell, with a line at zero.
fn panel(y_label: &'static str, y: (f64, f64)) -> Panel {
    let mut panel = Panel::new(("x / λ", (-0.5, 0.5)), (y_label, y)).ticks(11, 7);
    panel.line([(-0.5, 0.0), (0.5, 0.0)], Pen::new(GREY, 1));
    panel
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::figure::tests::{assert_reviewed, assert_written};

    fn quick() -> Fig2 {
        let params = Fig2::params(Preset::Quick).expect("no paper values are needed");
        Fig2::compute(&params).expect("coefficients cannot fail")
    }

    #[test]
    fn the_load_and_its_response_have_zero_mean() {
        for case in quick().cases {
            let rounding = f64::EPSILON * case.load();
            assert!(case.mean_stress.abs() <= rounding, "{}: mean load {:e}", case.name(), case.mean_stress);
            // A coefficient is exact to 1e-12 of the largest one, which is about d. The mean averages coefficients.
            let bound = 1e-12 * case.half_side();
            assert!(case.mean_response.abs() < bound, "{}: mean {:e} above {bound:e}", case.name(), case.mean_response);
        }
    }

    #[test]
    fn far_from_the_square_only_the_load_counts() {
        for case in quick().cases {
            let (numeric, point) = (case.response[0] / case.load(), point_response(0.5));
            // The next term is d²/6 times the Laplacian. Far from the square the longest wave dominates, whose
            // Laplacian is (2π)² times its value.
            let bound = (TAU * case.half_side()).powi(2) / 6.0;
            let difference = (numeric / point - 1.0).abs();
            assert!(difference < bound, "{}: {numeric} against {point}, relative {difference:e}", case.name());
        }
    }

    #[test]
    fn quick_figure_2_is_as_reviewed_and_can_be_drawn() {
        let (figure, params) = (quick(), Fig2::params(Preset::Quick).expect("no paper values are needed"));
        assert_reviewed(&figure, &params, &["fig2-summary", "fig2-lines"]);
        assert_written(&figure);
    }
}
