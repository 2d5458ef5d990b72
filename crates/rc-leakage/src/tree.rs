//! A spanning tree of the strongest bonds, along which unbalanced flow is balanced.
//!
//! Of all paths between two elements, the path in the tree has the strongest weakest bond. So imbalances within a wide
//! place are balanced there.

use rc_core::Grid;

use crate::network::Network;
use crate::parallel;
use crate::pools::{Pools, Saddle};
use crate::step::{Step, Strength};

/// The tree of each cluster.
#[derive(Debug)]
pub(crate) struct SpanningTree {
    grid: Grid,
    /// Step from each element to its parent.
    steps: Vec<Step>,
}

/// Count of children that marks an element as visited.
const DONE: u8 = u8::MAX;

impl SpanningTree {
    /// The maximum spanning tree of each cluster of `network`.
    ///
    /// It takes Borůvka's first round, and then Kruskal's algorithm on the trees of that round.
    pub(crate) fn new(network: &Network) -> Self {
        let mut tree = Self { grid: network.grid(), steps: strongest(network) };
        tree.break_pairs();
        for Saddle { from, step } in Pools::new(tree.grid, &tree.steps).join(network) {
            tree.hang(from, step);
        }
        tree
    }

    pub(crate) fn steps(&self) -> &[Step] {
        &self.steps
    }

    /// Makes one of two elements a root if they are each other's parents.
    ///
    /// It is the first of the two.
    fn break_pairs(&mut self) {
        for index in 0..self.steps.len() {
            let step = self.steps[index];
            if step != Step::None {
                let parent = step.from(index, self.grid);
                // Two neighbours may have two bonds. Only steps along one bond count.
                if self.steps[parent] == step.back() {
                    self.steps[index] = Step::None;
                }
            }
        }
    }

    /// Makes element `from` the root of its tree, and then a child of its neighbour.
    fn hang(&mut self, from: usize, to: Step) {
        let (mut at, mut next) = (from, to);
        while next != Step::None {
            let old = std::mem::replace(&mut self.steps[at], next);
            at = old.from(at, self.grid);
            next = old.back();
        }
    }

    /// Replaces the excess of each element by the flow from it to its parent.
    ///
    /// Every element passes its excess on.
    pub(crate) fn route(&self, excess: &mut [f64]) {
        let mut children = vec![0_u8; self.steps.len()];
        for (index, step) in self.steps.iter().enumerate().filter(|(_, step)| **step != Step::None) {
            children[step.from(index, self.grid)] += 1;
        }
        for start in 0..self.steps.len() {
            let mut at = start;
            while children[at] == 0 {
                children[at] = DONE;
                let step = self.steps[at];
                if step == Step::None {
                    break;
                }
                let parent = step.from(at, self.grid);
                excess[parent] += excess[at];
                children[parent] -= 1;
                at = parent;
            }
        }
    }
}

/// The step along the strongest bond of each element.
fn strongest(network: &Network) -> Vec<Step> {
    let (nx, ny) = (network.grid().nx(), network.grid().ny());
    let mut steps = vec![Step::None; network.grid().len()];
    let block = parallel::rows_per_block(nx) * nx;
    let blocks = steps.chunks_mut(block).zip(network.blocks()).collect();
    parallel::for_each(blocks, |(steps, rows): (&mut [Step], [usize; 2])| {
        let mut bonds = [vec![0.0; nx], vec![0.0; nx], vec![0.0; nx]];
        let [east, north, south] = &mut bonds;
        network.write_conductances((rows[0] + ny - 1) % ny, east, south);
        for (iy, steps) in (rows[0]..rows[1]).zip(steps.chunks_mut(nx)) {
            network.write_conductances(iy, east, north);
            let below = (iy + ny - 1) % ny * nx;
            for (ix, out) in steps.iter_mut().enumerate() {
                let before = if ix == 0 { nx - 1 } else { ix - 1 };
                let (here, first) = (iy * nx + ix, iy * nx);
                let choices = [
                    (Step::East, Strength::new(east[ix], here, 0)),
                    (Step::West, Strength::new(east[before], first + before, 0)),
                    (Step::North, Strength::new(north[ix], here, 1)),
                    (Step::South, Strength::new(south[ix], below + ix, 1)),
                ];
                let mut best = (Step::None, Strength::NONE);
                for choice in choices {
                    if choice.1.is_bond() && choice.1 > best.1 {
                        best = choice;
                    }
                }
                *out = best.0;
            }
            std::mem::swap(north, south);
        }
    });
    steps
}

