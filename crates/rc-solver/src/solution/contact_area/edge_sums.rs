//! Sums over the elements at the edges of contacts.

use std::ops::{Add, AddAssign};

use crate::solution::contact_area::edge::Edge;

/// The eight neighbours of an element, in order around it.
const AROUND: [[isize; 2]; 8] = [[-1, -1], [0, -1], [1, -1], [-1, 0], [1, 0], [-1, 1], [0, 1], [1, 1]];

/// Sums over elements of one size.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct EdgeSums {
    /// Number of elements in contact.
    pub(crate) n_contact: usize,
    /// Number of pairs of neighbours of which one is in contact.
    pub(crate) edges: usize,
    /// Number of these pairs that are neighbours along x.
    pub(crate) along_x: usize,
    /// Number of such pairs across a corner.
    pub(crate) diagonals: usize,
    /// Number of edges with a known gap beside the contact.
    ///
    /// The second number counts those where the next gap is known too.
    pub(crate) known: [usize; 2],
    /// Σ (s - ½) over edges where the gap is known, with s as in [`Edge::position`].
    pub(crate) shift: f64,
    /// Σ of [`Edge::deviation`] over edges where the next gap is known too.
    pub(crate) deviation: f64,
    /// Number of edges of plastic elements.
    ///
    /// There the pressure falls from the hardness to zero within an element. Of the sums above, these edges are only in
    /// `edges`, `along_x` and `diagonals`.
    pub(crate) sharp: usize,
    /// Number of sharp edges where the gap beside the contact is known.
    pub(crate) known_sharp: usize,
    /// Σ (s - ½) over sharp edges with a known gap.
    ///
    /// The gap grows in proportion to the distance from a sharp edge, and so does the overlap on the other side.
    pub(crate) shift_of_sharp: f64,
    /// Σ p² of the elements inside, over all edges that are not sharp.
    pub(crate) squares: f64,
    /// Corners where one of the four elements is in contact, minus those where three are.
    ///
    /// It is four times the number of contacts minus the number of their holes.
    pub(crate) turns: isize,
    /// Σ p² s over the sides of elements along free borders, with the side s across the border, in E*² λ.
    pub(crate) at_border: f64,
}

impl EdgeSums {
    /// Adds an element in contact, where pressures are at most the `hardness`.
    ///
    /// `at` gives pressure and gap at a place relative to the element, in elements. A gap that is not known may be NaN.
    /// `sides` are the sides of the element.
    pub(crate) fn add(&mut self, sides: [f64; 2], hardness: f64, at: &impl Fn(isize, isize) -> [f64; 2]) {
        self.n_contact += 1;
        let free = AROUND.map(|[dx, dy]| at(dx, dy)[0] <= 0.0);
        if free == [false; 8] {
            return;
        }
        let [pressure, overlap] = at(0, 0);
        for ([dx, dy], _) in AROUND.into_iter().zip(free).filter(|&(_, free)| free) {
            if dx != 0 && dy != 0 {
                self.diagonals += 1;
                continue;
            }
            self.edges += 1;
            self.along_x += usize::from(dy == 0);
            let side = if dy == 0 { sides[0] } else { sides[1] };
            if pressure >= hardness {
                self.add_sharp(overlap, at(dx, dy)[1]);
                continue;
            }
            self.squares += pressure * pressure;
            let gap_ratio = |steps: isize| at(steps * dx, steps * dy)[1] / (pressure * side);
            if let Some(edge) = Edge::new(gap_ratio(1)) {
                self.shift += edge.position() - 0.5;
                self.known[0] += 1;
                if let Some(deviation) = edge.deviation(gap_ratio(2)) {
                    self.known[1] += 1;
                    self.deviation += deviation;
                }
            }
        }
        let in_contact = |dx: isize, dy: isize| at(dx, dy)[0] > 0.0;
        for [x, y] in [[-1, -1], [0, -1], [-1, 0], [0, 0]] {
            let corner = [[x, y], [x + 1, y], [x, y + 1], [x + 1, y + 1]];
            // The first of its elements in contact counts each corner.
            if corner.into_iter().find(|&[x, y]| in_contact(x, y)) == Some([0, 0]) {
                match corner.into_iter().filter(|&[x, y]| in_contact(x, y)).count() {
                    1 => self.turns += 1,
                    3 => self.turns -= 1,
                    _ => {}
                }
            }
        }
    }
}

