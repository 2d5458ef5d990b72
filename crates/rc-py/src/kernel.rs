//! A half-space whose symbol is a function of the caller.

use std::f64::consts::{PI, TAU};
use std::ffi::CString;
use std::sync::Arc;

use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::exceptions::PyUserWarning;
use pyo3::prelude::*;
use rc_core::quantity::digits;
use rc_core::{Grid, Kernel, Symbol, Units};
use rc_kernel::Spectral;

use crate::errors::bad_input;

/// Maximum number of waves for which the function is also called with mirror images.
const MIRRORED: usize = 64;

/// Allowed relative difference between the values of a wave and of its mirror image.
///
/// It allows for the errors of a quadrature.
const MIRROR_ERROR: f64 = 1e-8;

/// Relative difference of short waves from the half-space of E* that causes a warning.
const HALF_SPACE_ERROR: f64 = 0.05;

/// Number of calls between the warning and the caller: `solve_keys` and `solve`.
const STACK_LEVEL: i32 = 3;

/// The symbol of the caller on a grid. The waves of all coarser grids are among those of the grid.
#[derive(Clone)]
pub(crate) struct OwnKernel {
    /// Maximum number of waves per cell along y.
    max_ky: usize,
    /// Values in λ/E* for all kx ≥ 0 and, for each kx, all ky ≥ 0. The value of the zero wave is zero.
    values: Arc<[f64]>,
}

/// The waves of a grid, with the wavenumber (rad/m) of one wave per cell.
struct Waves {
    grid: Grid,
    per_wave: [f64; 2],
}

impl OwnKernel {
    /// Calls `symbol(kx, ky)` once and tabulates its values.
    ///
    /// The arguments are two arrays of wavenumbers (rad/m). They have all waves of `grid` except the zero wave, and
    /// mirror images of some waves. The function returns one displacement (m) for each wave, for a pressure of 1 Pa.
    ///
    /// # Errors
    /// When the function raises, returns another shape or a value that is not positive and finite, or is not symmetric.
    pub(crate) fn new(symbol: &Bound<'_, PyAny>, grid: Grid, units: Units) -> PyResult<Self> {
        let waves = Waves { grid, per_wave: units.cell().sides().map(|side| TAU / side) };
        let (own, mirrored) = (waves.all(), waves.mirrored());
        let [kx, ky] = [0, 1].map(|axis| {
            let number = |wave: &[i64; 2]| wave[axis] as f64 * waves.per_wave[axis];
            own.iter().map(number).chain(mirrored.iter().map(|(_, wave)| number(wave))).collect::<Vec<f64>>()
        });
        let mut found = call(symbol, kx, ky)?;
        if let Some(i) = found.iter().position(|value| !(*value > 0.0 && value.is_finite())) {
            let wave = own.get(i).or_else(|| mirrored.get(i - own.len()).map(|(_, wave)| wave)).copied();
            let [kx, ky] = wave.unwrap_or_default();
            let at = [kx as f64 * waves.per_wave[0], ky as f64 * waves.per_wave[1]];
            let [value, kx, ky] = [found[i], at[0], at[1]].map(|x| digits(x, 4));
            return Err(bad_input(format_args!(
                "kernel: the function returned {value} m at kx = {kx}, ky = {ky} rad/m; it must be positive and finite"
            )));
        }
        // This is one metre per pascal in units of the libraries.
        let unit = units.length(1.0) / units.pressure(1.0);
        for value in &mut found {
            *value *= unit;
        }
        let of_mirrored = found.split_off(own.len());
        let values = std::iter::once(0.0).chain(found).collect();
        let kernel = Self { max_ky: grid.ny() / 2, values };
        kernel.check_symmetry(&waves, mirrored.iter().map(|(place, wave)| (*place, *wave)).zip(of_mirrored))?;
        kernel.warn_of_another_material(symbol.py(), &waves, units.elasticity().e_star())?;
        Ok(kernel)
    }

    fn at(&self, kx: usize, ky: usize) -> f64 {
        self.values[kx * (self.max_ky + 1) + ky]
    }

    /// Refuses values that differ between a wave and its mirror image.
    ///
    /// The images are in kx, in ky, and on a square grid in the diagonal.
    fn check_symmetry(
        &self,
        waves: &Waves,
        mirrored: impl Iterator<Item = (([usize; 2], [i64; 2]), f64)>,
    ) -> PyResult<()> {
        let differ = |a: f64, b: f64| (a - b).abs() > MIRROR_ERROR * a.abs();
        let refuse = |[a, b]: [[i64; 2]; 2], why: &str| {
            let [a, b] = [a, b].map(|[kx, ky]| {
                let [kx, ky] = [kx as f64 * waves.per_wave[0], ky as f64 * waves.per_wave[1]];
                format!("({kx:.6e}, {ky:.6e})")
            });
            bad_input(format_args!("kernel: the values for (kx, ky) = {a} and {b} rad/m differ; {why}"))
        };
        for (([kx, ky], image), value) in mirrored {
            if differ(self.at(kx, ky), value) {
                return Err(refuse([[kx as i64, ky as i64], image], "they must be even in kx and in ky"));
            }
        }
        if !waves.grid.is_square() {
            return Ok(());
        }
        for (kx, ky) in (0..=self.max_ky).flat_map(|kx| (0..kx).map(move |ky| (kx, ky))) {
            if differ(self.at(kx, ky), self.at(ky, kx)) {
                let pair = [[kx as i64, ky as i64], [ky as i64, kx as i64]];
                return Err(refuse(pair, "on a square grid they must be the same with kx and ky exchanged"));
            }
        }
        Ok(())
    }

