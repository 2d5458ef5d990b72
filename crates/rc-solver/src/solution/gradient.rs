//! Derivatives with respect to the heights.
//!
//! On the contact, L p = h + D with D = Δ - h_max. It is held fixed, because pressure and gap vanish at its edge. With L
//! x = 1 on the contact and w = x/Σx, the height of element j changes D by -w_j at a given load. The penetration is
//! measured from the highest point, so h_max adds 1 at that element.

use rc_core::Field;

use crate::descent::info::Status;
use crate::problem::capabilities::{Feature, refusal};
use crate::problem::control::Control;
use crate::solution::gradient_error::GradientError;
use crate::solution::whole::Solution;

/// A number of a solution whose gradient is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Quantity {
    /// [`crate::SolveInfo::elastic_energy`].
    ElasticEnergy,
    /// [`crate::SolveInfo::mean_pressure`].
    MeanPressure,
    /// [`crate::SolveInfo::penetration`].
    Penetration,
    /// [`crate::SolveInfo::mean_gap`].
    MeanGap,
}

/// What stays the same when a height changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Held {
    /// The mean pressure.
    MeanPressure,
    /// The penetration, which is measured from the highest point of the changed heights.
    Penetration,
}

impl From<Control> for Held {
    fn from(control: Control) -> Self {
        match control {
            Control::MeanPressure(_) => Self::MeanPressure,
            Control::Penetration(_) => Self::Penetration,
        }
    }
}

/// How D and the load follow a height.
struct Response {
    /// w = x/Σx.
    weights: Vec<f64>,
    /// dσ0/dΔ. Infinite in full contact with a half-space.
    stiffness: f64,
}

/// A gradient as a sum: of p/N, of w, of 1 at the highest element, and of 1/N everywhere.
struct Parts {
    pressure: f64,
    weight: f64,
    top: f64,
    everywhere: f64,
}

