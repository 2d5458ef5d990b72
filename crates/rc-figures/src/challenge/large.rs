//! One load on the grid of the published reference.

use anyhow::Result;
use rc_sweep::memory;

use super::tables::solved;
use super::{Params, REFERENCE_LOAD, Solved, Source, press};
use crate::Table;
use crate::table::Rows;

/// The contact under [`REFERENCE_LOAD`] on a grid of the reference's size.
#[derive(Clone, Debug)]
pub struct Large {
    side: usize,
    solved: Solved,
    /// The certified bound on the energy error of the pressure.
    energy_error: f64,
    megabytes: f64,
    source: &'static str,
}

impl Large {
    /// Solves the contact on a grid of `side` elements per side.
    ///
    /// At 65536² this takes about 6 GB, and at 131072² about 16 GB. No field is ever stored as a whole.
    ///
    /// # Errors
    /// When the surface cannot be made, or the contact cannot be solved.
    pub fn compute(params: &Params, side: usize) -> Result<Self> {
        let surface = params.source.surface()?;
        let of = (side, REFERENCE_LOAD, params.energy_tolerance);
        let (solved, energy_error) = press(&surface, of, |solution| solution.certificate().energy)?;
        let source = match params.source {
            Source::Generated { .. } => "generated",
            Source::File { .. } => "distributed",
        };
        let megabytes = memory::peak().map_or(f64::NAN, |bytes| bytes as f64 / 1e6);
        Ok(Self { side, solved, energy_error, megabytes, source })
    }

    /// Table with one line, the results of this contact.
    #[must_use]
    pub fn table(&self) -> Table {
        let threads = std::thread::available_parallelism().map_or(1, usize::from);
        let rows = Rows::of([self]).column("surface", |_| self.source.to_owned()).column("side", |_| self.side);
        solved(rows, |_| (REFERENCE_LOAD, &self.solved))
            .column("energy_error", |_| self.energy_error)
            .column("threads", |_| threads)
            .column("seconds", |_| self.solved.seconds)
            .column("peak_memory_megabytes", |_| self.megabytes)
            .table("large")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::challenge::Challenge;
    use crate::{Figure as _, Preset};

    #[test]
    fn the_line_is_that_of_the_curve_on_the_same_grid() {
        let params = Challenge::params(Preset::Quick).expect("parameters");
        let large = Large::compute(&params, params.side).expect("a small grid").table();
        let curve = Challenge::compute(&params).expect("the quick figure").curve_table();
        let line = |table: &Table, starts: &str| -> Vec<String> {
            let line = table.csv.lines().find(|line| line.contains(starts)).expect("its line");
            line.split(',').map(str::to_owned).collect()
        };
        let (large, curve) = (line(&large, "2.500000e-1,"), line(&curve, "2.500000e-1,"));
        assert_eq!(large[2..10], curve[..8]);
    }
}
