//! `L_ij = l_ij - l_m` of Eq. 4-6, over all images, between any two elements of the cell.
//!
//! The nearest image of the source is a square in free space ([`crate::square`]). All other images, with the
//! background, add the mean over the source of a smooth function, which is tabulated by size ([`crate::averages`]).

use std::f64::consts::{FRAC_1_PI, PI};
use std::sync::{LazyLock, OnceLock};

use rc_core::DVec2;

use crate::KernelError;
use crate::averages::{MAX_HALF_SIDE, MeanTable, Remainder};
use crate::lattice::wrap;
use crate::square::square_integral;
use crate::truncated::{check_half_side, check_offset};

/// Half sides 2^-2 to 2^-21 have a table each.
const FIRST_LEVEL: usize = 2;
const LEVELS: usize = 20;

/// Below this half side d, the share of the images is that of a point: the difference, d²/6 times the Laplacian of ψ
/// (below 20), is below 2e-13.
const POINT: f64 = 2.4e-7;

/// The smooth part, fitted once per process, and its tables, each made when first used.
#[derive(Debug)]
struct Tables {
    remainder: Remainder,
    levels: [OnceLock<MeanTable>; LEVELS],
    point: OnceLock<MeanTable>,
}

static TABLES: LazyLock<Tables> = LazyLock::new(|| Tables {
    remainder: Remainder::new(),
    levels: [const { OnceLock::new() }; LEVELS],
    point: OnceLock::new(),
});

/// The coefficients `L_ij = l_ij - l_m` of Eq. 4-6, all images, to 1e-12.
///
/// `L_ij` is the displacement at the centre of element i, minus its mean over the cell, under unit pressure on the
/// square element j, its images, and a uniform counter-load: `1/(π E*) ∫ φ ds` over the square, with φ of
/// [`ewald_phi`](crate::ewald_phi). In units of λ p/E*. The sum over a row is 0 on any tiling of the cell.
///
/// *Accuracy*: error at most 1e-12 of the larger of |L_ij| and (2d)², the area of the source: where L_ij changes sign
/// its relative error has no meaning. Measured 1.4e-13 for sides of λ/2 and 6e-14 for smaller ones, down to half sides
/// of 2^-17, at all offsets (test `coefficients_match_the_quadrature_of_ewald_sums`). Exactly symmetric under x → -x, y
/// → -y and x ↔ y.
///
/// *Cost*, one core, x86-64 without AVX: 54 ns within 13 half sides of the source, 31 ns beyond, for half sides 2^-2,
/// 2^-3, … and all below 2.4e-7. Other half sides take 0.7 µs; a [`PeriodicSource`] has a table for one of them.
/// Another square larger than λ/4 is the sum of its quarters, so 4 to 16 times as much. The first use in a process
/// takes 1 ms, and the first use of a size 0.3 ms; after that this is a pointer.
#[derive(Clone, Copy, Debug)]
pub struct PeriodicLove {
    tables: &'static Tables,
}

impl Default for PeriodicLove {
    fn default() -> Self {
        Self::new()
    }
}

impl PeriodicLove {
    /// The tables shared by all of this process; see [`PeriodicLove`] for the cost.
    #[must_use]
    pub fn new() -> Self {
        Self { tables: &TABLES }
    }

    /// `L_ij` for a source of half-side `half_side` d at `offset` = target minus source, in units of λ.
    ///
    /// The offset may be between any images: it is wrapped into the cell, to [-1/2, 1/2]². Nothing is checked: for an
    /// offset that is not finite or `half_side` not in (0, 1/2] the result has no meaning ([`Self::try_coefficient`]
    /// checks).
    #[inline]
    #[must_use]
    pub fn coefficient(&self, offset: DVec2, half_side: f64) -> f64 {
        debug_assert!(check_offset(offset).is_ok() && check_half_side(half_side).is_ok());
        match self.tables.of(half_side) {
            Some(table) => with_table(table, offset.x, offset.y, half_side),
            None => self.without_table(offset, half_side),
        }
    }

    /// As [`Self::coefficient`], checked.
    ///
    /// # Errors
    /// [`KernelError`]: an offset that is not finite, or `half_side` not in (0, 1/2].
    pub fn try_coefficient(&self, offset: DVec2, half_side: f64) -> Result<f64, KernelError> {
        check_offset(offset)?;
        check_half_side(half_side)?;
        Ok(self.coefficient(offset, half_side))
    }

    /// A table for sources of one size, when it is not a power of two: made in 0.3 ms, 40 kB.
    ///
    /// # Errors
    /// [`KernelError::HalfSide`] when `half_side` is not in (0, 1/2].
    pub fn source(&self, half_side: f64) -> Result<PeriodicSource, KernelError> {
        check_half_side(half_side)?;
        let mut pieces = 1;
        while half_side / pieces as f64 > MAX_HALF_SIDE {
            pieces *= 2;
        }
        let piece = half_side / pieces as f64;
        Ok(PeriodicSource { half_side: piece, pieces, table: MeanTable::new(&self.tables.remainder, piece) })
    }

