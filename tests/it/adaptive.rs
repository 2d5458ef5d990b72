//! The adaptive method against the uniform one, against exact solutions, and its own proofs.

use std::f64::consts::PI;

use rc_core::{DVec2, Field, Grid, HeightField, HeightSource, Operator, Silent};
use rc_fractal::{Normalisation, SpectrumParams, Surface};
use rc_kernel::Love;
use rc_solver::{
    AdaptiveError, ContactProblem, Control, Feature, Method, Solution, SolveError, SolveParams, Status,
    UniformOperator, solve,
};
use rc_theory::hertz::PeriodicHertz;

use crate::assert_close;

/// σ0/E* of the paper's Fig. 6.
const MEAN_PRESSURE: f64 = 8.9e-4;

fn surface(waves: usize, hurst: f64, seed: u64) -> Surface {
    let params = SpectrumParams { hurst, ..SpectrumParams::paper(waves, seed) };
    // The same rms slope for every H gives comparable contact areas.
    let params = SpectrumParams { normalisation: Normalisation::RmsSlope(0.026), ..params };
    Surface::new(&params).expect("a valid spectrum")
}

/// Certified parameters of the adaptive method.
fn certified() -> SolveParams {
    SolveParams::default().by(Method::Adaptive)
}

fn adaptive<'a>(source: impl Into<HeightSource<'a>>, control: Control, tolerance: f64) -> Solution<'a> {
    solve(source, control, &SolveParams::to_tolerance(tolerance).by(Method::Adaptive)).expect("a solvable scene")
}

/// The solution on the uniform grid.
fn on_uniform_grid(heights: &Field, control: Control, tolerance: f64) -> Solution<'_> {
    solve(heights, control, &SolveParams::to_tolerance(tolerance).by(Method::Uniform)).expect("a solvable scene")
}

/// Fails unless the solution agrees with the one on the uniform grid.
///
/// Both methods solve the same discrete problem. So area and pressure may differ by the squares of the energy errors of
/// both iterations. Counts may also differ by elements at edges whose pressures are below that error. Stiffnesses are
/// exact to 1e-3.
fn assert_agrees_with_uniform(heights: &Field, solution: &Solution<'_>, control: Control) {
    let uniform = on_uniform_grid(heights, control, 1e-6);
    let (of_uniform, of_adaptive) = (uniform.observables(), solution.observables());
    let [allowed, of_other] = [solution, &uniform].map(|solution| solution.info().iteration_error.powi(2));
    let allowed = allowed + of_other;
    assert!(allowed < 1e-4, "the iterations leave {allowed:e}");
    assert_close("area by counting", of_adaptive.area.cells, of_uniform.area.cells, 2e-4);
    assert_close("area", of_adaptive.area.fraction, of_uniform.area.fraction, allowed);
    assert_close("rms pressure", of_adaptive.rms_pressure, of_uniform.rms_pressure, allowed);
    assert_close("mean pressure", solution.info().mean_pressure, uniform.info().mean_pressure, allowed);
    assert_close("penetration", solution.info().penetration, uniform.info().penetration, allowed);
    assert_close("energy", of_adaptive.elastic_energy, of_uniform.elastic_energy, allowed);
    assert_close("stiffness", solution.stiffness(), uniform.stiffness(), 2e-3);
}

#[test]
fn agrees_with_the_uniform_grid_for_all_hurst_exponents_and_loads() {
    for (hurst, waves, pressure) in [(0.1, 32, 2e-4), (0.5, 24, MEAN_PRESSURE), (0.8, 32, 3e-3), (1.0, 8, 1e-5)] {
        let surface = surface(waves, hurst, 11);
        let heights = surface.sample(Grid::square(512).expect("a grid"));
        let control = Control::MeanPressure(pressure);
        let solution = adaptive(surface.on(Grid::square(512).expect("a grid")), control, 1e-6);
        assert_agrees_with_uniform(&heights, &solution, control);
    }
}

/// Contacts of a few elements have one element on coarser levels, or no element.
#[test]
fn the_smallest_loads_are_not_lost() {
    let surface = surface(32, 0.8, 7);
    let heights = surface.sample(Grid::square(512).expect("a grid"));
    for pressure in [1e-6, 1e-8, 1e-10] {
        let control = Control::MeanPressure(pressure);
        let solution = adaptive(surface.on(Grid::square(512).expect("a grid")), control, 1e-6);
        let uniform = on_uniform_grid(&heights, control, 1e-6);
        assert_close("mean pressure", solution.info().mean_pressure, pressure, 1e-10);
        let range = heights.max() - heights.min();
        let difference = (solution.info().penetration - uniform.info().penetration).abs();
        assert!(difference < 3e-6 * range, "{pressure:e}: penetrations differ by {difference:e}");
        assert!(10 * solution.n_evaluated() < 512 * 512, "{pressure:e}: {} cells evaluated", solution.n_evaluated());
    }
}

