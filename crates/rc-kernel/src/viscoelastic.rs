//! A viscoelastic solid under a surface that slides steadily.

use std::sync::Arc;

use rc_core::{
    ComplexSymbol, DVec2, EdgeBias, Grid, Kernel, Sliding, SlidingCompliance, SlidingModes, SplitByScale, Symbol,
};

use crate::creep::Retardation;
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
    modes: Option<SlidingModes>,
}

impl<K: Kernel> Viscoelastic<K> {
    /// The solid of `relaxed` with this material. The surface has this `velocity`, in λ per unit of time.
    #[must_use]
    pub fn new(relaxed: K, material: &Relaxation, velocity: DVec2) -> Self {
        let modes = (velocity.y == 0.0).then(|| modes(material, velocity.x)).flatten();
        let material = material.clone();
        Self { relaxed, modes, sliding: Sliding::new(velocity, Arc::new(move |omega| material.compliance(omega))) }
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

    fn sliding_modes(&self) -> Option<SlidingModes> {
        self.modes.clone()
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

    /// The split of the relaxed solid, which [`Kernel::symbol`] is that of.
    fn split(&self) -> Option<&dyn SplitByScale> {
        self.relaxed.split()
    }

    fn to_shared(&self) -> Option<Arc<dyn Kernel + Send + Sync>> {
        Some(Arc::new(self.clone()))
    }
}

/// The retardation of a material under a surface with this velocity along x. `None` if it is not a Prony series.
fn modes(material: &Relaxation, velocity: f64) -> Option<SlidingModes> {
    let (relaxed, storage) = (material.retardation()?, material.storage_retardation()?);
    let of = |Retardation { instantaneous, modes }: Retardation, sides: &[f64]| {
        // Nothing lags at rest.
        let (at_once, modes) = if velocity == 0.0 { (1.0, Vec::new()) } else { (instantaneous, modes) };
        let part = (sides.len() as f64).recip();
        let on_side = |&[j, rho]: &[f64; 2]| sides.iter().map(move |side| [part * j, side * velocity * rho]);
        SlidingCompliance { instantaneous: at_once, modes: modes.iter().flat_map(on_side).collect() }
    };
    Some(SlidingModes { compliance: of(relaxed, &[1.0]), storage: of(storage, &[1.0, -1.0]) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Love;

    #[test]
    fn modes_are_those_of_the_symbol() {
        let rubber = Relaxation::prony(&[[4.0, 0.01], [5.0, 0.3]]).expect("a material");
        for velocity in [0.0, 0.7, -0.2] {
            let kernel = Viscoelastic::new(Love, &rubber, velocity * DVec2::X);
            let modes = kernel.sliding_modes().expect("a series along x");
            for q in [0.0, 1.0, -30.0, 1e4] {
                let modulus = rubber.modulus(q * velocity);
                assert!((modes.compliance.at(q) - modulus.inv()).norm() < 1e-14);
                assert!((modes.storage.at(q) - modulus.re.recip()).norm() < 1e-14);
            }
        }
        assert_eq!(Viscoelastic::new(Love, &rubber, DVec2::Y).sliding_modes(), None);
        let fractional = Relaxation::fractional(0.5, 10.0, 1.0).expect("a material");
        assert_eq!(Viscoelastic::new(Love, &fractional, DVec2::X).sliding_modes(), None);
    }
}
