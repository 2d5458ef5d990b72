//! The result of a solve.

use rc_core::{Field, Grid};
use rc_quadtree::paper::{Mesh, Square};

use crate::descent::certificate::Certificate;
use crate::descent::contact_element::ContactElement;

/// How a solve ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// The certificate met the tolerance.
    Converged,
    /// Contact is complete. The solution is exact, without iteration.
    FullContact,
    /// The certificate exceeds the tolerance. The pressure is the best that was found.
    NotConverged,
}

impl Status {
    /// Name as in summaries: `converged`, `full_contact` or `not_converged`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Converged => "converged",
            Self::FullContact => "full_contact",
            Self::NotConverged => "not_converged",
        }
    }
}

/// The work done on one level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LevelInfo {
    /// The grid.
    pub grid: Grid,
    /// Number of iterations.
    pub iterations: usize,
    /// Applications of L.
    pub operator_applications: usize,
    /// Applications of the preconditioner.
    pub preconditioner_applications: usize,
}

/// Results of a level, for comparison with the next finer level.
///
/// The difference gives an estimate of the error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LevelValues {
    /// Root mean square of the pressure, in E*.
    pub rms_pressure: f64,
    /// Penetration Δ, in λ, from the maximum height of the finest grid.
    pub penetration: f64,
    /// Friction coefficient under a sliding surface. `None` at rest.
    pub friction: Option<f64>,
}

/// Friction of a surface that slides steadily over a solid that relaxes.
///
/// The force on the surface is against its velocity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction {
    /// μ, the ratio of the force against the velocity to the load: -⟨p ∂h⟩/σ0 along the velocity.
    pub coefficient: f64,
    /// 95 % error of [`Friction::coefficient`], from its differences to [`Friction::of_displacement`] and to the
    /// coefficient on a coarser grid.
    pub error: f64,
    /// Proven bound on the error that the iteration leaves on this grid: √G ‖∂h‖/σ0, in the norm of (Re L)⁻¹.
    pub bound: f64,
    /// μ from the displacement, -⟨p ∂v⟩/σ0.
    pub of_displacement: f64,
    /// Ratio to the load of the force on the solid across the velocity, positive to its left.
    pub lateral: f64,
    /// Dissipated power per nominal area, in E* λ per unit of time.
    pub power: f64,
    /// Maximum loss tangent of the waves of the grid.
    pub max_loss_tangent: f64,
    /// Directions of GMRES on the finest grid.
    pub gmres_iterations: usize,
    /// Rounds with the storage modulus on the finest grid.
    pub storage_rounds: usize,
}

/// How a solution was found, and how good it is.
#[derive(Clone, Debug, PartialEq)]
pub struct SolveInfo {
    /// Residuals from a fresh application of L on the returned pressure.
    pub certificate: Certificate,
    /// The part of [`Certificate::energy`] that comes from the iteration.
    ///
    /// It is computed without the bound on the error of the operator. Errors of area and rms pressure were measured to
    /// be less than its square. In heavy contact, which is solved for its gap, it is therefore larger than the bound.
    pub iteration_error: f64,
    /// Mean pressure σ0, in E*.
    pub mean_pressure: f64,
    /// Penetration Δ, in λ: the pressure-weighted mean of v - h, plus h_max.
    pub penetration: f64,
    /// Penetration of full contact, h_max - mean(h), in λ.
    pub penetration_full_contact: f64,
    /// Mean displacement over the nominal area, in λ.
    ///
    /// It is zero on the periodic half-space (Eq. 3). On a layer, the mean pressure causes it. With free borders it is
    /// the mean over the whole patch.
    pub mean_displacement: f64,
    /// Elastic energy per nominal area, ½ mean(p v), in E* λ.
    pub elastic_energy: f64,
    /// The work on each level, coarsest first. Empty in full contact.
    pub levels: Vec<LevelInfo>,
    /// Results of the level below the finest one.
    ///
    /// `None` without such a level, or if it does not have half the elements along both axes.
    pub coarser: Option<LevelValues>,
    /// Friction under a sliding surface. `None` at rest.
    pub friction: Option<Friction>,
}

impl SolveInfo {
    /// Mean gap, in λ: h_max - mean(h) - Δ plus the mean displacement.
    #[must_use]
    pub fn mean_gap(&self) -> f64 {
        self.penetration_full_contact + self.mean_displacement - self.penetration
    }

    /// Iterations on the finest level.
    #[must_use]
    pub fn fine_iterations(&self) -> usize {
        self.levels.last().map_or(0, |level| level.iterations)
    }

    /// Applications of L on the finest level, including those of the certificate.
    #[must_use]
    pub fn fine_operator_applications(&self) -> usize {
        self.levels.last().map_or(1, |level| level.operator_applications)
    }
}

/// Pressures on an adaptive mesh.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct MeshPressure {
    /// The elements in contact.
    pub mesh: Mesh,
    /// Pressure of each element, in E*, in the order of the mesh.
    pub pressure: Vec<f64>,
}

impl MeshPressure {
    /// The elements with their pressures.
    pub(crate) fn elements(&self) -> impl Iterator<Item = ContactElement> + '_ {
        let elements = self.mesh.elements().zip(&self.pressure);
        elements.map(|(element, &pressure)| {
            let Square { centre, side } = element;
            ContactElement { centre, side, pressure }
        })
    }
}

/// A solved contact problem.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct GridSolution {
    /// Pressure, in E*, ≥ 0.
    pub pressure: Field,
    /// Gap, in λ, with the pressure-weighted mean 0.
    ///
    /// It is zero within the tolerance at points in contact.
    pub gap: Field,
    /// Converged or full contact.
    pub status: Status,
    /// The elements and their pressures. `None` when the mesh is the grid itself.
    pub elements: Option<MeshPressure>,
    /// How the solution was found, and how good it is.
    pub info: SolveInfo,
}

impl GridSolution {
    /// Number of elements that carry unknowns.
    pub(crate) fn n_elements(&self) -> usize {
        self.elements.as_ref().map_or(self.pressure.grid().len(), |elements| elements.mesh.len())
    }

    /// Number of elements in contact.
    pub(crate) fn n_in_contact(&self) -> usize {
        let of_grid = || self.pressure.values().iter().filter(|&&p| p > 0.0).count();
        self.elements.as_ref().map_or_else(of_grid, |elements| elements.mesh.len())
    }
}
