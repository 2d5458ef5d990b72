//! Sums over the elements at the edges of contacts.

use std::ops::{Add, AddAssign};

use crate::solution::contact_area::corner::at_corner;
use crate::solution::contact_area::edge::Edge;
use crate::solution::contact_area::kind::Kind;

/// The eight neighbours of an element, in order around it.
const AROUND: [[isize; 2]; 8] = [[-1, -1], [0, -1], [1, -1], [-1, 0], [1, 0], [-1, 1], [0, 1], [1, 1]];

/// Number of parts of the distance between two elements in which edges are counted.
const N_POSITIONS: usize = 128;

/// Number of other values of [`EdgeSums`].
const N_VALUES: usize = 27;

/// The values of [`EdgeSums`] as ranks exchange them.
pub(crate) type Values = [f64; N_VALUES + N_POSITIONS];

/// Sums over elements of one size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct EdgeSums {
    /// Number of elements in contact.
    pub(crate) n_contact: usize,
    /// Number of pairs of neighbours of which one is in contact.
    pub(crate) edges: usize,
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
    /// `edges`, `diagonals` and `length`.
    pub(crate) sharp: usize,
    /// Number of sharp edges where the gap beside the contact is known.
    pub(crate) known_sharp: usize,
    /// Number of edges of elements in [`EdgeSums::thin_rims`].
    pub(crate) thin: usize,
    /// Σ (s - ½) over sharp edges with a known gap.
    ///
    /// The gap grows in proportion to the distance from a sharp edge, and so does the overlap on the other side.
    pub(crate) shift_of_sharp: f64,
    /// Σ of overlap inside and gap outside, over sharp edges with a known gap, in λ.
    pub(crate) steps: f64,
    /// Number of edges where the heights jump, as at the edge of a flat top.
    ///
    /// They may be anywhere between the two centres. Of the sums above, these edges are only in `edges` and `diagonals`.
    pub(crate) jumps: usize,
    /// Σ p² s over these edges, with the side s across the edge, in E*² λ.
    pub(crate) at_jumps: f64,
    /// Σ p of the elements.
    pub(crate) pressure: f64,
    /// Σ p² of the elements inside, over all edges that are not sharp, without [`EdgeSums::thin_rims`].
    pub(crate) squares: f64,
    /// Σ p² of the second elements inside, over the same edges.
    pub(crate) next_squares: f64,
    /// Σ p² of elements without a neighbour in contact along an axis, for each such axis.
    pub(crate) lone_squares: f64,
    /// Σ p (H - p) of elements between one that is plastic and one out of contact, for the hardness H.
    ///
    /// The elastic rim there is thinner than an element.
    pub(crate) thin_rims: f64,
    /// Σ of the squares of the terms of [`EdgeSums::thin_rims`], relative to H².
    pub(crate) thin_rims_squared: f64,
    /// Σ of the squared differences of pressure between neighbours that are both in elastic contact.
    pub(crate) differences: f64,
    /// Σ of the squared second differences of pressure over three elements in a line, all in elastic contact.
    pub(crate) second_differences: f64,
    /// Number of elements inside the contact that may hide a place out of contact.
    ///
    /// The pressure is minimum there, and less than it rises within half an element.
    pub(crate) hidden: usize,
    /// Σ of these rises of the pressure.
    pub(crate) hidden_rises: f64,
    /// Corners where one of the four elements is in contact, minus those where three are.
    ///
    /// It is four times the number of contacts minus the number of their holes.
    pub(crate) turns: isize,
    /// Σ of the lengths of located edges between the centres of elements, in λ.
    pub(crate) length: f64,
    /// Σ p² s over the sides of elements along free borders, with the side s across the border, in E*² λ.
    pub(crate) at_border: f64,
    /// Number of located edges by the root of their position between the centres of two elements.
    positions: [u32; N_POSITIONS],
}

impl Default for EdgeSums {
    fn default() -> Self {
        Self::from_values(&[0.0; N_VALUES + N_POSITIONS])
    }
}

