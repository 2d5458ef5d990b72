//! The incremental contact stiffness on a uniform grid.

use rc_core::{Boundary, Field, Kernel};

use crate::descent::stiffness::{self, elastic_part, gain, search, stiffness_by_gmres};
use crate::grid::operators::corrections_of;
use crate::grid::response::GridResponse;
use crate::problem::support::Support;

/// dσ0/dΔ, in E*/λ, on a uniform grid, as [`crate::descent::stiffness::stiffness_of`].
///
/// It is to a few percent unless the pressure has `converged`.
pub(crate) fn contact_stiffness(pressure: &Field, hardness: f64, kernel: &dyn Kernel, converged: bool) -> f64 {
    let grid = pressure.grid();
    let (pressure, support) = (elastic_part(pressure.values(), hardness), Support::of(kernel, grid));
    if support.boundary == Boundary::Periodic && pressure.iter().all(|&p| p > 0.0) {
        return support.compliance.recip();
    }
    let mut operator = corrections_of(grid, kernel, &GridResponse::of(grid, kernel));
    if kernel.sliding_velocity().is_some() {
        return stiffness_by_gmres(&pressure, (grid.len() as f64, converged), &mut *operator);
    }
    search(&pressure, (grid.len() as f64, gain(converged)), &mut *operator, |_, _| {})
}

/// The smallest dp/dσ0 of the contact, as [`stiffness::least_rise`].
///
/// It is 1 in full contact, where the pressure rises everywhere by the load.
pub(crate) fn least_rise(pressure: &Field, kernel: &dyn Kernel) -> f64 {
    let (grid, values) = (pressure.grid(), pressure.values());
    if Support::of(kernel, grid).boundary == Boundary::Periodic && values.iter().all(|&p| p > 0.0) {
        return 1.0;
    }
    let mut operator = corrections_of(grid, kernel, &GridResponse::of(grid, kernel));
    stiffness::least_rise(values, grid.len() as f64, &mut *operator)
}

#[cfg(test)]
mod tests {
    use rc_core::Grid;
    use rc_core::testing::quasi_random;
    use rc_kernel::Love;

    use super::*;
    use crate::grid::dense::eliminate;
    use crate::grid::direct_sum::DirectSum;

    /// Mean of the x that displaces every element in contact by 1, by elimination.
    fn eliminated(pressure: &Field) -> f64 {
        let operator = DirectSum::new(pressure.grid(), &Love);
        let contact: Vec<usize> = (0..pressure.grid().len()).filter(|&i| pressure.values()[i] > 0.0).collect();
        let row = |&i: &usize| contact.iter().map(|&j| operator.coefficient(i, j)).collect();
        let x = eliminate(contact.iter().map(row).collect(), vec![1.0; contact.len()]);
        x.iter().sum::<f64>() / pressure.grid().len() as f64
    }

    #[test]
    fn the_stiffness_of_many_contacts_is_that_of_elimination_to_a_thousandth() {
        let grid = Grid::square(24).expect("a grid");
        let check = |pressure: &Field, what: &str| {
            let (found, exact) = (contact_stiffness(pressure, f64::INFINITY, &Love, true), eliminated(pressure));
            assert!((found / exact - 1.0).abs() < 1e-3, "{what}: {found} for {exact}");
        };
        // Contacts of several sizes, with pressures that are not a multiple of those of a rigid punch.
        let wave = |t: f64| (std::f64::consts::TAU * t).cos();
        for (threshold, waves) in [(0.9, 1.0), (0.3, 2.0), (1.2, 3.0), (-0.6, 1.0), (-1.5, 2.0), (-2.2, 3.0)] {
            let pressure = Field::from_fn(grid, |at| {
                (wave(waves * at.x + 0.1) + wave(waves * at.y - at.x) + 0.5 * wave(5.0 * at.x) - threshold).max(0.0)
            });
            check(&pressure, &format!("{waves} waves above {threshold}"));
        }
        // Contacts of one element, with pressures of all sizes. They are dense on one side of the cell.
        let pressure = (0..grid.len()).map(|i| {
            let threshold = 0.3 + 0.6 * (i % 24) as f64 / 24.0;
            (quasi_random(i) - threshold).max(0.0).powi(4)
        });
        check(&Field::new(grid, pressure.collect()).expect("a value for each element"), "single elements");
    }
}
