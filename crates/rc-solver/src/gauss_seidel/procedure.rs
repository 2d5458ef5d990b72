//! Steps (i) to (vi) of the procedure of Sec. 2, which solves Eq. 4 on the elements in contact.

use rc_core::{Event, Field, Kernel, Observer, Operator, Snapshot};
use rc_quadtree::paper::{Key, Mask, Mesh, MeshKind, MeshParams, count, transfer};

use super::coefficients::{Coefficient, Coefficients, Site};
use super::sweep::{self, Limits};
use super::{GaussSeidelError, GaussSeidelParams};
use crate::operator::UniformOperator;
use crate::problem::Problem;
use crate::solution::{GridSolution, LevelInfo, MeshPressure, SolveInfo, Status};
use crate::uniform::coarsen;
use crate::{Certificate, Control, IterationError, IterationParams, solve_uniform};

/// Largest element, in finest elements: beyond it coarsening saves nothing and heights at centres would need more levels.
const LARGEST_DOUBLINGS: u32 = 5;

/// Side of the coarse grid that the cost is estimated on, at most.
const ESTIMATE_SIDE: usize = 256;

/// Rough time of one coefficient from a table, for the message about the budget.
const SECONDS_PER_COEFFICIENT: f64 = 2e-9;

/// Tolerance of all increments but the last, which only prepare its contact.
const EARLY_TOLERANCE: f64 = 1e-4;

/// Residual of v that a tolerance leaves to Gauss-Seidel; the rest is for penetration.
const RESIDUAL_SHARE: f64 = 0.1;

/// First residual of v, relative to the height range, while the contact is being found.
const FIRST_RESIDUAL: f64 = 1e-4;

/// Steps of the search for the penetration of a given mean pressure.
const MOST_SECANT_STEPS: usize = 30;

/// Solves the contact problem by the paper's procedure (Sec. 2, steps (i)-(vi)) on an adaptive mesh whose finest elements
/// are those of the grid of `heights`.
///
/// `kernel` and `coefficient` must be the same half-space: its symbol on uniform grids, and L_ij between squares, as
/// [`rc_kernel::Love`] and `rc_kernel::PeriodicLove` are. A mean pressure is found by a secant search over the penetration,
/// which is what the procedure controls.
///
/// The result is bitwise the same for any number of threads.
///
/// # Errors
/// [`GaussSeidelError`].
pub fn solve_gauss_seidel(
    heights: &Field,
    kernel: &dyn Kernel,
    coefficient: Coefficient<'_>,
    control: Control,
    params: &GaussSeidelParams,
    observer: &dyn Observer,
) -> Result<GridSolution, GaussSeidelError> {
    check(heights, params)?;
    let solve_params = IterationParams { tolerance: params.tolerance, ..IterationParams::certified() };
    let problem = Problem::check(heights, control, &solve_params)?;
    let expected = estimate(heights, kernel, control, params)?;
    let mut procedure = Procedure::new(heights, kernel, coefficient, &problem, params, observer)?;
    match control {
        Control::Penetration(penetration) => procedure.increase_to(penetration)?,
        Control::MeanPressure(mean) => procedure.search(mean, expected)?,
    }
    procedure.finish(control)
}

fn check(heights: &Field, params: &GaussSeidelParams) -> Result<(), GaussSeidelError> {
    let grid = heights.grid();
    if !grid.is_square() {
        return Err(GaussSeidelError::NotSquare { grid });
    }
    let bad = |what, wanted, value| Err(GaussSeidelError::Parameter { what, wanted, value });
    if !(params.relaxation > 0.0 && params.relaxation < 2.0) {
        return bad("the relaxation factor", "above 0 and below 2", params.relaxation);
    }
    if params.increments == 0 {
        return bad("the number of increments", "at least 1", 0.0);
    }
    if params.max_checks == 0 || params.max_sweeps == 0 {
        return bad("the number of sweeps and of double checks", "at least 1", 0.0);
    }
    Ok(())
}

/// The mesh of a grid of `side` elements.
fn mesh_params(side: usize, ring: usize) -> MeshParams {
    let doublings = side.trailing_zeros().min(LARGEST_DOUBLINGS);
    MeshParams { base: side >> doublings, ring, halo: 0 }
}

fn mesh_kind(params: &GaussSeidelParams) -> MeshKind {
    if params.uniform_elements { MeshKind::AdaptiveUniform } else { MeshKind::Adaptive }
}

