//! Contact conductance from the stiffness (Barber, Proc. R. Soc. A 459, 2003) against what is known of spots: of
//! conductivity 1, in a cell of side 1, with E* = 1, the conductance is the stiffness.

use std::f64::consts::PI;

use rc_core::{DVec2, Field, Grid, Kernel};
use rc_fractal::{SpectrumParams, Surface};
use rc_kernel::Love;
use rc_solver::{ContactSpot, Control};

use crate::{assert_close, solved};

/// Resistance between a spot and all its periodic images, times π: the Madelung constant of the square lattice in a
/// neutral background.
const SQUARE_LATTICE: f64 = -3.900264920001956;

/// Radii of circles of the area of each spot.
fn radii(pressure: &Field, gap: &Field) -> Vec<f64> {
    let spots = ContactSpot::all(pressure, gap, Love.edge_bias());
    spots.iter().map(|spot| (spot.area_fraction / PI).sqrt()).collect()
}

/// Holm: a round spot of radius a has the constriction resistance 1/(2a) between two bodies of conductivity 1; the
/// images add their part.
#[test]
fn one_round_spot_has_the_resistance_of_holm() {
    let grid = Grid::square(512).expect("a grid");
    let middle = DVec2::splat(0.5 + 0.5 / 512.0);
    let heights = Field::from_fn(grid, |at| -(at - middle).length_squared() / 2.0);
    for load in [2e-4, 1e-3] {
        let solution = solved(&heights, &Love, Control::MeanPressure(load), 1e-9);
        let a = radii(solution.pressure(), solution.gap())[0];
        let resistance = 1.0 / (2.0 * a) + SQUARE_LATTICE / PI;
        // The next term of the lattice is of the order a⁴ or less; the radius is located to 0.5 %.
        assert_close("conductance", solution.stiffness(), 1.0 / resistance, 1e-2);
    }
}

/// Greenwood (Br. J. Appl. Phys. 17, 1966): spots side by side conduct less than the sum of them all, as the currents
/// are in each other's way; in a periodic cell, the background of the images takes something off the resistance. They
/// conduct more than one round spot of the same area (Pólya and Szegő: of all shapes of an area the disc has the least
/// capacity).
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
        // Images of the whole contact help: their background is drawn from the cell. By no more than those of one spot
        // with all of the current.
        let least = 1.0 / alone + SQUARE_LATTICE / PI;
        assert!(1.0 / conductance > least, "{load}: 1/{conductance} is not above {least} of {} spots", radii.len());
        assert!(conductance > together, "{load}: {conductance} is not above {together}");
    }
}
