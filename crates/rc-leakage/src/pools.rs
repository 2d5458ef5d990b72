//! Pools of elements, and the bonds that join them.
//!
//! A pool is a tree of the strongest bonds of its elements.

use rc_core::Grid;

use crate::network::Network;
use crate::parallel;
use crate::step::{Step, Strength};

/// Pools of a forest that is not yet a tree per cluster.
pub(crate) struct Pools {
    grid: Grid,
    /// Pool of each element.
    labels: Vec<u32>,
    number: usize,
}

/// A bond that connects a pool to its parent pool.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Saddle {
    /// Element in the pool.
    pub(crate) from: usize,
    /// Step from this element to the element in the parent pool.
    pub(crate) step: Step,
}

/// A bond between two pools.
#[derive(Clone, Copy)]
struct Bond {
    strength: Strength,
    saddle: Saddle,
}

/// Label of an element without a pool.
const UNKNOWN: u32 = u32::MAX;

impl Pools {
    /// The pools of the trees in which `steps` lead to parents.
    pub(crate) fn new(grid: Grid, steps: &[Step]) -> Self {
        let mut labels = vec![UNKNOWN; steps.len()];
        let mut number = 0;
        for start in 0..labels.len() {
            let mut at = start;
            while labels[at] == UNKNOWN && steps[at] != Step::None {
                at = steps[at].from(at, grid);
            }
            let label = if labels[at] == UNKNOWN {
                number += 1;
                number - 1
            } else {
                labels[at]
            };
            let end = at;
            at = start;
            while at != end {
                labels[at] = label;
                at = steps[at].from(at, grid);
            }
            labels[end] = label;
        }
        Self { grid, labels, number: number as usize }
    }

    /// The bonds that join the pools of each cluster into one tree.
    ///
    /// The parent of a pool comes before the pool.
    pub(crate) fn join(&self, network: &Network) -> Vec<Saddle> {
        let mut bonds = self.bonds(network);
        bonds.sort_unstable_by(|a, b| b.strength.cmp(&a.strength));
        let mut sets: Vec<u32> = (0..self.number as u32).collect();
        let mut chosen: Vec<[(u32, Saddle); 2]> = Vec::new();
        for Bond { saddle, .. } in bonds {
            let other = saddle.step.from(saddle.from, self.grid);
            let [a, b] = [saddle.from, other].map(|index| self.labels[index]);
            let [root_a, root_b] = [a, b].map(|label| root(&mut sets, label));
            if root_a != root_b {
                sets[root_b as usize] = root_a;
                let back = Saddle { from: other, step: saddle.step.back() };
                chosen.push([(b, saddle), (a, back)]);
            }
        }
        self.in_order(&chosen)
    }

    /// All bonds between two pools.
    fn bonds(&self, network: &Network) -> Vec<Bond> {
        let grid = network.grid();
        let (nx, ny) = (grid.nx(), grid.ny());
        let blocks = parallel::map(network.blocks(), |rows| {
            let (mut east, mut north, mut out) = (vec![0.0; nx], vec![0.0; nx], Vec::new());
            for iy in rows[0]..rows[1] {
                network.write_conductances(iy, &mut east, &mut north);
                let above = (iy + 1) % ny * nx;
                for ix in 0..nx {
                    let here = iy * nx + ix;
                    let next = [if ix + 1 < nx { here + 1 } else { iy * nx }, above + ix];
                    for (axis, (step, conductance)) in
                        [(Step::East, east[ix]), (Step::North, north[ix])].into_iter().enumerate()
                    {
                        if conductance > 0.0 && self.labels[here] != self.labels[next[axis]] {
                            let strength = Strength::new(conductance, here, axis);
                            out.push(Bond { strength, saddle: Saddle { from: here, step } });
                        }
                    }
                }
            }
            out
        });
        blocks.concat()
    }

    /// The chosen bonds, ordered from the first pool of each cluster outwards.
    ///
    /// Each bond is given from both sides, with the pool on the other side.
    fn in_order(&self, chosen: &[[(u32, Saddle); 2]]) -> Vec<Saddle> {
        let of = |saddle: &Saddle| self.labels[saddle.from] as usize;
        let mut first = vec![0_u32; self.number + 1];
        for (_, saddle) in chosen.iter().flatten() {
            first[of(saddle) + 1] += 1;
        }
        for pool in 0..self.number {
            first[pool + 1] += first[pool];
        }
        let mut next = first.clone();
        let mut links = vec![0_u32; 2 * chosen.len()];
        for (index, (_, saddle)) in chosen.iter().flatten().enumerate() {
            let slot = &mut next[of(saddle)];
            links[*slot as usize] = index as u32;
            *slot += 1;
        }
        let (mut order, mut is_reached, mut waiting) =
            (Vec::with_capacity(chosen.len()), vec![false; self.number], Vec::new());
        for start in 0..self.number {
            if !is_reached[start] {
                is_reached[start] = true;
                waiting.push(start);
            }
            while let Some(pool) = waiting.pop() {
                for &link in &links[first[pool] as usize..first[pool + 1] as usize] {
                    let [here, there] = [link as usize, link as usize ^ 1].map(|link| chosen[link / 2][link % 2]);
                    let other = here.0 as usize;
                    if !is_reached[other] {
                        is_reached[other] = true;
                        order.push(there.1);
                        waiting.push(other);
                    }
                }
            }
        }
        order
    }
}

/// The root of the set of a pool.
fn root(sets: &mut [u32], pool: u32) -> u32 {
    let mut at = pool;
    while sets[at as usize] != at {
        let next = sets[at as usize];
        sets[at as usize] = sets[next as usize];
        at = next;
    }
    at
}
