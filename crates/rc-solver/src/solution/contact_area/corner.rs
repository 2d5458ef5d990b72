//! The edge of a contact at a corner of four elements.

use crate::solution::contact_area::kind::Kind;

/// What an element in contact adds at one of its corners: turns of the edge, and its length in λ.
///
/// The edge is a line between two sides of the rectangle of the four centres, with a located position on each. All
/// elements of a corner find the same line. If two of them are neighbours on one side of it, each adds half: beyond a
/// free border there is no second one, and the line ends at the border. If they touch across the corner only, each adds
/// a line of its own. A position that is not known is in the middle.
///
/// `at` gives pressure and gap at a place relative to the element, in elements. The corner is in the direction
/// `[dx, dy]`. `own` are the positions of the edges of the element along both axes, where it has them. `sides` are the
/// sides of the element.
pub(super) fn at_corner(
    at: &impl Fn(isize, isize) -> [f64; 2],
    [dx, dy]: [isize; 2],
    own: [f64; 2],
    sides: [f64; 2],
    hardness: f64,
) -> (isize, f64) {
    let [x, y] = sides;
    // The edges of the neighbours along y and along x, in the directions x and y.
    let beside = || {
        let along_y = |steps: isize| at(steps * dx, dy);
        let along_x = |steps: isize| at(dx, steps * dy);
        [Kind::of(&along_y, x, hardness), Kind::of(&along_x, y, hardness)].map(Kind::position)
    };
    match [[dx, 0], [0, dy], [dx, dy]].map(|[x, y]| at(x, y)[0] > 0.0) {
        [false, false, is_contact] => (isize::from(!is_contact), (x * own[0]).hypot(y * own[1])),
        [true, false, false] => (0, 0.5 * x.hypot(y * (own[1] - beside()[1]))),
        [false, true, false] => (0, 0.5 * y.hypot(x * (own[0] - beside()[0]))),
        [true, true, false] => {
            let [along_y, along_x] = beside();
            (-1, (x * (1.0 - along_y)).hypot(y * (1.0 - along_x)))
        }
        _ => (0, 0.0),
    }
}

#[cfg(test)]
mod tests {
    use rc_core::{Boundary, DVec2, Field, Grid};

    use crate::solution::contact_area::area::{around, sums_of_rows};
    use crate::solution::contact_area::edge_sums::EdgeSums;

    /// Sums of a plastic contact, with the overlap equal to this distance inside its edge.
    ///
    /// Linear positions are exact for a straight edge in any direction.
    fn sums(sides: [usize; 2], boundary: Boundary, distance: impl Fn(DVec2) -> f64) -> EdgeSums {
        let grid = Grid::new(sides[0], sides[1]).expect("a grid");
        let pressure = Field::from_fn(grid, |at| if distance(at) > 0.0 { 1.0 } else { 0.0 });
        let gap = Field::from_fn(grid, |at| -distance(at));
        let values = [pressure.values(), gap.values()];
        let at = |place: [usize; 2]| around(values, sides, place, boundary);
        sums_of_rows((grid, boundary), 1.0, |i| values[0][i] > 0.0, at)
    }

    #[test]
    fn straight_edges_are_found_exactly_and_end_at_free_borders() {
        for [kx, ky] in [[1.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 1.0]] {
            let waves = f64::hypot(kx, ky);
            let distance = |at: DVec2| {
                let phase = kx * at.x + ky * at.y + 0.13;
                (0.2 - (phase - phase.round()).abs()) / waves
            };
            for sides in [[64, 64], [128, 32], [32, 128]] {
                let length = sums(sides, Boundary::Periodic, distance).length;
                assert!((length / (2.0 * waves) - 1.0).abs() < 1e-9, "{kx}, {ky} on {sides:?}: {length}");
                let length = sums(sides, Boundary::Free, distance).length;
                // At a free border, a line goes on at a right angle to it for half an element.
                let allowed = if kx * ky == 0.0 { 1e-9 } else { 5e-2 };
                assert!((length / (2.0 * waves) - 1.0).abs() < allowed, "free, {kx}, {ky} on {sides:?}: {length}");
            }
        }
    }

    /// Elements that touch across a corner only have an edge each.
    #[test]
    fn circles_have_their_length_and_elements_across_a_corner_have_one_each() {
        let middle = DVec2::new(0.503, 0.497);
        for elements in [3.0, 10.0, 25.0] {
            let radius = elements / 64.0;
            let sums = sums([64; 2], Boundary::Periodic, |at| radius - (at - middle).length());
            let exact = std::f64::consts::TAU * radius;
            // Its lines are chords.
            let allowed = 0.07 / (elements * elements) + 1e-4;
            assert!((sums.length / exact - 1.0).abs() < allowed, "{elements}: {} for {exact}", sums.length);
            assert_eq!(sums.turns, 4);
        }
        let corner = |at: DVec2| (at * 8.0).floor();
        let joined = sums([8; 2], Boundary::Periodic, |at| match corner(at) {
            at if at == DVec2::new(2.0, 3.0) || at == DVec2::new(3.0, 4.0) => 0.0625,
            _ => -0.0625,
        });
        let alone =
            sums([8; 2], Boundary::Periodic, |at| if corner(at) == DVec2::splat(3.0) { 0.0625 } else { -0.0625 });
        assert!((joined.length / (2.0 * alone.length) - 1.0).abs() < 1e-12, "{joined:?}, {alone:?}");
        assert_eq!((joined.turns, alone.turns), (6, 4));
    }
}
