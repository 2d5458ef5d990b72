//! Contacts of few elements, and heights with a pit.
//!
//! Solves with the default tolerance are compared with solves to a tight tolerance.

use anyhow::Result;
use rc_core::Field;
use rc_figures::Preset;
use rc_solver::Control;

use super::heights::{mapped, rough};
use super::row::{Row, Rows, guarded};
use super::solved::{Method, solve, solve_by_default};

/// Tolerance of the solution that is taken as exact.
///
/// Pits and light loads make a tolerance that is relative to the height range loose.
const TIGHT: f64 = 1e-11;

/// Part of the stated error bar that the default solve may use.
const PART_OF_BAR: f64 = 0.1;

/// Allowed relative error of the response: a load, or a penetration.
///
/// The other of the two is prescribed.
const SAME_RESPONSE: f64 = 1e-3;

pub(crate) fn rows(preset: Preset) -> Result<Vec<Row>> {
    let mut rows = Rows::of("light contacts");
    let full = preset == Preset::Full;
    // Six waves of 21 elements. A contact of one asperity has a few elements.
    let heights = rough(6, 0.8, 41, 128)?;
    let deepest = heights.max() - heights.mean();
    let parts: &[f64] = if full { &[1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1] } else { &[1e-5, 1e-3, 1e-2] };
    let loads: &[f64] = if full { &[1e-8, 1e-7, 1e-6, 1e-5, 1e-4] } else { &[1e-7, 1e-5] };
    let pits: &[f64] = if full { &[10.0, 1e2, 1e3, 1e4, 1e5, 1e6] } else { &[1e2, 1e4] };
    for method in [Method::Uniform, Method::Adaptive] {
        for part in parts {
            let control = Control::Penetration(part * deepest);
            compare(&mut rows, &format!("{} {part:.0e} of full contact", method.name()), (&heights, method, control));
        }
        for &load in loads {
            let scene = format!("{} load {load:.0e} E*", method.name());
            compare(&mut rows, &scene, (&heights, method, Control::MeanPressure(load)));
        }
        for pit in pits {
            let (lowest, depth) = (heights.min(), pit * heights.rms());
            let pitted = mapped(&heights, |h| if h <= lowest { h - depth } else { h });
            let scene = format!("{} a pit of {pit:.0e} rms heights", method.name());
            compare(&mut rows, &scene, (&pitted, method, Control::MeanPressure(1e-3)));
        }
    }
    Ok(rows.finish())
}

/// Compares the default solution with the tight one in area, and in load or penetration.
fn compare(rows: &mut Rows, scene: &str, (heights, method, control): (&Field, Method, Control)) {
    let solved = guarded(|| {
        // The operator of the adaptive method is less exact. Without border levels the method's solution is that of the
        // uniform grid.
        let tight = solve(heights, Method::Uniform, control, TIGHT)?;
        Ok((solve_by_default(heights, method, control)?, tight))
    });
    match solved {
        Err(error) => rows.holds(scene, "solved", "converged", format!("{error:#}"), false),
        Ok((solved, tight)) => {
            let (area, exact) = (solved.observables.area, tight.observables.area);
            rows.at_most(scene, "area", (area.fraction - exact.fraction).abs(), PART_OF_BAR * area.error);
            let (property, ratio) = match control {
                Control::MeanPressure(_) => ("penetration", solved.info.penetration / tight.info.penetration),
                Control::Penetration(_) => ("load", solved.info.mean_pressure / tight.info.mean_pressure),
            };
            rows.at_most(scene, property, (ratio - 1.0).abs(), SAME_RESPONSE);
        }
    }
}
