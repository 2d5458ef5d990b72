//! The traits that a research fork implements to bring its own half-space or operator.

use crate::Grid;

/// Eigenvalue of an elastic operator on one grid, as a function of (|kx|, |ky|).
///
/// Arguments go up to half the number of elements along each side.
pub type Symbol<'a> = Box<dyn Fn(usize, usize) -> f64 + Send + Sync + 'a>;

/// What lies beyond the borders of the heights.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Boundary {
    /// The same heights again, as in a periodic cell.
    #[default]
    Periodic,
    /// The free surface of the solid, without pressure.
    Free,
}

/// Constants of the first-order error that a discretisation makes at the edges of contacts.
///
/// The first three terms are subtracted from a contact area whose edges are located between elements. Their unit is the
/// area of an element. The last term is added to Σ p².
///
/// The constants are fitted for each kernel (`docs/accuracy.md`). The default fits kernels that are similar to Love's
/// squares.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct EdgeBias {
    /// Term for each edge between an element in contact and an element out of contact.
    pub per_edge: f64,
    /// Term for each contact, because the shift of an edge depends on its curvature.
    ///
    /// Holes in contacts count as negative.
    pub per_contact: f64,
    /// Term for each element of deviation of the gap beside an edge.
    ///
    /// For a straight edge, gap ∝ s^(3/2) at distance s from the edge. This law assigns a distance to the gap two
    /// elements outside an edge. The deviation is this distance minus the true distance, in elements. It is not zero at
    /// curved edges and between contacts that are close to each other.
    pub per_deviation: f64,
    /// Missing part of Σ p² for each edge.
    ///
    /// It is relative to the square of the pressure beside the edge.
    pub per_square: f64,
}

impl Default for EdgeBias {
    /// The constants of Love's squares.
    ///
    /// The pressure is uniform on each element, and the displacement is taken at its centre.
    fn default() -> Self {
        Self { per_edge: 0.029, per_contact: -0.21, per_deviation: -0.0275, per_square: -0.06 }
    }
}

/// The elastic response of a periodic half-space to pressure on a uniform grid.
///
/// A layered or graded half-space is another `Kernel`. It needs two methods, and one of them returns a name.
/// [`crate::testing::check_kernel`] checks the contract.
///
/// # Not every linear solid is a `Kernel`
/// The solvers minimise an elastic energy, so a symbol is one positive number for a wave and its mirror images.
///
/// - **Viscoelastic solids** have a complex symbol at each frequency. The displacement lags behind the pressure, and
///   there is no energy to minimise. Instead, step in time. The response within a step is elastic, with a symbol that
///   is real. The displacement that remains from earlier steps is known, and is subtracted from the heights.
/// - **Shifts**, for example of a moving load, are complex too, with a factor exp(2πi k·d). Instead, move the heights.
/// - **Anisotropic solids** respond differently along different directions. Symbols here are even in kx and in ky, and
///   symmetric in kx and ky on a [square](Grid::is_square) grid. So the axes of the solid must be the axes of the cell,
///   and the grid must have different numbers of elements along them. A solid with oblique axes needs an [`Operator`]
///   of its own.
///
/// # What a solve checks
/// Before it starts, a solve evaluates the symbol on its grid. On a small grid it does so at every wave. On a large
/// grid it takes the longest wave, the shortest wave and one in 64 others. It refuses a symbol with one of these
/// faults:
///
/// - a value at a wave is NaN, infinite, zero or negative;
/// - the value at the zero wave is not zero;
/// - it is not symmetric on a square grid;
/// - a second evaluation gives another value.
///
/// The check cannot recognise a valid symbol of another solid, such as one with a wrong factor, a wrong thickness or
/// smooth noise. Compare with a known displacement. A fault at a single wave that was not evaluated shows only if it is
/// NaN or infinite. The solve does not converge then. Kernels with [`Kernel::is_split_by_scale`] are not checked.
pub trait Kernel: Sync {
    /// Short name, as used in result files.
    fn name(&self) -> &'static str;

    /// The symbol of `v = L p` on `grid`, in units of λ/E*.
    ///
    /// It is the factor between the pressure wave exp(2πi k·x) on element centres and its displacement. It is zero at
    /// k = 0, where the displacement has zero mean (Eq. 3), and positive elsewhere.
    ///
    /// The symbol is even in kx and in ky, so it is only evaluated for 0 ≤ kx ≤ nx/2 and 0 ≤ ky ≤ ny/2. On a
    /// [square](Grid::is_square) grid it is symmetric in kx and ky, so it may be evaluated for ky ≥ kx only.
    fn symbol(&self, grid: Grid) -> Symbol<'_>;

    /// Displacement of the cell under a uniform pressure of E*, in λ.
    ///
    /// A solid on a base has such a displacement. It is added to the displacement by [`Kernel::symbol`], which is zero
    /// at k = 0. The half-space returns `None`: its mean displacement is not finite and is left out (Eq. 3).
    fn uniform_displacement(&self) -> Option<f64> {
        None
    }

    /// Displacements around one loaded element, for heights with [`Boundary::Free`], or `None`.
    ///
    /// The function takes the distance (ix, iy) from the loaded element, in elements, for 0 ≤ ix < nx and 0 ≤ iy < ny.
    /// It returns the displacement there in λ, for a pressure of E*. The solver then uses it instead of
    /// [`Kernel::symbol`], which only preconditions the iteration. `None` means a periodic cell.
    fn free_response(&self, grid: Grid) -> Option<Symbol<'_>> {
        let _ = grid;
        None
    }

    /// First-order shift of the edges of contacts by the discretisation.
    ///
    /// It only corrects observables. The pressure does not depend on it. Short waves dominate at an edge, and most
    /// solids respond to short waves like a half-space. So the default fits every kernel whose elements are similar to
    /// Love's squares.
    fn edge_bias(&self) -> EdgeBias {
        EdgeBias::default()
    }

    /// Whether `rc_kernel::ScaleSplit` computes the displacements of this kernel.
    ///
    /// It splits the displacements of the half-space by scale, for pressures that are constant on elements. The elements
    /// are those of a periodic cell or, with [`Kernel::free_response`], those of a patch without images. The
    /// adaptive method is built on this split, so it works only with such a kernel.
    fn is_split_by_scale(&self) -> bool {
        false
    }
}

/// A linear map from pressure to zero-mean displacement, `v = L p` (Eq. 4).
///
/// It is symmetric for uniform grids.
///
/// [`crate::testing::check_operator`] checks the contract.
///
/// # What a solve checks
/// Before it starts, a solve applies the operator to two pressures without a pattern, and to the sum of both and a
/// uniform pressure. It refuses an operator with one of these faults:
///
/// - the displacement is not finite or has a mean;
/// - a second application gives another displacement;
/// - the displacement depends on the previous contents of output or scratch;
/// - the operator is not linear, not symmetric or not positive;
/// - a uniform pressure causes a displacement.
///
/// Each fault is compared with the tolerance of the solve, relative to the maximum displacement.
///
/// The check cannot recognise a valid operator of another solid, such as one with a wrong factor or with its elements
/// in another order than the heights. It cannot see a fault that comes later either, because the certificate of a
/// solution uses the same operator.
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
