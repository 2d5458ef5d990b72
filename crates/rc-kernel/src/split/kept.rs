//! Values that are made once for each set of parameters.
//!
//! They are kept as long as the process. Otherwise, many small problems would spend more time on these values than on
//! their solution.

use std::sync::{Mutex, PoisonError};

use super::SplitParams;

/// Maximum number of sets of parameters with kept values. Solvers use four.
const MOST: usize = 16;

/// Values by parameters.
pub(super) struct Kept<T>(Mutex<Vec<(SplitParams, T)>>);

impl<T: Clone> Kept<T> {
    pub(super) const fn new() -> Self {
        Self(Mutex::new(Vec::new()))
    }

    /// The value for `params`. `make` is called if there is no value yet.
    pub(super) fn of(&self, params: SplitParams, make: impl FnOnce() -> T) -> T {
        // A thread that panicked has stored nothing.
        let kept = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let known = kept().iter().find(|(other, _)| *other == params).map(|(_, value)| value.clone());
        known.unwrap_or_else(|| {
            // The lock is not held here, because work that this thread steals meanwhile may need it.
            let (value, mut kept) = (make(), kept());
            if kept.len() < MOST && kept.iter().all(|(other, _)| *other != params) {
                kept.push((params, value.clone()));
            }
            value
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_is_made_once_for_each_set_of_parameters() {
        static KEPT: Kept<usize> = Kept::new();
        let certified = SplitParams::certified();
        let value = |params, made| KEPT.of(params, || made);
        assert_eq!([value(certified, 1), value(SplitParams::quick(), 2), value(certified, 3)], [1, 2, 1]);
        let others = (0..2 * MOST).map(|cutoff| value(SplitParams { cutoff: 100 + cutoff, ..certified }, cutoff));
        assert!(others.eq(0..2 * MOST), "what is not kept is made");
    }
}
