//! The function that shears a solved contact.

use rc_core::{Boundary, DVec2, Grid, Observer};

use crate::descent::info::Status;
use crate::parallel::in_pool;
use crate::problem::capabilities::{Feature, refusal};
use crate::problem::control::Control;
use crate::problem::tolerance::ErrorBound;
use crate::shear::error::{SMALLEST_PART, ShearError};
use crate::shear::operator::{self, TangentialOperator};
use crate::shear::params::{ShearControl, ShearParams};
use crate::shear::problem::{Contact, Prescribed};
use crate::shear::rounds::{Rounds, Tractions};
use crate::shear::solution::{ShearInfo, ShearSolution};
use crate::solution::whole::Solution;
use crate::solve::features::features;
use crate::solve::plan::Plan;

/// Bytes for each element of the grid: both pressures, tractions, displacements, and vectors of the rounds.
const BYTES_PER_ELEMENT: u64 = 160;

/// Bound on the energy error of the tractions, if the tolerance of the solve is relative to the height.
const OF_RELATIVE: f64 = 1e-2;

/// Relative distance to the disc's border within which an element slips.
const AT_LIMIT: f64 = 1e-9;

impl Plan<'_> {
    /// Shears the solved contact `normal` of this problem.
    ///
    /// The plan is one of the same problem, as [`Plan::under`] makes it, and its load is not used. The normal contact
    /// keeps its pressure. A second one under the load σ0 - τ/μ gives the traction μ (p - p'), which for ν = 0 is exact.
    /// It is corrected by projected gradients until [`ShearInfo::error`] is at most the tolerance of the energy error,
    /// or 0.01 if the tolerance is relative to the height.
    ///
    /// ```
    /// use rc_core::{Field, Grid, Silent};
    /// use rc_solver::{ContactProblem, Control, ShearParams, SolveParams};
    ///
    /// // Half of Westergaard's wave touches, and a third where the shear leaves a quarter of the load.
    /// let wave = Field::from_fn(Grid::square(128)?, |at| 1e-3 * (std::f64::consts::TAU * at.x).cos());
    /// let load = 0.5e-3 * std::f64::consts::PI;
    /// let plan = ContactProblem::new(&wave, Control::MeanPressure(load)).plan(&SolveParams::default())?;
    /// let again = plan.under(Control::MeanPressure(load))?;
    /// let normal = plan.solve(&Silent)?;
    /// let sheared = again.shear(&normal, &ShearParams::new(0.4, 0.4 * 0.5 * load), &Silent)?;
    /// assert!((sheared.info.stick_area - 1.0 / 3.0).abs() < 0.02);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`ShearError`]. Non-convergence is an error too, and contains the best solution found.
    pub fn shear(
        &self,
        normal: &Solution<'_>,
        params: &ShearParams,
        observer: &dyn Observer,
    ) -> Result<ShearSolution, ShearError> {
        in_pool(|| self.shear_here(normal, params, observer))
    }

    fn shear_here(
        &self,
        normal: &Solution<'_>,
        params: &ShearParams,
        observer: &dyn Observer,
    ) -> Result<ShearSolution, ShearError> {
        check(params)?;
        let mut all = features(&self.problem, &self.params);
        all.push(Feature::Shear);
        if let Some(refused) = refusal(&all, Some(normal.method())) {
            return Err(refused.into());
        }
        let compliance = Compliance::of(params, self.problem.heights.grid(), self.problem.boundary());
        let load = smaller_load(normal, params, compliance.ratio)?;
        let contact = Contact::new(normal.pressure(), params.friction, self.problem.boundary());
        self.check_memory(contact.part())?;
        let smaller = self.under(load)?.solve(observer)?;
        let solution = self.sheared((&contact, [normal, &smaller]), (params, compliance), observer);
        let tolerance = tolerance(self.bound);
        if solution.info.error <= tolerance {
            Ok(solution)
        } else {
            Err(ShearError::NotConverged { tolerance, solution: Box::new(solution) })
        }
    }

    /// The tractions between the normal contacts under both loads.
    fn sheared(
        &self,
        (contact, [normal, smaller]): (&Contact, [&Solution<'_>; 2]),
        (params, compliance): (&ShearParams, Compliance),
        observer: &dyn Observer,
    ) -> ShearSolution {
        let &ShearParams { friction, control, direction, poisson } = params;
        let pressures = [normal.pressure(), smaller.pressure()].map(|pressure| contact.values(pressure));
        let mut start: Vec<DVec2> =
            pressures[0].iter().zip(&pressures[1]).map(|(p, q)| friction * (p - q) * direction).collect();
        let difference = friction * (normal.info().penetration - smaller.info().penetration);
        let prescribed = match control {
            ShearControl::MeanShear(shear) => Prescribed::Total(shear * contact.n_grid() as f64 * direction),
            ShearControl::Displacement(given) => Prescribed::Displacement(given * direction),
        };
        let operator = TangentialOperator::new((normal.grid(), contact.part()), self.problem.kernel.get(), poisson);
        let rounds = Rounds { operator: &operator, contact, prescribed };
        rounds.project(&mut start);
        let mut found = rounds.certified(start, compliance.ratio * difference * direction);
        // A uniform traction displaces nothing.
        let is_uniform = smaller.status() == Status::FullContact;
        let tolerance = tolerance(self.bound);
        if !is_uniform && found.bound.error() > tolerance {
            found = rounds.correct(found, tolerance, observer);
        }
        let displacement = match control {
            ShearControl::Displacement(given) => given,
            ShearControl::MeanShear(_) if compliance.is_exact => compliance.ratio * difference,
            ShearControl::MeanShear(_) => found.bound.displacement.dot(direction),
        };
        let slips = slips(contact, &found.vectors);
        let area = normal.area().fraction;
        let stick_area = if compliance.is_exact {
            smaller.area().fraction.min(area)
        } else {
            area * slips.iter().filter(|slips| !**slips).count() as f64 / slips.len().max(1) as f64
        };
        let info = ShearInfo {
            friction,
            mean_shear: found.vectors.iter().sum::<DVec2>().dot(direction) / contact.n_grid() as f64,
            displacement,
            slip_area: area - stick_area,
            stick_area,
            stiffness: normal.stiffness() / compliance.ratio,
            slip_work: 0.0,
            error: if is_uniform { 0.0 } else { found.bound.error() },
            rounds: found.rounds,
        };
        with_fields(info, direction, contact, (&found, &slips))
    }

    /// Refuses fields that do not fit into memory.
    fn check_memory(&self, part: Grid) -> Result<(), ShearError> {
        let grid = self.problem.heights.grid();
        let period = if self.problem.boundary() == Boundary::Free { operator::padded_grid(part) } else { grid };
        let needed = period.len() as u64 * operator::BYTES_PER_ELEMENT + grid.len() as u64 * BYTES_PER_ELEMENT;
        match self.params.memory_limit {
            Some(limit) if needed > limit => Err(ShearError::Memory { grid, needed, limit }),
            _ => Ok(()),
        }
    }
}

/// Tangential against normal compliance.
#[derive(Clone, Copy)]
struct Compliance {
    /// Their ratio along the shear.
    ratio: f64,
    /// Whether it is that of every wave, so that two normal contacts are the answer.
    is_exact: bool,
}

impl Compliance {
    /// Waves of a profile are all along it: it is sheared in plane strain along them, and in antiplane strain across them.
    fn of(params: &ShearParams, grid: Grid, boundary: Boundary) -> Self {
        let &ShearParams { poisson, direction, .. } = params;
        if grid.ny() > 1 || boundary == Boundary::Free {
            return Self { ratio: params.compliance_ratio(), is_exact: poisson == 0.0 };
        }
        let across = direction.y * direction.y;
        let is_axis = direction.x == 0.0 || direction.y == 0.0;
        Self { ratio: 1.0 - across + across / (1.0 - poisson), is_exact: poisson == 0.0 || is_axis }
    }
}

/// The load of the second contact.
fn smaller_load(normal: &Solution<'_>, params: &ShearParams, compliance_ratio: f64) -> Result<Control, ShearError> {
    let info = normal.info();
    match params.control {
        ShearControl::MeanShear(shear) => {
            let limit = params.friction * info.mean_pressure;
            let left = info.mean_pressure - shear / params.friction;
            check_part(shear, limit)?;
            if shear < limit && left > 0.0 {
                Ok(Control::MeanPressure(left))
            } else {
                Err(ShearError::Sliding { shear, limit })
            }
        }
        ShearControl::Displacement(displacement) => {
            let per_depth = params.friction * compliance_ratio;
            // In full contact the penetration does not grow with the load.
            let is_full = normal.status() == Status::FullContact;
            let depth = if is_full { info.penetration.min(info.penetration_full_contact) } else { info.penetration };
            let left = depth - displacement / per_depth;
            check_part(displacement, per_depth * depth)?;
            if left > 0.0 {
                Ok(Control::Penetration(left))
            } else {
                Err(ShearError::SlipsAll { displacement, limit: per_depth * depth })
            }
        }
    }
}

/// Refuses a shear or displacement that rounding would hide beside the one at which the surface slides.
fn check_part(value: f64, limit: f64) -> Result<(), ShearError> {
    let least = SMALLEST_PART * limit;
    if value >= least { Ok(()) } else { Err(ShearError::TooSmall { value, least }) }
}

/// The bound on the error of the tractions.
fn tolerance(bound: ErrorBound) -> f64 {
    match bound {
        ErrorBound::Energy(value) => value,
        ErrorBound::Relative(_) => OF_RELATIVE,
    }
}

/// Whether each element slips.
fn slips(contact: &Contact, tractions: &[DVec2]) -> Vec<bool> {
    tractions.iter().zip(&contact.limits).map(|(t, limit)| t.length() >= limit * (1.0 - AT_LIMIT)).collect()
}

/// The solution with its fields and the work of the slip.
fn with_fields(
    info: ShearInfo,
    direction: DVec2,
    contact: &Contact,
    (found, slips): (&Tractions, &[bool]),
) -> ShearSolution {
    let lengths: Vec<f64> = found
        .displacements
        .iter()
        .zip(slips)
        .map(|(v, slips)| if *slips { (found.bound.displacement - *v).length() } else { 0.0 })
        .collect();
    let work: f64 = lengths.iter().zip(&contact.limits).map(|(slip, limit)| slip * limit).sum();
    let info = ShearInfo { slip_work: work / contact.n_grid() as f64, ..info };
    let slip = contact.field(lengths.into_iter());
    ShearSolution { info, direction, traction: contact.fields(&found.vectors), slip }
}

fn check(params: &ShearParams) -> Result<(), ShearError> {
    let &ShearParams { friction, control, direction, poisson } = params;
    let (name, shear) = match control {
        ShearControl::MeanShear(value) => ("the mean shear", value),
        ShearControl::Displacement(value) => ("the shear displacement", value),
    };
    let positive = "positive and finite";
    let checks = [
        ("the coefficient of friction", friction, friction > 0.0 && friction.is_finite(), positive),
        (name, shear, shear > 0.0 && shear.is_finite(), positive),
        ("the length of the direction of shear", direction.length(), (direction.length() - 1.0).abs() < 1e-9, "1"),
        ("Poisson's ratio", poisson, poisson > -1.0 && poisson <= 0.5, "above -1 and at most 0.5"),
    ];
    match checks.into_iter().find(|(.., is_right, _)| !is_right) {
        Some((name, value, _, wanted)) => Err(ShearError::Parameter { name, value, wanted }),
        None => Ok(()),
    }
}
