//! The passes over the tiles of a level: their inputs, and their loops.
//!
//! Loops use the machine's vector instructions. They are compiled for a few numbers of taps and sides of patches
//! ([`TilePasses::new`]), which the compiler knows. All other code calls them through [`TilePasses`] and does not
//! depend on these numbers.

use pulp::{Arch, Simd, WithSimd};
use rc_quadtree::{CELLS, TILE, TileSet, gather, means_of_quarter, quarters};

use crate::tiles::operator::coarse::{CoarseTable, add_blur};
use crate::tiles::operator::real::Arithmetic;
use crate::tiles::operator::stencil::{Taps, add_short_range};
use crate::tiles::operator::tile_values::TileValues;
use crate::tiles::operator::transfer::Transfer;
use crate::tiles::operator::uneven::Uneven;

/// Tiles to compute: their places, and their cells one tile after the other.
pub(crate) struct Targets<'a, T> {
    pub(crate) places: &'a [[u32; 2]],
    pub(crate) cells: &'a mut [T],
}

impl<'a, T> Targets<'a, T> {
    #[inline(always)]
    fn tiles(self) -> impl Iterator<Item = ([u32; 2], &'a mut [T; CELLS])> {
        self.places.iter().copied().zip(self.cells.as_chunks_mut::<CELLS>().0)
    }
}

/// Computes the densities of tiles from those of the next finer level.
pub(crate) struct Restriction<'a, T> {
    pub(crate) transfer: &'a Transfer<T>,
    pub(crate) finer: TileValues<'a, T>,
}

/// Computes the displacements of tiles.
///
/// They are the level's stencil on its density, plus the prolonged displacement of the coarser level.
pub(crate) struct Displacement<'a, T> {
    pub(crate) table: &'a (Taps<T>, Transfer<T>),
    pub(crate) density: TileValues<'a, T>,
    pub(crate) coarser: TileValues<'a, T>,
}

/// [`Restriction`] to an uneven level.
///
/// This level does not have half as many elements along a side as the finest.
pub(crate) struct UnevenRestriction<'a, T> {
    pub(crate) uneven: &'a Uneven<T>,
    pub(crate) finer: TileValues<'a, T>,
}

/// [`Displacement`] of the finest level over an uneven one.
///
/// The coarser level does not have half as many elements along a side.
pub(crate) struct UnevenDisplacement<'a, T> {
    pub(crate) taps: &'a Taps<T>,
    pub(crate) uneven: &'a Uneven<T>,
    pub(crate) density: TileValues<'a, T>,
    pub(crate) coarser: TileValues<'a, T>,
}

/// Computes the density of coarse elements on their own level.
pub(crate) struct CoarseDensity<'a, T> {
    pub(crate) table: Option<&'a CoarseTable<T>>,
    pub(crate) elements: TileValues<'a, T>,
}

/// Computes the displacements of tiles of coarse elements.
pub(crate) struct CoarseDisplacement<'a, T> {
    pub(crate) table: Option<&'a CoarseTable<T>>,
    /// The elements of this level. The elements below are half as large.
    pub(crate) elements: TileValues<'a, T>,
    pub(crate) finer: TileValues<'a, T>,
    pub(crate) ghosts: &'a TileSet,
    /// The level's smooth displacement.
    pub(crate) level: TileValues<'a, T>,
}

/// Computes the stencil of the values on and around tiles.
pub(crate) struct ShortRange<'a, T> {
    pub(crate) taps: &'a Taps<T>,
    pub(crate) values: TileValues<'a, T>,
}

