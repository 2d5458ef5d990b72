//! Elements coarser than the finest level's ([`rc_kernel::CoarseElement`] has the mathematics).
//!
//! They take part in the density and the displacement of their own level through a blur. What finer levels would add is a
//! stencil between elements of one size; across a border between two sizes, quarters of the coarse elements stand in for
//! them on the finer level (ghosts). A ghost acts on finer elements and they on it, but ghosts do not act on each other:
//! that is in the coarse stencil already.

use std::marker::PhantomData;

use pulp::{Simd, WithSimd};
use rc_kernel::CoarseElement;
use rc_quadtree::{CELLS, Patch, TILE, TileSet, cell_over, gather, means_of_quarter, quarters};

use super::real::{MultiplyAdd, Real};
use super::stencil::Taps;

/// What coarse elements do, in the precision of the values.
#[derive(Clone, Debug)]
pub(crate) struct CoarseTable<T> {
    /// Half of the blur: the element itself, then its neighbours.
    pub(super) blur: Vec<T>,
    /// Between elements of this level.
    pub(super) near: Taps<T>,
    /// Between finer elements and ghosts, on the next finer level.
    pub(super) across: Taps<T>,
}

impl<T: Real> CoarseTable<T> {
    /// `across` is already in its unit; `factor` is that of the element's level, for patches of `side`.
    pub(super) fn new(element: &CoarseElement, factor: f64, across: Taps<T>, side: usize) -> Self {
        let blur = element.filter.taps().iter().map(|&tap| T::rounded(tap)).collect();
        Self { blur, near: Taps::new(&element.near, factor, side), across }
    }
}

/// The tiles of elements on a level that are not the finest, and their quarters next to finer elements.
pub(super) struct Leaves {
    pub(super) tiles: TileSet,
    pub(super) ghosts: TileSet,
}

impl Leaves {
    /// `finer` are the tiles of elements half as large, which act over `cutoff` cells.
    pub(super) fn new(tiles: TileSet, finer: &TileSet, cutoff: usize) -> Self {
        let reach = cutoff.div_ceil(TILE) as i64;
        let mut ghosts = Vec::new();
        for [x, y] in tiles.places().iter().copied().flat_map(quarters) {
            let is_near = (-reach..=reach)
                .any(|dy| (-reach..=reach).any(|dx| finer.find(i64::from(x) + dx, i64::from(y) + dy).is_some()));
            if is_near {
                ghosts.push([x, y]);
            }
        }
        Self { ghosts: TileSet::new(2 * tiles.per_side(), ghosts), tiles }
    }

    /// The values of the ghosts at `places`.
    pub(super) fn spread_to_ghosts<T: Real>(&self, values: &[T], places: &[[u32; 2]], ghosts: &mut [T]) {
        for (out, &place) in ghosts.as_chunks_mut::<CELLS>().0.iter_mut().zip(places) {
            let [column, row] = place;
            let tile =
                self.tiles.find(i64::from(column / 2), i64::from(row / 2)).expect("ghosts are quarters of tiles");
            for (cell, value) in out.iter_mut().enumerate() {
                *value = values[tile * CELLS + cell_over(place, cell % TILE, cell / TILE)];
            }
        }
    }
}

/// Adds blurred elements to the density of their level.
pub(super) struct Blur<'a, T, A, const AROUND: usize> {
    pub(super) table: Option<&'a CoarseTable<T>>,
    pub(super) values: (&'a [T], &'a TileSet),
    pub(super) places: &'a [[u32; 2]],
    pub(super) cells: &'a mut [T],
    pub(super) arithmetic: PhantomData<A>,
}

impl<T: Real, A: MultiplyAdd, const AROUND: usize> WithSimd for Blur<'_, T, A, AROUND> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let mut patch = [[T::default(); AROUND]; AROUND];
        for (out, &[column, row]) in self.cells.as_chunks_mut::<CELLS>().0.iter_mut().zip(self.places) {
            blurred::<T, A, AROUND>(self.table, self.values, (column, row), &mut patch, out);
        }
    }
}

