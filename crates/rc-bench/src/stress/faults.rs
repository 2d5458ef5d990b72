//! Faulty operators and kernels.
//!
//! The solver itself must refuse them, fail to converge, or certify a large error. A fault that the solver cannot see
//! must be found by an audit, and the row says so.

use std::sync::atomic::{AtomicUsize, Ordering};

use anyhow::{Result, ensure};
use rc_core::testing::{check_kernel, check_operator, quasi_random};
use rc_core::{Field, Grid, Kernel, Operator, Silent, Symbol};
use rc_figures::Preset;
use rc_kernel::Love;
use rc_solver::{ContactProblem, Control, Method, Solution, SolveParams, UniformOperator, solve_with_operator};

use super::audit::{Audit, direct};
use super::heights::{mapped, rough};
use super::row::{Row, Rows, guarded};
use super::scene::TOLERANCE;

/// Faults in an application of L.
#[derive(Clone, Copy, Debug)]
enum Fault {
    Noise(f64),
    Bias(f64),
    Nan,
    NonSymmetry(f64),
    ShiftedIndex,
    Sign,
    Stale,
}

/// The tolerance that is certified by default.
const CERTIFIED: f64 = 1e-6;

/// An operator with a fault.
struct Faulty {
    operator: UniformOperator,
    side: usize,
    fault: Fault,
    /// Number of applications before the fault begins.
    sound: usize,
    applications: AtomicUsize,
}

impl Faulty {
    fn new(grid: Grid, fault: Fault, sound: usize) -> Self {
        Self {
            operator: UniformOperator::new(grid, &Love),
            side: grid.nx(),
            fault,
            sound,
            applications: AtomicUsize::new(0),
        }
    }
}

impl Operator for Faulty {
    fn n_elements(&self) -> usize {
        self.operator.n_elements()
    }

    fn scratch_len(&self) -> usize {
        self.operator.scratch_len()
    }

    fn apply(&self, pressure: &[f64], displacement: &mut [f64], scratch: &mut [f64]) {
        let before = displacement[0];
        self.operator.apply(pressure, displacement, scratch);
        let count = self.applications.fetch_add(1, Ordering::Relaxed);
        if count < self.sound {
            return;
        }
        let scale = displacement.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
        match self.fault {
            Fault::Noise(size) => {
                let noise = |i: usize| size * scale * (quasi_random(i + 7919 * count) - 0.5);
                displacement.iter_mut().enumerate().for_each(|(i, v)| *v += noise(i));
            }
            Fault::Bias(size) => displacement.iter_mut().for_each(|v| *v += size),
            Fault::Nan => displacement[self.side + 1] = f64::NAN,
            // Displacements on one side of the cell are larger than on the other.
            Fault::NonSymmetry(size) => {
                let side = self.side;
                displacement
                    .iter_mut()
                    .enumerate()
                    .for_each(|(i, v)| *v *= 1.0 + size * ((i % side) as f64 / side as f64));
            }
            Fault::ShiftedIndex => displacement.rotate_right(1),
            Fault::Sign => displacement.iter_mut().for_each(|v| *v = -*v),
            Fault::Stale => displacement[0] = before,
        }
    }
}

/// A kernel with a fault in its symbol.
struct FaultyKernel {
    fault: KernelFault,
    calls: AtomicUsize,
}

#[derive(Clone, Copy, Debug)]
enum KernelFault {
    NanEverywhere,
    NanAtOneWave,
    InfiniteAtOneWave,
    ZeroAtOneWave,
    NegativeAtOneWave,
    NegativeEverywhere,
    Bias(f64),
    Noise(f64),
    NonSymmetry(f64),
    Changes(f64),
    Moves,
}

impl Kernel for FaultyKernel {
    fn name(&self) -> &'static str {
        "faulty"
    }

    fn symbol(&self, grid: Grid) -> Symbol<'_> {
        let (love, fault) = (Love.symbol(grid), self.fault);
        let call = self.calls.fetch_add(1, Ordering::Relaxed);
        Box::new(move |kx, ky| {
            let value = love(kx, ky);
            let one = (kx, ky) == (1, 2);
            match fault {
                KernelFault::NanEverywhere => f64::NAN,
                KernelFault::NanAtOneWave if one => f64::NAN,
                KernelFault::InfiniteAtOneWave if one => f64::INFINITY,
                KernelFault::ZeroAtOneWave if one => 0.0,
                KernelFault::NegativeAtOneWave if one => -value,
                KernelFault::NegativeEverywhere => -value,
                KernelFault::Bias(part) => value * (1.0 + part),
                KernelFault::Noise(part) => value * (1.0 + part * (quasi_random(131 * kx + ky) - 0.5)),
                KernelFault::NonSymmetry(part) if kx > ky => value * (1.0 + part),
                KernelFault::Moves if (kx, ky) == (0, 0) => 0.1,
                // The answer differs from call to call.
                KernelFault::Changes(part) => value * (1.0 + part * call as f64),
                _ => value,
            }
        })
    }
}

