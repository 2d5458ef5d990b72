//! Convergence with smaller elements, and the error at the paper's smallest step.

use anyhow::Result;
use rc_core::{Grid, HeightField as _};
use rc_fractal::{SpectrumParams, Surface};
use rc_solver::{Control, SolveParams, solve};

use super::params::Params;
use crate::table::Rows;
use crate::{Rule, Table};

/// Results on one mesh.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mesh {
    pub(super) elements_per_wave: usize,
    /// A/A0 by counting elements. The A/A0 with edges located between centres follows.
    area_cells: f64,
    area: f64,
    /// Rms pressure in E*.
    rms_pressure: f64,
    penetration: f64,
}

/// Errors of a mesh, relative to the values on the finest mesh.
#[derive(Clone, Copy, Debug)]
pub(super) struct Errors {
    pub(super) counting: f64,
    pub(super) located: f64,
    pub(super) rms_pressure: f64,
    pub(super) penetration: f64,
}

pub(super) fn solve_all(params: &Params) -> Result<Vec<Mesh>> {
    let surface = Surface::new(&SpectrumParams::paper(params.converged_waves, 1))?;
    let mesh = |&elements_per_wave: &usize| {
        let heights = surface.on(Grid::square(elements_per_wave * params.converged_waves)?);
        let solution =
            solve(heights, Control::MeanPressure(params.load), &SolveParams::to_tolerance(params.tolerance))?;
        Ok(Mesh {
            elements_per_wave,
            area_cells: solution.area().cells,
            area: solution.area().fraction,
            rms_pressure: solution.observables().rms_pressure,
            penetration: solution.info().penetration,
        })
    };
    params.meshes.iter().map(mesh).collect()
}

impl Mesh {
    pub(super) fn errors(&self, finest: &Self) -> Errors {
        let relative = |of: fn(&Self) -> f64| of(self) / of(finest) - 1.0;
        Errors {
            counting: self.area_cells / finest.area - 1.0,
            located: relative(|mesh| mesh.area),
            rms_pressure: relative(|mesh| mesh.rms_pressure),
            penetration: relative(|mesh| mesh.penetration),
        }
    }
}

/// Table of the values, and of errors relative to the finest mesh.
pub(super) fn table(meshes: &[Mesh]) -> Table {
    // These errors are relative already.
    let error = Rule::absolute(2e-5);
    Rows::of(meshes.iter().zip(meshes.last().into_iter().cycle()).map(|(mesh, finest)| (mesh, mesh.errors(finest))))
        .column("elements_per_wave", |(mesh, _)| mesh.elements_per_wave)
        .column("area_fraction_by_counting", |(mesh, _)| mesh.area_cells)
        .column("area_fraction", |(mesh, _)| mesh.area)
        .column("rms_pressure_over_e_star", |(mesh, _)| mesh.rms_pressure)
        .column("penetration_over_side", |(mesh, _)| mesh.penetration)
        .within("counting_error", error, |(_, errors)| errors.counting)
        .within("area_error", error, |(_, errors)| errors.located)
        .within("rms_pressure_error", error, |(_, errors)| errors.rms_pressure)
        .within("penetration_error", error, |(_, errors)| errors.penetration)
        .table("convergence")
        .rest(Rule::relative(1e-4))
}
