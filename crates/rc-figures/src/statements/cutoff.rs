//! Area and elastic energy against the number of waves N.
//!
//! All surfaces have the paper's load and the same long waves, and N exceeds the paper's two values. Only differences
//! between values of N matter here. Contact edges are located between the centres of elements, so coarse elements are
//! enough.

use anyhow::{Context, Result};
use rc_core::{Grid, HeightField as _};
use rc_fractal::{SpectrumParams, Surface};
use rc_solver::{Control, SolveParams, solve};

use super::params::Params;
use crate::fit::Sample;
use crate::{Rule, Table, number};

/// Averages over realisations for one N.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cutoff {
    pub(super) waves: usize,
    pub(super) rms_slope: f64,
    /// A/A0.
    pub(super) area: Sample,
    /// Ratio of the area to the area with the fewest waves, realisation by realisation.
    pub(super) area_ratio: Sample,
    /// κ = (A/A0) g E*/σ0 with the rms slope g.
    kappa: f64,
    /// Elastic energy per nominal area, in E* λ.
    energy: Sample,
    /// Ratio of the elastic energy to that with the fewest waves, realisation by realisation.
    pub(super) energy_ratio: Sample,
    /// Δ/h_max.
    penetration: Sample,
}

/// Results of one contact.
struct Contact {
    area: f64,
    energy: f64,
    penetration: f64,
}

pub(super) fn solve_all(params: &Params) -> Result<Vec<Cutoff>> {
    let mut first: Option<Vec<Contact>> = None;
    let mut cutoffs = Vec::new();
    for &waves in &params.waves {
        let surface = |seed: u64| Surface::new(&SpectrumParams::paper(waves, seed));
        let contacts = params.seeds.iter().map(|&seed| contact(params, &surface(seed)?)).collect::<Result<Vec<_>>>()?;
        let rms_slope =
            params.seeds.first().map_or(Ok(0.0), |&seed| Ok::<_, anyhow::Error>(surface(seed)?.moments().rms_slope))?;
        let sample = |of: fn(&Contact) -> f64| Sample::of(&contacts.iter().map(of).collect::<Vec<_>>());
        let fewest = first.as_ref().unwrap_or(&contacts);
        let ratio = |of: fn(&Contact) -> f64| {
            Sample::of(&contacts.iter().zip(fewest).map(|(a, b)| of(a) / of(b)).collect::<Vec<_>>())
        };
        let area = sample(|contact| contact.area);
        cutoffs.push(Cutoff {
            waves,
            rms_slope,
            area,
            area_ratio: ratio(|contact| contact.area),
            kappa: area.mean * rms_slope / params.load,
            energy: sample(|contact| contact.energy),
            energy_ratio: ratio(|contact| contact.energy),
            penetration: sample(|contact| contact.penetration),
        });
        first.get_or_insert(contacts);
    }
    Ok(cutoffs)
}

fn contact(params: &Params, surface: &Surface) -> Result<Contact> {
    let heights = surface.on(Grid::square(params.elements_per_wave * surface.waves())?);
    let solution = solve(heights, Control::MeanPressure(params.load), &SolveParams::to_tolerance(params.tolerance))
        .with_context(|| format!("N = {}", surface.waves()))?;
    let info = solution.info();
    Ok(Contact {
        area: solution.area().fraction,
        energy: info.elastic_energy,
        penetration: info.penetration / info.penetration_full_contact,
    })
}

pub(super) fn table(cutoffs: &[Cutoff]) -> Table {
    let header = [
        "waves",
        "rms_slope",
        "area_fraction",
        "area_standard_error",
        "area_over_first",
        "kappa",
        "energy_over_e_star_side",
        "energy_over_first",
        "energy_over_first_standard_error",
        "penetration_over_h_max",
    ];
    let rows = cutoffs.iter().map(|cutoff| {
        let Cutoff { rms_slope, area, area_ratio, kappa, energy, energy_ratio, penetration, .. } = *cutoff;
        let numbers = [
            rms_slope,
            area.mean,
            area.error(),
            area_ratio.mean,
            kappa,
            energy.mean,
            energy_ratio.mean,
            energy_ratio.error(),
            penetration.mean,
        ];
        [cutoff.waves.to_string()].into_iter().chain(numbers.map(number)).collect()
    });
    Table::new("cutoff", &header, rows)
        .rest(Rule::relative(1e-4))
        .column("area_standard_error", Rule::of_scale(5e-4))
        .column("energy_over_first_standard_error", Rule::of_scale(5e-4))
}
