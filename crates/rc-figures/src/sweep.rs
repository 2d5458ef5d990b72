//! Contacts of the paper's surfaces at many loads, for Fig. 5 and Fig. 7.
//!
//! Realisation s of each N has seed s. So realisations of N = 64 and N = 128 share their long waves, and their
//! difference is due to the short waves.

use anyhow::{Context, Result};
use rc_core::{Grid, HeightField as _};
use rc_fractal::{SpectrumParams, Surface};
use rc_solver::{Control, SolveParams, solve};

use crate::fit::Sample;
use crate::table::Rows;
use crate::{Preset, Rule, Table, paper};

/// Elements for the shortest wave. Their side is λ_min/32, half as large as the paper's.
pub(crate) const ELEMENTS_PER_WAVE: usize = 32;

/// Surfaces, loads and tolerance.
#[derive(Clone, Debug)]
pub(crate) struct Params {
    /// Numbers of waves N.
    pub(crate) waves: Vec<usize>,
    /// Elements per shortest wave.
    elements_per_wave: usize,
    /// Mean pressures σ0/E*, increasing.
    pub(crate) loads: Vec<f64>,
    /// Seeds of the realisations.
    seeds: Vec<u64>,
    /// Further seeds for one load. They tell how far an average of seven may be from that of all surfaces.
    more_seeds: Vec<u64>,
    /// Load of the further seeds.
    more_load: f64,
    /// Relative tolerance of the solves.
    tolerance: f64,
}

impl Params {
    /// The parameters of a preset.
    ///
    /// The full one has the paper's surfaces and number of realisations, with loads from first touch to nearly full
    /// contact. The quick one has 8 and 16 waves, three realisations and fewer loads.
    pub(crate) fn of(preset: Preset) -> Result<Self> {
        let load = paper::value("load")?;
        let realisations = paper::value("realisations")? as u64;
        Ok(match preset {
            Preset::Full => Self {
                waves: paper::both_waves()?.into(),
                elements_per_wave: ELEMENTS_PER_WAVE,
                loads: vec![1e-5, 3e-5, 1e-4, 2e-4, 4e-4, 6e-4, load, 1.2e-3, 1.5e-3, 2.5e-3, 4e-3, 7e-3],
                seeds: (1..=realisations).collect(),
                more_seeds: (realisations + 1..=4 * realisations).collect(),
                more_load: load,
                tolerance: 1e-6,
            },
            Preset::Quick => Self {
                waves: vec![8, 16],
                elements_per_wave: ELEMENTS_PER_WAVE / 2,
                loads: vec![3e-5, 1e-4, 2e-4, 4e-4, load, 1.5e-3, 4e-3, 1e-2],
                seeds: vec![1, 2, 3],
                more_seeds: vec![4, 5, 6],
                more_load: load,
                tolerance: 1e-8,
            },
        })
    }
}

/// Results of one contact, with lengths relative to the rms height or the highest point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct State {
    pub(crate) waves: usize,
    pub(crate) seed: u64,
    /// σ0/E*.
    pub(crate) load: f64,
    /// A/A0, best estimate.
    pub(crate) area: f64,
    /// A/A0 by counting elements.
    pub(crate) area_cells: f64,
    /// Δ/h_max.
    pub(crate) penetration: f64,
    /// Mean gap divided by the rms height.
    pub(crate) mean_gap: f64,
    /// h_max divided by the rms height.
    pub(crate) h_max: f64,
}

/// All contacts, ordered by N, realisation and load.
#[derive(Clone, Debug)]
pub(crate) struct Sweep {
    pub(crate) states: Vec<State>,
    /// Contacts of the further realisations.
    more: Vec<State>,
    pub(crate) surfaces: Vec<SurfaceOf>,
}

/// Properties that all realisations of one N share.
///
/// Amplitudes are fixed, so all have the same rms slope.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SurfaceOf {
    pub(crate) waves: usize,
    pub(crate) rms_slope: f64,
}

