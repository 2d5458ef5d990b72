//! One contact of a surface on the finest grid, by the faster of the two methods.

use anyhow::Result;
use rc_core::{Field, Grid, HeightField, HeightSource, Silent};
use rc_kernel::Love;
use rc_solver::{
    AdaptiveParams, AdaptiveProblem, AdaptiveSolution, ContactArea, Control, Estimate, IterationParams, Observables,
    SolveInfo, solve_uniform,
};

/// A solved contact, in units of λ and E*.
#[derive(Clone, Debug)]
pub(crate) struct Contact {
    /// Pressure on the finest grid.
    pub(crate) pressure: Field,
    pub(crate) area: ContactArea,
    pub(crate) info: SolveInfo,
}

/// Solves for `surface` on `side` × `side` elements: adaptively, where the estimated contact area says that this is faster,
/// else on the uniform grid.
pub(crate) fn solve(surface: &dyn HeightField, side: usize, control: Control, tolerance: f64) -> Result<Contact> {
    let solve = IterationParams { tolerance, ..IterationParams::certified() };
    let params = AdaptiveParams { solve, ..AdaptiveParams::certified() };
    let problem =
        AdaptiveProblem::new(HeightSource::Surface { surface: surface, grid: Grid::square(side)? }, control, &params)?;
    if problem.estimate().area_fraction > Estimate::GREATEST_ADAPTIVE_AREA {
        drop(problem);
        let heights = surface.sample(Grid::square(side)?);
        let solution = solve_uniform(&heights, &Love, control, &solve, &Silent)?;
        let area = Observables::of(&solution, &Love).area;
        return Ok(Contact { pressure: solution.pressure, area, info: solution.info });
    }
    let solution = problem.solve(&Silent)?;
    Ok(Contact { pressure: pressure_field(&solution)?, area: solution.contact_area(), info: solution.info })
}

/// The pressure on the finest grid.
pub fn pressure_field(solution: &AdaptiveSolution) -> Result<Field> {
    collect(solution.grid(), |take| solution.pressure_rows(take))
}

/// The displacement v on the finest grid.
pub(crate) fn displacement_field(solution: &AdaptiveSolution) -> Result<Field> {
    collect(solution.grid(), |take| solution.displacement_rows(take))
}

/// A field from its rows, which `rows` hands out in order.
fn collect(grid: Grid, rows: impl FnOnce(&mut dyn FnMut(usize, &[f64]) -> Result<()>) -> Result<()>) -> Result<Field> {
    let mut values = Vec::with_capacity(grid.len());
    rows(&mut |_, rows| {
        values.extend_from_slice(rows);
        Ok(())
    })?;
    Ok(Field::new(grid, values)?)
}
