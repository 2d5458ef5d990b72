//! The bound on the error of tangential tractions.

use rc_core::DVec2;

use crate::shear::problem::Contact;

/// Rounds in which the displacement is found that makes the bound small. Any displacement gives a bound.
const ROUNDS: usize = 60;

/// Slip below which the weight of an element grows no further, relative to the largest displacement.
const SMALLEST_SLIP: f64 = 1e-10;

/// A bound on the error of a traction t with the displacements v = `L_T` t.
///
/// The traction is the minimum of a convex function on |t| ≤ μp, so that ⟨(t - t*)·`L_T` (t - t*)⟩ ≤ G = ⟨μp|s| - t·s⟩,
/// where s = d - v is the slip. Under a given force this holds for every d.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bound {
    /// d, in λ.
    pub(super) displacement: DVec2,
    /// G, in E* λ.
    pub(super) gap: f64,
    /// U = ⟨t·v⟩/2, in E* λ.
    pub(super) energy: f64,
}

impl Bound {
    /// The bound for the displacement `displacement`.
    pub(super) fn at(contact: &Contact, tractions: &[DVec2], displacements: &[DVec2], displacement: DVec2) -> Self {
        let mut sums = [0.0; 2];
        for ((t, v), limit) in tractions.iter().zip(displacements).zip(&contact.limits) {
            let slip = displacement - *v;
            sums[0] += (limit * slip.length() - t.dot(slip)).max(0.0);
            sums[1] += 0.5 * t.dot(*v);
        }
        let [gap, energy] = sums.map(|sum| sum / contact.n_grid() as f64);
        Self { displacement, gap, energy }
    }

    /// The smallest bound that is found, starting from the displacement `start`.
    ///
    /// Weighted means of the displacements (Weiszfeld's iteration) lower the bound in each round.
    pub(super) fn smallest(contact: &Contact, tractions: &[DVec2], displacements: &[DVec2], start: DVec2) -> Self {
        let largest = displacements.iter().map(|v| v.length()).fold(0.0, f64::max);
        let least = SMALLEST_SLIP * largest + f64::MIN_POSITIVE;
        let total: DVec2 = tractions.iter().sum();
        let mut best = Self::at(contact, tractions, displacements, start);
        let sticking = sticking_mean(contact, tractions, displacements).unwrap_or(start);
        let other = Self::at(contact, tractions, displacements, sticking);
        if other.gap < best.gap {
            best = other;
        }
        for _ in 0..ROUNDS {
            let (mut weights, mut sum) = (0.0, total);
            for (v, limit) in displacements.iter().zip(&contact.limits) {
                let weight = limit / (best.displacement - *v).length().max(least);
                weights += weight;
                sum += weight * *v;
            }
            let next = Self::at(contact, tractions, displacements, sum / weights);
            let is_end = next.gap >= best.gap * (1.0 - 1e-3);
            if next.gap < best.gap {
                best = next;
            }
            if is_end {
                break;
            }
        }
        best
    }

    /// √(G/U); 0 where nothing slips and nothing is displaced.
    pub(super) fn error(&self) -> f64 {
        if self.gap == 0.0 { 0.0 } else { (self.gap / self.energy).sqrt() }
    }
}

/// Mean displacement of the elements that stick, weighted by what they could bear beyond their traction.
fn sticking_mean(contact: &Contact, tractions: &[DVec2], displacements: &[DVec2]) -> Option<DVec2> {
    let (mut weights, mut sum) = (0.0, DVec2::ZERO);
    for ((t, v), limit) in tractions.iter().zip(displacements).zip(&contact.limits) {
        let weight = (limit - t.length()).max(0.0);
        weights += weight;
        sum += weight * *v;
    }
    (weights > 0.0).then(|| sum / weights)
}
