//! Errors in the statement of a contact problem.

use rc_core::Grid;
use thiserror::Error;

/// Heights, a load or a tolerance that are not possible.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ProblemError {
    /// The operator has another number of elements than the grid of the heights.
    #[error("the operator has {n_elements} elements and the heights are on {grid}")]
    Operator {
        /// Grid of the heights.
        grid: Grid,
        /// Elements of the operator.
        n_elements: usize,
    },
    /// The operator does not describe an elastic half-space.
    #[error("the operator is not that of a half-space: {0}")]
    NotElastic(OperatorFault),
    /// The kernel does not describe an elastic half-space.
    #[error(
        "the symbol of the kernel {kernel} at the wave ({kx}, {ky}) of {grid} elements is {value}; it must be {wanted}"
    )]
    Symbol {
        /// Name of the kernel.
        kernel: &'static str,
        /// The grid that it was asked for.
        grid: Grid,
        /// Wavenumber along x.
        kx: usize,
        /// Wavenumber along y.
        ky: usize,
        /// The eigenvalue, in λ/E*.
        value: f64,
        /// The condition that the eigenvalue must meet.
        wanted: &'static str,
    },
    /// A kernel hands over the split of another solid ([`rc_core::Kernel::split`]).
    #[error(
        "the split of the kernel {kernel} gives the {what} {value} at ({kx}, {ky}) of {grid} elements; it must be {wanted}{relation}"
    )]
    Split {
        /// Name of the kernel.
        kernel: &'static str,
        /// The grid.
        grid: Grid,
        /// The quantity that was compared.
        what: &'static str,
        /// Wavenumber along x. With free borders, it is a distance in elements.
        kx: usize,
        /// Wavenumber or distance along y.
        ky: usize,
        /// The value by the split.
        value: f64,
        /// The value by the kernel, or a bound.
        wanted: f64,
        /// How the value must be related to the wanted one.
        relation: &'static str,
    },
    /// A height is NaN or infinite.
    #[error("height at element ({ix}, {iy}) is {value}; heights must be finite")]
    Height {
        /// Column.
        ix: usize,
        /// Row.
        iy: usize,
        /// The value.
        value: f64,
    },
    /// The peak-to-valley height is not 0, and too small or too large to solve for.
    ///
    /// Its products with pressures would not be numbers.
    #[error(
        "the range of the heights must be 0 or from {smallest:e} to {greatest:e} (in units of the cell side), not {value:e}"
    )]
    HeightRange {
        /// h_max - h_min, in λ.
        value: f64,
        /// The smallest range that can be solved for, in λ.
        smallest: f64,
        /// The largest range that can be solved for, in λ.
        greatest: f64,
    },
    /// The mean pressure is not positive and finite.
    #[error("the mean pressure must be positive and finite, not {value}")]
    MeanPressure {
        /// Mean pressure given, in E*.
        value: f64,
    },
    /// The pressure of a fluid is on another grid than the heights.
    #[error("the pressure of the fluid is on {given} elements, and the heights are on {grid}")]
    FluidGrid {
        /// Grid of the heights.
        grid: Grid,
        /// Grid of the pressure.
        given: Grid,
    },
    /// The pressure of a fluid is negative, NaN or infinite.
    #[error("the pressure of the fluid at element ({ix}, {iy}) is {value}; it must be finite and at least 0")]
    FluidPressure {
        /// Column.
        ix: usize,
        /// Row.
        iy: usize,
        /// The value, in E*.
        value: f64,
    },
    /// The fluid bears the whole load, and nothing is left for a contact.
    #[error("the mean pressure must be above that of the fluid, {fluid}, not {value} (in units of E*)")]
    FluidBears {
        /// Mean pressure given, in E*.
        value: f64,
        /// Mean pressure of the fluid, in E*.
        fluid: f64,
    },
    /// The fluid keeps the bodies apart.
    #[error(
        "the penetration must be above {touching}, where the surfaces first touch under the fluid, not {value} (in units of the cell side)"
    )]
    FluidParts {
        /// Penetration given, in λ.
        value: f64,
        /// Penetration of first touch, in λ.
        touching: f64,
    },
    /// The hardness is not positive.
    #[error("the hardness must be positive, not {value}")]
    Hardness {
        /// Hardness given, in E*.
        value: f64,
    },
    /// The mean pressure is not below the hardness, the maximum pressure.
    #[error("the mean pressure must be below the hardness, {hardness}, not {value} (in units of E*)")]
    TooSoft {
        /// Mean pressure given, in E*.
        value: f64,
        /// Hardness given, in E*.
        hardness: f64,
    },
    /// The penetration is outside (0, Δ_full).
    ///
    /// Under penetration control no unique pressure exists beyond full contact. Use pressure control there.
    #[error(
        "the penetration must be above 0 and below that of full contact, {full_contact}, not {value} (in units of the cell side)"
    )]
    Penetration {
        /// Penetration given, in λ.
        value: f64,
        /// h_max - mean(h), in λ.
        full_contact: f64,
    },
    /// The penetration into a surface with a hardness is outside (0, `deepest`).
    ///
    /// Beyond `deepest` the pressure is the hardness everywhere. It is h_max - h_min, plus the compression of a layer
    /// by the hardness.
    #[error(
        "the penetration must be above 0 and below {deepest}, where all is plastic, not {value} (in units of the cell side)"
    )]
    FullyPlastic {
        /// Penetration given, in λ.
        value: f64,
        /// h_max - h_min plus the compression, in λ.
        deepest: f64,
    },
    /// The penetration is not positive and finite, on a solid that carries a uniform pressure.
    #[error("the penetration must be positive and finite, not {value} (in units of the cell side)")]
    Depth {
        /// Penetration given, in λ.
        value: f64,
    },
    /// The tolerance is not in (0, 1), or is smaller than rounding allows.
    #[error("the tolerance must be between {smallest:e} and 1, not {value:e}")]
    Tolerance {
        /// The tolerance given.
        value: f64,
        /// The smallest tolerance that can be certified.
        smallest: f64,
    },
}

