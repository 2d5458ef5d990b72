//! Derivatives with respect to the heights against central differences of solves.

use rc_core::{Field, Grid, Kernel, Operator as _, Silent};
use rc_kernel::{FreeLove, Layer, Love, LoveLayer, Relaxation, Spectral, Viscoelastic};
use rc_solver::{
    ContactProblem, Control, GradientError, Held, Method, Quantity, Solution, SolveParams, UniformOperator, solve_dense,
};

use crate::bumps;

const LOAD: f64 = 4e-3;

/// A height change that moves no element into or out of contact: 2e-5 of the range.
///
/// Within a contact the numbers are linear or quadratic in the heights, so central differences have no error but
/// rounding, 1e-16 of a height of 1e-2 relative to the step.
const STEP: f64 = 5e-7;

fn solve<'a>(heights: &'a Field, kernel: &'a dyn Kernel, control: Control) -> Solution<'a> {
    let params = SolveParams::to_tolerance(1e-13).by(Method::Uniform);
    ContactProblem::new(heights, control).with_kernel(kernel).solve(&params, &Silent).expect("a contact")
}

/// A contact from elimination, exact to rounding.
struct Exact {
    pressure: Field,
    penetration: f64,
}

impl Exact {
    /// The contact under this load or penetration. `near` is a penetration of the same elements in contact.
    fn of(heights: &Field, kernel: &dyn Kernel, control: Control, near: f64) -> Self {
        let at = |penetration: f64| {
            let pressure = solve_dense(heights, kernel, penetration).expect("heights").expect("a contact");
            Self { pressure, penetration }
        };
        let Control::MeanPressure(load) = control else { return at(near) };
        // The load is linear in the penetration as long as the contact does not change.
        let beside = [at(near - STEP), at(near + STEP)];
        let [low, high] = [&beside[0], &beside[1]].map(|exact| exact.pressure.mean());
        let exact = at(near + STEP * (2.0 * load - low - high) / (high - low));
        assert!((exact.pressure.mean() / load - 1.0).abs() < 1e-12, "the contact changes");
        exact
    }

    fn value(&self, quantity: Quantity, heights: &Field, kernel: &dyn Kernel) -> f64 {
        let (p, load) = (self.pressure.values(), self.pressure.mean());
        match quantity {
            Quantity::ElasticEnergy => {
                let mut v = vec![0.0; p.len()];
                UniformOperator::new(heights.grid(), kernel).apply(p, &mut v, &mut []);
                0.5 * p.iter().zip(&v).map(|(p, v)| p * v).sum::<f64>() / p.len() as f64
            }
            Quantity::MeanPressure => load,
            Quantity::Penetration => self.penetration,
            _ => {
                let displaced = kernel.uniform_displacement().unwrap_or(0.0) * load;
                heights.max() - heights.mean() + displaced - self.penetration
            }
        }
    }
}

/// Contacts with the height of an element changed by ± [`STEP`], and these heights.
fn changed(
    heights: &Field,
    (kernel, control): (&dyn Kernel, Control),
    element: usize,
    solution: &Solution<'_>,
) -> [(Exact, Field); 2] {
    [STEP, -STEP].map(|step| {
        let mut heights = heights.clone();
        heights.values_mut()[element] += step;
        let exact = Exact::of(&heights, kernel, control, solution.info().penetration);
        assert_eq!(contact(&exact.pressure), contact(solution.pressure()), "the contact changes");
        (exact, heights)
    })
}

fn difference(changed: &[(Exact, Field); 2], number: impl Fn(&Exact, &Field) -> f64) -> f64 {
    let [after, before] = changed.each_ref().map(|(exact, heights)| number(exact, heights));
    (after - before) / (2.0 * STEP)
}

fn contact(pressure: &Field) -> Vec<bool> {
    pressure.values().iter().map(|p| *p > 0.0).collect()
}

/// The element under the maximum pressure, one with the median pressure, one out of contact, and the highest one.
fn elements(solution: &Solution<'_>, heights: &Field) -> [usize; 4] {
    let pressure = solution.pressure().values();
    let mut all: Vec<usize> = (0..pressure.len()).collect();
    let highest = all.iter().copied().max_by(|&i, &j| heights.values()[i].total_cmp(&heights.values()[j]));
    all.sort_by(|&i, &j| pressure[i].total_cmp(&pressure[j]));
    let n_contact = solution.n_in_contact();
    [all[all.len() - 1], all[all.len() - n_contact / 2], all[0], highest.expect("an element")]
}

fn agree(found: f64, difference: f64, size: f64, what: &str) {
    let error = (found - difference).abs() / size;
    assert!(error < 1e-6, "{what}: {found:e} for {difference:e}, {error:.1e} of the largest");
}

