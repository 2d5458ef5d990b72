//! Something costly that rows which follow one another share.

use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// The value that was made last, by its key: a surface, whose loads follow one another, so that one at a time serves
/// all workers.
#[derive(Debug)]
pub struct Latest<T>(Mutex<Option<Made<T>>>);

/// A value with the time that it took to make.
#[derive(Debug)]
struct Made<T> {
    key: usize,
    value: Arc<T>,
    time: Duration,
}

impl<T> Default for Latest<T> {
    fn default() -> Self {
        Self(Mutex::new(None))
    }
}

impl<T> Latest<T> {
    /// The value of `key`, and the time that it took to make once; `make` is called unless it is the latest.
    ///
    /// # Errors
    /// Those of `make`.
    pub fn get<E>(&self, key: usize, make: impl FnOnce() -> Result<T, E>) -> Result<(Arc<T>, Duration), E> {
        // A worker that panicked has stored nothing: the lock is as good as before.
        let mut latest = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(made) = latest.as_ref().filter(|made| made.key == key) {
            return Ok((Arc::clone(&made.value), made.time));
        }
        let started = Instant::now();
        // The one before is let go of first.
        *latest = None;
        let value = Arc::new(make()?);
        let time = started.elapsed();
        *latest = Some(Made { key, value: Arc::clone(&value), time });
        Ok((value, time))
    }
}
