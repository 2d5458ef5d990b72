//! Twins of a height map: random surfaces with its spectrum and its heights.

use rayon::prelude::*;
use rc_core::{Field, Grid};
use rc_fft::{Complex64, field_of_half_plane, half_plane_values};

use crate::Amplitudes;
use crate::draws::draw_column;
use crate::power::PowerSpectrum;
use crate::roughness::{Roughness, Waves};

/// Adjustments of amplitudes and heights, before those with the roughness, with it, and after.
///
/// Those after it bring the spectrum back to a few percent. The roughness then changes little.
const ADJUSTMENTS: [usize; 3] = [4, 12, 4];

/// The grid of a twin, and which twin it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TwinParams {
    /// Grid of the twin.
    pub grid: Grid,
    /// Ratios of the sides of the twin to those of the map, along x and y.
    pub sides: [f64; 2],
    /// Whether the twin has the height distribution of the map.
    ///
    /// Otherwise heights follow from the phases, and are nearly Gaussian.
    pub has_heights_of_map: bool,
    /// Seed of the phases, which are those of [`crate::Surface::new`].
    pub seed: u64,
}

/// A random surface with the spectrum of a map.
#[derive(Clone, Debug)]
pub struct Twin {
    /// Heights, in the unit of the map.
    pub heights: Field,
    /// Rms deviation of the amplitudes from those of the map, both times the wavenumber, relative to the rms slope.
    pub spectrum_deviation: f64,
}

impl Twin {
    /// The twin of `map` whose amplitudes are those of `waves`.
    ///
    /// `waves` is the map itself if it is periodic, else the map under a window. Each wave of the twin has the power of
    /// the map at its wave vector, interpolated between waves of the map in cells of other sides. There are no waves
    /// beyond the resolution of the map.
    ///
    /// With the heights of the map, amplitudes and ranks of heights are adjusted in turn, the ranks last (T. Schreiber
    /// and A. Schmitz, *Improved surrogate data for nonlinearity tests*, Phys. Rev. Lett. 77 (1996) 635). On the grid of
    /// the map, the sorted heights are then exactly those of the map. In between, the rms of each octave of waves is
    /// adjusted at each height too, since a light contact depends on the roughness of summits. The result is bitwise the
    /// same for any number of threads.
    #[must_use]
    pub fn of(map: &Field, waves: &Field, params: &TwinParams) -> Self {
        let amplitudes = Amplitude::of(waves, params);
        let grid = params.grid;
        let first = field_of_half_plane(first_waves(&amplitudes, params), grid);
        // Waves that are their own opposites had phases that a real field cannot have.
        let (mut waves, _) = amplitudes.applied_to(&first);
        if !params.has_heights_of_map {
            let mut heights = field_of_half_plane(waves, grid);
            let mean = map.mean();
            heights.values_mut().par_iter_mut().for_each(|height| *height += mean);
            let (_, spectrum_deviation) = amplitudes.applied_to(&heights);
            return Self { heights, spectrum_deviation };
        }
        let (sorted, roughness) = (quantiles(map, grid.len()), roughness_of(map, grid.len()));
        let [before, with, after] = ADJUSTMENTS;
        let mut heights = first;
        let mut spectrum_deviation = 0.0;
        for round in 0..before + with + after {
            let mut field = field_of_half_plane(waves.clone(), grid);
            if (before..before + with).contains(&round) {
                let of_twin = Waves { values: &waves, grid, scale: params.sides[0] };
                field = roughness.applied_to(&of_twin, &ranks(&field));
            }
            heights = with_heights(&field, &sorted);
            (waves, spectrum_deviation) = amplitudes.applied_to(&heights);
        }
        Self { heights, spectrum_deviation }
    }
}

/// The roughness of a map for twins of `elements`.
fn roughness_of(map: &Field, elements: usize) -> Roughness {
    let per_element = 1.0 / map.grid().len() as f64;
    let values = half_plane_values(map, map.mean(), |wave| wave * per_element);
    Roughness::of(&Waves { values: &values, grid: map.grid(), scale: 1.0 }, &ranks(map), elements)
}

/// Amplitudes that the waves of a field must have.
struct Amplitude {
    grid: Grid,
    /// In the layout of [`half_plane_values`].
    values: Vec<f64>,
}

impl Amplitude {
    /// The amplitudes of `map` at the wave vectors of the twin.
    fn of(map: &Field, params: &TwinParams) -> Self {
        let (grid, powers) = (params.grid, Powers { of: PowerSpectrum::of(map), grid: map.grid() });
        let ny = grid.ny();
        let is_same = grid == map.grid() && params.sides.iter().all(|side| (side - 1.0).abs() <= f64::EPSILON);
        let [x, y] = params.sides;
        let mut values = vec![0.0; (grid.nx() / 2 + 1) * ny];
        values.par_chunks_exact_mut(ny).enumerate().for_each(|(kx, column)| {
            for (place, value) in column.iter_mut().enumerate() {
                let power = if is_same {
                    powers.of.value(kx, place)
                } else {
                    powers.between([kx as f64 / x, signed(place, ny) / y]) / (x * y)
                };
                *value = power.sqrt();
            }
        });
        Self { grid, values }
    }

