//! The surface of the Contact-Mechanics Challenge without adhesion.
//!
//! The results are area, gap, stiffness and patches against the load.
//!
//! Problem: M. H. Müser, W. B. Dapp, *The contact mechanics challenge: problem definition*, arXiv:1512.02403 (2015); M.
//! H. Müser et al., *Meeting the contact-mechanics challenge*, Tribol. Lett. 65 (2017) 118. The published problem is
//! adhesive, this one is not.

mod drawing;
mod large;
mod tables;

use std::path::PathBuf;
use std::time::Instant;

use anyhow::{Context, Result};
use plotters::prelude::DrawingBackend;
use rc_core::{Grid, HeightField as _, Kernel as _};
use rc_fractal::{Complex64, Normalisation, SpectrumParams, Surface, Wave};
use rc_heights::spectrum;
use rc_kernel::Love;
use rc_plot::{Area, Picture, PictureError};
use rc_solver::{ContactArea, ContactSpot, Control, Observables, Solution, SolveParams, Tolerance, solve};

use crate::chart::draw_panels;
use crate::{Figure, Preset, Table};

pub use large::Large;

/// Side of the cell (µm); E* (MPa) follows.
const CELL_UM: f64 = 100.0;
const E_STAR_MPA: f64 = 25.0;
/// Rms slope of the whole gradient.
const RMS_SLOPE: f64 = 1.0;
/// Mean pressure of most published data, in E*.
pub const REFERENCE_LOAD: f64 = 0.01;

/// Origin of the surface.
#[derive(Clone, Debug)]
pub enum Source {
    /// A generated surface with the spectrum of the distributed one and other random phases.
    Generated {
        /// Number of the shortest waves in the cell, λ/`λ_s`.
        waves: usize,
        /// Seed of the phases.
        seed: u64,
    },
    /// A surface from the distributed coefficients, scaled to the rms slope of the problem.
    File {
        /// File of the coefficients.
        path: PathBuf,
        /// Whether the heights change their sign.
        is_flipped: bool,
    },
}

/// Surface, grid, loads and tolerance.
#[derive(Clone, Debug)]
pub struct Params {
    /// Origin of the surface.
    pub source: Source,
    /// Elements along a side of the cell.
    side: usize,
    /// Mean pressures σ0/E*.
    loads: Vec<f64>,
    /// Certified relative error of the pressure in the energy norm.
    energy_tolerance: f64,
}

/// Solved contacts of the surface.
#[derive(Clone, Debug)]
pub struct Challenge {
    side: usize,
    waves: usize,
    rms_height: f64,
    rms_slope: f64,
    points: Vec<Point>,
}

/// The contact under one load, in units of λ and E*.
#[derive(Clone, Debug)]
struct Point {
    load: f64,
    solved: Solved,
    /// Areas of the patches relative to the cell, largest first.
    patches: Vec<f64>,
}

/// Results of a solved contact without its fields.
#[derive(Clone, Copy, Debug)]
struct Solved {
    area: ContactArea,
    observables: Observables,
    stiffness: f64,
    n_in_contact: usize,
    seconds: f64,
}

impl Params {
    /// The parameters of a preset with another surface.
    ///
    /// # Errors
    /// As [`Figure::params`].
    pub fn with_source(preset: Preset, source: Option<Source>) -> Result<Self> {
        let params = Challenge::params(preset)?;
        Ok(Self { source: source.unwrap_or_else(|| params.source.clone()), ..params })
    }
}

impl Source {
    /// The surface on the unit cell.
    ///
    /// # Errors
    /// When the file cannot be read, or its waves make no surface.
    fn surface(&self) -> Result<Surface> {
        match self {
            Self::Generated { waves, seed } => Ok(Surface::new(&SpectrumParams {
                roll_off: 5.0,
                normalisation: Normalisation::RmsSlope(RMS_SLOPE),
                ..SpectrumParams::paper(*waves, *seed)
            })?),
            Self::File { path, is_flipped } => {
                let wave = |one: spectrum::Coefficient| Wave {
                    kx: one.kx,
                    ky: one.ky,
                    amplitude: Complex64::new(one.re, one.im),
                };
                let waves = spectrum::read(path)?.into_iter().map(wave).collect();
                let surface = Surface::from_waves(waves).with_context(|| path.display().to_string())?;
                let factor = RMS_SLOPE / surface.moments().rms_slope;
                Ok(surface.scaled(if *is_flipped { -factor } else { factor }))
            }
        }
    }
}

