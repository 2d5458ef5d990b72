//! The estimate of the contact area against exact contacts, beside counting elements.

use rc_core::{Field, Grid, Kernel};
use rc_kernel::{Love, Spectral};
use rc_solver::{ContactArea, Control};
use rc_theory::elliptic::EllipticContact;
use rc_theory::hertz::PeriodicHertz;
use rc_theory::westergaard::Westergaard;

use crate::solved;

/// Heights -(A x² + B y²) about a point near the middle of the cell, turned by `angle`.
fn paraboloid(n: usize, [a, b]: [f64; 2], (x0, y0): (f64, f64), angle: f64) -> Field {
    let (sin, cos) = angle.sin_cos();
    Field::from_fn(Grid::square(n).expect("grid"), |x, y| {
        let (x, y) = (x - 0.5 - x0, y - 0.5 - y0);
        let (along, across) = (cos * x + sin * y, cos * y - sin * x);
        -(a * along * along + b * across * across)
    })
}

/// Relative errors of the estimate and of the count.
fn errors(heights: &Field, kernel: &dyn Kernel, mean_pressure: f64, exact: f64) -> [f64; 2] {
    let solution = solved(heights, kernel, Control::MeanPressure(mean_pressure), 1e-8);
    let area = ContactArea::of(&solution.pressure, &solution.gap, kernel.edge_bias());
    [area.fraction, area.cells].map(|found| found / exact - 1.0)
}

#[test]
fn circles_are_found_ten_times_better_than_by_counting() {
    let theory = PeriodicHertz { radius: 1.0 };
    // 5, 10 and 26 elements per radius, at several places between the elements.
    for (radius, bound) in [(0.02, 2e-2), (0.04, 6e-3), (0.1, 1.2e-3)] {
        let contact = theory.at_contact_radius(radius).expect("small contact");
        let exact = std::f64::consts::PI * radius * radius;
        for kernel in [&Love as &dyn Kernel, &Spectral] {
            let mut sums = [0.0; 2];
            for place in 0..6 {
                let at = |step: f64| (step * f64::from(place)).fract() / 256.0;
                let heights = paraboloid(256, [0.5; 2], (at(0.618), at(0.414)), 0.0);
                let [found, counted] = errors(&heights, kernel, contact.load, exact);
                assert!(found.abs() < bound, "{} of {radius}: {found:e}, counted {counted:e}", kernel.name());
                sums[0] += found.abs();
                sums[1] += counted.abs();
            }
            assert!(sums[0] < 0.2 * sums[1], "{} of {radius}: {sums:?} in all", kernel.name());
        }
    }
}

#[test]
fn ellipses_are_found_at_every_angle() {
    let contact = EllipticContact { major: 0.06, minor: 0.02, peak_pressure: 0.02 };
    for angle in [0.0, 0.3, 0.7, 1.2] {
        let heights = paraboloid(512, contact.curvatures(), (3e-4, 8e-4), angle);
        for kernel in [&Love as &dyn Kernel, &Spectral] {
            let [found, counted] = errors(&heights, kernel, contact.load(), contact.area());
            assert!(
                found.abs() < 4e-3 && found.abs() < 0.25 * counted.abs(),
                "{}: {found:e}, {counted:e}",
                kernel.name()
            );
        }
    }
}

/// Strips, wide and narrow; their edges are all along the elements, so that counting is off by up to two elements in all.
#[test]
fn strips_are_found_between_the_elements() {
    let n = 256;
    let grid = Grid::square(n).expect("grid");
    for (fraction, bound) in [(0.05, 1e-2), (0.2, 3e-3), (0.7, 1e-3), (0.95, 1e-3)] {
        for shift in [0.0, 0.3, 0.5] {
            let wave = Westergaard { amplitude: 0.01 };
            let pressure = wave.full_contact_pressure() * f64::sin(0.5 * std::f64::consts::PI * fraction).powi(2);
            let heights =
                Field::from_fn(grid, |x, _| 0.01 * (std::f64::consts::TAU * (x - 0.5 - shift / n as f64)).cos());
            for kernel in [&Love as &dyn Kernel, &Spectral] {
                let [found, counted] = errors(&heights, kernel, pressure, fraction);
                assert!(found.abs() < bound, "{}, {fraction}: {found:e}, counted {counted:e}", kernel.name());
            }
        }
    }
}
