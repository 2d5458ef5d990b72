//! The traits for an elastic solid or an operator of your own.

use std::sync::Arc;

use glam::DVec2;
use num_complex::Complex64;

use crate::grid::Grid;
use crate::sliding::{Sliding, SlidingModes};
use crate::split::SplitByScale;

/// Eigenvalue of an elastic operator on one grid, as a function of (|kx|, |ky|).
///
/// The wave has |kx| and |ky| periods per side. Arguments go up to half the number of elements along each side.
/// [`Kernel::free_response`] uses the same type for a displacement as a function of a distance.
pub type Symbol<'a> = Box<dyn Fn(usize, usize) -> f64 + Send + Sync + 'a>;

/// Complex eigenvalue of a solid under a sliding surface, as a function of (kx, ky), which may be negative.
///
/// The displacement is real, so the wave (-kx, -ky) has the conjugate value.
pub type ComplexSymbol<'a> = Box<dyn Fn(i64, i64) -> Complex64 + Send + Sync + 'a>;

/// What lies beyond the borders of the heights.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Boundary {
    /// The heights repeat themselves: the cell is periodic.
    #[default]
    Periodic,
    /// The free surface of the solid, without pressure.
    Free,
}

/// Constants of the first-order error that a discretisation makes at the edges of contacts.
///
/// The solver locates contact edges by interpolation between the centres of elements. Each constant gives a term of the
/// correction. The terms of the first three are subtracted from the resulting contact area, in units of the area of an
/// element. The next three correct Σ p² over elements, at edges and inside contacts. The last three widen error bars.
///
/// The constants are fitted for each kernel (`docs/accuracy.md`). The default is for kernels similar to Love's squares,
/// which have a uniform pressure on each element.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct EdgeBias {
    /// Term for each edge between an element in contact and an element out of contact.
    pub per_edge: f64,
    /// Term for each contact, because the shift of an edge depends on its curvature.
    ///
    /// Each hole in a contact reduces the number of contacts by one.
    pub per_contact: f64,
    /// Term per unit of deviation from the gap law beside an edge.
    ///
    /// For a straight edge, gap ∝ s^(3/2) at distance s from the edge. The pressure inside and the gap outside the edge
    /// give its interpolated position and the factor of this law. The law then converts the gap at the second element
    /// outside the edge to a distance. The deviation is this distance minus the distance to the interpolated edge, in
    /// element sides. It is not zero at curved edges and between contacts that are close to each other.
    pub per_deviation: f64,
    /// Term added to Σ p² for each edge.
    ///
    /// Its unit is the square of the pressure beside the edge.
    pub per_square: f64,
    /// Term added to Σ p² for each two neighbours in contact. Its unit is the square of their difference of pressure.
    ///
    /// In full contact, the squared amplitude of a wave q has the factor (L∞/L)² for the kernel's symbol L and that of
    /// the solid, L∞. On elements of the side h, Love's squares have L/L∞ = 1 - (q h)²/24 + …, and p² is too large by
    /// h² ⟨|∇p|²⟩/12. A kernel that is exact for long waves has 0 here.
    pub per_difference: f64,
    /// Term added to Σ p² for each three elements in a line in contact. Its unit is the square of their second
    /// difference.
    pub per_second_difference: f64,
    /// 95 % error of [`EdgeBias::per_edge`], as a common error of all edges.
    pub per_edge_error: f64,
    /// 95 % error of [`EdgeBias::per_difference`].
    pub per_difference_error: f64,
    /// 95 % errors of the mean gap and of the penetration: one common to all edges, and one for each of the independent
    /// edges, as a mean over them.
    ///
    /// Their unit is h ⟨p²⟩/(σ0 E*) for elements of the side h and the mean pressure σ0, times the ratio of elements at
    /// edges to elements in contact.
    pub gap_errors: [f64; 2],
}

impl EdgeBias {
    /// The constants of values without a discretisation error.
    pub const NONE: Self = Self {
        per_edge: 0.0,
        per_contact: 0.0,
        per_deviation: 0.0,
        per_square: 0.0,
        per_difference: 0.0,
        per_second_difference: 0.0,
        per_edge_error: 0.0,
        per_difference_error: 0.0,
        gap_errors: [0.0; 2],
    };
}

