//! Roughness of a map at each height, octave by octave.
//!
//! Many surfaces are rougher on summits than in valleys, or the reverse. Neither the spectrum nor the distribution of
//! heights knows this, but a light contact does.

use rayon::prelude::*;
use rc_core::{Field, Grid};
use rc_fft::{Complex64, field_of_half_plane};

/// Maximum number of octaves. Longer waves are not compared.
const MOST_OCTAVES: usize = 8;

/// Waves per side below which there is no octave.
const LONGEST: f64 = 4.0;

/// Minimum number of elements of a class of heights.
const LEAST: usize = 64;

/// Number of classes of equal size, before the extreme ones are divided.
const CLASSES: usize = 20;

/// Limit of the factor of one adjustment.
const MOST: f64 = 4.0;

/// Octaves of wave vectors, with |k| in waves per side of the map along x.
pub(crate) struct Octaves {
    /// Wavenumbers between the octaves, rising.
    edges: Vec<f64>,
}

/// Rms of the waves of each octave, at each class of heights.
pub(crate) struct Roughness {
    octaves: Octaves,
    /// Bounds of the classes, as fractions of all elements by rank.
    bounds: Vec<f64>,
    /// `rms[octave][class]`
    rms: Vec<Vec<f64>>,
}

/// The waves of a periodic field, which is `scale` times as long along x as the map.
pub(crate) struct Waves<'a> {
    pub(crate) values: &'a [Complex64],
    pub(crate) grid: Grid,
    pub(crate) scale: f64,
}

impl Octaves {
    /// Octaves from the limit of resolution of `grid` on.
    fn of(grid: Grid) -> Self {
        let shortest = (grid.nx() as f64 / 2.0).min(grid.ny() as f64 / 2.0 / grid.cell_ratio());
        let halves = (1..=MOST_OCTAVES as i32).map(|i| shortest / 2_f64.powi(i));
        let mut edges: Vec<f64> = halves.take_while(|edge| *edge >= LONGEST).collect();
        edges.reverse();
        Self { edges }
    }

    /// Part of a wave that is below edge number `edge`; all of it for the number of edges.
    fn below(&self, edge: usize, squared_waves: f64) -> f64 {
        self.edges.get(edge).map_or(1.0, |edge| 1.0 / (1.0 + (squared_waves / (edge * edge)).powi(4)))
    }

    /// The field of the waves in octave number `octave`, or of the longer waves for `None`.
    fn field(&self, waves: &Waves<'_>, octave: Option<usize>) -> Field {
        let ny = waves.grid.ny();
        let per_side = 1.0 / (waves.scale * waves.scale);
        let mut part = waves.values.to_vec();
        part.par_chunks_exact_mut(ny).enumerate().for_each(|(kx, column)| {
            for (place, wave) in column.iter_mut().enumerate() {
                let squared = waves.grid.squared_waves(kx, place.min(ny - place)) * per_side;
                let longer = octave.map_or(0.0, |octave| self.below(octave, squared));
                *wave *= self.below(octave.map_or(0, |octave| octave + 1), squared) - longer;
            }
        });
        field_of_half_plane(part, waves.grid)
    }
}

impl Roughness {
    /// The roughness of a map with these waves, whose elements have this `order` of heights.
    ///
    /// Its classes are large enough for a field of `elements` too.
    pub(crate) fn of(waves: &Waves<'_>, order: &[usize], elements: usize) -> Self {
        let octaves = Octaves::of(waves.grid);
        let bounds = bounds(order.len().min(elements));
        let rms = (0..octaves.edges.len()).map(|i| rms(&octaves.field(waves, Some(i)), order, &bounds)).collect();
        Self { octaves, bounds, rms }
    }