#[cfg(test)]
mod tests {
    use rc_core::testing::quasi_random;
    use rc_core::{Field, Grid};

    use super::*;

    fn network(nx: usize, ny: usize, walls: f64) -> Network {
        let grid = Grid::new(nx, ny).expect("a grid");
        let of =
            |i: usize| if quasi_random(7919 * (i + 1)) < walls { 0.0 } else { 0.1 + quasi_random(104_729 * (i + 1)) };
        let gap = Field::new(grid, (0..grid.len()).map(of).collect()).expect("a field");
        Network::new(&gap, f64::INFINITY, &|iy, open: &mut [bool]| {
            open.iter_mut().zip(gap.row(iy)).for_each(|(open, gap)| *open = *gap > 0.0);
        })
    }

    /// Number of bonds and their product, from Kruskal's algorithm.
    ///
    /// Labels are rewritten at each bond.
    fn kruskal(network: &Network) -> (usize, f64) {
        let n = network.grid().len();
        let of = |a: usize| network.bonds_of(a).into_iter().map(move |(b, bond)| (a, b, bond));
        let mut bonds: Vec<_> = (0..n).flat_map(of).filter(|(_, _, bond)| *bond > 0.0).collect();
        bonds.sort_by(|a, b| b.2.total_cmp(&a.2));
        let mut labels: Vec<usize> = (0..n).collect();
        bonds.into_iter().fold((0, 0.0), |(number, sum), (a, b, bond)| {
            let [from, to] = [labels[a], labels[b]];
            if from == to {
                return (number, sum);
            }
            labels.iter_mut().filter(|label| **label == from).for_each(|label| *label = to);
            (number + 1, sum + bond.ln())
        })
    }

    #[test]
    fn the_tree_is_that_of_kruskal() {
        for (nx, ny, walls) in [(17, 13, 0.0), (17, 13, 0.35), (24, 2, 0.1), (1, 9, 0.0), (40, 31, 0.5)] {
            let network = network(nx, ny, walls);
            let tree = SpanningTree::new(&network);
            let bonds: Vec<f64> = (0..nx * ny)
                .filter(|&i| tree.steps[i] != Step::None)
                .map(|i| {
                    let all = [Step::East, Step::West, Step::North, Step::South];
                    let which = all.iter().position(|step| *step == tree.steps[i]).expect("a direction");
                    network.bonds_of(i)[which].1.ln()
                })
                .collect();
            let (number, sum) = kruskal(&network);
            assert_eq!(bonds.len(), number, "{nx} x {ny}");
            assert!((bonds.iter().sum::<f64>() - sum).abs() < 1e-9, "{nx} x {ny}: {bonds:?}");
        }
    }

    #[test]
    fn what_is_routed_balances_every_element_but_the_roots() {
        let network = network(23, 19, 0.3);
        let tree = SpanningTree::new(&network);
        let excess: Vec<f64> = (0..23 * 19).map(|i| quasi_random(31 * i) - 0.5).collect();
        let mut flow = excess.clone();
        tree.route(&mut flow);
        let mut left = excess;
        for (i, step) in tree.steps.iter().enumerate().filter(|(_, step)| **step != Step::None) {
            left[i] -= flow[i];
            left[step.from(i, tree.grid)] += flow[i];
        }
        let unbalanced = left.iter().zip(&tree.steps).filter(|(left, step)| **step != Step::None && left.abs() > 1e-12);
        assert_eq!(unbalanced.count(), 0);
    }
}
