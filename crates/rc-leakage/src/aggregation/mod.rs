//! Multigrid on aggregates of strongly bound elements.
//!
//! It is for networks that coarser grids do not represent: films that are connected by a few elements.
//!
//! An aggregate is a pair of pairs (Notay, Electron. Trans. Numer. Anal. 37, 2010; Napov and Notay, SIAM J. Sci.
//! Comput. 34, 2012). The coarser network is the one for pressures that are constant on each aggregate. It is solved by
//! two steps of conjugate gradients with its own cycle as preconditioner. Bonds of coarser levels are sums of bonds, so
//! nothing cancels for any ratio of conductances.

mod aggregates;
mod graph;
mod pairs;

use self::aggregates::ALONE;
use self::graph::BLOCK;
pub(crate) use self::graph::Graph;
use crate::elimination::Elimination;
use crate::flow_state::FlowState;
use crate::network::Network;
use crate::parallel;
use crate::preconditioner::Preconditioner;

/// Number of elements that is small enough for elimination.
const COARSEST: usize = 256;

/// Maximum number of elements of a last level that is eliminated.
const ELIMINATED: usize = 4096;

/// Ratio of aggregates to elements above which coarsening ends.
const STALLED: f64 = 0.9;

/// All levels of a network.
#[derive(Debug)]
pub(crate) struct Aggregation {
    /// The levels, finest first.
    levels: Vec<Level>,
    /// Elimination of the last level; `None` if it has too many elements and is relaxed.
    last: Option<Elimination>,
}

#[derive(Debug)]
struct Level {
    graph: Graph,
    /// Aggregate of each element, or [`ALONE`]; empty on the last level.
    aggregates: Vec<u32>,
    right: Vec<f64>,
    x: Vec<f64>,
    residual: Vec<f64>,
    /// The first of two steps. The flow that leaves under it follows, which is also scratch space of the cycle.
    first: Vec<f64>,
    drawn: Vec<f64>,
}

impl Level {
    fn new(graph: Graph) -> Self {
        let [right, x, residual, first, drawn] = [(); 5].map(|()| vec![0.0; graph.len()]);
        Self { graph, aggregates: Vec::new(), right, x, residual, first, drawn }
    }
}

impl Aggregation {
    pub(crate) fn new(network: Graph) -> Self {
        let mut levels = vec![Level::new(network)];
        loop {
            let Some(level) = levels.last_mut() else { unreachable!("there is a finest level") };
            if level.graph.len() <= COARSEST {
                break;
            }
            let first = pairs::matched(&level.graph, &level.graph.totals);
            let middle = level.graph.coarse(&first);
            let second = pairs::matched(&middle, &first.sums(&level.graph.totals));
            let coarse = middle.coarse(&second);
            if coarse.len() as f64 > STALLED * first.of.iter().filter(|aggregate| **aggregate != ALONE).count() as f64 {
                break;
            }
            let of = |first: &u32| second.of.get(*first as usize).copied().unwrap_or(ALONE);
            level.aggregates = first.of.iter().map(of).collect();
            levels.push(Level::new(coarse));
        }
        let graph = &levels[levels.len() - 1].graph;
        let last = (graph.len() <= ELIMINATED).then(|| Elimination::new(graph.len(), graph.bonds()));
        Self { levels, last }
    }
}

impl Aggregation {
    /// Approximates the solution for the right side, better than one application does.
    pub(crate) fn solve(&mut self) -> &[f64] {
        solve(&mut self.levels, self.last.as_ref());
        &self.levels[0].x
    }
}

impl Preconditioner for Aggregation {
    type Value = f64;

    fn right_mut(&mut self) -> &mut [f64] {
        &mut self.levels[0].right
    }

    fn apply(&mut self) -> &[f64] {
        cycle(&mut self.levels, self.last.as_ref());
        &self.levels[0].x
    }

    fn draw(&self, network: &Network, x: &[f64], iy: usize, out: &mut [f64]) {
        FlowState::of(network, x, [0.0; 2]).visit([iy, iy + 1], &mut |row| row.write_outflow(out));
    }
}