#[test]
fn penetration_control_agrees_and_returns_the_penetration() {
    let surface = surface(32, 0.8, 4);
    let heights = surface.sample(Grid::square(512).expect("a grid"));
    let control = Control::Penetration(0.5 * heights.max());
    let solution = adaptive(surface.on(Grid::square(512).expect("a grid")), control, 1e-6);
    assert_close("penetration", solution.info().penetration, 0.5 * heights.max(), 1e-9);
    assert_agrees_with_uniform(&heights, &solution, control);
}

#[test]
fn a_map_of_heights_goes_the_same_way() {
    let surface = surface(24, 0.8, 9);
    let heights = surface.sample(Grid::square(512).expect("a grid"));
    let control = Control::MeanPressure(MEAN_PRESSURE);
    let of_map = adaptive(&heights, control, 1e-6);
    assert_agrees_with_uniform(&heights, &of_map, control);
}

/// The uniform operator confirms the certificate of the adaptive method on every cell.
///
/// Cells that were proven to be out of contact are out of contact.
#[test]
fn nothing_penetrates_where_nothing_was_evaluated() {
    for (seed, pressure) in [(1, 1e-4), (2, MEAN_PRESSURE), (3, 4e-3)] {
        let surface = surface(48, 0.7, seed);
        let grid = Grid::square(1024).expect("a grid");
        let solution = adaptive(surface.on(Grid::square(1024).expect("a grid")), Control::MeanPressure(pressure), 1e-6);
        assert_eq!(solution.n_evaluated() + solution.n_proven(), grid.len());
        if pressure < 1e-3 {
            assert!(
                2 * solution.n_proven() > grid.len(),
                "only {} of {} cells are proven",
                solution.n_proven(),
                grid.len()
            );
        }
        let (p, heights) = (solution.pressure(), surface.sample(grid));
        let mut v = vec![0.0; grid.len()];
        UniformOperator::new(grid, &Love).apply(p.values(), &mut v, &mut []);
        let offset = heights.max() - solution.info().penetration;
        let range = heights.max() - heights.min();
        let least = v.iter().zip(heights.values()).map(|(v, h)| v - h + offset).fold(f64::INFINITY, f64::min);
        // The bound allows for the tolerance and for the error of the multilevel operator.
        assert!(least > -1.2e-6 * range, "seed {seed}: a gap of {:e} of the height range", least / range);
        let from_rows = solution.displacement();
        let worst = v.iter().zip(from_rows.values()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(worst < 2e-6 * range, "displacement rows are off by {:e} of the height range", worst / range);
    }
}

#[test]
fn gap_rows_are_displacement_less_height() {
    let surface = surface(16, 0.8, 4);
    let grid = Grid::square(512).expect("a grid");
    let solution = adaptive(surface.on(grid), Control::MeanPressure(MEAN_PRESSURE), 1e-6);
    let mut gap = Vec::new();
    let rows = solution.gap_rows(|first, rows| {
        assert_eq!(first * 512, gap.len(), "rows come in order");
        gap.extend_from_slice(rows);
        Ok::<(), ()>(())
    });
    rows.expect("no row fails");
    let displacement = solution.displacement();
    assert_eq!(gap.len(), grid.len());
    let heights = surface.sample(grid);
    let offset = heights.max() - solution.info().penetration;
    let expected = displacement.values().iter().zip(heights.values()).map(|(v, h)| (v - h + offset).max(0.0));
    let worst = expected.zip(&gap).map(|(expected, gap)| (expected - gap).abs()).fold(0.0, f64::max);
    // Gaps are at least 0, and heights on tiles are interpolated to 1e-9 of their rms.
    assert!(worst < 2e-9 * heights.rms(), "off by {worst:e}, rms height {:e}", heights.rms());
}

#[test]
fn tight_tolerances_are_reached() {
    let surface = surface(16, 0.8, 5);
    let control = Control::MeanPressure(MEAN_PRESSURE);
    let solution = adaptive(surface.on(Grid::square(256).expect("a grid")), control, 1e-9);
    assert!(solution.info().certificate.penetration <= 1e-9, "{}", solution.info().certificate);
    let heights = surface.sample(Grid::square(256).expect("a grid"));
    let uniform = on_uniform_grid(&heights, control, 1e-9);
    assert_close("rms pressure", solution.observables().rms_pressure, uniform.pressure().rms(), 1e-6);
}

#[test]
fn a_sphere_is_hertzs() {
    // The contact radius is a tenth of the cell. A paraboloid does not have a band limit, so it is solved as a map.
    let exact = PeriodicHertz { radius: 1.0 }.at_contact_radius(0.1).expect("a small contact");
    let n = 1024;
    let grid = Grid::square(n).expect("a grid");
    let centre = grid.centre(n / 2, n / 2).x;
    let heights = Field::from_fn(grid, |DVec2 { x, y }| -0.5 * ((x - centre).powi(2) + (y - centre).powi(2)));
    let solution = adaptive(&heights, Control::MeanPressure(exact.load), 1e-7);
    let observables = solution.observables();
    assert_close("area", observables.area.fraction, PI * 0.01, 5e-3);
    assert_close("penetration", solution.info().penetration, exact.penetration, 5e-4);
    assert_close("peak pressure", observables.max_pressure, exact.peak_pressure, 5e-4);
    assert!(4 * solution.n_evaluated() < n * n, "{} cells evaluated", solution.n_evaluated());
}

#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    let surface = surface(32, 0.8, 6);
    let solve = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| {
            let grid = Grid::square(512).expect("a grid");
            adaptive(surface.on(grid), Control::MeanPressure(MEAN_PRESSURE), 1e-6).pressure().clone()
        })
    };
    let (one, three) = (solve(1), solve(3));
    assert!(one.values().iter().zip(three.values()).all(|(a, b)| a.to_bits() == b.to_bits()));
}

