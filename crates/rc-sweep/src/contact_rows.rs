//! Solver of rows that are contact problems.

use std::marker::PhantomData;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use rc_core::Silent;
use rc_solver::{Plan, SolveError};

use crate::content::Cells;
use crate::latest::Latest;
use crate::problems::RowProblems;
use crate::results::{RowResults, SolvedRow};
use crate::row::Row;
use crate::row_solver::{RowError, RowSolver};

/// Rows whose problems are known, with the surface that was made last.
///
/// The loads of a surface follow one another.
pub(crate) struct Planner<'a, P: RowProblems<R>, R: Row> {
    problems: &'a P,
    latest: Latest<SurfaceOfLoads<P::Surface>>,
    rows: PhantomData<fn(&R)>,
}

/// A surface, and the data that its loads share.
struct SurfaceOfLoads<S> {
    surface: S,
    /// The plan of the first load.
    ///
    /// `None` if the surface has one load alone, whose solve may then free what it no longer needs.
    first: Option<Mutex<Option<Plan<'static>>>>,
}

/// A surface, and the time that was needed to make it.
type Made<S> = (Arc<SurfaceOfLoads<S>>, Duration);

impl<'a, P: RowProblems<R>, R: Row> Planner<'a, P, R> {
    pub(crate) fn new(problems: &'a P) -> Self {
        Self { problems, latest: Latest::default(), rows: PhantomData }
    }

    /// The surface of `row`, made now unless the last row shares it.
    fn surface(&self, row: &R) -> Result<Made<P::Surface>, P::Error> {
        let number = row.shared_surface();
        let make =
            || Ok(SurfaceOfLoads { surface: self.problems.surface(row)?, first: number.map(|_| Mutex::default()) });
        if let Some(number) = number {
            return self.latest.get(number, make);
        }
        let started = Instant::now();
        let made = Arc::new(make()?);
        Ok((made, started.elapsed()))
    }

    /// The plan of `contact` on `loaded`, with what the first load has prepared.
    fn plan(&self, loaded: &SurfaceOfLoads<P::Surface>, contact: &P::Contact) -> Result<Plan<'static>, P::Error> {
        let Some(first) = &loaded.first else { return self.first_plan(&loaded.surface, contact) };
        // Even if a worker panicked, the stored plan is complete or absent.
        let mut first = first.lock().unwrap_or_else(PoisonError::into_inner);
        let control = self.problems.problem(&loaded.surface, contact)?.control;
        let plan = match first.take() {
            Some(plan) => plan,
            None => self.first_plan(&loaded.surface, contact)?,
        };
        let of_load = first.insert(plan).under(control);
        of_load.map_err(|error| self.problems.refused(&loaded.surface, contact, error))
    }

    fn first_plan(&self, surface: &P::Surface, contact: &P::Contact) -> Result<Plan<'static>, P::Error> {
        let plan = self.problems.problem(surface, contact)?.plan();
        let plan = plan.map_err(|error| self.problems.refused(surface, contact, error))?;
        self.problems.check(surface, contact, &plan)?;
        Ok(plan)
    }

    /// Expected processor time of `row` (s).
    ///
    /// `None` if it is not known, or if the row will be refused.
    pub(crate) fn seconds(&self, row: &R) -> Option<f64> {
        let (loaded, _) = self.surface(row).ok()?;
        let contact = self.problems.contact(row).ok()?;
        let plan = self.plan(&loaded, &contact).ok()?;
        self.problems.seconds(&loaded.surface, &contact, &plan)
    }
}

/// Solver of rows.
pub(crate) struct ContactRows<'a, P: RowProblems<R>, T, R: Row> {
    planner: Planner<'a, P, R>,
    results: &'a T,
}

impl<'a, P: RowProblems<R>, T: RowResults<P, R>, R: Row> ContactRows<'a, P, T, R> {
    pub(crate) fn new(problems: &'a P, results: &'a T) -> Self {
        Self { planner: Planner::new(problems), results }
    }

    fn cells(&self, row: &R) -> Result<Cells, P::Error> {
        let problems = self.planner.problems;
        let contact = problems.contact(row)?;
        let (loaded, time) = self.planner.surface(row)?;
        let started = Instant::now().checked_sub(time).unwrap_or_else(Instant::now);
        let solution = match self.planner.plan(&loaded, &contact)?.solve(&Silent) {
            Ok(solution) => solution,
            // A row that did not converge is kept. Its status says so.
            Err(SolveError::NotConverged { solution, .. }) => *solution,
            Err(error) => return Err(problems.refused(&loaded.surface, &contact, error)),
        };
        let solved = SolvedRow { solution, wall: started.elapsed() };
        self.results.cells(row, &loaded.surface, &contact, solved)
    }
}

impl<P: RowProblems<R>, T: RowResults<P, R>, R: Row> RowSolver<R> for ContactRows<'_, P, T, R> {
    type Error = P::Error;

    fn solve(&self, row: &R) -> Result<Cells, RowError<P::Error>> {
        self.cells(row).map_err(|error| self.results.failed(row, error))
    }

    fn row_kept(&self) {
        self.results.row_kept();
    }

    fn should_stop(&self) -> bool {
        self.results.should_stop()
    }
}