impl Default for EdgeBias {
    /// The constants of Love's squares.
    ///
    /// The pressure is uniform on each element, and the displacement is taken at its centre.
    fn default() -> Self {
        Self {
            per_edge: 0.029,
            per_contact: -0.21,
            per_deviation: -0.0275,
            per_square: 0.05,
            per_difference: -0.0743,
            per_second_difference: 0.0249,
            per_edge_error: 0.0,
            per_difference_error: 0.006,
            gap_errors: [0.034, 0.12],
        }
    }
}

/// The elastic response of a solid to pressure on a uniform grid.
///
/// The half-space, a layered solid and a graded one are different `Kernel`s. Only two methods are required, and one of
/// them returns a name. [`crate::testing::check_kernel`] checks the contract.
///
/// # Not every linear solid is a `Kernel`
/// The solvers minimise an elastic energy, so the symbol is real and positive. They also assume equal values for a wave
/// and its mirror images.
///
/// - **Viscoelastic solids** under a surface that slides steadily have a complex symbol: the displacement lags behind
///   the pressure. [`Kernel::sliding_symbol`] gives it, and [`Kernel::symbol`] then is that of the relaxed solid. The
///   real part must be positive, as it is for each wave of a material that dissipates. Other histories of load need steps in
///   time: the response within a step is elastic, and the displacement that remains from earlier steps is subtracted
///   from the heights.
/// - **Shifted responses** have a complex symbol with a factor exp(2πi k·d). Instead, move the heights.
/// - **Anisotropic solids** respond differently along different directions. Symbols here are even in kx and in ky. The
///   axes of an anisotropic solid must therefore be the axes of the cell. On a [square](Grid::is_square) grid, symbols
///   are also symmetric in kx and ky. The grid must therefore not be square: the cell is a rectangle, or the numbers of
///   elements along its sides differ. A solid with oblique axes needs its own [`Operator`].
///
/// # What a solve checks
/// Before it starts, a solve evaluates the symbol on its grid. If the grid has at most 512 waves, it does so at every
/// wave. On larger grids it takes the longest waves, the shortest waves, and a sample of the others. The sample has one
/// wave in 64, but at least 512 and at most 65536. The solve refuses a symbol with one of these faults:
///
/// - a value at a wave is NaN, infinite, zero or negative;
/// - the value at the zero wave is not zero;
/// - the symbol is not symmetric on a square grid;
/// - a second evaluation gives another value.
///
/// The check does not notice a valid symbol of the wrong solid: with a wrong factor, a wrong thickness or smooth noise.
/// Compare with a known displacement. A fault at a single wave that was not evaluated is noticed only if the value is
/// NaN or infinite, because the solve then does not converge. The adaptive method also checks [`Kernel::split`].
pub trait Kernel: Sync {
    /// Short name, as used in result files.
    fn name(&self) -> &'static str;

    /// The symbol of `v = L p` on `grid`, in units of λ/E*.
    ///
    /// The symbol is the ratio of displacement to pressure for the wave exp(2πi k·x) on element centres. It is zero at
    /// k = 0, because the displacement has zero mean (Eq. 3), and positive elsewhere.
    ///
    /// A solve calls this method a few times for each of its grids. It evaluates the returned function a few times for
    /// each wave and stores the values, so a kernel need not store them.
    ///
    /// The symbol is even in kx and in ky, so it is only evaluated for 0 ≤ kx ≤ nx/2 and 0 ≤ ky ≤ ny/2. On a
    /// [square](Grid::is_square) grid it is symmetric in kx and ky, so it may be evaluated for ky ≥ kx only.
    fn symbol(&self, grid: Grid) -> Symbol<'_>;

    /// The velocity of a surface that slides steadily over the solid, in λ per unit of time. `None` at rest.
    fn sliding_velocity(&self) -> Option<DVec2> {
        None
    }

