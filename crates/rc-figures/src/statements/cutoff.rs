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
use crate::table::Rows;
use crate::{Rule, Table};

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
    Rows::of(cutoffs)
        .column("waves", |cutoff| cutoff.waves)
        .column("rms_slope", |cutoff| cutoff.rms_slope)
        .column("area_fraction", |cutoff| cutoff.area.mean)
        .within("area_standard_error", Rule::of_scale(5e-4), |cutoff| cutoff.area.error())
        .column("area_over_first", |cutoff| cutoff.area_ratio.mean)
        .column("kappa", |cutoff| cutoff.kappa)
        .column("energy_over_e_star_side", |cutoff| cutoff.energy.mean)
        .column("energy_over_first", |cutoff| cutoff.energy_ratio.mean)
        .within("energy_over_first_standard_error", Rule::of_scale(5e-4), |cutoff| cutoff.energy_ratio.error())
        .column("penetration_over_h_max", |cutoff| cutoff.penetration.mean)
        .table("cutoff")
        .rest(Rule::relative(1e-4))
}
