//! The result of a solve, for all methods.

use std::sync::OnceLock;

use rc_comm::Ranks;
use rc_core::{Field, Grid};

use crate::descent::certificate::Certificate;
use crate::descent::contact_element::ContactElement;
use crate::descent::info::{SolveInfo, Status};
use crate::parallel::in_pool;
use crate::problem::bounds::Bounds;
use crate::problem::capabilities::Feature;
use crate::problem::control::Control;
use crate::problem::method::Method;
use crate::problem::method_reason::MethodReason;
use crate::problem::summit::Summit;
use crate::problem::tolerance::ErrorBound;
use crate::solution::contact_area::area::ContactArea;
use crate::solution::elements;
use crate::solution::observables::Observables;
use crate::solution::solved::Solved;

/// A solved contact problem.
///
/// Pressures are in E*, lengths in λ, areas relative to the nominal area. Fields are on [`Solution::grid`]. With the
/// adaptive method, fields are made when they are first requested. [`Solution::pressure_rows`] and
/// [`Solution::gap_rows`] never store a whole field.
///
/// Over ranks ([`crate::ContactProblem::over`]), each rank has a part. All ranks call the functions of a solution
/// together, and get the same numbers. [`Solution::pressure_rows`] and the like pass all rows on the first rank, and
/// none on the others. [`Solution::own_pressure_rows`] and [`Solution::own_gap_rows`] pass the rows of the calling
/// rank. [`Solution::elements`] returns the elements of the calling rank only.
pub struct Solution<'a> {
    pub(crate) how: HowSolved,
    summit: Summit,
    pub(crate) solved: Box<dyn Solved + 'a>,
    pub(crate) computed: Computed,
}

/// What is computed when it is first requested.
#[derive(Default)]
pub(crate) struct Computed {
    pub(crate) pressure: OnceLock<Field>,
    pub(crate) gap: OnceLock<Field>,
    pub(crate) plastic_gap: OnceLock<Field>,
    pub(crate) displacement: OnceLock<Field>,
    /// The observables, and the error of the penetration at the load.
    observables: OnceLock<(Observables, f64)>,
    stiffness: OnceLock<f64>,
    conductance: OnceLock<f64>,
    least_rise: OnceLock<Option<f64>>,
}

/// The parts of its plan that a solution keeps.
#[derive(Clone, Debug)]
pub(crate) struct HowSolved {
    pub(crate) method: Method,
    pub(crate) reason: MethodReason,
    pub(crate) bound: ErrorBound,
    pub(crate) kernel: &'static str,
    /// The load. The hardness, which limits the pressure, is infinite for an elastic contact.
    pub(crate) asked: Bounds,
}

/// Relative errors of the conductance from its solve, for a solution that has converged and for others.
const CONDUCTANCE: f64 = 1.3e-3;
const ROUGH_CONDUCTANCE: f64 = 0.05;

impl<'a> Solution<'a> {
    /// The solution of a solved level.
    pub(crate) fn new(how: HowSolved, summit: Summit, solved: Box<dyn Solved + 'a>) -> Self {
        Self { how, summit, solved, computed: Computed::default() }
    }

