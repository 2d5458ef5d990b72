//! A viscoelastic solid under a surface that slides steadily.

use std::sync::Arc;

use rc_core::{ComplexSymbol, DVec2, EdgeBias, Grid, Kernel, Sliding, Symbol};

use crate::relaxation::Relaxation;

/// The solid of another kernel, of a material that relaxes, under a surface that slides over it.
///
/// Poisson's ratio is constant, so the compliance J~(q·v) multiplies the displacement by each wave q: (Carbone and
/// Putignano, *J. Mech. Phys. Solids* 61 (2013) 1822)
///
/// ```text
/// u(x) = ∫ [J0 δ(s) + Σ (J/ℓ) exp(-s/ℓ)] (L p)(x + s v/|v|) ds,     ℓ = |v| ρ for each retardation time ρ.
/// ```
///
/// E* is that of the relaxed material. [`Kernel::symbol`] is the symbol at rest.
///
/// ```
/// use rc_core::{DVec2, Grid, Kernel};
/// use rc_kernel::{Relaxation, Spectral, Viscoelastic};
///
/// // A glassy modulus of ten times the relaxed one. The surface slides along +x by one cell in each relaxation time.
/// let rubber = Relaxation::single(10.0, 1.0)?;
/// let kernel = Viscoelastic::new(Spectral, &rubber, DVec2::X);
/// let grid = Grid::square(16)?;
/// let (rest, slides) = (kernel.symbol(grid), kernel.sliding_symbol(grid).expect("it slides"));
/// let omega = std::f64::consts::TAU;
/// assert!((slides(1, 0) - rest(1, 0) / rubber.modulus(omega)).norm() < 1e-15);
/// assert!((slides(0, 3) - rest(0, 3)).norm() < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Viscoelastic<K> {
    relaxed: K,
    sliding: Sliding,
}

impl<K: Kernel> Viscoelastic<K> {
    /// The solid of `relaxed` with this material. The surface has this `velocity`, in λ per unit of time.
    #[must_use]
    pub fn new(relaxed: K, material: &Relaxation, velocity: DVec2) -> Self {
        let material = material.clone();
        Self { relaxed, sliding: Sliding::new(velocity, Arc::new(move |omega| material.compliance(omega))) }
    }
}

impl<K: Kernel + Clone + Send + Sync + 'static> Kernel for Viscoelastic<K> {
    fn name(&self) -> &'static str {
        self.relaxed.name()
    }

    fn symbol(&self, grid: Grid) -> Symbol<'_> {
        self.relaxed.symbol(grid)
    }

    fn sliding_velocity(&self) -> Option<DVec2> {
        Some(self.sliding.velocity())
    }

    fn sliding_symbol(&self, grid: Grid) -> Option<ComplexSymbol<'_>> {
        Some(self.relaxed.symbol_while(&self.sliding, grid))
    }

    fn uniform_displacement(&self) -> Option<f64> {
        self.relaxed.uniform_displacement()
    }

    fn half_space(&self) -> Option<&dyn Kernel> {
        Some(self.relaxed.half_space().unwrap_or(&self.relaxed))
    }

    fn edge_bias(&self, grid: Grid) -> EdgeBias {
        self.relaxed.edge_bias(grid)
    }

    fn to_shared(&self) -> Option<Arc<dyn Kernel + Send + Sync>> {
        Some(Arc::new(self.clone()))
    }
}
