//! Precision of a hierarchy of levels.

use std::iter::Sum;
use std::ops::{Add, AddAssign, Div, Mul, Sub, SubAssign};

/// `f32`, or `f64` if single precision does not distinguish a weak bond from rounding.
pub(crate) trait Real:
    Copy
    + Default
    + PartialOrd
    + Send
    + Sync
    + std::fmt::Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + AddAssign
    + SubAssign
    + Sum
{
    const ZERO: Self;
    const ONE: Self;
    /// Smallest normal number.
    const TINY: Self;
    /// `value` rounded.
    fn of(value: f64) -> Self;
    fn to_f64(self) -> f64;
    fn abs(self) -> Self;
}

macro_rules! real {
    ($($real:ident),+) => {$(
        impl Real for $real {
            const ZERO: Self = 0.0;
            const ONE: Self = 1.0;
            const TINY: Self = $real::MIN_POSITIVE;

            #[inline]
            fn of(value: f64) -> Self {
                value as Self
            }

            #[inline]
            fn to_f64(self) -> f64 {
                f64::from(self)
            }

            #[inline]
            fn abs(self) -> Self {
                $real::abs(self)
            }
        }
    )+};
}

real!(f32, f64);
