//! Length, aspect ratio and direction of the texture of a height map, as in ISO 25178-2.

use std::f64::consts::PI;

use rc_core::{DVec2, Field, Grid};
use rc_fft::{Complex64, field_of_half_plane, half_plane_values, has_small_factors};

/// Part of the autocorrelation at which it counts as decayed.
const DECAYED: f64 = 0.2;

/// Number of directions of the autocorrelation between 0 and 180°.
const DIRECTIONS: usize = 720;

/// Number of directions of the spectrum between 0 and 180°.
const SECTORS: usize = 360;

/// Spatial parameters of ISO 25178-2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Texture {
    /// Autocorrelation length Sal, in λ: the least distance at which the autocorrelation falls to 0.2.
    ///
    /// `None` if it does so nowhere within half of the map.
    pub length: Option<f64>,
    /// Aspect ratio Str: Sal divided by the greatest distance at which the autocorrelation falls to 0.2.
    ///
    /// Near 0 for a lay, near 1 for an isotropic surface.
    pub aspect: Option<Aspect>,
    /// Direction Std (degrees from x towards y, from 0 to 180) in which the amplitudes of waves are largest.
    ///
    /// A lay is at a right angle to it. Without a lay it is arbitrary.
    pub direction: f64,
    /// Ratio of the rms slopes across and along the lay, at least 1.
    pub slopes: f64,
    /// Whether Sal is below a twentieth of the shorter side.
    is_short: bool,
}

/// The aspect ratio of a texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aspect {
    /// Str, from 0 to 1.
    pub ratio: f64,
    /// Whether the ratio is only known to be smaller, because the lay is longer than half of the map.
    pub is_bound: bool,
}

/// Aspect ratio below which a surface has a lay, by the usual convention.
const LAY: f64 = 0.5;

/// Autocorrelation length, relative to the shorter side, below which the map shows enough of the texture to tell a lay
/// from a few long waves that are oblique by chance.
const SHORT: f64 = 0.05;

/// Ratio of rms slopes above which even few waves are a lay. It is 1 for an isotropic surface, whatever its long waves.
const STEEP: f64 = 2.0;

impl Texture {
    /// Whether the surface has a lay: Str below 0.5, and not by the chance of a few long waves.
    #[must_use]
    pub fn has_lay(&self) -> bool {
        self.aspect.is_some_and(|aspect| aspect.ratio < LAY) && (self.is_short || self.slopes > STEEP)
    }

    /// The texture of `heights`; `windowed` are the same heights under a window, if they are not periodic.
    ///
    /// The autocorrelation is ⟨h(x) h(x + τ)⟩ about the mean, over the points for which both are on the map, for lags up
    /// to half of each side. Source: ISO 25178-2, 4.3. An independent program (surfalize) gives the same lengths within
    /// 1 %, see the tests.
    #[must_use]
    pub fn of(heights: &Field, windowed: &Field) -> Self {
        let (length, aspect) = Autocorrelation::of(heights).lengths();
        let (direction, slopes) = of_spectrum(windowed);
        let is_short = length.is_some_and(|length| length < SHORT * heights.grid().cell_ratio().min(1.0));
        Self { length, aspect, direction, slopes, is_short }
    }
}

/// The autocorrelation of a map, at lags up to half of each side.
struct Autocorrelation {
    grid: Grid,
    padded: Field,
}

impl Autocorrelation {
    fn of(heights: &Field) -> Self {
        let (grid, mean) = (heights.grid(), heights.mean());
        let side = |n: usize| (n + n / 2 + 2..2 * n).find(|n| has_small_factors(*n, 7)).unwrap_or(2 * n);
        let padded_grid = Grid::new(side(grid.nx()), side(grid.ny())).expect("sides of twice a grid at most");
        let mut padded = Field::zeros(padded_grid);
        for iy in 0..grid.ny() {
            let start = padded_grid.index(0, iy);
            let row = &mut padded.values_mut()[start..start + grid.nx()];
            row.iter_mut().zip(heights.row(iy)).for_each(|(to, height)| *to = height - mean);
        }
        let powers = half_plane_values(&padded, 0.0, |wave| Complex64::from(wave.norm_sqr()));
        Self { grid, padded: field_of_half_plane(powers, padded_grid) }
    }