impl Solution<'_> {
    /// Derivatives of a number with respect to the height of each element, with `held` fixed, in E* and λ.
    ///
    /// `None` holds fixed what the solve was given. The number is that of the discrete problem, and the contact is held
    /// fixed: derivatives are exact unless an element is just about to touch or to part. The contact area then does not
    /// change, so it has no gradient of use. The errors are those of the pressure, and 1e-7 of the linear system. One
    /// linear solve, some twenty applications of L, unless the derivative is the pressure. Of several highest elements,
    /// the first counts as the highest.
    ///
    /// ```
    /// use rc_core::{Field, Grid};
    /// use rc_solver::{Control, Method, Quantity, SolveParams, solve};
    ///
    /// let wave = Field::from_fn(Grid::square(64)?, |at| 1e-3 * (std::f64::consts::TAU * at.x).cos());
    /// let params = SolveParams::default().by(Method::Uniform);
    /// let solution = solve(&wave, Control::MeanPressure(1e-3), &params)?;
    /// // A surface that is higher everywhere has the same gap under the same load.
    /// let gradient = solution.gradient(Quantity::MeanGap, None)?;
    /// assert!(gradient.values().iter().sum::<f64>().abs() < 1e-6);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`GradientError`].
    pub fn gradient(&self, quantity: Quantity, held: Option<Held>) -> Result<Field, GradientError> {
        let held = held.unwrap_or(self.how.asked.control.into());
        self.check(held)?;
        let info = self.info();
        let load = info.mean_pressure;
        let none = Parts { pressure: 0.0, weight: 0.0, top: 0.0, everywhere: 0.0 };
        if (quantity, held) == (Quantity::ElasticEnergy, Held::Penetration) {
            return Ok(self.sum(&[], &Parts { pressure: 1.0, top: -load, ..none }));
        }
        let Response { weights, stiffness } = self.response(held)?;
        // dv/dσ0, the mean displacement of a layer.
        let compliance = if load > 0.0 { info.mean_displacement / load } else { 0.0 };
        let parts = match (quantity, held) {
            (Quantity::MeanPressure, Held::MeanPressure) => {
                return Err(GradientError::Held("mean pressure", "penetration"));
            }
            (Quantity::Penetration, Held::Penetration) => {
                return Err(GradientError::Held("penetration", "mean pressure"));
            }
            (Quantity::ElasticEnergy, _) => Parts { pressure: 1.0, weight: -load, ..none },
            (Quantity::MeanPressure, Held::Penetration) => Parts { weight: stiffness, top: -stiffness, ..none },
            (Quantity::Penetration, Held::MeanPressure) => Parts { weight: -1.0, top: 1.0, ..none },
            (Quantity::MeanGap, Held::MeanPressure) => Parts { weight: 1.0, everywhere: -1.0, ..none },
            (Quantity::MeanGap, Held::Penetration) => {
                let moved = compliance * stiffness;
                Parts { weight: moved, top: 1.0 - moved, everywhere: -1.0, ..none }
            }
        };
        Ok(self.sum(&weights, &parts))
    }

    /// Derivatives of a function f(p) of the pressures with respect to the heights, with `held` fixed, in 1/λ E*.
    ///
    /// `derivatives` are ∂f/∂p of each element of the grid, in the order of fields. Those out of contact do not count.
    /// Otherwise it is as [`Solution::gradient`]. With z of mean zero and L z = ∂f/∂p up to a constant on the contact,
    /// the gradient at a given load is z.
    ///
    /// # Errors
    /// [`GradientError`].
    pub fn gradient_of(&self, derivatives: &[f64], held: Option<Held>) -> Result<Field, GradientError> {
        let held = held.unwrap_or(self.how.asked.control.into());
        self.check(held)?;
        let grid = self.grid();
        let mut in_contact = derivatives.iter().zip(self.pressure().values()).filter(|(_, p)| **p > 0.0);
        if derivatives.len() != grid.len() || in_contact.any(|(value, _)| !value.is_finite()) {
            return Err(GradientError::Derivatives(grid));
        }
        let mut gradient = self.solved.displaced_by(derivatives, held == Held::MeanPressure)?;
        if let Some(top) = self.solved.highest().filter(|_| held == Held::Penetration) {
            gradient[top] -= sum(&gradient);
        }
        Ok(self.field(&gradient))
    }

    /// Refuses what has no gradient.
    fn check(&self, held: Held) -> Result<(), GradientError> {
        let hardness = self.hardness().is_finite().then_some(Feature::Hardness);
        let features: Vec<_> = self.solved.features().into_iter().chain(hardness).chain([Feature::Gradient]).collect();
        if let Some(refused) = refusal(&features, Some(self.how.method)) {
            return Err(refused.into());
        }
        match self.status() {
            Status::NotConverged => Err(GradientError::NotConverged),
            Status::FullContact if held == Held::Penetration && self.stiffness().is_infinite() => {
                Err(GradientError::FullContact)
            }
            _ => Ok(()),
        }
    }

    fn response(&self, held: Held) -> Result<Response, GradientError> {
        let n = self.grid().len();
        if self.status() == Status::FullContact {
            return Ok(Response { weights: vec![1.0 / n as f64; n], stiffness: self.stiffness() });
        }
        let mut x = self.solved.displaced_by(&vec![1.0; n], false)?;
        let total = sum(&x);
        if total > 0.0 {
            for x in &mut x {
                *x /= total;
            }
        } else if held == Held::MeanPressure {
            return Err(GradientError::NoContact);
        }
        Ok(Response { weights: x, stiffness: total / n as f64 })
    }

    /// The gradient of these parts. Without weights, they are zero.
    fn sum(&self, weights: &[f64], parts: &Parts) -> Field {
        let n = self.grid().len() as f64;
        let of = |p: f64, weight: f64| (parts.pressure * p + parts.everywhere) / n + parts.weight * weight;
        let weights = weights.iter().copied().chain(std::iter::repeat(0.0));
        let mut values: Vec<f64> = self.pressure().values().iter().zip(weights).map(|(&p, w)| of(p, w)).collect();
        if let Some(top) = self.solved.highest() {
            values[top] += parts.top;
        }
        self.field(&values)
    }

    fn field(&self, values: &[f64]) -> Field {
        let mut field = Field::zeros(self.grid());
        field.values_mut().copy_from_slice(values);
        field
    }
}

/// The sum, in the order of elements.
fn sum(values: &[f64]) -> f64 {
    values.iter().sum()
}
