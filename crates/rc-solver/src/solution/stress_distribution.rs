//! The distribution of the interfacial stress P(σ), resolved below the element at contact edges.
//!
//! Eq. 7 is Persson's form of it. At the distance s from an edge the pressure is c√s, so P must start linearly at
//! σ = 0. A histogram of elements cannot show that. Its smallest pressures, about c√(element side), belong to elements
//! that an edge cuts. Its first bins stay at 30 to 60 % of the peak.
//!
//! But p² is linear across an edge. Here p² is interpolated linearly between the centres of elements, and continued
//! linearly beyond elements at edges. The area between two stresses is then exact for the interpolant.

use rayon::prelude::*;
use rc_core::Field;

/// Rows of elements that are summed together.
///
/// Sums have this order for any number of threads.
const ROWS_AT_ONCE: usize = 64;

/// The directions to neighbours: along the axes here, and across corners below.
const AXES: [[isize; 2]; 4] = [[1, 0], [-1, 0], [0, 1], [0, -1]];
const DIAGONALS: [[isize; 2]; 4] = [[1, 1], [1, -1], [-1, 1], [-1, -1]];

/// The density of the stress over the whole nominal area, P(σ) = (A/A0) p(σ), on bins.
///
/// Accuracy was tested on Hertz contacts with 51 elements per radius (`tests/it/stress_distribution.rs`). Bins were a
/// tenth of the peak pressure. The error is at most 5 % in every bin, including the first, and 0.5 % from a third of
/// the peak on. The error of the area is at most 0.2 %, unless the contact area is given.
#[derive(Clone, Debug, PartialEq)]
pub struct StressDistribution {
    /// Ends of the bins, in E*.
    ///
    /// Bin k goes from `edges[k]` to `edges[k + 1]`.
    pub edges: Vec<f64>,
    /// P, in 1/E*: the mean over each bin.
    pub density: Vec<f64>,
    /// Part of the nominal area where the interpolated pressure is positive, or the given contact area.
    ///
    /// It is the integral of P over all σ > 0, whether in a bin or not.
    pub area_fraction: f64,
}

impl StressDistribution {
    /// The distribution of `pressure`, in E*, on bins with the ends `edges`.
    ///
    /// The ends increase from 0 or above. The pressure is on a periodic grid. A bin that ends before it begins has
    /// density 0. The function passes over the field once, and computes only at elements in contact and beside it.
    #[must_use]
    pub fn of(pressure: &Field, edges: &[f64]) -> Self {
        Self::new(edges, |stresses| exceedance(pressure, stresses))
    }

    /// The distribution of a `pressure` whose contact area is known better, as a fraction of the nominal area.
    ///
    /// It is that of [`StressDistribution::of`], except for stresses up to about twice those of elements at contact
    /// edges. The area above a stress differs there by a part of the difference of the two areas, which is all of it at
    /// zero stress. Where ∫ σ P dσ would then be farther from the mean pressure, all stresses are scaled by a number
    /// near 1. The function passes over the field four times.
    #[must_use]
    pub fn with_area(pressure: &Field, edges: &[f64], area_fraction: f64) -> Self {
        let Some(shift) = Shift::to(area_fraction, pressure) else { return Self::of(pressure, edges) };
        let of_edges = Self::new(edges, |stresses| {
            let unscaled: Vec<f64> = stresses.iter().map(|stress| stress / shift.scale).collect();
            exceedance(pressure, &unscaled).into_iter().map(|above| shift.of(above)).collect()
        });
        Self { area_fraction, ..of_edges }
    }

    /// The distribution from the areas above zero stress and above each of `edges`.
    fn new(edges: &[f64], above: impl Fn(&[f64]) -> Vec<f64>) -> Self {
        let above = above(&[&[0.0], edges].concat());
        let density = |(edges, above): (&[f64], &[f64])| {
            if edges[1] > edges[0] { (above[0] - above[1]) / (edges[1] - edges[0]) } else { 0.0 }
        };
        Self {
            edges: edges.to_vec(),
            density: edges.windows(2).zip(above[1..].windows(2)).map(density).collect(),
            area_fraction: above[0],
        }
    }
}

