//! A level: bonds of each element to its neighbours, and sweeps of relaxation.

use crate::parallel;
use crate::real::Real;

/// Number of rows in a block. Rows of a block are relaxed one after another, while other blocks have values from before
/// the sweep.
const BLOCK_ROWS: usize = 32;

/// Conductances between the elements of a periodic grid.
///
/// A bond is stored with the lower left one of its elements.
#[derive(Debug)]
pub(super) struct Stencil<T> {
    pub(super) nx: usize,
    pub(super) ny: usize,
    /// Bonds to the next element along x.
    pub(super) east: Vec<T>,
    /// Bonds to the next element along y.
    pub(super) north: Vec<T>,
    /// Bonds across corners, on all levels except the finest.
    pub(super) corners: Option<Corners<T>>,
    /// Reciprocal of the sum of an element's conductances; 0 without conductances.
    pub(super) inverse: Vec<T>,
}

/// Bonds across corners of elements.
#[derive(Debug)]
pub(super) struct Corners<T> {
    /// Bonds from (ix, iy) to (ix + 1, iy + 1).
    pub(super) rising: Vec<T>,
    /// Bonds from (ix + 1, iy) to (ix, iy + 1).
    pub(super) falling: Vec<T>,
}

/// Order of a sweep. Each order is the adjoint of the other, so both together are symmetric.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Order {
    Forward,
    Backward,
}

/// The bonds of one row.
struct RowBonds<'a, T> {
    east: &'a [T],
    north: &'a [T],
    south: &'a [T],
    corners: Option<RowCorners<'a, T>>,
}

struct RowCorners<'a, T> {
    rising: &'a [T],
    falling: &'a [T],
    rising_below: &'a [T],
    falling_below: &'a [T],
}

impl<T: Real> RowBonds<'_, T> {
    /// Adds to `out` the sum over neighbours in the rows below and above.
    ///
    /// A term is conductance · `pull`(neighbour, element).
    #[inline]
    fn add_across(&self, [below, row, above]: [&[T]; 3], out: &mut [T], pull: impl Fn(T, T) -> T) {
        let last = out.len() - 1;
        let vertical = self.north.iter().zip(above).zip(self.south.iter().zip(below));
        for ((out, &own), ((north, &above), (south, &below))) in out.iter_mut().zip(row).zip(vertical) {
            *out += *north * pull(above, own) + *south * pull(below, own);
        }
        let Some(corners) = &self.corners else { return };
        // The first loops go from earlier elements to later ones and the reverse. Bonds around the cell are separate.
        let to_after = corners.rising.iter().zip(&above[1..]).zip(corners.falling_below.iter().zip(&below[1..]));
        for ((out, &own), ((rising, &above), (falling, &below))) in out.iter_mut().zip(row).zip(to_after) {
            *out += *rising * pull(above, own) + *falling * pull(below, own);
        }
        let to_before = corners.falling.iter().zip(above).zip(corners.rising_below.iter().zip(below));
        for ((out, &own), ((falling, &above), (rising, &below))) in out[1..].iter_mut().zip(&row[1..]).zip(to_before) {
            *out += *falling * pull(above, own) + *rising * pull(below, own);
        }
        out[last] += corners.rising[last] * pull(above[0], row[last]);
        out[last] += corners.falling_below[last] * pull(below[0], row[last]);
        out[0] += corners.falling[last] * pull(above[last], row[0]);
        out[0] += corners.rising_below[last] * pull(below[last], row[0]);
    }

    /// Relaxes every second element from `first` on.
    ///
    /// `pull` is the right side plus the contributions of the rows below and above. For an odd number of elements the
    /// first and the last are neighbours, so the last one comes first on the way back.
    fn relax_along(&self, row: &mut [T], pull: &[T], inverse: &[T], (order, first): (Order, usize)) {
        let (n, east) = (row.len(), self.east);
        let relax = |row: &mut [T], [before, i, after]: [usize; 3]| {
            row[i] = (pull[i] + east[i] * row[after] + east[before] * row[before]) * inverse[i];
        };
        let seam = (first == 0 && n % 2 == 1 && n > 1 && order == Order::Backward).then_some([n - 2, n - 1, 0]);
        if let Some(seam) = seam {
            relax(row, seam);
        }
        let end = if seam.is_some() { n - 1 } else { n };
        for_ring(n, first, 2, |at| {
            if at[1] < end {
                relax(row, at);
            }
        });
    }

    /// Adds to `out` Σ conductance · (neighbour - element) over the neighbours along x.
    fn add_along(&self, row: &[T], out: &mut [T]) {
        let last = row.len() - 1;
        for ((out, pair), east) in out.iter_mut().zip(row.windows(2)).zip(self.east) {
            *out += *east * (pair[1] - pair[0]);
        }
        for ((out, pair), east) in out[1..].iter_mut().zip(row.windows(2)).zip(self.east) {
            *out += *east * (pair[0] - pair[1]);
        }
        let around = self.east[last] * (row[0] - row[last]);
        out[last] += around;
        out[0] -= around;
    }

    /// Sum of the conductances of the bonds of element `i`.
    fn total(&self, [before, i, _]: [usize; 3]) -> T {
        let mut total = self.east[i] + self.east[before] + self.north[i] + self.south[i];
        if let Some(corners) = &self.corners {
            total += corners.rising[i] + corners.rising_below[before];
            total += corners.falling[before] + corners.falling_below[i];
        }
        total
    }
}

/// Calls `visit` with indices on a ring of `n`, each between its two neighbours.
///
/// The indices go from `first` in steps of `step`.
#[inline]
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

