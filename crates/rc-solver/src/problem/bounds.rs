//! What a pressure may be: between zero and the hardness, with a given mean or under a given penetration.

use crate::problem::control::Control;

/// Relative distance below the hardness within which a pressure counts as the hardness: prolongation rounds.
const SNAP: f64 = 1e-12;

/// Bounds of the pressure of each element, and the condition on all of them.
///
/// Pressures are moved along p (1 - p/H), which is a scaling if H is infinite. Elements at 0 and at H keep their
/// pressure. Others stay between these bounds for steps from -1 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bounds {
    pub(crate) control: Control,
    /// H in 0 ≤ p ≤ H, in E*. It is infinite for an elastic contact.
    pub(crate) hardness: f64,
}

impl From<Control> for Bounds {
    /// An elastic contact.
    fn from(control: Control) -> Self {
        Self { control, hardness: f64::INFINITY }
    }
}

impl Bounds {
    /// Whether there is a hardness.
    pub(crate) fn is_limited(self) -> bool {
        self.hardness.is_finite()
    }

    /// The prescribed mean pressure, if one is prescribed.
    pub(crate) fn mean(self) -> Option<f64> {
        match self.control {
            Control::MeanPressure(mean) => Some(mean),
            Control::Penetration(_) => None,
        }
    }

    /// The pressure between the bounds. Next to the hardness it is the hardness.
    pub(crate) fn clip(self, p: f64) -> f64 {
        if p >= self.hardness * (1.0 - SNAP) { self.hardness } else { p.max(0.0) }
    }

    /// The direction p (1 - p/H).
    pub(crate) fn direction(self, p: f64) -> f64 {
        p * (1.0 - p / self.hardness)
    }

    /// The pressure `p` after a step of `factor` along its direction.
    pub(crate) fn along(self, p: f64, factor: f64) -> f64 {
        (p + factor * self.direction(p)).clamp(0.0, self.hardness)
    }
}
