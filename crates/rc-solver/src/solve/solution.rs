//! What a solve returns, whatever the method.

use std::convert::Infallible;
use std::sync::OnceLock;

use rc_comm::Ranks;
use rc_core::{Field, Grid, Kernel, Operator};

use super::elements;
use super::response::{KernelOfGrid, Response};
use crate::adaptive::{AdaptiveProblem, AdaptiveSolution, Receiver, Rows};
use crate::gap_part::GapPart;
use crate::solution::{GridSolution, Status};
use crate::{Certificate, ContactArea, ContactElement, ErrorBound, Method, MethodReason, Observables, SolveInfo};

/// A solved contact problem.
///
/// Pressures are in E*, lengths in λ, areas relative to the nominal area. Fields are on [`Solution::grid`]. Those of the adaptive method
/// are made when they are first asked for; [`Solution::pressure_rows`] and [`Solution::gap_rows`] never hold them whole.
///
/// Over ranks ([`crate::ContactProblem::over`]) each has a part. All of them call the functions of a solution together; each gets the same numbers, rows go to
/// the first of them, and elements are those of the rank.
pub struct Solution<'a> {
    how: HowSolved,
    status: Status,
    h_max: f64,
    pressures: Pressures<'a>,
    pressure: OnceLock<Field>,
    gap: OnceLock<Field>,
    plastic_gap: OnceLock<Field>,
    displacement: OnceLock<Field>,
    observables: OnceLock<Observables>,
    stiffness: OnceLock<f64>,
}

/// What a solution keeps of its plan.
#[derive(Clone, Debug)]
pub(super) struct HowSolved {
    pub(super) method: Method,
    pub(super) reason: MethodReason,
    pub(super) bound: ErrorBound,
    pub(super) kernel: &'static str,
    /// The greatest pressure; infinite for an elastic contact.
    pub(super) hardness: f64,
}

impl HowSolved {
    pub(super) fn new(method: Method, reason: MethodReason, bound: ErrorBound, kernel: &'static str) -> Self {
        Self { method, reason, bound, kernel, hardness: f64::INFINITY }
    }

    pub(super) fn with_hardness(self, hardness: f64) -> Self {
        Self { hardness, ..self }
    }
}

/// Pressures on the grid, or on the tiles that contact touches.
enum Pressures<'a> {
    Grid {
        solution: GridSolution,
        response: Response<'a>,
    },
    Tiles {
        solution: AdaptiveSolution,
        /// What it solves, heights included.
        problem: Box<AdaptiveProblem<'a>>,
    },
}

impl<'a> Solution<'a> {
    /// Of a method that stores every element of the grid.
    pub(super) fn on_grid(how: HowSolved, kernel: &'a dyn Kernel, solution: GridSolution, h_max: f64) -> Self {
        Self::of_grid(how, Response::Kernel(KernelOfGrid::Borrowed(kernel)), solution, h_max)
    }

    /// Of an operator of the caller.
    pub(super) fn with_operator(
        how: HowSolved,
        operator: &'a dyn Operator,
        solution: GridSolution,
        h_max: f64,
    ) -> Self {
        Self::of_grid(how, Response::Operator(operator), solution, h_max)
    }

    fn of_grid(how: HowSolved, response: Response<'a>, solution: GridSolution, h_max: f64) -> Self {
        let status = solution.status;
        Self::new(how, status, h_max, Pressures::Grid { solution, response })
    }

    /// Of the adaptive method.
    pub(super) fn on_tiles(how: HowSolved, solution: AdaptiveSolution, problem: Box<AdaptiveProblem<'a>>) -> Self {
        let (status, h_max) = (solution.status(), problem.h_max());
        Self::new(how, status, h_max, Pressures::Tiles { solution, problem })
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

    /// The same solution without borrows. The adaptive method's keeps a copy of a map, and that of a grid the symbol of its kernel. With an
    /// operator, displacement and stiffness are computed now.
    #[must_use]
    pub fn into_owned(self) -> Solution<'static> {
        let pressures = match self.pressures {
            Pressures::Grid { solution, response } => {
                let response = response.into_owned(&solution);
                Pressures::Grid { solution, response }
            }
            Pressures::Tiles { solution, problem } => {
                Pressures::Tiles { solution, problem: Box::new(problem.into_owned()) }
            }
        };
        let Self { how, status, h_max, pressure, gap, plastic_gap, displacement, observables, stiffness, .. } = self;
        Solution { how, status, h_max, pressures, pressure, gap, plastic_gap, displacement, observables, stiffness }
    }

