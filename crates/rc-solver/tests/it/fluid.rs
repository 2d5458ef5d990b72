//! Contact under a fluid: a pressure that is nowhere below that of the fluid.

use std::f64::consts::TAU;

use rc_core::{Field, Grid, Kernel, Operator, Silent};
use rc_kernel::{FreeLove, Layer, Love, LoveLayer, Spectral};
use rc_solver::{
    ContactProblem, Control, Feature, FluidProblem, Method, ProblemError, SolveError, SolveParams, UniformOperator,
};

use crate::hardness::rough;

fn under<'a>(heights: &'a Field, kernel: &'a dyn Kernel, control: Control) -> ContactProblem<'a> {
    ContactProblem::new(heights, control).with_kernel(kernel)
}

fn fluid<'a>(problem: ContactProblem<'a>, pressure: &Field, params: &SolveParams) -> FluidProblem<'a> {
    problem.with_fluid_pressure(pressure.clone(), params).expect("a problem under a fluid")
}

/// A fluid that presses on one side of the cell, with the mean pressure `mean`.
fn on_one_side(grid: Grid, mean: f64) -> Field {
    Field::from_fn(grid, |at| mean * (1.0 + (TAU * at.x).sin() * (0.5 + 0.4 * (TAU * at.y).cos())))
}

#[test]
fn a_uniform_fluid_leaves_the_problem_of_the_rest_of_the_load_bit_for_bit() {
    let heights = rough(2, 256, 16);
    let layer = LoveLayer(Layer::on_rigid_base(0.2, 0.3));
    let compliance = layer.uniform_displacement().expect("a layer");
    let [load, f] = [5e-4, 2e-4];
    let pressure = Field::from_fn(heights.grid(), |_| f);
    for (kernel, method, per_pressure) in [
        (&Love as &dyn Kernel, Method::Uniform, 0.0),
        (&Love, Method::Adaptive, 0.0),
        (&Love, Method::GaussSeidel, 0.0),
        (&layer, Method::Uniform, compliance),
    ] {
        let params = SolveParams::default().by(method);
        let problem = fluid(under(&heights, kernel, Control::MeanPressure(load)), &pressure, &params);
        let found = problem.solve(&Silent).expect("solvable");
        let rest = Control::MeanPressure(load - pressure.mean());
        let alone = under(&heights, kernel, rest).solve(&params, &Silent).expect("solvable");
        assert!(found.info() == alone.info() && found.gap() == alone.gap(), "{method}");
        assert!(found.pressure() == alone.pressure(), "{method}");
        let both = problem.of(&found);
        assert!((both.mean_pressure / load - 1.0).abs() < 1e-9, "{method}: {both:?}");
        let expected = alone.info().penetration + per_pressure * f;
        assert!((both.penetration / expected - 1.0).abs() < 1e-12, "{method}: {both:?}");
        let energy = alone.info().elastic_energy + per_pressure * f * (load - 0.5 * f);
        assert!((both.elastic_energy / energy - 1.0).abs() < 1e-9, "{method}: {both:?} for {energy}");
        // The same penetration of the undeformed heights gives the same load.
        let sunk = fluid(under(&heights, kernel, Control::Penetration(both.penetration)), &pressure, &params);
        if method != Method::GaussSeidel {
            let load_again = sunk.of(&sunk.solve(&Silent).expect("solvable")).mean_pressure;
            assert!((load_again / load - 1.0).abs() < 1e-3, "{method}: {load_again}");
        }
    }
}

#[test]
fn no_fluid_gives_the_digits_of_the_contact_without_one() {
    let heights = rough(3, 128, 8);
    let nothing = Field::zeros(heights.grid());
    for kernel in [&Love as &dyn Kernel, &Spectral, &FreeLove] {
        for control in [Control::MeanPressure(4e-4), Control::Penetration(2e-2 * heights.max())] {
            let params = SolveParams::default();
            let problem = fluid(under(&heights, kernel, control), &nothing, &params);
            let found = problem.solve(&Silent).expect("solvable");
            let alone = under(&heights, kernel, control).solve(&params, &Silent).expect("solvable");
            assert!(found.info() == alone.info() && found.pressure() == alone.pressure(), "{}", kernel.name());
            let both = problem.of(&found);
            assert_eq!(both.penetration.to_bits(), alone.info().penetration.to_bits(), "{}", kernel.name());
            assert_eq!(both.elastic_energy.to_bits(), alone.info().elastic_energy.to_bits(), "{}", kernel.name());
        }
    }
}

