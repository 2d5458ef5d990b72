//! Where the time of a solve goes, for benchmarks.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// A step of a solve. The rest of a solve prepares levels and moves vectors between them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// Heights on the elements of a level, and their coarsening.
    Heights,
    /// Tables of the kernels.
    Kernels,
    /// Residuals of the active elements, and steps along directions.
    Residuals,
    /// L on directions, in single precision, with the work on vectors before and after it.
    Directions,
    /// The approximate inverse of L on residuals, with the sums over its result.
    Preconditioner,
    /// The projection to the bounds and the load, with L on the changes.
    Projection,
    /// Gaps from a fresh application of L.
    FreshGaps,
    /// Bounds that exclude contact, and the choice of elements.
    Exclusion,
}

impl Step {
    /// All steps, in the order of a solve.
    pub const ALL: [Self; 8] = [
        Self::Heights,
        Self::Kernels,
        Self::Residuals,
        Self::Directions,
        Self::Preconditioner,
        Self::Projection,
        Self::FreshGaps,
        Self::Exclusion,
    ];

    /// The name of the step in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Heights => "heights",
            Self::Kernels => "tables of the kernels",
            Self::Residuals => "residuals and steps",
            Self::Directions => "L on directions",
            Self::Preconditioner => "preconditioner",
            Self::Projection => "projection, with L on changes",
            Self::FreshGaps => "fresh gaps",
            Self::Exclusion => "exclusion and choice of elements",
        }
    }
}

/// Nanoseconds of each step while a record is made. They are of the process, because a record is.
static NANOSECONDS: [AtomicU64; Step::ALL.len()] = [const { AtomicU64::new(0) }; Step::ALL.len()];
static IS_RECORDING: AtomicBool = AtomicBool::new(false);

/// The result of `work`, and the wall time of each step of the solves in it, in the order of [`Step::ALL`].
///
/// Solves that run at the same time in other threads are counted too, so that a benchmark solves one problem at a time.
/// Otherwise nothing is measured, and a step costs the read of a flag.
pub fn record_steps<R>(work: impl FnOnce() -> R) -> (R, [Duration; Step::ALL.len()]) {
    for step in &NANOSECONDS {
        step.store(0, Ordering::Relaxed);
    }
    IS_RECORDING.store(true, Ordering::Relaxed);
    let result = work();
    IS_RECORDING.store(false, Ordering::Relaxed);
    (result, NANOSECONDS.each_ref().map(|step| Duration::from_nanos(step.load(Ordering::Relaxed))))
}

/// The time from [`Step::begin`] to the end of a scope.
#[must_use]
pub(crate) struct Running(Option<(Step, Instant)>);

impl Step {
    /// Begins the step, which ends with the scope of the result. Steps are not begun within each other.
    pub(crate) fn begin(self) -> Running {
        Running(IS_RECORDING.load(Ordering::Relaxed).then(|| (self, Instant::now())))
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        if let Some((step, start)) = self.0 {
            let nanoseconds = u64::try_from(start.elapsed().as_nanos()).unwrap_or(u64::MAX);
            NANOSECONDS[step as usize].fetch_add(nanoseconds, Ordering::Relaxed);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_record_has_the_steps_of_its_work_alone() {
        let wait = |step: Step| {
            let _running = step.begin();
            std::thread::sleep(Duration::from_millis(5));
        };
        wait(Step::Heights);
        let ((), steps) = record_steps(|| wait(Step::Exclusion));
        wait(Step::Exclusion);
        let of = |step: Step| steps[step as usize];
        assert!(of(Step::Exclusion) >= Duration::from_millis(5), "{steps:?}");
        assert!(Step::ALL.iter().enumerate().all(|(i, &step)| step as usize == i), "the order of all");
    }
}
