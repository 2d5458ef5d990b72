//! The traits that a research fork implements to bring its own surface, half-space or operator.

use crate::{DVec2, Field, Grid, HeightSource};

/// A rough surface, periodic on the square cell of side 1.
///
/// Implementations: a realised spectrum, a measured map, a sphere. [`crate::testing::check_height_field`] (feature
/// `testing`) checks the contract.
pub trait HeightField: Sync {
    /// Height at the point `at`, both in λ; periodic with period 1 along x and along y.
    fn height(&self, at: DVec2) -> f64;

    /// The largest wavenumber (waves per cell) in any direction, or `None` when the surface is not band-limited.
    fn band_limit(&self) -> Option<usize>;

    /// Heights at the element centres of `grid`. Equal to [`HeightField::height`] there up to rounding, so they are periodic on a square
    /// cell only; implementations that have a fast transform override it.
    fn sample(&self, grid: Grid) -> Field {
        Field::from_fn(grid, |at| self.height(at))
    }

    /// The surface as the heights of a contact problem on `grid`. Nothing is evaluated yet.
    fn on(&self, grid: Grid) -> HeightSource<'_>
    where
        Self: Sized,
    {
        HeightSource::Surface { surface: self, grid }
    }
}

/// Eigenvalues of an elastic operator on one grid: maps (|kx|, |ky|), up to half the grid, to the eigenvalue.
pub type Symbol<'a> = Box<dyn Fn(usize, usize) -> f64 + Send + Sync + 'a>;

/// What the discretisation does to the edges of contacts: what to take off an area whose edges were located between elements, in
/// areas of an element, so that its first-order error vanishes; and the like for the square of the pressure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeBias {
    /// For each edge between an element in contact and one out of it.
    pub per_edge: f64,
    /// For each contact, less the holes in contacts: edges that curve are shifted otherwise than straight ones.
    pub per_contact: f64,
    /// For the sum over edges of how far the gap two elements out is from the law that holds near a straight edge: between
    /// contacts that are close, and at edges that curve, it bends away from it.
    pub per_bend: f64,
    /// Not of the area, but of Σ p² over elements: what it misses for each edge, over the square of the pressure beside the edge.
    pub per_square: f64,
}

/// The elastic response of a periodic half-space to pressure on a uniform grid.
///
/// A layered or viscoelastic half-space is another `Kernel`. [`crate::testing::check_kernel`] checks the contract.
pub trait Kernel: Sync {
    /// Short name, as in result files.
    fn name(&self) -> &'static str;

    /// The symbol of `v = L p` on `grid`, in units of λ/E*: the factor between the pressure wave exp(2πi k·x) on element
    /// centres and its displacement. Even in kx and in ky, so it is asked for 0 ≤ kx ≤ nx/2, 0 ≤ ky ≤ ny/2 only; on a
    /// [square](Grid::is_square) grid symmetric in kx and ky, so it may be asked for ky ≥ kx only. Zero at k = 0 (Eq. 3: the displacement has zero mean) and positive elsewhere.
    fn symbol(&self, grid: Grid) -> Symbol<'_>;

    /// How far the discretisation shifts the edges of contacts: it is first order in the element size, and depends on the
    /// kernel (`docs/accuracy.md` has the calibration of the ones here).
    fn edge_bias(&self) -> EdgeBias;

    /// Whether this is the half-space whose displacements `rc_kernel::ScaleSplit` splits by scale, under pressures that are constant on
    /// elements. The adaptive method is made of that split, so it serves only such a kernel.
    fn is_split_by_scale(&self) -> bool {
        false
    }
}

/// A linear map from pressure to zero-mean displacement: `v = L p` (Eq. 4), symmetric for uniform grids.
///
/// [`crate::testing::check_operator`] checks the contract.
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
