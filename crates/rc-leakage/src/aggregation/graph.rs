//! Networks that are not on a grid.

use crate::parallel;

use super::aggregates::{ALONE, Aggregates};

/// Number of elements that are relaxed one after another, and whose products are summed together.
pub(super) const BLOCK: usize = 1 << 13;

/// A network that is not on a grid.
///
/// It has the bonds of each element to its neighbours, ordered by neighbour.
#[derive(Debug, Default)]
pub(crate) struct Graph {
    /// Index of the first bond of each element. The last entry is the number of bonds.
    first: Vec<u32>,
    neighbours: Vec<u32>,
    conductances: Vec<f64>,
    /// Sum of the conductances of each element.
    pub(super) totals: Vec<f64>,
    /// Reciprocal of the sum that relaxation divides by; 0 without conductances.
    ///
    /// Bonds to other blocks count twice in this sum. Otherwise two elements that are strongly bound across a border
    /// would change places (Baker, Falgout, Kolev and Yang, SIAM J. Sci. Comput. 33, 2011). Coarser grids have negative
    /// bonds too. Their magnitude is added, because with a smaller sum relaxation would amplify errors.
    inverse: Vec<f64>,
}

/// Function that adds the bonds of an element, each with its neighbour, to a list.
type WriteBonds<'a> = &'a (dyn Fn(usize, &mut Vec<(u32, f64)>) + Sync);

/// Bonds of the elements of a block, from which a graph is put together.
#[derive(Default)]
struct Rows {
    lengths: Vec<u32>,
    bonds: Vec<(u32, f64)>,
}

impl Rows {
    /// Adds an element with these bonds. Several bonds to one neighbour are summed.
    fn push(&mut self, bonds: &mut Vec<(u32, f64)>) {
        // The sort is stable, so that sums have a fixed order.
        bonds.sort_by_key(|(neighbour, _)| *neighbour);
        let start = self.bonds.len();
        for (neighbour, bond) in bonds.drain(..) {
            match self.bonds[start..].last_mut() {
                Some((last, sum)) if *last == neighbour => *sum += bond,
                _ => self.bonds.push((neighbour, bond)),
            }
        }
        self.lengths.push((self.bonds.len() - start) as u32);
    }
}

impl Graph {
    /// The network of `n` elements.
    ///
    /// `write` adds the bonds of an element, each with its neighbour, to an empty list.
    pub(crate) fn new(n: usize, write: WriteBonds<'_>) -> Self {
        let blocks = parallel::map((0..n).step_by(BLOCK).collect(), |first| {
            let (mut rows, mut bonds) = (Rows::default(), Vec::new());
            for element in first..(first + BLOCK).min(n) {
                write(element, &mut bonds);
                rows.push(&mut bonds);
            }
            rows
        });
        Self::of_rows(blocks)
    }

    /// The network of the aggregates, for pressures that are constant on each aggregate.
    pub(super) fn coarse(&self, aggregates: &Aggregates) -> Self {
        let (first, members) = aggregates.members();
        Self::new(aggregates.number, &|aggregate, bonds| {
            for &member in &members[first[aggregate] as usize..first[aggregate + 1] as usize] {
                let all = self.bonds_of(member as usize).map(|(other, bond)| (aggregates.of[other], bond));
                bonds.extend(all.filter(|(other, _)| *other as usize != aggregate && *other != ALONE));
            }
        })
    }