/// L as a matrix, one column for each loaded element.
fn matrix(grid: Grid, kernel: &dyn Kernel) -> Vec<Vec<f64>> {
    let operator = UniformOperator::new(grid, kernel);
    let column = |i| {
        let (mut unit, mut column) = (vec![0.0; grid.len()], vec![0.0; grid.len()]);
        unit[i] = 1.0;
        operator.apply(&unit, &mut column, &mut []);
        column
    };
    (0..grid.len()).map(column).collect()
}

/// Projected Gauss-Seidel for p ≥ f at a given penetration, element by element, with a dense L.
fn by_gauss_seidel(l: &[Vec<f64>], heights: &Field, fluid: &Field, penetration: f64) -> Vec<f64> {
    let (mut p, h, top) = (fluid.values().to_vec(), heights.values(), heights.max());
    for _ in 0..20_000 {
        let mut change = 0.0_f64;
        for i in 0..p.len() {
            let gap = l[i].iter().zip(&p).map(|(l, p)| l * p).sum::<f64>() - h[i] + top - penetration;
            let next = (p[i] - gap / l[i][i]).max(fluid.values()[i]);
            change = change.max((next - p[i]).abs());
            p[i] = next;
        }
        if change < 1e-15 {
            return p;
        }
    }
    panic!("Gauss-Seidel did not converge");
}

#[test]
fn any_fluid_agrees_with_a_dense_gauss_seidel_solve() {
    let grid = Grid::square(16).expect("a grid");
    let heights = rough(1, 16, 4);
    let pressure = on_one_side(grid, 2e-3);
    let layer = LoveLayer(Layer::on_rigid_base(0.3, 0.3));
    let params = SolveParams::to_tolerance(1e-10).by(Method::Uniform);
    for kernel in [&Love as &dyn Kernel, &Spectral, &FreeLove, &layer] {
        let name = kernel.name();
        let l = matrix(grid, kernel);
        let nothing = fluid(under(&heights, kernel, Control::MeanPressure(1e-2)), &pressure, &params);
        let touching = nothing.of(&nothing.solve(&Silent).expect("solvable")).penetration;
        let expected = by_gauss_seidel(&l, &heights, &pressure, touching);
        let touches = expected.iter().zip(pressure.values()).filter(|(p, f)| p > f).count();
        assert!(touches > 20 && touches < 236, "{name}: {touches} of 256 elements touch");
        let mean = expected.iter().sum::<f64>() / 256.0;
        assert!((mean / 1e-2 - 1.0).abs() < 1e-7, "{name}: the load is {mean}");
        let work: f64 =
            l.iter().zip(&expected).map(|(l, p)| p * l.iter().zip(&expected).map(|(l, p)| l * p).sum::<f64>()).sum();
        for control in [Control::MeanPressure(mean), Control::Penetration(touching)] {
            let problem = fluid(under(&heights, kernel, control), &pressure, &params);
            let found = problem.solve(&Silent).expect("solvable");
            let total = found.pressure().values().iter().zip(pressure.values()).map(|(q, f)| q + f);
            let largest = expected.iter().copied().fold(0.0, f64::max);
            let off = total.zip(&expected).map(|(p, expected)| (p - expected).abs()).fold(0.0, f64::max);
            assert!(off < 1e-6 * largest, "{name} under {control:?}: off by {off} of {largest}");
            let both = problem.of(&found);
            assert!((both.penetration / touching - 1.0).abs() < 1e-8, "{name} under {control:?}: {both:?}");
            assert!((both.elastic_energy / (work / 512.0) - 1.0).abs() < 1e-7, "{name} under {control:?}: {both:?}");
        }
    }
}