/// Adds the blur of `values` on the tile at a place, or the values themselves without a table, to `out`.
#[inline(always)]
fn blurred<T: Real, A: MultiplyAdd, const AROUND: usize>(
    table: Option<&CoarseTable<T>>,
    values: (&[T], &TileSet),
    (column, row): (u32, u32),
    patch: &mut Patch<T, AROUND>,
    out: &mut [T; CELLS],
) {
    let Some(table) = table else {
        if let Some(tile) = values.1.find(i64::from(column), i64::from(row)) {
            for (out, &value) in out.iter_mut().zip(&values.0[tile * CELLS..]) {
                *out = *out + value;
            }
        }
        return;
    };
    let (margin, reach) = ((AROUND - TILE) / 2, table.blur.len() - 1);
    let tiles = (margin / TILE) as i64;
    let corner = (i64::from(column) - tiles, i64::from(row) - tiles);
    if !gather(values.0, values.1, corner, margin - reach..margin + TILE + reach, patch) {
        return;
    }
    for (y, out) in out.as_chunks_mut::<TILE>().0.iter_mut().enumerate() {
        let mut line = [T::default(); AROUND];
        for (j, &tap) in table.blur.iter().enumerate() {
            let (low, high) = (&patch[margin + y - j], &patch[margin + y + j]);
            // The element itself is met once.
            for x in 0..AROUND {
                line[x] = A::add(line[x], tap, if j == 0 { low[x] } else { low[x] + high[x] });
            }
        }
        for (j, &tap) in table.blur.iter().enumerate() {
            let (low, high) = (&line[margin - j..][..TILE], &line[margin + j..][..TILE]);
            for x in 0..TILE {
                out[x] = A::add(out[x], tap, if j == 0 { low[x] } else { low[x] + high[x] });
            }
        }
    }
}

/// The displacements of tiles of coarse elements.
pub(super) struct Means<'a, T, A, const AROUND: usize> {
    pub(super) table: Option<&'a CoarseTable<T>>,
    /// The elements of this level, and those half as large.
    pub(super) elements: (&'a [T], &'a TileSet),
    pub(super) finer: (&'a [T], &'a TileSet),
    pub(super) ghosts: &'a TileSet,
    /// The level's smooth displacement.
    pub(super) level: (&'a [T], &'a TileSet),
    pub(super) places: &'a [[u32; 2]],
    pub(super) cells: &'a mut [T],
    pub(super) arithmetic: PhantomData<A>,
}

impl<T: Real, A: MultiplyAdd, const AROUND: usize> WithSimd for Means<'_, T, A, AROUND> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let mut patch = [[T::default(); AROUND]; AROUND];
        for (out, &[column, row]) in self.cells.as_chunks_mut::<CELLS>().0.iter_mut().zip(self.places) {
            *out = [T::default(); CELLS];
            blurred::<T, A, AROUND>(self.table, self.level, (column, row), &mut patch, out);
            let Some(table) = self.table else { continue };
            short_range::<T, A, AROUND>(&table.near, self.elements, (column, row), &mut patch, out);
            for place in quarters([column, row]) {
                if self.ghosts.find(i64::from(place[0]), i64::from(place[1])).is_none() {
                    continue;
                }
                let mut ghost = [T::default(); CELLS];
                if short_range::<T, A, AROUND>(&table.across, self.finer, place.into(), &mut patch, &mut ghost) {
                    means_of_quarter(place, &ghost, |cell, mean| out[cell] = out[cell] + mean);
                }
            }
        }
    }
}

/// Adds what a stencil makes of the values around a tile to `out`; false when there are none.
#[inline(always)]
pub(super) fn short_range<T: Real, A: MultiplyAdd, const AROUND: usize>(
    taps: &Taps<T>,
    values: (&[T], &TileSet),
    (column, row): (u32, u32),
    patch: &mut Patch<T, AROUND>,
    out: &mut [T; CELLS],
) -> bool {
    let margin = ((AROUND - TILE) / 2 / TILE) as i64;
    let corner = (i64::from(column) - margin, i64::from(row) - margin);
    let any = gather(values.0, values.1, corner, taps.rows(AROUND), patch);
    if any {
        taps.add::<A, AROUND>(patch, out);
    }
    any
}

/// Adds what ghosts do to the elements around them.
pub(super) struct FromGhosts<'a, T, A, const AROUND: usize> {
    pub(super) taps: &'a Taps<T>,
    pub(super) ghosts: (&'a [T], &'a TileSet),
    pub(super) places: &'a [[u32; 2]],
    pub(super) cells: &'a mut [T],
    pub(super) arithmetic: PhantomData<A>,
}

impl<T: Real, A: MultiplyAdd, const AROUND: usize> WithSimd for FromGhosts<'_, T, A, AROUND> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let mut patch = [[T::default(); AROUND]; AROUND];
        for (out, &[column, row]) in self.cells.as_chunks_mut::<CELLS>().0.iter_mut().zip(self.places) {
            short_range::<T, A, AROUND>(self.taps, self.ghosts, (column, row), &mut patch, out);
        }
    }
}