    fn of_rows(blocks: Vec<Rows>) -> Self {
        let elements = blocks.iter().map(|rows| rows.lengths.len()).sum::<usize>();
        let bonds = blocks.iter().map(|rows| rows.bonds.len()).sum();
        let mut graph = Self {
            first: Vec::with_capacity(elements + 1),
            neighbours: Vec::with_capacity(bonds),
            conductances: Vec::with_capacity(bonds),
            totals: Vec::with_capacity(elements),
            inverse: vec![0.0; elements],
        };
        graph.first.push(0);
        for rows in blocks {
            let mut at = 0;
            for length in rows.lengths {
                let bonds = &rows.bonds[at..at + length as usize];
                at += length as usize;
                graph.neighbours.extend(bonds.iter().map(|(neighbour, _)| *neighbour));
                graph.conductances.extend(bonds.iter().map(|(_, bond)| *bond));
                graph.totals.push(bonds.iter().map(|(_, bond)| bond).sum());
                graph.first.push(graph.neighbours.len() as u32);
            }
        }
        let mut inverse = std::mem::take(&mut graph.inverse);
        for_blocks(&mut inverse, &|start, inverse| {
            let here = start..start + inverse.len();
            for (i, inverse) in here.clone().zip(inverse) {
                let others = graph.bonds_of(i).filter(|(j, _)| !here.contains(j));
                let total = graph.totals[i] + others.map(|(_, bond)| bond.abs()).sum::<f64>();
                *inverse = if total > 0.0 { total.recip() } else { 0.0 };
            }
        });
        graph.inverse = inverse;
        graph
    }

    pub(super) fn len(&self) -> usize {
        self.totals.len()
    }

    /// Neighbours of an element, with the conductances to them.
    #[inline]
    pub(super) fn bonds_of(&self, element: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let range = self.first[element] as usize..self.first[element + 1] as usize;
        let neighbours = self.neighbours[range.clone()].iter().map(|neighbour| *neighbour as usize);
        neighbours.zip(self.conductances[range].iter().copied())
    }

    /// The bonds of [`Graph::bonds_of`] in reverse order.
    #[inline]
    fn bonds_back(&self, element: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let range = self.first[element] as usize..self.first[element + 1] as usize;
        let neighbours = self.neighbours[range.clone()].iter().rev().map(|neighbour| *neighbour as usize);
        neighbours.zip(self.conductances[range].iter().rev().copied())
    }

    /// Each bond once: two elements and the conductance.
    pub(super) fn bonds(&self) -> impl Iterator<Item = (usize, usize, f64)> + '_ {
        let of = |a: usize| self.bonds_of(a).filter(move |(b, _)| a < *b).map(move |(b, bond)| (a, b, bond));
        (0..self.len()).flat_map(of)
    }

    /// Writes `right` minus the flow that leaves each element under `x`.
    pub(super) fn residual(&self, x: &[f64], right: &[f64], out: &mut [f64]) {
        for_blocks(out, &|start, out| {
            for (i, out) in (start..).zip(out) {
                *out = right[i] + self.bonds_of(i).map(|(j, bond)| bond * (x[j] - x[i])).sum::<f64>();
            }
        });
    }

    /// Writes the flow that leaves each element under `x`.
    pub(super) fn draw(&self, x: &[f64], out: &mut [f64]) {
        for_blocks(out, &|start, out| {
            for (i, out) in (start..).zip(out) {
                *out = self.bonds_of(i).map(|(j, bond)| bond * (x[i] - x[j])).sum();
            }
        });
    }

    /// Relaxes each element once, in order, starting from zero.
    ///
    /// The blocks are independent of each other.
    pub(super) fn relax(&self, right: &[f64], x: &mut [f64]) {
        for_blocks(x, &|start, x| {
            for k in 0..x.len() {
                let done = self.bonds_of(start + k).take_while(|(j, _)| *j < start + k);
                let flow =
                    done.filter(|(j, _)| *j >= start).fold(right[start + k], |flow, (j, b)| flow + b * x[j - start]);
                x[k] = flow * self.inverse[start + k];
            }
        });
    }

    /// Writes the residual of [`Graph::relax`] for `right`, of which `x` is the result.
    ///
    /// Elements before an element in its block are balanced with it, so it reads only those after it, and other blocks.
    pub(super) fn residual_of_relaxed(&self, x: &[f64], out: &mut [f64]) {
        for_blocks(out, &|start, out| {
            let end = start + out.len();
            for (i, out) in (start..).zip(out) {
                let before =
                    self.bonds_of(i).take_while(|(j, _)| *j < start).map(|(j, bond)| bond * x[j] + bond.abs() * x[i]);
                let after = self.bonds_back(i).take_while(|(j, _)| *j > i);
                let after = after.map(|(j, bond)| bond * x[j] + if j >= end { bond.abs() * x[i] } else { 0.0 });
                *out = before.sum::<f64>() + after.sum::<f64>();
            }
        });
    }

    /// The adjoint of [`Graph::relax`].
    pub(super) fn relax_back(&self, right: &[f64], x: &mut [f64]) {
        for_blocks(x, &|start, x| {
            let end = start + x.len();
            for k in (0..x.len()).rev() {
                let done = self.bonds_back(start + k).take_while(|(j, _)| *j > start + k);
                let flow =
                    done.filter(|(j, _)| *j < end).fold(right[start + k], |flow, (j, b)| flow + b * x[j - start]);
                x[k] = flow * self.inverse[start + k];
            }
        });
    }
}