pub(crate) fn rows(_preset: Preset) -> Result<Vec<Row>> {
    let mut rows = Rows::of("faults");
    conformance_of_operators(&mut rows)?;
    operators(&mut rows)?;
    kernels(&mut rows)?;
    inputs(&mut rows)?;
    Ok(rows.finish())
}

/// Faults of operators, with whether they are larger than the tolerance of a solve.
const OPERATOR_FAULTS: [(Fault, bool); 10] = [
    (Fault::Noise(1e-9), false),
    (Fault::Noise(1e-3), true),
    (Fault::Bias(1e-9), false),
    (Fault::Bias(1e-3), true),
    (Fault::Nan, true),
    (Fault::NonSymmetry(1e-7), false),
    (Fault::NonSymmetry(0.1), true),
    (Fault::ShiftedIndex, true),
    (Fault::Sign, true),
    (Fault::Stale, true),
];

/// The conformance check of operators finds each fault, and accepts an operator without one.
///
/// Forks run this check on their operators.
fn conformance_of_operators(rows: &mut Rows) -> Result<()> {
    let grid = Grid::square(16)?;
    let check = |operator: &dyn Operator| {
        guarded(|| {
            check_operator(operator);
            Ok(())
        })
    };
    let sound = check(&UniformOperator::new(grid, &Love));
    rows.holds("sound operator", "conformance", "nothing found", text(&sound), sound.is_ok());
    for (fault, _) in OPERATOR_FAULTS {
        let found = check(&Faulty::new(grid, fault, 0));
        rows.holds(&format!("operator with {fault:?}"), "conformance", "detected", text(&found), found.is_err());
    }
    Ok(())
}

/// A solve with a faulty operator ends with an error of the solver.
///
/// If the fault is below the tolerance, it passes too when an audit with the sound operator finds the tolerance met.
fn operators(rows: &mut Rows) -> Result<()> {
    let heights = rough(4, 0.8, 8, 32)?;
    let control = Control::MeanPressure(1e-3);
    let solve = |operator: &Faulty| {
        guarded(|| {
            let params = SolveParams::to_tolerance(CERTIFIED);
            let solution = solve_with_operator(&heights, operator, control, &params, &Silent)?;
            let pressure = solution.pressure();
            Ok(Audit::of_pressure(&heights, pressure, &direct(pressure), control))
        })
    };
    for (fault, is_large) in OPERATOR_FAULTS {
        let scene = format!("operator with {fault:?}");
        let solved = solve(&Faulty::new(heights.grid(), fault, 0));
        if is_large {
            error_of_solver(rows, &scene, &solved.map(|_| ()));
        } else {
            match solved {
                Ok(audit) => rows.at_most(&scene, "penetration of its solution", audit.penetration, 1.1 * CERTIFIED),
                Err(error) => error_of_solver(rows, &scene, &Err(error)),
            }
        }
    }
    // These faults begin after the check at the start of a solve.
    for fault in [Fault::Nan, Fault::Noise(1e-3), Fault::Sign] {
        let solved = solve(&Faulty::new(heights.grid(), fault, 10));
        error_of_solver(rows, &format!("operator with {fault:?} from its 11th application on"), &solved.map(|_| ()));
    }
    Ok(())
}

/// Adds a row that passes if the solver has returned an error.
///
/// A panic does not pass.
fn error_of_solver(rows: &mut Rows, scene: &str, solved: &Result<()>) {
    let is_error = matches!(solved, Err(error) if !error.to_string().starts_with("panic"));
    rows.holds(scene, "detected by the solver", "an error", text(solved), is_error);
}

/// A solve with a faulty kernel ends with an error of the solver.
///
/// A sound symbol of another solid is not an error. Only an audit with the right kernel finds it.
fn kernels(rows: &mut Rows) -> Result<()> {
    let heights = rough(4, 0.8, 8, 32)?;
    let loads = [Control::MeanPressure(1e-3), Control::Penetration(0.3 * (heights.max() - heights.mean()))];
    let sound = outcome(&heights, &Love, loads[0]);
    rows.holds("sound kernel", "solve and audit", "nothing found", text(&sound), sound.is_ok());
    let faults = [
        KernelFault::NanEverywhere,
        KernelFault::NanAtOneWave,
        KernelFault::InfiniteAtOneWave,
        KernelFault::ZeroAtOneWave,
        KernelFault::NegativeAtOneWave,
        KernelFault::NegativeEverywhere,
        KernelFault::Noise(1e-2),
        KernelFault::NonSymmetry(1e-2),
        KernelFault::Changes(1e-4),
        KernelFault::Moves,
    ];
    let faulty = |fault| FaultyKernel { fault, calls: AtomicUsize::new(0) };
    for fault in faults {
        for control in loads {
            let to = if matches!(control, Control::MeanPressure(_)) { "to a load" } else { "to a penetration" };
            let solved = guarded(|| solve(&heights, &faulty(fault), control, CERTIFIED).map(|_| ()));
            error_of_solver(rows, &format!("kernel with {fault:?} {to}"), &solved);
        }
    }
    for fault in [KernelFault::NonSymmetry(1e-2), KernelFault::Moves] {
        let found = conformance(&faulty(fault));
        rows.holds(&format!("kernel with {fault:?}"), "conformance", "detected", text(&found), found.is_err());
    }
    let softer = KernelFault::Bias(1e-3);
    let (scene, solved) = (format!("kernel with {softer:?}"), outcome(&heights, &faulty(softer), loads[0]));
    let only_by_audit = matches!(&solved, Err(error) if error.to_string().starts_with("audit"));
    rows.holds(&scene, "another solid is seen only by an audit", "audit", text(&solved), only_by_audit);
    Ok(())
}

