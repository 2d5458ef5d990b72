//! A sphere in the periodic cell, against the periodic correction of Hertz.

use rc_core::{DVec2, Field, Grid, Kernel};
use rc_kernel::{Love, Spectral};
use rc_solver::{ContactArea, Control};
use rc_theory::hertz::PeriodicHertz;

use crate::{assert_close, solved};

/// A paraboloid with its apex at the centre of an element.
fn sphere(n: usize, radius: f64) -> Field {
    let grid = Grid::square(n).expect("grid");
    let centre = grid.centre(n / 2, n / 2).x;
    Field::from_fn(grid, |DVec2 { x, y }| {
        let nearest = |u: f64| (u - centre + 0.5).rem_euclid(1.0) - 0.5;
        -(nearest(x).powi(2) + nearest(y).powi(2)) / (2.0 * radius)
    })
}

#[test]
fn sphere_in_the_periodic_cell_matches_corrected_hertz() {
    // This is the paper's sphere in a cell of 1 cm, R = λ, with a = 0.1 λ. It has 51 elements per radius.
    let theory = PeriodicHertz { radius: 1.0 };
    let expected = theory.at_contact_radius(0.1).expect("small contact");
    let heights = sphere(512, 1.0);
    for kernel in [&Love as &dyn Kernel, &Spectral] {
        let by_load = solved(&heights, kernel, Control::MeanPressure(expected.load), 1e-9);
        assert_close("penetration", by_load.info().penetration, expected.penetration, 5e-4);
        assert_close("peak pressure", by_load.pressure().max(), expected.peak_pressure, 5e-4);
        let area = ContactArea::of(by_load.pressure(), by_load.gap(), kernel.edge_bias(heights.grid()));
        let radius = (area.fraction / std::f64::consts::PI).sqrt();
        assert_close("radius", radius, expected.contact_radius, 5e-3);

        let by_penetration = solved(&heights, kernel, Control::Penetration(expected.penetration), 1e-9);
        assert_close("load", by_penetration.info().mean_pressure, expected.load, 5e-4);
    }
}

#[test]
fn forty_elements_per_radius_suffice_at_several_penetrations() {
    let theory = PeriodicHertz { radius: 2.0 };
    for contact_radius in [0.04, 0.06, 0.08] {
        let n = 1024; // 41 elements per radius at 0.04
        let expected = theory.at_contact_radius(contact_radius).expect("small contact");
        let solution = solved(&sphere(n, 2.0), &Love, Control::Penetration(expected.penetration), 1e-8);
        assert_close("load", solution.info().mean_pressure, expected.load, 5e-4);
        assert_close("peak pressure", solution.pressure().max(), expected.peak_pressure, 5e-4);
        let area = ContactArea::of(solution.pressure(), solution.gap(), Love.edge_bias(solution.grid()));
        assert_close("radius", (area.fraction / std::f64::consts::PI).sqrt(), contact_radius, 5e-3);
    }
}
