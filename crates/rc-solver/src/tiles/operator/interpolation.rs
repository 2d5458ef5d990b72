//! Interpolation from the cells of a level to the next finer one, and its transpose.
//!
//! The extension uses both.

use rc_quadtree::{CELLS, TILE, cell_over, gather};

use crate::tiles::operator::tile_values::TileValues;

/// Side of the patch around a tile, and around the four tiles under one.
const AROUND: usize = 3 * TILE;
const UNDER: usize = 4 * TILE;

/// Applies P: values at the centres of the cells of a tile.
pub(super) fn interpolate(coarser: TileValues<'_, f32>, [column, row]: [u32; 2], out: &mut [f32; CELLS]) {
    let [half_x, half_y] = [column, row].map(|i| i as usize % 2 * (TILE / 2));
    let corner = (i64::from(column / 2) - 1, i64::from(row / 2) - 1);
    let mut patch = [[0.0; AROUND]; AROUND];
    let first = TILE + half_y - 1;
    if !gather(coarser.values, coarser.tiles, corner, first..first + TILE / 2 + 2, &mut patch) {
        *out = [0.0; CELLS];
        return;
    }
    for (iy, out) in out.as_chunks_mut::<TILE>().0.iter_mut().enumerate() {
        let near = TILE + half_y + iy / 2;
        let far = if iy % 2 == 0 { near - 1 } else { near + 1 };
        let line: [f32; TILE / 2 + 2] = std::array::from_fn(|i| {
            let x = TILE + half_x - 1 + i;
            0.75 * patch[near][x] + 0.25 * patch[far][x]
        });
        for (x, pair) in out.as_chunks_mut::<2>().0.iter_mut().enumerate() {
            let [before, here, after] = [line[x], line[x + 1], line[x + 2]];
            *pair = [0.75 * here + 0.25 * before, 0.75 * here + 0.25 * after];
        }
    }
}

/// Applies a quarter of the transpose of P, from the values of the finer level.
pub(super) fn collect(finer: TileValues<'_, f32>, places: &[[u32; 2]], cells: &mut [f32]) {
    let mut patch = [[0.0; UNDER]; UNDER];
    for (&[column, row], out) in places.iter().zip(cells.as_chunks_mut::<CELLS>().0) {
        let corner = (2 * i64::from(column) - 1, 2 * i64::from(row) - 1);
        if !gather(finer.values, finer.tiles, corner, TILE - 1..3 * TILE + 1, &mut patch) {
            *out = [0.0; CELLS];
            continue;
        }
        for (iy, out) in out.as_chunks_mut::<TILE>().0.iter_mut().enumerate() {
            let rows = &patch[TILE + 2 * iy - 1..][..4];
            let line: [f32; 2 * TILE + 2] = std::array::from_fn(|i| {
                let x = TILE - 1 + i;
                0.75 * (rows[1][x] + rows[2][x]) + 0.25 * (rows[0][x] + rows[3][x])
            });
            for (x, value) in out.iter_mut().enumerate() {
                let parts = &line[2 * x..][..4];
                *value = 0.0625 * (3.0 * (parts[1] + parts[2]) + parts[0] + parts[3]);
            }
        }
    }
}

/// The values of the coarser cells that contain the cells of a tile.
///
/// They are zero where there is no coarser cell.
pub(super) fn cells_over(coarser: TileValues<'_, f32>, place: [u32; 2]) -> [f32; CELLS] {
    let Some(values) = coarser.tile(place.map(|i| i / 2)) else { return [0.0; CELLS] };
    std::array::from_fn(|cell| values[cell_over(place, cell % TILE, cell / TILE)])
}