    /// The field of `waves` with this roughness. Its elements have this `order` of heights before.
    pub(crate) fn applied_to(&self, waves: &Waves<'_>, order: &[usize]) -> Field {
        let mut sum = self.octaves.field(waves, None);
        let mut places = vec![0.0; order.len()];
        for (rank, &element) in order.iter().enumerate() {
            places[element] = rank as f64 / order.len() as f64;
        }
        for (octave, wanted) in self.rms.iter().enumerate() {
            let part = self.octaves.field(waves, Some(octave));
            let own = rms(&part, order, &self.bounds);
            let ratio = |(wanted, own): (&f64, &f64)| {
                if *own > 0.0 { (wanted / own).clamp(1.0 / MOST, MOST) } else { 1.0 }
            };
            let factors: Vec<f64> = wanted.iter().zip(&own).map(ratio).collect();
            let terms = part.values().par_iter().zip(&places);
            sum.values_mut().par_iter_mut().zip(terms).for_each(|(sum, (part, place))| {
                *sum += part * self.factor(&factors, *place);
            });
        }
        sum
    }

    /// The factor at a rank, linear between the middles of classes.
    fn factor(&self, factors: &[f64], rank: f64) -> f64 {
        let middle = |class: usize| 0.5 * (self.bounds[class] + self.bounds[class + 1]);
        let class = self.bounds[1..factors.len()].partition_point(|bound| *bound <= rank);
        let neighbour = if rank < middle(class) { class.checked_sub(1) } else { Some(class + 1) };
        match neighbour.filter(|neighbour| *neighbour < factors.len()) {
            None => factors[class],
            Some(other) => {
                let part = (rank - middle(class)) / (middle(other) - middle(class));
                factors[class] + part * (factors[other] - factors[class])
            }
        }
    }
}

/// Bounds of classes of ranks for `n` elements: equal ones, and narrower ones towards both ends.
fn bounds(n: usize) -> Vec<f64> {
    let width = 1.0 / CLASSES as f64;
    let mut bounds: Vec<f64> = (1..CLASSES).map(|i| i as f64 * width).collect();
    let mut end = width / 2.0;
    while end * n as f64 >= LEAST as f64 {
        bounds.extend([end, 1.0 - end]);
        end /= 2.0;
    }
    bounds.extend([0.0, 1.0]);
    bounds.sort_by(f64::total_cmp);
    bounds
}

/// Rms of `field` in each class.
fn rms(field: &Field, order: &[usize], bounds: &[f64]) -> Vec<f64> {
    let place = |bound: f64| (bound * order.len() as f64).round() as usize;
    let of_class = |pair: &[f64]| {
        let elements = &order[place(pair[0])..place(pair[1])];
        let squares: f64 = elements.iter().map(|&element| field.values()[element].powi(2)).sum();
        (squares / elements.len().max(1) as f64).sqrt()
    };
    bounds.par_windows(2).map(of_class).collect()
}

#[cfg(test)]
mod tests {
    use rc_fft::half_plane_values;

    use super::*;

    #[test]
    fn octaves_add_up_to_the_field() {
        let grid = Grid::new(64, 48).expect("a grid");
        let field = Field::from_fn(grid, |at| (40.0 * at.x).sin() * (at.y - 0.3).exp() + (90.0 * at.y).cos());
        let values = half_plane_values(&field, 0.0, |wave| wave / grid.len() as f64);
        let (waves, octaves) = (Waves { values: &values, grid, scale: 1.0 }, Octaves::of(grid));
        assert_eq!(octaves.edges, [6.0, 12.0]);
        let mut sum = octaves.field(&waves, None);
        for octave in 0..octaves.edges.len() {
            let part = octaves.field(&waves, Some(octave));
            sum.values_mut().iter_mut().zip(part.values()).for_each(|(sum, part)| *sum += part);
        }
        let error = field.values().iter().zip(sum.values()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(error < 1e-13, "off by {error:.1e}");
    }

    #[test]
    fn the_own_roughness_changes_nothing() {
        let grid = Grid::new(64, 64).expect("a grid");
        let field = Field::from_fn(grid, |at| (1.0 + at.x) * (150.0 * at.x).sin() + (70.0 * at.y).cos());
        let values = half_plane_values(&field, 0.0, |wave| wave / grid.len() as f64);
        let mut order: Vec<usize> = (0..grid.len()).collect();
        order.sort_by(|&a, &b| field.values()[a].total_cmp(&field.values()[b]));
        let waves = Waves { values: &values, grid, scale: 1.0 };
        let same = Roughness::of(&waves, &order, grid.len()).applied_to(&waves, &order);
        let error = field.values().iter().zip(same.values()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(error < 1e-13, "off by {error:.1e}");
    }
}
