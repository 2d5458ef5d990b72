//! `L_ij = l_ij - l_m` of Eq. 4-6, over all images, between any two elements of the cell.
//!
//! The nearest image of the source is a square in free space ([`crate::square`]). All other images and the background
//! add the mean of a smooth function over the source. This mean is tabulated by size ([`crate::averages`]).

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

/// Half side d below which the contribution of the images is that of a point.
///
/// The difference, d²/6 times the Laplacian of ψ (below 20), is then below 2e-13.
const POINT: f64 = 2.4e-7;

/// The smooth part, fitted once per process, and its tables. Each table is made when it is first used.
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

/// The coefficients `L_ij = l_ij - l_m` of Eq. 4-6, with all images, to 1e-12.
///
/// `L_ij` is the displacement at the centre of element i, minus its mean over the cell. The load is unit pressure on
/// the square element j and its images, and a uniform counter-load. So `L_ij = 1/(π E*) ∫ φ ds` over the square, with φ
/// of [`ewald_phi`](crate::ewald_phi), in units of λ p/E*. The sum over a row is 0 on any tiling of the cell.
///
/// *Accuracy*: the error is at most 1e-12 of the larger of |L_ij| and (2d)², the area of the source. Relative to L_ij
/// alone it has no meaning where L_ij changes sign. Measured errors are 1.4e-13 for sides of λ/2 and 6e-14 for smaller
/// ones, down to half sides of 2^-17, at all offsets (test `coefficients_match_the_quadrature_of_ewald_sums`). The
/// result is exactly symmetric under x → -x, y → -y and x ↔ y.
///
/// *Cost*, on one core of x86-64 without AVX, for half sides 2^-2, 2^-3, … and all below 2.4e-7: 54 ns within 13 half
/// sides of the source, and 31 ns beyond. Other half sides take 0.7 µs. A [`PeriodicSource`] has a table for one of
/// them. A square larger than λ/4 without a table is the sum of its quarters, which costs 4 to 16 times as much. The
/// first use in a process takes 1 ms, and the first use of a size takes 0.3 ms. After that, a value of this type is
/// only a pointer.
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
    /// The tables that all users in this process share. For the cost see [`PeriodicLove`].
    #[must_use]
    pub fn new() -> Self {
        Self { tables: &TABLES }
    }

    /// `L_ij` for a source of half-side `half_side` d at `offset`, in units of λ.
    ///
    /// The offset is target minus source. It may be between any images. It is wrapped into the cell, to [-1/2, 1/2]².
    /// Arguments are not checked. For an offset that is not finite, or `half_side` not in (0, 1/2], the result has no
    /// meaning. [`Self::try_coefficient`] checks.
    #[inline]
    #[must_use]
    pub fn coefficient(&self, offset: DVec2, half_side: f64) -> f64 {
        debug_assert!(check_offset(offset).is_ok() && check_half_side(half_side).is_ok());
        match self.tables.of(half_side) {
            Some(table) => with_table(table, offset.x, offset.y, half_side),
            None => self.without_table(offset, half_side),
        }
    }

    /// As [`Self::coefficient`], with checked arguments.
    ///
    /// # Errors
    /// [`KernelError`] for an offset that is not finite, or `half_side` not in (0, 1/2].
    pub fn try_coefficient(&self, offset: DVec2, half_side: f64) -> Result<f64, KernelError> {
        check_offset(offset)?;
        check_half_side(half_side)?;
        Ok(self.coefficient(offset, half_side))
    }

    /// A table for sources of one size that is not a power of two.
    ///
    /// It is made in 0.3 ms and takes 40 kB.
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

/// The coefficients `L_ij` of Eq. 4-6 for sources of one size.
///
/// They come from [`PeriodicLove::source`] and have its accuracy and speed.
#[derive(Debug)]
pub struct PeriodicSource {
    /// Half side of one piece of the source.
    half_side: f64,
    /// Number of pieces along a side, which is 1 up to λ/4.
    pieces: usize,
    table: MeanTable,
}

impl PeriodicSource {
    /// `L_ij` at `offset` = target minus source, as [`PeriodicLove::coefficient`].
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
    /// The table for `half_side`, or `None` if there is none.
    #[inline]
    fn of(&self, half_side: f64) -> Option<&MeanTable> {
        let bits = half_side.to_bits();
        // A power of two has only an exponent. The exponent of 2^-level is 1023 - level.
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
        // A square of side λ/2 is too close to its images for the fit of ψ. The contribution of the images is smooth at
        // the offsets of this square. It is the sum of the quarters minus the nearest image.
        let (half, side) = (0.5 * half_side, 2.0 * half_side);
        let quarter = self.make(half);
        MeanTable::of_means(|offset| {
            let all = PI * quarters(offset, half, |offset| with_table(&quarter, offset.x, offset.y, half));
            (all - square_integral(offset.max_element(), offset.min_element(), half_side)) / (side * side)
        })
    }
}

/// `L_ij` at an offset (`dx`, `dy`).
///
/// The offset is not a [`DVec2`], which would cost 5 ns. Where this is not inlined, two numbers are passed in
/// floating-point registers, but a struct is not.
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

/// The nearest image plus the rest, which follows from its mean over the source.
#[inline]
fn assembled(long: f64, short: f64, half_side: f64, mean: f64) -> f64 {
    let side = 2.0 * half_side;
    FRAC_1_PI * (square_integral(long, short, half_side) + side * side * mean)
}

/// The sum of `of` over the centres of four quarters.
///
/// They are `half` from the centre along each axis. The offset is folded first, so that symmetric offsets add the same
/// numbers in the same order.
fn quarters(offset: DVec2, half: f64, of: impl Fn(DVec2) -> f64) -> f64 {
    let (folded, diagonal, other_diagonal) =
        (DVec2::from(folded(offset.x, offset.y)), DVec2::splat(half), DVec2::new(half, -half));
    (of(folded - diagonal) + of(folded + diagonal)) + (of(folded - other_diagonal) + of(folded + other_diagonal))
}
