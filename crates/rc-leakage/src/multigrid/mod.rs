//! A multigrid cycle, which approximates the inverse of the network.

mod coarsen;
mod interpolation;
mod stencil;

use self::coarsen::coarsen;
use self::interpolation::{Bonds, Interpolation};
use self::stencil::{Order, Stencil};
use crate::aggregation::{Aggregation, Graph};
use crate::network::Network;
use crate::parallel;
use crate::preconditioner::Preconditioner;
use crate::real::Real;

/// Number of elements that is small enough for elimination.
const COARSEST: usize = 256;

/// Number of coarser grids. Aggregates take over what these do not resolve.
const GRIDS: usize = 3;

/// Ratio of an element's sides above which only the shorter side is coarsened.
const LONGEST: f64 = 2.0;

/// All levels of a network.
#[derive(Debug)]
pub(crate) struct Multigrid<T> {
    /// The levels, finest first.
    levels: Vec<Level<T>>,
    coarsest: Aggregation,
}

#[derive(Debug)]
struct Level<T> {
    stencil: Stencil<T>,
    /// Interpolation from the next coarser level; `None` on the coarsest.
    interpolation: Option<Interpolation<T>>,
    x: Vec<T>,
    right: Vec<T>,
}

impl<T: Real> Level<T> {
    fn new(stencil: Stencil<T>) -> Self {
        let n = stencil.nx * stencil.ny;
        Self { stencil, interpolation: None, x: vec![T::ZERO; n], right: vec![T::ZERO; n] }
    }
}

impl<T: Real> Multigrid<T> {
    pub(crate) fn new(network: &Network) -> Self {
        let mut sides = network.grid().spacing();
        let mut levels = vec![Level::new(finest(network))];
        loop {
            let is_last = levels.len() > GRIDS;
            let Some(level) = levels.last_mut() else { unreachable!("there is a finest level") };
            let (nx, ny) = (level.stencil.nx, level.stencil.ny);
            if nx * ny <= COARSEST || is_last {
                break;
            }
            let halve_x = nx > 2 && (sides.x <= LONGEST * sides.y || ny <= 2);
            let halve_y = ny > 2 && (sides.y <= LONGEST * sides.x || nx <= 2);
            let factor = [halve_x, halve_y].map(|halve| if halve { 2 } else { 1 });
            sides.x *= factor[0] as f64;
            sides.y *= factor[1] as f64;
            let interpolation = Interpolation::new(&level.stencil, factor);
            let coarse = coarsen(&level.stencil, &interpolation);
            level.interpolation = Some(interpolation);
            levels.push(Level::new(coarse));
        }
        let coarsest = Aggregation::new(graph_of(&levels[levels.len() - 1].stencil));
        Self { levels, coarsest }
    }

    /// The pressure between those of every second element, `half`, without the mean `fall` per element.
    ///
    /// `half` is without the fall of its own grid, whose elements are twice as far apart. `None` if the next coarser
    /// level does not have every second element along both axes.
    pub(crate) fn pressure_between(&self, half: &[f64], fall: [f64; 2]) -> Option<Vec<f64>> {
        let interpolation = self.levels[0].interpolation.as_ref()?;
        let [nx, ny] = interpolation.coarse;
        (interpolation.factor == [2, 2] && nx * ny == half.len()).then(|| interpolation.pressure_between(half, fall))
    }
}

impl<T: Real> Preconditioner for Multigrid<T> {
    type Value = T;

    fn right_mut(&mut self) -> &mut [T] {
        &mut self.levels[0].right
    }

    fn apply(&mut self) -> &[T] {
        cycle(&mut self.levels, &mut self.coarsest);
        &self.levels[0].x
    }

    fn draw(&self, _: &Network, x: &[T], iy: usize, out: &mut [f64]) {
        self.levels[0].stencil.draw_finest(x, iy, out);
    }
}

/// The finest level, which is the network with its bonds across faces.
fn finest<T: Real>(network: &Network) -> Stencil<T> {
    let (nx, ny) = (network.grid().nx(), network.grid().ny());
    let (mut east, mut north) = (vec![T::ZERO; nx * ny], vec![T::ZERO; nx * ny]);
    let rows = east.chunks_mut(nx).zip(north.chunks_mut(nx)).enumerate().collect();
    parallel::for_each(rows, |(iy, (east, north)): (usize, (&mut [T], &mut [T]))| {
        network.write_conductances(iy, east, north);
    });
    let mut stencil = Stencil { nx, ny, east, north, corners: None, inverse: Vec::new() };
    stencil.invert_totals();
    stencil
}