/// Solves the scene on a coarse grid to foresee the cost, and the penetration. Refuses what would exceed the budget.
fn estimate(
    heights: &Field,
    kernel: &dyn Kernel,
    control: Control,
    params: &GaussSeidelParams,
) -> Result<f64, GaussSeidelError> {
    let coarse = coarsen(heights, ESTIMATE_SIDE / 2);
    let coarse = std::iter::once(heights).chain(&coarse).find(|field| field.grid().nx() <= ESTIMATE_SIDE);
    // A grid that cannot be halved is its own coarse grid.
    let coarse = coarse.unwrap_or(heights);
    let at_most = |full_contact: f64| match control {
        // The coarse grid misses the highest point: keep its penetration below its own full contact.
        Control::Penetration(value) => Control::Penetration(value.min(0.999 * full_contact)),
        Control::MeanPressure(_) => control,
    };
    let solve_params = IterationParams { tolerance: 1e-4, ..IterationParams::certified() };
    let control = at_most(coarse.max() - coarse.mean());
    let solution = match solve_uniform(coarse, kernel, control, &solve_params, &rc_core::Silent) {
        Ok(solution) => solution,
        Err(IterationError::NotConverged { solution, .. }) => *solution,
        Err(error) => return Err(error.into()),
    };
    let side = heights.grid().nx();
    let ratio = side / coarse.grid().nx();
    let contact = |i: usize| {
        let (ix, iy) = (i % side, i / side);
        solution.pressure.at(ix / ratio, iy / ratio) > 0.0
    };
    let mask = Mask::new(side, (0..heights.grid().len()).map(contact).collect())?;
    let elements: usize = count(&mask, mesh_kind(params), &mesh_params(side, params.ring))?.into_iter().sum();
    let coefficients = (elements as f64).powi(2);
    if coefficients > params.sweep_budget as f64 {
        let (seconds_per_sweep, budget) = (coefficients * SECONDS_PER_COEFFICIENT, params.sweep_budget as f64);
        return Err(GaussSeidelError::Budget { elements, coefficients, seconds_per_sweep, budget });
    }
    Ok(solution.info.penetration.max(f64::MIN_POSITIVE))
}

/// The state between increments.
struct Procedure<'a> {
    /// Heights at the centres of elements of 1, 2, 4, … finest elements; the first are the heights themselves.
    pyramid: Vec<Field>,
    problem: &'a Problem,
    params: &'a GaussSeidelParams,
    observer: &'a dyn Observer,
    coefficients: Coefficients<'a>,
    operator: UniformOperator,
    kind: MeshKind,
    mesh_params: MeshParams,
    penetration: f64,
    /// Cells of the finest grid in contact.
    contact: Vec<bool>,
    /// Displacement on the finest grid.
    displacement: Field,
    mesh: Mesh,
    sites: Vec<Site>,
    pressure: Vec<f64>,
    info: LevelInfo,
    /// Whether the last double check left the contact as it was.
    settled: bool,
}

impl<'a> Procedure<'a> {
    fn new(
        heights: &Field,
        kernel: &dyn Kernel,
        coefficient: Coefficient<'a>,
        problem: &'a Problem,
        params: &'a GaussSeidelParams,
        observer: &'a dyn Observer,
    ) -> Result<Self, GaussSeidelError> {
        let grid = heights.grid();
        let side = grid.nx();
        let mut pyramid = vec![heights.clone()];
        pyramid.extend(coarsen(heights, 1).into_iter().take(LARGEST_DOUBLINGS as usize));
        // No element larger than heights are known for.
        let mut mesh_params = mesh_params(side, params.ring);
        mesh_params.base = mesh_params.base.max(side >> (pyramid.len() - 1));
        let kind = mesh_kind(params);
        let contact = vec![false; grid.len()];
        let mesh = Mesh::from_mask(&Mask::new(side, contact.clone())?, kind, &mesh_params)?;
        Ok(Self {
            pyramid,
            problem,
            params,
            observer,
            coefficients: Coefficients::new(coefficient, side as u32, params.memory_budget),
            operator: UniformOperator::new(grid, kernel),
            kind,
            mesh_params,
            penetration: 0.0,
            contact,
            displacement: Field::zeros(grid),
            mesh,
            sites: Vec::new(),
            pressure: Vec::new(),
            info: LevelInfo { grid, iterations: 0, operator_applications: 0, preconditioner_applications: 0 },
            settled: false,
        })
    }

    /// Step (i): Δ in increments, of which only the last is solved to the tolerance, and that only when Δ is what is prescribed.
    fn increase_to(&mut self, penetration: f64) -> Result<(), GaussSeidelError> {
        let (grid, steps) = (self.info.grid, self.params.increments);
        for step in 1..=steps {
            self.observer.notify(&Event::Level { grid, level: step - 1, n_levels: steps });
            let early = step < steps || matches!(self.problem.control, Control::MeanPressure(_));
            let tolerance = if early { self.params.tolerance.max(EARLY_TOLERANCE) } else { self.params.tolerance };
            self.settle(step as f64 / steps as f64 * penetration, tolerance)?;
            if self.observer.should_stop() {
                break;
            }
        }
        Ok(())
    }