impl EdgeSums {
    /// Adds an element in contact, where pressures are at most the `hardness`.
    ///
    /// `at` gives pressure and gap at a place relative to the element, in elements. A gap that is not known may be NaN.
    /// `distance` is that of a neighbour's centre in sides of the element. It is 0 beyond a free border. `sides` are the
    /// sides of the element.
    pub(crate) fn add(
        &mut self,
        sides: [f64; 2],
        hardness: f64,
        at: &impl Fn(isize, isize) -> [f64; 2],
        distance: &impl Fn(isize, isize) -> f64,
    ) {
        self.n_contact += 1;
        let pressure = at(0, 0)[0];
        self.pressure += pressure;
        let around = AROUND.map(|[dx, dy]| at(dx, dy)[0]);
        let beside = [[around[3], around[4]], [around[1], around[6]]];
        let distances = [[[-1, 0], [1, 0]], [[0, -1], [0, 1]]].map(|axis| axis.map(|[dx, dy]| distance(dx, dy)));
        self.add_inside(pressure, hardness, (beside, distances));
        let free = around.map(|p| p <= 0.0);
        if free == [false; 8] {
            return;
        }
        let any_beside = |is: fn(f64, f64) -> bool| beside.as_flattened().iter().any(|&p| is(p, hardness));
        let is_thin_rim = pressure < hardness && any_beside(|p, _| p <= 0.0) && any_beside(|p, hardness| p >= hardness);
        if is_thin_rim {
            let term = pressure * (hardness - pressure);
            self.thin_rims += term;
            self.thin_rims_squared += (term / hardness).powi(2);
        }
        let mut positions = [0.5; 8];
        for (place, [dx, dy]) in AROUND.into_iter().enumerate().filter(|&(place, _)| free[place]) {
            if dx != 0 && dy != 0 {
                self.diagonals += 1;
                continue;
            }
            self.edges += 1;
            let (side, across) = (if dy == 0 { sides[0] } else { sides[1] }, |steps: isize| at(steps * dx, steps * dy));
            let kind = Kind::of(&across, side, hardness);
            positions[place] = kind.position();
            match kind {
                Kind::Jump => {
                    self.jumps += 1;
                    self.at_jumps += if pressure < hardness { pressure * pressure * side } else { 0.0 };
                }
                Kind::Sharp { overlap, gap } => self.add_sharp([overlap, gap.unwrap_or(f64::NAN)], kind.position()),
                Kind::Smooth(edge) => {
                    if is_thin_rim {
                        self.thin += 1;
                    } else {
                        self.squares += pressure * pressure;
                        self.next_squares += across(-1)[0].powi(2);
                    }
                    self.add_smooth(edge, across(2)[1] / (pressure * side));
                }
            }
        }
        self.add_corners(sides, hardness, positions, at);
    }

    /// Adds the differences of pressure to the neighbours, which lie before and behind along both axes.
    ///
    /// A neighbour of another size is not at the distance of a side, and beyond a free border there is none.
    fn add_inside(&mut self, pressure: f64, hardness: f64, (beside, distances): ([[f64; 2]; 2], [[f64; 2]; 2])) {
        let mut curvatures = [0.0; 2];
        // A step to a plastic element is at the edge of the elastic part, as the step to a free element is.
        let is_elastic = |p: f64| p > 0.0 && p < hardness;
        for (([before, behind], distances), curvature) in beside.into_iter().zip(distances).zip(&mut curvatures) {
            let in_line = distances.iter().all(|distance| (distance - 1.0).abs() < 0.1);
            let second = before - 2.0 * pressure + behind;
            if distances[1] > 0.0 && is_elastic(pressure) && is_elastic(behind) {
                self.differences += ((behind - pressure) / distances[1]).powi(2);
                if in_line && is_elastic(before) {
                    self.second_differences += second.powi(2);
                }
            }
            if behind <= 0.0 && before <= 0.0 && pressure < hardness {
                self.lone_squares += pressure * pressure;
            }
            *curvature = if in_line && before.min(behind) >= pressure { second } else { 0.0 };
        }
        // Half an element from the minimum, the pressure is higher by an eighth of the second difference.
        let rise = 0.25 * (curvatures[0] * curvatures[1]).sqrt();
        if pressure < rise {
            self.hidden += 1;
            self.hidden_rises += rise;
        }
    }

