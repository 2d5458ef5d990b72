//! Roughness parameters of an area, as in ISO 25178-2.

use rc_core::Field;
use serde::Serialize;

use crate::treat::{mean, rms_slope};

/// Height and hybrid parameters of ISO 25178-2 for a whole map.
///
/// No filter is applied. Level and filter the map before, as the measurement requires. Heights are relative to their
/// mean. Gradients are differences of neighbours inside the map, never across its border. So Sdq and Sdr depend on the
/// distance of points, as they do in the standard.
///
/// *Accuracy*: test `parameters_of_a_wave_are_those_of_a_wave`. An independent program gives the same values
/// (`tests/it/`).
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct AreaParameters {
    /// Mean height, the reference of the others.
    pub mean: f64,
    /// Mean absolute height Sa.
    pub sa: f64,
    /// Root mean square height Sq.
    pub sq: f64,
    /// Skewness Ssk = ⟨h³⟩/Sq³, 0 for a Gaussian surface.
    pub ssk: f64,
    /// Kurtosis Sku = ⟨h⁴⟩/Sq⁴, 3 for a Gaussian surface.
    pub sku: f64,
    /// Height Sp of the highest peak above the mean.
    pub sp: f64,
    /// Depth Sv of the deepest valley below the mean, positive.
    pub sv: f64,
    /// Maximum height Sz = Sp + Sv.
    pub sz: f64,
    /// rms gradient Sdq = √⟨|∇h|²⟩.
    pub sdq: f64,
    /// Developed area Sdr: ratio of the area of the surface to its projection, minus 1.
    pub sdr: f64,
}

impl AreaParameters {
    /// The parameters of the map with all heights and sides multiplied by `factor`.
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        let Self { mean, sa, sq, sp, sv, sz, .. } = self;
        let [mean, sa, sq, sp, sv, sz] = [mean, sa, sq, sp, sv, sz].map(|length| length * factor);
        Self { mean, sa, sq, sp, sv, sz, ..self }
    }

    /// The parameters of `heights` on a rectangle of `sides` along x and y.
    ///
    /// Heights and sides have the same unit. Points that are `NaN` are missing: the parameters are those of the
    /// measured points and of pairs and meshes of them.
    #[must_use]
    pub fn of(heights: &Field, sides: [f64; 2]) -> Self {
        let grid = heights.grid();
        let (of_measured, n) = mean(heights);
        let mean = if n == grid.len() { heights.mean() } else { of_measured };
        let mut sums = [0.0; 4];
        // Summed row by row, so that rounding errors do not grow with the whole map.
        for iy in 0..grid.ny() {
            let mut row_sums = [0.0; 4];
            for height in heights.row(iy).iter().filter(|height| !height.is_nan()) {
                let h = height - mean;
                let squared = h * h;
                for (sum, term) in row_sums.iter_mut().zip([h.abs(), squared, squared * h, squared * squared]) {
                    *sum += term;
                }
            }
            sums.iter_mut().zip(row_sums).for_each(|(sum, row)| *sum += row);
        }
        let [sa, m2, m3, m4] = sums.map(|sum| sum / n as f64);
        let sq = m2.sqrt();
        let (sp, sv) = (heights.max() - mean, mean - heights.min());
        let spacing = [sides[0] / grid.nx() as f64, sides[1] / grid.ny() as f64];
        let (sdq, sdr) = (rms_slope(heights, spacing), developed(heights, spacing));
        Self { mean, sa, sq, ssk: m3 / (sq * m2), sku: m4 / (m2 * m2), sp, sv, sz: sp + sv, sdq, sdr }
    }
}

/// Sdr as a mean over meshes of four points.
///
/// For each mesh, it is the mean over both divisions into two triangles.
fn developed(heights: &Field, [dx, dy]: [f64; 2]) -> f64 {
    let grid = heights.grid();
    let (mut areas, mut n_meshes) = (0.0, 0_usize);
    for iy in 1..grid.ny() {
        let (below, above) = (heights.row(iy - 1), heights.row(iy));
        let mut row = 0.0;
        for (a, b) in below.windows(2).zip(above.windows(2)) {
            if [a[0], a[1], b[0], b[1]].iter().any(|height| height.is_nan()) {
                continue;
            }
            n_meshes += 1;
            let x = [(a[1] - a[0]) / dx, (b[1] - b[0]) / dx];
            let y = [(b[0] - a[0]) / dy, (b[1] - a[1]) / dy];
            for (gx, gy) in [(x[0], y[0]), (x[1], y[1]), (x[0], y[1]), (x[1], y[0])] {
                // √(1 + s) - 1 without loss of digits for small slopes.
                let squared = gx * gx + gy * gy;
                row += squared / (1.0 + (1.0 + squared).sqrt());
            }
        }
        areas += row;
    }
    if n_meshes > 0 { areas / (4 * n_meshes) as f64 } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use rc_core::{DVec2, Grid};

    use super::*;

    #[test]
    fn parameters_of_a_wave_are_those_of_a_wave() {
        use std::f64::consts::{PI, TAU};
        let (amplitude, waves, side) = (2e-6, 4.0, 1e-3);
        let grid = Grid::square(1024).expect("a grid");
        let field = Field::from_fn(grid, |at| 7e-6 + amplitude * (TAU * waves * at.x).sin());
        let p = AreaParameters::of(&field, [side, side]);
        let slope = TAU * waves * amplitude / side;
        let exact = [
            ("mean", p.mean, 7e-6),
            ("Sa", p.sa, 2.0 * amplitude / PI),
            ("Sq", p.sq, amplitude / 2_f64.sqrt()),
            ("Sku", p.sku, 1.5),
            ("Sz", p.sz, 2.0 * amplitude),
            ("Sdq", p.sdq, slope / 2_f64.sqrt()),
            // ⟨√(1 + s² cos²)⟩ - 1 up to the next order.
            ("Sdr", p.sdr, slope * slope / 4.0 * (1.0 - 3.0 / 16.0 * slope * slope)),
        ];
        for (name, value, reference) in exact {
            // With 256 points in a wave, differences are too small by (2π/256)²/24 = 2.5e-5, and their squares by twice
            // that. The border, where the wave is steepest, is not included. It is 1 of 1023 differences.
            assert!((value / reference - 1.0).abs() < 1.1e-3, "{name}: {value}, reference {reference}");
        }
        assert!(p.ssk.abs() < 1e-9, "Ssk {}", p.ssk);
    }

    #[test]
    fn a_plane_has_its_slope_and_its_area() {
        let field = Field::from_fn(Grid::new(5, 9).expect("a grid"), |DVec2 { x, y }| 3.0 * x + 4.0 * y);
        let p = AreaParameters::of(&field, [1.0, 1.0]);
        assert!((p.sdq - 5.0).abs() < 1e-12 && (p.sdr - (26_f64.sqrt() - 1.0)).abs() < 1e-12, "{p:?}");
    }
}
