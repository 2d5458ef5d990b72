//! Steps (i) to (vi) of the procedure of Sec. 2.
//!
//! The procedure solves Eq. 4 on the elements in contact.

use rc_core::{Boundary, Event, Field, Observer, Operator, Snapshot};
use rc_quadtree::paper::{Key, Mask, Mesh, MeshKind, MeshParams, transfer};

use crate::descent::info::LevelInfo;
use crate::grid::coarser::{Pits, coarsen, halved};
use crate::grid::uniform_operator::UniformOperator;
use crate::paper::coefficients::{Coefficients, Site};
use crate::paper::error::GaussSeidelError;
use crate::paper::estimate::{LARGEST_DOUBLINGS, mesh_kind, mesh_params};
use crate::paper::half_space::HalfSpace;
use crate::paper::params::GaussSeidelParams;
use crate::paper::sweep;
use crate::paper::sweep::Limits;
use crate::problem::checked::Problem;
use crate::problem::control::Control;

/// Tolerance of all increments but the last. They only prepare the contact of the last one.
const EARLY_TOLERANCE: f64 = 1e-4;

/// Part of a tolerance that Gauss-Seidel may leave as a residual of v.
///
/// The rest is for penetration.
const RESIDUAL_SHARE: f64 = 0.1;

/// First residual of v, relative to the height range, while the contact is being found.
const FIRST_RESIDUAL: f64 = 1e-4;

/// Maximum number of steps in the search for the penetration of a given mean pressure.
const MOST_SECANT_STEPS: usize = 30;

/// The state between increments.
pub(super) struct Procedure<'a> {
    /// Heights at the centres of elements of 1, 2, 4, … finest elements.
    ///
    /// The first are the heights themselves.
    pub(super) pyramid: Vec<Field>,
    pub(super) problem: &'a Problem,
    /// Tolerance relative to the height range.
    tolerance: f64,
    params: &'a GaussSeidelParams,
    observer: &'a dyn Observer,
    pub(super) coefficients: Coefficients<'a>,
    operator: UniformOperator,
    kind: MeshKind,
    mesh_params: MeshParams,
    pub(super) penetration: f64,
    /// Whether each cell of the finest grid is in contact.
    pub(super) contact: Vec<bool>,
    /// Displacement on the finest grid.
    pub(super) displacement: Field,
    pub(super) mesh: Mesh,
    pub(super) sites: Vec<Site>,
    pub(super) pressure: Vec<f64>,
    pub(super) info: LevelInfo,
    /// Whether the last double check left the contact as it was.
    pub(super) settled: bool,
}

