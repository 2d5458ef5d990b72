//! The roughness of a pressure. The error of the split kernel grows with it.

use std::ops::Range;

use rayon::prelude::*;
use rc_quadtree::{CELLS, TILE};

use crate::tiles::mesh::Mesh;

/// Maximum difference between `pressure` and the mean of its four neighbours, times the element's side.
///
/// The maximum is over all elements, and λ = 1.
pub(crate) fn roughness(mesh: &Mesh, pressure: &[f64]) -> f64 {
    let around = mesh.surroundings(pressure);
    let of_level = |(coarser, places, values): (usize, &[[u32; 2]], Range<usize>)| {
        let of_tile = |(tile, &place): (usize, &[u32; 2])| {
            let start = values.start + tile * CELLS;
            if pressure[start..start + CELLS].iter().all(|&p| p <= 0.0) {
                return 0.0;
            }
            let p = around.elements.around(&around.values, coarser, place, 0.0);
            let cells = (TILE..2 * TILE).flat_map(|y| (TILE..2 * TILE).map(move |x| (x, y)));
            cells.fold(0.0_f64, |maximum, (x, y)| {
                let mean = 0.25 * (p[y - 1][x] + p[y + 1][x] + p[y][x - 1] + p[y][x + 1]);
                maximum.max((p[y][x] - mean).abs())
            })
        };
        mesh.side(coarser) * places.par_iter().enumerate().map(of_tile).reduce(|| 0.0, f64::max)
    };
    mesh.ranks().maximum(mesh.own_levels().map(of_level).fold(0.0, f64::max), 0.0)
}

#[cfg(test)]
mod tests {
    use rc_quadtree::{Elements, TileSet};

    use super::*;

    #[test]
    fn a_chequered_pressure_is_as_rough_as_its_steps_and_a_uniform_one_is_smooth() {
        let elements = Mesh::from(Elements::uniform(TileSet::full([4 * TILE; 2])));
        let chequered: Vec<f64> = (0..elements.len()).map(|i| f64::from((i % TILE + i / TILE) as u32 % 2)).collect();
        let side = 1.0 / (4 * TILE) as f64;
        assert!((roughness(&elements, &chequered) / side - 1.0).abs() < 1e-12);
        assert!(roughness(&elements, &vec![3.0; elements.len()]).abs() < 1e-12);
    }
}