/// The part of the nominal area where the interpolated pressure is above each of `stresses`.
fn exceedance(pressure: &Field, stresses: &[f64]) -> Vec<f64> {
    let grid = pressure.grid();
    let surface = Squares { pressure, nx: grid.nx() as isize, ny: grid.ny() as isize };
    let levels: Vec<f64> = stresses.iter().map(|stress| stress.max(0.0).powi(2)).collect();
    let first_rows: Vec<usize> = (0..grid.ny()).step_by(ROWS_AT_ONCE).collect();
    let part = |first: usize| {
        let mut part = Exceedance::new(&levels);
        (first..(first + ROWS_AT_ONCE).min(grid.ny())).for_each(|iy| surface.add_row(iy, &mut part));
        part.finish()
    };
    let parts: Vec<Vec<f64>> = first_rows.into_par_iter().map(part).collect();
    let mut above = vec![0.0; levels.len()];
    for part in parts {
        above.iter_mut().zip(part).for_each(|(sum, area)| *sum += area / grid.len() as f64);
    }
    above
}

/// A change of the area above each stress, such that the area above zero stress is a given one.
///
/// Between the areas above zero and above an inner stress, x goes from 1 to 0. The change is proportional to x². The
/// density is then continuous at the inner stress, and begins as it was at zero stress, apart from a factor.
#[derive(Clone, Copy, Debug)]
struct Shift {
    /// Area above zero stress, before the change.
    all: f64,
    /// Area above the inner stress. If it is `all`, all areas change by the same factor.
    inner: f64,
    /// The area above zero stress, minus `all`.
    change: f64,
    /// Factor of all stresses. With it, ∫ σ P dσ is as near to the mean pressure as before the change.
    scale: f64,
}

/// Number of inner stresses that are tried, each twice the one before.
///
/// The first is twice the rms pressure of elements at edges. A sphere's distribution is too low up to there.
const INNER_STRESSES: i32 = 12;

/// Number of steps of the integral over the stress.
const STEPS: u32 = 256;

impl Shift {
    /// The change to the area `wanted`. `None` without edges of contacts.
    ///
    /// The area above a stress must not grow with the stress. Where the change is too large for this, the inner stress
    /// is larger.
    fn to(wanted: f64, pressure: &Field) -> Option<Self> {
        let at_edges = rms_at_edges(pressure)?;
        let inner: Vec<f64> = (1..=INNER_STRESSES).map(|k| at_edges * 2.0_f64.powi(k)).collect();
        let above = exceedance(pressure, &[&[0.0], &inner[..]].concat());
        let (all, change) = (above[0], wanted - above[0]);
        let enough = above[1..].iter().position(|inner| 2.0 * change.abs() <= all - inner);
        let inner = enough.map_or(all, |chosen| above[chosen + 1]);
        Some(Self { all, inner, change, scale: 1.0 }.scaled(pressure))
    }

    /// The change with the scale of stresses.
    fn scaled(self, pressure: &Field) -> Self {
        let step = pressure.max() / f64::from(STEPS);
        let stresses: Vec<f64> = (0..STEPS).map(|k| (f64::from(k) + 0.5) * step).collect();
        let above = exceedance(pressure, &stresses);
        let (before, mean) = (step * above.iter().sum::<f64>(), pressure.mean());
        let changed: f64 = step * above.into_iter().map(|above| self.of(above)).sum::<f64>();
        let error = (before - mean).abs();
        let scale = if changed > 0.0 { changed.clamp(mean - error, mean + error) / changed } else { 1.0 };
        Self { scale, ..self }
    }

    /// The changed area for the area `above` a stress.
    fn of(self, above: f64) -> f64 {
        let Self { all, inner, change, .. } = self;
        if all <= inner {
            return above * (1.0 + change / all);
        }
        let x = ((above - inner) / (all - inner)).max(0.0);
        above + change * x * x
    }
}