/// Solves the contact of `surface` under the mean pressure `load`.
///
/// `with` takes further results from the solution.
fn press<T>(
    surface: &Surface,
    (side, load, energy_tolerance): (usize, f64, f64),
    with: impl FnOnce(&Solution<'_>) -> T,
) -> Result<(Solved, T)> {
    let start = Instant::now();
    let params = SolveParams { tolerance: Tolerance::Energy(energy_tolerance), ..SolveParams::certified() };
    let solution = solve(surface.on(Grid::square(side)?), Control::MeanPressure(load), &params)
        .with_context(|| format!("σ0/E* = {load:e} on {side}²"))?;
    let observables = *solution.observables();
    let seconds = start.elapsed().as_secs_f64();
    let (area, stiffness) = (observables.area, solution.stiffness());
    Ok((Solved { area, observables, stiffness, n_in_contact: solution.n_in_contact(), seconds }, with(&solution)))
}

impl Figure for Challenge {
    const NAME: &'static str = "challenge";
    type Params = Params;

    /// The generated surface with 1000 waves on 4096² elements, up to 15 % contact (full).
    ///
    /// The quick preset has 40 waves on 320² elements.
    fn params(preset: Preset) -> Result<Params> {
        Ok(match preset {
            Preset::Full => Params {
                source: Source::Generated { waves: 1000, seed: 1 },
                side: 4096,
                loads: vec![5e-4, 1e-3, 2e-3, 5e-3, REFERENCE_LOAD, 0.02, 0.04, 0.075],
                energy_tolerance: 0.01,
            },
            Preset::Quick => Params {
                source: Source::Generated { waves: 40, seed: 1 },
                side: 320,
                loads: vec![2e-3, REFERENCE_LOAD, 0.04],
                // A tighter tolerance makes the effect of other vector instructions small.
                energy_tolerance: 1e-4,
            },
        })
    }

    fn compute(params: &Params) -> Result<Self> {
        let surface = params.source.surface()?;
        let moments = surface.moments();
        let areas = |solution: &Solution<'_>| {
            let spots = ContactSpot::all(solution.pressure(), solution.gap(), Love.edge_bias(solution.grid()));
            spots.iter().map(|spot| spot.area_fraction).collect()
        };
        let point = |&load: &f64| {
            let (solved, patches) = press(&surface, (params.side, load, params.energy_tolerance), areas)?;
            Ok(Point { load, solved, patches })
        };
        Ok(Self {
            side: params.side,
            waves: surface.waves(),
            rms_height: moments.rms_height,
            rms_slope: moments.rms_slope,
            points: params.loads.iter().map(point).collect::<Result<_>>()?,
        })
    }

    fn tables(&self) -> Vec<Table> {
        vec![self.surface_table(), self.curve_table(), self.patches_table()]
    }
}

impl Picture for Challenge {
    fn size(&self) -> (u32, u32) {
        (2000, 1700)
    }

    fn draw<B: DrawingBackend>(&self, area: &Area<B>) -> Result<(), PictureError> {
        let panels = [self.area_panel(), self.gap_panel(), self.stiffness_panel(), self.patches_panel()];
        draw_panels(area, (2, 2), &panels)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figure::tests::{assert_reviewed, assert_written};

    #[test]
    fn the_surface_is_that_of_the_problem() {
        let source = Challenge::params(Preset::Full).expect("parameters").source;
        let moments = source.surface().expect("a surface").moments();
        assert!((moments.rms_slope - 1.0).abs() < 1e-12, "{moments:?}");
        // The integral over plateau and power law gives 0.7765 µm. The sum over a lattice of waves is slightly larger.
        assert!((moments.rms_height * CELL_UM / 0.7765 - 1.0).abs() < 0.01, "{moments:?}");
    }

    #[test]
    fn distributed_coefficients_are_scaled_to_the_slope_and_may_be_turned_over() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("waves.dat");
        std::fs::write(&path, "# qX, qY, Re, Im\n3, 4, 100, 50\n-1, 2, 0, 30\n").expect("a file");
        let surface = |is_flipped| {
            let surface = Source::File { path: path.clone(), is_flipped }.surface().expect("a surface");
            assert!((surface.moments().rms_slope - 1.0).abs() < 1e-14);
            surface.amplitude(3, 4)
        };
        assert_eq!(surface(true), -surface(false));
        assert!(surface(false).re > 0.0 && (surface(false).im / surface(false).re - 0.5).abs() < 1e-14);
    }

    #[test]
    fn quick_challenge_is_as_reviewed_and_can_be_drawn() {
        let params = Challenge::params(Preset::Quick).expect("parameters");
        let figure = Challenge::compute(&params).expect("the quick figure is solved");
        for Point { load, solved, patches } in &figure.points {
            let sum = patches.iter().sum::<f64>() / solved.area.fraction - 1.0;
            // The fields of the adaptive method are rounded, but the sums within the method are not.
            assert!(sum.abs() < 1e-6, "σ0 = {load}: the patches add up to the area but for {sum:e}");
        }
        assert_reviewed(&figure, &params, &["challenge-surface", "challenge-curve", "challenge-patches"]);
        assert_written(&figure);
    }
}
