//! Full contact, solved exactly.

use rayon::prelude::*;
use rc_core::{Field, Kernel};

use crate::descent::certificate::{Certificate, Residuals};
use crate::descent::info::{GridSolution, LevelInfo, SolveInfo, Status};
use crate::descent::operators::{BlockOperator, read_blocks, write_blocks};
use crate::grid::factors::Factors;
use crate::grid::operators::SymbolOperator;
use crate::grid::uniform_operator::UniformOperator;
use crate::problem::checked::{BELOW_FULL, Problem};
use crate::problem::control::Control;
use crate::problem::tolerance::ErrorBound;

/// A mean pressure that may close every gap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum MeanPressure {
    /// This one, in E*.
    Given(f64),
    /// The least that does.
    Least,
}

/// Part of the least pressure that is added to it, so that all elements press.
const ABOVE_LEAST: f64 = 1e-9;

/// The mean pressure that closes every gap at the load of `problem`, if any.
///
/// Under pressure control it is the prescribed one. On a layer, a penetration beyond full contact of the half-space
/// compresses the layer. The mean pressure is then the one of this compression. On a half-space, the penetration of full
/// contact is that of every load from the least on.
pub(crate) fn mean_pressure(problem: &Problem) -> Option<MeanPressure> {
    match problem.bounds.control {
        Control::MeanPressure(value) => Some(MeanPressure::Given(value)),
        Control::Penetration(depth) if problem.support.is_none() => {
            let is_elastic = problem.bounds.hardness.is_infinite();
            let full_contact = problem.h_max - problem.h_mean;
            (is_elastic && depth >= full_contact * (1.0 - 2.0 * BELOW_FULL)).then_some(MeanPressure::Least)
        }
        Control::Penetration(depth) => {
            let pressure = (depth - (problem.h_max - problem.h_mean)) / problem.support.compliance;
            (pressure > 0.0 && pressure.is_finite()).then_some(MeanPressure::Given(pressure))
        }
    }
}

/// The solution when `mean_pressure` closes every gap: v = h - mean(h) and p = σ0 + L⁻¹ h.
///
/// (For the spectral kernel p̂ = E*|q|ĥ/2.) `None` if p is tensile or above the hardness anywhere. `None` also if
/// rounding or a faulty kernel leave a larger error than `bound`. Coarser grids have the heights `coarser`, finest
/// first.
pub(crate) fn solve(
    (heights, coarser): (&Field, &[Field]),
    kernel: &dyn Kernel,
    mean_pressure: MeanPressure,
    problem: &Problem,
    bound: ErrorBound,
) -> Option<GridSolution> {
    if let MeanPressure::Given(mean) = mean_pressure
        && (proves_partial_contact(heights, kernel, mean) || shows_partial_contact(coarser, kernel, mean))
    {
        return None;
    }
    let grid = heights.grid();
    let mut inverse = fluctuation(heights, kernel, problem.h_mean);
    let block = inverse.layout().len();
    let mean_pressure = match mean_pressure {
        MeanPressure::Given(mean) => mean,
        MeanPressure::Least => -(1.0 + ABOVE_LEAST) * least_of(&inverse, heights),
    };
    let mut pressure = Field::zeros(grid);
    let extremes = read_blocks(&inverse, pressure.values_mut().chunks_mut(block), |p, rows| {
        let (mut least, mut greatest) = (f64::INFINITY, f64::NEG_INFINITY);
        for (p, row) in p.iter_mut().zip(rows) {
            *p = mean_pressure + row;
            (least, greatest) = (least.min(*p), greatest.max(*p));
        }
        [least, greatest]
    });
    if extremes.into_iter().any(|[least, greatest]| least < 0.0 || greatest > problem.bounds.hardness) {
        return None;
    }
    let solution = certified(heights, kernel, problem, (pressure, mean_pressure), &mut inverse);
    solution.info.certificate.meets(bound).then_some(solution)
}

