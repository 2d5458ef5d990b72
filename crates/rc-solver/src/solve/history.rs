//! Several loads one after the other on a plastic contact: loading and unloading.
//!
//! The state is the plastic gap w: the overlap that flow has removed so far. A load is the contact of the heights h - w
//! with 0 ≤ p ≤ H, the convex problem of a single load. Where p = H, the overlap that it removes is added to w. A load
//! of 0 removes nothing. Contact below the largest load so far is elastic.

use std::sync::Arc;

use rayon::prelude::*;
use rc_core::{Field, HeightSource, Observer};

use crate::problem::capabilities::Feature;
use crate::problem::contact_problem::ContactProblem;
use crate::problem::control::Control;
use crate::solution::whole::Solution;
use crate::solve::error::SolveError;
use crate::solve::features::{features, refusal_of};
use crate::solve::params::SolveParams;

/// A contact after several loads, one after the other.
#[derive(Debug)]
pub struct History<'a> {
    /// The contact under the last load above 0.
    ///
    /// Its heights are those that the loads before it have left. Its penetration and [`Solution::h_max`] are relative to
    /// them, and [`Solution::plastic_gap`] is what this load alone has removed.
    pub solution: Solution<'a>,
    /// The unloaded surface after the last load: heights less all overlaps that flow has removed, in λ.
    pub residual: Field,
}

impl<'a> ContactProblem<'a> {
    /// Solves the contact under these mean pressures (in E*), one after the other.
    ///
    /// Each load begins on the surface that the loads before it have left. They replace the load of the problem, and
    /// are 0 or more, one of them above 0. The method that [`ContactProblem::plan`] chooses for the largest load solves
    /// all of them. Without a hardness nothing flows, and the residual heights are those of the problem.
    ///
    /// ```
    /// use rc_core::{Field, Grid, Silent};
    /// use rc_solver::{ContactProblem, Control, SolveParams};
    ///
    /// let wave = Field::from_fn(Grid::square(64)?, |at| 1e-3 * (std::f64::consts::TAU * at.x).cos());
    /// let problem = ContactProblem::new(&wave, Control::MeanPressure(1e-3)).with_hardness(2.5e-3);
    /// let first = problem.clone().solve_history(&[1e-3, 0.0], &SolveParams::default(), &Silent)?;
    /// assert!(first.residual.max() < wave.max());
    /// // The same load again finds a surface that bears it without flow.
    /// let again = problem.solve_history(&[1e-3, 1e-3], &SolveParams::default(), &Silent)?;
    /// assert!((again.solution.area().fraction / first.solution.area().fraction - 1.0).abs() < 1e-2);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`SolveError`]. [`SolveError::NotConverged`] has the solution of the first load that did not converge.
    /// [`crate::ProblemError`] if no load is above 0, or one is negative or not finite.
    ///
    /// # Panics
    /// Never, because a history without a load above 0 is an error.
    pub fn solve_history(
        self,
        loads: &[f64],
        params: &SolveParams,
        observer: &dyn Observer,
    ) -> Result<History<'a>, SolveError> {
        let under = |load| Self { control: Control::MeanPressure(load), ..self.clone() };
        let asked: Vec<_> = features(&self, params).into_iter().chain([Feature::History]).collect();
        if let Some(refused) = refusal_of(&self, &asked, params.method) {
            return Err(refused.into());
        }
        // NaN and negative loads are refused as any load is.
        let wrong = loads.iter().copied().find(|load| load.is_nan() || *load < 0.0);
        let largest = wrong.unwrap_or_else(|| loads.iter().copied().fold(0.0, f64::max));
        let plan = under(largest).plan(params)?;
        let (method, bound, reason) = (plan.method(), plan.bound(), plan.reason().clone());
        drop(plan);
        // That of a surface may depend on its waves, which the map after it does not know.
        let params = SolveParams { tolerance: bound.into(), method: Some(method), ..*params };
        let (mut last, mut flow) = (None, None);
        for &load in loads.iter().filter(|load| **load > 0.0) {
            let heights = left(&self.heights, flow.as_ref());
            let mut solution = Self { heights, ..under(load) }.solve(&params, observer)?;
            solution.how.reason = reason.clone();
            flow = Some(match flow {
                None => solution.plastic_gap().clone(),
                Some(before) => combined(before, solution.plastic_gap(), 1.0),
            });
            last = Some(solution);
        }
        let solution = last.expect("a load is above 0, since the plan of the largest one was not refused");
        let residual = left(&self.heights, flow.as_ref()).heights().into_owned();
        Ok(History { solution, residual })
    }
}

/// The heights less the plastic gap so far. They are a map then.
fn left<'a>(heights: &HeightSource<'a>, flow: Option<&Field>) -> HeightSource<'a> {
    match flow {
        None => heights.clone(),
        Some(flow) => Arc::new(combined(heights.heights().into_owned(), flow, -1.0)).into(),
    }
}

/// `one` + `factor` `other`.
pub(super) fn combined(mut one: Field, other: &Field, factor: f64) -> Field {
    one.values_mut().par_iter_mut().zip(other.values()).for_each(|(a, b)| *a += factor * b);
    one
}