/// A fault of an operator.
///
/// `a` and `b` are irregular pressures between -1/2 and 1/2, in E*.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum OperatorFault {
    /// A displacement is NaN or infinite, or the operator does not overwrite its output.
    #[error(
        "the displacement of element {element} is {value}; it must be finite, whatever numbers were in the output array before"
    )]
    NotFinite {
        /// Index of the element.
        element: usize,
        /// Its displacement, in λ.
        value: f64,
    },
    /// The mean of a displacement is not zero.
    #[error(
        "it displaces the mean by {mean:.1e} where it displaces elements by up to {largest:.1e}; the mean must be 0"
    )]
    Mean {
        /// Mean displacement, in λ.
        mean: f64,
        /// Maximum displacement, in λ.
        largest: f64,
    },
    /// One pressure has two displacements.
    #[error(
        "a second application differs by {change:.1e}, where displacements are up to {largest:.1e}; it must be the same each time"
    )]
    Changes {
        /// Maximum difference, in λ.
        change: f64,
        /// Maximum displacement, in λ.
        largest: f64,
    },
    /// A uniform pressure displaces the surface.
    #[error("a uniform pressure of E* displaces by up to {displacement:.1e}; it must displace nothing")]
    Uniform {
        /// Maximum displacement, in λ.
        displacement: f64,
    },
    /// The displacement of a sum is not the sum of displacements.
    #[error(
        "L(a + b) differs from L a + L b by {difference:.1e}, where displacements are up to {largest:.1e}; it must be linear"
    )]
    Linearity {
        /// Maximum difference, in λ.
        difference: f64,
        /// Maximum displacement, in λ.
        largest: f64,
    },
    /// Element i acts on j differently from j on i.
    #[error("<a, L b> = {ab:.6e} and <b, L a> = {ba:.6e}; it must be symmetric")]
    Symmetry {
        /// Σ a (L b), in E* λ.
        ab: f64,
        /// Σ b (L a), in E* λ.
        ba: f64,
    },
    /// A pressure does no work.
    #[error("<a, L a> = {energy:.1e}; it must be positive, since displacement follows pressure")]
    Energy {
        /// Σ a (L a), in E* λ.
        energy: f64,
    },
}
