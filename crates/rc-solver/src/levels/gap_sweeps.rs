//! Steps that change the gap of pools so that their pressure vanishes.
//!
//! They are conjugate gradients with the kernel of K = L⁻¹ cut off after a few elements, on the tiles around pools. The
//! kernel decays as r⁻³, so little is cut off.

use pulp::Arch;
use rc_core::{Grid, Kernel};
use rc_fft::Instructions;
use rc_quadtree::{BLOCK_CELLS, BLOCK_TILES, CELLS, TILE, TileSet};

use crate::parallel;
use crate::tiles::operator::passes::{ShortRange, Targets, TilePasses};
use crate::tiles::operator::sizes::Real;
use crate::tiles::operator::stencil::Taps;
use crate::tiles::operator::tile_values::TileValues;

/// Reach of the kernel, in elements.
const RADIUS: usize = 6;

/// Number of steps.
const STEPS: usize = 8;

/// Elements along a side of the lattice that the kernel is computed on.
///
/// Its images are too far away to matter.
const LATTICE: usize = 64;

/// The kernel of K near an element, for a grid whose elements are squares.
pub(super) struct NearKernel {
    taps: Taps<f32>,
    passes: TilePasses<f32>,
    arch: Arch,
    /// The pressure of an element alone that answers to a gap of one unit, in E*.
    pub(super) closing: f32,
}

impl NearKernel {
    /// The kernel with these `weights` on `grid`, for gaps in units of `unit`.
    pub(super) fn new(weights: &NearWeights, grid: Grid, unit: f64) -> Self {
        let sizes = <f32 as Real>::SIZES[0];
        let (NearWeights(weights), reach) = (weights, RADIUS as i32);
        let factor = unit * grid.nx() as f64 / LATTICE as f64;
        let closing = (factor * weights[0][0]) as f32;
        let weight = |dx: i32, dy: i32| {
            let is_near = dx * dx + dy * dy <= reach * reach;
            if is_near { factor * weights[dy.unsigned_abs() as usize][dx.unsigned_abs() as usize] } else { 0.0 }
        };
        let arch = match Instructions::of_process() {
            Instructions::Best => Arch::new(),
            Instructions::Scalar | Instructions::Sse => Arch::Scalar,
        };
        Self { taps: Taps::of_weights(RADIUS, sizes.around, weight), passes: sizes.passes, arch, closing }
    }

    /// The pressures that these gaps add.
    fn apply(&self, tiles: &TileSet, gaps: &[f32], pressures: &mut [f32]) {
        let pass = ShortRange { taps: &self.taps, values: TileValues::new(gaps, tiles) };
        let blocks = tiles.places().chunks(BLOCK_TILES).zip(pressures.chunks_mut(BLOCK_CELLS));
        parallel::for_each(blocks, |(places, cells)| {
            cells.fill(0.0);
            (self.passes.add_stencil)(self.arch, &pass, Targets { places, cells });
        });
    }
}

/// Weights of K at offsets from 0 to [`RADIUS`] along y and x, on a lattice that is one cell.
pub(super) struct NearWeights(Vec<Vec<f64>>);

impl NearWeights {
    pub(super) fn of(kernel: &dyn Kernel) -> Self {
        let symbol = kernel.symbol(Grid::square(LATTICE).expect("a small grid"));
        let wave = |k: usize| k.min(LATTICE - k);
        let inverse = |kx: usize, ky: usize| if kx + ky == 0 { 0.0 } else { symbol(wave(kx), wave(ky)).recip() };
        let cosine = |k: usize, d: usize| (std::f64::consts::TAU * (k * d) as f64 / LATTICE as f64).cos();
        let along_x: Vec<Vec<f64>> = (0..LATTICE)
            .map(|ky| (0..=RADIUS).map(|dx| (0..LATTICE).map(|kx| inverse(kx, ky) * cosine(kx, dx)).sum()).collect())
            .collect();
        let weight = |dx: usize, dy: usize| (0..LATTICE).map(|ky| along_x[ky][dx] * cosine(ky, dy)).sum::<f64>();
        let n = (LATTICE * LATTICE) as f64;
        Self((0..=RADIUS).map(|dy| (0..=RADIUS).map(|dx| weight(dx, dy) / n).collect()).collect())
    }
}

/// The gap and the pressure of tiles around pools.
pub(super) struct Pools {
    tiles: TileSet,
    gap: Vec<f32>,
    pressure: Vec<f32>,
}

impl Pools {
    /// The tiles at the places, from the values of the whole grid.
    pub(super) fn new(grid: Grid, places: Vec<[u32; 2]>, [gap, pressure]: [&[f32]; 2]) -> Self {
        let tiles = TileSet::new([grid.nx(), grid.ny()], places);
        let take = |values: &[f32]| {
            let mut taken = vec![0.0; tiles.n_cells()];
            let blocks = tiles.places().chunks(BLOCK_TILES).zip(taken.chunks_mut(BLOCK_CELLS));
            parallel::for_each(blocks, |(places, cells)| {
                for (&place, cells) in places.iter().zip(cells.chunks_mut(CELLS)) {
                    for (y, row) in cells.chunks_mut(TILE).enumerate() {
                        row.copy_from_slice(&values[first_of_row(grid, place, y)..][..TILE]);
                    }
                }
            });
            taken
        };
        let (gap, pressure) = (take(gap), take(pressure));
        Self { tiles, gap, pressure }
    }

