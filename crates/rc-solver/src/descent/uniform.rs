//! L on a uniform grid, by Fourier transforms.

use rayon::prelude::*;
use rc_core::{Grid, Kernel};
use rc_fft::{BLOCK_ROWS, Convolution, SymbolTable, TransformReal};

use super::extension::GridExtension;
use super::layout::BlockLayout;
use super::operators::{BlockOperator, LevelOperators, PreconditionedOperator};
use crate::parallel::Tasks;

/// The symbol of `kernel` on `grid`, with what a uniform pressure displaces.
pub(crate) fn symbol_table(grid: Grid, kernel: &dyn Kernel) -> SymbolTable<f64> {
    let mut table = SymbolTable::new(grid, kernel.symbol(grid));
    if let Some(displacement) = kernel.uniform_displacement() {
        table.set_mean(displacement / grid.len() as f64);
    }
    table
}

/// L of `kernel` on `grid`.
pub(crate) fn uniform_operators(grid: Grid, kernel: &dyn Kernel) -> LevelOperators<'static> {
    let displacement = symbol_table(grid, kernel);
    LevelOperators {
        corrections: Box::new(UniformCorrections::new(grid, &displacement)),
        fresh: Box::new(SymbolOperator::new(grid, displacement)),
    }
}

/// For corrections.
pub(crate) struct UniformCorrections {
    convolution: Convolution<f32>,
    displacement: SymbolTable<f32>,
    preconditioner: SymbolTable<f32>,
    extension: GridExtension,
}

impl UniformCorrections {
    /// From the symbol of L.
    pub(crate) fn new(grid: Grid, displacement: &SymbolTable<f64>) -> Self {
        Self {
            convolution: Convolution::new(grid),
            extension: GridExtension::new(grid),
            preconditioner: displacement.inverse(grid),
            displacement: displacement.map(|value| value as f32),
        }
    }
}

impl BlockOperator<f32> for UniformCorrections {
    fn layout(&self) -> BlockLayout {
        layout(self.convolution.grid())
    }

    fn write(&mut self, write: &(dyn Fn(usize, &mut [f32]) + Sync)) {
        write_rows(&mut self.convolution, write);
    }

    fn apply(&mut self) {
        self.convolution.apply_symbol(&self.displacement);
    }

    fn read(&self, read: &(dyn Fn(usize, &[f32]) + Sync)) {
        read_rows(&self.convolution, read);
    }
}

impl PreconditionedOperator for UniformCorrections {
    fn set_active(&mut self, active: &[bool]) {
        self.extension.set_active(active);
    }

    fn precondition(&mut self, active: &[bool], values: &mut [f32]) {
        let Self { convolution, preconditioner, extension, .. } = self;
        extension.extend(values);
        let len = BLOCK_ROWS * convolution.grid().nx();
        let filled = &*extension;
        write_rows(convolution, &|i, rows| {
            let here = i * len..i * len + rows.len();
            rows.copy_from_slice(&values[here.clone()]);
            filled.fill(i * BLOCK_ROWS, &active[here], rows);
        });
        convolution.apply_symbol(preconditioner);
        let tasks = Tasks::new(values.chunks_mut(len));
        read_rows(convolution, &|i, rows| tasks.run(i, |to: &mut [f32]| to.copy_from_slice(rows)));
        extension.gather(active, values);
    }

    fn set_mean(&mut self, eigenvalue: f64) {
        self.preconditioner.set_mean((eigenvalue / self.convolution.grid().len() as f64) as f32);
    }
}

/// An operator of this symbol, in double precision.
pub(crate) struct SymbolOperator {
    convolution: Convolution<f64>,
    symbol: SymbolTable<f64>,
}

impl SymbolOperator {
    /// On `grid`, which `symbol` is the table of.
    pub(crate) fn new(grid: Grid, symbol: SymbolTable<f64>) -> Self {
        Self { convolution: Convolution::new(grid), symbol }
    }
}

impl BlockOperator<f64> for SymbolOperator {
    fn layout(&self) -> BlockLayout {
        layout(self.convolution.grid())
    }

    fn write(&mut self, write: &(dyn Fn(usize, &mut [f64]) + Sync)) {
        write_rows(&mut self.convolution, write);
    }

    fn apply(&mut self) {
        self.convolution.apply_symbol(&self.symbol);
    }

    fn read(&self, read: &(dyn Fn(usize, &[f64]) + Sync)) {
        read_rows(&self.convolution, read);
    }
}

/// Blocks of rows, as they are transformed.
fn layout(grid: Grid) -> BlockLayout {
    BlockLayout::of_rows(BLOCK_ROWS, [grid.nx(), grid.ny()])
}

fn n_blocks(grid: Grid) -> usize {
    grid.ny().div_ceil(BLOCK_ROWS)
}

/// Calls `write` once for each block of rows, with its index and the rows to be filled in. (All callers pass closures in this form, for
/// which the transforms are compiled once.)
pub(crate) fn write_rows<T: TransformReal>(convolution: &mut Convolution<T>, write: &(dyn Fn(usize, &mut [T]) + Sync)) {
    let blocks = (0..n_blocks(convolution.grid())).into_par_iter();
    convolution.transform_rows(blocks, write);
}

/// Calls `read` once for each block of rows, with its index and the rows.
pub(crate) fn read_rows<T: TransformReal>(convolution: &Convolution<T>, read: &(dyn Fn(usize, &[T]) + Sync)) {
    let blocks = (0..n_blocks(convolution.grid())).into_par_iter();
    convolution.read_rows(blocks, read);
}
