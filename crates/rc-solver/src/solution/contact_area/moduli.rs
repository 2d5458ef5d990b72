//! The moduli that edges of contacts see under a sliding surface.
//!
//! At an edge, p = c √s inside and g = (4c/3M) s^{3/2} outside, with the modulus M of the waves that the edge is made
//! of. Across an edge these are waves of a few elements; along it, those of the chord of the contact. Where an edge
//! moves across, its short waves are glassy. Where it moves along itself, its material relaxes as it passes the chord.

use std::f64::consts::TAU;

use rc_core::{Complex64, Field, Grid, Kernel};

/// Elements in a wave that an edge is made of.
const ELEMENTS: f64 = 2.0;

/// M for edges across x and for edges across y, in E*: the best values, and those of longer and of shorter waves.
///
/// `None` if nothing slides.
pub(crate) fn moduli(kernel: &dyn Kernel, pressure: &Field) -> Option<[[f64; 2]; 3]> {
    let grid = pressure.grid();
    let (slides, rest) = (kernel.sliding_symbol(grid)?, kernel.symbol(grid));
    let chords = chords(pressure);
    let (nx, ny) = (grid.nx() as i64, grid.ny() as i64);
    let within = |waves: f64, n: i64| (waves.round() as i64).clamp(0, n / 2);
    let modulus = |kx: i64, ky: i64| {
        if (kx, ky) == (0, 0) {
            return 1.0;
        }
        // Both mirror images of an edge occur.
        let both = [slides(kx, ky), slides(kx, -ky)].map(Complex64::norm);
        2.0 * rest(kx as usize, ky as usize) / (both[0] + both[1])
    };
    let of_waves = |factor: f64| {
        let across = |n: i64| within(factor * n as f64 / ELEMENTS, n);
        let along = |i: usize, n: i64| within(factor * n as f64 / (2.0 * chords[i]), n);
        [modulus(across(nx), along(1, ny)), modulus(along(0, nx), across(ny))]
    };
    Some(with_longer(of_waves(1.0), of_waves(0.5)))
}

/// [`moduli`] of a surface that slides along x, with contacts of `chord` elements of this `side`.
///
/// `compliance` is |J~| of a wave along x.
pub(crate) fn edge_moduli(chord: f64, side: f64, compliance: impl Fn(f64) -> f64) -> [[f64; 2]; 3] {
    let modulus = |elements: f64| compliance(TAU / (elements * side)).recip();
    let of_waves = |factor: f64| [modulus(ELEMENTS / factor), modulus(2.0 * chord.max(1.0) / factor)];
    with_longer(of_waves(1.0), of_waves(0.5))
}

/// The best moduli, those of longer waves, and as much larger ones.
fn with_longer(best: [f64; 2], longer: [f64; 2]) -> [[f64; 2]; 3] {
    [best, longer, [0, 1].map(|i| best[i] * best[i] / longer[i])]
}

/// Mean number of elements in contact from edge to edge, along x and y.
fn chords(pressure: &Field) -> [f64; 2] {
    let grid: Grid = pressure.grid();
    let (nx, ny) = (grid.nx(), grid.ny());
    let mut counts = [0_usize; 3];
    for iy in 0..ny {
        let (row, next) = (pressure.row(iy), pressure.row((iy + 1) % ny));
        for (ix, &p) in row.iter().enumerate() {
            if p > 0.0 {
                counts[0] += 1;
                counts[1] += usize::from(row[(ix + 1) % nx] <= 0.0);
                counts[2] += usize::from(next[ix] <= 0.0);
            }
        }
    }
    [1, 2].map(|axis| counts[0].max(1) as f64 / counts[axis].max(1) as f64)
}
