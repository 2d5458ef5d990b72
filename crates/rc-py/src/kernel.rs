//! A half-space whose symbol is a function of the caller.

use std::f64::consts::TAU;

use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use rc_core::{Grid, Kernel, Symbol, Units};

use crate::errors::bad_input;

/// The symbol on a grid and on all coarser ones, whose waves are among its own.
pub(crate) struct OwnKernel {
    /// Waves per cell along y, at most.
    max_ky: usize,
    /// In λ/E*, for 0 ≤ kx, then 0 ≤ ky; zero at the zero wave.
    values: Vec<f64>,
}

impl OwnKernel {
    /// Calls `symbol(kx, ky)` once with all waves of `grid` but the zero wave: two arrays of wavenumbers (rad/m). It returns as many
    /// displacements (m) for a pressure of 1 Pa.
    pub(crate) fn new(symbol: &Bound<'_, PyAny>, grid: Grid, units: Units) -> PyResult<Self> {
        let py = symbol.py();
        let (max_kx, max_ky) = (grid.nx() / 2, grid.ny() / 2);
        let waves = (0..=max_kx).flat_map(|kx| (0..=max_ky).map(move |ky| (kx, ky))).skip(1);
        let [side_x, side_y] = units.cell().sides();
        let (kx, ky): (Vec<f64>, Vec<f64>) =
            waves.map(|(kx, ky)| (TAU * kx as f64 / side_x, TAU * ky as f64 / side_y)).unzip();
        let n_waves = kx.len();
        let returned = symbol.call1((PyArray1::from_vec(py, kx), PyArray1::from_vec(py, ky)))?;
        let as_array = py.import("numpy")?.call_method1("ascontiguousarray", (returned, "float64"))?;
        let of_shape = || {
            bad_input(format_args!("kernel: the function must return one number for each wave, an array of {n_waves}"))
        };
        let array: PyReadonlyArray1<'_, f64> = as_array.extract().map_err(|_| of_shape())?;
        let array = array.as_array();
        if array.len() != n_waves {
            return Err(of_shape());
        }
        // One metre for one pascal, in units of the libraries.
        let unit = units.length(1.0) / units.pressure(1.0);
        let values = std::iter::once(0.0).chain(array.iter().map(|value| value * unit)).collect();
        Ok(Self { max_ky, values })
    }
}

impl Kernel for OwnKernel {
    fn name(&self) -> &'static str {
        "own"
    }

    fn symbol(&self, _grid: Grid) -> Symbol<'_> {
        // A wave that is not in the table is refused by the solver, as any symbol that is not a number.
        Box::new(|kx, ky| {
            let row = self.values.chunks_exact(self.max_ky + 1).nth(kx);
            row.and_then(|row| row.get(ky)).copied().unwrap_or(f64::NAN)
        })
    }
}