fn largest(gradient: &Field) -> f64 {
    gradient.values().iter().map(|value| value.abs()).fold(0.0, f64::max)
}

#[test]
fn gradients_are_central_differences_of_solves() {
    let (square, oblong) = (bumps(32, 32), bumps(36, 24));
    let line = bumps(64, 1);
    let layer = LoveLayer(Layer::on_rigid_base(0.2, 0.3));
    let problems: [(&Field, &dyn Kernel); 4] =
        [(&square, &Love), (&oblong, &Spectral), (&square, &layer), (&line, &Spectral)];
    for (heights, kernel) in problems {
        let depth = Control::Penetration(solve(heights, kernel, Control::MeanPressure(LOAD)).info().penetration);
        for (control, given) in [(Control::MeanPressure(LOAD), Quantity::MeanPressure), (depth, Quantity::Penetration)]
        {
            let solution = solve(heights, kernel, control);
            assert!((0.1..0.9).contains(&(solution.n_in_contact() as f64 / heights.grid().len() as f64)));
            let quantities =
                [Quantity::ElasticEnergy, Quantity::MeanPressure, Quantity::Penetration, Quantity::MeanGap];
            let gradients = quantities
                .map(|quantity| (quantity != given).then(|| solution.gradient(quantity, None).expect("a gradient")));
            for element in elements(&solution, heights) {
                let changed = changed(heights, (kernel, control), element, &solution);
                for (quantity, gradient) in quantities.into_iter().zip(&gradients) {
                    let Some(gradient) = gradient else { continue };
                    let difference = difference(&changed, |exact, heights| exact.value(quantity, heights, kernel));
                    let what = format!("{quantity:?} of {} under {control:?} at {element}", kernel.name());
                    agree(gradient.values()[element], difference, largest(gradient), &what);
                }
            }
        }
    }
}

#[test]
fn gradients_of_functions_of_the_pressure_are_central_differences_of_solves() {
    let heights = bumps(32, 32);
    // A function of the pressure of each element that is different everywhere.
    let weight = |i: usize| 1.0 + (0.37 * i as f64).sin();
    let number =
        |exact: &Exact| exact.pressure.values().iter().enumerate().map(|(i, p)| weight(i) * p * p).sum::<f64>();
    let depth = Control::Penetration(solve(&heights, &Love, Control::MeanPressure(LOAD)).info().penetration);
    for control in [Control::MeanPressure(LOAD), depth] {
        let solution = solve(&heights, &Love, control);
        let pressure = solution.pressure().values();
        let derivatives: Vec<f64> = pressure.iter().enumerate().map(|(i, p)| 2.0 * weight(i) * p).collect();
        let gradient = solution.gradient_of(&derivatives, None).expect("a gradient");
        for element in elements(&solution, &heights) {
            let changed = changed(&heights, (&Love, control), element, &solution);
            let difference = difference(&changed, |exact, _| number(exact));
            agree(gradient.values()[element], difference, largest(&gradient), &format!("{control:?} at {element}"));
        }
    }
}

#[test]
fn in_full_contact_the_load_is_held_fixed_or_a_base_supports_it() {
    let heights = bumps(24, 24);
    let layer = LoveLayer(Layer::on_rigid_base(0.2, 0.3));
    for kernel in [&Love as &dyn Kernel, &layer] {
        let control = Control::MeanPressure(0.5);
        let solution = solve(&heights, kernel, control);
        assert_eq!(solution.n_in_contact(), heights.grid().len());
        let derivatives: Vec<f64> = solution.pressure().values().iter().map(|p| 2.0 * p).collect();
        let energy = solution.gradient(Quantity::ElasticEnergy, None).expect("a gradient");
        let squares = solution.gradient_of(&derivatives, None).expect("a gradient");
        // Full contact is solved without iteration.
        let at = |step: f64| {
            let mut heights = heights.clone();
            heights.values_mut()[100] += step;
            let solution = solve(&heights, kernel, control);
            [solution.info().elastic_energy, solution.pressure().values().iter().map(|p| p * p).sum()]
        };
        let (after, before) = (at(1e-4), at(-1e-4));
        for (i, gradient) in [energy, squares].into_iter().enumerate() {
            let difference = (after[i] - before[i]) / 2e-4;
            agree(gradient.values()[100], difference, largest(&gradient), &format!("{} {i}", kernel.name()));
        }
        let load = solution.gradient(Quantity::MeanPressure, Some(Held::Penetration));
        if kernel.uniform_displacement().is_some() {
            let sum: f64 = load.expect("a gradient").values().iter().sum();
            assert!(sum.abs() < 1e-9 * solution.stiffness(), "a surface that is higher everywhere: {sum:e}");
        } else {
            assert_eq!(load, Err(GradientError::FullContact));
        }
    }
}