/// Rms pressure of the elements in contact beside one that is not. `None` without such elements.
fn rms_at_edges(pressure: &Field) -> Option<f64> {
    let grid = pressure.grid();
    let surface = Squares { pressure, nx: grid.nx() as isize, ny: grid.ny() as isize };
    let of_row = |iy: usize| {
        pressure.row(iy).iter().enumerate().fold((0.0, 0), |(squares, n), (ix, &p)| {
            let is_edge = || AXES.iter().any(|[dx, dy]| surface.at(ix as isize + dx, iy as isize + dy) <= 0.0);
            if p > 0.0 && is_edge() { (squares + p * p, n + 1) } else { (squares, n) }
        })
    };
    let rows: Vec<(f64, usize)> = (0..grid.ny()).into_par_iter().map(of_row).collect();
    let (squares, n) = rows.into_iter().fold((0.0, 0), |sum, row| (sum.0 + row.0, sum.1 + row.1));
    (n > 0).then(|| (squares / n as f64).sqrt())
}

/// The squares between the centres of elements, with p² at their corners.
///
/// p² is continued beyond contact edges.
struct Squares<'a> {
    pressure: &'a Field,
    nx: isize,
    ny: isize,
}

impl Squares<'_> {
    /// Adds the squares between the centres of row `iy` and of the next row.
    fn add_row(&self, iy: usize, exceedance: &mut Exceedance<'_>) {
        let (row, next) = (self.pressure.row(iy), self.pressure.row((iy + 1) % self.ny as usize));
        for ix in 0..row.len() {
            let right = (ix + 1) % row.len();
            let corners = [row[ix], row[right], next[right], next[ix]];
            let n_inside = corners.iter().filter(|&&p| p > 0.0).count();
            if n_inside == 0 {
                continue;
            }
            let levels = if n_inside == 4 {
                corners.map(|p| p * p)
            } else {
                let (x, y) = (ix as isize, iy as isize);
                [[x, y], [x + 1, y], [x + 1, y + 1], [x, y + 1]].map(|[x, y]| self.level(x, y))
            };
            exceedance.add_square(levels);
        }
    }

    /// p of the periodic field.
    fn at(&self, x: isize, y: isize) -> f64 {
        self.pressure.at(x.rem_euclid(self.nx) as usize, y.rem_euclid(self.ny) as usize)
    }

    /// p² in contact. Beyond an edge, the linear continuation of p², at most 0.
    fn level(&self, x: isize, y: isize) -> f64 {
        let p = self.at(x, y);
        if p > 0.0 {
            return p * p;
        }
        self.continued(x, y, AXES).or_else(|| self.continued(x, y, DIAGONALS)).unwrap_or(0.0).min(0.0)
    }

    /// The mean of the continuations from the contacts in `directions`. `None` where there is no contact.
    fn continued(&self, x: isize, y: isize, directions: [[isize; 2]; 4]) -> Option<f64> {
        let (mut sum, mut n) = (0.0, 0.0);
        for [dx, dy] in directions {
            let [first, second] = [1, 2].map(|step| self.at(x + step * dx, y + step * dy).max(0.0).powi(2));
            if first > 0.0 {
                // If a contact is one element wide, only its middle is known. The edge is taken half an element from
                // it.
                sum += if second > 0.0 { 2.0 * first - second } else { -first };
                n += 1.0;
            }
        }
        (n > 0.0).then(|| sum / n)
    }
}

/// Area, in elements, where p² is above each of a list of levels.
struct Exceedance<'a> {
    /// The levels, increasing.
    levels: &'a [f64],
    /// Area above each level, of triangles that it cuts.
    cut: Vec<f64>,
    /// At index k, the area of triangles whose smallest value is above exactly k levels.
    whole: Vec<f64>,
}

impl<'a> Exceedance<'a> {
    fn new(levels: &'a [f64]) -> Self {
        Self { levels, cut: vec![0.0; levels.len()], whole: vec![0.0; levels.len() + 1] }
    }

    /// Adds a square with these values at its corners.
    ///
    /// It is four triangles that meet in the middle, where the value is the mean.
    fn add_square(&mut self, corners: [f64; 4]) {
        let middle = 0.25 * corners.iter().sum::<f64>();
        for i in 0..4 {
            self.add_triangle([corners[i], corners[(i + 1) % 4], middle]);
        }
    }

