//! The result of a solve, for all methods.

use std::sync::OnceLock;

use rc_comm::Ranks;
use rc_core::{Field, Grid, Operator};

use crate::descent::certificate::Certificate;
use crate::descent::contact_element::ContactElement;
use crate::descent::info::SolveInfo;
use crate::descent::info::{GridSolution, Status};
use crate::levels::adaptive::AdaptiveProblem;
use crate::problem::kernel::OwnedKernel;
use crate::problem::method::Method;
use crate::problem::method_reason::MethodReason;
use crate::problem::tolerance::ErrorBound;
use crate::solution::contact_area::area::ContactArea;
use crate::solution::observables::Observables;
use crate::solve::elements;
use crate::solve::response::Response;
use crate::tiles::solution::AdaptiveSolution;

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
    pub(crate) status: Status,
    pub(crate) h_max: f64,
    pub(crate) pressures: Pressures<'a>,
    pub(crate) pressure: OnceLock<Field>,
    pub(crate) gap: OnceLock<Field>,
    pub(crate) plastic_gap: OnceLock<Field>,
    pub(crate) displacement: OnceLock<Field>,
    observables: OnceLock<Observables>,
    stiffness: OnceLock<f64>,
}

/// The parts of its plan that a solution keeps.
#[derive(Clone, Debug)]
pub(crate) struct HowSolved {
    pub(crate) method: Method,
    pub(crate) reason: MethodReason,
    pub(crate) bound: ErrorBound,
    pub(crate) kernel: &'static str,
    /// The limit of the pressure. Infinite for an elastic contact.
    pub(crate) hardness: f64,
}

impl HowSolved {
    pub(crate) fn new(method: Method, reason: MethodReason, bound: ErrorBound, kernel: &'static str) -> Self {
        Self { method, reason, bound, kernel, hardness: f64::INFINITY }
    }

    pub(crate) fn with_hardness(self, hardness: f64) -> Self {
        Self { hardness, ..self }
    }
}

/// Pressures on the grid, or on the tiles that contact touches.
pub(crate) enum Pressures<'a> {
    Grid {
        solution: Box<GridSolution>,
        response: Response<'a>,
    },
    Tiles {
        solution: Box<AdaptiveSolution>,
        /// The problem that was solved, with its heights.
        problem: Box<AdaptiveProblem<'a>>,
    },
}

impl<'a> Solution<'a> {
    /// The solution of a method that stores fields on the whole grid.
    pub(crate) fn on_grid(how: HowSolved, kernel: OwnedKernel<'a>, solution: GridSolution, h_max: f64) -> Self {
        Self::of_grid(how, Response::Kernel(kernel), solution, h_max)
    }

    /// The solution with an operator of the caller.
    pub(crate) fn with_operator(
        how: HowSolved,
        operator: &'a dyn Operator,
        solution: GridSolution,
        h_max: f64,
    ) -> Self {
        Self::of_grid(how, Response::Operator(operator), solution, h_max)
    }

    fn of_grid(how: HowSolved, response: Response<'a>, solution: GridSolution, h_max: f64) -> Self {
        let status = solution.status;
        Self::new(how, status, h_max, Pressures::Grid { solution: Box::new(solution), response })
    }

    /// The solution of the adaptive method.
    pub(crate) fn on_tiles(how: HowSolved, solution: AdaptiveSolution, problem: Box<AdaptiveProblem<'a>>) -> Self {
        let (status, h_max) = (solution.status(), problem.h_max());
        Self::new(how, status, h_max, Pressures::Tiles { solution: Box::new(solution), problem })
    }

    fn new(how: HowSolved, status: Status, h_max: f64, pressures: Pressures<'a>) -> Self {
        Self {
            how,
            status,
            h_max,
            pressures,
            pressure: OnceLock::new(),
            gap: OnceLock::new(),
            plastic_gap: OnceLock::new(),
            displacement: OnceLock::new(),
            observables: OnceLock::new(),
            stiffness: OnceLock::new(),
        }
    }