#[test]
fn a_rough_contact_under_a_fluid_meets_its_conditions_and_its_certificate() {
    let heights = rough(5, 256, 32);
    let pressure = on_one_side(heights.grid(), 3e-4);
    for method in [Method::Uniform, Method::Adaptive] {
        let params = SolveParams::to_tolerance(1e-6).by(method);
        let problem = fluid(under(&heights, &Love, Control::MeanPressure(8e-4)), &pressure, &params);
        let found = problem.solve(&Silent).expect("solvable");
        assert!(found.certificate().meets(found.bound()), "{method}: {}", found.certificate());
        let both = problem.of(&found);
        let total: Vec<f64> = found.pressure().values().iter().zip(pressure.values()).map(|(q, f)| q + f).collect();
        let mut displacement = vec![0.0; total.len()];
        UniformOperator::new(heights.grid(), &Love).apply(&total, &mut displacement, &mut []);
        let (top, range) = (heights.max(), heights.max() - heights.min());
        let gap = displacement.iter().zip(heights.values()).map(|(v, h)| v - h + top - both.penetration);
        let mut touching = 0;
        for ((gap, stated), q) in gap.zip(found.gap().values()).zip(found.pressure().values()) {
            assert!(*q >= 0.0 && gap > -1e-5 * range, "{method}: overlap {gap}");
            assert!((gap - stated).abs() < 1e-5 * range, "{method}: gap {gap}, stated {stated}");
            assert!(*q == 0.0 || gap < 1e-4 * range, "{method}: pressure {q} across a gap of {gap}");
            touching += usize::from(*q > 0.0);
        }
        assert!(touching > 1000, "{method}: {touching} elements touch");
        let work = total.iter().zip(&displacement).map(|(p, v)| p * v).sum::<f64>() / (2.0 * total.len() as f64);
        assert!((both.elastic_energy / work - 1.0).abs() < 1e-6, "{method}: {both:?} for {work}");
        let dry = under(&heights, &Love, Control::MeanPressure(8e-4)).solve(&params, &Silent).expect("solvable");
        assert!(found.area().fraction < dry.area().fraction, "{method}: the fluid bears a part of the load");
    }
}

#[test]
fn fluids_that_leave_nothing_to_the_contact_are_refused() {
    let heights = rough(2, 64, 8);
    let refused = |problem: ContactProblem<'_>, pressure: &Field, params: &SolveParams| {
        problem.with_fluid_pressure(pressure.clone(), params).map(|_| ()).expect_err("refused")
    };
    let params = SolveParams::default();
    let pressure = on_one_side(heights.grid(), 3e-4);
    let by = |control| under(&heights, &Love, control);
    let error = refused(by(Control::MeanPressure(2e-4)), &pressure, &params);
    assert!(matches!(error, SolveError::Problem(ProblemError::FluidBears { .. })), "{error}");
    // A fluid that presses the summits down.
    let on_summits = heights.values().iter().map(|h| if *h > 0.0 { 6e-4 } else { 0.0 });
    let on_summits = Field::new(heights.grid(), on_summits.collect()).expect("a field");
    let error = refused(by(Control::Penetration(1e-9)), &on_summits, &params);
    assert!(matches!(error, SolveError::Problem(ProblemError::FluidParts { .. })), "{error}");
    let deep = 2.0 * (heights.max() - heights.mean());
    let error = refused(by(Control::Penetration(deep)), &pressure, &params);
    assert!(
        matches!(error, SolveError::Problem(ProblemError::Penetration { value, .. }) if value.to_bits() == deep.to_bits()),
        "{error}"
    );
    for wrong in [-1e-9, f64::NAN, f64::INFINITY] {
        let mut pressure = pressure.clone();
        pressure.values_mut()[70] = wrong;
        let error = refused(by(Control::MeanPressure(1e-3)), &pressure, &params);
        assert!(matches!(error, SolveError::Problem(ProblemError::FluidPressure { ix: 6, iy: 1, .. })), "{error}");
    }
    let coarse = on_one_side(Grid::square(32).expect("a grid"), 3e-4);
    let error = refused(by(Control::MeanPressure(1e-3)), &coarse, &params);
    assert!(matches!(error, SolveError::Problem(ProblemError::FluidGrid { .. })), "{error}");
    let error = refused(by(Control::MeanPressure(1e-3)).with_hardness(1e-2), &pressure, &params);
    assert!(matches!(error, SolveError::Unsupported(refusal) if refusal.object == Feature::Hardness));
}
