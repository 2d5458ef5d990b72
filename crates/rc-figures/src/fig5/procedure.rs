//! Fig. 5 at reduced size, solved by the paper's own procedure.
//!
//! The procedure is adaptive mesh, Gauss-Seidel iteration and double check.

use anyhow::{Context, Result};
use rc_core::{Grid, HeightField as _};
use rc_fractal::{SpectrumParams, Surface};
use rc_solver::{Control, Method, SolveParams, solve};

use crate::table::Rows;
use crate::{Rule, Table};

/// The contacts that both methods solve.
///
/// The paper's d = λ_min/32 is half the side of these elements.
#[derive(Clone, Debug)]
pub(super) struct Params {
    waves: usize,
    elements_per_wave: usize,
    loads: Vec<f64>,
    seeds: Vec<u64>,
    tolerance: f64,
}

impl Params {
    /// A case with only a few waves.
    ///
    /// The cost of Gauss-Seidel grows as the square of the number of elements.
    pub(super) fn reduced(load: f64) -> Self {
        Self { waves: 8, elements_per_wave: 16, loads: vec![2e-4, load], seeds: vec![1, 2], tolerance: 1e-5 }
    }
}

/// One contact by both methods.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pair {
    seed: u64,
    load: f64,
    procedure: Contact,
    every_element: Contact,
}

/// One contact by one method.
#[derive(Clone, Copy, Debug)]
struct Contact {
    /// A/A0 by counting the smallest elements.
    area: f64,
    /// Δ/h_max.
    penetration: f64,
    /// Elements in contact.
    elements: usize,
}

impl Pair {
    /// Relative difference of the procedure's area from the other method's.
    pub(super) fn difference(&self) -> f64 {
        self.procedure.area / self.every_element.area - 1.0
    }

    /// Relative difference of the procedure's penetration from the other method's.
    #[cfg(test)]
    pub(super) fn difference_of_penetration(&self) -> f64 {
        self.procedure.penetration / self.every_element.penetration - 1.0
    }
}

pub(super) fn solve_all(params: &Params) -> Result<Vec<Pair>> {
    let grid = Grid::square(params.waves * params.elements_per_wave)?;
    let mut pairs = Vec::new();
    for &seed in &params.seeds {
        let surface = Surface::new(&SpectrumParams::paper(params.waves, seed))?;
        for &load in &params.loads {
            let by = |method| {
                let how = SolveParams::to_tolerance(params.tolerance).by(method);
                let solution = solve(surface.on(grid), Control::MeanPressure(load), &how)
                    .with_context(|| format!("N = {}, seed {seed}, σ0/E* = {load:e}", params.waves))?;
                let info = solution.info();
                let penetration = info.penetration / info.penetration_full_contact;
                Ok::<_, anyhow::Error>(Contact {
                    area: solution.area().cells,
                    penetration,
                    elements: solution.n_in_contact(),
                })
            };
            pairs.push(Pair { seed, load, procedure: by(Method::GaussSeidel)?, every_element: by(Method::Uniform)? });
        }
    }
    Ok(pairs)
}

pub(super) fn table(params: &Params, pairs: &[Pair]) -> Table {
    Rows::of(pairs)
        .column("waves", |_| params.waves)
        .column("seed", |pair| pair.seed)
        .column("mean_pressure_over_e_star", |pair| pair.load)
        .column("area_fraction_by_procedure", |pair| pair.procedure.area)
        .column("area_fraction", |pair| pair.every_element.area)
        .within("relative_difference", Rule::absolute(2e-4), |pair| pair.difference())
        .column("penetration_over_h_max_by_procedure", |pair| pair.procedure.penetration)
        .column("penetration_over_h_max", |pair| pair.every_element.penetration)
        .column("elements_by_procedure", |pair| pair.procedure.elements)
        .column("elements", |pair| pair.every_element.elements)
        .table("procedure")
        .rest(Rule::relative(2e-4))
}