/// The loops for one number of taps, and for patches of one size.
#[derive(Clone, Copy)]
pub(crate) struct TilePasses<T> {
    /// Pass that sets the targets, like those below.
    pub(crate) restrict: fn(Arch, &Restriction<'_, T>, Targets<'_, T>),
    pub(crate) displace: fn(Arch, &Displacement<'_, T>, Targets<'_, T>),
    pub(crate) restrict_uneven: fn(Arch, &UnevenRestriction<'_, T>, Targets<'_, T>),
    pub(crate) displace_uneven: fn(Arch, &UnevenDisplacement<'_, T>, Targets<'_, T>),
    pub(crate) displace_coarse: fn(Arch, &CoarseDisplacement<'_, T>, Targets<'_, T>),
    /// Pass that adds to the targets, like the one below.
    pub(crate) add_coarse: fn(Arch, &CoarseDensity<'_, T>, Targets<'_, T>),
    pub(crate) add_stencil: fn(Arch, &ShortRange<'_, T>, Targets<'_, T>),
}

impl<T: Arithmetic> TilePasses<T> {
    /// The passes for filters of `TAPS` taps.
    ///
    /// Patches have `AROUND` cells per side around one tile, and `UNDER` cells around the tiles under a coarse one.
    /// Where sides are not halved, a fine tile takes from a patch of `OVER` cells per side, and a coarse one from
    /// `BELOW` cells.
    pub(crate) const fn new<
        const TAPS: usize,
        const AROUND: usize,
        const UNDER: usize,
        const OVER: usize,
        const BELOW: usize,
    >() -> Self {
        Self {
            restrict: restrict::<T, TAPS, UNDER>,
            displace: displace::<T, TAPS, AROUND>,
            restrict_uneven: restrict_uneven::<T, 0, BELOW>,
            displace_uneven: displace_uneven::<T, OVER, AROUND>,
            displace_coarse: displace_coarse::<T, 0, AROUND>,
            add_coarse: add_coarse::<T, 0, AROUND>,
            add_stencil: add_stencil::<T, 0, AROUND>,
        }
    }
}

/// A function for a pass, with the vector instructions of the machine. (Closures would be compiled twice.)
macro_rules! dispatched {
    ($($name:ident: $Pass:ident),*) => {$(
        fn $name<T: Arithmetic, const TAPS: usize, const SIDE: usize>(
            arch: Arch,
            pass: &$Pass<'_, T>,
            targets: Targets<'_, T>,
        ) {
            arch.dispatch(Loop::<_, T, TAPS, SIDE> { pass, targets });
        }
    )*};
}

dispatched!(
    restrict: Restriction,
    displace: Displacement,
    restrict_uneven: UnevenRestriction,
    displace_uneven: UnevenDisplacement,
    displace_coarse: CoarseDisplacement,
    add_coarse: CoarseDensity,
    add_stencil: ShortRange
);

/// A pass for filters of `TAPS` taps, if it has filters, and patches of `SIDE` cells per side.
struct Loop<'a, P, T, const TAPS: usize, const SIDE: usize> {
    pass: &'a P,
    targets: Targets<'a, T>,
}

impl<T: Arithmetic, const TAPS: usize, const SIDE: usize> WithSimd for Loop<'_, Restriction<'_, T>, T, TAPS, SIDE> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Restriction { transfer, finer } = self.pass;
        let margin = ((SIDE - 2 * TILE) / 2 / TILE) as i64;
        let mut patch = [[T::default(); SIDE]; SIDE];
        for ([column, row], out) in self.targets.tiles() {
            let corner = (2 * i64::from(column) - margin, 2 * i64::from(row) - margin);
            if gather(finer.values, finer.tiles, corner, transfer.rows_to_restrict(SIDE), &mut patch) {
                transfer.restrict::<S, TAPS, SIDE>(&patch, out);
            } else {
                *out = [T::default(); CELLS];
            }
        }
    }
}

