//! A fork of `rc-kernel`, as small as it can be: another implementation of Love's kernel under the same name, and the rest as
//! it was. `cargo xtask swap` builds the solver with it.
//!
//! The symbol is the sum over aliases, one value at a time: slow, and independent of the fast one that it replaces.

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
        Box::new(move |kx, ky| if kx == 0 && ky == 0 { 0.0 } else { upstream::love_alias_sum(grid, kx, ky) })
    }

    fn edge_bias(&self) -> EdgeBias {
        upstream::Love.edge_bias()
    }
}