    /// Adds the corners of an element with these positions of edges to its eight neighbours.
    fn add_corners(
        &mut self,
        sides: [f64; 2],
        hardness: f64,
        positions: [f64; 8],
        at: &impl Fn(isize, isize) -> [f64; 2],
    ) {
        let [_, below, _, before, behind, _, above, _] = positions;
        for (dy, along_y) in [(-1, below), (1, above)] {
            for (dx, along_x) in [(-1, before), (1, behind)] {
                let (turns, length) = at_corner(at, [dx, dy], [along_x, along_y], sides, hardness);
                self.turns += turns;
                self.length += length;
            }
        }
    }

    /// Adds an edge with the ratio of the second gap outside to the pressure, as in [`Edge::new`].
    fn add_smooth(&mut self, edge: Option<Edge>, second: f64) {
        let Some(edge) = edge else { return };
        self.shift += edge.position() - 0.5;
        self.known[0] += 1;
        self.add_position(edge.position());
        if let Some(deviation) = edge.deviation(second) {
            self.known[1] += 1;
            self.deviation += deviation;
        }
    }

    /// Adds the edge at this position between a plastic element and a neighbour out of contact.
    ///
    /// `[overlap, gap]` are those of the two. A gap that is not known is NaN.
    fn add_sharp(&mut self, [overlap, gap]: [f64; 2], position: f64) {
        self.sharp += 1;
        if gap.is_nan() {
            return;
        }
        self.shift_of_sharp += position - 0.5;
        self.steps += overlap + gap;
        self.known_sharp += 1;
        self.add_position(position);
    }

    /// Counts an edge at a position between the centres of two elements, from 0 to 1.
    ///
    /// The pressure of the last element falls in proportion to the distance by which an edge moves, and the position in
    /// proportion to its square. So roots of positions have a smooth density.
    fn add_position(&mut self, position: f64) {
        self.positions[((position.sqrt() * N_POSITIONS as f64) as usize).min(N_POSITIONS - 1)] += 1;
    }

    /// The sums as ranks exchange them. Counts are exact.
    pub(crate) fn to_values(self) -> Values {
        let Self {
            n_contact, edges, diagonals, known, sharp, known_sharp, thin, hidden, jumps, turns, positions, ..
        } = self;
        let Self { shift, deviation, shift_of_sharp, steps, pressure, squares, lone_squares, .. } = self;
        let Self { next_squares, thin_rims, thin_rims_squared, differences, second_differences, .. } = self;
        let Self { hidden_rises, at_border, length, at_jumps, .. } = self;
        let counts = [n_contact, edges, diagonals, known[0], known[1], sharp, known_sharp, thin, hidden, jumps];
        let sums = [shift, deviation, shift_of_sharp, steps, pressure, squares, lone_squares];
        let of_pressures = [next_squares, thin_rims, thin_rims_squared, differences, second_differences];
        let counts = counts.into_iter().map(|n| n as f64).chain([turns as f64]);
        let mut values = counts
            .chain(sums)
            .chain(of_pressures)
            .chain([hidden_rises, at_border, length, at_jumps])
            .chain(positions.map(f64::from));
        std::array::from_fn(|_| values.next().unwrap_or_default())
    }

