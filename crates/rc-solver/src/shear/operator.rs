//! L_T: the displacement by tangential tractions on a grid.

use rayon::prelude::*;
use rc_core::{DVec2, Field, Grid, Kernel};
use rc_fft::{Complex64, field_of_half_plane, half_plane_values};

use crate::grid::response::padded_side;
use crate::shear::response::rectangle;

/// Bytes for each element of the period, at the peak of an application.
pub(super) const BYTES_PER_ELEMENT: u64 = 72;

/// The operator from tractions to tangential displacements, for E* = 1.
///
/// Along a wave vector q its symbol is that of the normal operator, 2/q, and across it 2/((1 - ν) q). On a periodic grid
/// both are the symbol of the kernel, times these factors, so that for ν = 0 the operator is that of the normal contact.
/// With free borders the responses of loaded rectangles are summed on a padded grid.
pub(super) struct TangentialOperator {
    grid: Grid,
    /// The elements of the transforms.
    around: Grid,
    /// Factors xx, yy and xy of each wave of the half plane, with that of the inverse transform.
    factors: Vec<[f64; 3]>,
}

impl TangentialOperator {
    /// The operator on a part of `grid`, of the half-space of `kernel` with Poisson's ratio `poisson`.
    ///
    /// Only with free borders may the part be smaller than the grid.
    pub(super) fn new((grid, part): (Grid, Grid), kernel: &dyn Kernel, poisson: f64) -> Self {
        let ratio = poisson / (1.0 - poisson);
        match kernel.free_response(grid) {
            Some(response) => {
                let around = padded_grid(part);
                let factors = of_responses((part, around), grid.spacing(), (ratio, &response));
                Self { grid: part, around, factors }
            }
            None => Self { grid, around: grid, factors: of_symbol(grid, ratio, &kernel.symbol(grid)) },
        }
    }

    /// The displacements by the tractions along x and y.
    pub(super) fn apply(&self, traction: &[Field; 2]) -> [Field; 2] {
        let mut waves = traction.each_ref().map(|field| {
            let padded = if self.around == self.grid { None } else { Some(padded(field, self.around)) };
            half_plane_values(padded.as_ref().unwrap_or(field), 0.0, |wave| wave)
        });
        let [x, y] = &mut waves;
        let along_both = x.par_iter_mut().zip(y.par_iter_mut()).zip(self.factors.par_iter());
        along_both.for_each(|((x, y), [xx, yy, xy])| {
            let (of_x, of_y): (Complex64, Complex64) = (*x, *y);
            *x = of_x * *xx + of_y * *xy;
            *y = of_x * *xy + of_y * *yy;
        });
        waves.map(|waves| {
            let whole = field_of_half_plane(waves, self.around);
            if self.around == self.grid { whole } else { cut(&whole, self.grid) }
        })
    }
}

/// The elements of the transforms with free borders. Their spacing does not matter.
pub(super) fn padded_grid(part: Grid) -> Grid {
    let [px, py] = [part.nx(), part.ny()].map(padded_side);
    Grid::new(px, py).expect("the normal contact was solved on such a grid, or a larger one")
}

/// Factors from the symbol of a periodic kernel.
fn of_symbol(grid: Grid, ratio: f64, symbol: &(dyn Fn(usize, usize) -> f64 + Sync)) -> Vec<[f64; 3]> {
    let (nx, ny) = (grid.nx(), grid.ny());
    let scale = 1.0 / grid.len() as f64;
    let of_wave = |place: usize| {
        let (kx, row) = (place / ny, place % ny);
        let ky = if 2 * row > ny { row as i64 - ny as i64 } else { row as i64 };
        if place == 0 {
            return [0.0; 3];
        }
        let along = grid.angular_wave(kx as i64, ky).normalize();
        let normal = scale * symbol(kx, ky.unsigned_abs() as usize);
        // A wave of half the elements is its own conjugate, and has no sign of its direction.
        let is_half = 2 * kx == nx || 2 * row == ny;
        let across = if is_half { 0.0 } else { along.x * along.y };
        let part = |along: f64| normal * (1.0 + ratio * (1.0 - along * along));
        [part(along.x), part(along.y), -normal * ratio * across]
    };
    (0..(nx / 2 + 1) * ny).into_par_iter().map(of_wave).collect()
}

/// Factors from the responses to one element, which are zero beyond the elements of `grid`.
fn of_responses(
    (grid, around): (Grid, Grid),
    spacing: DVec2,
    (ratio, normal): (f64, &(dyn Fn(usize, usize) -> f64 + Sync)),
) -> Vec<[f64; 3]> {
    let scale = 1.0 / around.len() as f64;
    let (px, py) = (around.nx(), around.ny());
    let signed = |i: usize, n: usize| if 2 * i > n { i as i64 - n as i64 } else { i as i64 };
    let transform = |part: usize| {
        let mut values = Field::zeros(around);
        values.values_mut().par_chunks_mut(px).enumerate().for_each(|(iy, row)| {
            let dy = signed(iy, py);
            for (ix, value) in row.iter_mut().enumerate() {
                let dx = signed(ix, px);
                let [nx, ny] = [dx, dy].map(|d| d.unsigned_abs() as usize);
                if nx >= grid.nx() || ny >= grid.ny() {
                    continue;
                }
                let of_ratio = ratio * rectangle(spacing * DVec2::new(dx as f64, dy as f64), 0.5 * spacing)[part];
                *value = of_ratio + if part < 2 { normal(nx, ny) } else { 0.0 };
            }
        });
        half_plane_values(&values, 0.0, |wave| scale * wave.re)
    };
    let [xx, yy, xy] = [0, 1, 2].map(transform);
    xx.into_iter().zip(yy).zip(xy).map(|((xx, yy), xy)| [xx, yy, xy]).collect()
}