/// Applies one cycle to the right side of the first level.
fn cycle(levels: &mut [Level], last: Option<&Elimination>) {
    let Some((level, coarser)) = levels.split_first_mut() else { return };
    let Level { graph, aggregates, right, x, residual, drawn, .. } = level;
    let Some(next) = coarser.first_mut() else {
        match last {
            Some(last) => last.solve(right, x),
            None => graph.relax(right, x),
        }
        return;
    };
    graph.relax(right, x);
    graph.residual_of_relaxed(x, residual);
    next.right.fill(0.0);
    for (residual, aggregate) in residual.iter().zip(aggregates.iter()).filter(|(_, aggregate)| **aggregate != ALONE) {
        next.right[*aggregate as usize] += residual;
    }
    solve(coarser, last);
    let coarse = &coarser[0].x;
    let blocks = x.chunks_mut(BLOCK).zip(aggregates.chunks(BLOCK)).collect();
    parallel::for_each(blocks, |(x, aggregates): (&mut [f64], &[u32])| {
        let pairs = x.iter_mut().zip(aggregates).filter(|(_, aggregate)| **aggregate != ALONE);
        pairs.for_each(|(x, aggregate)| *x += coarse[*aggregate as usize]);
    });
    graph.residual(x, right, residual);
    graph.relax_back(residual, drawn);
    add(x, 1.0, drawn);
}

/// Solves the first level by two steps of conjugate gradients.
///
/// If it is the last level, one cycle solves it.
fn solve(levels: &mut [Level], last: Option<&Elimination>) {
    cycle(levels, last);
    if levels.len() == 1 {
        return;
    }
    let level = &mut levels[0];
    std::mem::swap(&mut level.x, &mut level.first);
    level.graph.draw(&level.first, &mut level.residual);
    let (slope, curvature) = (dot(&level.first, &level.right), dot(&level.first, &level.residual));
    if !(slope > 0.0 && curvature > 0.0) {
        level.x.copy_from_slice(&level.first);
        return;
    }
    let length = slope / curvature;
    scale(&mut level.first, length);
    add(&mut level.right, -length, &level.residual);
    cycle(levels, last);
    let Level { graph, right, x, residual, first, .. } = &mut levels[0];
    // The second direction is made conjugate to the first.
    graph.draw(x, residual);
    let along = dot(first, residual) / (length * slope);
    let (slope, curvature) = (dot(x, right), dot(x, residual) - along * dot(first, residual));
    let length = if slope > 0.0 && curvature > 0.0 { slope / curvature } else { 0.0 };
    scale(x, length);
    add(x, 1.0 - along * length, first);
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    let blocks = a.chunks(BLOCK).zip(b.chunks(BLOCK)).collect();
    parallel::sum(blocks, |(a, b): (&[f64], &[f64])| a.iter().zip(b).map(|(a, b)| a * b).sum())
}

/// Adds `factor` times `b` to `a`.
fn add(a: &mut [f64], factor: f64, b: &[f64]) {
    let blocks = a.chunks_mut(BLOCK).zip(b.chunks(BLOCK)).collect();
    parallel::for_each(blocks, |(a, b): (&mut [f64], &[f64])| a.iter_mut().zip(b).for_each(|(a, b)| *a += factor * b));
}

fn scale(a: &mut [f64], factor: f64) {
    parallel::for_each(a.chunks_mut(BLOCK).collect(), |a: &mut [f64]| a.iter_mut().for_each(|a| *a *= factor));
}

#[cfg(test)]
mod tests {
    use rc_core::testing::quasi_random;

    use super::*;

    /// Two conjugate steps leave a residual that is orthogonal to their sum.
    #[test]
    fn both_steps_of_a_solve_are_conjugate() {
        let side = 60;
        let n = side * side;
        let conductance = |a: usize, axis: usize| 10.0_f64.powf(-3.0 * quasi_random(7919 * (2 * a + axis + 1)));
        let graph = || {
            Graph::new(n, &|i, out| {
                let (x, y) = (i % side, i / side);
                let neighbour = |x: usize, y: usize| y % side * side + x % side;
                let [west, south] = [neighbour(x + side - 1, y), neighbour(x, y + side - 1)];
                let all = [
                    (neighbour(x + 1, y), conductance(i, 0)),
                    (neighbour(x, y + 1), conductance(i, 1)),
                    (west, conductance(west, 0)),
                    (south, conductance(south, 1)),
                ];
                out.extend(all.map(|(other, bond)| (other as u32, bond)));
            })
        };
        let mut aggregation = Aggregation::new(graph());
        // Each element has its source, and the next one the same sink.
        let source = |i: usize| quasi_random(31 * (i % n) + 5);
        let right: Vec<f64> = (0..n).map(|i| source(i + 1) - source(i)).collect();
        aggregation.right_mut().copy_from_slice(&right);
        let x = aggregation.solve().to_vec();
        let mut drawn = vec![0.0; n];
        graph().draw(&x, &mut drawn);
        let (work, energy) = (dot(&x, &right), dot(&x, &drawn));
        assert!(work > 0.0 && (work - energy).abs() < 1e-10 * work, "{work:e}, {energy:e}");
    }
}
