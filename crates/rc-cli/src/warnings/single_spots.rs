//! Contact spots of a single element, counted row by row.

use rc_core::{Boundary, Grid};

/// Counts elements in contact, and those without a neighbour in contact across an edge.
///
/// It keeps four rows, so that the pressure of a large grid need not exist as a whole.
#[derive(Clone, Debug)]
pub(super) struct SingleSpots {
    grid: Grid,
    boundary: Boundary,
    /// The first two rows, which are neighbours of the last one.
    first: Vec<Vec<bool>>,
    /// The latest rows, at most two.
    latest: Vec<Vec<bool>>,
    n_rows: usize,
    in_contact: usize,
    single: usize,
}

impl SingleSpots {
    pub(super) fn new(grid: Grid, boundary: Boundary) -> Self {
        Self { grid, boundary, first: Vec::new(), latest: Vec::new(), n_rows: 0, in_contact: 0, single: 0 }
    }

    /// Takes the next rows of pressures.
    pub(super) fn take(&mut self, rows: &[f64]) {
        for row in rows.chunks(self.grid.nx()) {
            let row: Vec<bool> = row.iter().map(|pressure| *pressure > 0.0).collect();
            self.in_contact += row.iter().filter(|touches| **touches).count();
            if self.first.len() < 2 {
                self.first.push(row.clone());
            }
            if let [below, middle] = &self.latest[..] {
                self.single += self.count(middle, Some(below), Some(&row));
                self.latest.remove(0);
            }
            self.latest.push(row);
            self.n_rows += 1;
        }
    }

    /// Part of the elements in contact that are spots of their own, after all rows. It is 0 without contact.
    pub(super) fn part(mut self) -> f64 {
        let (first, latest) = (std::mem::take(&mut self.first), std::mem::take(&mut self.latest));
        // In one row, it is its own neighbour.
        let (bottom, top) = (first.first(), latest.last().filter(|_| self.n_rows > 1));
        let across = |row| if self.boundary == Boundary::Periodic { row } else { None };
        if let Some(bottom) = bottom {
            self.single += self.count(bottom, across(top), first.get(1));
        }
        if let Some(top) = top {
            let below = if latest.len() > 1 { latest.first() } else { None };
            self.single += self.count(top, below, across(bottom));
        }
        if self.in_contact == 0 { 0.0 } else { self.single as f64 / self.in_contact as f64 }
    }

    /// Number of single elements in `row`, between its neighbours.
    fn count(&self, row: &[bool], below: Option<&Vec<bool>>, above: Option<&Vec<bool>>) -> usize {
        let n = row.len();
        let beside = |i: usize, step: usize| {
            let at = (i + step) % n;
            let crosses = (step == 1 && at == 0) || (step != 1 && at == n - 1);
            n > 1 && row[at] && (self.boundary == Boundary::Periodic || !crosses)
        };
        let touches = |row: Option<&Vec<bool>>, i: usize| row.is_some_and(|row| row[i]);
        let is_single = |i: &usize| !(beside(*i, 1) || beside(*i, n - 1) || touches(below, *i) || touches(above, *i));
        (0..n).filter(|i| row[*i]).filter(is_single).count()
    }
}

#[cfg(test)]
mod tests {
    use rc_core::Field;
    use rc_core::testing::quasi_random;
    use rc_solver::ContactSpot;

    use super::*;

    #[test]
    fn single_spots_are_those_of_the_list_of_spots() {
        let mut n_single = 0;
        for (nx, ny) in [(1, 1), (1, 5), (5, 1), (2, 2), (7, 3), (16, 16), (33, 20)] {
            let grid = Grid::new(nx, ny).expect("a grid");
            for boundary in [Boundary::Periodic, Boundary::Free] {
                for (seed, threshold) in [(1, 0.5), (2, 0.8), (3, 0.9)] {
                    let noise = |i: usize| (quasi_random(i + 997 * seed) - threshold).max(0.0);
                    let values = (0..grid.len()).map(noise).collect();
                    let pressure = Field::new(grid, values).expect("a field");
                    let mut counted = SingleSpots::new(grid, boundary);
                    pressure.values().chunks(nx * 2).for_each(|rows| counted.take(rows));
                    let spots = ContactSpot::with_boundary(
                        &pressure,
                        &Field::zeros(grid),
                        rc_core::EdgeBias::default(),
                        boundary,
                    );
                    let single = spots.iter().filter(|spot| spot.elements == 1).count();
                    let all: usize = spots.iter().map(|spot| spot.elements).sum();
                    let expected = if all == 0 { 0.0 } else { single as f64 / all as f64 };
                    assert_eq!(counted.part().to_bits(), expected.to_bits(), "{nx} x {ny} {boundary:?} {seed}");
                    n_single += single;
                }
            }
        }
        assert!(n_single > 50, "{n_single}");
    }
}