impl<'a> Procedure<'a> {
    pub(super) fn new(
        heights: &Field,
        half_space: HalfSpace<'a>,
        problem: &'a Problem,
        (tolerance, params): (f64, &'a GaussSeidelParams),
        observer: &'a dyn Observer,
    ) -> Result<Self, GaussSeidelError> {
        let grid = heights.grid();
        let side = grid.nx();
        let mut pyramid = vec![heights.clone()];
        let coarser = halved(grid, 1).take(LARGEST_DOUBLINGS as usize);
        pyramid.extend(coarsen(heights, Boundary::Periodic, Pits::Kept, coarser));
        // Elements are at most as large as those whose heights are known.
        let mut mesh_params = mesh_params(side, params.ring);
        mesh_params.base = mesh_params.base.max(side >> (pyramid.len() - 1));
        let kind = mesh_kind(params);
        let contact = vec![false; grid.len()];
        let mesh = Mesh::from_mask(&Mask::new(side, contact.clone())?, kind, &mesh_params)?;
        Ok(Self {
            pyramid,
            problem,
            tolerance,
            params,
            observer,
            coefficients: Coefficients::new(half_space.coefficient, side as u32, params.memory_budget),
            operator: UniformOperator::new(grid, half_space.kernel),
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

    /// Step (i): increases Δ in increments.
    ///
    /// Only the last increment is solved to the tolerance, and only if Δ is prescribed.
    pub(super) fn increase_to(&mut self, penetration: f64) -> Result<(), GaussSeidelError> {
        let (grid, steps) = (self.info.grid, self.params.increments);
        for step in 1..=steps {
            self.observer.notify(&Event::Level { grid, level: step - 1, n_levels: steps });
            let early = step < steps || matches!(self.problem.bounds.control, Control::MeanPressure(_));
            let tolerance = if early { self.tolerance.max(EARLY_TOLERANCE) } else { self.tolerance };
            self.settle(step as f64 / steps as f64 * penetration, tolerance)?;
            if self.observer.should_stop() {
                break;
            }
        }
        Ok(())
    }

    /// Finds the penetration at which the mean pressure is `mean`.
    ///
    /// The search starts from the `expected` penetration.
    pub(super) fn search(&mut self, mean: f64, expected: f64) -> Result<(), GaussSeidelError> {
        let full = self.problem.h_max - self.problem.h_mean;
        self.increase_to(expected.min(0.999 * full))?;
        let mut bracket = Bracket { low: (0.0, 0.0), high: (full, f64::INFINITY) };
        for _ in 0..MOST_SECANT_STEPS {
            if self.observer.should_stop() {
                break;
            }
            let here = (self.penetration, self.mean_pressure());
            let off = (here.1 / mean - 1.0).abs();
            if off <= self.tolerance {
                return self.settle(here.0, self.tolerance);
            }
            let next = bracket.next(here, mean);
            // The tolerance follows the error of the load, until that is small.
            let tolerance = if off < self.tolerance.sqrt() { 0.0 } else { 1e-2 * off };
            self.settle(next, tolerance.clamp(self.tolerance, EARLY_TOLERANCE))?;
        }
        Ok(())
    }

    /// Mean pressure over the cell.
    pub(super) fn mean_pressure(&self) -> f64 {
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
            self.report_pressure();
            let unchanged = removed + added == 0;
            self.settled = unchanged && residual <= wanted;
            // This comes after the first sweeps, so that there is a result to return.
            if self.observer.should_stop() {
                self.settled = false;
                break;
            }
            if self.settled {
                break;
            }
            // While the contact still changes, v may differ from the prescribed values in its last digits.
            if removed + added <= self.mesh.len() / 100 {
                residual = wanted.max(0.1 * residual);
            }
        }
        Ok(())
    }

    /// Lets the observer look at the pressure.
    fn report_pressure(&self) {
        let rows = |take: &mut dyn FnMut(&[f64])| {
            let field = self.mesh.to_field(&self.pressure, self.info.grid);
            take(field.expect("a value for each element").values());
        };
        self.observer.look(&Snapshot::new(self.info.grid, &rows));
    }

    /// Steps (iii) and (iv): meshes the contact and relaxes the pressure.
    ///
    /// v is then as prescribed, to `residual`.
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
    pub(super) fn prescribed(&self) -> Vec<f64> {
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

    /// Step (v): computes the displacement everywhere.
    pub(super) fn displace(&mut self) -> Result<(), GaussSeidelError> {
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

    /// Brings cells out of contact that penetrate by more than `slack` into contact.
    ///
    /// Returns their number.
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
}

/// Two penetrations with their mean pressures: one of too little load and one of too much.
struct Bracket {
    low: (f64, f64),
    high: (f64, f64),
}

impl Bracket {
    /// Narrows the bracket to `here`, and returns the penetration to try next.
    ///
    /// It lies on the chord to the other end, or to the origin while the bracket has no upper end.
    fn next(&mut self, here: (f64, f64), mean: f64) -> f64 {
        let other = if here.1 < mean && self.high.1.is_finite() { self.high } else { self.low };
        if here.1 < mean {
            self.low = here;
        } else {
            self.high = here;
        }
        let chord = here.0 + (mean - here.1) * (here.0 - other.0) / (here.1 - other.1);
        let inside = chord > self.low.0 && chord < self.high.0;
        if inside { chord } else { f64::midpoint(self.low.0, self.high.0) }
    }
}
