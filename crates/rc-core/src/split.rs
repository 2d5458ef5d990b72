//! How a solid deviates from the half-space, for methods that split the response by scale.

/// An isotropic solid that responds to short waves like the half-space, for the adaptive method.
///
/// [`Kernel::split`](crate::Kernel::split) returns it. The adaptive method splits the displacement by the scale of the
/// waves. Its short-range parts are those of the half-space: pressures are uniform on each element and displacements
/// are taken at its centre, as in `rc_kernel::Love`. The rest is computed on the base grid, a coarse grid with a
/// Fourier transform. There the symbol at the angular wavenumber q (in rad/λ) is 2/q plus [`SplitByScale::deviation`],
/// in λ/E*.
///
/// `rc_kernel::HalfSpace` is the split of the half-space. All three methods return zero for it. `rc_kernel::Layer` is that
/// of a layer or a coating. A uniform pressure adds [`Kernel::uniform_displacement`](crate::Kernel::uniform_displacement).
///
/// # What a solve checks
/// The adaptive method computes with this object, not with [`Kernel::symbol`](crate::Kernel::symbol). Before a solve,
/// it compares both at the longest waves of the grid of the heights, and at a sample of the others. With free borders,
/// it compares [`Kernel::free_response`](crate::Kernel::free_response). It refuses a relative difference above 1e-8. It
/// also refuses a bound that the deviation exceeds at one of these waves.
pub trait SplitByScale: Sync {
    /// The symbol minus that of the half-space, 2/q, at the angular wavenumber `q` > 0, in λ/E*.
    fn deviation(&self, q: f64) -> f64;

    /// The angular wavenumber from which on the deviation is at most `tolerance` times 2/q.
    ///
    /// The base grid must resolve all waves below it, for a tolerance of 2e-6. Otherwise the adaptive method does not
    /// solve the problem. Smaller deviations that it does not resolve count as an error of the operator. Problems with
    /// free borders are not solved, unless the value is zero.
    fn deviates_below(&self, tolerance: f64) -> f64;

    /// Bound of the second derivatives, along the axes, of the displacement that the deviation adds.
    ///
    /// It holds for pressures between 0 and 1. One such bound is ∫ |∂²κ/∂x²| over the plane, where κ is the inverse
    /// Fourier transform of the deviation. The adaptive method excludes contact between the points of the base grid by
    /// this bound.
    fn curvature(&self) -> f64;
}
