//! A running computation: without the lock of the interpreter, ended by Ctrl-C, seen by a function of the caller.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::time::{Duration, Instant};

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use rayon::ThreadPool;
use rc_core::{Event, Observer};

use crate::pools::Pool;

/// How often the calling thread looks for signals.
const LOOK: Duration = Duration::from_millis(20);

/// How a computation is run.
pub(crate) struct Run<'py> {
    /// Worker threads; 0 for all cores.
    pub(crate) threads: usize,
    /// When it ends with what there is.
    pub(crate) end: Option<Instant>,
    /// Called with numbers of each event: level, levels, nx, ny, iteration, error, tolerance, elements in contact.
    pub(crate) progress: Option<Bound<'py, PyAny>>,
}

/// What ends a computation early, and where its events go.
pub(crate) struct Watched<'a, T> {
    stop: &'a AtomicBool,
    end: Option<Instant>,
    events: Option<Sender<Message<T>>>,
}

/// What comes from the threads of a computation.
enum Message<T> {
    Event(Event),
    Done(T),
}

impl<T: Send> Observer for Watched<'_, T> {
    fn notify(&self, event: &Event) {
        if let Some(events) = &self.events {
            // The receiver is there until the computation ends.
            let _ = events.send(Message::Event(*event));
        }
    }

    fn should_stop(&self) -> bool {
        self.stop.load(Ordering::Relaxed) || self.end.is_some_and(|end| Instant::now() >= end)
    }
}

/// Runs `work` on its threads, without the lock of the interpreter. Returns what it returned, the number of threads, and what ended it early:
/// the exception of a signal handler, as `KeyboardInterrupt`, or of the function that sees progress.
pub(crate) fn run<T: Send>(
    py: Python<'_>,
    run: Run<'_>,
    work: impl FnOnce(&Watched<'_, T>) -> T + Send,
) -> PyResult<(T, usize, Option<PyErr>)> {
    let Run { threads, end, progress } = run;
    let progress = progress.map(Bound::unbind);
    py.detach(move || {
        let pool = Pool::take(threads).map_err(|cause| PyRuntimeError::new_err(format!("threads: {cause}")))?;
        let (value, ended) = on_pool(pool.threads(), end, progress.as_ref(), work);
        let value = value.ok_or_else(|| PyRuntimeError::new_err("the computation ended without a result"))?;
        Ok((value, pool.threads().current_num_threads(), ended))
    })
}

/// Runs `work` on a pool, while this thread hands events to `progress` and looks for signals.
fn on_pool<T: Send>(
    pool: &ThreadPool,
    end: Option<Instant>,
    progress: Option<&Py<PyAny>>,
    work: impl FnOnce(&Watched<'_, T>) -> T + Send,
) -> (Option<T>, Option<PyErr>) {
    let stop = &AtomicBool::new(false);
    let (sender, receiver) = mpsc::channel();
    let events = progress.map(|_| sender.clone());
    let mut ended = None;
    let value = pool.in_place_scope(|scope| {
        scope.spawn(move |_| {
            let watched = Watched { stop, end, events };
            let value = work(&watched);
            let _ = sender.send(Message::Done(value));
        });
        let mut calls = Calls { progress, level: (0, 1), grid: (0, 0) };
        loop {
            let looked = match receiver.recv_timeout(LOOK) {
                Ok(Message::Done(value)) => return Some(value),
                // Only when the computation panics, which the scope passes on.
                Err(RecvTimeoutError::Disconnected) => return None,
                _ if ended.is_some() => Ok(()),
                Ok(Message::Event(event)) => Python::attach(|py| {
                    calls.tell(py, event)?;
                    py.check_signals()
                }),
                Err(RecvTimeoutError::Timeout) => Python::attach(look_for_signals),
            };
            if let Err(error) = looked {
                stop.store(true, Ordering::Relaxed);
                ended = Some(error);
            }
        }
    });
    (value, ended)
}

/// Runs the handlers of signals that have come; that of Ctrl-C raises an exception.
fn look_for_signals(py: Python<'_>) -> PyResult<()> {
    py.check_signals()
}

/// Calls of the function that sees progress; an iteration does not say on which level it is.
struct Calls<'a> {
    progress: Option<&'a Py<PyAny>>,
    level: (usize, usize),
    grid: (usize, usize),
}

impl Calls<'_> {
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
