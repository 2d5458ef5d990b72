//! The elastic solid on the base grid: the half-space, and what a kernel's split adds to it.

use std::f64::consts::PI;
use std::sync::Arc;

use rc_core::{Grid, Kernel, SlidingCompliance, SplitByScale};

use crate::problem::adaptive_error::AdaptiveError;
use crate::tiles::base::Base;

/// Deviations, as parts of 2/q, that a base grid may leave unresolved, smallest first.
///
/// The first is below the error of any split. The others add to that error. The last is about that of the fastest split.
/// It lets layers from 1.3 of the shortest wavelength on be solved with the usual base grid.
const UNRESOLVED: [f64; 6] = [2e-10, 1e-9, 1e-8, 1e-7, 1e-6, 2e-6];

/// Part of the shortest wave's number up to which the base grid represents a deviation.
///
/// Filters between levels are accurate for these waves.
const RESOLVED: f64 = 0.6;

/// The base grid, with the deviation of a solid from the half-space there.
#[derive(Clone)]
pub(crate) struct Solid {
    base: Base,
    deviation: Option<Arc<Deviation>>,
    /// Displacement by a uniform pressure of 1, in λ/E*.
    compliance: f64,
    /// The largest deviation that the base grid does not resolve, as a part of 2/q. It is zero below the error of all
    /// splits.
    unresolved: f64,
    /// What a surface that slides along x makes of it, with lengths in λ.
    sliding: Option<Arc<SlidingCompliance>>,
}

/// The deviation of a solid that is not the half-space.
struct Deviation {
    /// Symbol minus 2/q, for the waves 0 ≤ kx ≤ nx/2 and 0 ≤ ky ≤ ny/2 of the base grid, row by row.
    symbol: Vec<f64>,
    curvature: f64,
}

impl<B: Into<Base>> From<B> for Solid {
    /// The half-space.
    fn from(base: B) -> Self {
        Self { base: base.into(), deviation: None, compliance: 0.0, unresolved: 0.0, sliding: None }
    }
}

impl Solid {
    /// The solid of a `kernel` with this `split`. The base grid may leave deviations unresolved that are `allowed`.
    ///
    /// # Errors
    /// [`AdaptiveError::Deviation`] if the base grid does not resolve its deviation from the half-space.
    pub(crate) fn new(
        kernel: &dyn Kernel,
        split: &dyn SplitByScale,
        base: Base,
        allowed: f64,
    ) -> Result<Self, AdaptiveError> {
        let most = UNRESOLVED.into_iter().rev().find(|part| *part <= allowed).unwrap_or(UNRESOLVED[0]);
        if split.deviates_below(0.0) == 0.0 && kernel.uniform_displacement().is_none() {
            return Ok(base.into());
        }
        let deviates_below = split.deviates_below(most);
        let grid = base.grid();
        let resolved = if base.is_free() { 0.0 } else { RESOLVED * PI / grid.spacing().max_element() };
        // NaN is not resolved.
        let is_resolved = |part: &f64| *part <= most && split.deviates_below(*part) <= resolved;
        let Some(at) = UNRESOLVED.iter().position(is_resolved) else {
            return Err(AdaptiveError::Deviation { kernel: kernel.name(), deviates_below, resolved });
        };
        let unresolved = if at == 0 { 0.0 } else { UNRESOLVED[at] };
        let compliance = kernel.uniform_displacement().unwrap_or(0.0);
        let waves = (0..=grid.ny() / 2).flat_map(|ky| (0..=grid.nx() / 2).map(move |kx| (kx, ky)));
        let at = |(kx, ky)| if (kx, ky) == (0, 0) { 0.0 } else { split.deviation(wavenumber(grid, kx, ky)) };
        let deviation = Deviation { symbol: waves.map(at).collect(), curvature: split.curvature() };
        Ok(Self { base, deviation: Some(Arc::new(deviation)), compliance, unresolved, sliding: None })
    }

    /// The solid, of a material that relaxes while a surface slides over it along x. Lengths are in λ.
    ///
    /// The cell is periodic, and each level has twice the elements of the one below along a side.
    pub(crate) fn under_sliding(self, compliance: SlidingCompliance) -> Self {
        Self { sliding: Some(Arc::new(compliance)), ..self }
    }

    /// Displacement by a uniform pressure of 1, in λ/E*.
    pub(crate) fn compliance(&self) -> f64 {
        self.compliance
    }

    /// The largest deviation that the base grid does not resolve, as a part of 2/q.
    pub(crate) fn unresolved(&self) -> f64 {
        self.unresolved
    }

    /// What a sliding surface makes of the solid, with lengths in λ. `None` at rest.
    pub(crate) fn sliding(&self) -> Option<&SlidingCompliance> {
        self.sliding.as_deref()
    }

    /// The base grid.
    pub(crate) fn base(&self) -> Base {
        self.base
    }

    /// What the symbol of a wave of the base grid has beyond 2/q, in λ/E*.
    pub(crate) fn deviation(&self, kx: usize, ky: usize) -> f64 {
        let columns = self.base.grid().nx() / 2 + 1;
        self.deviation.as_ref().map_or(0.0, |deviation| deviation.symbol[ky * columns + kx])
    }

    /// Bound of the second derivatives that the deviation adds to displacements by pressures between 0 and 1.
    pub(crate) fn curvature(&self) -> f64 {
        self.deviation.as_ref().map_or(0.0, |deviation| deviation.curvature)
    }
}

/// The largest deviation that a base grid may leave unresolved, as a part of 2/q.
pub(crate) fn largest_unresolved() -> f64 {
    UNRESOLVED[UNRESOLVED.len() - 1]
}

/// The angular wavenumber of a wave, in rad/λ.
pub(crate) fn wavenumber(grid: Grid, kx: usize, ky: usize) -> f64 {
    2.0 * PI * (kx as f64).hypot(ky as f64 / grid.cell_ratio())
}