/// L⁻¹ h, ready to be read.
fn fluctuation(heights: &Field, kernel: &dyn Kernel, mean: f64) -> SymbolOperator {
    let grid = heights.grid();
    let mut inverse = SymbolOperator::new(grid, Factors::of(kernel, grid).inverse(grid));
    let block = inverse.layout().len();
    write_blocks(&mut inverse, heights.values().chunks(block), |h, rows| {
        // The mean would add only rounding.
        for (row, h) in rows.iter_mut().zip(h) {
            *row = h - mean;
        }
    });
    inverse.apply();
    inverse
}

/// Maximum number of elements of a grid that shows whether contact is partial.
const SKETCH: usize = 1 << 18;

/// Ratio of fluctuation to mean of the pressure that shows partial contact.
///
/// The fluctuation is that of full contact on a coarser grid. If its minimum is below minus this many times the mean,
/// contact is partial on the finest grid too. The pressures of the two grids differ by much less.
const CLEARLY: f64 = 2.0;

/// Whether full contact on a coarse grid shows that contact is partial.
///
/// It must pull so clearly there that it also pulls on the finest grid. If it does not, the iteration finds full
/// contact.
fn shows_partial_contact(coarser: &[Field], kernel: &dyn Kernel, mean_pressure: f64) -> bool {
    let Some(heights) = coarser.iter().find(|heights| heights.grid().len() <= SKETCH) else { return false };
    least_of(&fluctuation(heights, kernel, heights.mean()), heights) < -CLEARLY * mean_pressure
}

/// Minimum of a fluctuation on the grid of `heights`.
fn least_of(fluctuation: &SymbolOperator, heights: &Field) -> f64 {
    let rows = heights.values().chunks(fluctuation.layout().len());
    let least = read_blocks(fluctuation, rows, |_, rows| rows.iter().copied().fold(f64::INFINITY, f64::min));
    least.into_iter().fold(f64::INFINITY, f64::min)
}

/// Whether one of two Fourier coefficients proves that contact is partial.
///
/// A pressure p ≥ 0 has no Fourier coefficient above its mean. Full contact prescribes the coefficients, and the
/// longest waves of a rough surface are the largest. Two of them are therefore usually a proof, at a tenth of the cost
/// of a transform.
fn proves_partial_contact(heights: &Field, kernel: &dyn Kernel, mean_pressure: f64) -> bool {
    let grid = heights.grid();
    if grid.nx() < 3 || grid.ny() < 3 {
        return false;
    }
    let symbol = kernel.symbol(grid);
    let turn = |i: usize, n: usize| (std::f64::consts::TAU * i as f64 / n as f64).sin_cos();
    let waves: Vec<(f64, f64)> = (0..grid.nx()).map(|ix| turn(ix, grid.nx())).collect();
    let rows: Vec<[f64; 3]> = heights
        .values()
        .par_chunks(grid.nx())
        .map(|row| {
            let mut sums = [0.0; 3];
            for (h, (sin, cos)) in row.iter().zip(&waves) {
                sums[0] += h;
                sums[1] += h * cos;
                sums[2] += h * sin;
            }
            sums
        })
        .collect();
    let (mut along_x, mut along_y) = ((0.0, 0.0), (0.0, 0.0));
    for (iy, [sum, cosine, sine]) in rows.into_iter().enumerate() {
        let (sin, cos) = turn(iy, grid.ny());
        along_x = (along_x.0 + cosine, along_x.1 + sine);
        along_y = (along_y.0 + sum * cos, along_y.1 + sum * sin);
    }
    let coefficient = |(re, im): (f64, f64)| f64::hypot(re, im) / grid.len() as f64;
    coefficient(along_x) / symbol(1, 0) > mean_pressure || coefficient(along_y) / symbol(0, 1) > mean_pressure
}

