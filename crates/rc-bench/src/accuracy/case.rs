//! One mesh of one scene with its errors, and sets of such cases.
//!
//! Errors are relative to the limit of fine meshes.

use anyhow::Result;
use rc_core::{EdgeBias, Kernel, Silent};
use rc_kernel::{Love, Spectral};
use rc_solver::{ContactProblem, Control, Method, Observables, SolveParams, StressDistribution};

use super::scenes::{RMS_SLOPE, Scene, Set};

/// Published perimeter correction, (π - 1 + ln 2)/24.
///
/// Source: Yastrebov, Anciaux, Molinari, *Tribol. Int.* 114 (2017) 161.
const PUBLISHED: f64 = 0.118_114_159_756_238_73;

/// Observables in the limit of fine meshes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limit {
    pub(super) area: f64,
    pub(super) rms_pressure: f64,
    pub(super) mean_gap: f64,
}

/// Difference of a stress distribution from the distribution of the limit.
#[derive(Clone, Copy, Debug)]
pub(super) struct Distribution {
    /// Ratio of the first bin of the distribution to its highest bin.
    pub(super) first_bin: f64,
    /// Ratio of the first bin to the highest bin in the distribution of the limit.
    pub(super) first_bin_of_limit: f64,
    /// ∫ |P - P of the limit| dσ over the contact area.
    pub(super) distance: f64,
}

impl Distribution {
    fn new(found: &StressDistribution, limit: &StressDistribution) -> Self {
        let width = BIN_OVER_RMS_SLOPE * RMS_SLOPE;
        let differences = found.density.iter().zip(&limit.density).map(|(p, limit)| (p - limit).abs());
        let first_bin = |of: &StressDistribution| of.density[0] / of.density.iter().copied().fold(0.0, f64::max);
        Self {
            first_bin: first_bin(found),
            first_bin_of_limit: first_bin(limit),
            distance: differences.sum::<f64>() * width / limit.area_fraction,
        }
    }
}

/// Width of a bin of the stress distribution, divided by E* and the rms slope.
const BIN_OVER_RMS_SLOPE: f64 = 0.02;
const N_BINS: usize = 150;

/// Smallest ratio of the elements under test to the elements of the limit, by side.
pub(super) const FINER: usize = 4;

/// One mesh of one scene.
#[derive(Clone, Copy, Debug)]
pub(super) struct Case {
    pub(super) scene: Scene,
    pub(super) kernel: &'static str,
    pub(super) mesh: usize,
    pub(super) limit: Limit,
    pub(super) found: Observables,
    /// A/A0 of the level set that is found from p² alone.
    area_of_pressure: f64,
    pub(super) distribution: Distribution,
    pub(super) side: usize,
    bias: EdgeBias,
}

impl Case {
    /// A/A0 by four estimators.
    ///
    /// In this order: counting, counting with the published perimeter term, the level set of p² alone, and the level
    /// set of p and the gap.
    pub(super) fn areas(&self) -> [f64; 4] {
        let area = &self.found.area;
        let published = area.cells - PUBLISHED * area.perimeter_edges as f64 / (self.side * self.side) as f64;
        [area.cells, published, self.area_of_pressure, area.fraction]
    }

    /// Relative errors of [`Self::areas`].
    pub(super) fn area_errors(&self) -> [f64; 4] {
        self.areas().map(|area| area / self.limit.area - 1.0)
    }

    /// Amount to add to [`EdgeBias::per_square`] to get the limit's rms pressure.
    pub(super) fn more_per_square(&self) -> f64 {
        let squares = self.found.area.missing_square / self.bias.per_square;
        (self.limit.rms_pressure.powi(2) - self.found.rms_pressure_corrected.powi(2)) / squares
    }

    /// Ratios of error to error bar for area, rms pressure and mean gap.
    ///
    /// A bar holds when its ratio is at most 1 in size. A quantity without a bar has NaN.
    pub(super) fn over_bars(&self) -> [f64; 3] {
        let Observables { area, rms_pressure_corrected, rms_pressure_error, mean_gap, mean_gap_error, .. } = self.found;
        let over = |value: f64, limit: f64, bar: Option<f64>| bar.map_or(f64::NAN, |bar| (value - limit) / bar);
        [
            over(area.fraction, self.limit.area, Some(area.error)),
            over(rms_pressure_corrected, self.limit.rms_pressure, rms_pressure_error),
            over(mean_gap, self.limit.mean_gap, Some(mean_gap_error)),
        ]
    }
}

/// The cases of a scene on `meshes`, each with the limit from a fine grid.
///
/// `meshes` are elements for the shortest wave; `reference` is the number of elements per side of the fine grid.
pub(super) fn cases_of(scene: Scene, meshes: &[usize], reference: usize) -> Result<Vec<Case>> {
    // The limit of the area is from the other kernel. The errors of pressure and gap are several times smaller with
    // `spectral`, so the limits of both are from `spectral`.
    let (love, fine) = solve(scene, &Love, reference)?;
    let (spectral, _) = solve(scene, &Spectral, reference)?;
    let mut cases = Vec::new();
    for (kernel, other) in [(&Love as &dyn Kernel, spectral), (&Spectral, love)] {
        let limit = Limit {
            area: other.area.fraction,
            rms_pressure: spectral.rms_pressure_corrected,
            mean_gap: spectral.mean_gap,
        };
        for &mesh in meshes.iter().filter(|&mesh| FINER * mesh * scene.waves <= reference) {
            let side = mesh * scene.waves;
            let (found, stress) = solve(scene, kernel, side)?;
            let distribution = Distribution::new(&stress, &fine);
            let (area_of_pressure, bias) = (stress.area_fraction, kernel.edge_bias());
            let kernel = kernel.name();
            cases.push(Case { scene, kernel, mesh, limit, found, area_of_pressure, distribution, side, bias });
        }
    }
    Ok(cases)
}

fn solve(scene: Scene, kernel: &dyn Kernel, side: usize) -> Result<(Observables, StressDistribution)> {
    let heights = scene.heights(side)?;
    let control = Control::MeanPressure(scene.mean_pressure);
    let params = SolveParams::default().by(Method::Uniform);
    let solution = ContactProblem::new(&heights, control).with_kernel(kernel).solve(&params, &Silent)?;
    let edges: Vec<f64> = (0..=N_BINS).map(|bin| bin as f64 * BIN_OVER_RMS_SLOPE * RMS_SLOPE).collect();
    Ok((*solution.observables(), StressDistribution::of(solution.pressure(), &edges)))
}

/// Root mean square of the values.
pub(super) fn rms(values: impl Iterator<Item = f64>) -> f64 {
    let (mut sum, mut n) = (0.0, 0.0);
    for value in values {
        sum += value * value;
        n += 1.0;
    }
    f64::sqrt(sum / n)
}

/// The cases of a set of scenes.
pub(super) fn of_set(cases: &[Case], set: Set) -> impl Iterator<Item = &Case> {
    cases.iter().filter(move |case| case.scene.set == set)
}

/// The cases of a set of scenes with one kernel on one mesh.
pub(super) fn of_mesh<'a>(cases: &'a [Case], set: Set, kernel: &'a str, mesh: usize) -> impl Iterator<Item = &'a Case> {
    of_set(cases, set).filter(move |case| case.kernel == kernel && case.mesh == mesh)
}
