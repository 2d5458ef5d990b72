//! The arithmetic of the inner loops, in single or double precision, with or without fused multiply-add.

use rc_fft::Plan;

/// `f32` or `f64`.
pub(crate) trait Real: Plan + Default + From<f32> {
    /// Rounded from double precision.
    fn rounded(value: f64) -> Self;

    /// `self · a + b` in one rounding.
    fn fused(self, a: Self, b: Self) -> Self;

    /// Rows of a tile that are summed at once: as many as fit into eight registers of 256 bits.
    const ROWS: usize;
}

impl Real for f32 {
    fn rounded(value: f64) -> Self {
        value as Self
    }

    #[inline(always)]
    fn fused(self, a: Self, b: Self) -> Self {
        self.mul_add(a, b)
    }

    const ROWS: usize = 8;
}

impl Real for f64 {
    fn rounded(value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn fused(self, a: Self, b: Self) -> Self {
        self.mul_add(a, b)
    }

    const ROWS: usize = 4;
}

/// How products are added: chosen once for the machine, since a fused multiply-add without hardware is a function call.
pub(crate) trait MultiplyAdd: Send + Sync {
    /// `sum + a b`
    fn add<T: Real>(sum: T, a: T, b: T) -> T;
}

/// Machines that have the instruction.
pub(crate) struct Fused;

/// Machines that have not.
pub(crate) struct Separate;

impl MultiplyAdd for Fused {
    #[inline(always)]
    fn add<T: Real>(sum: T, a: T, b: T) -> T {
        a.fused(b, sum)
    }
}

impl MultiplyAdd for Separate {
    #[inline(always)]
    fn add<T: Real>(sum: T, a: T, b: T) -> T {
        sum + a * b
    }
}
