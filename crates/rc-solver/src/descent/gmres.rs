//! GMRES on the active elements, for operators that are not symmetric.
//!
//! Y. Saad, M. H. Schultz, *SIAM J. Sci. Stat. Comput.* 7 (1986) 856-869, preconditioned from the right. Vectors have
//! values of the active elements only, in single precision. Sums are in double precision and in a fixed order.

use rc_core::Observer;

use crate::descent::operators::{PreconditionedOperator, read_blocks, write_blocks};
use crate::descent::stop::{Stopped, unless_stopped};
use crate::parallel;

/// Values that are summed at once.
const PIECE: usize = 4096;

/// The active elements of a mesh, block by block.
pub(crate) struct ActiveElements {
    pub(crate) active: Vec<bool>,
    /// Number of values in a block.
    block: usize,
    /// Place within its block of each active element.
    places: Vec<u32>,
    /// Number of active elements of each block.
    counts: Vec<usize>,
}

impl ActiveElements {
    /// The elements that are `active`, in blocks of `block` values.
    pub(crate) fn new(active: Vec<bool>, block: usize) -> Self {
        let of_blocks = parallel::map(active.chunks(block), |active| {
            (0_u32..).zip(active).filter(|(_, active)| **active).map(|(place, _)| place).collect::<Vec<u32>>()
        });
        let counts = of_blocks.iter().map(Vec::len).collect();
        Self { active, block, places: of_blocks.concat(), counts }
    }

    /// Number of active elements.
    pub(crate) fn len(&self) -> usize {
        self.places.len()
    }

    /// The values of the active elements, from those of all.
    pub(crate) fn gather(&self, all: &[f32]) -> Vec<f32> {
        let mut values = vec![0.0; self.len()];
        let parts = self.places_of_blocks().zip(self.parts_mut(&mut values)).zip(all.chunks(self.block));
        parallel::for_each(parts, |((places, values), all)| take(places, all, values));
        values
    }

    /// Writes the values of the active elements, and zeros elsewhere.
    pub(crate) fn scatter(&self, values: &[f32], all: &mut [f32]) {
        let parts = self.places_of_blocks().zip(self.parts(values)).zip(all.chunks_mut(self.block));
        parallel::for_each(parts, |((places, values), all)| put(places, values, all));
    }

    /// Writes L times `values` of the active elements.
    fn apply(&self, operator: &mut dyn PreconditionedOperator, values: &[f32], result: &mut [f32]) {
        let sources = self.places_of_blocks().zip(self.parts(values));
        write_blocks(operator, sources, |(places, values), written| put(places, values, written));
        operator.apply();
        let sinks = self.places_of_blocks().zip(self.parts_mut(result));
        read_blocks(operator, sinks, |(places, values), read| take(places, read, values));
    }

    fn places_of_blocks(&self) -> impl Iterator<Item = &[u32]> {
        self.parts(&self.places)
    }

    /// The parts of a vector of active elements that belong to blocks.
    fn parts<'v, T>(&self, values: &'v [T]) -> impl Iterator<Item = &'v [T]> {
        self.counts.iter().scan(values, |rest, &count| {
            let (part, others) = rest.split_at(count);
            *rest = others;
            Some(part)
        })
    }

    fn parts_mut<'v, T>(&self, values: &'v mut [T]) -> impl Iterator<Item = &'v mut [T]> {
        self.counts.iter().scan(values, |rest, &count| {
            let (part, others) = std::mem::take(rest).split_at_mut(count);
            *rest = others;
            Some(part)
        })
    }
}

fn take(places: &[u32], all: &[f32], values: &mut [f32]) {
    for (value, &place) in values.iter_mut().zip(places) {
        *value = all[place as usize];
    }
}

fn put(places: &[u32], values: &[f32], all: &mut [f32]) {
    all.fill(0.0);
    for (&value, &place) in values.iter().zip(places) {
        all[place as usize] = value;
    }
}

/// A system L x = b among active elements.
pub(crate) struct LinearSystem<'a> {
    pub(crate) operator: &'a mut dyn PreconditionedOperator,
    pub(crate) elements: &'a ActiveElements,
    /// Whether x has the mean zero, and b counts up to a constant.
    pub(crate) fixed_mean: bool,
}

/// Maximum number of directions, and the number for a system of all elements.
const DIRECTIONS: [usize; 2] = [40, 10];

/// The number of directions for `n` of `n_all` elements, whose vectors need at most 80 bytes for each of all elements.
pub(crate) fn directions(n: usize, n_all: usize) -> usize {
    (DIRECTIONS[1] * n_all / n.max(1)).clamp(DIRECTIONS[1], DIRECTIONS[0])
}

/// When GMRES ends.
#[derive(Clone, Copy)]
pub(crate) struct Goal {
    /// The residual, relative to the right side.
    pub(crate) reduction: f64,
    /// Maximum number of directions.
    pub(crate) directions: usize,
}

/// The directions of one cycle, and the least-squares problem in their span.
#[derive(Default)]
struct Cycle {
    basis: Vec<Vec<f32>>,
    preconditioned: Vec<Vec<f32>>,
    /// Columns of the triangular factor.
    columns: Vec<Vec<f64>>,
    /// Rotations that made it triangular.
    rotations: Vec<[f64; 2]>,
    /// The rotated right side. The last value is the residual.
    rotated: Vec<f64>,
}