    /// The mean product at a whole lag.
    fn at(&self, [ix, iy]: [isize; 2]) -> f64 {
        let grid = self.padded.grid();
        let pairs = |n: usize, lag: isize| n.saturating_sub(lag.unsigned_abs()).max(1) as f64;
        let place = |n: usize, lag: isize| lag.rem_euclid(n as isize) as usize;
        let sum = self.padded.at(place(grid.nx(), ix), place(grid.ny(), iy));
        sum / (pairs(self.grid.nx(), ix) * pairs(self.grid.ny(), iy))
    }

    /// The mean product at a lag in spacings, by cubic interpolation.
    fn between(&self, lag: DVec2) -> f64 {
        let (first, rest) = (lag.floor(), lag - lag.floor());
        let [wx, wy] = [weights(rest.x), weights(rest.y)];
        let mut sum = 0.0;
        for (j, wy) in wy.into_iter().enumerate() {
            for (i, wx) in wx.into_iter().enumerate() {
                sum += wx * wy * self.at([first.x as isize + i as isize - 1, first.y as isize + j as isize - 1]);
            }
        }
        sum
    }

    /// Sal, and the aspect ratio.
    fn lengths(&self) -> (Option<f64>, Option<Aspect>) {
        let level = DECAYED * self.at([0, 0]);
        if level.is_nan() || level <= 0.0 {
            return (None, None);
        }
        let (mut shortest, mut longest, mut is_bound) = (f64::INFINITY, 0.0_f64, false);
        for direction in 0..DIRECTIONS {
            let towards = DVec2::from_angle(PI * direction as f64 / DIRECTIONS as f64);
            let (length, ended) = self.decay(towards, level);
            is_bound |= !ended;
            longest = longest.max(length);
            if ended {
                shortest = shortest.min(length);
            }
        }
        if shortest.is_infinite() {
            return (None, None);
        }
        (Some(shortest), Some(Aspect { ratio: shortest / longest, is_bound }))
    }

    /// The distance (λ) at which the autocorrelation falls to `level` towards a direction, or that of the last lag and
    /// `false`.
    fn decay(&self, towards: DVec2, level: f64) -> (f64, bool) {
        let spacing = self.grid.spacing();
        let last = DVec2::new((self.grid.nx() / 2) as f64, (self.grid.ny() / 2) as f64);
        let step = 0.5 * spacing.min_element();
        let lag = |distance: f64| towards * distance / spacing;
        let mut distance = 0.0;
        loop {
            let next = distance + step;
            if lag(next).abs().cmpgt(last).any() {
                return (distance, false);
            }
            if self.between(lag(next)) <= level {
                break;
            }
            distance = next;
        }
        let (mut low, mut high) = (distance, distance + step);
        for _ in 0..20 {
            let middle = 0.5 * (low + high);
            if self.between(lag(middle)) > level { low = middle } else { high = middle }
        }
        (high, true)
    }
}

/// Weights of four values for the place `t` between the second and the third (Catmull and Rom).
fn weights(t: f64) -> [f64; 4] {
    let (t2, t3) = (t * t, t * t * t);
    [0.5 * (2.0 * t2 - t - t3), 0.5 * (2.0 - 5.0 * t2 + 3.0 * t3), 0.5 * (t + 4.0 * t2 - 3.0 * t3), 0.5 * (t3 - t2)]
}

