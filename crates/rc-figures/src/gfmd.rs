//! Our results beside a published reference with many longest waves in the cell.
//!
//! The results are area, stress, gap and energy against pressure. The reference is Green's function molecular dynamics
//! by Y. Zhou and M. H. Müser, published with the comparison of Persson's theories of Y. Xu
//! (`PerssonModelFudgeFactor`). Numbers from its files are in `data/gfmd.csv` and `data/gfmd-stress.csv`.

mod drawing;
mod published;
mod tables;

use anyhow::{Context, Result};
use plotters::prelude::DrawingBackend;
use rc_core::{Grid, HeightField as _};
use rc_fractal::{Normalisation, SpectrumParams, Surface};
use rc_plot::{Area, Picture, PictureError};
use rc_solver::{ContactArea, Control, SolveParams, StressDistribution, Tolerance, solve};
use rc_theory::full_contact;
use rc_theory::persson::Persson;

use crate::chart::draw_panels;
use crate::{Figure, Preset, Table};
use published::Published;

/// Elastic energy of full contact per nominal area, divided by E* and the longest wavelength.
///
/// The reference gives 2.2349e-7 m for a wavelength of 2π/1e4 m. It is the reference's only number that determines the
/// heights on its lattice of waves. The rms slope is not given.
const FULL_ENERGY: f64 = 2.2349e-7 * 1e4 / std::f64::consts::TAU;
const HURST: f64 = 0.8;

/// Parameters of the comparison.
#[derive(Clone, Debug)]
pub struct Params {
    /// Number of the longest waves in the cell.
    longest: usize,
    /// Ratio of the longest wavelength to the shortest.
    ratio: usize,
    /// Elements along a side of the cell.
    side: usize,
    seed: u64,
    /// Mean pressures σ0/E*.
    loads: Vec<f64>,
    /// Loads with a stress distribution, and the widths of its bins (E*). The number of bins follows.
    distributions: Vec<(f64, f64)>,
    n_bins: usize,
    /// Certified relative error of the pressure in the energy norm.
    energy_tolerance: f64,
}

/// Solved contacts of one surface.
#[derive(Clone, Debug)]
pub struct Gfmd {
    params: Params,
    rms_slope: f64,
    /// Elastic energy per nominal area in full contact, in E* λ of the cell.
    full_energy: f64,
    points: Vec<Point>,
    distributions: Vec<Distribution>,
}

/// Results at one load.
#[derive(Clone, Copy, Debug)]
struct Point {
    load: f64,
    area: ContactArea,
    /// Mean gap over the rms height, with its error bar.
    mean_gap: (f64, f64),
    /// Elastic energy over that of full contact.
    energy: f64,
    published: Option<Published>,
}

/// The stress distribution under one load.
#[derive(Clone, Debug)]
struct Distribution {
    load: f64,
    stress: StressDistribution,
    theory: Persson,
}

impl Params {
    /// A surface with the reference's band, exponent, and energy of full contact.
    fn surface(&self) -> Result<Surface> {
        let surface = Surface::new(&SpectrumParams {
            hurst: HURST,
            low_cut: self.longest as f64,
            normalisation: Normalisation::RmsHeight(1.0),
            ..SpectrumParams::paper(self.longest * self.ratio, self.seed)
        })?;
        let energy = FULL_ENERGY / self.longest as f64;
        let factor = (energy / full_energy(&surface)).sqrt();
        Ok(surface.scaled(factor))
    }
}

impl Figure for Gfmd {
    const NAME: &'static str = "gfmd";
    type Params = Params;

    /// Eight longest waves of 100 shortest waves each on 4096² elements (full).
    ///
    /// The quick preset has 4 of 16 on 512² elements.
    fn params(preset: Preset) -> Result<Params> {
        let all: Vec<f64> = published::all()?.iter().map(|one| one.load).collect();
        Ok(match preset {
            Preset::Full => Params {
                longest: 8,
                ratio: 100,
                side: 4096,
                seed: 1,
                loads: all,
                distributions: vec![(0.025, 0.01), (0.113, 0.02), (0.24, 0.025)],
                n_bins: 50,
                energy_tolerance: 0.01,
            },
            Preset::Quick => Params {
                longest: 4,
                ratio: 16,
                side: 512,
                seed: 1,
                loads: vec![1e-3, 0.025, 0.113],
                distributions: vec![(0.025, 0.02), (0.113, 0.04)],
                n_bins: 20,
                // A tighter tolerance makes the effect of other vector instructions small.
                energy_tolerance: 1e-4,
            },
        })
    }

    fn compute(params: &Params) -> Result<Self> {
        let surface = params.surface()?;
        let mut figure = Self {
            params: params.clone(),
            rms_slope: surface.moments().rms_slope,
            full_energy: full_energy(&surface),
            points: Vec::new(),
            distributions: Vec::new(),
        };
        for &load in &params.loads {
            figure.press(&surface, load).with_context(|| format!("σ0/E* = {load:e}"))?;
        }
        Ok(figure)
    }