impl EdgeSums {
    /// The sums as ranks exchange them. Counts are exact.
    pub(crate) fn to_values(self) -> [f64; 14] {
        let Self { n_contact, edges, along_x, diagonals, known, shift, deviation, squares, turns, .. } = self;
        let Self { sharp, known_sharp, shift_of_sharp, at_border, .. } = self;
        let [n_contact, edges, along_x, diagonals] = [n_contact, edges, along_x, diagonals].map(|n| n as f64);
        let [first, second, sharp, known_sharp] = [known[0], known[1], sharp, known_sharp].map(|n| n as f64);
        let counts = [n_contact, edges, along_x, diagonals, first, second, sharp, known_sharp, turns as f64];
        let mut values = [0.0; 14];
        values[..9].copy_from_slice(&counts);
        values[9..].copy_from_slice(&[shift, deviation, squares, shift_of_sharp, at_border]);
        values
    }

    /// The sums from [`EdgeSums::to_values`].
    pub(crate) fn from_values(values: [f64; 14]) -> Self {
        let [n_contact, edges, along_x, diagonals, first, second, sharp, known_sharp] =
            std::array::from_fn(|i| values[i] as usize);
        let (known, turns) = ([first, second], values[8] as isize);
        let [shift, deviation, squares, shift_of_sharp, at_border] = std::array::from_fn(|i| values[9 + i]);
        Self {
            n_contact,
            edges,
            along_x,
            diagonals,
            known,
            shift,
            deviation,
            sharp,
            known_sharp,
            shift_of_sharp,
            squares,
            turns,
            at_border,
        }
    }
}

impl EdgeSums {
    /// Adds the pressure of an element that may be along a free border.
    ///
    /// The element is at `place` of a grid of `extent` elements, and has the sides `sides`. Plastic elements are left
    /// out, because the hardness ends the singularity of the pressure.
    pub(crate) fn add_at_border(
        &mut self,
        pressure: f64,
        hardness: f64,
        [place, extent]: [[usize; 2]; 2],
        sides: [f64; 2],
    ) {
        if pressure >= hardness {
            return;
        }
        for axis in [0, 1] {
            let n = usize::from(place[axis] == 0) + usize::from(place[axis] + 1 == extent[axis]);
            self.at_border += n as f64 * pressure * pressure * sides[axis];
        }
    }

    /// Adds the edge between a plastic element and a neighbour out of contact.
    ///
    /// `inside` and `outside` are their gaps. A negative gap is an overlap.
    fn add_sharp(&mut self, inside: f64, outside: f64) {
        self.sharp += 1;
        if outside.is_nan() {
            return;
        }
        let (overlap, gap) = ((-inside).max(0.0), outside.max(0.0));
        let position = if overlap + gap > 0.0 { overlap / (overlap + gap) } else { 0.5 };
        self.shift_of_sharp += position - 0.5;
        self.known_sharp += 1;
    }

    /// Shift and deviation, summed over all edges.
    ///
    /// Where they are not known, they are the mean of the other edges of their kind.
    pub(crate) fn of_all(&self) -> [f64; 2] {
        let all = |sum: f64, edges: usize, known: usize| match known {
            0 => 0.0,
            known => sum * (edges as f64 / known as f64),
        };
        let shift = all(self.shift, self.smooth(), self.known[0]);
        let of_sharp = all(self.shift_of_sharp, self.sharp, self.known_sharp);
        [shift + of_sharp, all(self.deviation, self.smooth(), self.known[1])]
    }

    /// Number of edges that are not sharp.
    pub(crate) fn smooth(&self) -> usize {
        self.edges - self.sharp
    }
}

impl Add for EdgeSums {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            n_contact: self.n_contact + other.n_contact,
            edges: self.edges + other.edges,
            along_x: self.along_x + other.along_x,
            diagonals: self.diagonals + other.diagonals,
            known: [self.known[0] + other.known[0], self.known[1] + other.known[1]],
            shift: self.shift + other.shift,
            deviation: self.deviation + other.deviation,
            sharp: self.sharp + other.sharp,
            known_sharp: self.known_sharp + other.known_sharp,
            shift_of_sharp: self.shift_of_sharp + other.shift_of_sharp,
            squares: self.squares + other.squares,
            turns: self.turns + other.turns,
            at_border: self.at_border + other.at_border,
        }
    }
}

impl AddAssign for EdgeSums {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The gap is linear across the edge, and negative inside.
    #[test]
    fn a_sharp_edge_is_where_the_overlap_ends() {
        for position in [0.25, 0.5, 0.75] {
            let at = |dx: isize, _: isize| [if dx <= 0 { 1.0 } else { 0.0 }, 0.1 * (dx as f64 - position)];
            let mut sums = EdgeSums::default();
            EdgeSums::add(&mut sums, [1.0; 2], 1.0, &at);
            assert_eq!((sums.sharp, sums.known_sharp), (1, 1));
            assert!((sums.shift_of_sharp - (position - 0.5)).abs() < 1e-12, "{position}: {sums:?}");
        }
    }
}