    /// The penetration at which the mean pressure is `mean`, starting from the `expected` one.
    fn search(&mut self, mean: f64, expected: f64) -> Result<(), GaussSeidelError> {
        let full = self.problem.h_max - self.problem.h_mean;
        self.increase_to(expected.min(0.999 * full))?;
        let (mut low, mut high) = ((0.0, 0.0), (full, f64::INFINITY));
        for _ in 0..MOST_SECANT_STEPS {
            if self.observer.should_stop() {
                break;
            }
            let here = (self.penetration, self.mean_pressure());
            if (here.1 / mean - 1.0).abs() <= self.params.tolerance {
                return self.settle(here.0, self.params.tolerance);
            }
            // A chord to the other end of the bracket, or to the origin while it has no upper end.
            let other = if here.1 < mean && high.1.is_finite() { high } else { low };
            if here.1 < mean {
                low = here;
            } else {
                high = here;
            }
            let chord = here.0 + (mean - here.1) * (here.0 - other.0) / (here.1 - other.1);
            let inside = chord > low.0 && chord < high.0;
            let next = if inside { chord } else { f64::midpoint(low.0, high.0) };
            // As accurately as the load is known to be off, until it is not.
            let off = (here.1 / mean - 1.0).abs();
            let tolerance = if off < self.params.tolerance.sqrt() { 0.0 } else { 1e-2 * off };
            self.settle(next, tolerance.clamp(self.params.tolerance, EARLY_TOLERANCE))?;
        }
        Ok(())
    }

    /// Mean pressure over the cell.
    fn mean_pressure(&self) -> f64 {
        self.mesh.elements().zip(&self.pressure).map(|(element, p)| p * element.area()).sum()
    }

    /// Steps (ii) to (vi) at one penetration.
    fn settle(&mut self, penetration: f64, tolerance: f64) -> Result<(), GaussSeidelError> {
        self.penetration = penetration;
        let wanted = RESIDUAL_SHARE * tolerance * self.problem.h_range;
        let mut residual = wanted.max(FIRST_RESIDUAL * self.problem.h_range);
        // (ii) The deformed layer as it was, lowered to the new penetration, meets the surface.
        self.add_penetrating(0.0);
        for _ in 0..self.params.max_checks {
            self.relax(residual)?;
            self.displace()?;
            // (vi) The double check. An element under tension has no gap, so it is not added right back.
            let removed = self.remove_tension();
            let added = self.add_penetrating(residual / RESIDUAL_SHARE);
            self.observer.notify(&Event::Iteration {
                iteration: self.info.iterations,
                error: residual / (RESIDUAL_SHARE * self.problem.h_range),
                tolerance,
                n_contact: self.mesh.len(),
            });
            self.show();
            let unchanged = removed + added == 0;
            self.settled = unchanged && residual <= wanted;
            // After the first sweeps, so that there is something to return.
            if self.observer.should_stop() {
                self.settled = false;
                break;
            }
            if self.settled {
                break;
            }
            // While the contact still changes, v need not be as prescribed to all digits.
            if removed + added <= self.mesh.len() / 100 {
                residual = wanted.max(0.1 * residual);
            }
        }
        Ok(())
    }

    /// Lets the observer look at the pressure.
    fn show(&self) {
        let rows = |take: &mut dyn FnMut(&[f64])| {
            let field = self.mesh.to_field(&self.pressure, self.info.grid);
            take(field.expect("a value for each element").values());
        };
        self.observer.look(&Snapshot::new(self.info.grid, &rows));
    }

    /// Steps (iii) and (iv): meshes the contact and relaxes the pressure until v is as prescribed, to `residual`.
    fn relax(&mut self, residual: f64) -> Result<(), GaussSeidelError> {
        let mask = Mask::new(self.info.grid.nx(), self.contact.clone())?;
        let mesh = Mesh::from_mask(&mask, self.kind, &self.mesh_params)?;
        self.pressure = transfer(&self.mesh, &mesh, &self.pressure)?.values;
        self.pressure.iter_mut().for_each(|p| *p = p.max(0.0));
        self.sites = self.coefficients.prepare(&mesh);
        self.mesh = mesh;
        let prescribed = self.prescribed();
        let limits = Limits { residual, max_sweeps: self.params.max_sweeps, relaxation: self.params.relaxation };
        let relaxed = sweep::relax(&self.coefficients, &self.sites, &prescribed, &mut self.pressure, &limits);
        self.info.iterations += relaxed.sweeps;
        Ok(())
    }

    /// `v_i = h_i - h_max + Δ` at the centres of elements.
    fn prescribed(&self) -> Vec<f64> {
        let depth = self.mesh_params.base;
        let lowering = self.penetration - self.problem.h_max;
        let finest = self.info.grid.nx();
        let height = |key: &Key| {
            let side = depth << key.level();
            let level = (finest / side).trailing_zeros() as usize;
            self.pyramid[level].at(key.ix() as usize, key.iy() as usize) + lowering
        };
        self.mesh.keys().iter().map(height).collect()
    }