/// The result of the conformance check of kernels.
fn conformance(kernel: &dyn Kernel) -> Result<()> {
    guarded(|| {
        check_kernel(kernel);
        Ok(())
    })
}

/// The solution on the uniform grid.
fn solve<'a>(heights: &'a Field, kernel: &'a dyn Kernel, control: Control, tolerance: f64) -> Result<Solution<'a>> {
    let params = SolveParams::to_tolerance(tolerance).by(Method::Uniform);
    Ok(ContactProblem::new(heights, control).with_kernel(kernel).solve(&params, &Silent)?)
}

/// Solves with `kernel` and audits with Love's kernel.
fn outcome(heights: &Field, kernel: &dyn Kernel, control: Control) -> Result<()> {
    guarded(|| {
        let solution = solve(heights, kernel, control, TOLERANCE)?;
        let pressure = solution.pressure();
        let audit = Audit::of_pressure(heights, pressure, &direct(pressure), control);
        ensure!(audit.n_bad == 0, "audit: {} pressures that are not finite or negative", audit.n_bad);
        ensure!(audit.penetration <= 1.1 * TOLERANCE, "audit: penetration error {:.1e}", audit.penetration);
        Ok(())
    })
}

/// Invalid heights, loads and tolerances are refused.
fn inputs(rows: &mut Rows) -> Result<()> {
    let heights = rough(4, 0.8, 8, 32)?;
    let with = |value: f64| {
        let mut heights = heights.clone();
        heights.values_mut()[100] = value;
        heights
    };
    let flat = mapped(&heights, |_| 0.5);
    let load = Control::MeanPressure(1e-3);
    let cases: Vec<(String, Field, Control, f64)> = vec![
        ("a height of NaN".into(), with(f64::NAN), load, TOLERANCE),
        ("an infinite height".into(), with(f64::INFINITY), load, TOLERANCE),
        ("a height of minus infinity".into(), with(f64::NEG_INFINITY), load, TOLERANCE),
        ("a load of zero".into(), heights.clone(), Control::MeanPressure(0.0), TOLERANCE),
        ("a negative load".into(), heights.clone(), Control::MeanPressure(-1e-3), TOLERANCE),
        ("a load of NaN".into(), heights.clone(), Control::MeanPressure(f64::NAN), TOLERANCE),
        ("an infinite load".into(), heights.clone(), Control::MeanPressure(f64::INFINITY), TOLERANCE),
        ("a penetration of zero".into(), heights.clone(), Control::Penetration(0.0), TOLERANCE),
        ("a penetration beyond full contact".into(), heights.clone(), Control::Penetration(heights.max()), TOLERANCE),
        ("a penetration of NaN".into(), heights.clone(), Control::Penetration(f64::NAN), TOLERANCE),
        ("a penetration into a flat surface".into(), flat, Control::Penetration(1e-3), TOLERANCE),
        ("a tolerance of zero".into(), heights.clone(), load, 0.0),
        ("a tolerance of NaN".into(), heights.clone(), load, f64::NAN),
        ("a tolerance below rounding".into(), heights.clone(), load, 1e-15),
        (
            "heights whose range overflows".into(),
            mapped(&heights, |h| if h > 0.0 { 1.7e308 } else { -1.7e308 }),
            load,
            TOLERANCE,
        ),
    ];
    for (name, heights, control, tolerance) in cases {
        let solved = guarded(|| solve(&heights, &Love, control, tolerance));
        let reported = matches!(&solved, Err(error) if !error.to_string().starts_with("panic"));
        let said = solved.map_or_else(|error| format!("{error:#}"), |_| "converged".to_owned());
        rows.holds(&name, "refused", "an error", said, reported);
    }
    Ok(())
}

fn text(found: &Result<()>) -> String {
    found.as_ref().map_or_else(|error| format!("{error:#}"), |()| "nothing found".to_owned())
}
