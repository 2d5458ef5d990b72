//! L on a uniform grid, by Fourier transforms.

use rc_core::{Boundary, Grid, Kernel};
use rc_fft::Convolution;

use crate::descent::layout::BlockLayout;
use crate::descent::operators::{BlockOperator, LevelOperators, PreconditionedOperator};
use crate::grid::factors::Factors;
use crate::grid::inverse::Inverse;
use crate::grid::line;
use crate::grid::line::{LineCorrections, LineOperator};
use crate::grid::margin::Margin;
use crate::grid::passes::{layout, read_rows, write_rows};
use crate::grid::response::GridResponse;
use crate::problem::steps::Step;

/// The operators L of `kernel` on `grid`.
pub(crate) fn uniform_operators(grid: Grid, kernel: &dyn Kernel) -> LevelOperators<'static> {
    let _running = Step::Kernels.begin();
    operators_of(grid, kernel, GridResponse::of(grid, kernel))
}

/// The operators L of `kernel` with its `response` on `grid`.
pub(crate) fn operators_of(grid: Grid, kernel: &dyn Kernel, response: GridResponse) -> LevelOperators<'static> {
    LevelOperators { corrections: corrections_of(grid, kernel, &response), fresh: operator_of(grid, response) }
}

/// L of `kernel` with its `response` on `grid`, and its approximate inverse, for corrections.
pub(crate) fn corrections_of(
    grid: Grid,
    kernel: &dyn Kernel,
    response: &GridResponse,
) -> Box<dyn PreconditionedOperator> {
    if line::is_line(grid, response) {
        Box::new(LineCorrections::new(grid, response))
    } else {
        Box::new(UniformCorrections::new(grid, kernel, response))
    }
}

/// L of a grid in double precision.
pub(crate) fn operator_of(grid: Grid, response: GridResponse) -> Box<dyn BlockOperator<f64> + Send> {
    if line::is_line(grid, &response) {
        Box::new(LineOperator::new(grid.nx(), response.factors))
    } else {
        Box::new(SymbolOperator::of(response))
    }
}

/// The operator L of `kernel` on `grid` for a certificate only, without corrections.
pub(crate) fn certifying_operators(grid: Grid, kernel: &dyn Kernel) -> LevelOperators<'static> {
    let fresh = operator_of(grid, GridResponse::of(grid, kernel));
    LevelOperators { corrections: Box::new(NoOperator(fresh.layout())), fresh }
}

/// No operators on `grid`, for a pressure whose gap is known.
pub(crate) fn no_operators(grid: Grid) -> LevelOperators<'static> {
    LevelOperators { corrections: Box::new(NoOperator(layout(grid))), fresh: Box::new(NoOperator(layout(grid))) }
}

/// No operator, where no step is taken: only the layout is asked for.
struct NoOperator(BlockLayout);

impl<T> BlockOperator<T> for NoOperator {
    fn layout(&self) -> BlockLayout {
        self.0.clone()
    }

    fn write(&mut self, _write: &(dyn Fn(usize, &mut [T]) + Sync)) {}

    fn apply(&mut self) {}

    fn read(&self, _read: &(dyn Fn(usize, &[T]) + Sync)) {}
}

impl PreconditionedOperator for NoOperator {
    fn set_active(&mut self, _active: &[bool]) {}

    fn precondition(&mut self, _active: &[bool], _values: &mut [f32]) {}

    fn set_mean(&mut self, _eigenvalue: f64) {}
}

/// L and its approximate inverse, for corrections.
struct UniformCorrections {
    /// Convolution of displacements. On periodic cells it serves the approximate inverse too.
    convolution: Convolution<f32>,
    displacement: Factors<f32>,
    inverse: Inverse,
    /// The margin around heights with free borders.
    margin: Option<Margin>,
}

impl UniformCorrections {
    /// Operators of `kernel` with its `response` on `grid`.
    fn new(grid: Grid, kernel: &dyn Kernel, response: &GridResponse) -> Self {
        let margin = (response.boundary == Boundary::Free).then(|| Margin::around(grid));
        let inverse = match &margin {
            None => Inverse::new(grid, response.factors.storage_inverse(grid)),
            Some(margin) => Inverse::new(margin.grid(), Factors::AtRest(margin.inverse(kernel))),
        };
        let displacement = response.factors.to_single();
        Self { convolution: response.convolution(), displacement, inverse, margin }
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
        self.displacement.apply(&mut self.convolution);
    }

    fn read(&self, read: &(dyn Fn(usize, &[f32]) + Sync)) {
        read_rows(&self.convolution, read);
    }
}

impl PreconditionedOperator for UniformCorrections {
    fn set_active(&mut self, active: &[bool]) {
        let active = self.margin.as_mut().map_or(active, |margin| margin.set_active(active));
        self.inverse.extension.set_active(active, |active| f32::from(u8::from(active)));
    }

    fn precondition(&mut self, active: &[bool], values: &mut [f32]) {
        match &mut self.margin {
            None => self.inverse.apply(&mut self.convolution, active, values),
            Some(margin) => margin.apply(&mut self.inverse, values),
        }
    }

    fn set_mean(&mut self, eigenvalue: f64) {
        let grid = self.convolution.grid();
        let around = self.margin.as_ref().map_or(grid, Margin::grid);
        // The grid gets the whole load on the larger grid.
        let part = grid.len() as f64 / around.len() as f64;
        self.inverse.symbol.set_mean((part * eigenvalue / around.len() as f64) as f32);
    }
}

/// An operator with this symbol, in double precision.
pub(crate) struct SymbolOperator {
    convolution: Convolution<f64>,
    factors: Factors<f64>,
}

impl SymbolOperator {
    /// An operator on `grid`, with these factors of its waves.
    pub(crate) fn new(grid: Grid, factors: Factors<f64>) -> Self {
        Self { convolution: Convolution::new(grid), factors }
    }

    /// The operator L of a grid.
    fn of(response: GridResponse) -> Self {
        Self { convolution: response.convolution(), factors: response.factors }
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
        self.factors.apply(&mut self.convolution);
    }

    fn read(&self, read: &(dyn Fn(usize, &[f64]) + Sync)) {
        read_rows(&self.convolution, read);
    }
}
