//! A level: bonds of each element to its neighbours, and sweeps of relaxation over them.

use crate::parallel;

/// Rows that are relaxed one after the other; the next block sees their values from before the sweep.
const BLOCK_ROWS: usize = 32;

/// Conductances between the elements of a periodic grid. A bond is kept by the lower left of the elements that it belongs to.
#[derive(Debug)]
pub(super) struct Stencil {
    pub(super) nx: usize,
    pub(super) ny: usize,
    /// To the next element along x.
    pub(super) east: Vec<f32>,
    /// To the next element along y.
    pub(super) north: Vec<f32>,
    /// Across corners, on all levels but the finest.
    pub(super) corners: Option<Corners>,
    /// One over the sum of the conductances of an element; 0 where there are none.
    pub(super) inverse: Vec<f32>,
}

/// Bonds across corners of elements.
#[derive(Debug)]
pub(super) struct Corners {
    /// From (ix, iy) to (ix + 1, iy + 1).
    pub(super) rising: Vec<f32>,
    /// From (ix + 1, iy) to (ix, iy + 1).
    pub(super) falling: Vec<f32>,
}

/// Order of a sweep: one is the adjoint of the other, so that both together are symmetric.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Order {
    Forward,
    Backward,
}

/// The bonds of one row.
struct RowBonds<'a> {
    east: &'a [f32],
    north: &'a [f32],
    south: &'a [f32],
    corners: Option<RowCorners<'a>>,
}

struct RowCorners<'a> {
    rising: &'a [f32],
    falling: &'a [f32],
    rising_below: &'a [f32],
    falling_below: &'a [f32],
}

/// Values of a row and of its neighbours.
struct RowValues<'a> {
    below: &'a [f32],
    above: &'a [f32],
}

impl RowBonds<'_> {
    /// Σ conductance · value of the neighbours of element `i`, whose neighbours along x are `before` and `after`.
    #[inline(always)]
    fn pull(&self, row: &[f32], values: &RowValues<'_>, [before, i, after]: [usize; 3]) -> f32 {
        let RowValues { below, above } = values;
        let mut pull = self.east[i] * row[after] + self.east[before] * row[before];
        pull += self.north[i] * above[i] + self.south[i] * below[i];
        if let Some(corners) = &self.corners {
            pull += corners.rising[i] * above[after] + corners.rising_below[before] * below[before];
            pull += corners.falling[before] * above[before] + corners.falling_below[i] * below[after];
        }
        pull
    }

    /// Σ conductance of the bonds of element `i`.
    #[inline(always)]
    fn total(&self, [before, i, _]: [usize; 3]) -> f32 {
        let mut total = self.east[i] + self.east[before] + self.north[i] + self.south[i];
        if let Some(corners) = &self.corners {
            total += corners.rising[i] + corners.rising_below[before];
            total += corners.falling[before] + corners.falling_below[i];
        }
        total
    }
}

/// Calls `visit` with each index from `first` in steps of `step`, and with those of its neighbours on a ring of `n`.
#[inline(always)]
fn for_ring(n: usize, first: usize, step: usize, mut visit: impl FnMut([usize; 3])) {
    if first >= n {
        return;
    }
    let mut i = first;
    if i == 0 {
        visit([n - 1, 0, usize::from(n > 1)]);
        i += step;
    }
    while i + 1 < n {
        visit([i - 1, i, i + 1]);
        i += step;
    }
    if i + 1 == n && i > 0 {
        visit([i - 1, i, 0]);
    }
}

