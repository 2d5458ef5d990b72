//! The elastic solid on the base grid: the half-space, and what a kernel's split adds to it.

use std::f64::consts::PI;
use std::sync::Arc;

use rc_core::{Grid, Kernel, SlidingCompliance, SplitByScale};

use crate::problem::adaptive_error::AdaptiveError;
use crate::tiles::base::Base;
use crate::tiles::split::GapSplit;

/// Part of the shortest wave's number up to which the base grid represents a deviation.
///
/// Filters between levels are accurate for these waves.
const RESOLVED: f64 = 0.6;

/// The base grid, with the deviation of a solid from the half-space there.
#[derive(Clone)]
pub(crate) struct Solid {
    base: Base,
    deviation: Option<Arc<Deviation>>,
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
        Self { base: base.into(), deviation: None, sliding: None }
    }
}

impl Solid {
    /// The solid of a `kernel` with this `split`.
    ///
    /// # Errors
    /// [`AdaptiveError::Deviation`] if the base grid does not resolve its deviation from the half-space.
    pub(crate) fn new(kernel: &dyn Kernel, split: &dyn SplitByScale, base: Base) -> Result<Self, AdaptiveError> {
        let deviates_below = split.deviates_below(smallest_deviation());
        if deviates_below == 0.0 {
            return Ok(base.into());
        }
        let grid = base.grid();
        let resolved = if base.is_free() { 0.0 } else { RESOLVED * PI / grid.spacing().max_element() };
        // NaN is not resolved.
        let is_resolved = deviates_below <= resolved;
        if !is_resolved {
            return Err(AdaptiveError::Deviation { kernel: kernel.name(), deviates_below, resolved });
        }
        let waves = (0..=grid.ny() / 2).flat_map(|ky| (0..=grid.nx() / 2).map(move |kx| (kx, ky)));
        let at = |(kx, ky)| if (kx, ky) == (0, 0) { 0.0 } else { split.deviation(wavenumber(grid, kx, ky)) };
        let deviation = Deviation { symbol: waves.map(at).collect(), curvature: split.curvature() };
        Ok(Self { base, deviation: Some(Arc::new(deviation)), sliding: None })
    }

    /// The solid, of a material that relaxes while a surface slides over it along x. Lengths are in λ.
    ///
    /// The cell is periodic, and each level has twice the elements of the one below along a side.
    pub(crate) fn under_sliding(self, compliance: SlidingCompliance) -> Self {
        Self { sliding: Some(Arc::new(compliance)), ..self }
    }

    /// The half-space of the same material.
    pub(crate) fn half_space(self) -> Self {
        Self { deviation: None, ..self }
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

/// Deviations that count between levels, as a part of 2/q: those above the error of any split.
pub(crate) fn smallest_deviation() -> f64 {
    GapSplit::most_accurate().error
}

/// The angular wavenumber of a wave, in rad/λ.
pub(crate) fn wavenumber(grid: Grid, kx: usize, ky: usize) -> f64 {
    2.0 * PI * (kx as f64).hypot(ky as f64 / grid.cell_ratio())
}
