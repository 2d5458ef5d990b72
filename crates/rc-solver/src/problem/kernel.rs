//! The kernel of a problem and of its solution, with any owner.

use std::f64::consts::PI;
use std::sync::Arc;

use rc_core::{EdgeBias, Grid, Kernel, Symbol};

/// The kernel that a problem is solved with.
#[derive(Clone)]
pub(crate) enum OwnedKernel<'a> {
    /// A kernel that the caller owns.
    Borrowed(&'a dyn Kernel),
    /// A kernel with several owners.
    Shared(Arc<dyn Kernel + Send + Sync>),
    /// The table that a solution keeps of a borrowed kernel, to outlive it.
    Tabulated(Arc<TabulatedKernel>),
}

/// A kernel that is known on one grid.
pub(crate) struct TabulatedKernel {
    name: &'static str,
    bias: EdgeBias,
    uniform: Option<f64>,
    grid: Grid,
    /// Eigenvalues for 0 ≤ kx ≤ nx/2 and 0 ≤ ky ≤ ny/2. Columns of constant kx are contiguous.
    values: Vec<f64>,
    /// For free borders: displacements at each distance from one loaded element, row-major.
    free: Option<Vec<f64>>,
}

impl OwnedKernel<'_> {
    /// The kernel without a borrow. A borrowed kernel becomes a table for `grid`.
    pub(crate) fn into_owned(self, grid: Grid) -> OwnedKernel<'static> {
        match self {
            Self::Borrowed(kernel) => OwnedKernel::Tabulated(Arc::new(TabulatedKernel::new(kernel, grid))),
            Self::Shared(kernel) => OwnedKernel::Shared(kernel),
            Self::Tabulated(kernel) => OwnedKernel::Tabulated(kernel),
        }
    }

    /// The kernel.
    pub(crate) fn get(&self) -> &dyn Kernel {
        match self {
            Self::Borrowed(kernel) => *kernel,
            Self::Shared(kernel) => &**kernel,
            Self::Tabulated(kernel) => &**kernel,
        }
    }
}

impl TabulatedKernel {
    fn new(kernel: &dyn Kernel, grid: Grid) -> Self {
        let symbol = kernel.symbol(grid);
        let columns = 0..=grid.nx() / 2;
        let values = columns.flat_map(|kx| (0..=grid.ny() / 2).map(move |ky| (kx, ky))).map(|(kx, ky)| symbol(kx, ky));
        let (name, bias, uniform) = (kernel.name(), kernel.edge_bias(), kernel.uniform_displacement());
        let elements = (0..grid.len()).map(|i| (i % grid.nx(), i / grid.nx()));
        let free = kernel.free_response(grid).map(|response| elements.map(|(ix, iy)| response(ix, iy)).collect());
        Self { name, bias, uniform, grid, values: values.collect(), free }
    }
}

impl Kernel for TabulatedKernel {
    fn name(&self) -> &'static str {
        self.name
    }

    fn symbol(&self, grid: Grid) -> Symbol<'_> {
        if self.free.is_some() {
            // With free borders, the symbol only preconditions, on a grid with a margin. The symbol of
            // `rc_kernel::Spectral` serves equally well for this.
            return Box::new(move |kx, ky| match grid.waves(kx, ky) {
                0.0 => 0.0,
                waves => 1.0 / (PI * waves),
            });
        }
        assert_eq!(grid, self.grid, "a tabulated kernel is asked for the grid of its solution only");
        Box::new(|kx, ky| self.values[kx * (self.grid.ny() / 2 + 1) + ky])
    }

    fn uniform_displacement(&self) -> Option<f64> {
        self.uniform
    }

    fn free_response(&self, grid: Grid) -> Option<Symbol<'_>> {
        let values = self.free.as_ref()?;
        Some(Box::new(move |ix, iy| values[iy * grid.nx() + ix]))
    }

    fn edge_bias(&self) -> EdgeBias {
        self.bias
    }
}