    /// The waves of `field` with these amplitudes, and the deviation of their own.
    fn applied_to(&self, field: &Field) -> (Vec<Complex64>, f64) {
        let (nx, ny) = (self.grid.nx(), self.grid.ny());
        let per_element = 1.0 / self.grid.len() as f64;
        let mut waves = half_plane_values(field, field.mean(), |wave| wave * per_element);
        let columns = waves.par_chunks_exact_mut(ny).zip(self.values.par_chunks_exact(ny)).enumerate();
        let sums: Vec<[f64; 2]> = columns
            .map(|(kx, (waves, amplitudes))| {
                let multiplicity = if kx == 0 || 2 * kx == nx { 1.0 } else { 2.0 };
                let mut sums = [0.0; 2];
                for (place, (wave, &amplitude)) in waves.iter_mut().zip(amplitudes).enumerate() {
                    let squared_waves = self.grid.squared_waves(kx, place.min(ny - place));
                    let size = wave.norm();
                    sums[0] += multiplicity * squared_waves * (size - amplitude).powi(2);
                    sums[1] += multiplicity * squared_waves * amplitude * amplitude;
                    *wave = if size > 0.0 { *wave * (amplitude / size) } else { Complex64::new(amplitude, 0.0) };
                }
                sums
            })
            .collect();
        let [off, all] = sums.into_iter().fold([0.0; 2], |a, b| [a[0] + b[0], a[1] + b[1]]);
        (waves, if all > 0.0 { (off / all).sqrt() } else { 0.0 })
    }
}

/// The squared amplitudes of a map between its waves.
struct Powers {
    of: PowerSpectrum,
    grid: Grid,
}

impl Powers {
    /// The power at a wave vector (waves per side of the map), linear between waves along x and y.
    ///
    /// It is 0 at the limit of resolution and beyond.
    fn between(&self, [kx, ky]: [f64; 2]) -> f64 {
        let (x, y) = (kx.floor(), ky.floor());
        let (along_x, along_y) = (kx - x, ky - y);
        let corner =
            |right: f64, up: f64, weight: f64| if weight > 0.0 { weight * self.at(x + right, y + up) } else { 0.0 };
        corner(0.0, 0.0, (1.0 - along_x) * (1.0 - along_y))
            + corner(1.0, 0.0, along_x * (1.0 - along_y))
            + corner(0.0, 1.0, (1.0 - along_x) * along_y)
            + corner(1.0, 1.0, along_x * along_y)
    }

    fn at(&self, kx: f64, ky: f64) -> f64 {
        let (nx, ny) = (self.grid.nx() as f64, self.grid.ny() as f64);
        if 2.0 * kx >= nx || 2.0 * ky.abs() >= ny {
            return 0.0;
        }
        let place = if ky < 0.0 { ky + ny } else { ky };
        self.of.value(kx as usize, place as usize)
    }
}

/// The wavenumber at a place of a column of `n`.
fn signed(place: usize, n: usize) -> f64 {
    if 2 * place > n { place as f64 - n as f64 } else { place as f64 }
}

/// Waves of these amplitudes with the phases of a seed.
fn first_waves(amplitude: &Amplitude, params: &TwinParams) -> Vec<Complex64> {
    let ny = params.grid.ny();
    let reach = ny / 2;
    let mut waves = vec![Complex64::ZERO; amplitude.values.len()];
    let columns = waves.par_chunks_exact_mut(ny).zip(amplitude.values.par_chunks_exact(ny)).enumerate();
    columns.for_each(|(kx, (waves, amplitudes))| {
        let phases = draw_column(params.seed, kx, reach, Amplitudes::Fixed);
        for (place, (wave, amplitude)) in waves.iter_mut().zip(amplitudes).enumerate() {
            let index = if 2 * place > ny { reach + place - ny } else { reach + place };
            *wave = phases[index] * *amplitude;
        }
    });
    waves
}

/// The heights of a map at `n` equally spaced ranks.
fn quantiles(map: &Field, n: usize) -> Vec<f64> {
    let mut sorted = map.values().to_vec();
    sorted.par_sort_unstable_by(f64::total_cmp);
    if sorted.len() == n {
        return sorted;
    }
    let last = sorted.len() - 1;
    let at = |rank: usize| {
        let place = ((rank as f64 + 0.5) * (sorted.len() as f64 / n as f64) - 0.5).clamp(0.0, last as f64);
        let below = place.floor() as usize;
        let above = (below + 1).min(last);
        sorted[below] + (place - below as f64) * (sorted[above] - sorted[below])
    };
    (0..n).map(at).collect()
}

/// The elements in the order of their heights. Equal heights are in the order of their elements.
fn ranks(field: &Field) -> Vec<usize> {
    // Heights beside their elements sort faster than elements that point to heights.
    let mut pairs: Vec<(f64, usize)> = field.values().par_iter().copied().zip(0..field.grid().len()).collect();
    pairs.par_sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    pairs.into_par_iter().map(|(_, element)| element).collect()
}

/// The field whose heights have the order of those of `field` and the values in `sorted`.
fn with_heights(field: &Field, sorted: &[f64]) -> Field {
    let mut result = Field::zeros(field.grid());
    for (element, &height) in ranks(field).into_iter().zip(sorted) {
        result.values_mut()[element] = height;
    }
    result
}