impl Sweep {
    /// Solves all contacts one after the other, since one solve uses all threads.
    pub(crate) fn solve(params: &Params) -> Result<Self> {
        let mut sweep = Self { states: Vec::new(), more: Vec::new(), surfaces: Vec::new() };
        for &waves in &params.waves {
            for &seed in &params.seeds {
                let surface = Surface::new(&SpectrumParams::paper(waves, seed))?;
                for &load in &params.loads {
                    sweep.states.push(state(params, &surface, (waves, seed, load))?);
                }
            }
            let mut rms_slope = 0.0;
            for &seed in &params.more_seeds {
                let surface = Surface::new(&SpectrumParams::paper(waves, seed))?;
                rms_slope = surface.moments().rms_slope;
                sweep.more.push(state(params, &surface, (waves, seed, params.more_load))?);
            }
            sweep.surfaces.push(SurfaceOf { waves, rms_slope });
        }
        Ok(sweep)
    }

    /// Mean and scatter as in [`Sweep::sample`], with the further realisations of that load.
    pub(crate) fn larger_sample(&self, waves: usize, load: f64, of: impl Fn(&State) -> f64) -> Sample {
        Sample::of(&self.all_at(waves, load).map(of).collect::<Vec<_>>())
    }

    /// Ratio of the areas of two N, realisation by realisation.
    ///
    /// The two surfaces of a pair share their long waves.
    pub(crate) fn area_ratio(&self, waves: usize, over: usize, load: f64) -> Sample {
        let pairs = self.all_at(waves, load).zip(self.all_at(over, load)).filter(|(a, b)| a.seed == b.seed);
        Sample::of(&pairs.map(|(a, b)| a.area / b.area).collect::<Vec<_>>())
    }

    fn all_at(&self, waves: usize, load: f64) -> impl Iterator<Item = &State> {
        let is_it = move |state: &&State| state.waves == waves && state.load.total_cmp(&load).is_eq();
        self.states.iter().chain(&self.more).filter(is_it)
    }

    /// The contacts of one N and load, by realisation.
    pub(crate) fn at(&self, waves: usize, load: f64) -> impl Iterator<Item = &State> {
        self.states.iter().filter(move |state| state.waves == waves && state.load.total_cmp(&load).is_eq())
    }

    /// Mean and scatter of a result over the realisations.
    pub(crate) fn sample(&self, waves: usize, load: f64, of: impl Fn(&State) -> f64) -> Sample {
        Sample::of(&self.at(waves, load).map(of).collect::<Vec<_>>())
    }

    /// The contacts of each realisation of one N, by load.
    pub(crate) fn realisations(&self, waves: usize) -> impl Iterator<Item = &[State]> {
        self.states.chunk_by(|a, b| (a.waves, a.seed) == (b.waves, b.seed)).filter(move |run| run[0].waves == waves)
    }

    /// Table of all contacts.
    pub(crate) fn table(&self) -> Table {
        let (area, length) = (Rule::relative(5e-4), Rule::of_scale(1e-5));
        Rows::of(self.states.iter().chain(&self.more))
            .column("waves", |state| state.waves)
            .column("seed", |state| state.seed)
            .column("mean_pressure_over_e_star", |state| state.load)
            .within("area_fraction", area, |state| state.area)
            .within("area_fraction_by_counting", area, |state| state.area_cells)
            .within("penetration_over_h_max", length, |state| state.penetration)
            .within("mean_gap_over_rms_height", length, |state| state.mean_gap)
            .within("h_max_over_rms_height", Rule::relative(1e-5), |state| state.h_max)
            .table("realisations")
    }
}

fn state(params: &Params, surface: &Surface, (waves, seed, load): (usize, u64, f64)) -> Result<State> {
    let heights = surface.on(Grid::square(params.elements_per_wave * waves)?);
    let solution = solve(heights, Control::MeanPressure(load), &SolveParams::to_tolerance(params.tolerance))
        .with_context(|| format!("N = {waves}, seed {seed}, σ0/E* = {load:e}"))?;
    let area = solution.area();
    let (info, rms_height) = (solution.info(), surface.moments().rms_height);
    Ok(State {
        waves,
        seed,
        load,
        area: area.fraction,
        area_cells: area.cells,
        penetration: info.penetration / info.penetration_full_contact,
        mean_gap: (info.penetration_full_contact - info.penetration) / rms_height,
        h_max: info.penetration_full_contact / rms_height,
    })
}
