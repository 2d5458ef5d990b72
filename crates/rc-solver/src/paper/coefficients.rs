//! The coefficients L_ij of Eq. 4 between the elements of a mesh, looked up or computed.
//!
//! Centres of elements lie on a lattice of half the finest element. L_ij therefore depends on the size of the source
//! and on two integers. A table for each size of source replaces the n² matrix. It has the offsets folded into a
//! quarter of the cell.

use rayon::prelude::*;
use rc_core::DVec2;
use rc_quadtree::paper::Mesh;

/// Function `coefficient(offset, half_side)`: L_ij of Eq. 4-6, in λ/E*.
///
/// The source has the half-side d. The offset is that of the target.
pub(crate) type Coefficient<'a> = &'a (dyn Fn(DVec2, f64) -> f64 + Sync);

/// One element as the sums see it.
///
/// It has a centre on the lattice, and a size as a source.
#[derive(Clone, Copy, Debug)]
pub(super) struct Site {
    /// Centre, in half finest elements.
    pub(super) x: u32,
    pub(super) y: u32,
    /// Number of doublings: the side is 2^`doublings` finest elements.
    pub(super) doublings: u32,
}

/// L_ij for every pair of elements of meshes whose finest elements are 1/`side` wide.
pub(super) struct Coefficients<'a> {
    coefficient: Coefficient<'a>,
    /// Number of finest elements per side of the cell.
    side: u32,
    /// For each size of source, nothing yet or a table over (|dx|, |dy|) ≤ `side`.
    tables: Vec<Vec<f64>>,
    /// Bytes that tables may take.
    budget: usize,
}

impl<'a> Coefficients<'a> {
    pub(super) fn new(coefficient: Coefficient<'a>, side: u32, budget: usize) -> Self {
        Self { coefficient, side, tables: Vec::new(), budget }
    }

    /// The elements of `mesh` on the lattice. Makes tables for their sizes as far as the budget allows.
    ///
    /// Smallest sources come first, because they are the most numerous.
    pub(super) fn prepare(&mut self, mesh: &Mesh) -> Vec<Site> {
        let finest = 1.0 / f64::from(self.side);
        let sites: Vec<Site> = mesh
            .elements()
            .map(|element| Site {
                x: (2.0 * element.centre.x / finest).round() as u32,
                y: (2.0 * element.centre.y / finest).round() as u32,
                doublings: (element.side / finest).round().log2() as u32,
            })
            .collect();
        let sizes = sites.iter().map(|site| site.doublings + 1).max().unwrap_or(0) as usize;
        let table_len = (self.side as usize + 1).pow(2);
        while self.tables.len() < sizes && (self.tables.len() + 1) * table_len * size_of::<f64>() <= self.budget {
            let table = self.table(self.tables.len() as u32);
            self.tables.push(table);
        }
        sites
    }

    fn table(&self, doublings: u32) -> Vec<f64> {
        let row_len = self.side as usize + 1;
        let mut table = vec![0.0; row_len * row_len];
        table.par_chunks_exact_mut(row_len).enumerate().for_each(|(dy, row)| {
            for (dx, value) in row.iter_mut().enumerate().take(dy + 1) {
                *value = self.compute(dx as u32, dy as u32, doublings);
            }
        });
        // The other half follows by symmetry under x ↔ y.
        for dy in 0..row_len {
            for dx in dy + 1..row_len {
                table[dy * row_len + dx] = table[dx * row_len + dy];
            }
        }
        table
    }

    fn compute(&self, dx: u32, dy: u32, doublings: u32) -> f64 {
        let half = 0.5 / f64::from(self.side);
        // One order makes values with and without a table the same.
        let (long, short) = (dx.max(dy), dx.min(dy));
        let offset = DVec2::new(f64::from(long) * half, f64::from(short) * half);
        (self.coefficient)(offset, half * f64::from(1_u32 << doublings))
    }

    /// Offset between two coordinates, folded to the nearest image.
    fn fold(&self, a: u32, b: u32) -> u32 {
        let distance = a.abs_diff(b);
        distance.min(2 * self.side - distance)
    }

    /// L between a target and a source.
    pub(super) fn get(&self, target: Site, source: Site) -> f64 {
        let (dx, dy) = (self.fold(target.x, source.x), self.fold(target.y, source.y));
        match self.tables.get(source.doublings as usize) {
            Some(table) => table[dy as usize * (self.side as usize + 1) + dx as usize],
            None => self.compute(dx, dy, source.doublings),
        }
    }
}