    /// The same solution without borrows, with the kernel that it was solved with. Nothing is tabulated then.
    #[must_use]
    pub fn into_owned_with(self, kernel: &'static dyn Kernel) -> Solution<'static> {
        match self.pressures {
            Pressures::Grid { solution, response: Response::Kernel(KernelOfGrid::Borrowed(_)) } => {
                let pressures =
                    Pressures::Grid { solution, response: Response::Kernel(KernelOfGrid::Borrowed(kernel)) };
                let Self {
                    how, status, h_max, pressure, gap, plastic_gap, displacement, observables, stiffness, ..
                } = self;
                Solution {
                    how,
                    status,
                    h_max,
                    pressures,
                    pressure,
                    gap,
                    plastic_gap,
                    displacement,
                    observables,
                    stiffness,
                }
            }
            pressures => Self { pressures, ..self }.into_owned(),
        }
    }

    /// How the solve ended.
    #[must_use]
    pub fn status(&self) -> Status {
        self.status
    }

    /// The method.
    #[must_use]
    pub fn method(&self) -> Method {
        self.how.method
    }

    /// Why it was this one.
    #[must_use]
    pub fn reason(&self) -> &MethodReason {
        &self.how.reason
    }

    /// What the certificate had to meet.
    #[must_use]
    pub fn bound(&self) -> ErrorBound {
        self.how.bound
    }

    /// Name of the kernel; `operator` for an operator of the caller.
    #[must_use]
    pub fn kernel(&self) -> &'static str {
        self.how.kernel
    }

    /// How the solution was found and how good it is: certificate, load, penetration, energy, and the work on each level.
    #[must_use]
    pub fn info(&self) -> &SolveInfo {
        match &self.pressures {
            Pressures::Grid { solution, .. } => &solution.info,
            Pressures::Tiles { solution, .. } => &solution.info,
        }
    }

    /// Residuals from a fresh application of L on the returned pressure, for the whole cell.
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

    /// The grid of the smallest elements: finer than [`Solution::grid`] where a border level was asked for.
    pub(super) fn finest_grid(&self) -> Grid {
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

    /// Area, pressure, gap, energy.
    #[must_use]
    pub fn observables(&self) -> &Observables {
        self.observables.get_or_init(|| match &self.pressures {
            Pressures::Grid { solution, response } => {
                Observables::of(solution, self.how.hardness, response.edge_bias())
            }
            Pressures::Tiles { solution, .. } => solution.observables(),
        })
    }

    /// Contact stiffness dσ0/dΔ at fixed contact area, in E*/λ, to 1e-3 relative; infinite in full contact. What is plastic stays so, and adds nothing. Takes a few applications of L
    /// the first time.
    #[must_use]
    pub fn stiffness(&self) -> f64 {
        *self.stiffness.get_or_init(|| match &self.pressures {
            Pressures::Grid { .. } if self.status == Status::FullContact => f64::INFINITY,
            Pressures::Grid { solution, response } => response.stiffness(solution, self.how.hardness),
            Pressures::Tiles { solution, problem } => problem.contact_stiffness(solution),
        })
    }

    /// Hands out the elements of [`Solution::elements`], over ranks those of all of them to the first, in order. Stops at the first error.
    ///
    /// # Errors
    /// What `take` returns.
    pub fn each_element<E>(&self, take: impl FnMut(ContactElement) -> Result<(), E>) -> Result<(), E> {
        let elements = self.elements().into_iter().flatten();
        elements::each_of_ranks(elements, &self.ranks(), take)
    }

    /// Number of elements that carry unknowns: those in contact on an adaptive mesh, all of a uniform grid.
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

    /// The elements of a mesh that is not the grid itself, those in contact with their pressures; `None` for the uniform method.
    #[must_use]
    pub fn elements(&self) -> Option<Box<dyn Iterator<Item = ContactElement> + '_>> {
        match &self.pressures {
            Pressures::Grid { solution, .. } => solution.elements.as_ref().map(|mesh| Box::new(mesh.elements()) as _),
            Pressures::Tiles { solution, .. } => Some(Box::new(solution.elements())),
        }
    }