    fn tables(&self) -> Vec<Table> {
        vec![self.surface_table(), self.areas_table(), self.curve_table(), self.stress_table()]
    }
}

impl Picture for Gfmd {
    fn size(&self) -> (u32, u32) {
        (2000, 1700)
    }

    fn draw<B: DrawingBackend>(&self, area: &Area<B>) -> Result<(), PictureError> {
        let panels = [self.kappa_panel(), self.difference_panel(), self.stress_panel(), self.gap_and_energy_panel()];
        draw_panels(area, (2, 2), &panels)
    }
}

impl Gfmd {
    /// Solves one load.
    fn press(&mut self, surface: &Surface, load: f64) -> Result<()> {
        let tolerance = Tolerance::Energy(self.params.energy_tolerance);
        let params = SolveParams { tolerance, ..SolveParams::certified() };
        let solution = solve(surface.on(Grid::square(self.params.side)?), Control::MeanPressure(load), &params)?;
        let observables = *solution.observables();
        let rms_height = surface.moments().rms_height;
        self.points.push(Point {
            load,
            area: observables.area,
            mean_gap: (observables.mean_gap / rms_height, observables.mean_gap_error / rms_height),
            energy: observables.elastic_energy / self.full_energy,
            published: self.published(load)?,
        });
        let bins = self.params.distributions.iter().find(|(of, _)| of.total_cmp(&load).is_eq());
        if let Some(&(_, width)) = bins {
            let edges: Vec<f64> = (0..=self.params.n_bins).map(|bin| width * bin as f64).collect();
            self.distributions.push(Distribution {
                load,
                stress: StressDistribution::with_area(solution.pressure(), &edges, observables.area.fraction),
                theory: Persson::from_rms_slope(load, self.rms_slope),
            });
        }
        Ok(())
    }

    /// The published areas at this load; `None` for a surface smaller than the reference's.
    fn published(&self, load: f64) -> Result<Option<Published>> {
        let is_reference = self.params.ratio == 100;
        Ok(published::all()?.into_iter().find(|one| is_reference && one.load.total_cmp(&load).is_eq()))
    }

    /// Persson's contact area at this load.
    fn theory(&self, load: f64) -> f64 {
        Persson::from_rms_slope(load, self.rms_slope).area_fraction()
    }
}

/// Elastic energy of full contact per nominal area, summed over all waves.
fn full_energy(surface: &Surface) -> f64 {
    let n = surface.waves() as i64;
    let column = |kx: i64| -> f64 {
        let of_column = (-n..=n).map(|ky| (kx as f64).hypot(ky as f64) * surface.amplitude(kx, ky).norm_sqr());
        of_column.sum::<f64>() * if kx == 0 { 1.0 } else { 2.0 }
    };
    full_contact::energy(std::f64::consts::TAU * (0..=n).map(column).sum::<f64>())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figure::tests::{assert_reviewed, assert_written};

    /// Integrals over the reference's spectrum give 6 µm and 0.2766. Sums over a lattice of waves differ from them.
    #[test]
    fn the_surface_is_that_of_the_reference() {
        let params = Gfmd::params(Preset::Full).expect("published loads");
        let surface = params.surface().expect("a surface");
        let energy = full_energy(&surface) * params.longest as f64 * std::f64::consts::TAU * 1e-4;
        assert!((energy / 2.2349e-7 - 1.0).abs() < 1e-12, "{energy:e}");
        let moments = surface.moments();
        let height = moments.rms_height * params.longest as f64 * std::f64::consts::TAU * 1e-4;
        assert!((height / 6e-6 - 1.0).abs() < 1e-2 && (moments.rms_slope / 0.2766 - 1.0).abs() < 1e-2, "{moments:?}");
        assert_eq!((surface.waves(), surface.amplitude(5, 6) == rc_fractal::Complex64::ZERO), (800, true));
    }

    #[test]
    fn quick_gfmd_is_as_reviewed_and_can_be_drawn() {
        let params = Gfmd::params(Preset::Quick).expect("published loads");
        let figure = Gfmd::compute(&params).expect("the quick figure is solved");
        for distribution in &figure.distributions {
            let point = figure.points.iter().find(|point| point.load.total_cmp(&distribution.load).is_eq());
            let area = point.expect("its load").area;
            let of_stress = distribution.stress.area_fraction / area.fraction - 1.0;
            assert!(of_stress.abs() < 3e-2, "the area of the distribution is off by {of_stress:e}");
        }
        // From a fifteenth of contact on, the energy grows with the load and the gap closes.
        assert!(
            figure.points.windows(2).all(|two| two[0].energy < two[1].energy && two[0].mean_gap.0 > two[1].mean_gap.0)
        );
        assert_reviewed(&figure, &params, &["gfmd-surface", "gfmd-areas", "gfmd-curve", "gfmd-stress"]);
        assert_written(&figure);
    }
}
