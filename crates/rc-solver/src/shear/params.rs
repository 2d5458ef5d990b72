//! What is asked of a sheared contact.

use rc_core::DVec2;

/// The prescribed tangential quantity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ShearControl {
    /// Shear force per nominal area τ, in E*. The displacement is a result.
    MeanShear(f64),
    /// Tangential displacement d of the bodies far from the contact, in λ. The force is a result.
    Displacement(f64),
}

/// Friction, shear and material of a sheared contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShearParams {
    /// Coulomb's coefficient of friction μ, above 0.
    pub friction: f64,
    /// The shear, above 0.
    pub control: ShearControl,
    /// Unit vector along which the rough surface is sheared.
    pub direction: DVec2,
    /// Poisson's ratio ν, above -1 and at most 1/2.
    ///
    /// For two elastic bodies it is the mean of their ratios, weighted by 1/G of each, where G is its shear modulus.
    pub poisson: f64,
}

impl ShearParams {
    /// Shear by a force per nominal area along x, of a body with ν = 0.
    #[must_use]
    pub fn new(friction: f64, mean_shear: f64) -> Self {
        Self { friction, control: ShearControl::MeanShear(mean_shear), direction: DVec2::X, poisson: 0.0 }
    }

    /// Ratio of tangential to normal compliance of an isotropic contact without slip, (2 - ν)/(2 (1 - ν)).
    ///
    /// Mindlin, J. Appl. Mech. 16 (1949) 259.
    #[must_use]
    pub fn compliance_ratio(&self) -> f64 {
        (2.0 - self.poisson) / (2.0 * (1.0 - self.poisson))
    }
}
