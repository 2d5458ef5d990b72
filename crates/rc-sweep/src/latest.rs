//! A costly value that consecutive rows share.

use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// The value that was made last, with its key.
///
/// The value is, for example, a surface. Its loads follow one another, so one surface at a time is enough for all
/// workers.
#[derive(Debug)]
pub(crate) struct Latest<T>(Mutex<Option<Made<T>>>);

/// A value, with the time that was needed to make it.
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
    /// The value for `key`, and the time that was needed to make it.
    ///
    /// `make` is called unless the last value has this key.
    ///
    /// # Errors
    /// Those of `make`.
    pub(crate) fn get<E>(&self, key: usize, make: impl FnOnce() -> Result<T, E>) -> Result<(Arc<T>, Duration), E> {
        // A worker that panicked has stored nothing, so the value is still valid.
        let mut latest = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(made) = latest.as_ref().filter(|made| made.key == key) {
            return Ok((Arc::clone(&made.value), made.time));
        }
        let started = Instant::now();
        // The previous value is released first.
        *latest = None;
        let value = Arc::new(make()?);
        let time = started.elapsed();
        *latest = Some(Made { key, value: Arc::clone(&value), time });
        Ok((value, time))
    }
}