#[test]
fn gradients_on_tiles_are_those_on_a_grid() {
    let in_cell = |nx: usize, ny: usize| {
        let grid = Grid::in_cell(nx, ny, ny as f64 / nx as f64).expect("a grid");
        Field::new(grid, bumps(nx, ny).values().to_vec()).expect("a value for each element")
    };
    let (square, oblong, odd) = (in_cell(256, 256), in_cell(256, 128), in_cell(250, 230));
    let layer = LoveLayer(Layer::on_rigid_base(0.2, 0.3));
    let problems: [(&Field, &dyn Kernel); 4] = [(&square, &Love), (&oblong, &Love), (&odd, &Love), (&square, &layer)];
    for (heights, kernel) in problems {
        let solve = |control, method| {
            let params = SolveParams::to_tolerance(1e-9).by(method);
            ContactProblem::new(heights, control).with_kernel(kernel).solve(&params, &Silent).expect("a contact")
        };
        let deep = Control::Penetration(solve(Control::MeanPressure(LOAD), Method::Uniform).info().penetration);
        for (control, given) in [(Control::MeanPressure(LOAD), Quantity::MeanPressure), (deep, Quantity::Penetration)] {
            let both = [Method::Adaptive, Method::Uniform].map(|method| solve(control, method));
            assert_eq!(both[0].method(), Method::Adaptive);
            assert_eq!(contact(both[0].pressure()), contact(both[1].pressure()), "{} {control:?}", kernel.name());
            let squares = both.each_ref().map(|solution| {
                let derivatives: Vec<f64> = solution.pressure().values().iter().map(|p| 2.0 * p).collect();
                solution.gradient_of(&derivatives, None).expect("a gradient")
            });
            let quantities =
                [Quantity::ElasticEnergy, Quantity::MeanPressure, Quantity::Penetration, Quantity::MeanGap];
            let named = quantities.into_iter().filter(|quantity| *quantity != given);
            let pairs = named.map(|name| both.each_ref().map(|it| it.gradient(name, None).expect("a gradient")));
            for [tiles, grid] in pairs.chain([squares]) {
                let apart = tiles.values().iter().zip(grid.values()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                // The pressures differ by their tolerance, and the split by 6e-9 of a displacement.
                let error = apart / largest(&grid);
                assert!(error < 1e-6, "{} {control:?}: {error:.1e}", kernel.name());
            }
        }
    }
}

#[test]
fn what_has_no_gradient_is_refused() {
    let heights = bumps(64, 64);
    let rubber = Relaxation::single(10.0, 0.1).expect("a material");
    let sliding = Viscoelastic::new(Love, &rubber, 0.1 * rc_core::DVec2::X);
    let solved = |kernel: &'static str, problem: ContactProblem<'_>, method| {
        let params = SolveParams::default().by(method);
        let solution = problem.solve(&params, &Silent).unwrap_or_else(|error| panic!("{kernel}: {error}"));
        solution.gradient(Quantity::MeanGap, None).expect_err("no gradient").to_string()
    };
    let problem = || ContactProblem::new(&heights, Control::MeanPressure(1e-3));
    let cases = [
        ("free", problem().with_kernel(&FreeLove), Method::Uniform, "a gradient cannot be combined with free borders"),
        ("hard", problem().with_hardness(0.05), Method::Uniform, "a gradient cannot be combined with a hardness"),
        ("sliding", problem().with_kernel(&sliding), Method::Uniform, "cannot be combined with a sliding surface"),
        ("paper", problem(), Method::GaussSeidel, "gauss-seidel cannot be combined with a gradient"),
    ];
    for (name, problem, method, wanted) in cases {
        let told = solved(name, problem, method);
        assert!(told.contains(wanted) && !told.contains('\n'), "{name}: {told}");
    }
    let solution = solve(&heights, &Love, Control::MeanPressure(LOAD));
    let held = solution.gradient(Quantity::MeanPressure, None);
    assert_eq!(held, Err(GradientError::Held("mean pressure", "penetration")));
    let grid = Grid::square(64).expect("a grid");
    assert_eq!(solution.gradient_of(&[1.0; 3], None), Err(GradientError::Derivatives(grid)));
    assert_eq!(solution.gradient_of(&vec![f64::NAN; grid.len()], None), Err(GradientError::Derivatives(grid)));
}

#[test]
fn gradients_do_not_depend_on_threads() {
    let heights = bumps(64, 64);
    let gradient = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| {
            let solution = solve(&heights, &Love, Control::MeanPressure(LOAD)).into_owned();
            solution.gradient(Quantity::Penetration, None).expect("a gradient")
        })
    };
    assert_eq!(gradient(1), gradient(3));
}
