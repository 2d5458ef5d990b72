//! A solved sheared contact.

use rc_core::{DVec2, Field};

/// The numbers of a sheared contact. Areas are relative to the nominal area.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShearInfo {
    /// Coulomb's coefficient of friction.
    pub friction: f64,
    /// Shear force per nominal area along the direction of shear, in E*.
    pub mean_shear: f64,
    /// Tangential displacement of the bodies far from the contact, along the direction of shear, in λ.
    pub displacement: f64,
    /// Area where the surfaces slip.
    pub slip_area: f64,
    /// Area where they stick.
    pub stick_area: f64,
    /// Stiffness dτ/dd at the start of shear, before any slip, in E*/λ.
    ///
    /// It is the contact stiffness divided by [`crate::ShearParams::compliance_ratio`], which for ν > 0 is exact for
    /// isotropic contacts only. That of a profile is exact along it and across. Infinite in full contact.
    pub stiffness: f64,
    /// Energy that slip dissipates, per nominal area, in E* λ.
    pub slip_work: f64,
    /// √(G/U), a bound on the relative error of the traction in the energy norm.
    ///
    /// G = ⟨μp|s| - t·s⟩ with the slip s = d - `L_T` t, and U = ⟨t·`L_T` t⟩/2. The exact traction t* for this pressure
    /// has ⟨(t - t*)·`L_T` (t - t*)⟩ ≤ G.
    pub error: f64,
    /// Rounds of the correction. 0 if the difference of two normal contacts met the tolerance.
    pub rounds: usize,
}

/// A sheared contact with its fields on the grid of the normal contact.
#[derive(Clone, Debug, PartialEq)]
pub struct ShearSolution {
    /// The numbers.
    pub info: ShearInfo,
    /// Unit vector of the shear.
    pub direction: DVec2,
    /// Traction on the elastic body along x and y, in E*.
    pub traction: [Field; 2],
    /// Length of the slip, in λ. It is 0 where the surfaces stick or do not touch.
    pub slip: Field,
}