/// A field with zeros around it.
fn padded(field: &Field, around: Grid) -> Field {
    let mut whole = Field::zeros(around);
    let rows = whole.values_mut().chunks_exact_mut(around.nx());
    for (row, source) in rows.zip(field.values().chunks_exact(field.grid().nx())) {
        row[..source.len()].copy_from_slice(source);
    }
    whole
}

/// The part of a field on `grid`, from the first element on.
fn cut(whole: &Field, grid: Grid) -> Field {
    let rows = (0..grid.ny()).flat_map(|iy| whole.row(iy)[..grid.nx()].iter().copied());
    Field::new(grid, rows.collect()).expect("as many values as the grid has elements")
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use rc_core::{Boundary, Operator as _};
    use rc_kernel::{FreeLove, Love, Spectral};

    use super::*;
    use crate::grid::uniform_operator::UniformOperator;

    fn normal(grid: Grid, kernel: &dyn Kernel, field: &Field) -> Field {
        let mut displacement = Field::zeros(grid);
        UniformOperator::new(grid, kernel).apply(field.values(), displacement.values_mut(), &mut []);
        displacement
    }

    fn largest_difference(a: &Field, b: &Field) -> f64 {
        a.values().iter().zip(b.values()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn without_poissons_ratio_it_is_the_normal_operator() {
        for (grid, kernel) in [
            (Grid::new(24, 18).expect("a grid"), &Love as &dyn Kernel),
            (Grid::square(15).expect("a grid"), &Spectral),
            (Grid::new(12, 9).expect("a grid"), &FreeLove),
        ] {
            let field = Field::from_fn(grid, |at| (17.0 * at.x).sin() + (at.y * 40.0).cos().powi(3) + 0.2);
            let twice = Field::from_fn(grid, |at| (3.0 * at.x * at.y).exp());
            let operator = TangentialOperator::new((grid, grid), kernel, 0.0);
            let found = operator.apply(&[field.clone(), twice.clone()]);
            for (found, source) in found.iter().zip([&field, &twice]) {
                let expected = normal(grid, kernel, source);
                let error = largest_difference(found, &expected);
                assert!(error < 1e-13 * expected.max().abs().max(1.0), "{}: {error:e}", kernel.name());
            }
        }
    }

    #[test]
    fn a_wave_is_softer_across_than_along() {
        let grid = Grid::square(32).expect("a grid");
        let wave = Field::from_fn(grid, |at| (TAU * (2.0 * at.x + at.y)).cos());
        let none = Field::zeros(grid);
        let operator = TangentialOperator::new((grid, grid), &Spectral, 0.3);
        let q = DVec2::new(2.0, 1.0).normalize();
        let length = TAU * 5.0_f64.sqrt();
        for (direction, factor) in [(q, 1.0), (q.perp(), 1.0 / 0.7)] {
            let scaled = |part: f64| Field::from_fn(grid, |at| part * (TAU * (2.0 * at.x + at.y)).cos());
            let [x, y] = operator.apply(&[scaled(direction.x), scaled(direction.y)]);
            for (found, part) in [(&x, direction.x), (&y, direction.y)] {
                let expected = scaled(part * 2.0 / length * factor);
                assert!(largest_difference(found, &expected) < 1e-14, "{direction}");
            }
        }
        assert!(largest_difference(&operator.apply(&[none.clone(), wave])[1], &none) > 0.0);
    }

    /// The reference is the sum over all pairs of elements.
    #[test]
    fn free_borders_are_a_direct_sum() {
        let grid = Grid::in_cell(7, 5, 0.6).expect("a grid");
        let fields = [
            Field::from_fn(grid, |at| (9.0 * at.x).sin() + at.y),
            Field::from_fn(grid, |at| (5.0 * at.y).cos() - at.x),
        ];
        let poisson = 0.4;
        let found = TangentialOperator::new((grid, grid), &FreeLove, poisson).apply(&fields);
        let response = FreeLove.free_response(grid).expect("a response");
        let (nx, spacing) = (grid.nx(), grid.spacing());
        for i in 0..grid.len() {
            let mut expected = [0.0; 2];
            for j in 0..grid.len() {
                let [dx, dy] = [(i % nx, j % nx), (i / nx, j / nx)].map(|(a, b)| a as f64 - b as f64);
                let parts =
                    rectangle(spacing * DVec2::new(dx, dy), 0.5 * spacing).map(|v| v * poisson / (1.0 - poisson));
                let normal = response(dx.abs() as usize, dy.abs() as usize);
                let t = fields.each_ref().map(|field| field.values()[j]);
                expected[0] += (normal + parts[0]) * t[0] + parts[2] * t[1];
                expected[1] += (normal + parts[1]) * t[1] + parts[2] * t[0];
            }
            for (found, expected) in found.iter().zip(expected) {
                let error = (found.values()[i] - expected).abs();
                assert!(error < 1e-13, "element {i}: off by {error:e}");
            }
        }
        assert_eq!(crate::problem::support::Support::of(&FreeLove, grid).boundary, Boundary::Free);
    }
}
