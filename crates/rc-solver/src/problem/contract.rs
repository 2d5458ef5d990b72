//! Quick checks, before a solve, that a kernel or an operator is a half-space.
//!
//! The kernel or operator is the caller's. [`rc_core::testing`] has the thorough checks.

use rc_core::testing::quasi_random;
use rc_core::{ComplexSymbol, Grid, Kernel, Operator};

use crate::problem::error::{OperatorFault, ProblemError};

/// Waves per axis that are always checked, from the longest on.
///
/// They are the largest part of any displacement.
const LONG_WAVES: usize = 4;

/// Waves for each one that is checked on large grids.
///
/// At least [`FEWEST_WAVES`] are checked, and at most [`MOST_WAVES`], which take a few milliseconds.
const WAVES_PER_LOOK: usize = 64;
pub(crate) const FEWEST_WAVES: usize = 512;
const MOST_WAVES: usize = 1 << 16;

/// Relative difference that quadrature may leave between the eigenvalues of two mirrored waves.
const MIRROR_ERROR: f64 = 1e-8;

/// Rounding of an operator in double precision, relative to its maximum displacement.
const ROUNDING: f64 = 1e-12;

/// Refuses a kernel whose symbol on `grid` is not that of an elastic half-space.
///
/// The symbol must be finite, zero at the zero wave and positive elsewhere. It must be symmetric in kx and ky on a
/// square grid, and the same each time it is evaluated. All waves of small grids are checked, and a sample
/// on large grids.
pub(crate) fn check_kernel(kernel: &dyn Kernel, grid: Grid) -> Result<(), ProblemError> {
    let (symbol, again) = (kernel.symbol(grid), kernel.symbol(grid));
    let fault =
        |kx, ky, value, wanted| Err(ProblemError::Symbol { kernel: kernel.name(), grid, kx, ky, value, wanted });
    if let Some(response) = kernel.free_response(grid) {
        for (kx, ky) in [(0, 0), (grid.nx() - 1, 0), (0, grid.ny() - 1), (grid.nx() - 1, grid.ny() - 1)] {
            let value = response(kx, ky);
            if !(value > 0.0 && value <= response(0, 0)) {
                let wanted = "positive, and at most that at (0, 0); with free borders, (kx, ky) is a distance in elements, and the value is the displacement there";
                return fault(kx, ky, value, wanted);
            }
        }
    }
    if let Some(value) = kernel.uniform_displacement()
        && !(value >= 0.0 && value.is_finite())
    {
        return fault(0, 0, value, "zero or positive, and finite, for a solid on a base");
    }
    let waves = [grid.nx() / 2 + 1, grid.ny() / 2 + 1];
    for (kx, ky) in places(waves, (waves[0] * waves[1] / WAVES_PER_LOOK).clamp(FEWEST_WAVES, MOST_WAVES)) {
        let value = symbol(kx, ky);
        match (kx, ky) {
            (0, 0) if value != 0.0 => return fault(kx, ky, value, "zero, since a uniform pressure displaces nothing"),
            (0, 0) => {}
            _ if !(value > 0.0 && value.is_finite()) => return fault(kx, ky, value, "positive and finite"),
            _ => {}
        }
        if again(kx, ky).to_bits() != value.to_bits() {
            return fault(kx, ky, again(kx, ky), "the same each time it is evaluated");
        }
        // On other grids the mirrored wave may not be a wave of the grid.
        let is_mirrored = || (symbol(ky, kx) - value).abs() <= MIRROR_ERROR * value;
        if grid.is_square() && kx.max(ky) > 0 && !is_mirrored() {
            return fault(ky, kx, symbol(ky, kx), "the same at (ky, kx), since the grid is square");
        }
    }
    match kernel.sliding_symbol(grid) {
        Some(symbol) => check_sliding(kernel, grid, &symbol),
        None => Ok(()),
    }
}