impl<T: Real> Stencil<T> {
    fn bonds(&self, iy: usize) -> RowBonds<'_, T> {
        let below = (iy + self.ny - 1) % self.ny;
        let row = |values: &'_ [T], iy: usize| -> std::ops::Range<usize> {
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
        let mut inverse = vec![T::ZERO; self.nx * self.ny];
        let rows = inverse.chunks_mut(self.nx).enumerate().collect();
        parallel::for_each(rows, |(iy, out): (usize, &mut [T])| {
            let bonds = self.bonds(iy);
            for_ring(self.nx, 0, 1, |at| {
                let total = bonds.total(at);
                out[at[1]] = if total > T::TINY { T::ONE / total } else { T::ZERO };
            });
        });
        self.inverse = inverse;
    }

    /// One Gauss-Seidel sweep in four colours over blocks of rows.
    ///
    /// A colour is every second element in every second row.
    pub(super) fn relax(&self, x: &mut [T], right: &[T], order: Order) {
        let nx = self.nx;
        let borders: Vec<[Vec<T>; 2]> = (0..self.ny)
            .step_by(BLOCK_ROWS)
            .map(|first| {
                let after = (first + BLOCK_ROWS).min(self.ny) % self.ny;
                [(first + self.ny - 1) % self.ny, after].map(|iy| x[iy * nx..(iy + 1) * nx].to_vec())
            })
            .collect();
        let blocks = x.chunks_mut(BLOCK_ROWS * nx).zip(borders).enumerate().collect();
        parallel::for_each(blocks, |(block, (x, borders)): (usize, (&mut [T], [Vec<T>; 2]))| {
            let (rows, mut pull) = (x.len() / nx, vec![T::ZERO; nx]);
            let mut block = RowBlock { first: block * BLOCK_ROWS, x, borders };
            let parity = match order {
                Order::Forward => 0,
                Order::Backward => 1,
            };
            for row in 0..=rows {
                if row < rows && row % 2 == parity {
                    self.relax_row(&mut block, row, right, (order, &mut pull));
                }
                if row > 0 && (row - 1) % 2 != parity {
                    self.relax_row(&mut block, row - 1, right, (order, &mut pull));
                }
            }
        });
    }

    fn relax_row(&self, block: &mut RowBlock<'_, T>, row: usize, right: &[T], (order, pull): (Order, &mut [T])) {
        let (nx, iy) = (self.nx, block.first + row);
        let (before, rest) = block.x.split_at_mut(row * nx);
        let (values, after) = rest.split_at_mut(nx);
        let below = if before.is_empty() { &block.borders[0] } else { &before[before.len() - nx..] };
        let above = if after.is_empty() { &block.borders[1] } else { &after[..nx] };
        let bonds = self.bonds(iy);
        pull.copy_from_slice(&right[iy * nx..(iy + 1) * nx]);
        bonds.add_across([below, values, above], pull, |neighbour, _| neighbour);
        let inverse = &self.inverse[iy * nx..(iy + 1) * nx];
        let columns = match order {
            Order::Forward => [0, 1],
            Order::Backward => [1, 0],
        };
        for first in columns {
            bonds.relax_along(values, pull, inverse, (order, first));
        }
    }

    /// Writes the flow out of the elements of row `iy`.
    ///
    /// It is that of the finest network under the pressure `x`. The sums are in double precision, of fluxes that are
    /// rounded alike for both elements of a face.
    pub(super) fn draw_finest(&self, x: &[T], iy: usize, out: &mut [f64]) {
        let bonds = self.bonds(iy);
        let [below, row, above] = self.rows_around(x, iy);
        let flux = |bond: T, from: T, to: T| (bond * (from - to)).to_f64();
        let vertical = bonds.north.iter().zip(above).zip(bonds.south.iter().zip(below));
        for ((out, &own), ((&north, &above), (&south, &below))) in out.iter_mut().zip(row).zip(vertical) {
            *out = flux(north, own, above) - flux(south, below, own);
        }
        for ((out, pair), &east) in out.iter_mut().zip(row.windows(2)).zip(bonds.east) {
            *out += flux(east, pair[0], pair[1]);
        }
        for ((out, pair), &east) in out[1..].iter_mut().zip(row.windows(2)).zip(bonds.east) {
            *out -= flux(east, pair[0], pair[1]);
        }
        let last = row.len() - 1;
        let around = flux(bonds.east[last], row[last], row[0]);
        out[last] += around;
        out[0] -= around;
    }

    fn rows_around<'x>(&self, x: &'x [T], iy: usize) -> [&'x [T]; 3] {
        [iy + self.ny - 1, iy, iy + 1].map(|iy| &x[iy % self.ny * self.nx..][..self.nx])
    }

    /// Writes `right` minus the flow out of the elements of row `iy` under `x`.
    pub(super) fn residual(&self, x: &[T], right: &[T], iy: usize, out: &mut [T]) {
        out.copy_from_slice(&right[iy * self.nx..(iy + 1) * self.nx]);
        let rows = self.rows_around(x, iy);
        let bonds = self.bonds(iy);
        bonds.add_across(rows, out, |neighbour, own| neighbour - own);
        bonds.add_along(rows[1], out);
    }
}

/// Rows that are relaxed together, from row `first` on.
///
/// It also has the rows before and after them, with values from before the sweep.
struct RowBlock<'a, T> {
    first: usize,
    x: &'a mut [T],
    borders: [Vec<T>; 2],
}
