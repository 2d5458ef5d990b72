//! What a solve returns.

use rc_core::{Field, Grid};
use rc_quadtree::paper::{Mesh, Square};

use crate::{Certificate, ContactElement};

/// How a solve ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// Iterated until the certificate met the tolerance.
    Converged,
    /// Contact is complete: the exact solution, without iteration.
    FullContact,
    /// The certificate exceeds the tolerance: the best pressure that was found.
    NotConverged,
}

impl Status {
    /// As in summaries: `converged`, `full_contact` or `not_converged`.
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
    /// Iterations.
    pub iterations: usize,
    /// Applications of L.
    pub operator_applications: usize,
    /// Applications of the preconditioner.
    pub preconditioner_applications: usize,
}

/// What a level found that the next finer one is compared with, to estimate its error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LevelValues {
    /// Root mean square of the pressure, in E*.
    pub rms_pressure: f64,
    /// Penetration Δ, in λ, from the greatest height of the finest grid.
    pub penetration: f64,
}

/// How a solution was found and how good it is.
#[derive(Clone, Debug, PartialEq)]
pub struct SolveInfo {
    /// Residuals from a fresh application of L on the returned pressure.
    pub certificate: Certificate,
    /// [`Certificate::energy`] of the gap as the operator computed it, without the bound on the error of the operator:
    /// what the iteration has left. Area and rms pressure were measured to be off by less than its square.
    pub iteration_error: f64,
    /// Mean pressure σ0, in E*.
    pub mean_pressure: f64,
    /// Penetration Δ, in λ: pressure-weighted mean of v - h, plus h_max.
    pub penetration: f64,
    /// Penetration of full contact, h_max - mean(h), in λ.
    pub penetration_full_contact: f64,
    /// Mean displacement over the nominal area, in λ: zero on the periodic half-space (Eq. 3), that of the mean
    /// pressure on a layer, that of the whole patch where borders are free.
    pub mean_displacement: f64,
    /// Elastic energy per nominal area, ½ mean(p v), in E* λ.
    pub elastic_energy: f64,
    /// The work, coarsest level first; empty in full contact.
    pub levels: Vec<LevelInfo>,
    /// What the level below the finest one found; none when there was none, or not one with half the elements along
    /// both axes.
    pub coarser: Option<LevelValues>,
}

impl SolveInfo {
    /// Mean gap, in λ: h_max - mean(h) - Δ and the mean displacement.
    #[must_use]
    pub fn mean_gap(&self) -> f64 {
        self.penetration_full_contact + self.mean_displacement - self.penetration
    }

    /// Iterations on the finest level.
    #[must_use]
    pub fn fine_iterations(&self) -> usize {
        self.levels.last().map_or(0, |level| level.iterations)
    }

    /// Applications of L on the finest level, the certificate's included.
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
    /// Pressure of each, in E*, in the order of the mesh.
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
    /// Gap, in λ, with the pressure-weighted mean 0; at points in contact it is zero within the tolerance.
    pub gap: Field,
    /// Converged or full contact.
    pub status: Status,
    /// The elements and their pressures, when the mesh is not the grid itself.
    pub elements: Option<MeshPressure>,
    /// How it was found and how good it is.
    pub info: SolveInfo,
}

impl GridSolution {
    /// Elements that carry unknowns.
    pub(crate) fn n_elements(&self) -> usize {
        self.elements.as_ref().map_or(self.pressure.grid().len(), |elements| elements.mesh.len())
    }

    /// Elements in contact.
    pub(crate) fn n_in_contact(&self) -> usize {
        let of_grid = || self.pressure.values().iter().filter(|&&p| p > 0.0).count();
        self.elements.as_ref().map_or_else(of_grid, |elements| elements.mesh.len())
    }
}
