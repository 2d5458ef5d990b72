//! The distribution of the gap, resolved below the element at contact edges.
//!
//! At the distance s outside an edge, the gap is (4c/3E*) s^{3/2}. Its density therefore falls as g^{-1/3} from an
//! infinite value at g = 0, which a histogram of elements cuts off. But g^{2/3} is linear outside an edge, as p² is
//! inside. The interpolation of [`crate::StressDistribution`] therefore serves here too.

use rayon::prelude::*;
use rc_core::Field;

use crate::solution::stress_distribution::StressDistribution;

/// The density of the gap over the whole nominal area, on bins.
///
/// It does not include contact, where the gap is zero.
#[derive(Clone, Debug, PartialEq)]
pub struct GapDistribution {
    /// Ends of the bins, in the unit of the gap.
    ///
    /// Bin k goes from `edges[k]` to `edges[k + 1]`.
    pub edges: Vec<f64>,
    /// Mean over each bin of the part of the nominal area per unit of gap.
    pub density: Vec<f64>,
    /// Part of the nominal area out of contact, where the interpolated gap is positive.
    pub open_fraction: f64,
}

impl GapDistribution {
    /// The distribution of `gap`, in λ, on bins with the ends `edges`.
    ///
    /// The ends increase from 0 or above. The gap is on a periodic grid, and zero in contact within the tolerance.
    /// Elements with `pressure` > 0 are in contact.
    ///
    /// # Panics
    /// When `gap` and `pressure` are not on the same grid.
    #[must_use]
    pub fn of(gap: &Field, pressure: &Field, edges: &[f64]) -> Self {
        assert_eq!(gap.grid(), pressure.grid(), "gap and pressure on the same grid");
        let values = gap.values().par_iter().zip(pressure.values());
        let roots = values.map(|(g, p)| if *p > 0.0 { 0.0 } else { g.max(0.0).cbrt() }).collect();
        let roots = Field::new(gap.grid(), roots).expect("as many values as the gap has");
        let of_roots =
            StressDistribution::of(&roots, &edges.iter().map(|edge| edge.max(0.0).cbrt()).collect::<Vec<_>>());
        let bins = edges.windows(2).zip(of_roots.edges.windows(2)).zip(&of_roots.density);
        let density = |((edges, roots), density): ((&[f64], &[f64]), &f64)| {
            if edges[1] > edges[0] { density * (roots[1] - roots[0]) / (edges[1] - edges[0]) } else { 0.0 }
        };
        Self { edges: edges.to_vec(), density: bins.map(density).collect(), open_fraction: of_roots.area_fraction }
    }
}

#[cfg(test)]
mod tests {
    use rc_core::{DVec2, Grid};

    use super::*;

    /// Outside a circle g = (r - a)^{3/2}. The area with gaps up to g is π ((a + g^{2/3})² - a²).
    #[test]
    fn the_density_beside_a_round_contact_is_that_of_its_gap() {
        let (a, far) = (0.2_f64, 0.25_f64);
        let radius = |x: f64, y: f64| (x - 0.5).hypot(y - 0.49);
        for (n, bound) in [(128, 4e-2), (512, 1e-2)] {
            let grid = Grid::square(n).expect("a grid");
            let gap = Field::from_fn(grid, |DVec2 { x, y }| (radius(x, y) - a).max(0.0).powf(1.5));
            let pressure = Field::from_fn(grid, |DVec2 { x, y }| (a - radius(x, y)).max(0.0).sqrt());
            let edges: Vec<f64> = (0..=10).map(|k| far.powf(1.5) * f64::from(k) / 10.0).collect();
            let found = GapDistribution::of(&gap, &pressure, &edges);
            let area = |g: f64| std::f64::consts::PI * ((a + g.powf(2.0 / 3.0)).powi(2) - a * a);
            for (bin, density) in found.density.iter().enumerate() {
                let exact = (area(edges[bin + 1]) - area(edges[bin])) / (edges[bin + 1] - edges[bin]);
                assert!((density / exact - 1.0).abs() < bound, "{n}²: bin {bin}: {density} against {exact}");
            }
            let open = 1.0 - std::f64::consts::PI * a * a;
            assert!((found.open_fraction / open - 1.0).abs() < bound, "{} against {open}", found.open_fraction);
        }
    }

    #[test]
    fn full_contact_has_no_gaps() {
        let grid = Grid::new(10, 7).expect("a grid");
        let found = GapDistribution::of(&Field::zeros(grid), &Field::from_fn(grid, |_| 1.0), &[0.0, 1.0]);
        assert_eq!((found.open_fraction, found.density), (0.0, vec![0.0]));
    }
}