    /// The same solution without borrows.
    ///
    /// A solution of the adaptive method keeps a copy of a map. A solution on a grid keeps a copy of its kernel
    /// ([`rc_core::Kernel::to_shared`]). If there is none, displacement and stiffness are computed now.
    #[must_use]
    pub fn into_owned(self) -> Solution<'static> {
        let Self { how, summit, solved, computed } = self;
        Solution { how, summit, solved: solved.into_owned(), computed }
    }

    /// How the solve ended.
    #[must_use]
    pub fn status(&self) -> Status {
        self.solved.status()
    }

    /// The method that has solved the problem.
    #[must_use]
    pub fn method(&self) -> Method {
        self.how.method
    }

    /// The reason why this method was chosen.
    #[must_use]
    pub fn reason(&self) -> &MethodReason {
        &self.how.reason
    }

    /// The bound that the certificate had to meet.
    #[must_use]
    pub fn bound(&self) -> ErrorBound {
        self.how.bound
    }

    /// Name of the kernel, or `operator` for an operator of the caller.
    #[must_use]
    pub fn kernel(&self) -> &'static str {
        self.how.kernel
    }

    /// How the solution was found, and how good it is.
    ///
    /// The result contains the certificate, load, penetration, energy, and the work on each level.
    #[must_use]
    pub fn info(&self) -> &SolveInfo {
        self.solved.info()
    }

    /// Bounds on the error, from a fresh application of L on the returned pressure.
    #[must_use]
    pub fn certificate(&self) -> Certificate {
        self.info().certificate
    }

    /// The grid of the fields.
    #[must_use]
    pub fn grid(&self) -> Grid {
        self.solved.grid()
    }

    /// The grid of the smallest elements.
    ///
    /// It is finer than [`Solution::grid`] if a border level was requested.
    pub(crate) fn finest_grid(&self) -> Grid {
        self.solved.finest_grid()
    }

    /// Maximum height on the grid of the smallest elements, in λ.
    #[must_use]
    pub fn h_max(&self) -> f64 {
        self.summit.sampled
    }

    /// Estimated height of the true maximum above [`Solution::h_max`], in λ, ≥ 0. It lies between samples.
    ///
    /// Surfaces are evaluated there. For a map, parabolas are fitted to its heights.
    #[must_use]
    pub fn summit_excess(&self) -> f64 {
        self.summit.excess
    }

    /// Estimated discretisation error of the penetration at this load, in λ.
    ///
    /// It is the sum of [`Solution::summit_excess`], by which a penetration from the highest sample is too small, and of
    /// [`Observables::mean_gap_error`]; where contact reaches a free border, also of the error of the depth that the gap
    /// does not show. Under a given penetration, the load has the error that this penetration causes
    /// ([`Solution::mean_pressure_error`]).
    #[must_use]
    pub fn penetration_error(&self) -> f64 {
        self.with_penetration_error().1
    }

    /// Estimated discretisation error of the mean pressure, in E*. `None` under a given load.
    ///
    /// It is [`Solution::stiffness`] times [`Solution::penetration_error`], and `None` where the stiffness is infinite.
    #[must_use]
    pub fn mean_pressure_error(&self) -> Option<f64> {
        match self.how.asked.control {
            Control::MeanPressure(_) => None,
            Control::Penetration(_) => {
                Some(self.stiffness() * self.penetration_error()).filter(|error| error.is_finite())
            }
        }
    }

    /// The contact area with its error bar.
    #[must_use]
    pub fn area(&self) -> ContactArea {
        self.observables().area
    }

    /// The observables: area, pressure, gap, energy.
    #[must_use]
    pub fn observables(&self) -> &Observables {
        &self.with_penetration_error().0
    }

    fn with_penetration_error(&self) -> &(Observables, f64) {
        self.computed.observables.get_or_init(|| {
            let observables = self.here_or_in_pool(|| self.solved.observables());
            let of_depth = observables.mean_gap_error.hypot(observables.hidden_depth_error(self.info()));
            let error = self.summit.excess + of_depth;
            match self.how.asked.control {
                Control::MeanPressure(_) => (observables, error),
                Control::Penetration(_) => {
                    let load_error = self.stiffness() * error / self.info().mean_pressure.max(f64::MIN_POSITIVE);
                    (observables.with_load_error(load_error, error), error)
                }
            }
        })
    }

    /// The result of `work` in a thread of the pool, unless it may wait there: for other ranks, or in an operator of the
    /// caller.
    fn here_or_in_pool<R: Send>(&self, work: impl FnOnce() -> R + Send) -> R {
        let waits = self.ranks().size() > 1 || self.solved.features().contains(&Feature::OwnOperator);
        if waits { work() } else { in_pool(work) }
    }

    /// Contact stiffness dσ0/dΔ at fixed contact area, in E*/λ.
    ///
    /// It is computed to 1e-3 relative, or less accurately with an operator of the caller
    /// ([`crate::solve_with_operator`]), and to a few percent if the solve did not converge. The stiffness is infinite
    /// in full contact with the half-space. Plastic elements keep their pressure and do not contribute. The first call
    /// takes a few applications of L.
    #[must_use]
    pub fn stiffness(&self) -> f64 {
        *self.computed.stiffness.get_or_init(|| self.here_or_in_pool(|| self.solved.stiffness()))
    }

    /// The smallest dp/dσ0 in an elastic contact at rest, at this load. `None` if the kernel makes no copy of itself, and
    /// with an operator of the caller.
    ///
    /// The pressure of a half-space rises by at least the load wherever there is contact, so it is at least 1. On a layer
    /// it may be less. Where it is negative, a growing load relieves a point, and the creep of Lee and Radok pulls there.
    #[must_use]
    pub fn least_pressure_rise(&self) -> Option<f64> {
        *self.computed.least_rise.get_or_init(|| self.here_or_in_pool(|| self.solved.least_rise()))
    }

    /// Electrical or thermal conductance of the contact spots for unit conductivity, per nominal area, in 1/λ.
    ///
    /// All spots have one potential, and no current crosses elsewhere (Holm). The current spreads in half-spaces. It is
    /// then [`Solution::stiffness`] of an elastic half-space (Barber, Proc. R. Soc. A 459, 2003, 53), and one more
    /// linear solve with plastic elements, which conduct like others, or on a layer. It is infinite in full contact.
    #[must_use]
    pub fn conductance(&self) -> f64 {
        let of_spots = || self.here_or_in_pool(|| self.solved.conductance());
        *self.computed.conductance.get_or_init(|| of_spots().unwrap_or_else(|| self.stiffness()))
    }

    /// Estimated error of [`Solution::conductance`] from the mesh and from its solve, in 1/λ.
    #[must_use]
    pub fn conductance_error(&self) -> f64 {
        let of_solve = if self.status() == Status::NotConverged { ROUGH_CONDUCTANCE } else { CONDUCTANCE };
        let (area, conductance) = (self.area(), self.conductance());
        let at_border = area.relative_error_at_border(conductance, self.info().mean_pressure);
        conductance * area.relative_error_of_width().hypot(of_solve).hypot(at_border)
    }

    /// Passes the elements of [`Solution::elements`] to `take`, in order.
    ///
    /// Over ranks, the first rank gets the elements of all ranks. Stops at the first error.
    ///
    /// # Errors
    /// The error that `take` returns.
    pub fn each_element<E>(&self, take: impl FnMut(ContactElement) -> Result<(), E>) -> Result<(), E> {
        let elements = self.elements().into_iter().flatten();
        elements::each_of_ranks(elements, &self.ranks(), take)
    }

    /// The hardness, which limits the pressure, in E*. Infinite for an elastic contact.
    #[must_use]
    pub fn hardness(&self) -> f64 {
        self.how.asked.hardness
    }

    /// The ranks that solved the problem. All of them call the functions of this solution together.
    #[must_use]
    pub fn ranks(&self) -> Ranks {
        self.solved.ranks()
    }

    /// Number of elements on which the solution states a pressure.
    ///
    /// For the uniform method, these are all elements of the grid. For the adaptive and the Gauss-Seidel method, these
    /// are the elements in contact. Elsewhere the pressure is zero.
    #[must_use]
    pub fn n_elements(&self) -> usize {
        self.solved.counts().stated
    }

    /// Number of elements in contact.
    #[must_use]
    pub fn n_in_contact(&self) -> usize {
        self.solved.counts().in_contact
    }

    /// The elements in contact, with their pressures, if the mesh is not the grid.
    ///
    /// `None` for the uniform method. The adaptive and the Gauss-Seidel method have a mesh.
    #[must_use]
    pub fn elements(&self) -> Option<Box<dyn Iterator<Item = ContactElement> + '_>> {
        self.solved.elements()
    }

    /// Number of elements whose gap the certificate computed.
    ///
    /// With border levels, they have several sizes.
    #[must_use]
    pub fn n_evaluated(&self) -> usize {
        self.solved.counts().evaluated
    }

    /// Number of elements of the smallest size that are proven to be out of contact.
    ///
    /// Their gap was not computed. They are the rest of the cell.
    #[must_use]
    pub fn n_proven(&self) -> usize {
        self.solved.counts().proven
    }
}

impl std::fmt::Debug for Solution<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mut out = f.debug_struct("Solution");
        out.field("how", &self.how).field("status", &self.status()).field("grid", &self.grid());
        out.field("info", self.info()).finish_non_exhaustive()
    }
}
