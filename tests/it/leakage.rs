//! Flow through solved rough contacts against effective medium theory, and the contact area at which it ends against published values.

use std::collections::BTreeMap;

use rc_core::{Field, Grid};

use rc_fractal::{SpectrumParams, Surface, height_and_slope_of_grid};
use rc_kernel::Love;
use rc_leakage::{LeakageParams, leakage};
use rc_solver::Control;

use crate::solved;

/// The gap of a rough contact under a mean pressure in units of E* times the rms slope, 0 where they touch; and the part of elements that do.
fn contact(seed: u64, waves: usize, n: usize, pressure: f64) -> (Field, f64) {
    let params = SpectrumParams { roll_off: 4.0, ..SpectrumParams::paper(waves, seed) };
    let surface = Surface::new(&params).expect("a surface");
    let heights = surface.sample_on(Grid::square(n).expect("a grid")).expect("heights");
    let [_, slope] = height_and_slope_of_grid(&heights);
    let solution = solved(&heights, &Love, Control::MeanPressure(pressure * slope), 1e-7);
    let mut gap = solution.gap().clone();
    let touching = solution.pressure().values().iter().map(|pressure| *pressure > 0.0);
    for (gap, touches) in gap.values_mut().iter_mut().zip(touching) {
        *gap = if touches { 0.0 } else { gap.max(0.0) };
    }
    let closed = gap.values().iter().filter(|gap| **gap <= 0.0).count();
    let part = closed as f64 / gap.values().len() as f64;
    (gap, part)
}

/// The conductivity s of a medium in which elements of conductivity g³ are on average no disturbance: Σ (g³ - s)/(g³ + s) = 0 (Bruggeman, Ann.
/// Phys. 416, 1935; for contacts Persson, J. Phys. Condens. Matter 22, 2010).
fn effective_medium(gap: &Field) -> f64 {
    let excess = |s: f64| -> f64 { gap.values().iter().map(|gap| gap.powi(3)).map(|g| (g - s) / (g + s)).sum() };
    let (mut low, mut high) = (1e-30_f64, gap.max().powi(3));
    for _ in 0..100 {
        let middle = (low * high).sqrt();
        if excess(middle) > 0.0 { low = middle } else { high = middle }
    }
    low
}

/// The theory has no directions: it is compared with the geometric mean of both axes, which is exact for media that are their own dual.
#[test]
fn the_flow_through_rough_contacts_is_that_of_effective_medium_theory() {
    for (pressure, allowed) in [(0.03, 0.08), (0.08, 0.1)] {
        let mut ratios = Vec::new();
        for seed in 1..=4 {
            let (gap, area) = contact(seed, 16, 256, pressure);
            assert!((0.02..0.25).contains(&area), "{area}");
            let [x, y] = leakage(&gap, &LeakageParams::default()).expect("a flow").flows.map(|flow| flow.permeance);
            ratios.push((x * y).sqrt() / effective_medium(&gap));
        }
        let mean = ratios.iter().sum::<f64>() / ratios.len() as f64;
        assert!((mean - 1.0).abs() < allowed, "{pressure}: {mean} is the mean of {ratios:?}");
    }
}

/// Dapp, Lücke, Persson and Müser, Phys. Rev. Lett. 108, 2012: the film of self-affine contacts is cut near A/A0 = 0.42. A cell of a few long
/// waves scatters about it.
#[test]
fn the_film_is_cut_near_the_published_contact_area() {
    let params = LeakageParams { half_grid: false, ..LeakageParams::default() };
    let mut lost = BTreeMap::new();
    for seed in 1..=6 {
        for step in 0..12 {
            let (gap, area) = contact(seed, 32, 256, 0.17 + 0.01 * f64::from(step));
            let flows = leakage(&gap, &params).expect("a flow").flows;
            // One axis that percolates is a film.
            if flows.iter().all(|flow| !flow.percolates) {
                lost.insert(seed, area);
                break;
            }
        }
    }
    let mean = lost.values().sum::<f64>() / lost.len() as f64;
    assert!(lost.len() >= 5, "{lost:?}");
    assert!((mean - 0.42).abs() < 0.04, "{mean} is the mean of {lost:?}");
}
