//! The radially averaged power spectrum of any height map.

use std::f64::consts::TAU;

use rc_core::Field;

use crate::power::PowerSpectrum;

/// A ring of wave vectors.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct SpectrumBin {
    /// Mean |k| of the wave vectors in the ring, in waves per λ.
    pub wavenumber: f64,
    /// Mean of C = |`a_k`|² A0/(2π)² over the wave vectors in the ring, in λ⁴. A0 = 1 for a square cell.
    pub psd: f64,
    /// Number of wave vectors in the ring, where k and -k are counted separately.
    pub n_modes: usize,
}

/// Radially averaged spectrum C(q) of a height map.
///
/// Rings have width 1 about |k| = 1, 2, 3, …, in waves per longer side of the cell. The ring of the longest waves is
/// first. Every wave vector of the grid except k = 0 is in one ring. Hence Σ (2π)² `psd` · `n_modes` / A0 = ⟨h²⟩ about
/// the mean, exactly (Parseval; the sum is ∫ C d²q).
///
/// Rings beyond half the shorter side of the grid contain only wave vectors in the corners of the spectrum. A ring
/// averages over |k| ± ½. So C of a power law is too high where the ring is wide relative to |k|. It is too low in the
/// ring at the truncation, half of which is empty.
///
/// Source: T. D. B. Jacobs, T. Junge, L. Pastewka, *Quantitative characterization of surface topography using spectral
/// analysis*, Surf. Topogr.: Metrol. Prop. 5 (2017) 013001. Tests `thin_rings_recover_the_power_law_to_rounding` and
/// `rings_add_up_to_the_mean_square_height`.
#[must_use]
pub fn radial_spectrum(heights: &Field) -> Vec<SpectrumBin> {
    // If the cell is longer along y, its longest waves are shorter than one per side along x.
    binned_spectrum(heights, heights.grid().cell_ratio().max(1.0))
}

/// Means over rings of the spectrum of Eq. (11).
///
/// There are `rings_per_wave` rings for each unit of |k|. Rings without a wave vector are omitted.
fn binned_spectrum(heights: &Field, rings_per_wave: f64) -> Vec<SpectrumBin> {
    #[derive(Clone, Copy, Default)]
    struct Ring {
        n_modes: usize,
        wavenumbers: f64,
        power: f64,
    }
    let grid = heights.grid();
    let ratio = grid.cell_ratio();
    let largest = (grid.nx() as f64 / 2.0).hypot(grid.ny() as f64 / 2.0 / ratio);
    let mut rings = vec![Ring::default(); (largest * rings_per_wave).round() as usize + 1];
    for column in PowerSpectrum::of(heights).columns() {
        let weight = column.multiplicity as f64;
        for (ky, power) in column.powers() {
            let wavenumber = grid.waves(column.kx, ky);
            let ring = &mut rings[(wavenumber * rings_per_wave).round() as usize];
            ring.n_modes += column.multiplicity;
            ring.wavenumbers += weight * wavenumber;
            ring.power += weight * power;
        }
    }
    // Ring 0 holds only the mean height, which is not a wave.
    let waves = rings.iter().skip(1).filter(|ring| ring.n_modes > 0);
    waves
        .map(|ring| {
            let count = ring.n_modes as f64;
            let psd = ring.power * ratio / (TAU * TAU * count);
            SpectrumBin { wavenumber: ring.wavenumbers / count, psd, n_modes: ring.n_modes }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use rc_core::{Grid, HeightField};

    use super::*;
    use crate::{Normalisation, SpectrumParams, Surface};

    /// In very thin rings all waves have the same |k|, so averaging changes nothing.
    #[test]
    fn thin_rings_recover_the_power_law_to_rounding() {
        let (c0, roll_off) = (3e-9, 4.5);
        let params = SpectrumParams { normalisation: Normalisation::C0(c0), roll_off, ..SpectrumParams::paper(24, 5) };
        let surface = Surface::new(&params).expect("valid parameters");
        let heights = surface.sample(Grid::new(64, 51).expect("small grid"));
        let mut n_modes = 0;
        for bin in binned_spectrum(&heights, 1000.0) {
            let k = bin.wavenumber;
            let expected = if k < 24.0 + 1e-9 { c0 * (k.max(roll_off) / roll_off).powf(-3.6) } else { 0.0 };
            let error = (bin.psd - expected).abs();
            assert!(error <= 1e-12 * expected + 1e-30, "C({k}) = {:e}, asked for {expected:e}", bin.psd);
            n_modes += bin.n_modes;
        }
        assert_eq!(n_modes, 64 * 51 - 1);
    }
}
