//! The mean displacement of heights with free borders.

use rayon::prelude::*;
use rc_core::{DVec2, Grid};
use rc_kernel::love_rectangle_displacement;
use rc_quadtree::{BLOCK_CELLS, CELLS, TILE};

use crate::tiles::mesh::Mesh;

/// Mean displacement of a patch under a pressure on the elements of `mesh`.
///
/// The mean is over the grid `finest` of the smallest elements. Because L is symmetric, it is the mean of the pressure
/// times the displacement under a uniform pressure of 1. This pressure acts on the whole patch, which is one rectangle.
pub(crate) fn displacement_of_patch(mesh: &Mesh, pressure: &[f64], finest: Grid) -> f64 {
    let mut products = vec![0.0; pressure.len()];
    let spacing = finest.spacing();
    let half_sides = 0.5 * DVec2::new(1.0, finest.cell_ratio());
    let under_uniform = |at: DVec2| love_rectangle_displacement((at - half_sides).abs(), half_sides);
    for (coarser, places, cells) in mesh.own_levels() {
        // A larger element is the mean over the smallest in it.
        let parts = 1_usize << coarser;
        let sinks = products[cells.clone()].par_chunks_mut(CELLS).zip(pressure[cells].par_chunks(CELLS));
        sinks.zip(places).for_each(|((products, pressure), &place)| {
            for (cell, (product, &p)) in products.iter_mut().zip(pressure).enumerate().filter(|(_, (_, p))| **p > 0.0) {
                let cell = [cell % TILE, cell / TILE];
                let [x, y] = [0, 1].map(|axis| (place[axis] as usize * TILE + cell[axis]) << coarser);
                let centres = (0..parts * parts).map(|i| DVec2::new((x + i % parts) as f64, (y + i / parts) as f64));
                let sum: f64 = centres.map(|centre| under_uniform(spacing * (centre + 0.5))).sum();
                *product = p * sum / (parts * parts) as f64;
            }
        });
    }
    let blocks = products.par_chunks(BLOCK_CELLS).map(|block| [block.iter().sum()]).collect();
    let [sum] = mesh.layout().total(blocks);
    sum / finest.len() as f64
}
