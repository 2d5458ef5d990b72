//! Elements with positive pressure, as runs and as fractions of blocks.

use rc_core::Field;

/// The elements in contact of a square periodic grid.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct ContactMap {
    n: usize,
    inside: Vec<bool>,
}

/// Elements `from..to` of row `iy`, all in contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Run {
    pub(crate) iy: usize,
    pub(crate) from: usize,
    pub(crate) to: usize,
}

impl ContactMap {
    /// The map of the elements of `pressure` (n × n) that carry load.
    pub(crate) fn of(pressure: &Field) -> Self {
        Self { n: pressure.grid().nx(), inside: pressure.values().iter().map(|&p| p > 0.0).collect() }
    }

    /// Maximal runs of contact, row by row.
    pub(crate) fn runs(&self) -> Vec<Run> {
        let mut runs = Vec::new();
        for (iy, row) in self.inside.chunks_exact(self.n).enumerate() {
            let mut from = 0;
            for run in row.chunk_by(|a, b| a == b) {
                let to = from + run.len();
                if run[0] {
                    runs.push(Run { iy, from, to });
                }
                from = to;
            }
        }
        runs
    }

    /// Fraction in contact of each of `m` × `m` equal blocks, row by row.
    ///
    /// `m` must divide the side of the map.
    pub(crate) fn block_fractions(&self, m: usize) -> Vec<f64> {
        let block = self.n / m;
        let mut counts = vec![0_usize; m * m];
        for run in self.runs() {
            for ix in run.from..run.to {
                counts[(run.iy / block) * m + ix / block] += 1;
            }
        }
        counts.into_iter().map(|count| count as f64 / (block * block) as f64).collect()
    }
}

#[cfg(test)]
mod tests {
    use rc_core::Grid;

    use super::*;

    /// A map from rows of text, in which `#` is contact.
    fn map(rows: &[&str]) -> ContactMap {
        let values = rows.iter().flat_map(|row| row.bytes()).map(|byte| if byte == b'#' { 1.0 } else { 0.0 });
        let grid = Grid::square(rows.len()).expect("small grid");
        ContactMap::of(&Field::new(grid, values.collect()).expect("square map"))
    }

    #[test]
    fn runs_are_maximal() {
        let expected =
            vec![Run { iy: 0, from: 1, to: 3 }, Run { iy: 1, from: 0, to: 1 }, Run { iy: 1, from: 3, to: 4 }];
        assert_eq!(map(&[".##.", "#..#", "....", "...."]).runs(), expected);
    }

    #[test]
    fn blocks_keep_the_area() {
        let map = map(&["##..", "##.#", "....", "#..."]);
        assert_eq!(map.block_fractions(2), vec![1.0, 0.25, 0.25, 0.0]);
    }
}