    #[cold]
    #[inline(never)]
    fn without_table(self, offset: DVec2, half_side: f64) -> f64 {
        if half_side > 0.5 {
            f64::NAN
        } else if half_side > MAX_HALF_SIDE {
            let half = 0.5 * half_side;
            quarters(offset, half, |offset| self.coefficient(offset, half))
        } else {
            let (long, short) = folded(offset.x, offset.y);
            assembled(long, short, half_side, self.tables.remainder.mean(DVec2::new(long, short), half_side))
        }
    }
}

/// The coefficients `L_ij` of Eq. 4-6 for sources of one size; from [`PeriodicLove::source`], as accurate and as fast.
#[derive(Debug)]
pub struct PeriodicSource {
    /// Half side of one piece of the source.
    half_side: f64,
    /// Pieces along a side: 1 up to λ/4.
    pieces: usize,
    table: MeanTable,
}

impl PeriodicSource {
    /// `L_ij` at `offset` = target minus source; see [`PeriodicLove::coefficient`].
    #[inline]
    #[must_use]
    pub fn coefficient(&self, offset: DVec2) -> f64 {
        debug_assert!(check_offset(offset).is_ok());
        if self.pieces == 1 {
            with_table(&self.table, offset.x, offset.y, self.half_side)
        } else {
            self.of_pieces(offset)
        }
    }

    #[cold]
    #[inline(never)]
    fn of_pieces(&self, offset: DVec2) -> f64 {
        let one = |offset: DVec2| with_table(&self.table, offset.x, offset.y, self.half_side);
        let four = |offset: DVec2| quarters(offset, self.half_side, one);
        if self.pieces == 2 { four(offset) } else { quarters(offset, 2.0 * self.half_side, four) }
    }
}

impl Tables {
    /// The table for `half_side`, when there is one.
    #[inline]
    fn of(&self, half_side: f64) -> Option<&MeanTable> {
        let bits = half_side.to_bits();
        // A power of two has only an exponent; that of 2^-level is 1023 - level.
        if bits << 12 == 0 {
            let level = 1023_usize.wrapping_sub((bits >> 52) as usize);
            if let Some(table) = self.levels.get(level.wrapping_sub(FIRST_LEVEL)) {
                return Some(table.get_or_init(|| self.make(half_side)));
            }
        }
        (half_side < POINT).then(|| self.point.get_or_init(|| self.make(0.0)))
    }

    #[cold]
    #[inline(never)]
    fn make(&self, half_side: f64) -> MeanTable {
        if half_side <= MAX_HALF_SIDE {
            return MeanTable::new(&self.remainder, half_side);
        }
        // A square of side λ/2 reaches too near its images for the fit of ψ. The share of the images at its own offsets
        // is smooth: it is the sum of the quarters minus the nearest image.
        let (half, side) = (0.5 * half_side, 2.0 * half_side);
        let quarter = self.make(half);
        MeanTable::of_means(|offset| {
            let all = PI * quarters(offset, half, |offset| with_table(&quarter, offset.x, offset.y, half));
            (all - square_integral(offset.max_element(), offset.min_element(), half_side)) / (side * side)
        })
    }
}

/// `L_ij` at an offset, not as a [`DVec2`]: where this is not inlined, two numbers are passed in floating-point
/// registers and a struct is not, which costs 5 ns.
#[inline]
fn with_table(table: &MeanTable, dx: f64, dy: f64, half_side: f64) -> f64 {
    let (long, short) = folded(dx, dy);
    assembled(long, short, half_side, table.mean(long, short))
}

/// The offset to the nearest image, folded into 0 ≤ short ≤ long ≤ 1/2.
#[inline]
fn folded(dx: f64, dy: f64) -> (f64, f64) {
    let (x, y) = (wrap(dx).abs(), wrap(dy).abs());
    if x >= y { (x, y) } else { (y, x) }
}

/// The nearest image, and the rest from its mean over the source.
#[inline]
fn assembled(long: f64, short: f64, half_side: f64, mean: f64) -> f64 {
    let side = 2.0 * half_side;
    FRAC_1_PI * (square_integral(long, short, half_side) + side * side * mean)
}

/// The sum of `of` over the centres of four quarters, `half` from the centre along each axis.
///
/// The offset is folded first, so that symmetric offsets add the same numbers in the same order.
fn quarters(offset: DVec2, half: f64, of: impl Fn(DVec2) -> f64) -> f64 {
    let (folded, diagonal, other_diagonal) =
        (DVec2::from(folded(offset.x, offset.y)), DVec2::splat(half), DVec2::new(half, -half));
    (of(folded - diagonal) + of(folded + diagonal)) + (of(folded - other_diagonal) + of(folded + other_diagonal))
}
