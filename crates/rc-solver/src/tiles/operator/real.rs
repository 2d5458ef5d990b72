//! The arithmetic of the inner loops, in single or double precision.
//!
//! It has multiply-add, fused or not.

use pulp::Simd;
use rc_comm::Packed;
use rc_fft::TransformReal;

/// The number types `f32` and `f64`.
pub(crate) trait Arithmetic: TransformReal + Packed + Default + From<f32> + Into<f64> {
    /// The number nearest to one in double precision.
    fn rounded(value: f64) -> Self;

    /// `self · a + b` in one rounding.
    fn fused(self, a: Self, b: Self) -> Self;

    /// Number of rows of a tile that are summed at once.
    ///
    /// As many fit into eight registers of 256 bits.
    const ROWS: usize;
}

impl Arithmetic for f32 {
    fn rounded(value: f64) -> Self {
        value as Self
    }

    #[inline(always)]
    fn fused(self, a: Self, b: Self) -> Self {
        self.mul_add(a, b)
    }

    const ROWS: usize = 8;
}

impl Arithmetic for f64 {
    fn rounded(value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn fused(self, a: Self, b: Self) -> Self {
        self.mul_add(a, b)
    }

    const ROWS: usize = 4;
}

/// `sum + a b`, fused if the machine has the instruction. Without it, a fused one is a function call.
#[inline(always)]
pub(crate) fn add_product<S: Simd, T: Arithmetic>(sum: T, a: T, b: T) -> T {
    if S::IS_SCALAR { sum + a * b } else { a.fused(b, sum) }
}