    /// Elements of the grid whose gap the certificate computed.
    #[must_use]
    pub fn n_evaluated(&self) -> usize {
        match &self.pressures {
            Pressures::Grid { solution, .. } => solution.pressure.grid().len(),
            Pressures::Tiles { solution, .. } => solution.evaluated,
        }
    }

    /// Elements of the grid that are proven to be out of contact without computing their gap: all others.
    #[must_use]
    pub fn n_proven(&self) -> usize {
        match &self.pressures {
            Pressures::Grid { .. } => 0,
            Pressures::Tiles { solution, .. } => solution.proven,
        }
    }

    /// The pressure on the grid, in E*, ≥ 0. On smaller elements it is their mean.
    #[must_use]
    pub fn pressure(&self) -> &Field {
        match &self.pressures {
            Pressures::Grid { solution, .. } => &solution.pressure,
            Pressures::Tiles { .. } => {
                self.pressure.get_or_init(|| self.collect(self.grid(), |take| self.pressure_rows(take)))
            }
        }
    }

    /// The greatest pressure, in E*; infinite for an elastic contact.
    #[must_use]
    pub fn hardness(&self) -> f64 {
        self.how.hardness
    }

    /// The gap on the grid, in λ, with its pressure-weighted mean at zero; zero in contact within the tolerance. With a hardness it is that after
    /// plastic flow.
    #[must_use]
    pub fn gap(&self) -> &Field {
        match &self.pressures {
            Pressures::Grid { solution, .. } if self.how.hardness.is_infinite() => &solution.gap,
            _ => self.gap.get_or_init(|| self.collect(self.grid(), |take| self.gap_rows(take))),
        }
    }

    /// The gap on the grid of the smallest elements, in λ, as [`Solution::gap`]; `None` where that is [`Solution::grid`], which it is without
    /// a border level. Takes one application of L on that grid each time.
    #[must_use]
    pub fn finest_gap(&self) -> Option<Field> {
        match &self.pressures {
            Pressures::Tiles { solution, problem } if self.finest_grid() != self.grid() => {
                Some(self.collect(self.finest_grid(), |take| {
                    problem.gap_rows(solution, GapPart::Open, Rows::finest(), take)
                }))
            }
            _ => None,
        }
    }

    /// The overlap that plastic flow has removed, on the grid, in λ, ≥ 0; zero where the pressure is below the hardness, and everywhere
    /// without one.
    #[must_use]
    pub fn plastic_gap(&self) -> &Field {
        self.plastic_gap.get_or_init(|| self.collect(self.grid(), |take| self.plastic_gap_rows(take)))
    }

    /// The displacement v on the grid, in λ, of mean zero. Takes one application of L the first time.
    #[must_use]
    pub fn displacement(&self) -> &Field {
        self.displacement.get_or_init(|| match &self.pressures {
            Pressures::Grid { solution, response } => response.displacement(&solution.pressure),
            Pressures::Tiles { solution, problem } => {
                self.collect(self.grid(), |take| problem.displacement_rows(solution, Receiver::First, take))
            }
        })
    }