impl<T: Arithmetic, const TAPS: usize, const SIDE: usize> WithSimd for Loop<'_, Displacement<'_, T>, T, TAPS, SIDE> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Displacement { table: (taps, transfer), density, coarser } = self.pass;
        let margin = ((SIDE - TILE) / 2 / TILE) as i64;
        let mut patch = [[T::default(); SIDE]; SIDE];
        for ([column, row], out) in self.targets.tiles() {
            let half = (column as usize % 2, row as usize % 2);
            let corner = (i64::from(column / 2) - margin, i64::from(row / 2) - margin);
            gather(coarser.values, coarser.tiles, corner, transfer.rows_to_prolong(SIDE, half.1), &mut patch);
            transfer.prolong::<S, TAPS, SIDE>(&patch, half, out);
            add_short_range::<S, T, SIDE>(taps, *density, [column, row], &mut patch, out);
        }
    }
}

impl<T: Arithmetic, const TAPS: usize, const SIDE: usize> WithSimd
    for Loop<'_, UnevenRestriction<'_, T>, T, TAPS, SIDE>
{
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let UnevenRestriction { uneven, finer } = self.pass;
        let mut patch = [[T::default(); SIDE]; SIDE];
        for (place, out) in self.targets.tiles() {
            let under = uneven.to_restrict(place);
            if gather(finer.values, finer.tiles, under.corner, under.rows.clone(), &mut patch) {
                uneven.restrict::<S, SIDE>(place, (&under, &patch), out);
            } else {
                *out = [T::default(); CELLS];
            }
        }
    }
}

/// The loop with patches of `OVER` cells per side on the coarser level.
impl<T: Arithmetic, const OVER: usize, const SIDE: usize> WithSimd
    for Loop<'_, UnevenDisplacement<'_, T>, T, OVER, SIDE>
{
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let UnevenDisplacement { taps, uneven, density, coarser } = self.pass;
        let mut over = [[T::default(); OVER]; OVER];
        let mut patch = [[T::default(); SIDE]; SIDE];
        for (place, out) in self.targets.tiles() {
            let under = uneven.to_prolong(place);
            gather(coarser.values, coarser.tiles, under.corner, under.rows.clone(), &mut over);
            uneven.prolong::<S, OVER>(place, (&under, &over), out);
            add_short_range::<S, T, SIDE>(taps, *density, place, &mut patch, out);
        }
    }
}

impl<T: Arithmetic, const TAPS: usize, const SIDE: usize> WithSimd for Loop<'_, CoarseDensity<'_, T>, T, TAPS, SIDE> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let CoarseDensity { table, elements } = self.pass;
        let mut patch = [[T::default(); SIDE]; SIDE];
        for (place, out) in self.targets.tiles() {
            add_blur::<S, T, SIDE>(*table, *elements, place, &mut patch, out);
        }
    }
}

impl<T: Arithmetic, const TAPS: usize, const SIDE: usize> WithSimd
    for Loop<'_, CoarseDisplacement<'_, T>, T, TAPS, SIDE>
{
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let CoarseDisplacement { table, elements, finer, ghosts, level } = self.pass;
        let mut patch = [[T::default(); SIDE]; SIDE];
        for (place, out) in self.targets.tiles() {
            *out = [T::default(); CELLS];
            add_blur::<S, T, SIDE>(*table, *level, place, &mut patch, out);
            let Some(table) = table else { continue };
            add_short_range::<S, T, SIDE>(&table.near, *elements, place, &mut patch, out);
            for quarter in quarters(place) {
                if ghosts.find(i64::from(quarter[0]), i64::from(quarter[1])).is_none() {
                    continue;
                }
                let mut ghost = [T::default(); CELLS];
                if add_short_range::<S, T, SIDE>(&table.across, *finer, quarter, &mut patch, &mut ghost) {
                    means_of_quarter(quarter, &ghost, |cell, mean| out[cell] = out[cell] + mean);
                }
            }
        }
    }
}

impl<T: Arithmetic, const TAPS: usize, const SIDE: usize> WithSimd for Loop<'_, ShortRange<'_, T>, T, TAPS, SIDE> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let ShortRange { taps, values } = self.pass;
        let mut patch = [[T::default(); SIDE]; SIDE];
        for (place, out) in self.targets.tiles() {
            add_short_range::<S, T, SIDE>(taps, *values, place, &mut patch, out);
        }
    }
}