#[test]
fn elements_carry_the_load() {
    let surface = surface(16, 0.8, 2);
    let solution = adaptive(surface.on(Grid::square(512).expect("a grid")), Control::MeanPressure(MEAN_PRESSURE), 1e-6);
    let load: f64 = solution.elements().expect("a mesh").map(|e| e.pressure * e.side * e.side).sum();
    assert_close("load", load, MEAN_PRESSURE, 1e-10);
    assert_eq!(solution.elements().expect("a mesh").count(), solution.n_elements());
}

#[test]
fn estimates_are_right_within_a_factor_of_two() {
    let surface = surface(32, 0.8, 3);
    for pressure in [3e-4, MEAN_PRESSURE, 4e-3] {
        let control = Control::MeanPressure(pressure);
        let problem = ContactProblem::new(surface.on(Grid::square(1024).expect("a grid")), control);
        let plan = problem.plan(&certified()).expect("a valid scene");
        let cost = plan.cost();
        let area_fraction = cost.area_fraction.expect("the adaptive method estimates it");
        let tile_fraction = cost.elements.expect("the adaptive method estimates them") / (1024.0 * 1024.0);
        let solution = plan.solve(&Silent).expect("a solvable scene");
        let area = solution.observables().area.cells;
        assert!(area_fraction / area < 2.0 && area / area_fraction < 2.0, "{area_fraction} for {area}");
        let evaluated = solution.n_evaluated() as f64 / (1024.0 * 1024.0);
        assert!(tile_fraction / evaluated < 2.0 && evaluated / tile_fraction < 2.0, "{tile_fraction} for {evaluated}");
    }
}

#[test]
fn what_cannot_be_done_is_said_before_any_work() {
    let surface = surface(32, 0.8, 3);
    let control = Control::MeanPressure(MEAN_PRESSURE);
    let refused = |source: HeightSource<'_>, params: SolveParams| match solve(source, control, &params) {
        Err(SolveError::Adaptive(error)) => error,
        other => panic!("not refused: {other:?}"),
    };
    let error = |side: usize, params| refused(surface.on(Grid::square(side).expect("a grid")), params);
    let params = certified();
    assert!(matches!(error(66, params), AdaptiveError::Grid { .. }), "no coarser grid has 32 waves");
    let border = SolveParams { border_level: 1, ..params };
    let uneven =
        solve(surface.on(Grid::square(501).expect("a grid")), control, &border).expect_err("no whole tiles of halves");
    assert!(matches!(uneven, SolveError::Unsupported(refusal) if refusal.object == Feature::UnevenGrid));
    let small = SolveParams { base_side: Some(64), ..params };
    assert!(matches!(error(1024, small), AdaptiveError::Base { waves: 32, .. }), "64 elements for 32 waves");
    let little = SolveParams { memory_limit: Some(1_000_000), ..params };
    assert!(matches!(error(1024, little), AdaptiveError::Memory { limit: 1, .. }));
    let exact = SolveParams { operator_error: 1e-14, ..params };
    assert!(matches!(error(1024, exact), AdaptiveError::OperatorError { .. }));
    let flat = Field::zeros(Grid::square(512).expect("a grid"));
    let error = solve(&flat, control, &params).expect_err("nothing to adapt to");
    assert!(matches!(&error, SolveError::Unsupported(refusal) if refusal.object == Feature::Flat), "{error}");
}

