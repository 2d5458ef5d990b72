//! What a sliding surface makes of the edges of contacts.
//!
//! At an edge, p = c √s inside and g = (4c/3M) s^{3/2} outside, with the modulus M of the waves that the edge is made
//! of. Across an edge these are waves of a few elements; along it, those of the chord of the contact. Where an edge
//! moves across, its short waves are glassy. Where it moves along itself, its material relaxes as it passes the chord.
//!
//! A lag shorter than an element makes contacts narrower by this lag, which their elements do not show.

use std::f64::consts::TAU;

use rc_core::{Complex64, Field, Grid, Kernel};

/// Elements in a wave that an edge is made of.
const ELEMENTS: f64 = 2.0;

/// Edges under a sliding surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SlidingEdges {
    /// M for edges across x and for edges across y, in E*: the best values, and those of longer and of shorter waves.
    pub(crate) moduli: [[f64; 2]; 3],
    /// Area that lags shorter than an element take from contacts, in the area of the cell.
    pub(crate) hidden_lag: f64,
    /// Loss tangent of the shortest wave.
    pub(crate) loss: f64,
}

impl SlidingEdges {
    /// The edges of the contacts under this `pressure`. `None` if nothing slides.
    pub(crate) fn of(kernel: &dyn Kernel, pressure: &Field) -> Option<Self> {
        let grid = pressure.grid();
        let (slides, rest) = (kernel.sliding_symbol(grid)?, kernel.symbol(grid));
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
        let n_contact = pressure.values().iter().filter(|&&p| p > 0.0).count();
        let ends = ends(pressure);
        let chords = ends.map(|ends| n_contact.max(1) as f64 / ends.max(1) as f64);
        let of_waves = |factor: f64| {
            let across = |n: i64| within(factor * n as f64 / ELEMENTS, n);
            let along = |i: usize, n: i64| within(factor * n as f64 / (2.0 * chords[i]), n);
            [modulus(across(nx), along(1, ny)), modulus(along(0, nx), across(ny))]
        };
        // The shortest waves of a grid are real. On one twice as fine they are not. The largest grids have no finer one.
        let finer = grid.with_elements(2 * grid.nx(), 2 * grid.ny());
        let (finer, nx, ny) = finer.map_or((grid, nx / 2, ny / 2), |finer| (finer, nx, ny));
        let (slides, rest) = (kernel.sliding_symbol(finer)?, kernel.symbol(finer));
        let shortest = [(nx / 2, 0), (0, ny / 2)].map(|(kx, ky)| match (kx, ky) {
            (0, 0) => Complex64::ONE,
            _ => slides(kx, ky) / rest(kx as usize, ky as usize),
        });
        let hidden = [0, 1].map(|i| hidden_lag(shortest[i]) * ends[i] as f64 / grid.len() as f64);
        Some(Self {
            moduli: with_longer(of_waves(1.0), of_waves(0.5)),
            hidden_lag: hidden[0].hypot(hidden[1]),
            loss: shortest.map(loss).into_iter().fold(0.0, f64::max),
        })
    }

    /// The edges of contacts of `chord` elements of this `side` that cover a part `cells` of the cell.
    ///
    /// The surface slides along x, and `compliance` is J~ of a wave along x.
    pub(crate) fn of_chord([chord, cells]: [f64; 2], side: f64, compliance: impl Fn(f64) -> Complex64) -> Self {
        let modulus = |elements: f64| compliance(TAU / (elements * side)).norm().recip();
        let of_waves = |factor: f64| [modulus(ELEMENTS / factor), modulus(2.0 * chord.max(1.0) / factor)];
        let shortest = compliance(TAU / (ELEMENTS * side));
        Self {
            moduli: with_longer(of_waves(1.0), of_waves(0.5)),
            hidden_lag: hidden_lag(shortest) * cells / chord.max(1.0),
            loss: loss(shortest),
        }
    }
}

/// Lag of the waves shorter than two elements, in elements, from the compliance of that wave.
///
/// A mode J/(1 - i q ℓ) with q ℓ « 1 shifts the displacement by J ℓ, which is Im J~/q, and makes a contact narrower by
/// as much (Hunter's cylinder). For ℓ above an element, Im J~/q falls as the elements show more of the lag.
fn hidden_lag(compliance: Complex64) -> f64 {
    compliance.im.abs() * ELEMENTS / TAU
}

fn loss(compliance: Complex64) -> f64 {
    (compliance.im / compliance.re).abs()
}

/// The best moduli, those of longer waves, and as much larger ones.
fn with_longer(best: [f64; 2], longer: [f64; 2]) -> [[f64; 2]; 3] {
    [best, longer, [0, 1].map(|i| best[i] * best[i] / longer[i])]
}

/// Number of elements in contact whose next neighbour along x and along y is out of contact.
fn ends(pressure: &Field) -> [usize; 2] {
    let grid: Grid = pressure.grid();
    let (nx, ny) = (grid.nx(), grid.ny());
    let mut counts = [0; 2];
    for iy in 0..ny {
        let (row, next) = (pressure.row(iy), pressure.row((iy + 1) % ny));
        for (ix, &p) in row.iter().enumerate() {
            if p > 0.0 {
                counts[0] += usize::from(row[(ix + 1) % nx] <= 0.0);
                counts[1] += usize::from(next[ix] <= 0.0);
            }
        }
    }
    counts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lag_shorter_than_an_element_is_hidden_and_a_longer_one_is_not() {
        let hidden = |elements: f64| {
            let compliance = |q: f64| Complex64::from(0.1) + 0.9 / Complex64::new(1.0, -q * elements);
            SlidingEdges::of_chord([20.0, 0.3], 1.0, compliance).hidden_lag / (0.3 / 20.0)
        };
        // Hunter's cylinder becomes narrower by (1 - J0) ℓ.
        assert!((hidden(0.01) / 0.009 - 1.0).abs() < 2e-3);
        assert!(hidden(30.0) < 0.01);
    }
}