    /// The same solution without borrows.
    ///
    /// A solution of the adaptive method keeps a copy of a map. A solution on a grid keeps a copy of its kernel
    /// ([`rc_core::Kernel::to_shared`]). If there is none, displacement and stiffness are computed now.
    #[must_use]
    pub fn into_owned(self) -> Solution<'static> {
        let pressures = match self.pressures {
            Pressures::Grid { solution, response } => {
                let response = response.into_owned(&solution, self.how.hardness);
                Pressures::Grid { solution, response }
            }
            Pressures::Tiles { solution, problem } => {
                Pressures::Tiles { solution, problem: Box::new(problem.into_owned()) }
            }
        };
        let Self { how, status, h_max, pressure, gap, plastic_gap, displacement, observables, stiffness, .. } = self;
        Solution { how, status, h_max, pressures, pressure, gap, plastic_gap, displacement, observables, stiffness }
    }

    /// How the solve ended.
    #[must_use]
    pub fn status(&self) -> Status {
        self.status
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
        match &self.pressures {
            Pressures::Grid { solution, .. } => &solution.info,
            Pressures::Tiles { solution, .. } => &solution.info,
        }
    }

    /// Bounds on the error, from a fresh application of L on the returned pressure.
    #[must_use]
    pub fn certificate(&self) -> Certificate {
        self.info().certificate
    }

    /// The grid of the fields.
    #[must_use]
    pub fn grid(&self) -> Grid {
        match &self.pressures {
            Pressures::Grid { solution, .. } => solution.pressure.grid(),
            Pressures::Tiles { solution, .. } => solution.grid(),
        }
    }

    /// The grid of the smallest elements.
    ///
    /// It is finer than [`Solution::grid`] if a border level was requested.
    pub(crate) fn finest_grid(&self) -> Grid {
        match &self.pressures {
            Pressures::Grid { solution, .. } => solution.pressure.grid(),
            Pressures::Tiles { solution, .. } => solution.finest_grid(),
        }
    }

    /// Maximum height on the grid of the smallest elements, in λ.
    #[must_use]
    pub fn h_max(&self) -> f64 {
        self.h_max
    }

    /// The contact area with its error bar.
    #[must_use]
    pub fn area(&self) -> ContactArea {
        self.observables().area
    }

    /// The observables: area, pressure, gap, energy.
    #[must_use]
    pub fn observables(&self) -> &Observables {
        self.observables.get_or_init(|| match &self.pressures {
            Pressures::Grid { solution, response } => {
                let boundary = response.boundary(solution.pressure.grid());
                Observables::of(solution, self.how.hardness, response.edge_bias(), boundary)
            }
            Pressures::Tiles { solution, .. } => solution.observables(),
        })
    }

    /// Contact stiffness dσ0/dΔ at fixed contact area, in E*/λ.
    ///
    /// It is computed to 1e-3 relative, or less accurately with an operator of the caller
    /// ([`crate::solve_with_operator`]), and to a few percent if the solve did not converge. The stiffness is infinite
    /// in full contact with the half-space. Plastic elements keep their pressure and do not contribute. The first call
    /// takes a few applications of L.
    #[must_use]
    pub fn stiffness(&self) -> f64 {
        *self.stiffness.get_or_init(|| match &self.pressures {
            Pressures::Grid { solution, response } => response.stiffness(solution, self.how.hardness),
            Pressures::Tiles { solution, problem } => problem.contact_stiffness(solution),
        })
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
        self.how.hardness
    }

    /// The ranks that solved the problem. All of them call the functions of this solution together.
    #[must_use]
    pub fn ranks(&self) -> Ranks {
        match &self.pressures {
            Pressures::Grid { .. } => Ranks::alone(),
            Pressures::Tiles { problem, .. } => problem.ranks().clone(),
        }
    }

    /// Number of elements on which the solution states a pressure.
    ///
    /// For the uniform method, these are all elements of the grid. For the adaptive and the Gauss-Seidel method, these
    /// are the elements in contact. Elsewhere the pressure is zero.
    #[must_use]
    pub fn n_elements(&self) -> usize {
        match &self.pressures {
            Pressures::Grid { solution, .. } => solution.n_elements(),
            Pressures::Tiles { solution, .. } => solution.n_elements(),
        }
    }

    /// Number of elements in contact.
    #[must_use]
    pub fn n_in_contact(&self) -> usize {
        match &self.pressures {
            Pressures::Grid { solution, .. } => solution.n_in_contact(),
            Pressures::Tiles { solution, .. } => solution.n_elements(),
        }
    }

    /// The elements in contact, with their pressures, if the mesh is not the grid.
    ///
    /// `None` for the uniform method. The adaptive and the Gauss-Seidel method have a mesh.
    #[must_use]
    pub fn elements(&self) -> Option<Box<dyn Iterator<Item = ContactElement> + '_>> {
        match &self.pressures {
            Pressures::Grid { solution, .. } => solution.elements.as_ref().map(|mesh| Box::new(mesh.elements()) as _),
            Pressures::Tiles { solution, .. } => Some(Box::new(solution.elements())),
        }
    }

    /// Number of elements whose gap the certificate computed.
    ///
    /// With border levels, they have several sizes.
    #[must_use]
    pub fn n_evaluated(&self) -> usize {
        match &self.pressures {
            Pressures::Grid { solution, .. } => solution.pressure.grid().len(),
            Pressures::Tiles { solution, .. } => solution.evaluated,
        }
    }

    /// Number of elements of the smallest size that are proven to be out of contact.
    ///
    /// Their gap was not computed. They are the rest of the cell.
    #[must_use]
    pub fn n_proven(&self) -> usize {
        match &self.pressures {
            Pressures::Grid { .. } => 0,
            Pressures::Tiles { solution, .. } => solution.proven,
        }
    }
}

impl std::fmt::Debug for Solution<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mut out = f.debug_struct("Solution");
        out.field("how", &self.how).field("status", &self.status).field("grid", &self.grid());
        out.field("info", self.info()).finish_non_exhaustive()
    }
}