/// Refuses a complex symbol that is not finite, or whose real part is not positive.
///
/// With a positive real part the operator is monotone, and there is one solution.
fn check_sliding(kernel: &dyn Kernel, grid: Grid, symbol: &ComplexSymbol<'_>) -> Result<(), ProblemError> {
    let waves = [grid.nx() / 2 + 1, grid.ny() / 2 + 1];
    for (kx, ky) in places(waves, FEWEST_WAVES).filter(|wave| *wave != (0, 0)) {
        for sign in [1, -1] {
            let value = symbol(kx as i64, sign * ky as i64);
            if !(value.re > 0.0 && value.re.is_finite() && value.im.is_finite()) {
                let (kernel, wanted) = (kernel.name(), "finite with a positive real part, for a surface that slides");
                return Err(ProblemError::Symbol { kernel, grid, kx, ky, value: value.re, wanted });
            }
        }
    }
    Ok(())
}

/// The waves or distances that are checked: the first, the last, and `looks` of all.
pub(crate) fn places([columns, rows]: [usize; 2], looks: usize) -> impl Iterator<Item = (usize, usize)> {
    let (n, long) = (columns * rows, [columns.min(LONG_WAVES), rows.min(LONG_WAVES)]);
    let looks = n.min(looks);
    let long_waves = (0..long[0] * long[1]).map(move |i| (i % long[0], i / long[0]));
    let shortest = [(columns - 1, 0), (0, rows - 1), (columns - 1, rows - 1)];
    // With as many looks as waves, every wave is checked once.
    let place = move |i: usize| if looks == n { i } else { ((quasi_random(i) * n as f64) as usize).min(n - 1) };
    let others = (0..looks).map(move |i| (place(i) % columns, place(i) / columns));
    long_waves.chain(shortest).chain(others)
}

/// Refuses an operator that is not v = L p of an elastic half-space.
///
/// The displacement must be finite and of zero mean. L must be symmetric, positive, linear, the same each time, and
/// zero for a uniform pressure. Each may be wrong by `tolerance` of the maximum displacement. The check takes three
/// applications.
///
/// A fault below the tolerance of a solve changes its solution by no more than the tolerance.
pub(crate) fn check_operator(operator: &dyn Operator, tolerance: f64) -> Result<(), ProblemError> {
    let n = operator.n_elements();
    if n == 1 {
        return Ok(());
    }
    let probes = Probes::apply(operator).map_err(ProblemError::NotElastic)?;
    probes.check(operator, tolerance.max(ROUNDING)).map_err(ProblemError::NotElastic)
}

/// Two pressures without a pattern, and their displacements.
struct Probes {
    a: Vec<f64>,
    b: Vec<f64>,
    of_a: Vec<f64>,
    of_b: Vec<f64>,
    /// Displacement of a + b + 1, into memory that held NaN.
    of_sum: Vec<f64>,
}

impl Probes {
    fn apply(operator: &dyn Operator) -> Result<Self, OperatorFault> {
        let n = operator.n_elements();
        let pressure = |factor: usize| (0..n).map(|i| quasi_random(factor * i + 1) - 0.5).collect::<Vec<f64>>();
        let (a, b) = (pressure(1), pressure(3));
        let sum: Vec<f64> = a.iter().zip(&b).map(|(a, b)| a + b + 1.0).collect();
        let (of_a, of_b) = (displacement(operator, &a, 0.0)?, displacement(operator, &b, 0.0)?);
        let of_sum = displacement(operator, &sum, f64::NAN)?;
        Ok(Self { a, b, of_a, of_b, of_sum })
    }

    fn check(&self, operator: &dyn Operator, tolerance: f64) -> Result<(), OperatorFault> {
        let Self { a, b, of_a, of_b, of_sum } = self;
        let n = a.len() as f64;
        let largest = largest(of_a);
        let mean = of_a.iter().sum::<f64>() / n;
        if mean.abs() > tolerance * largest {
            return Err(OperatorFault::Mean { mean, largest });
        }
        let sum = of_a.iter().zip(of_b).map(|(a, b)| a + b);
        let difference = of_sum.iter().zip(sum).fold(0.0_f64, |most, (whole, parts)| most.max((whole - parts).abs()));
        if difference > tolerance * largest {
            return Err(self.why_sums_differ(operator, tolerance, difference));
        }
        let (ab, ba) = (product(a, of_b), product(b, of_a));
        // For vectors without a pattern, the product is smaller than the product of their norms by √n. The noise in it
        // is smaller by the same factor.
        if (ab - ba).abs() > tolerance * (product(a, a) * product(of_b, of_b) / n).sqrt() {
            return Err(OperatorFault::Symmetry { ab, ba });
        }
        // A displacement of zero mean does no work on the mean of a pressure.
        let energy = product(a, of_a).min(product(b, of_b));
        if energy > 0.0 { Ok(()) } else { Err(OperatorFault::Energy { energy }) }
    }

