//! A multigrid cycle in single precision, which approximates the inverse of the network.

mod coarsen;
mod coarsest;
mod interpolation;
mod stencil;

use self::coarsen::coarsen;
use self::coarsest::Coarsest;
use self::interpolation::Interpolation;
use self::stencil::{Order, Stencil};
use crate::network::Network;
use crate::parallel;

/// Elements that are few enough for elimination.
const COARSEST: usize = 256;

/// Elements with sides of more than this ratio are coarsened along the shorter one only.
const LONGEST: f64 = 2.0;

/// All levels of a network.
#[derive(Debug)]
pub(crate) struct Multigrid {
    /// Finest first.
    levels: Vec<Level>,
    coarsest: Coarsest,
}

#[derive(Debug)]
struct Level {
    stencil: Stencil,
    /// To the next coarser level; `None` on the coarsest.
    interpolation: Option<Interpolation>,
    x: Vec<f32>,
    right: Vec<f32>,
}

impl Level {
    fn new(stencil: Stencil) -> Self {
        let n = stencil.nx * stencil.ny;
        Self { stencil, interpolation: None, x: vec![0.0; n], right: vec![0.0; n] }
    }
}

impl Multigrid {
    pub(crate) fn new(network: &Network) -> Self {
        let mut sides = network.grid().spacing();
        let mut levels = vec![Level::new(finest(network))];
        loop {
            let Some(level) = levels.last_mut() else { unreachable!("there is a finest level") };
            let (nx, ny) = (level.stencil.nx, level.stencil.ny);
            if nx * ny <= COARSEST {
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
        let coarsest = Coarsest::new(&levels[levels.len() - 1].stencil);
        Self { levels, coarsest }
    }

    /// The right side, to be written.
    pub(crate) fn right_mut(&mut self) -> &mut [f32] {
        &mut self.levels[0].right
    }

    /// Applies the cycle to the right side.
    pub(crate) fn cycle(&mut self) -> &[f32] {
        cycle(&mut self.levels, &self.coarsest);
        &self.levels[0].x
    }
}

/// The finest level: the network itself, with bonds across faces.
fn finest(network: &Network) -> Stencil {
    let (nx, ny) = (network.grid().nx(), network.grid().ny());
    let (mut east, mut north) = (vec![0.0; nx * ny], vec![0.0; nx * ny]);
    let rows = east.chunks_mut(nx).zip(north.chunks_mut(nx)).enumerate().collect();
    parallel::for_each(rows, |(iy, (east, north)): (usize, (&mut [f32], &mut [f32]))| {
        network.write_conductances(iy, east, north);
    });
    let mut stencil = Stencil { nx, ny, east, north, corners: None, inverse: Vec::new() };
    stencil.invert_totals();
    stencil
}

fn cycle(levels: &mut [Level], coarsest: &Coarsest) {
    let Some((level, coarser)) = levels.split_first_mut() else { return };
    let Level { stencil, interpolation, x, right } = level;
    let Some(interpolation) = interpolation else {
        coarsest.solve(right, x);
        return;
    };
    x.fill(0.0);
    stencil.relax(x, right, Order::Forward);
    interpolation.restrict(&|iy, out| stencil.residual(x, right, iy, out), &mut coarser[0].right);
    cycle(coarser, coarsest);
    interpolation.prolong(&coarser[0].x, x);
    stencil.relax(x, right, Order::Backward);
}
