//! The paper's procedure on its adaptive mesh.
//!
//! The cases are Hertz's contact with the paper's parameters, and a rough surface.

use rc_core::{DVec2, Field, Grid, Kernel as _};
use rc_fractal::{SpectrumParams, Surface};
use rc_kernel::Love;
use rc_solver::{ContactArea, ContactElement, Control, Method, Solution, SolveParams, solve};
use rc_theory::hertz::PeriodicHertz;

use crate::{assert_close, solved};

fn by_the_paper(heights: &Field, control: Control, tolerance: f64) -> Solution<'_> {
    let params = SolveParams::to_tolerance(tolerance).by(Method::GaussSeidel);
    solve(heights, control, &params).unwrap_or_else(|error| panic!("{control:?}: {error}"))
}

/// Contact area of the adaptive solution, with edges located on the finest grid.
fn contact_area(solution: &Solution<'_>) -> f64 {
    ContactArea::of(solution.pressure(), solution.gap(), Love.edge_bias(solution.grid())).fraction
}

#[test]
fn papers_sphere_on_the_adaptive_mesh_matches_periodic_hertz() {
    // R = 1 cm and Δ = 25 µm in a cell of 1 cm give a radius of 27 finest elements.
    let theory = PeriodicHertz { radius: 1.0 };
    let expected = theory.at_penetration(2.5e-3).expect("small contact");
    let grid = Grid::square(512).expect("grid");
    // The apex is at the centre of a block of eight elements. So one large element is at the peak, and not four around
    // it.
    let centre = 260.0 / 512.0;
    let heights = Field::from_fn(grid, |DVec2 { x, y }| -0.5 * ((x - centre).powi(2) + (y - centre).powi(2)));
    // The centres of elements miss the apex, so h_max of the grid is lower by the same amount.
    let solution = by_the_paper(&heights, Control::Penetration(2.5e-3 + heights.max()), 1e-7);
    let elements: Vec<ContactElement> = solution.elements().expect("a mesh").collect();
    assert!(elements.len() < 1600, "{} elements for 2250 cells", elements.len());
    assert_eq!(elements.len(), solution.n_elements());
    let radius = (contact_area(&solution) / std::f64::consts::PI).sqrt();
    assert_close("radius", radius, expected.contact_radius, 0.01);
    assert_close("load", solution.info().mean_pressure, expected.load, 0.01);
    assert_close("peak pressure", solution.pressure().max(), expected.peak_pressure, 0.01);
    // The sections are those of Fig. 4, through the centre and beside it.
    for element in &elements {
        let r = (element.centre.x - centre).hypot(element.centre.y - centre);
        if r < 0.9 * expected.contact_radius {
            let exact = expected.pressure(r);
            let error = (element.pressure - exact).abs() / expected.peak_pressure;
            assert!(error < 0.03, "at r = {r}: {:e} against {exact:e}", element.pressure);
        }
    }
}

#[test]
fn rough_surface_matches_the_uniform_solution_with_the_same_smallest_element() {
    let surface = Surface::new(&SpectrumParams::paper(8, 1)).expect("valid spectrum");
    let heights = surface.sample_on(Grid::square(128).expect("grid")).expect("resolved");
    let reference = solved(&heights, &Love, Control::Penetration(1.5e-3), 1e-8);
    let solution = by_the_paper(&heights, Control::Penetration(1.5e-3), 1e-6);
    assert_close("area", contact_area(&solution), contact_area(&reference), 0.01);
    assert_close("load", solution.info().mean_pressure, reference.info().mean_pressure, 0.01);
    let elements = solution.n_elements();
    let cells = reference.pressure().values().iter().filter(|&&p| p > 0.0).count();
    assert!(elements < cells, "{elements} elements for {cells} cells");
}
