//! Memory for a solve: the limit of the user, and the memory of the machine.

use rc_core::Grid;
use rc_solver::UNIFORM_BYTES_PER_ELEMENT;
use thiserror::Error;

use super::ByteSize;

/// Memory that is available to a command.
#[derive(Clone, Copy, Debug)]
pub struct Budget {
    limit: Option<ByteSize>,
    machine: Option<ByteSize>,
}

/// Source of a limit of memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bound {
    /// The limit that the user gave.
    Limit,
    /// The memory of the machine.
    Machine,
}

/// Error of a command that needs more memory than is available.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{what} needs about {needed} of memory, but {available} is available{remedy}")]
pub struct MemoryError {
    /// Name of what needs the memory.
    pub what: String,
    /// Estimate of the needed memory.
    pub needed: ByteSize,
    /// Available memory.
    pub available: ByteSize,
    /// Source of the limit.
    pub bound: Bound,
    /// Description of what would fit, as the end of a sentence. It may be empty.
    pub remedy: String,
}

impl Budget {
    /// A budget without a limit, for estimates that must be the same on every machine.
    pub const UNLIMITED: Self = Self { limit: None, machine: None };

    /// The memory of this machine, with the limit of the user if there is one.
    #[must_use]
    pub fn new(limit: Option<ByteSize>) -> Self {
        Self { limit, machine: super::physical().map(ByteSize) }
    }

    /// Number of bytes that are available, or `None` if it is not known.
    #[must_use]
    pub fn available(&self) -> Option<u64> {
        self.limit.into_iter().chain(self.machine).map(|bytes| bytes.0).min()
    }

    /// Refuses `what` when it needs more bytes than are available.
    ///
    /// `needed` is the approximate number of bytes. `remedy` gets the available bytes and may return an empty text.
    ///
    /// # Errors
    /// [`MemoryError`] when the memory does not suffice.
    pub fn check(&self, what: &str, needed: f64, remedy: impl Fn(u64) -> String) -> Result<(), MemoryError> {
        let bounds = [(Bound::Limit, self.limit), (Bound::Machine, self.machine)];
        let exceeded = bounds.into_iter().find_map(|(bound, bytes)| {
            let available = bytes.filter(|bytes| needed > bytes.0 as f64)?;
            Some(MemoryError {
                what: what.to_owned(),
                needed: ByteSize(needed as u64),
                available,
                bound,
                remedy: remedy(available.0),
            })
        });
        exceeded.map_or(Ok(()), Err)
    }

    /// Number of solves that fit into memory at once, at least one.
    ///
    /// The largest solve has `n_elements` elements, with any method. The limit is that of the user, or half of the
    /// memory of the machine.
    #[must_use]
    pub fn solves_at_once(&self, n_elements: f64) -> usize {
        let available = self.limit.map(|limit| limit.0 as f64).or(self.machine.map(|machine| 0.5 * machine.0 as f64));
        available.map_or(1, |bytes| (bytes / (n_elements * UNIFORM_BYTES_PER_ELEMENT as f64)) as usize).max(1)
    }

    /// Refuses a grid that is too large for a method that stores every element.
    ///
    /// `what` is the name of the method.
    ///
    /// # Errors
    /// [`MemoryError`] with the largest grid that fits.
    pub fn check_grid(&self, what: &str, grid: Grid) -> Result<(), MemoryError> {
        let needed = grid.len() as f64 * UNIFORM_BYTES_PER_ELEMENT as f64;
        let remedy = |available: u64| {
            format!("; at most {} elements per side fit", (available / UNIFORM_BYTES_PER_ELEMENT).isqrt())
        };
        self.check(&format!("{what} on {grid} elements"), needed, remedy)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_limit_holds_before_the_machine_and_names_what_fits() {
        let budget = Budget { limit: Some(ByteSize(8_000_000)), machine: Some(ByteSize(800_000_000)) };
        let grid = |n| Grid::square(n).expect("a grid");
        assert!(budget.check_grid("it", grid(316)).is_ok());
        let error = budget.check_grid("it", grid(317)).expect_err("above the limit");
        assert_eq!(error.bound, Bound::Limit);
        let text = error.to_string();
        assert!(text.starts_with("it on 317 x 317") && text.contains("at most 316"), "{text}");
        assert_eq!(budget.solves_at_once(25_000.0), 4);
        assert_eq!(budget.solves_at_once(1e9), 1);
        let unlimited = Budget { limit: None, ..budget };
        assert_eq!(unlimited.solves_at_once(25_000.0), 200);
        assert!(unlimited.check_grid("it", grid(3162)).is_ok());
        let error = unlimited.check_grid("it", grid(3163)).expect_err("above the machine");
        assert_eq!((budget.available(), unlimited.available()), (Some(8_000_000), Some(800_000_000)));
        assert_eq!(error.bound, Bound::Machine);
        let text = error.to_string();
        assert!(text.starts_with("it on 3163 x 3163") && text.contains("800 MB is available"), "{text}");
    }
}