    /// Warns if short waves behave as on another half-space than that of E*.
    ///
    /// Contact edges are located with E*. Short waves are those in the outer half of the grid's waves. The warning is
    /// given only if all of them differ.
    fn warn_of_another_material(&self, py: Python<'_>, waves: &Waves, e_star: f64) -> PyResult<()> {
        let number = |[kx, ky]: [i64; 2]| waves.grid.waves(kx as usize, ky as usize);
        let (max_kx, max_ky) = (waves.grid.nx() as i64 / 2, waves.grid.ny() as i64 / 2);
        let outer = 0.5 * number([max_kx, 0]).min(number([0, max_ky]));
        let short = waves.all().into_iter().filter(|&wave| number(wave) >= outer);
        let ratio = |wave: [i64; 2]| PI * number(wave) * self.at(wave[0] as usize, wave[1] as usize);
        let nearest = short.map(ratio).min_by(|a, b| a.ln().abs().total_cmp(&b.ln().abs()));
        let Some(nearest) = nearest.filter(|ratio| (ratio - 1.0).abs() > HALF_SPACE_ERROR) else {
            return Ok(());
        };
        let message = format!(
            "kernel: at short waves, the function is nearest to a half-space with E* = {} Pa, but e_star, which locates contact edges, is \
             {} Pa; give the E* of short waves, or correct the function",
            digits(e_star / nearest, 5),
            digits(e_star, 5)
        );
        let message = CString::new(message).map_err(bad_input)?;
        PyErr::warn(py, &py.get_type::<PyUserWarning>(), &message, STACK_LEVEL)
    }
}

impl Waves {
    /// All waves except the zero wave, in the order of the values of a kernel.
    fn all(&self) -> Vec<[i64; 2]> {
        let [max_kx, max_ky] = [self.grid.nx() as i64 / 2, self.grid.ny() as i64 / 2];
        (0..=max_kx).flat_map(|kx| (0..=max_ky).map(move |ky| [kx, ky])).skip(1).collect()
    }

    /// Some of the waves, each with its mirror images in kx and in ky.
    fn mirrored(&self) -> Vec<([usize; 2], [i64; 2])> {
        let all = self.all();
        let step = (all.len() / MIRRORED).max(1);
        let images = |&[kx, ky]: &[i64; 2]| [[-kx, ky], [kx, -ky]].map(|image| ([kx as usize, ky as usize], image));
        all.iter().rev().step_by(step).take(MIRRORED).flat_map(images).collect()
    }
}

/// The values of the function for these wavenumbers.
fn call(symbol: &Bound<'_, PyAny>, kx: Vec<f64>, ky: Vec<f64>) -> PyResult<Vec<f64>> {
    let (py, n_waves) = (symbol.py(), kx.len());
    let returned = symbol.call1((PyArray1::from_vec(py, kx), PyArray1::from_vec(py, ky)))?;
    let as_array = py.import("numpy")?.call_method1("ascontiguousarray", (returned, "float64"))?;
    let of_shape =
        || bad_input(format_args!("kernel: the function must return one number for each wave, an array of {n_waves}"));
    let array: PyReadonlyArray1<'_, f64> = as_array.extract().map_err(|_| of_shape())?;
    let array = array.as_array();
    if array.len() == n_waves { Ok(array.to_vec()) } else { Err(of_shape()) }
}

impl Kernel for OwnKernel {
    fn name(&self) -> &'static str {
        "own"
    }

    fn symbol(&self, _grid: Grid) -> Symbol<'_> {
        // The solver refuses a wave that is not in the table, like any symbol that is not a number.
        Box::new(|kx, ky| {
            let row = self.values.chunks_exact(self.max_ky + 1).nth(kx);
            row.and_then(|row| row.get(ky)).copied().unwrap_or(f64::NAN)
        })
    }

    /// Conductivities are uniform, whatever the elastic moduli are.
    fn half_space(&self) -> Option<&dyn Kernel> {
        Some(&Spectral)
    }

    fn to_shared(&self) -> Option<Arc<dyn Kernel + Send + Sync>> {
        Some(Arc::new(self.clone()))
    }
}