/// The direction (degrees) of the sector of the spectrum in which the sum of amplitudes is largest, and the ratio of rms
/// slopes along the principal axes of the mean square slopes.
fn of_spectrum(heights: &Field) -> (f64, f64) {
    let (grid, mut sums) = (heights.grid(), vec![0.0; SECTORS]);
    let mut slopes = [0.0; 3];
    let amplitudes = half_plane_values(heights, heights.mean(), Complex64::norm);
    for (kx, column) in amplitudes.chunks_exact(grid.ny()).enumerate() {
        let multiplicity = if kx == 0 || 2 * kx == grid.nx() { 1.0 } else { 2.0 };
        for (place, amplitude) in column.iter().enumerate() {
            if kx == 0 && place == 0 {
                continue;
            }
            let ky = if 2 * place > grid.ny() { place as f64 - grid.ny() as f64 } else { place as f64 };
            let (qx, qy) = (kx as f64, ky / grid.cell_ratio());
            let power = multiplicity * amplitude * amplitude;
            slopes = [slopes[0] + power * qx * qx, slopes[1] + power * qy * qy, slopes[2] + power * qx * qy];
            let angle = qy.atan2(qx) / PI;
            // Sectors are about multiples of half a degree.
            let sector = (angle * SECTORS as f64).round().rem_euclid(SECTORS as f64);
            sums[sector as usize % SECTORS] += multiplicity * amplitude;
        }
    }
    let largest = (0..SECTORS).max_by(|a, b| sums[*a].total_cmp(&sums[*b])).unwrap_or(0);
    let [xx, yy, xy] = slopes;
    let (mean, half) = (0.5 * (xx + yy), (0.5 * (xx - yy)).hypot(xy));
    let ratio = if mean > 0.0 { ((mean + half) / (mean - half).max(1e-12 * mean)).sqrt() } else { 1.0 };
    (180.0 * largest as f64 / SECTORS as f64, ratio)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rc_core::HeightField;

    use crate::{Normalisation, SpectrumParams, Surface};

    /// The autocorrelation of a wave is its cosine. That along its crests does not decay.
    #[test]
    fn a_wave_has_a_lay_in_its_direction() {
        let grid = Grid::new(192, 128).expect("a grid");
        let (kx, ky) = (12.0, 9.0);
        let wave = Field::from_fn(grid, |at| (2.0 * PI * (kx * at.x + ky * at.y / grid.cell_ratio())).cos());
        let texture = Texture::of(&wave, &wave);
        let q = DVec2::new(kx, ky / grid.cell_ratio());
        assert!((texture.direction - q.y.atan2(q.x).to_degrees()).abs() <= 0.25, "{texture:?}");
        let exact = DECAYED.acos() / (2.0 * PI * q.length());
        assert!((texture.length.expect("a length") / exact - 1.0).abs() < 0.01, "{texture:?}, exact {exact}");
        let aspect = texture.aspect.expect("a ratio");
        assert!(aspect.is_bound && aspect.ratio < 0.1 && texture.has_lay(), "{texture:?}");
    }

    #[test]
    fn stretching_an_isotropic_surface_divides_its_aspect_ratio() {
        let params = SpectrumParams {
            roll_off: 8.0,
            low_cut: 4.0,
            normalisation: Normalisation::RmsHeight(1.0),
            ..SpectrumParams::paper(64, 4)
        };
        let surface = Surface::new(&params).expect("a surface").sample(Grid::square(256).expect("a grid"));
        let ratio = |heights: &Field| Texture::of(heights, heights).aspect.expect("a ratio");
        let isotropic = ratio(&surface);
        assert!(!isotropic.is_bound && isotropic.ratio > 0.6, "{isotropic:?}");
        let long = Grid::in_cell(256, 256, 4.0).expect("a grid");
        let stretched = ratio(&Field::new(long, surface.values().to_vec()).expect("a field"));
        assert!((0.2..0.4).contains(&stretched.ratio), "{stretched:?}");
        // A part of an isotropic surface has few long waves, which are oblique by chance.
        let lays = (0..16).map(|seed| {
            let params = SpectrumParams::paper(64, seed);
            Surface::new(&params).expect("a surface").sample(Grid::square(256).expect("a grid"))
        });
        assert_eq!(lays.filter(|heights| Texture::of(heights, heights).has_lay()).count(), 0);
        let flat = Texture::of(&Field::zeros(long), &Field::zeros(long));
        assert_eq!((flat.length, flat.aspect), (None, None));
    }
}