impl Stencil {
    fn bonds(&self, iy: usize) -> RowBonds<'_> {
        let below = (iy + self.ny - 1) % self.ny;
        let row = |values: &'_ [f32], iy: usize| -> std::ops::Range<usize> {
            debug_assert_eq!(values.len(), self.nx * self.ny);
            iy * self.nx..(iy + 1) * self.nx
        };
        RowBonds {
            east: &self.east[row(&self.east, iy)],
            north: &self.north[row(&self.north, iy)],
            south: &self.north[row(&self.north, below)],
            corners: self.corners.as_ref().map(|corners| RowCorners {
                rising: &corners.rising[row(&corners.rising, iy)],
                falling: &corners.falling[row(&corners.falling, iy)],
                rising_below: &corners.rising[row(&corners.rising, below)],
                falling_below: &corners.falling[row(&corners.falling, below)],
            }),
        }
    }

    /// Computes `inverse`.
    pub(super) fn invert_totals(&mut self) {
        let mut inverse = vec![0.0; self.nx * self.ny];
        let rows = inverse.chunks_mut(self.nx).enumerate().collect();
        parallel::for_each(rows, |(iy, out): (usize, &mut [f32])| {
            let bonds = self.bonds(iy);
            for_ring(self.nx, 0, 1, |at| {
                let total = bonds.total(at);
                out[at[1]] = if total > f32::MIN_POSITIVE { 1.0 / total } else { 0.0 };
            });
        });
        self.inverse = inverse;
    }

    /// One sweep of Gauss and Seidel in colours over blocks of rows; two colours with bonds across faces only, four with corners.
    pub(super) fn relax(&self, x: &mut [f32], right: &[f32], order: Order) {
        let nx = self.nx;
        let borders: Vec<[Vec<f32>; 2]> = (0..self.ny)
            .step_by(BLOCK_ROWS)
            .map(|first| {
                let after = (first + BLOCK_ROWS).min(self.ny) % self.ny;
                [(first + self.ny - 1) % self.ny, after].map(|iy| x[iy * nx..(iy + 1) * nx].to_vec())
            })
            .collect();
        let blocks = x.chunks_mut(BLOCK_ROWS * nx).zip(borders).enumerate().collect();
        parallel::for_each(blocks, |(block, (x, borders)): (usize, (&mut [f32], [Vec<f32>; 2]))| {
            self.relax_block(block * BLOCK_ROWS, x, &borders, right, order);
        });
    }

    /// Relaxes some rows from `first` on. The first half of the colours of a row goes before the second half of its neighbours.
    fn relax_block(&self, first: usize, x: &mut [f32], borders: &[Vec<f32>; 2], right: &[f32], order: Order) {
        let rows = x.len() / self.nx;
        for row in 0..=rows {
            if row < rows {
                self.relax_row(first, (row, x), borders, right, (order, 0));
            }
            if row > 0 {
                self.relax_row(first, (row - 1, x), borders, right, (order, 1));
            }
        }
    }

    /// Relaxes what of row `row` of a block is in the first or in the second half of the colours.
    fn relax_row(
        &self,
        first: usize,
        (row, x): (usize, &mut [f32]),
        borders: &[Vec<f32>; 2],
        right: &[f32],
        (order, half): (Order, usize),
    ) {
        let (nx, iy) = (self.nx, first + row);
        let second = match order {
            Order::Forward => half,
            Order::Backward => 1 - half,
        };
        let (before, rest) = x.split_at_mut(row * nx);
        let (values, after) = rest.split_at_mut(nx);
        let neighbours = RowValues {
            below: if before.is_empty() { &borders[0] } else { &before[before.len() - nx..] },
            above: if after.is_empty() { &borders[1] } else { &after[..nx] },
        };
        let bonds = self.bonds(iy);
        let (right, inverse) = (&right[iy * nx..(iy + 1) * nx], &self.inverse[iy * nx..(iy + 1) * nx]);
        let mut relax = |first: usize| {
            for_ring(nx, first, 2, |at| {
                values[at[1]] = (right[at[1]] + bonds.pull(values, &neighbours, at)) * inverse[at[1]];
            });
        };
        if self.corners.is_none() {
            relax((iy + second) % 2);
        } else if iy % 2 == second {
            match order {
                Order::Forward => [0, 1].into_iter().for_each(&mut relax),
                Order::Backward => [1, 0].into_iter().for_each(&mut relax),
            }
        }
    }

    /// Writes `right` less what the network draws under `x`, of row `iy`.
    pub(super) fn residual(&self, x: &[f32], right: &[f32], iy: usize, out: &mut [f32]) {
        let nx = self.nx;
        let row = |iy: usize| &x[iy * nx..(iy + 1) * nx];
        let values = RowValues { below: row((iy + self.ny - 1) % self.ny), above: row((iy + 1) % self.ny) };
        let (bonds, values_here, right) = (self.bonds(iy), row(iy), &right[iy * nx..(iy + 1) * nx]);
        for_ring(nx, 0, 1, |at| {
            out[at[1]] = right[at[1]] + bonds.pull(values_here, &values, at) - bonds.total(at) * values_here[at[1]];
        });
    }
}
