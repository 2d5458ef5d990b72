//! A spanning tree of the strongest bonds, along which what a pressure leaves unbalanced flows to where it is missing.
//!
//! The path of the tree between two elements has the largest weakest bond of all paths, so that what is unbalanced within a wide place stays there.

use rc_core::Grid;

use crate::network::Network;
use crate::parallel;
use crate::pools::{Pools, Saddle};
use crate::step::{Step, Strength};

/// The tree of each cluster.
#[derive(Debug)]
pub(crate) struct SpanningTree {
    grid: Grid,
    /// To the parent of each element.
    steps: Vec<Step>,
}

/// Children of an element that has been visited.
const DONE: u8 = u8::MAX;

impl SpanningTree {
    /// The maximum spanning tree of each cluster of `network`, by Borůvka's first round and Kruskal's algorithm on what it leaves.
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

    /// Of two elements that are the parents of each other, the first becomes a root.
    fn break_pairs(&mut self) {
        for index in 0..self.steps.len() {
            let step = self.steps[index];
            if step != Step::None {
                let parent = step.from(index, self.grid);
                // Between two neighbours that have two bonds, only those that are one bond.
                if self.steps[parent] == step.back() {
                    self.steps[index] = Step::None;
                }
            }
        }
    }

    /// Makes element `from` the root of its tree, and hangs it on its neighbour.
    fn hang(&mut self, from: usize, to: Step) {
        let (mut at, mut next) = (from, to);
        while next != Step::None {
            let old = std::mem::replace(&mut self.steps[at], next);
            at = old.from(at, self.grid);
            next = old.back();
        }
    }

    /// Replaces the excess of each element by what flows from it to its parent when every element passes its excess on.
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
