//! The network of conductances that represents the film.
//!
//! Elements are nodes, and faces between elements are bonds.

use rc_core::{Field, Grid};

use crate::parallel;
use crate::real::Real;
use crate::step::Step;

/// Axis of a flow, or of a fall of the pressure.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Axis {
    /// Along x.
    X,
    /// Along y.
    Y,
}

impl Axis {
    /// Both axes, x first.
    pub const BOTH: [Self; 2] = [Self::X, Self::Y];

    /// Index of the axis: 0 for x, 1 for y.
    #[must_use]
    pub fn index(self) -> usize {
        match self {
            Self::X => 0,
            Self::Y => 1,
        }
    }

    /// A fall of the pressure of 1 per element along the axis.
    pub(crate) fn unit(self) -> [f64; 2] {
        match self {
            Self::X => [1.0, 0.0],
            Self::Y => [0.0, 1.0],
        }
    }

    /// Name of the axis: `x` or `y`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::X => "x",
            Self::Y => "y",
        }
    }
}

/// Conductances of faces.
///
/// A conductance is the harmonic mean of g³ of the elements on both sides, times length over width of the face. Gaps
/// are scaled to at most 2^30. Single precision then holds the conductances of gaps that differ by a factor of 10^20.
#[derive(Debug)]
pub(crate) struct Network {
    grid: Grid,
    /// 1/(2 g³) of each element; infinite in contact.
    resistances: Vec<f64>,
    /// Ratios of length to width of faces across x and across y.
    aspects: [f64; 2],
    /// Power of two that scales conductances back to those of the given gaps.
    scale: f64,
}

impl Network {
    /// The network of `gap`, whose values are limited to `widest`.
    ///
    /// `is_open` tells which elements of a row carry flow.
    pub(crate) fn new(gap: &Field, widest: f64, is_open: &(dyn Fn(usize, &mut [bool]) + Sync)) -> Self {
        let grid = gap.grid();
        let (nx, spacing) = (grid.nx(), grid.spacing());
        // It is a power of two, so that scaled gaps keep their digits.
        let unit = 2.0_f64.powi(30 - gap.max().min(widest).log2().ceil().clamp(-900.0, 900.0) as i32);
        let mut resistances = vec![f64::INFINITY; grid.len()];
        let rows = resistances.chunks_mut(nx).enumerate().collect();
        parallel::for_each(rows, |(iy, row): (usize, &mut [f64])| {
            let mut open = vec![false; nx];
            is_open(iy, &mut open);
            for ((resistance, &gap), open) in row.iter_mut().zip(gap.row(iy)).zip(open) {
                if open {
                    *resistance = 0.5 / (gap.min(widest) * unit).powi(3);
                }
            }
        });
        let aspects = [spacing.y / spacing.x, spacing.x / spacing.y];
        Self { grid, resistances, aspects, scale: unit.powi(-3) }
    }

    pub(crate) fn grid(&self) -> Grid {
        self.grid
    }

    /// The conductance of the given gaps from one of the network.
    pub(crate) fn unscaled(&self, conductance: f64) -> f64 {
        conductance * self.scale
    }

    /// Writes the conductances of the faces of row `iy`.
    ///
    /// They are from each element to the next along x, and along y. The face from an element to itself, on a grid with
    /// one element along an axis, has the conductance 0.
    pub(crate) fn write_conductances<T: Real>(&self, iy: usize, east: &mut [T], north: &mut [T]) {
        let (nx, ny) = (self.grid.nx(), self.grid.ny());
        let [row, above] = [iy, (iy + 1) % ny].map(|iy| self.resistances(iy));
        let [x, y] = self.aspects;
        for (out, pair) in east.iter_mut().zip(row.windows(2)) {
            *out = T::of(x / (pair[0] + pair[1]));
        }
        east[nx - 1] = if nx > 1 { T::of(x / (row[nx - 1] + row[0])) } else { T::ZERO };
        for (out, (r, s)) in north.iter_mut().zip(row.iter().zip(above)) {
            *out = if ny > 1 { T::of(y / (r + s)) } else { T::ZERO };
        }
    }

    /// 1/(2 g³) of each element of row `iy`; infinite in contact.
    pub(crate) fn resistances(&self, iy: usize) -> &[f64] {
        let nx = self.grid.nx();
        &self.resistances[iy * nx..(iy + 1) * nx]
    }

    /// Ratios of length to width of faces across x and across y.
    pub(crate) fn aspects(&self) -> [f64; 2] {
        self.aspects
    }

    /// Neighbours of an element, with the conductances to them; 0 where there is no bond.
    pub(crate) fn bonds_of(&self, element: usize) -> [(usize, f64); 4] {
        [Step::East, Step::West, Step::North, Step::South].map(|step| {
            let other = step.from(element, self.grid);
            let aspect = self.aspects[usize::from(matches!(step, Step::North | Step::South))];
            let conductance = aspect / (self.resistances[element] + self.resistances[other]);
            (other, if other == element { 0.0 } else { conductance })
        })
    }

    /// Blocks of rows, each from its first row to the one after its last.
    pub(crate) fn blocks(&self) -> Vec<[usize; 2]> {
        let rows = parallel::rows_per_block(self.grid.nx());
        (0..self.grid.ny()).step_by(rows).map(|first| [first, (first + rows).min(self.grid.ny())]).collect()
    }
}