    /// Finds the reason why displacements of sums differ, with two more applications.
    ///
    /// Either the operator changes, or a uniform pressure displaces, or the operator is not linear.
    fn why_sums_differ(&self, operator: &dyn Operator, tolerance: f64, difference: f64) -> OperatorFault {
        let largest_of_a = largest(&self.of_a);
        let again = displacement(operator, &self.a, 0.0);
        let uniform = displacement(operator, &vec![1.0; self.a.len()], 0.0);
        let (again, uniform) = match (again, uniform) {
            (Ok(again), Ok(uniform)) => (again, uniform),
            (Err(fault), _) | (_, Err(fault)) => return fault,
        };
        let change = again.iter().zip(&self.of_a).fold(0.0_f64, |most, (v, before)| most.max((v - before).abs()));
        if change > 0.1 * tolerance * largest_of_a {
            return OperatorFault::Changes { change, largest: largest_of_a };
        }
        let displacement = largest(&uniform);
        if displacement > 0.1 * tolerance * largest_of_a {
            return OperatorFault::Uniform { displacement };
        }
        OperatorFault::Linearity { difference, largest: largest_of_a }
    }
}

/// The displacement L `pressure`, written into memory that held `before`.
fn displacement(operator: &dyn Operator, pressure: &[f64], before: f64) -> Result<Vec<f64>, OperatorFault> {
    let (mut v, mut scratch) = (vec![before; pressure.len()], vec![before; operator.scratch_len()]);
    operator.apply(pressure, &mut v, &mut scratch);
    match v.iter().position(|v| !v.is_finite()) {
        Some(element) => Err(OperatorFault::NotFinite { element, value: v[element] }),
        None => Ok(v),
    }
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0_f64, |most, v| most.max(v.abs()))
}

