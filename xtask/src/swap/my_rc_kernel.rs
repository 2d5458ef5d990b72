//! A fork of `rc-kernel`, as small as it can be: another implementation of Love's kernel under the same name, and the rest as
//! it was. `cargo xtask swap` builds the solver with it.
//!
//! The symbol is a table of sums over aliases: slow to make, and independent of the fast one that it replaces.

use rc_core::{EdgeBias, Grid, Kernel, Symbol};

// What is defined here goes before what is taken over.
pub use upstream::*;

/// Love's kernel, from [`upstream::love_alias_sum`].
#[derive(Clone, Copy, Debug, Default)]
pub struct Love;

impl Kernel for Love {
    /// Not that of the original: a test sees by it which of the two the solver has.
    fn name(&self) -> &'static str {
        "my-love"
    }

    fn symbol(&self, grid: Grid) -> Symbol<'_> {
        let width = grid.nx() / 2 + 1;
        let row = |ky: usize| (0..width).map(move |kx| upstream::love_alias_sum(grid, kx, ky));
        let table: Vec<f64> = (0..=grid.ny() / 2).flat_map(row).collect();
        Box::new(move |kx, ky| table[ky * width + kx])
    }

    fn edge_bias(&self) -> EdgeBias {
        upstream::Love.edge_bias()
    }
}
