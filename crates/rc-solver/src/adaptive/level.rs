//! One level on tiles: the coarser ones prepare the next, the finest is certified.

use std::sync::Arc;

use rayon::prelude::*;
use rc_core::{Grid, Observer};

use super::element_heights::element_heights;
use super::elements::Elements;
use super::fresh::Fresh;
use super::operator::{BLOCK_CELLS, Hierarchy, Reach, Real, Tables, TileOperator};
use super::solver::Solver;
use super::split::split;
use super::survey::{Remainder, possible_contact};
use crate::Control;
use crate::descent::{Descent, Engine, Machinery, Outcome, Start, fresh_gap, mean_pressure, rescale, scale_to_load};
use crate::solution::LevelInfo;

/// The finest level is first solved to the tolerance times this, then the gap is computed afresh: corrections are applied with
/// the quick operator, a few percent off on pressures as rough as corrections are.
const FIRST_TOLERANCE: f64 = 20.0;

/// The error left to the fresh gap, relative to the tolerance, when corrections end. Two fresh gaps of one pressure, computed on
/// different tiles, differ by about a tenth of the tolerance in the worst of ten million elements.
const LAST_TOLERANCE: f64 = 0.7;

/// Rounds of descents and surveys on the finest level. Each round but the first starts with what the last one has missed; one
/// is the rule, two are the exception.
const MOST_ROUNDS: usize = 20;

/// Candidates for contact are chosen with this margin, in units of the height range, so that small changes of the pressure do
/// not add others.
const CANDIDATE_MARGIN: f64 = 2e-3;

/// Pressures on elements; zero everywhere else.
pub(super) struct Mesh {
    pub(super) elements: Elements,
    pub(super) pressure: Vec<f64>,
}

/// A level as it was left.
pub(super) struct Level {
    pub(super) elements: Elements,
    pub(super) pressure: Vec<f64>,
    pub(super) gap: Vec<f64>,
    pub(super) outcome: Outcome,
    /// Elements whose gap was computed; everything else is proven to be out of contact.
    pub(super) evaluated: usize,
    pub(super) info: LevelInfo,
}

/// Pressure and gap wherever contact is possible, and what they amount to.
struct Surveyed {
    pressure: Vec<f64>,
    gap: Vec<f64>,
    outcome: Outcome,
}

/// Elements where contact is possible, with their heights.
struct Candidates {
    elements: Elements,
    heights: Vec<f64>,
}

