//! The factors of the waves of a grid: real for a solid at rest, complex under a sliding surface.

use rc_core::{Complex64, Grid, Kernel};
use rc_fft::{Complex, Convolution, LineConvolution, SymbolTable, TransformReal, WaveTable};

/// Factors of the waves of a grid, including that of the inverse transform.
#[derive(Clone)]
pub(crate) enum Factors<T> {
    /// Real factors, even in both wavenumbers.
    AtRest(SymbolTable<T>),
    /// Complex factors.
    Sliding(WaveTable<T>),
}

impl<T: TransformReal> Factors<T> {
    /// Multiplies the waves of a convolution.
    pub(crate) fn apply(&self, convolution: &mut Convolution<T>) {
        match self {
            Self::AtRest(table) => convolution.apply_symbol(table),
            Self::Sliding(table) => convolution.apply_waves(table),
        }
    }

    /// Multiplies the waves of a row.
    pub(crate) fn apply_to_line(&self, convolution: &mut LineConvolution<T>) {
        match self {
            Self::AtRest(table) => convolution.apply(table),
            Self::Sliding(table) => convolution.apply_waves(table),
        }
    }

    /// Sets the factor of constant vectors, which includes that of the inverse transform.
    pub(crate) fn set_mean(&mut self, value: T) {
        match self {
            Self::AtRest(table) => table.set_mean(value),
            Self::Sliding(table) => table.set_mean(value),
        }
    }
}

impl Factors<f64> {
    /// L of `kernel` on a periodic `grid`.
    pub(crate) fn of(kernel: &dyn Kernel, grid: Grid) -> Self {
        match kernel.sliding_velocity().and_then(|_| kernel.sliding_symbol(grid)) {
            None => Self::AtRest(SymbolTable::new(grid, kernel.symbol(grid))),
            Some(symbol) => Self::Sliding(WaveTable::new(grid, symbol)),
        }
    }

    /// The factors in single precision.
    pub(crate) fn to_single(&self) -> Factors<f32> {
        match self {
            Self::AtRest(table) => Factors::AtRest(table.map(|value| value as f32)),
            Self::Sliding(table) => {
                let mut single = table.map(|value| Complex::new(value.re as f32, value.im as f32));
                single.set_mean(table.mean() as f32);
                Factors::Sliding(single)
            }
        }
    }

    /// L⁻¹, with 0 for constant vectors.
    pub(crate) fn inverse(&self, grid: Grid) -> Self {
        match self {
            Self::AtRest(table) => Self::AtRest(table.inverse(grid)),
            Self::Sliding(table) => {
                let scale = (grid.len() as f64).powi(-2);
                Self::Sliding(table.map(|value| scale * value.inv()))
            }
        }
    }

    /// The symmetric part of L⁻¹, which preconditions: 1/L at rest, and Re(1/L) under a sliding surface.
    ///
    /// Re(1/L) has the storage modulus of each wave instead of its complex modulus.
    pub(crate) fn storage_inverse(&self, grid: Grid) -> Factors<f32> {
        match self {
            Self::AtRest(table) => Factors::AtRest(table.inverse(grid)),
            Self::Sliding(table) => {
                let scale = (grid.len() as f64).powi(-2);
                Factors::Sliding(table.map(|value| Complex::new((scale * value.inv().re) as f32, 0.0)))
            }
        }
    }

    /// 1/Re(1/L), the solid whose elastic modulus is the storage modulus of each wave.
    pub(crate) fn storage(self) -> Self {
        match self {
            Self::AtRest(table) => Self::AtRest(table),
            Self::Sliding(table) => {
                let mut storage = table.map(|value| Complex64::from(value.inv().re.recip()));
                storage.set_mean(table.mean());
                Self::Sliding(storage)
            }
        }
    }
}
