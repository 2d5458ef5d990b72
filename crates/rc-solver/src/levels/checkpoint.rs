//! The start values of a level, for a checkpoint.
//!
//! They come from the solved level before it, and are stored outside of the process.

use rc_comm::{Packed, Ranks};
use rc_core::{Boundary, Grid};
use rc_quadtree::{CELLS, Elements, TILE, TileSet};

use crate::descent::info::{LevelInfo, LevelValues};
use crate::levels::nested::History;
use crate::problem::checkpoint::Checkpoint;
use crate::tiles::mesh::Mesh;
use crate::tiles::prolongation::MeshStart;

/// The start of a level above the base grid.
pub(crate) struct TileStart {
    /// The whole grid of the level's smallest elements.
    pub(crate) grid: Grid,
    pub(crate) mesh: MeshStart,
    pub(crate) contact_gap: f64,
    /// U/σ0 of the level before, in λ.
    pub(crate) energy_length: f64,
    /// Part of the cell in tiles of the finest level that the contact of the base grid touches or is next to.
    pub(crate) tile_fraction: f64,
}

/// Number of values about a start before those of its levels.
///
/// The number below is that of the values of a level.
const N_NUMBERS: usize = 10;
const N_OF_LEVEL: usize = 5;

/// Limits above those of any solve. Larger values do not belong to a start.
const MOST_LEVELS: f64 = 64.0;
const MOST_TILES: f64 = 1e12;

/// Number of tiles in a piece.
const AT_ONCE: usize = 1 << 14;

/// Keeps a start on elements of one size, with the levels before it.
///
/// All ranks call this together.
pub(crate) fn keep(checkpoint: &dyn Checkpoint, start: &TileStart, history: &History) {
    let mesh = &start.mesh.elements;
    if mesh.levels().len() > 1 {
        return;
    }
    let (ranks, pressure) = (mesh.ranks(), &start.mesh.pressure);
    let n_pieces = |rank: usize| mesh.deal().range(rank).len().div_ceil(AT_ONCE);
    if ranks.rank() > 0 {
        for values in pressure.chunks(AT_ONCE * CELLS) {
            let _ = ranks.exchange(vec![(0, packed(values))], &[]);
        }
        return;
    }
    let head = [packed(&numbers(start, history)), packed(mesh.finest().places())];
    let own = pressure.chunks(AT_ONCE * CELLS).map(packed);
    let others = (1..ranks.size()).flat_map(|rank| (0..n_pieces(rank)).map(move |_| rank));
    let others = others.map(|rank| ranks.exchange(Vec::new(), &[rank]).concat());
    let mut pieces = head.into_iter().chain(own).chain(others);
    checkpoint.replace(&mut pieces);
    // If the checkpoint has failed, pieces that other ranks have sent are left over.
    pieces.for_each(drop);
}

/// The kept start, and the levels before it. `None` if no start was kept.
///
/// `grid` is any grid of the cell, with its `boundary`.
pub(crate) fn kept(
    checkpoint: &dyn Checkpoint,
    (grid, boundary): (Grid, Boundary),
    ranks: &Ranks,
) -> Option<(TileStart, History)> {
    let found = read(checkpoint, (grid, boundary), ranks);
    // Either all ranks go on from the same level, or they all start anew.
    if ranks.any(found.is_none()) { None } else { found }
}

fn read(
    checkpoint: &dyn Checkpoint,
    (grid, boundary): (Grid, Boundary),
    ranks: &Ranks,
) -> Option<(TileStart, History)> {
    let numbers = f64::unpack_all(&checkpoint.read(0, N_NUMBERS * f64::BYTES)?);
    let &[n_tiles, nx, ny, contact_gap, energy_length, tile_fraction, has_coarser, rms_pressure, penetration, n_levels] =
        numbers.as_slice()
    else {
        return None;
    };
    let is_possible = (0.0..=MOST_LEVELS).contains(&n_levels) && (0.0..=MOST_TILES).contains(&n_tiles);
    let mut offset = (N_NUMBERS * f64::BYTES) as u64;
    let mut next = |len: usize| {
        let bytes = checkpoint.read(offset, len);
        offset += len as u64;
        bytes
    };
    let n_bytes = is_possible.then_some(n_levels as usize)? * <[f64; N_OF_LEVEL]>::BYTES;
    let levels = <[f64; N_OF_LEVEL]>::unpack_all(&next(n_bytes)?);
    let level = |&[nx, ny, iterations, operators, preconditioners]: &[f64; N_OF_LEVEL]| {
        Some(LevelInfo {
            grid: grid.with_elements(nx as usize, ny as usize).ok()?,
            iterations: iterations as usize,
            operator_applications: operators as usize,
            preconditioner_applications: preconditioners as usize,
        })
    };
    let levels = levels.iter().map(level).collect::<Option<Vec<_>>>()?;
    let places = <[u32; 2]>::unpack_all(&next(n_tiles as usize * <[u32; 2]>::BYTES)?);
    let grid = grid.with_elements(nx as usize, ny as usize).ok()?;
    let extent = [grid.nx(), grid.ny()].map(|side| side.div_ceil(TILE));
    if places.iter().any(|place| (0..2).any(|axis| place[axis] as usize >= extent[axis])) {
        return None;
    }
    let tiles = TileSet::new([grid.nx(), grid.ny()], places).with_boundary(boundary);
    let elements = Mesh::new(Elements::uniform(tiles), ranks);
    let own = elements.own();
    offset += (own.start * f64::BYTES) as u64;
    let pressure = f64::unpack_all(&checkpoint.read(offset, own.len() * f64::BYTES)?);
    let mesh = MeshStart { elements, pressure };
    let coarser = (has_coarser > 0.0).then_some(LevelValues { rms_pressure, penetration, friction: None });
    Some((TileStart { grid, mesh, contact_gap, energy_length, tile_fraction }, History { levels, coarser }))
}

fn numbers(start: &TileStart, history: &History) -> Vec<f64> {
    let TileStart { grid, mesh, contact_gap, energy_length, tile_fraction } = start;
    let of_coarser = match history.coarser {
        Some(LevelValues { rms_pressure, penetration, .. }) => [1.0, rms_pressure, penetration],
        None => [0.0; 3],
    };
    let head = [mesh.elements.finest().len() as f64, grid.nx() as f64, grid.ny() as f64, *contact_gap, *energy_length];
    let of_levels = history.levels.iter().flat_map(|level| {
        let counts = [level.iterations, level.operator_applications, level.preconditioner_applications];
        [level.grid.nx(), level.grid.ny()].into_iter().chain(counts).map(|n| n as f64)
    });
    head.into_iter()
        .chain([*tile_fraction])
        .chain(of_coarser)
        .chain([history.levels.len() as f64])
        .chain(of_levels)
        .collect()
}

fn packed<T: Packed>(values: &[T]) -> Vec<u8> {
    let mut bytes = Vec::new();
    T::pack(values, &mut bytes);
    bytes
}
