//! Contact conductance from the stiffness against theories of contact spots.
//!
//! With conductivity 1, cell side 1 and E* = 1, the conductance is the stiffness (Barber, Proc. R. Soc. A 459, 2003).

use std::f64::consts::PI;

use rc_core::{DVec2, Field, Grid, Kernel};
use rc_fractal::{SpectrumParams, Surface};
use rc_kernel::Love;
use rc_solver::{ContactSpot, Control};

use crate::{assert_close, solved};

/// Resistance between a spot and all its periodic images, times π.
///
/// It is the Madelung constant of the square lattice in a neutral background.
const SQUARE_LATTICE: f64 = -3.900264920001956;

/// Radii of circles that have the areas of the spots.
fn radii(pressure: &Field, gap: &Field) -> Vec<f64> {
    let spots = ContactSpot::all(pressure, gap, Love.edge_bias(pressure.grid()));
    spots.iter().map(|spot| (spot.area_fraction / PI).sqrt()).collect()
}

/// A round spot of radius a has Holm's constriction resistance 1/(2a).
///
/// It is between two bodies of conductivity 1. The periodic images add their part.
#[test]
fn one_round_spot_has_the_resistance_of_holm() {
    let grid = Grid::square(512).expect("a grid");
    let middle = DVec2::splat(0.5 + 0.5 / 512.0);
    let heights = Field::from_fn(grid, |at| -(at - middle).length_squared() / 2.0);
    for load in [2e-4, 1e-3] {
        let solution = solved(&heights, &Love, Control::MeanPressure(load), 1e-9);
        let a = radii(solution.pressure(), solution.gap())[0];
        let resistance = 1.0 / (2.0 * a) + SQUARE_LATTICE / PI;
        // The next term of the lattice is of the order a⁴ or smaller. The radius is located to 0.5 %.
        assert_close("conductance", solution.stiffness(), 1.0 / resistance, 1e-2);
    }
}

/// The conductance of a rough contact has bounds from its spots.
///
/// Spots side by side conduct less than the sum of all spots, since their currents obstruct each other (Greenwood, Br.
/// J. Appl. Phys. 17, 1966). In a periodic cell, the background of the images reduces the resistance. The spots conduct
/// more than one round spot of the same area. The reason is that the disc has the smallest capacity of all shapes of an
/// area (Pólya and Szegő).
#[test]
fn a_light_rough_contact_conducts_less_than_its_spots_alone_and_more_than_one_spot_of_their_area() {
    let params = SpectrumParams { roll_off: 4.0, ..SpectrumParams::paper(16, 3) };
    let surface = Surface::new(&params).expect("a surface");
    let heights = surface.sample_on(Grid::square(512).expect("a grid")).expect("heights");
    for load in [5e-5, 1e-4, 2e-4] {
        let solution = solved(&heights, &Love, Control::MeanPressure(load), 1e-8);
        let radii = radii(solution.pressure(), solution.gap());
        let (sum, squares) = (radii.iter().sum::<f64>(), radii.iter().map(|a| a * a).sum::<f64>());
        let (alone, together) = (2.0 * sum, 2.0 * squares.sqrt());
        let conductance = solution.stiffness();
        assert!(1.0 / alone > -SQUARE_LATTICE / PI, "the bound says nothing");
        assert!(radii.len() > 2, "only {} spots", radii.len());
        // The images of the whole contact reduce the resistance, since their background is taken from the cell. The
        // reduction is at most that of a single spot with the whole current.
        let least = 1.0 / alone + SQUARE_LATTICE / PI;
        assert!(1.0 / conductance > least, "{load}: 1/{conductance} is not above {least} of {} spots", radii.len());
        assert!(conductance > together, "{load}: {conductance} is not above {together}");
    }
}
