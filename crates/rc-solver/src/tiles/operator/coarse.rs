//! Elements coarser than the finest level's ([`rc_kernel::CoarseElement`] has the mathematics).
//!
//! They take part in the density and the displacement of their own level through a blur. Between elements of one size,
//! a stencil adds what finer levels would add. Across a border between two sizes, quarters of the coarse elements stand
//! in for them on the finer level (ghosts). A ghost acts on finer elements, and they act on it. Ghosts do not act on
//! each other, since the coarse stencil has that already.

use pulp::Simd;
use rc_kernel::CoarseElement;
use rc_quadtree::{CELLS, Patch, TILE, TileSet, cell_over, gather, quarters};

use crate::tiles::operator::real::{Arithmetic, add_product};
use crate::tiles::operator::stencil::Taps;
use crate::tiles::operator::tile_values::TileValues;

/// Blur and stencils of coarse elements, in the precision of the values.
#[derive(Clone, Debug)]
pub(crate) struct CoarseTable<T> {
    /// Half of the blur: the element itself, then its neighbours.
    pub(crate) blur: Vec<T>,
    /// Stencil between elements of this level.
    pub(crate) near: Taps<T>,
    /// Stencil between finer elements and ghosts, on the next finer level.
    pub(crate) across: Taps<T>,
}

impl<T: Arithmetic> CoarseTable<T> {
    /// A table for patches of `side`.
    ///
    /// `across` is already in its unit. `factor` is that of the element's level.
    pub(crate) fn new(element: &CoarseElement, factor: f64, across: Taps<T>, side: usize) -> Self {
        let blur = element.filter.taps().iter().map(|&tap| T::rounded(tap)).collect();
        Self { blur, near: Taps::new(&element.near, factor, side), across }
    }
}

/// The tiles of coarse elements on a level, and their quarters next to finer elements.
pub(crate) struct Leaves {
    pub(crate) tiles: TileSet,
    pub(crate) ghosts: TileSet,
}

impl Leaves {
    /// The tiles of a level with their ghosts.
    ///
    /// `finer` are the tiles of elements half as large, which act over `cutoff` cells.
    pub(crate) fn new(tiles: TileSet, finer: &TileSet, cutoff: usize) -> Self {
        let reach = cutoff.div_ceil(TILE) as i64;
        let mut ghosts = Vec::new();
        for [x, y] in tiles.places().iter().copied().flat_map(quarters) {
            let is_near = (-reach..=reach)
                .any(|dy| (-reach..=reach).any(|dx| finer.find(i64::from(x) + dx, i64::from(y) + dy).is_some()));
            if is_near {
                ghosts.push([x, y]);
            }
        }
        Self { ghosts: TileSet::new(tiles.sides().map(|side| 2 * side), ghosts), tiles }
    }

    /// The values of the ghosts at `places`.
    pub(crate) fn set_ghosts<T: Arithmetic>(&self, values: &[T], places: &[[u32; 2]], ghosts: &mut [T]) {
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

/// Adds to `out` the blur of values on the tile at a place.
///
/// Without a table it adds the values themselves.
#[inline(always)]
pub(crate) fn add_blur<S: Simd, T: Arithmetic, const SIDE: usize>(
    table: Option<&CoarseTable<T>>,
    elements: TileValues<'_, T>,
    [column, row]: [u32; 2],
    patch: &mut Patch<T, SIDE>,
    out: &mut [T; CELLS],
) {
    let Some(table) = table else {
        if let Some(tile) = elements.tiles.find(i64::from(column), i64::from(row)) {
            for (out, &value) in out.iter_mut().zip(&elements.values[tile * CELLS..]) {
                *out = *out + value;
            }
        }
        return;
    };
    let (margin, reach) = ((SIDE - TILE) / 2, table.blur.len() - 1);
    let tiles = (margin / TILE) as i64;
    let corner = (i64::from(column) - tiles, i64::from(row) - tiles);
    if !gather(elements.values, elements.tiles, corner, margin - reach..margin + TILE + reach, patch) {
        return;
    }
    for (y, out) in out.as_chunks_mut::<TILE>().0.iter_mut().enumerate() {
        let mut line = [T::default(); SIDE];
        for (j, &tap) in table.blur.iter().enumerate() {
            let (low, high) = (&patch[margin + y - j], &patch[margin + y + j]);
            // The element itself counts once.
            for x in 0..SIDE {
                line[x] = add_product::<S, T>(line[x], tap, if j == 0 { low[x] } else { low[x] + high[x] });
            }
        }
        for (j, &tap) in table.blur.iter().enumerate() {
            let (low, high) = (&line[margin - j..][..TILE], &line[margin + j..][..TILE]);
            for x in 0..TILE {
                out[x] = add_product::<S, T>(out[x], tap, if j == 0 { low[x] } else { low[x] + high[x] });
            }
        }
    }
}