/// Calls `work` with each block of `values`, and the index of its first element.
fn for_blocks(values: &mut [f64], work: &(dyn Fn(usize, &mut [f64]) + Sync)) {
    let blocks = values.chunks_mut(BLOCK).enumerate().collect();
    parallel::for_each(blocks, |(block, values): (usize, &mut [f64])| work(block * BLOCK, values));
}

#[cfg(test)]
mod tests {
    use rc_core::testing::quasi_random;

    use super::*;

    /// Bonds 0-1, 1-3, 3-2 and a negative bond 0-2.
    ///
    /// Elements 0 and 1 are in one block, 2 and 3 in the next. The path around conducts 0.4975, so that the network
    /// dissipates under any pressure.
    #[test]
    fn relaxation_takes_energy_off_across_a_negative_bond_between_blocks() {
        let places = [0, 1, BLOCK, BLOCK + 1];
        let bonds = [(0, 1, 1.0), (1, 3, 100.0), (3, 2, 1.0), (0, 2, -0.45)];
        let graph = Graph::new(BLOCK + 2, &|element, out| {
            for (a, b, bond) in bonds.map(|(a, b, bond)| (places[a], places[b], bond)) {
                let other = if element == a { Some(b) } else { (element == b).then_some(a) };
                out.extend(other.map(|other| (other as u32, bond)));
            }
        });
        let n = graph.len();
        let [mut x, mut drawn, mut step] = [(); 3].map(|()| vec![0.0; n]);
        x[0] = 1.0;
        let energy = |x: &[f64], drawn: &mut [f64]| -> f64 {
            graph.draw(x, drawn);
            x.iter().zip(drawn).map(|(x, drawn)| x * *drawn).sum()
        };
        let mut before = energy(&x, &mut drawn);
        for sweep in 0..20 {
            let right: Vec<f64> = drawn.iter().map(|drawn| -drawn).collect();
            let relax = if sweep % 2 == 0 { Graph::relax } else { Graph::relax_back };
            relax(&graph, &right, &mut step);
            x.iter_mut().zip(&step).for_each(|(x, step)| *x += step);
            let after = energy(&x, &mut drawn);
            assert!(after < before, "sweep {sweep}: energy {after:e} after {before:e}");
            before = after;
        }
    }

    /// Random bonds of both signs, also between blocks.
    #[test]
    fn the_residual_after_relaxation_needs_only_later_elements_and_other_blocks() {
        let n = BLOCK + 300;
        let random = |i: usize| quasi_random(7919 * (i + 1));
        let graph = Graph::new(n, &|element, out| {
            for distance in [1, 17, BLOCK - 100] {
                for (first, other) in [(element, element + distance), (element + n - distance, element + n - distance)]
                {
                    out.push(((other % n) as u32, 1.0 + random(first % n + n * distance) - 0.1 * random(distance)));
                }
            }
        });
        let right: Vec<f64> = (0..n).map(|i| random(3 * n + i) - 0.5).collect();
        let [mut x, mut expected, mut found] = [(); 3].map(|()| vec![0.0; n]);
        graph.relax(&right, &mut x);
        graph.residual(&x, &right, &mut expected);
        graph.residual_of_relaxed(&x, &mut found);
        let off = expected.iter().zip(&found).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off < 1e-13, "{off:e}");
    }
}
