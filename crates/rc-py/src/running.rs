//! Running computations, without the lock of the interpreter.
//!
//! Ctrl-C ends them, and a function of the caller sees their progress.

use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::thread::Result as Outcome;
use std::time::{Duration, Instant};

use pyo3::exceptions::{PyKeyboardInterrupt, PyRuntimeError};
use pyo3::prelude::*;
use rc_core::{Event, Observer};

use crate::pools::Pool;

/// Time between two looks for signals on the calling thread.
const LOOK: Duration = Duration::from_millis(20);

/// Time to wait, after a signal, for a solve that was told to stop.
pub(crate) const GRACE: Duration = Duration::from_millis(100);

/// Settings of a computation.
pub(crate) struct Run<'py> {
    /// Worker threads; 0 for all cores.
    pub(crate) threads: usize,
    /// Time at which it ends with what it has.
    pub(crate) end: Option<Instant>,
    /// Function that is called with the numbers of each event.
    ///
    /// These are level, levels, nx, ny, iteration, error, tolerance, and elements in contact.
    pub(crate) progress: Option<Bound<'py, PyAny>>,
    /// Time for which it may continue after a signal.
    ///
    /// Then the caller no longer waits for it.
    pub(crate) grace: Duration,
}

/// The observer of a computation, which can stop it and passes on its events.
pub(crate) struct Watched<T> {
    stop: Arc<AtomicBool>,
    end: Option<Instant>,
    events: Option<Sender<Message<T>>>,
}

/// Messages from the threads of a computation.
enum Message<T> {
    Event(Event),
    Done(Outcome<T>),
}

impl<T: Send> Observer for Watched<T> {
    fn notify(&self, event: &Event) {
        if let Some(events) = &self.events {
            // If the caller no longer waits for the computation, nobody receives the event.
            let _ = events.send(Message::Event(*event));
        }
    }

    fn should_stop(&self) -> bool {
        self.stop.load(Ordering::Relaxed) || self.end.is_some_and(|end| Instant::now() >= end)
    }
}

/// The end of a computation.
pub(crate) enum Ended<T> {
    /// It ended with a value.
    ///
    /// `early` is the exception that ended it early, if any. It is from a signal handler, for instance
    /// `KeyboardInterrupt`, or from the function that sees progress.
    Done { value: T, early: Option<PyErr> },
    /// A signal came, but the computation has not yet seen that it must stop. It continues on its own until it does.
    Left { early: PyErr, rest: Rest<T> },
}

/// A computation that continues on its own.
pub(crate) struct Rest<T>(Receiver<Message<T>>);

impl<T: Send> Rest<T> {
    /// Waits for the value. Another signal ends the wait.
    pub(crate) fn wait(&mut self, py: Python<'_>) -> PyResult<T> {
        let receiver = &mut self.0;
        py.detach(move || {
            loop {
                match receiver.recv_timeout(LOOK) {
                    Ok(Message::Done(outcome)) => return Ok(outcome.unwrap_or_else(|panic| resume_unwind(panic))),
                    Ok(Message::Event(_)) => {}
                    Err(RecvTimeoutError::Timeout) => Python::attach(look_for_signals)?,
                    Err(RecvTimeoutError::Disconnected) => return Err(without_a_result()),
                }
            }
        })
    }
}

/// Runs `work` on threads, without the lock of the interpreter.
///
/// A signal or an exception of `progress` tells it to stop. Returns how it ended, and the number of threads.
///
/// # Errors
/// When threads cannot be started.
pub(crate) fn run<T: Send + 'static>(
    py: Python<'_>,
    run: Run<'_>,
    work: impl FnOnce(&Watched<T>) -> T + Send + 'static,
) -> PyResult<(Ended<T>, usize)> {
    let Run { threads, end, progress, grace } = run;
    let progress = progress.map(Bound::unbind);
    py.detach(move || {
        let pool = take_pool(threads)?;
        let threads = pool.threads().current_num_threads();
        let stop = Arc::new(AtomicBool::new(false));
        let (sender, receiver) = mpsc::channel();
        let watched = Watched { stop: Arc::clone(&stop), end, events: progress.is_some().then(|| sender.clone()) };
        pool.threads().spawn(move || {
            // A panic is passed on to the caller. In this thread it would end the process.
            let outcome = catch_unwind(AssertUnwindSafe(|| work(&watched)));
            let _ = sender.send(Message::Done(outcome));
        });
        let ended = wait(receiver, (&stop, grace), progress.as_ref())?;
        if matches!(ended, Ended::Left { .. }) {
            pool.leave();
        }
        Ok((ended, threads))
    })
}