#[test]
fn a_pressure_that_is_not_positive_is_refused() {
    let surface = surface(16, 0.8, 1);
    for control in [Control::MeanPressure(-1.0), Control::MeanPressure(f64::NAN), Control::Penetration(1.0)] {
        let source = surface.on(Grid::square(256).expect("a grid"));
        let error = solve(source, control, &certified()).expect_err("an error");
        assert!(matches!(error, SolveError::Problem(_)), "{control:?}: {error}");
    }
}

/// With border levels the area converges as on uniform grids of the smallest element.
///
/// Border levels halve the elements at edges and keep those inside, so there are far fewer elements.
#[test]
fn border_levels_refine_edges_only() {
    let surface = surface(8, 0.8, 1);
    let control = Control::MeanPressure(MEAN_PRESSURE);
    let with_border = |side: usize, border_level: usize| {
        let params = SolveParams { border_level, ..certified() };
        solve(surface.on(Grid::square(side).expect("a grid")), control, &params).expect("a solvable scene")
    };
    let mut counts = Vec::new();
    for border_level in 1..=4 {
        let (edges, everywhere) = (with_border(256, border_level), with_border(256 << border_level, 0));
        let (of_edges, of_all) = (edges.observables(), everywhere.observables());
        assert_close("area by counting", of_edges.area.cells, of_all.area.cells, 2e-3);
        assert_close("area", of_edges.area.fraction, of_all.area.fraction, 2e-3);
        assert_close("rms pressure", of_edges.rms_pressure, of_all.rms_pressure, 2e-3);
        assert_close("penetration", edges.info().penetration, everywhere.info().penetration, 5e-4);
        assert_close("stiffness", edges.stiffness(), everywhere.stiffness(), 1e-2);
        assert_eq!(edges.grid().nx(), 256);
        assert_close("mean pressure on the grid", edges.pressure().mean(), MEAN_PRESSURE, 1e-12);
        let load: f64 =
            edges.elements().expect("a mesh").map(|element| element.pressure * element.side * element.side).sum();
        assert_close("mean pressure of the elements", load, MEAN_PRESSURE, 1e-12);
        // What is proven to be out of contact and what is in contact are different parts of the cell.
        let smallest = ((256_usize << border_level) as f64).powi(2);
        let proven = edges.n_proven() as f64 / smallest;
        assert!(proven > 0.5 && proven < 1.0 - of_edges.area.cells, "{proven} of the cell is proven");
        counts.push((edges.n_elements() as f64, of_edges.area.cells));
        if border_level == 4 {
            let with_side =
                |n: f64| edges.elements().expect("a mesh").filter(|e| e.side.to_bits() == n.recip().to_bits()).count();
            assert!(with_side(4096.0) > with_side(2048.0) && with_side(1024.0) > 0, "elements are coarser inside");
            assert!(4 * edges.n_elements() < everywhere.n_elements(), "{}", edges.n_elements());
        }
    }
    // The ratio of the numbers of elements tends to two with each halving, not to four. Each halving also halves the
    // error.
    let growth: Vec<f64> = counts.windows(2).map(|pair| pair[1].0 / pair[0].0).collect();
    assert!(growth.iter().all(|&growth| growth < 2.8) && growth[2] < 2.5, "{growth:?}");
    let steps: Vec<f64> = counts.windows(2).map(|pair| pair[0].1 - pair[1].1).collect();
    for pair in steps.windows(2) {
        assert!((1.6..2.4).contains(&(pair[0] / pair[1])), "steps of the area: {steps:?}");
    }
}