    /// The symbol for steady sliding, in units of λ/E*, if the kernel has a [`Kernel::sliding_velocity`].
    ///
    /// E* is the relaxed modulus, and [`Kernel::symbol`] the symbol at rest.
    fn sliding_symbol(&self, grid: Grid) -> Option<ComplexSymbol<'_>> {
        let _ = grid;
        None
    }

    /// The retardation of the solid, if it has finitely many times and the velocity is along x.
    ///
    /// Methods that split the response by scale need it. The compliance is that of [`Kernel::sliding_symbol`].
    fn sliding_modes(&self) -> Option<SlidingModes> {
        None
    }

    /// The symbol of a solid of this shape whose material relaxes while a surface slides over it.
    ///
    /// A kernel whose waves are those of the continuous solid multiplies its symbol by the compliance of the wave, as
    /// the default does. A kernel that sums over aliases has the compliance of each alias inside the sum.
    fn symbol_while<'a>(&'a self, sliding: &Sliding, grid: Grid) -> ComplexSymbol<'a> {
        let (symbol, sliding) = (self.symbol(grid), sliding.clone());
        Box::new(move |kx, ky| {
            symbol(kx.unsigned_abs() as usize, ky.unsigned_abs() as usize)
                * sliding.compliance(grid.angular_wave(kx, ky))
        })
    }

    /// Displacement of the cell under a uniform pressure of E*, in λ.
    ///
    /// A solid on a rigid base has such a displacement, because a uniform pressure compresses it. It is added to the
    /// displacement from [`Kernel::symbol`], which is zero at k = 0. The half-space returns `None`: its mean
    /// displacement is not finite and is left out (Eq. 3).
    fn uniform_displacement(&self) -> Option<f64> {
        None
    }

    /// The half-space on the same elements, or `None` if the kernel itself is that of a half-space.
    ///
    /// Current between contact spots spreads in a half-space as its displacement does, whatever else is below them.
    fn half_space(&self) -> Option<&dyn Kernel> {
        None
    }

    /// Displacements around one loaded element, for heights with [`Boundary::Free`], or `None`.
    ///
    /// The function takes the distance (ix, iy) from the loaded element, in elements, for 0 ≤ ix < nx and 0 ≤ iy < ny.
    /// It returns the displacement there in λ, for a pressure of E*. The solver then uses this function instead of
    /// [`Kernel::symbol`]. The symbol only preconditions the iteration. `None` means a periodic cell.
    fn free_response(&self, grid: Grid) -> Option<Symbol<'_>> {
        let _ = grid;
        None
    }

    /// First-order shift of the edges of contacts by the discretisation.
    ///
    /// The shift only corrects observables on elements of the size of those of `grid`. The pressure does not depend on
    /// it. Short waves dominate at an edge, and most solids respond to short waves like a half-space. Therefore the
    /// default fits every kernel whose elements are similar to Love's squares.
    fn edge_bias(&self, grid: Grid) -> EdgeBias {
        let _ = grid;
        EdgeBias::default()
    }

    /// The split of the displacements by scale, which the adaptive method needs.
    ///
    /// `None` means that the kernel is solved on the uniform grid. A kernel of an isotropic solid has a split if its
    /// elements are Love's squares and short waves see the half-space. Such a kernel can return the split of
    /// `rc_kernel::Love`, or an object of its own.
    fn split(&self) -> Option<&dyn SplitByScale> {
        None
    }

    /// A copy of the kernel that solutions keep, or `None`.
    ///
    /// A solution with a borrowed kernel that has to outlive the borrow keeps this copy. Without one, it computes
    /// stiffness and displacement before the borrow ends.
    fn to_shared(&self) -> Option<Arc<dyn Kernel + Send + Sync>> {
        None
    }
}

/// A linear map from pressure to zero-mean displacement, `v = L p` (Eq. 4).
///
/// It is symmetric for uniform grids.
///
/// [`crate::testing::check_operator`] checks the contract.
///
/// # What a solve checks
/// Before it starts, a solve applies the operator to two irregular pressures a and b. It then applies the operator to
/// the sum of a, b and a uniform pressure. If the displacements do not add up, two more applications find the reason.
/// The solve refuses an operator with one of these faults:
///
/// - the displacement is not finite or has a mean;
/// - two applications to the same pressure give different displacements;
/// - the displacement depends on the previous contents of output or scratch;
/// - the operator is not linear, not symmetric or not positive;
/// - a uniform pressure causes a displacement.
///
/// A deviation counts as a fault if it exceeds the tolerance of the solve, relative to the maximum displacement.
///
/// The check does not notice a valid operator of the wrong solid, for example with a wrong factor or a different order
/// of elements. A small fault that appears after the check may also go unnoticed, because the certificate uses the
/// same operator.
pub trait Operator: Sync {
    /// Number of elements, which is the length of pressure and displacement.
    fn n_elements(&self) -> usize;

    /// Length of the scratch slice that [`Operator::apply`] needs.
    fn scratch_len(&self) -> usize;

    /// Computes `displacement = L pressure`, in λ for pressures in E*.
    ///
    /// `scratch` may hold any values before the call, and holds no useful values after it. The result must not depend
    /// on the number of threads.
    ///
    /// # Panics
    /// When the length of a slice is not what the two methods above return.
    fn apply(&self, pressure: &[f64], displacement: &mut [f64], scratch: &mut [f64]);
}