impl<T: Real + Into<f64>> Solver<'_, T> {
    fn n_levels(&self, grid: Grid) -> usize {
        (grid.nx() / self.base().nx()).ilog2() as usize
    }

    fn hierarchy(&self, elements: &Elements, reach: Reach) -> Arc<Hierarchy> {
        Arc::new(Hierarchy::new(self.base().nx(), elements.clone(), reach))
    }

    /// An operator for gaps under pressures like that of `mesh`.
    fn fresh_of<U: Real + Into<f64>>(&self, hierarchy: Arc<Hierarchy>, mesh: &Mesh) -> Fresh<U> {
        let n_cell = (mesh.elements.finest().side() as f64).powi(2);
        let mean = match self.problem.control {
            Control::MeanPressure(mean) => mean,
            Control::Penetration(_) => mean_pressure(n_cell, &mesh.elements.division(), &mesh.pressure),
        };
        Fresh::new(hierarchy, mean, self.problem.h_range)
    }

    /// Solves on the elements of the prolonged pressure only, for the next level.
    pub(super) fn prepare_level(&self, grid: Grid, mesh: Mesh, tolerance: f64, observer: &dyn Observer) -> Level {
        let n_levels = self.n_levels(grid);
        let hierarchy = self.hierarchy(&mesh.elements, self.response.reach());
        let response = self.response.tables(n_levels);
        let machinery = Machinery {
            corrections: TileOperator::new(Arc::clone(&hierarchy)),
            preconditioner: self.preconditioner.tables(n_levels),
            fresh: self.fresh_of::<f32>(hierarchy, &mesh),
            fresh_response: response.clone(),
            response,
        };
        let heights = element_heights(self.heights, &mesh.elements);
        let start = Start::Pressure(mesh.pressure);
        let mut descent = Descent::new(&heights, grid, machinery, &self.problem, start);
        let outcome = descent.run(tolerance, self.params.max_iterations, false, observer, &mesh.elements);
        let info = descent.info();
        let (pressure, gap) = descent.into_vectors(0.0);
        Level { evaluated: gap.len(), elements: mesh.elements, pressure, gap, outcome, info }
    }

    /// Solves to the tolerance, and proves it for the whole cell.
    pub(super) fn solve_finest(&self, grid: Grid, mut mesh: Mesh, contact_gap: f64, observer: &dyn Observer) -> Level {
        let (n, n_levels) = (grid.len() as f64, self.n_levels(grid));
        let mut info = LevelInfo { grid, iterations: 0, operator_applications: 0, preconditioner_applications: 0 };
        scale_to_load(&self.problem, n, &mesh.elements.division(), &mut mesh.pressure);
        let mut response = self.response.tables(n_levels);
        let mut preconditioner = self.preconditioner.tables(n_levels);
        let mut fresh_response = self.fresh.tables(n_levels);
        let mut candidates = self.first_candidates(&mesh, &response, contact_gap);
        let mut gave_up = false;
        for round in 0.. {
            // The gap wherever contact is possible.
            let Surveyed { pressure, gap, outcome } =
                self.survey(&mut candidates, &mesh, &fresh_response, &mut info, round > 0);
            if round == MOST_ROUNDS
                || gave_up
                || (round > 0 && outcome.certificate.penetration <= self.params.tolerance)
            {
                let evaluated = candidates.elements.n_cells();
                return Level { elements: candidates.elements, pressure, gap, outcome, evaluated, info };
            }
            // What is nearer to contact than the error may come into it yet.
            let error = match outcome.mean_pressure {
                // Nothing presses, when coarser levels have lost a contact that they hardly resolve: it begins anew.
                0.0 => CANDIDATE_MARGIN,
                _ => outcome.certificate.penetration,
            };
            let near = outcome.contact_gap + error * self.problem.h_range;
            let part = Part::choose(&candidates, &mesh.elements, &pressure, &gap, near);
            let machinery = Machinery {
                corrections: TileOperator::new(self.hierarchy(&part.elements, self.response.reach())),
                response,
                preconditioner,
                fresh: self.fresh_of(self.hierarchy(&part.elements, self.fresh.reach()), &mesh),
                fresh_response,
            };
            // Before the descent, which needs the memory.
            drop((pressure, gap));
            let start = Start::Known { pressure: part.pressure, gap: part.gap };
            let mut descent = Descent::new(&part.heights, grid, machinery, &self.problem, start);
            let tolerance = self.params.tolerance;
            let most = self.params.max_iterations;
            descent.run(FIRST_TOLERANCE * tolerance, most, false, observer, &part.elements);
            descent.renew();
            let reached = descent.run(LAST_TOLERANCE * tolerance, most, false, observer, &part.elements).converged;
            gave_up = !reached;
            let done = descent.info();
            info.iterations += done.iterations;
            info.operator_applications += done.operator_applications;
            info.preconditioner_applications += done.preconditioner_applications;
            let (machinery, pressure) = descent.into_machinery();
            mesh = Mesh { elements: part.elements, pressure };
            (response, preconditioner, fresh_response) =
                (machinery.response, machinery.preconditioner, machinery.fresh_response);
        }
        unreachable!("the last round returns")
    }

    /// Elements where the start may touch, judged by the quick operator.
    fn first_candidates(&self, mesh: &Mesh, response: &Tables<f32>, contact_gap: f64) -> Candidates {
        let mut quick = self.fresh_of::<f32>(self.hierarchy(&mesh.elements, self.response.reach()), mesh);
        quick.fill(mesh.pressure.par_chunks(BLOCK_CELLS), |p, cells| cells.copy_from_slice(p));
        quick.multiply(response);
        // Not a proof yet: the margin stands for the quick operator's error too.
        // No contact is nearer than first touch, though coarser heights may reach beyond the highest point.
        let first_touch = self.problem.offset() - self.problem.h_max;
        let level = contact_gap.max(first_touch) + CANDIDATE_MARGIN * self.problem.h_range;
        let curvature = self.response.remainder_curvature();
        let places =
            self.possible_contact(&quick, curvature, &mesh.pressure, mesh.elements.coarsest().per_side(), level);
        self.candidates(mesh.elements.with(&places))
    }

    fn candidates(&self, elements: Elements) -> Candidates {
        Candidates { heights: element_heights(self.heights, &elements), elements }
    }

    /// Tiles where the gap under the pressure last spread by `operator` may be less than `level`; `unit_curvature` is the bound
    /// of its remainder's second derivatives for unit pressure ([`super::operator::Prepared::remainder_curvature`]).
    fn possible_contact<U: Real + Into<f64>>(
        &self,
        operator: &Fresh<U>,
        unit_curvature: f64,
        pressure: &[f64],
        per_side: usize,
        level: f64,
    ) -> Vec<[u32; 2]> {
        let greatest = pressure.par_iter().copied().reduce(|| 0.0, f64::max);
        let remainder = Remainder {
            values: operator.operator().base_displacement(),
            unit: operator.unit(),
            curvature: greatest * unit_curvature,
            error: 1e-5 * self.problem.h_range,
        };
        possible_contact(&remainder, self.heights, level - self.problem.offset(), per_side)
    }

    /// Pressure and gap on all candidates. With `prove`, tiles are added to them until no contact is possible elsewhere.
    fn survey(
        &self,
        candidates: &mut Candidates,
        mesh: &Mesh,
        response: &Tables<T>,
        info: &mut LevelInfo,
        prove: bool,
    ) -> Surveyed {
        loop {
            let mut pressure = mesh.elements.moved(&candidates.elements, &mesh.pressure, 0.0);
            let mut gap = vec![0.0; pressure.len()];
            let mut fresh = self.fresh_of::<T>(self.hierarchy(&candidates.elements, self.fresh.reach()), mesh);
            info.operator_applications += 1;
            let heights = &candidates.heights;
            let mut sums = fresh_gap(&mut fresh, response, &self.problem, (heights, &pressure, &mut gap));
            if let Some(scale) = sums.scale_to_penetration(&self.problem) {
                sums =
                    rescale(scale, &candidates.elements.division(), &self.problem, (heights, &mut pressure, &mut gap));
            }
            let outcome = Outcome::new(&self.problem, &sums, info.grid.len() as f64, true);
            if prove {
                let level = outcome.contact_gap;
                let curvature = self.fresh.remainder_curvature();
                let elements = &candidates.elements;
                let places = self.possible_contact(&fresh, curvature, &pressure, elements.coarsest().per_side(), level);
                let state = self.state(elements, &pressure, &gap, level);
                let more = match elements.levels().len() {
                    1 => elements.with(&places),
                    _ => split(elements, state.too_coarse(), false, self.fresh.reach().stencil).with(&places),
                };
                if more.n_cells() > elements.n_cells() {
                    *candidates = self.candidates(more);
                    continue;
                }
            }
            return Surveyed { pressure, gap, outcome };
        }
    }
}

/// The candidates that press somewhere, or nearly do, or did when the level began.
struct Part {
    elements: Elements,
    heights: Vec<f64>,
    pressure: Vec<f64>,
    gap: Vec<f64>,
}

impl Part {
    fn choose(candidates: &Candidates, known: &Elements, pressure: &[f64], gap: &[f64], near: f64) -> Self {
        let elements = candidates.elements.filtered(|side, place, cells| {
            known.has(side, place) || cells.into_iter().any(|i| pressure[i] > 0.0 || gap[i] < near)
        });
        let part = |values: &[f64], elsewhere: f64| candidates.elements.moved(&elements, values, elsewhere);
        // What fills a level up is as far from contact as can be.
        let (heights, gap) = (part(&candidates.heights, f64::MIN), part(gap, f64::MAX));
        Self { heights, pressure: part(pressure, 0.0), gap, elements }
    }
}