    /// The sums from [`EdgeSums::to_values`].
    pub(crate) fn from_values(values: &Values) -> Self {
        let [n_contact, edges, diagonals, first, second, sharp, known_sharp, thin, hidden, jumps] =
            std::array::from_fn(|i| values[i] as usize);
        let [shift, deviation, shift_of_sharp, steps, pressure, squares, lone_squares] =
            std::array::from_fn(|i| values[11 + i]);
        let [
            next_squares,
            thin_rims,
            thin_rims_squared,
            differences,
            second_differences,
            hidden_rises,
            at_border,
            length,
            at_jumps,
        ] = std::array::from_fn(|i| values[18 + i]);
        Self {
            n_contact,
            edges,
            diagonals,
            known: [first, second],
            shift,
            deviation,
            sharp,
            known_sharp,
            thin,
            jumps,
            at_jumps,
            shift_of_sharp,
            steps,
            pressure,
            squares,
            next_squares,
            lone_squares,
            thin_rims,
            thin_rims_squared,
            differences,
            second_differences,
            hidden,
            hidden_rises,
            turns: values[10] as isize,
            at_border,
            length,
            positions: std::array::from_fn(|i| values[N_VALUES + i] as u32),
        }
    }

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

    /// Number of further edges with the same position between elements, in the mean over edges.
    ///
    /// The positions of independent edges have a smooth density. Copies of an asperity at a pitch of whole elements have
    /// the same positions. If each occurs k times, the counts c of edges in small parts of the distance have
    /// Σ (c_i - c_{i+1})² = k Σ (c_i + c_{i+1}). About one neighbour along an edge is in the same part in any case.
    pub(crate) fn copies(&self) -> f64 {
        let counts = self.positions.map(f64::from);
        let sum = |of_pair: fn(f64, f64) -> f64| counts.windows(2).map(|pair| of_pair(pair[0], pair[1])).sum::<f64>();
        let n = sum(|a, b| a + b);
        if n > 0.0 { sum(|a, b| (a - b).powi(2)) / n - 1.0 } else { 0.0 }
    }

    /// Number of edges where the pressure vanishes.
    pub(crate) fn smooth(&self) -> usize {
        self.edges - self.sharp - self.jumps
    }
}

impl Add for EdgeSums {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let (a, b) = (self.to_values(), other.to_values());
        Self::from_values(&std::array::from_fn(|i| a[i] + b[i]))
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
            EdgeSums::add(&mut sums, [1.0; 2], 1.0, &at, &|_, _| 1.0);
            assert_eq!((sums.sharp, sums.known_sharp), (1, 1));
            assert!((sums.shift_of_sharp - (position - 0.5)).abs() < 1e-12, "{position}: {sums:?}");
        }
    }

    /// Edges at irregular positions, each a number of times.
    #[test]
    fn copies_of_edges_are_counted() {
        for (n, copies) in [(400, 1), (400, 16), (30, 64), (40_000, 1)] {
            let mut sums = EdgeSums::default();
            for i in 0..n {
                // Most edges are near the inner element.
                let position = (f64::from(i) * f64::from(i) * 0.618_033_988_749_895).fract().powi(2);
                (0..copies).for_each(|_| sums.add_position(position));
            }
            let (found, expected) = (sums.copies() + 1.0, f64::from(copies));
            assert!((found / expected - 1.0).abs() < 0.5, "{n} x {copies}: {found}");
        }
        assert!(EdgeSums::default().copies().abs() < 1e-12);
    }

    /// The pressure between two contacts of full contact is a parabola. Its minimum is between two centres.
    #[test]
    fn a_minimum_below_half_an_element_may_hide_a_place_out_of_contact() {
        let hidden = |least: f64| {
            let at = |x: isize, y: isize| [least + 0.5 * ((x as f64 - 0.4).powi(2) + (y as f64).powi(2)), 0.0];
            let mut sums = EdgeSums::default();
            EdgeSums::add(&mut sums, [1.0; 2], f64::INFINITY, &at, &|_, _| 1.0);
            sums.hidden
        };
        assert_eq!([0.01, 0.1, 0.3].map(hidden), [1, 1, 0]);
    }

    #[test]
    fn ranks_exchange_all_sums() {
        let values: Values = std::array::from_fn(|i| i as f64);
        assert_eq!(EdgeSums::from_values(&values).to_values().map(f64::to_bits), values.map(f64::to_bits));
    }
}