/// Runs `work` on `threads` threads, 0 for all cores, and returns its value.
///
/// A signal ends the wait for it.
pub(crate) fn on_threads<T: Send + 'static>(
    py: Python<'_>,
    threads: usize,
    work: impl FnOnce() -> T + Send + 'static,
) -> PyResult<T> {
    match run(py, Run { threads, end: None, progress: None, grace: Duration::ZERO }, move |_| work())?.0 {
        Ended::Done { value, early: None } => Ok(value),
        Ended::Done { early: Some(early), .. } | Ended::Left { early, .. } => Err(early),
    }
}

/// Runs `work`, which may borrow, on `threads` threads to its end.
///
/// Signals are handled after it.
pub(crate) fn to_end<T: Send>(py: Python<'_>, threads: usize, work: impl FnOnce() -> T + Send) -> PyResult<T> {
    py.detach(|| Ok(take_pool(threads)?.threads().install(work)))
}

fn take_pool(threads: usize) -> PyResult<Pool> {
    Pool::take(threads).map_err(|cause| PyRuntimeError::new_err(format!("threads: {cause}")))
}

fn without_a_result() -> PyErr {
    PyRuntimeError::new_err("the computation ended without a result")
}

/// Runs the handlers of signals that have come. The handler of Ctrl-C raises an exception.
fn look_for_signals(py: Python<'_>) -> PyResult<()> {
    py.check_signals()
}

/// Passes events to `progress` and looks for signals, until the computation ends or is left.
fn wait<T>(
    receiver: Receiver<Message<T>>,
    (stop, grace): (&AtomicBool, Duration),
    progress: Option<&Py<PyAny>>,
) -> PyResult<Ended<T>> {
    let mut calls = Calls { progress, level: (0, 1), grid: (0, 0) };
    let mut early: Option<PyErr> = None;
    let mut leave_at: Option<Instant> = None;
    loop {
        let event = match receiver.recv_timeout(LOOK) {
            Ok(Message::Done(Ok(value))) => return Ok(Ended::Done { value, early }),
            Ok(Message::Done(Err(panic))) => resume_unwind(panic),
            Err(RecvTimeoutError::Disconnected) => return Err(early.unwrap_or_else(without_a_result)),
            Ok(Message::Event(event)) => Some(event),
            Err(RecvTimeoutError::Timeout) => None,
        };
        let looked = Python::attach(|py| calls.look(py, event.filter(|_| early.is_none())));
        if let Err((error, is_signal)) = looked {
            stop.store(true, Ordering::Relaxed);
            early = Some(error);
            if is_signal {
                leave_at.get_or_insert_with(|| Instant::now() + grace);
            }
        }
        if leave_at.is_some_and(|at| Instant::now() >= at)
            && let Some(early) = early.take()
        {
            return Ok(Ended::Left { early, rest: Rest(receiver) });
        }
    }
}

/// Calls of the function that sees progress.
///
/// It keeps the level, since the event of an iteration does not have it.
struct Calls<'a> {
    progress: Option<&'a Py<PyAny>>,
    level: (usize, usize),
    grid: (usize, usize),
}

impl Calls<'_> {
    /// Reports an event, and runs the handlers of signals that have come.
    ///
    /// An error has the exception of either, and whether it is from a signal.
    fn look(&mut self, py: Python<'_>, event: Option<Event>) -> Result<(), (PyErr, bool)> {
        if let Some(event) = event {
            self.tell(py, event).map_err(|error| {
                // The signal may have come while the function ran.
                let is_signal = error.is_instance_of::<PyKeyboardInterrupt>(py);
                (error, is_signal)
            })?;
        }
        py.check_signals().map_err(|error| (error, true))
    }

    fn tell(&mut self, py: Python<'_>, event: Event) -> PyResult<()> {
        let Some(progress) = self.progress else { return Ok(()) };
        let (iteration, error, tolerance, n_contact) = match event {
            Event::Level { grid, level, n_levels } => {
                (self.level, self.grid) = ((level + 1, n_levels), (grid.nx(), grid.ny()));
                (0, f64::NAN, f64::NAN, 0)
            }
            Event::Iteration { iteration, error, tolerance, n_contact } => (iteration, error, tolerance, n_contact),
            _ => return Ok(()),
        };
        let ((level, n_levels), (nx, ny)) = (self.level, self.grid);
        progress.call1(py, (level, n_levels, nx, ny, iteration, error, tolerance, n_contact))?;
        Ok(())
    }
}
