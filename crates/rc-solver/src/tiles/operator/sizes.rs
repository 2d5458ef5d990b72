//! Numbers of taps and sides of patches that the inner loops are compiled for.

use rc_kernel::SplitParams;

use crate::tiles::operator::passes::TilePasses;
use crate::tiles::operator::real::Arithmetic;

/// The numbers of taps and the sides of patches of compiled inner loops.
///
/// Filters are filled up to such a number of taps, and patches are as large as that needs.
#[derive(Clone, Copy)]
pub(crate) struct Sizes<T> {
    /// Number of taps of filters.
    pub(crate) taps: usize,
    /// Maximum number of cells that stencils reach.
    cutoff: usize,
    /// Side of the patch around one tile.
    pub(crate) around: usize,
    pub(crate) passes: TilePasses<T>,
}

impl<T: Arithmetic> Sizes<T> {
    /// Sizes from the number of taps and the sides of patches.
    ///
    /// `UNDER` is the side of the patch around the four tiles under a coarse one. Where sides are not halved, a fine
    /// tile takes from a patch of side `OVER`, and a coarse one from a patch of side `BELOW`. These hold 12 elements
    /// more than the taps, and 23 more than twice the taps.
    const fn new<const TAPS: usize, const AROUND: usize, const UNDER: usize, const OVER: usize, const BELOW: usize>(
        cutoff: usize,
    ) -> Self {
        let passes = TilePasses::new::<TAPS, AROUND, UNDER, OVER, BELOW>();
        Self { taps: TAPS, cutoff, around: AROUND, passes }
    }
}

/// Numbers that the operator works with: `f32` for errors from 1e-6 on, `f64` for any.
pub(crate) trait Real: Arithmetic {
    /// The compiled sizes, smallest first.
    const SIZES: &'static [Sizes<Self>];

    /// The smallest compiled sizes that hold the split kernel's filters and stencils.
    ///
    /// # Panics
    /// When the split has an error that this precision does not reach.
    fn sizes(split: SplitParams) -> Sizes<Self> {
        let fits = |sizes: &&Sizes<Self>| split.cutoff <= sizes.cutoff && split.taps <= sizes.taps;
        *Self::SIZES.iter().find(fits).expect("single precision is for errors from 1e-6 on")
    }
}

impl Real for f32 {
    const SIZES: &'static [Sizes<Self>] = &[Sizes::new::<4, 24, 32, 16, 32>(8), Sizes::new::<16, 24, 48, 32, 56>(8)];
}

impl Real for f64 {
    const SIZES: &'static [Sizes<Self>] = &[Sizes::new::<16, 24, 48, 32, 56>(8), Sizes::new::<32, 40, 80, 48, 88>(16)];
}
