//! The edge of a contact at a corner of four elements.

use crate::solution::contact_area::edge::Edge;

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
    let [along_x, along_y, across] = [[dx, 0], [0, dy], [dx, dy]].map(|[x, y]| at(x, y));
    let position = |inside: [f64; 2], outside: [f64; 2], side: f64| {
        let position = if inside[0] >= hardness {
            sharp_position([inside[1], outside[1]])
        } else {
            Edge::new(outside[1] / (inside[0] * side)).map(Edge::position)
        };
        position.unwrap_or(0.5)
    };
    let [x, y] = sides;
    match [along_x, along_y, across].map(|[pressure, _]| pressure > 0.0) {
        [false, false, is_contact] => (isize::from(!is_contact), (x * own[0]).hypot(y * own[1])),
        [true, false, false] => (0, 0.5 * x.hypot(y * (own[1] - position(along_x, across, y)))),
        [false, true, false] => (0, 0.5 * y.hypot(x * (own[0] - position(along_y, across, x)))),
        [true, true, false] => {
            let rests = [(along_y, x), (along_x, y)].map(|(inside, side)| side * (1.0 - position(inside, across, side)));
            (-1, rests[0].hypot(rests[1]))
        }
        _ => (0, 0.0),
    }
}

/// Position of the edge of a plastic element, as a fraction of the distance to the next centre.
///
/// The gaps are those inside and outside. A negative gap is an overlap. `None` if the gap outside is not a number.
pub(super) fn sharp_position([inside, outside]: [f64; 2]) -> Option<f64> {
    let (overlap, gap) = ((-inside).max(0.0), outside.max(0.0));
    let position = if overlap + gap > 0.0 { overlap / (overlap + gap) } else { 0.5 };
    (!outside.is_nan()).then_some(position)
}