    /// Hands out [`Solution::pressure`] in order, some rows at a time: the index of the first row, and the rows one after the other. Stops
    /// at the first error.
    ///
    /// # Errors
    /// What `take` returns.
    pub fn pressure_rows<E>(&self, mut take: impl FnMut(usize, &[f64]) -> Result<(), E>) -> Result<(), E> {
        match (&self.pressures, self.pressure.get()) {
            (Pressures::Grid { solution, .. }, _) => take(0, solution.pressure.values()),
            (_, Some(pressure)) => take(0, pressure.values()),
            (Pressures::Tiles { solution, .. }, None) => solution.pressure_rows(Receiver::First, take),
        }
    }

    /// The same over ranks, with some rows for each rank: those that it takes follow each other, and those of the next rank follow them.
    ///
    /// # Errors
    /// What `take` returns.
    pub fn own_pressure_rows<E>(&self, take: impl FnMut(usize, &[f64]) -> Result<(), E>) -> Result<(), E> {
        match &self.pressures {
            Pressures::Grid { .. } => self.pressure_rows(take),
            Pressures::Tiles { solution, .. } => solution.pressure_rows(Receiver::Each, take),
        }
    }

    /// Hands out [`Solution::gap`] as [`Solution::pressure_rows`] does the pressure, for the adaptive method at about the cost of one
    /// application of L on the whole grid.
    ///
    /// # Errors
    /// What `take` returns.
    pub fn gap_rows<E>(&self, mut take: impl FnMut(usize, &[f64]) -> Result<(), E>) -> Result<(), E> {
        match (&self.pressures, self.gap.get()) {
            (Pressures::Grid { solution, .. }, _) if self.how.hardness.is_infinite() => take(0, solution.gap.values()),
            (_, Some(gap)) => take(0, gap.values()),
            _ => self.part_rows(GapPart::Open, Receiver::First, take),
        }
    }

    /// Hands out [`Solution::plastic_gap`] as [`Solution::gap_rows`] does the gap.
    ///
    /// # Errors
    /// What `take` returns.
    pub fn plastic_gap_rows<E>(&self, mut take: impl FnMut(usize, &[f64]) -> Result<(), E>) -> Result<(), E> {
        match self.plastic_gap.get() {
            Some(gap) => take(0, gap.values()),
            None => self.part_rows(GapPart::Plastic, Receiver::First, take),
        }
    }

    /// The same over ranks, as [`Solution::own_pressure_rows`] does it.
    ///
    /// # Errors
    /// What `take` returns.
    pub fn own_gap_rows<E>(&self, take: impl FnMut(usize, &[f64]) -> Result<(), E>) -> Result<(), E> {
        self.part_rows(GapPart::Open, Receiver::Each, take)
    }

    /// The ranks that have solved it, all of which call its functions together.
    #[must_use]
    pub fn ranks(&self) -> Ranks {
        match &self.pressures {
            Pressures::Grid { .. } => Ranks::alone(),
            Pressures::Tiles { problem, .. } => problem.ranks().clone(),
        }
    }

    /// A field on `grid` from its rows, which `rows` hands out in order.
    fn collect(
        &self,
        grid: Grid,
        rows: impl FnOnce(&mut dyn FnMut(usize, &[f64]) -> Result<(), Infallible>) -> Result<(), Infallible>,
    ) -> Field {
        let mut values = Vec::with_capacity(grid.len());
        let Ok(()) = rows(&mut |_, rows| {
            values.extend_from_slice(rows);
            Ok(())
        });
        // Rows go to the first rank, fields to all.
        let values = self.ranks().concatenate(values);
        Field::new(grid, values).expect("as many values as the grid has elements")
    }

    /// Hands out a part of the gap.
    fn part_rows<E>(
        &self,
        part: GapPart,
        receiver: Receiver,
        take: impl FnMut(usize, &[f64]) -> Result<(), E>,
    ) -> Result<(), E> {
        match &self.pressures {
            Pressures::Grid { solution, .. } => part.rows((&solution.gap, &solution.pressure), self.how.hardness, take),
            Pressures::Tiles { solution, problem } => problem.gap_rows(solution, part, Rows::on_grid(receiver), take),
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