    /// Step (v): the displacement everywhere.
    fn displace(&mut self) -> Result<(), GaussSeidelError> {
        let pressure = self.mesh.to_field(&self.pressure, self.info.grid)?;
        self.operator.apply(pressure.values(), self.displacement.values_mut(), &mut []);
        self.info.operator_applications += 1;
        Ok(())
    }

    /// Takes elements with negative pressure out of contact. Returns their number.
    fn remove_tension(&mut self) -> usize {
        let grid = self.info.grid;
        let mut removed = 0;
        for (key, _) in self.mesh.keys().iter().zip(&self.pressure).filter(|&(_, &p)| p < 0.0) {
            let cells = grid.nx() / (self.mesh_params.base << key.level());
            let (left, low) = (key.ix() as usize * cells, key.iy() as usize * cells);
            for iy in low..low + cells {
                self.contact[grid.index(left, iy)..grid.index(left, iy) + cells].fill(false);
            }
            removed += 1;
        }
        removed
    }

    /// Brings cells out of contact that penetrate by more than `slack` into it. Returns their number.
    fn add_penetrating(&mut self, slack: f64) -> usize {
        let lowering = self.penetration - self.problem.h_max;
        let mut added = 0;
        let cells = self.contact.iter_mut().zip(self.displacement.values()).zip(self.pyramid[0].values());
        for ((contact, v), h) in cells {
            if !*contact && v - (h + lowering) < -slack {
                *contact = true;
                added += 1;
            }
        }
        added
    }

    /// The solution with its certificate, from fresh sums.
    fn finish(mut self, control: Control) -> Result<GridSolution, GaussSeidelError> {
        let area: Vec<f64> = self.mesh.elements().map(|element| element.area()).collect();
        let weighted = |p: &[f64], values: &[f64]| -> f64 {
            p.iter().zip(&area).zip(values).map(|((p, area), value)| p * area * value).sum()
        };
        let wanted = self.prescribed();
        let v = sweep::displacement(&self.coefficients, &self.sites, &self.pressure);
        // The last digits of the load, or of the penetration, by scaling the pressure.
        let scale = match control {
            Control::MeanPressure(mean) => mean / self.mean_pressure(),
            Control::Penetration(_) => weighted(&self.pressure, &wanted) / weighted(&self.pressure, &v),
        };
        self.pressure.iter_mut().for_each(|p| *p *= scale);
        self.displace()?;
        let v = sweep::displacement(&self.coefficients, &self.sites, &self.pressure);
        let gap: Vec<f64> = v.iter().zip(&wanted).map(|(v, wanted)| v - wanted).collect();
        let mean_pressure = self.mean_pressure();
        let mean_gap = weighted(&self.pressure, &gap) / mean_pressure;

        let lowering = self.penetration - self.problem.h_max;
        let mut field = self.displacement;
        for (g, h) in field.values_mut().iter_mut().zip(self.pyramid[0].values()) {
            *g -= h + lowering + mean_gap;
        }
        let outside = field.values().iter().zip(&self.contact).filter(|&(_, &contact)| !contact).map(|(&g, _)| g);
        let least = gap.iter().map(|g| g - mean_gap).chain(outside).fold(f64::INFINITY, f64::min);
        let error = (-least / self.problem.h_range).max(0.0);
        let load = match control {
            Control::MeanPressure(wanted) => (mean_pressure - wanted).abs() / wanted,
            Control::Penetration(_) => mean_gap.abs() / self.problem.h_range,
        };
        let certificate = Certificate { complementarity: error, penetration: error, load };
        let info = SolveInfo {
            certificate,
            mean_pressure,
            penetration: self.penetration + mean_gap,
            penetration_full_contact: self.problem.h_max - self.problem.h_mean,
            elastic_energy: 0.5 * weighted(&self.pressure, &v),
            levels: vec![self.info],
            coarser: None,
        };
        let pressure = self.mesh.to_field(&self.pressure, self.info.grid)?;
        let elements = Some(MeshPressure { mesh: self.mesh, pressure: self.pressure });
        let within = error <= self.params.tolerance && load <= Certificate::LOAD_TOLERANCE;
        let converged = self.settled && within && pressure.min() >= 0.0;
        let status = if converged { Status::Converged } else { Status::NotConverged };
        let solution = GridSolution { pressure, gap: field, status, elements, info };
        if converged {
            return Ok(solution);
        }
        let (grid, iterations) = (self.info.grid, self.info.iterations);
        Err(IterationError::NotConverged { grid, iterations, certificate, solution: Box::new(solution) }.into())
    }
}
