//! The function `rc_solver::solve` and its results, for all methods.

use std::convert::Infallible;
use std::sync::Arc;

use rayon::prelude::*;
use rc_core::{Elasticity, Field, Grid, HeightField as _, HeightSource, PeriodicCell, Silent, Units};
use rc_fractal::{SpectrumParams, Surface};
use rc_kernel::Spectral;
use rc_solver::{
    AdaptiveError, ContactProblem, Control, Feature, Method, MethodReason, Solution, SolveError, SolveParams, Status,
    Tolerance, solve,
};

const LOAD: Control = Control::MeanPressure(8.9e-4);

fn surface(waves: usize) -> Surface {
    Surface::new(&SpectrumParams::paper(waves, 1)).expect("a surface")
}

fn square(side: usize) -> Grid {
    Grid::square(side).expect("a grid")
}

fn rows_of(solution: &Solution<'_>, gap: bool) -> Vec<f64> {
    let mut values = Vec::new();
    let take = |_: usize, rows: &[f64]| {
        values.extend_from_slice(rows);
        Ok::<(), Infallible>(())
    };
    let Ok(()) = if gap { solution.gap_rows(take) } else { solution.pressure_rows(take) };
    values
}

#[test]
fn every_method_gives_one_kind_of_solution() {
    let surface = surface(8);
    let solved = [Method::Adaptive, Method::Uniform, Method::GaussSeidel].map(|method| {
        let params = SolveParams::default().by(method);
        let solution = solve(surface.on(square(128)), LOAD, &params).expect("a solvable scene");
        assert_eq!((solution.method(), solution.status()), (method, Status::Converged));
        assert_eq!(solution.reason(), &MethodReason::AskedFor(method));
        assert_eq!(rows_of(&solution, false), solution.pressure().values(), "{method}: rows before the field");
        assert_eq!(rows_of(&solution, true), solution.gap().values(), "{method}: rows before the field");
        assert_eq!(solution.elements().is_some(), method != Method::Uniform);
        let counted = solution.pressure().values().iter().filter(|&&p| p > 0.0).count();
        assert!((counted as f64 / 16384.0 - solution.area().cells).abs() < 1e-12, "{method}");
        assert!(solution.certificate().energy <= 1e-2, "{method}");
        // Between the points of collocation of its larger elements, the paper's procedure leaves larger overlaps.
        let claimed = solution.certificate().penetration;
        let allowed = if method == Method::GaussSeidel { 1e-2 } else { 1.001 * claimed };
        let range = surface.sample(square(128)).max() - surface.sample(square(128)).min();
        assert!(solution.gap().min() > -allowed * range, "{method}: a gap of {:e}", solution.gap().min() / range);
        assert_eq!(solution.n_evaluated() + solution.n_proven(), 16384);
        solution
    });
    let [adaptive, uniform, paper] = &solved;
    // Two methods have one operator and one discretisation. The paper's elements are larger inside contacts.
    let off = |a: f64, b: f64| (a / b - 1.0).abs();
    assert!(off(adaptive.area().fraction, uniform.area().fraction) < 1e-4);
    assert!(off(adaptive.stiffness(), uniform.stiffness()) < 2e-3);
    assert!(off(paper.area().fraction, uniform.area().fraction) < 2e-2);
    let (a, b) = (adaptive.displacement(), uniform.displacement());
    let worst = a.values().iter().zip(b.values()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(worst < 1e-3 * b.max(), "displacements differ by {worst:e}");
}

#[test]
fn the_method_is_chosen_by_the_estimated_area() {
    let surface = surface(16);
    let chosen = |pressure: f64, side: usize, params: &SolveParams| {
        let problem = ContactProblem::new(surface.on(square(side)), Control::MeanPressure(pressure));
        problem.plan(params).expect("a valid scene").reason().clone()
    };
    let params = SolveParams::default();
    assert!(matches!(chosen(8.9e-4, 512, &params), MethodReason::SmallContact { percent } if percent < 15.0));
    assert!(matches!(chosen(8.9e-4, 256, &params), MethodReason::LargeContact { percent } if percent < 15.0), "small");
    assert!(matches!(chosen(2e-2, 256, &params), MethodReason::LargeContact { percent } if percent > 35.0));
    assert!(matches!(chosen(8.9e-4, 500, &params), MethodReason::SmallContact { .. }), "no halves of whole tiles");
    assert!(matches!(chosen(8.9e-4, 40, &params), MethodReason::NoLevels { .. }));
    let tight = SolveParams::to_tolerance(1e-12);
    assert!(matches!(chosen(8.9e-4, 256, &tight), MethodReason::ToleranceTooSmall { .. }));
    let border = SolveParams { border_level: 1, ..params };
    assert!(matches!(chosen(2e-2, 256, &border), MethodReason::Only { method: Method::Adaptive, .. }));
    let problem = ContactProblem::new(surface.on(square(256)), LOAD).with_kernel(&Spectral);
    assert_eq!(
        problem.plan(&params).expect("a scene").reason().to_string(),
        "uniform: a kernel without a split by scale has no adaptive form (spectral)"
    );
}

#[test]
fn memory_refuses_or_changes_the_method() {
    let surface = surface(16);
    let plan = |limit: u64, follows: bool, pressure: f64| {
        let params =
            SolveParams { memory_limit: Some(limit), method_follows_memory: follows, ..SolveParams::default() };
        let problem = ContactProblem::new(surface.on(square(512)), Control::MeanPressure(pressure));
        problem.plan(&params).map(|plan| plan.reason().clone())
    };
    // The uniform grid needs 80 bytes an element, 21 MB in all. With 40 % of the tiles the adaptive method needs less.
    assert!(matches!(plan(20_500_000, true, 3.6e-3), Ok(MethodReason::UniformDoesNotFit { .. })));
    assert!(matches!(plan(20_500_000, false, 3.6e-3), Err(SolveError::Memory { method: Method::Uniform, .. })));
    for follows in [true, false] {
        let refused = plan(100_000, follows, 8.9e-4);
        assert!(matches!(refused, Err(SolveError::Adaptive(AdaptiveError::Memory { .. }))), "{refused:?}");
    }
}

#[test]
fn non_convergence_is_an_error_with_the_best_solution_that_outlives_its_heights() {
    for method in [Method::Adaptive, Method::Uniform] {
        let heights = surface(8).sample(square(128));
        let params = SolveParams { max_iterations: 1, ..SolveParams::default().by(method) };
        let error = solve(&heights, LOAD, &params).expect_err("one iteration is too few");
        drop(heights);
        let SolveError::NotConverged { solution, certificate, .. } = error else { panic!("{error}") };
        assert_eq!((solution.status(), solution.method()), (Status::NotConverged, method));
        assert!(certificate.penetration > 1e-6 && solution.gap().rms() > 0.0 && solution.stiffness() > 0.0);
    }
}

#[test]
fn an_owned_solution_says_the_same() {
    let heights = surface(8).sample(square(128));
    for method in [Method::Adaptive, Method::Uniform] {
        let params = SolveParams::default().by(method);
        let borrowed = solve(&heights, LOAD, &params).expect("solvable");
        let owned = solve(&heights, LOAD, &params).expect("solvable").into_owned();
        assert_eq!(borrowed.stiffness().to_bits(), owned.stiffness().to_bits());
        assert_eq!(borrowed.gap(), owned.gap());
        assert_eq!(borrowed.observables(), owned.observables());
    }
}

#[test]
fn what_a_method_cannot_do_is_refused_by_name() {
    let surface = surface(8);
    let problem = ContactProblem::new(surface.on(square(128)), LOAD);
    let refused = |problem: ContactProblem<'_>, params: SolveParams| problem.plan(&params).expect_err("refused");
    let adaptive = SolveParams::default().by(Method::Adaptive);
    let told = refused(problem.clone().with_kernel(&Spectral), adaptive).to_string();
    assert!(
        told.contains("the method adaptive cannot be combined with a kernel") && told.contains("spectral"),
        "{told}"
    );
    let border = SolveParams { border_level: 2, ..SolveParams::default().by(Method::Uniform) };
    assert!(
        matches!(refused(problem, border), SolveError::Unsupported(refusal) if refusal.object == Feature::BorderLevel)
    );
    let error = refused(ContactProblem::new(surface.on(square(128)), Control::MeanPressure(-1.0)), adaptive);
    assert!(matches!(error, SolveError::Problem(_)), "{error}");
}

#[test]
fn the_grid_follows_the_wanted_error_of_the_area() {
    let surface = surface(16);
    let params = SolveParams { tolerance: Tolerance::Auto, ..SolveParams::default() };
    let problem = ContactProblem::new(surface.on(square(1)), LOAD);
    let coarse = problem.clone().solve_to_area_error(0.03, &params, &Silent).expect("solvable");
    let fine = problem.solve_to_area_error(0.005, &params, &Silent).expect("solvable");
    assert!(coarse.area().relative_error() <= 0.03 && fine.area().relative_error() <= 0.005);
    assert!(fine.grid().nx() > coarse.grid().nx());
    assert!((fine.area().fraction / coarse.area().fraction - 1.0).abs() < 0.03);
    let map = surface.sample(square(64));
    let error = ContactProblem::new(&map, LOAD).solve_to_area_error(0.01, &params, &Silent).expect_err("a map");
    assert!(matches!(error, SolveError::Unsupported(refusal) if refusal.object == Feature::HeightMap));
}

#[test]
fn metres_and_pascals_go_in_through_one_conversion() {
    let units = Units::new(
        PeriodicCell::new(1e-2).expect("a cell"),
        Elasticity::from_young_poisson(0.4e9, 0.45).expect("a material"),
    );
    let surface = surface(8);
    let in_metres = Field::from_fn(square(128), |at| 1e-2 * surface.height(at));
    let heights = units.heights(&in_metres).expect("a square cell");
    let solution = solve(&heights, Control::pascals(446_395.0, units), &SolveParams::default()).expect("solvable");
    let other = solve(surface.on(square(128)), LOAD, &SolveParams::default()).expect("solvable");
    let (here, there) = (solution.area().fraction, other.area().fraction);
    assert!((here / there - 1.0).abs() < 1e-5, "{here} and {there}");
    assert!((units.pascals(solution.pressure().mean()) / 446_395.0 - 1.0).abs() < 1e-9);
    let depth = Control::metres(units.metres(solution.info().penetration), units);
    let again = solve(&heights, depth, &SolveParams::default()).expect("solvable");
    assert!((again.info().mean_pressure / solution.info().mean_pressure - 1.0).abs() < 1e-3);
}

#[test]
fn loads_that_share_a_surface_have_the_digits_of_their_own_plans() {
    let surface = Arc::new(surface(8));
    let map = surface.sample(square(384));
    let sources: [HeightSource<'_>; 2] =
        [HeightSource::shared(Arc::<Surface>::clone(&surface), square(384)), (&map).into()];
    // The last load brings most of the cell into contact, so that the method changes.
    let loads = [LOAD, Control::MeanPressure(1e-4), Control::Penetration(1.5e-3), Control::MeanPressure(8e-3)];
    for source in sources {
        let own = |load| ContactProblem::new(source.clone(), load).plan(&SolveParams::default()).expect("a plan");
        let first = own(LOAD);
        let mut methods = Vec::new();
        for load in loads {
            let [shared, own] = [first.under(load).expect("a plan"), own(load)].map(|plan| plan.solve(&Silent));
            let (shared, own) = (shared.expect("solvable"), own.expect("solvable"));
            assert_eq!(shared.method(), own.method(), "{load:?}");
            assert_eq!(shared.pressure().values(), own.pressure().values(), "{load:?}");
            assert_eq!(shared.gap().values(), own.gap().values(), "{load:?}");
            assert_eq!(shared.stiffness().to_bits(), own.stiffness().to_bits(), "{load:?}");
            methods.push(own.method());
        }
        assert!(methods.contains(&Method::Uniform) && methods.contains(&Method::Adaptive), "{methods:?}");
    }
    // The loads are solved side by side in one pool, where a waiting thread takes up another load.
    let first = ContactProblem::new(HeightSource::shared(surface, square(256)), LOAD);
    let first = first.plan(&SolveParams::default()).expect("a plan");
    let area = |load: &Control| first.under(*load).expect("a plan").solve(&Silent).expect("solvable").area().fraction;
    let together: Vec<f64> = loads.par_iter().map(area).collect();
    let one_by_one: Vec<f64> = loads.iter().map(area).collect();
    assert_eq!(together, one_by_one);
    let error = ContactProblem::new(&map, LOAD).plan(&SolveParams::default()).expect("a plan");
    assert!(error.under(Control::MeanPressure(-1.0)).is_err(), "a load is checked");
}

#[test]
fn scattered_contact_is_solved_on_the_uniform_grid() {
    // The short waves have nearly the same amplitudes, so that contacts of a few elements are all over the cell.
    let spectrum = SpectrumParams { hurst: 0.3, ..SpectrumParams::paper(128, 1) };
    let surface = Surface::new(&spectrum).expect("a surface");
    let source = || surface.on(square(1024));
    let solved = |load: f64| {
        let load = Control::MeanPressure(load);
        solve(source(), load, &SolveParams::default()).expect("solvable")
    };
    let slope = surface.moments().rms_slope;
    let (light, scattered) = (solved(0.005 * slope), solved(0.04 * slope));
    assert!(matches!(light.reason(), MethodReason::SmallContact { .. }), "{}", light.reason());
    assert_eq!(light.method(), Method::Adaptive);
    let MethodReason::ScatteredContact { percent } = scattered.reason() else { panic!("{}", scattered.reason()) };
    assert!(*percent > 35.0 && *percent < 90.0 && scattered.area().fraction < 0.25, "{percent} % of the tiles");
    let load = Control::MeanPressure(0.04 * slope);
    let uniform = solve(source(), load, &SolveParams::default().by(Method::Uniform)).expect("solvable");
    assert_eq!(scattered.method(), Method::Uniform);
    assert_eq!(scattered.pressure().values(), uniform.pressure().values());
    let adaptive = solve(source(), load, &SolveParams::default().by(Method::Adaptive)).expect("solvable");
    assert_eq!(adaptive.method(), Method::Adaptive);
}