    /// Adds a triangle of a quarter of an element, with these values at its corners.
    ///
    /// The function is linear in the triangle.
    fn add_triangle(&mut self, mut corners: [f64; 3]) {
        const AREA: f64 = 0.25;
        corners.sort_unstable_by(f64::total_cmp);
        let [low, middle, high] = corners;
        let first_cut = self.levels.partition_point(|&level| level < low);
        self.whole[first_cut] += AREA;
        for (level, area) in self.levels.iter().zip(&mut self.cut).skip(first_cut) {
            if *level >= high {
                break;
            }
            let above = if *level < middle {
                1.0 - (level - low).powi(2) / ((middle - low) * (high - low))
            } else {
                (high - level).powi(2) / ((high - middle) * (high - low))
            };
            *area += AREA * above;
        }
    }

    /// Returns the area above each level.
    fn finish(self) -> Vec<f64> {
        let mut whole = 0.0;
        let above = self.cut.iter().zip(&self.whole[1..]).rev().map(|(cut, above)| {
            whole += above;
            cut + whole
        });
        let mut above: Vec<f64> = above.collect();
        above.reverse();
        above
    }
}

#[cfg(test)]
mod tests {
    use rc_core::{DVec2, Grid};

    use super::*;

    /// p² = 1 - (r/a)², sampled at the centres, so P = 2πa²σ. The slope of p² at the edge is taken one element inside
    /// it. The error is therefore of the order of an element over the radius.
    #[test]
    fn a_paraboloid_of_squared_pressure_has_a_linear_distribution() {
        for (n, bound) in [(128, 5e-2), (512, 1.3e-2)] {
            let radius: f64 = 0.2;
            let p = |DVec2 { x, y }: DVec2| {
                (1.0 - ((x - 0.5).powi(2) + (y - 0.49).powi(2)) / radius.powi(2)).max(0.0).sqrt()
            };
            let pressure = Field::from_fn(Grid::square(n).expect("a grid"), p);
            let edges: Vec<f64> = (0..=10).map(|k| 0.1 * f64::from(k)).collect();
            let found = StressDistribution::of(&pressure, &edges);
            let area = std::f64::consts::PI * radius * radius;
            assert!((found.area_fraction / area - 1.0).abs() < bound, "{} against {area}", found.area_fraction);
            for (bin, density) in found.density.iter().enumerate() {
                let exact = area * (edges[bin] + edges[bin + 1]);
                assert!((density / exact - 1.0).abs() < bound, "{n}²: bin {bin}: {density} against {exact}");
            }
        }
    }

    #[test]
    fn full_contact_is_counted_once_and_none_not_at_all() {
        let grid = Grid::new(10, 7).expect("a grid");
        let of = |p: f64| StressDistribution::of(&Field::from_fn(grid, |_| p), &[0.0, 1.0, 2.0]);
        let (full, none) = (of(1.5), of(0.0));
        assert!((full.area_fraction - 1.0).abs() < 1e-14 && full.density[0] == 0.0, "{full:?}");
        assert!((full.density[1] - 1.0).abs() < 1e-14, "{full:?}");
        assert_eq!((none.area_fraction, none.density), (0.0, vec![0.0, 0.0]));
    }

    /// The middle of the one element is all that is known of the contact.
    #[test]
    fn a_contact_of_one_element_has_about_its_area() {
        let grid = Grid::square(8).expect("a grid");
        let mut values = vec![0.0; 64];
        values[0] = 1.0;
        let one = StressDistribution::of(&Field::new(grid, values).expect("64 values"), &[0.0, 2.0]);
        assert!((0.4..1.0).contains(&(64.0 * one.area_fraction)), "{one:?}");
    }

    #[test]
    fn edges_that_make_no_bins_give_no_densities() {
        let pressure = Field::from_fn(Grid::square(4).expect("a grid"), |_| 1.0);
        for edges in [&[][..], &[1.0], &[2.0, 1.0], &[f64::NAN, -1.0]] {
            let found = StressDistribution::of(&pressure, edges);
            assert!(found.density.iter().all(|&density| density == 0.0), "{found:?}");
            assert!((found.area_fraction - 1.0).abs() < 1e-14, "{found:?}");
        }
    }
}