/// The solution with its certificate, from a fresh application of L.
fn certified(
    heights: &Field,
    kernel: &dyn Kernel,
    problem: &Problem,
    (pressure, mean_pressure): (Field, f64),
    inverse: &mut SymbolOperator,
) -> GridSolution {
    let grid = heights.grid();
    let operator = UniformOperator::new(grid, kernel);
    let mut gap = Field::zeros(grid);
    rc_core::Operator::apply(&operator, pressure.values(), gap.values_mut(), &mut []);
    let (mut weighted, mut total, mut work) = (0.0, 0.0, 0.0);
    for ((g, &p), &h) in gap.values_mut().iter_mut().zip(pressure.values()).zip(heights.values()) {
        // The mean pressure does work only on the rounding of a displacement of zero mean.
        work += (p - mean_pressure) * *g;
        *g -= h;
        weighted += p * *g;
        total += p;
    }
    let approach = weighted / total;
    gap.values_mut().par_iter_mut().for_each(|g| *g -= approach);
    // If a gap is not a number, the sum is not a number either. The minimum passes over it.
    let least = if approach.is_finite() { gap.min() } else { f64::NAN };
    let mean = total / grid.len() as f64;
    let elastic_energy = 0.5 * work / grid.len() as f64;
    let mean_gap = match problem.bounds.control {
        Control::MeanPressure(_) => 0.0,
        Control::Penetration(_) => approach + problem.offset(),
    };
    let residuals = Residuals { least_gap: least, excess: -least, mean_gap, mean_pressure: mean, elastic_energy };
    let mut certificate = Certificate::new(problem, &residuals);
    // The other bound is that of a symmetric L.
    let is_symmetric = kernel.sliding_velocity().is_none();
    let of_residual = if is_symmetric { error_of_residual(&gap, elastic_energy, inverse) } else { f64::INFINITY };
    if of_residual < certificate.energy {
        certificate.energy = of_residual;
    }
    let info = SolveInfo {
        certificate,
        iteration_error: certificate.energy,
        mean_pressure: mean,
        penetration: problem.h_max + approach,
        penetration_full_contact: problem.h_max - problem.h_mean,
        mean_displacement: problem.support.compliance * mean,
        elastic_energy: elastic_energy + problem.uniform_energy(mean),
        levels: vec![LevelInfo { grid, iterations: 0, operator_applications: 1, preconditioner_applications: 0 }],
        coarser: None,
        friction: None,
    };
    GridSolution { pressure, gap, status: Status::FullContact, elements: None, info }
}

/// Another bound on the energy error: √(⟨r, L⁻¹ r⟩/U).
///
/// r is the gap minus its mean. ⟨p - p*, L (p - p*)⟩ ≤ ⟨r, p - p*⟩, since p and p* have the same mean. The bound stays
/// small where the mean pressure is far beyond full contact and multiplies every rounding of the gap.
fn error_of_residual(gap: &Field, elastic_energy: f64, inverse: &mut SymbolOperator) -> f64 {
    let (block, mean) = (inverse.layout().len(), gap.mean());
    write_blocks(inverse, gap.values().chunks(block), |g, rows| {
        for (row, g) in rows.iter_mut().zip(g) {
            *row = g - mean;
        }
    });
    inverse.apply();
    let products = read_blocks(inverse, gap.values().chunks(block), |g, rows| -> f64 {
        rows.iter().zip(g).map(|(row, g)| row * (g - mean)).sum()
    });
    let product = products.into_iter().sum::<f64>() / gap.grid().len() as f64;
    // For an exact solution, rounding may make it negative.
    if product <= 0.0 { 0.0 } else { (product / elastic_energy).sqrt() }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{PI, TAU};

    use rc_core::Grid;
    use rc_kernel::Spectral;

    use super::*;

    /// A wave of amplitude a and length λ/k. Its pressure fluctuates by π k a E* under full contact.
    #[test]
    fn a_coarse_grid_shows_partial_contact_only_far_below_full_contact() {
        let (waves, amplitude) = (8.0, 1e-3);
        let coarse = [Field::from_fn(Grid::square(128).expect("a grid"), |at| amplitude * (TAU * waves * at.x).cos())];
        let full = PI * waves * amplitude;
        for (part, expected) in [(0.1, true), (0.49, true), (0.51, false), (1.0, false), (2.0, false)] {
            assert_eq!(shows_partial_contact(&coarse, &Spectral, part * full), expected, "at {part} of full contact");
        }
        assert!(!shows_partial_contact(&[], &Spectral, 0.1 * full), "no coarser grid shows nothing");
    }
}