fn product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use rc_core::Symbol;
    use rc_kernel::{Love, Spectral};

    use super::*;
    use crate::grid::direct_sum::DirectSum;
    use crate::grid::uniform_operator::UniformOperator;
    use crate::tiles::multilevel::MultilevelOperator;

    /// Changes the displacement of an operator, given the count of applications and the largest displacement.
    type Fault = fn(&mut [f64], usize, f64);

    struct Faulty {
        operator: DirectSum,
        fault: Fault,
        count: AtomicUsize,
    }

    impl Operator for Faulty {
        fn n_elements(&self) -> usize {
            self.operator.n_elements()
        }

        fn scratch_len(&self) -> usize {
            0
        }

        fn apply(&self, pressure: &[f64], displacement: &mut [f64], scratch: &mut [f64]) {
            self.operator.apply(pressure, displacement, scratch);
            let (count, size) = (self.count.fetch_add(1, Ordering::Relaxed), largest(displacement));
            (self.fault)(displacement, count, size);
        }
    }

    fn found(fault: Fault) -> Option<OperatorFault> {
        let operator = DirectSum::new(Grid::new(12, 10).expect("grid"), &Love);
        match check_operator(&Faulty { operator, fault, count: AtomicUsize::new(0) }, 1e-6) {
            Err(ProblemError::NotElastic(fault)) => Some(fault),
            _ => None,
        }
    }

    #[test]
    fn each_fault_of_an_operator_has_its_name() {
        assert_eq!(found(|_, _, _| {}), None);
        assert!(matches!(found(|v, _, _| v[7] = f64::NAN), Some(OperatorFault::NotFinite { element: 7, .. })));
        let biased: Fault = |v, _, size| v.iter_mut().for_each(|v| *v += 1e-4 * size);
        assert!(matches!(found(biased), Some(OperatorFault::Mean { .. })));
        let noisy: Fault = |v, count, size| {
            let sign = if count.is_multiple_of(2) { 1.0 } else { -1.0 };
            v.iter_mut().enumerate().for_each(|(i, v)| *v += 1e-4 * sign * size * if i % 2 == 0 { 1.0 } else { -1.0 });
        };
        assert!(matches!(found(noisy), Some(OperatorFault::Changes { .. })));
        let unsymmetric: Fault = |v, _, _| {
            let (first, rest) = v.split_at_mut(60);
            for v in first.iter_mut() {
                *v *= 1.01;
            }
            let mean = (first.iter().sum::<f64>() + rest.iter().sum::<f64>()) / 120.0;
            first.iter_mut().chain(rest).for_each(|v| *v -= mean);
        };
        assert!(matches!(found(unsymmetric), Some(OperatorFault::Symmetry { .. })));
        assert!(matches!(found(|v, _, _| v.iter_mut().for_each(|v| *v = -*v)), Some(OperatorFault::Energy { .. })));
        let cubed: Fault = |v, _, size| {
            for v in v.iter_mut() {
                *v += 1e-3 * v.powi(3) / (size * size);
            }
            let mean = v.iter().sum::<f64>() / v.len() as f64;
            for v in v.iter_mut() {
                *v -= mean;
            }
        };
        assert!(matches!(found(cubed), Some(OperatorFault::Linearity { .. })));
        assert!(matches!(found(|v, _, _| v.fill(0.0)), Some(OperatorFault::Energy { .. })));
    }

    /// Adds the mean pressure to the wave of alternating signs. It is linear, but a uniform pressure displaces.
    struct UniformDisplaces(DirectSum);

    impl Operator for UniformDisplaces {
        fn n_elements(&self) -> usize {
            self.0.n_elements()
        }

        fn scratch_len(&self) -> usize {
            0
        }

        fn apply(&self, pressure: &[f64], displacement: &mut [f64], scratch: &mut [f64]) {
            self.0.apply(pressure, displacement, scratch);
            let mean = pressure.iter().sum::<f64>() / pressure.len() as f64;
            displacement.iter_mut().enumerate().for_each(|(i, v)| *v += if i % 2 == 0 { mean } else { -mean });
        }
    }

    #[test]
    fn a_uniform_pressure_that_displaces_is_named() {
        let operator = UniformDisplaces(DirectSum::new(Grid::square(8).expect("grid"), &Love));
        let error = check_operator(&operator, 1e-6).err();
        assert!(matches!(error, Some(ProblemError::NotElastic(OperatorFault::Uniform { .. }))), "{error:?}");
    }

    #[test]
    fn operators_of_every_kind_pass_at_the_smallest_tolerance() {
        for (nx, ny) in [(1, 1), (1, 64), (9, 15), (64, 64), (128, 2)] {
            let grid = Grid::new(nx, ny).expect("grid");
            for kernel in [&Love as &dyn Kernel, &Spectral] {
                check_operator(&UniformOperator::new(grid, kernel), 1e-13).expect("sound");
            }
        }
        let places = (0..16).flat_map(|row| (0..16).map(move |column| [column, row])).collect();
        check_operator(&MultilevelOperator::new(32, 128, places, 1e-6).expect("valid"), 1e-6).expect("sound");
    }

    /// The symbol of another kernel, with a different value at one wave.
    struct OneWave((usize, usize), f64);

    impl Kernel for OneWave {
        fn name(&self) -> &'static str {
            "one wave"
        }

        fn symbol(&self, grid: Grid) -> Symbol<'_> {
            let waves = Spectral.symbol(grid);
            Box::new(move |kx, ky| if (kx, ky) == self.0 { self.1 } else { waves(kx, ky) })
        }
    }

    #[test]
    fn each_wave_of_a_small_grid_and_the_long_waves_of_a_large_one_are_looked_at() {
        let small = Grid::square(32).expect("grid");
        check_kernel(&Spectral, small).expect("sound");
        for wave in (0..17 * 17).map(|i| (i % 17, i / 17)) {
            for value in [f64::NAN, f64::INFINITY, -1.0, 0.0, 7.0] {
                let is_sound = (wave == (0, 0) && value == 0.0)
                    || (wave.0 == wave.1 && wave.0 > 0 && value > 6.0 && value.is_finite());
                let error = check_kernel(&OneWave(wave, value), small).err();
                assert_eq!(error.is_none(), is_sound, "{wave:?}: {value}");
            }
        }
        let large = Grid::new(4096, 2048).expect("grid");
        check_kernel(&Spectral, large).expect("sound");
        for wave in [(0, 0), (3, 0), (0, 3), (2, 1), (2048, 1024), (0, 1024)] {
            assert!(check_kernel(&OneWave(wave, -1.0), large).is_err(), "{wave:?}");
        }
    }
}