impl LinearSystem<'_> {
    /// An approximate solution, and the number of applications of L.
    ///
    /// # Errors
    /// [`Stopped`] when the observer wants to stop.
    pub(crate) fn solve(
        &mut self,
        mut rhs: Vec<f32>,
        goal: Goal,
        observer: &dyn Observer,
    ) -> Result<(Vec<f32>, usize), Stopped> {
        self.project(&mut rhs);
        let size = dot(&rhs, &rhs).sqrt();
        if size == 0.0 || !size.is_finite() {
            return Ok((vec![0.0; rhs.len()], 0));
        }
        scale(&mut rhs, size.recip());
        let mut cycle = Cycle { basis: vec![rhs], rotated: vec![size], ..Cycle::default() };
        let mut all = parallel::zeros(self.elements.active.len());
        for step in 0..goal.directions {
            unless_stopped(observer)?;
            self.elements.scatter(&cycle.basis[step], &mut all);
            self.operator.precondition(&self.elements.active, &mut all);
            let mut direction = self.elements.gather(&all);
            self.project(&mut direction);
            unless_stopped(observer)?;
            let mut image = vec![0.0; direction.len()];
            self.elements.apply(self.operator, &direction, &mut image);
            self.project(&mut image);
            cycle.preconditioned.push(direction);
            let is_last = cycle.add(image) || cycle.residual() <= goal.reduction * size;
            if is_last {
                break;
            }
        }
        let n = cycle.columns.len();
        Ok((cycle.solution(), n))
    }

    /// Subtracts the mean, if it is fixed.
    fn project(&self, values: &mut [f32]) {
        if !self.fixed_mean || values.is_empty() {
            return;
        }
        let sums = parallel::map(values.chunks(PIECE), |piece| piece.iter().copied().map(f64::from).sum::<f64>());
        let mean = (sums.into_iter().sum::<f64>() / values.len() as f64) as f32;
        parallel::for_each(values.chunks_mut(PIECE), |piece| piece.iter_mut().for_each(|value| *value -= mean));
    }
}

impl Cycle {
    /// Adds the image of the last direction. Returns whether it adds nothing new.
    fn add(&mut self, mut image: Vec<f32>) -> bool {
        let mut column = Vec::with_capacity(self.basis.len() + 1);
        for vector in &self.basis {
            let along = dot(vector, &image);
            add(&mut image, -along, vector);
            column.push(along);
        }
        let left = dot(&image, &image).sqrt();
        let size = column.iter().fold(left * left, |sum, value| sum + value * value).sqrt();
        for (i, &[cosine, sine]) in self.rotations.iter().enumerate() {
            let [upper, lower] = [column[i], column[i + 1]];
            (column[i], column[i + 1]) = (cosine * upper + sine * lower, cosine * lower - sine * upper);
        }
        let last = column.len() - 1;
        let radius = column[last].hypot(left);
        let [cosine, sine] = if radius > 0.0 { [column[last] / radius, left / radius] } else { [1.0, 0.0] };
        column[last] = radius;
        self.columns.push(column);
        self.rotations.push([cosine, sine]);
        let residual = self.rotated[last];
        self.rotated[last] = cosine * residual;
        self.rotated.push(-sine * residual);
        // Single precision has no direction left.
        if left <= 1e-6 * size {
            return true;
        }
        scale(&mut image, left.recip());
        self.basis.push(image);
        false
    }

    fn residual(&self) -> f64 {
        self.rotated.last().map_or(0.0, |value| value.abs())
    }

    /// The combination of directions with the least residual.
    fn solution(self) -> Vec<f32> {
        let n = self.columns.len();
        let mut factors = self.rotated[..n].to_vec();
        for i in (0..n).rev() {
            for j in i + 1..n {
                factors[i] -= self.columns[j][i] * factors[j];
            }
            factors[i] = if self.columns[i][i] == 0.0 { 0.0 } else { factors[i] / self.columns[i][i] };
        }
        let mut solution = vec![0.0; self.basis[0].len()];
        for (factor, direction) in factors.into_iter().zip(&self.preconditioned) {
            add(&mut solution, factor, direction);
        }
        solution
    }
}

fn dot(a: &[f32], b: &[f32]) -> f64 {
    let sums = parallel::map(a.chunks(PIECE).zip(b.chunks(PIECE)), |(a, b)| {
        a.iter().zip(b).map(|(&a, &b)| f64::from(a) * f64::from(b)).sum::<f64>()
    });
    sums.into_iter().sum()
}

fn add(to: &mut [f32], factor: f64, values: &[f32]) {
    let factor = factor as f32;
    parallel::for_each(to.chunks_mut(PIECE).zip(values.chunks(PIECE)), |(to, values)| {
        for (to, value) in to.iter_mut().zip(values) {
            *to += factor * value;
        }
    });
}

fn scale(values: &mut [f32], factor: f64) {
    let factor = factor as f32;
    parallel::for_each(values.chunks_mut(PIECE), |piece| piece.iter_mut().for_each(|value| *value *= factor));
}
