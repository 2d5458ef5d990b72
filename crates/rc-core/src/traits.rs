//! The traits that a research fork implements to bring its own half-space or operator.

use crate::Grid;

/// Eigenvalues of an elastic operator on one grid: maps (|kx|, |ky|), up to half the grid, to the eigenvalue.
pub type Symbol<'a> = Box<dyn Fn(usize, usize) -> f64 + Send + Sync + 'a>;

/// What is beyond the borders of the heights.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Boundary {
    /// The same heights again: a periodic cell.
    #[default]
    Periodic,
    /// The free surface of the solid, which nothing presses on.
    Free,
}

/// The first-order error of a discretisation at the edges of contacts, per edge: the first three terms are subtracted
/// from a contact area whose edges are located between elements, in areas of an element; the last is added to Σ p².
///
/// The constants are fitted, kernel by kernel (`docs/accuracy.md`). The default is that of a kernel like Love's
/// squares.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct EdgeBias {
    /// For each edge between an element in contact and one out of it.
    pub per_edge: f64,
    /// For each contact, holes in contacts counted negative: the shift of an edge depends on its curvature.
    pub per_contact: f64,
    /// For each element by which the gap two elements outside an edge deviates from the law of a straight edge, gap ∝
    /// s^(3/2) at the distance s: it does at edges that curve and between contacts that are close.
    pub per_deviation: f64,
    /// For each edge, the part of Σ p² over elements that is missing, relative to the square of the pressure beside the
    /// edge.
    pub per_square: f64,
}

impl Default for EdgeBias {
    /// The constants of Love's squares, a uniform pressure on each element and the displacement of its centre.
    fn default() -> Self {
        Self { per_edge: 0.029, per_contact: -0.21, per_deviation: -0.0275, per_square: -0.06 }
    }
}

/// The elastic response of a periodic half-space to pressure on a uniform grid.
///
/// A layered or a graded half-space is another `Kernel`: two methods, of which one is a name.
/// [`crate::testing::check_kernel`] checks the contract.
///
/// # Not every linear solid is a `Kernel`
/// The solvers minimise an elastic energy, so a symbol is one positive number for a wave and its mirror images.
///
/// - **Viscoelastic solids** have a complex symbol at each frequency: the displacement lags behind the pressure, and
///   there is no energy to minimise. Instead, step in time. The response within a step is elastic, with a symbol that
///   is real; the displacement that remains from earlier steps is known, and is subtracted from the heights.
/// - **Shifts**, as of a moving load, are complex too: a factor exp(2πi k·d). Instead, move the heights.
/// - **Anisotropic solids** respond differently along different directions. Symbols here are even in kx and in ky, and
///   on a [square](Grid::is_square) grid symmetric in both, so the axes of the solid must be those of the cell, and the
///   grid must have different numbers of elements along them. A solid with oblique axes needs an [`Operator`] of its
///   own.
///
/// # What a solve checks
/// Before it starts, a solve looks at the symbol on its grid: at every wave of a small grid, and at the longest, the
/// shortest and one in 64 others of a large one. It refuses a symbol that is NaN, infinite, zero or negative at a wave,
/// not zero at the zero wave, not symmetric on a square grid, or different when it is asked again. What cannot be seen
/// is a sound symbol of another solid: a factor, a wrong thickness, smooth noise. Compare with a known displacement. A
/// fault at single waves that were not looked at shows only if it is NaN or infinite, as a solve that does not
/// converge. Kernels with [`Kernel::is_split_by_scale`] are not looked at.
pub trait Kernel: Sync {
    /// Short name, as in result files.
    fn name(&self) -> &'static str;

    /// The symbol of `v = L p` on `grid`, in units of λ/E*: the factor between the pressure wave exp(2πi k·x) on
    /// element centres and its displacement. Even in kx and in ky, so it is asked for 0 ≤ kx ≤ nx/2, 0 ≤ ky ≤ ny/2
    /// only; on a [square](Grid::is_square) grid symmetric in kx and ky, so it may be asked for ky ≥ kx only. Zero at
    /// k = 0 (Eq. 3: the displacement has zero mean) and positive elsewhere.
    fn symbol(&self, grid: Grid) -> Symbol<'_>;

    /// Displacement of the cell under a uniform pressure of E*, in λ: that of a solid on a base, added to
    /// [`Kernel::symbol`], which is zero at k = 0. `None` for the half-space, whose mean displacement is not finite and
    /// left out (Eq. 3).
    fn uniform_displacement(&self) -> Option<f64> {
        None
    }

    /// For heights with [`Boundary::Free`]: displacement, in λ, of the element that is (ix, iy) elements away from one
    /// under a pressure of E*, for 0 ≤ ix < nx and 0 ≤ iy < ny. The solver then uses it instead of [`Kernel::symbol`],
    /// which only preconditions the iteration. `None` for the periodic cell.
    fn free_response(&self, grid: Grid) -> Option<Symbol<'_>> {
        let _ = grid;
        None
    }

    /// The shift of the edges of contacts by the discretisation, first order in the element size. It only corrects
    /// observables; the pressure does not depend on it. At an edge short waves matter, and to these most solids are
    /// half-spaces, so the default fits kernels whose elements are like Love's squares.
    fn edge_bias(&self) -> EdgeBias {
        EdgeBias::default()
    }

    /// Whether this is the half-space whose displacements `rc_kernel::ScaleSplit` splits by scale, under pressures that
    /// are constant on elements: of a periodic cell or, with [`Kernel::free_response`], without images. The adaptive
    /// method is made of that split, so it serves only such a kernel.
    fn is_split_by_scale(&self) -> bool {
        false
    }
}

/// A linear map from pressure to zero-mean displacement: `v = L p` (Eq. 4), symmetric for uniform grids.
///
/// [`crate::testing::check_operator`] checks the contract.
///
/// # What a solve checks
/// Before it starts, a solve applies the operator to two pressures without a pattern, and to their sum with a uniform
/// pressure. It refuses an operator whose displacement is not finite, has a mean, is another one each time, depends on
/// what output and scratch held, is not linear, not symmetric or not positive, or whose uniform pressure displaces. All
/// are judged by the tolerance of the solve, relative to the maximum displacement. What cannot be seen is a sound
/// operator of another solid, as by a factor or by elements in another order than those of the heights, and a fault
/// that comes later: the certificate of a solution is computed by the operator itself.
pub trait Operator: Sync {
    /// Number of elements: the length of pressure and displacement.
    fn n_elements(&self) -> usize;

    /// Length of the scratch that [`Operator::apply`] needs.
    fn scratch_len(&self) -> usize;

    /// Computes `displacement = L pressure`, in λ for pressures in E*. `scratch` may hold anything before, and holds
    /// nothing useful after. The result must not depend on the number of threads.
    ///
    /// # Panics
    /// When a slice has another length than the two methods above say.
    fn apply(&self, pressure: &[f64], displacement: &mut [f64], scratch: &mut [f64]);
}
