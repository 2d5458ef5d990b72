//! A kernel of one's own: an elastic layer on a rigid base.
//!
//! Run with `cargo run -p rc-tests --example own_kernel`. Units: cell side λ = 1, E* = 1 (of the layer's material).
#![expect(clippy::print_stdout, reason = "what an example is for")]

use std::error::Error;
use std::f64::consts::TAU;

use rc_core::{Grid, Kernel, Silent, Symbol};
use rc_fractal::{SpectrumParams, Surface};
use rc_kernel::Spectral;
use rc_solver::{ContactProblem, Control, SolveParams};

/// A layer bonded to a rigid base, loaded without friction.
///
/// A pressure wave of wavenumber q displaces it by 2/(E* q) · M(q d), with ξ = q d:
///
/// ```text
/// M(ξ) = [(3-4ν) sinh 2ξ - 2ξ] / [(3-4ν) cosh 2ξ + 2ξ² + 5 - 12ν + 8ν²]
/// ```
///
/// Source: R. H. Bentall, K. L. Johnson, *An elastic strip in plane rolling contact*, Int. J. Mech. Sci. 10 (1968)
/// 637-663; in this form G. Carbone, L. Mangialardi, J. Mech. Phys. Solids 56 (2008) 684-706.
///
/// For short waves M → 1, as for the half-space. For long waves M → ξ (1-2ν)/(2(1-ν)²), so that each column of the
/// layer is a spring. The mean displacement is not part of v (Eq. 3). Under a mean pressure σ0 the layer is displaced
/// in addition as these springs are.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BondedLayer {
    /// Thickness d, in λ.
    pub(crate) thickness: f64,
    /// Poisson's ratio ν of the layer.
    pub(crate) poisson: f64,
}

impl BondedLayer {
    /// The factor M(ξ).
    ///
    /// Numerator and denominator are multiplied by 2 exp(-2ξ), so that they do not overflow for short waves.
    pub(crate) fn factor(self, xi: f64) -> f64 {
        let nu = self.poisson;
        let (decay, stiff) = ((-2.0 * xi).exp(), 3.0 - 4.0 * nu);
        let above = stiff * (1.0 - decay * decay) - 4.0 * xi * decay;
        let below = stiff * (1.0 + decay * decay) + (4.0 * xi * xi + 10.0 - 24.0 * nu + 16.0 * nu * nu) * decay;
        above / below
    }
}

/// `edge_bias` keeps its default. At the edge of a contact short waves matter, and for these the layer is a half-space.
impl Kernel for BondedLayer {
    fn name(&self) -> &'static str {
        "bonded-layer"
    }

    fn symbol(&self, grid: Grid) -> Symbol<'_> {
        let half_space = Spectral.symbol(grid);
        Box::new(move |kx, ky| {
            let q = TAU * grid.waves(kx, ky);
            half_space(kx, ky) * self.factor(q * self.thickness)
        })
    }
}

pub(crate) fn main() -> Result<(), Box<dyn Error>> {
    let heights = Surface::new(&SpectrumParams::paper(16, 1))?.sample_on(Grid::square(256)?)?;
    let control = Control::MeanPressure(2e-3);
    let solve = |kernel: &dyn Kernel| -> Result<(), Box<dyn Error>> {
        let problem = ContactProblem::new(&heights, control).with_kernel(kernel);
        let solution = problem.solve(&SolveParams::default(), &Silent).map_err(|error| error.to_string())?;
        let (name, area) = (kernel.name(), solution.area().fraction);
        println!("{name:<14} A/A0 = {area:.4}, Δ = {:.4e} λ", solution.info().penetration);
        Ok(())
    };
    solve(&Spectral)?;
    for thickness in [1.0, 0.1, 0.03] {
        println!("thickness {thickness} λ:");
        solve(&BondedLayer { thickness, poisson: 0.3 })?;
    }
    Ok(())
}