fn graph_of<T: Real>(stencil: &Stencil<T>) -> Graph {
    let bonds = Bonds(stencil);
    let (nx, ny) = (stencil.nx, stencil.ny);
    Graph::new(nx * ny, &|element, out| {
        let (x, y) = (element % nx, element / nx);
        let (before, below) = (x + nx - 1, y + ny - 1);
        let all = [
            ([x + 1, y], bonds.east(x, y)),
            ([before, y], bonds.east(before, y)),
            ([x, y + 1], bonds.north(x, y)),
            ([x, below], bonds.north(x, below)),
            ([x + 1, y + 1], bonds.rising(x, y)),
            ([before, below], bonds.rising(before, below)),
            ([before, y + 1], bonds.falling(before, y)),
            ([x + 1, below], bonds.falling(x, below)),
        ];
        let all = all.map(|([x, y], bond)| (bonds.index(x, y), bond.to_f64()));
        let others = all.into_iter().filter(|(other, bond)| *other != element && *bond != 0.0);
        out.extend(others.map(|(other, bond)| (other as u32, bond)));
    })
}

fn cycle<T: Real>(levels: &mut [Level<T>], coarsest: &mut Aggregation) {
    let Some((level, coarser)) = levels.split_first_mut() else { return };
    let Level { stencil, interpolation, x, right } = level;
    let Some(interpolation) = interpolation else {
        coarsest.right_mut().iter_mut().zip(right).for_each(|(out, right)| *out = right.to_f64());
        x.iter_mut().zip(coarsest.solve()).for_each(|(x, value)| *x = T::of(*value));
        return;
    };
    x.fill(T::ZERO);
    stencil.relax(x, right, Order::Forward);
    interpolation.restrict(&|iy, out| stencil.residual(x, right, iy, out), &mut coarser[0].right);
    cycle(coarser, coarsest);
    interpolation.prolong(&coarser[0].x, x);
    stencil.relax(x, right, Order::Backward);
}

#[cfg(test)]
mod tests {
    use rc_core::testing::quasi_random;
    use rc_core::{Field, Grid};

    use super::*;

    /// The columns of the cycle as a matrix.
    fn columns(nx: usize, ny: usize, walls: f64, decades: f64) -> Vec<Vec<f64>> {
        let grid = Grid::new(nx, ny).expect("a grid");
        let random = |i: usize| quasi_random(7919 * (i + 1));
        let gap = (0..grid.len())
            .map(|i| if random(i) < walls { 0.0 } else { 10.0_f64.powf(-decades / 3.0 * random(i + grid.len())) });
        let gap = Field::new(grid, gap.collect()).expect("a value for each element");
        let network = Network::new(&gap, f64::INFINITY, &|iy, open: &mut [bool]| {
            open.iter_mut().zip(gap.row(iy)).for_each(|(open, gap)| *open = *gap > 0.0);
        });
        let mut multigrid = Multigrid::<f64>::new(&network);
        let unit = |i: usize| {
            multigrid.right_mut().fill(0.0);
            multigrid.right_mut()[i] = 1.0;
            multigrid.apply().to_vec()
        };
        // Walls do not have a residual.
        let (is_open, columns) = (|i: usize| gap.values()[i] > 0.0, (0..grid.len()).map(unit));
        let open = |column: Vec<f64>| (0..grid.len()).filter(|&i| is_open(i)).map(|i| column[i]).collect();
        let columns: Vec<Vec<f64>> = columns.map(open).collect();
        columns.into_iter().enumerate().filter(|(i, _)| is_open(*i)).map(|(_, column)| column).collect()
    }

    /// The cycle is symmetric and positive, as conjugate gradients need.
    ///
    /// On odd sides, there are neighbours of one colour.
    #[test]
    fn the_cycle_is_symmetric_and_positive() {
        for (nx, ny, walls, decades) in
            [(40, 41, 0.3, 1.0), (24, 24, 0.3, 9.0), (25, 19, 0.3, 1.0), (70, 8, 0.1, 2.0), (3, 150, 0.0, 1.0)]
        {
            let columns = columns(nx, ny, walls, decades);
            let largest = (0..columns.len()).map(|i| columns[i][i]).fold(0.0, f64::max);
            for (i, column) in columns.iter().enumerate() {
                assert!(column[i] >= 0.0, "{nx} x {ny}: {} on the diagonal", column[i]);
                for (j, value) in column.iter().enumerate().take(i) {
                    let off = (value - columns[j][i]).abs();
                    assert!(off <= 1e-12 * largest, "{nx} x {ny}, elements {i} and {j}: {off:e} of {largest:e}");
                }
            }
        }
    }
}
