//! What a solve may need of memory: the limit that the user gives, and what the machine has.

use rc_core::Grid;
use rc_solver::UNIFORM_BYTES_PER_ELEMENT;

use crate::byte_size::ByteSize;
use crate::error::CliError;
use crate::memory;

/// Memory that there is for a command.
#[derive(Clone, Copy, Debug)]
pub struct Budget {
    limit: Option<ByteSize>,
    machine: Option<ByteSize>,
}

impl Budget {
    /// The memory of this machine, and the limit of the user, if there is one.
    #[must_use]
    pub fn new(limit: Option<ByteSize>) -> Self {
        Self { limit, machine: memory::physical().map(ByteSize) }
    }

    /// Bytes that there are, as far as that is known.
    #[must_use]
    pub fn available(&self) -> Option<u64> {
        self.limit.into_iter().chain(self.machine).map(|bytes| bytes.0).min()
    }

    /// Refuses `what`, which needs about `needed` bytes, when there are fewer; `remedy` (may be empty) gets the bytes that
    /// there are.
    ///
    /// # Errors
    /// [`CliError::Input`] with the estimate.
    pub fn check(&self, what: &str, needed: f64, remedy: impl Fn(u64) -> String) -> Result<(), CliError> {
        let exceeds = |bound: &ByteSize| needed > bound.0 as f64;
        let needs = ByteSize(needed as u64);
        if let Some(limit) = self.limit.filter(exceeds) {
            let message = format_args!(
                "memory_limit: {what} needs about {needs}, more than the limit of {limit}{}",
                remedy(limit.0)
            );
            return Err(CliError::input(message));
        }
        match self.machine.filter(exceeds) {
            Some(machine) => Err(CliError::input(format_args!(
                "grid: {what} needs about {needs} of memory, this machine has {machine}{}",
                remedy(machine.0)
            ))),
            None => Ok(()),
        }
    }

    /// How many solves fit side by side, the greatest on `n_elements` elements, whatever their method: within the limit, or half
    /// of the machine's memory; at least one.
    #[must_use]
    pub fn solves_at_once(&self, n_elements: f64) -> usize {
        let available = self.limit.map(|limit| limit.0 as f64).or(self.machine.map(|machine| 0.5 * machine.0 as f64));
        available.map_or(1, |bytes| (bytes / (n_elements * UNIFORM_BYTES_PER_ELEMENT as f64)) as usize).max(1)
    }

    /// Refuses a grid on which a method that stores every element, here called `what`, would not fit.
    ///
    /// # Errors
    /// [`CliError::Input`] that names what is needed, what there is, and the largest grid that fits.
    pub fn check_grid(&self, what: &str, grid: Grid) -> Result<(), CliError> {
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
        let error = budget.check_grid("it", grid(317)).expect_err("above the limit").to_string();
        assert!(error.starts_with("memory_limit: it on 317 x 317") && error.contains("at most 316"), "{error}");
        assert_eq!(budget.solves_at_once(25_000.0), 4);
        assert_eq!(budget.solves_at_once(1e9), 1);
        let unlimited = Budget { limit: None, ..budget };
        assert_eq!(unlimited.solves_at_once(25_000.0), 200);
        assert!(unlimited.check_grid("it", grid(3162)).is_ok());
        let error = unlimited.check_grid("it", grid(3163)).expect_err("above the machine").to_string();
        assert_eq!((budget.available(), unlimited.available()), (Some(8_000_000), Some(800_000_000)));
        assert!(error.starts_with("grid: it on 3163 x 3163") && error.contains("has 800 MB"), "{error}");
    }
}