/// The certificate with border levels holds on the whole grid of the smallest elements.
#[test]
fn nothing_penetrates_between_coarse_elements() {
    let surface = surface(24, 0.7, 5);
    let control = Control::MeanPressure(MEAN_PRESSURE);
    let params = SolveParams { border_level: 2, ..certified() };
    let solution = solve(surface.on(Grid::square(256).expect("a grid")), control, &params).expect("solvable");
    // This grid gets the pressure of every element.
    let grid = Grid::square(1024).expect("a grid");
    let mut pressure = vec![0.0; grid.len()];
    for element in solution.elements().expect("a mesh") {
        let n = (element.side * 1024.0).round() as usize;
        let corner = |centre: f64| ((centre - 0.5 * element.side) * 1024.0).round() as usize;
        for row in 0..n {
            let start = (corner(element.centre.y) + row) * 1024 + corner(element.centre.x);
            pressure[start..start + n].fill(element.pressure);
        }
    }
    let operator = UniformOperator::new(grid, &Love);
    let mut displacement = vec![0.0; grid.len()];
    operator.apply(&pressure, &mut displacement, &mut vec![0.0; operator.scratch_len()]);
    let heights = surface.sample(grid);
    let offset = heights.max() - solution.info().penetration;
    let range = heights.max() - heights.min();
    let free = displacement.iter().zip(heights.values()).zip(&pressure).filter(|&(_, &p)| p == 0.0);
    let least = free.map(|((v, h), _)| v - h + offset).fold(f64::INFINITY, f64::min);
    assert!(least > -2e-6 * range, "a point outside contact penetrates by {:e}", -least / range);
    // The adaptive operator gives the same gap. Its error is a part of the tolerance.
    let gap = solution.finest_gap().expect("elements smaller than those of the grid");
    assert_eq!(gap.grid(), grid);
    let expected = displacement.iter().zip(heights.values()).map(|(v, h)| v - h + offset);
    let worst = gap.values().iter().zip(expected).fold(0.0_f64, |worst, (g, e)| worst.max((g - e).abs()));
    assert!(worst < 1e-5 * range, "the gap on the finest grid is off by {:e}", worst / range);
}

/// Far beyond full contact, the rounding of the mean pressure does not hide the heights.
///
/// In single precision it would.
#[test]
fn loads_far_beyond_full_contact_are_solved() {
    let surface = surface(8, 0.8, 1);
    let heights = surface.sample(Grid::square(256).expect("a grid"));
    for pressure in [1.0, 2.0, 1e3, 1e6] {
        let control = Control::MeanPressure(pressure);
        let solution = adaptive(surface.on(Grid::square(256).expect("a grid")), control, 1e-6);
        assert_eq!(solution.status(), Status::FullContact, "{pressure:e}");
        let exact = on_uniform_grid(&heights, control, 1e-6);
        let exact = exact.pressure();
        let scale = (exact.max() - exact.min()).max(1e-15 * pressure);
        let differences = solution.pressure().values().iter().zip(exact.values()).map(|(a, b)| (a - b).abs());
        let worst = differences.fold(0.0, f64::max);
        // The tolerance is on heights. For the same height, the shortest waves need the largest pressures.
        assert!(worst <= 1e-3 * scale, "{pressure:e}: off by {worst:e} of {scale:e}");
    }
}

/// A contact with a sharp edge is found again after coarser levels have lost it.
///
/// Coarser levels have the edge as a line of single elements, which the interpolation to the next level loses.
#[test]
fn a_contact_that_coarser_levels_lose_is_found_again() {
    let grid = Grid::square(128).expect("a grid");
    let step = Field::from_fn(grid, |at| if at.x < 0.5 { 0.0 } else { 1e-2 });
    let (heights, pressure) = (step, 1e-4);
    let control = Control::MeanPressure(pressure);
    let solution = adaptive(&heights, control, 1e-6);
    assert_close("mean pressure", solution.info().mean_pressure, pressure, 1e-10);
    // Located edges are not compared. At a sharp edge the pressure does not end as a square root, so only the count has
    // a meaning.
    let uniform = on_uniform_grid(&heights, control, 1e-6);
    let (of_uniform, of_adaptive) = (uniform.observables(), solution.observables());
    assert_close("area by counting", of_adaptive.area.cells, of_uniform.area.cells, 2e-3);
    assert_close("rms pressure", of_adaptive.rms_pressure, of_uniform.rms_pressure, 2e-3);
    assert_close("penetration", solution.info().penetration, uniform.info().penetration, 5e-4);
}