    /// Takes the steps.
    pub(super) fn relax(&mut self, kernel: &NearKernel) {
        let n = self.gap.len();
        let first = (self.gap.clone(), self.pressure.clone());
        let [mut direction, mut response, mut change] = [(); 3].map(|()| vec![0.0; n]);
        let mut curvature = f64::INFINITY;
        for _ in 0..STEPS {
            let beta = (self.product_with(&response) / curvature).max(0.0) as f32;
            let mut slope = self.turn(&mut direction, beta);
            if slope >= 0.0 && beta > 0.0 {
                // Closing gaps has changed the elements, and the direction does not lead down.
                slope = self.turn(&mut direction, 0.0);
            }
            kernel.apply(&self.tiles, &direction, &mut response);
            curvature =
                sum(direction.chunks(BLOCK_CELLS).zip(response.chunks(BLOCK_CELLS)), |(direction, response)| {
                    direction.iter().zip(response).map(|(d, k)| f64::from(*d) * f64::from(*k)).sum()
                });
            if !(slope < 0.0 && curvature > 0.0) {
                return;
            }
            if self.step((-slope / curvature) as f32, [&direction, &response], (&first.0, &mut change)) {
                kernel.apply(&self.tiles, &change, &mut self.pressure);
                let blocks = self.pressure.chunks_mut(BLOCK_CELLS).zip(first.1.chunks(BLOCK_CELLS));
                parallel::for_each(blocks, |(pressure, first)| {
                    pressure.iter_mut().zip(first).for_each(|(p, first)| *p += first);
                });
            }
        }
    }

    /// Σ p k over the elements that may have a gap.
    fn product_with(&self, response: &[f32]) -> f64 {
        let blocks = self.gap.chunks(BLOCK_CELLS).zip(self.pressure.chunks(BLOCK_CELLS));
        sum(blocks.zip(response.chunks(BLOCK_CELLS)), |((gap, pressure), response)| {
            let elements = gap.iter().zip(pressure).zip(response).filter(|((g, p), _)| is_active(**g, **p));
            elements.map(|((_, p), k)| f64::from(*p) * f64::from(*k)).sum()
        })
    }

    /// Moves on to the next direction -p + β d. Returns its product with p.
    fn turn(&self, direction: &mut [f32], beta: f32) -> f64 {
        let blocks = self.gap.chunks(BLOCK_CELLS).zip(self.pressure.chunks(BLOCK_CELLS));
        sum(blocks.zip(direction.chunks_mut(BLOCK_CELLS)), |((gap, pressure), direction)| {
            let mut sum = 0.0;
            for ((g, p), d) in gap.iter().zip(pressure).zip(direction) {
                *d = if is_active(*g, *p) { beta * *d - p } else { 0.0 };
                sum += f64::from(*d) * f64::from(*p);
            }
            sum
        })
    }

    /// Takes a step, and closes negative gaps. Returns whether there are any.
    ///
    /// `change` gets the difference from the `first` gaps.
    fn step(&mut self, length: f32, [direction, response]: [&[f32]; 2], (first, change): (&[f32], &mut [f32])) -> bool {
        let values = self.gap.chunks_mut(BLOCK_CELLS).zip(self.pressure.chunks_mut(BLOCK_CELLS));
        let along = direction.chunks(BLOCK_CELLS).zip(response.chunks(BLOCK_CELLS));
        let since = first.chunks(BLOCK_CELLS).zip(change.chunks_mut(BLOCK_CELLS));
        let closed = parallel::map(values.zip(along).zip(since), |((values, along), (first, change))| {
            let (mut is_closed, elements) = (false, values.0.iter_mut().zip(values.1).zip(along.0.iter().zip(along.1)));
            for (((g, p), (d, k)), (first, change)) in elements.zip(first.iter().zip(change)) {
                let next = *g + length * d;
                is_closed |= next < 0.0;
                (*g, *p) = (next.max(0.0), *p + length * k);
                *change = *g - first;
            }
            is_closed
        });
        closed.into_iter().any(|is_closed| is_closed)
    }

    /// Writes gap and pressure to those of the whole grid.
    pub(super) fn put(&self, grid: Grid, [gap, pressure]: [&mut [f32]; 2]) {
        let row_of_tiles = TILE * grid.nx();
        let mut rows = vec![Vec::new(); grid.ny() / TILE];
        for (tile, place) in self.tiles.places().iter().enumerate() {
            rows[place[1] as usize].push(tile);
        }
        let put = |values: &[f32], whole: &mut [f32]| {
            parallel::for_each(whole.chunks_mut(row_of_tiles).zip(&rows), |(whole, tiles)| {
                for &tile in tiles {
                    let column = self.tiles.places()[tile][0];
                    for (y, row) in values[tile * CELLS..][..CELLS].chunks(TILE).enumerate() {
                        whole[first_of_row(grid, [column, 0], y)..][..TILE].copy_from_slice(row);
                    }
                }
            });
        };
        put(&self.gap, gap);
        put(&self.pressure, pressure);
    }
}

/// Whether an element has a gap, or may open.
pub(super) fn is_active(gap: f32, pressure: f32) -> bool {
    gap > 0.0 || pressure < 0.0
}

/// The index of the first element of row `y` of a tile.
fn first_of_row(grid: Grid, [column, row]: [u32; 2], y: usize) -> usize {
    (row as usize * TILE + y) * grid.nx() + column as usize * TILE
}

/// The sum over blocks, in their order.
fn sum<S: Send>(blocks: impl Iterator<Item = S>, of_block: impl Fn(S) -> f64 + Sync) -> f64 {
    parallel::map(blocks, of_block).into_iter().sum()
}
