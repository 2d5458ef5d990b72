//! The network of conductances that stands for the film: elements are nodes, faces between elements are bonds.

use rc_core::{Field, Grid};

use crate::multigrid::Real;
use crate::parallel;

/// Axis of a flow, or of a fall of the pressure.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Axis {
    /// Along x.
    X,
    /// Along y.
    Y,
}

/// A pressure at elements, to more digits than one number holds: fluxes in wide places come from its last ones.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Potential<'a> {
    pub(crate) values: &'a [f64],
    /// What is added to them.
    pub(crate) rest: Option<&'a [f32]>,
}

impl Axis {
    /// Both, x first.
    pub const BOTH: [Self; 2] = [Self::X, Self::Y];

    /// 0 for x, 1 for y.
    #[must_use]
    pub fn index(self) -> usize {
        match self {
            Self::X => 0,
            Self::Y => 1,
        }
    }

    /// `x` or `y`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::X => "x",
            Self::Y => "y",
        }
    }
}

/// Conductances of faces: the harmonic mean of g³ of the elements on both sides, times length over width of the face.
///
/// Gaps are scaled to at most 2^30, so that single precision holds the conductances of gaps that differ by a factor of 10^20.
#[derive(Debug)]
pub(crate) struct Network {
    grid: Grid,
    /// 1/(2 g³) of each element, infinite in contact.
    resistances: Vec<f64>,
    /// Length over width of faces across x and across y.
    aspects: [f64; 2],
    /// Power by which conductances are to be multiplied to be those of the gaps given.
    scale: f64,
}

/// Fluxes through the faces of one row of elements.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RowFluxes<'a> {
    /// Row.
    pub(crate) iy: usize,
    /// From each element to the next along x.
    pub(crate) east: &'a [f64],
    /// From each element to the next along y.
    pub(crate) north: &'a [f64],
    /// From each element of the row before to this one.
    pub(crate) south: &'a [f64],
}

impl RowFluxes<'_> {
    /// Flux into element `ix` from the one before along x.
    pub(crate) fn west(&self, ix: usize) -> f64 {
        self.east[if ix == 0 { self.east.len() - 1 } else { ix - 1 }]
    }

    /// Writes what flows out of each element in excess of what flows in.
    pub(crate) fn write_outflow(&self, out: &mut [f64]) {
        let rows = out.iter_mut().zip(self.east).zip(self.north.iter().zip(self.south));
        rows.for_each(|((out, east), (north, south))| *out = east + (north - south));
        let Some((first, rest)) = out.split_first_mut() else { return };
        *first -= self.west(0);
        rest.iter_mut().zip(self.east).for_each(|(out, west)| *out -= west);
    }
}

impl Network {
    /// The network of `gap`, of the elements that `is_open` says carry flow (from row and column).
    pub(crate) fn new(gap: &Field, is_open: &(dyn Fn(usize, &mut [bool]) + Sync)) -> Self {
        let grid = gap.grid();
        let (nx, spacing) = (grid.nx(), grid.spacing());
        // A power of two: scaled gaps keep their digits.
        let unit = 2.0_f64.powi(30 - gap.max().log2().ceil().clamp(-900.0, 900.0) as i32);
        let mut resistances = vec![f64::INFINITY; grid.len()];
        let rows = resistances.chunks_mut(nx).enumerate().collect();
        parallel::for_each(rows, |(iy, row): (usize, &mut [f64])| {
            let mut open = vec![false; nx];
            is_open(iy, &mut open);
            for ((resistance, &gap), open) in row.iter_mut().zip(gap.row(iy)).zip(open) {
                if open {
                    *resistance = 0.5 / (gap * unit).powi(3);
                }
            }
        });
        let aspects = [spacing.y / spacing.x, spacing.x / spacing.y];
        Self { grid, resistances, aspects, scale: unit.powi(-3) }
    }

    pub(crate) fn grid(&self) -> Grid {
        self.grid
    }

    /// A conductance of the network as that of the gaps given.
    pub(crate) fn unscaled(&self, conductance: f64) -> f64 {
        conductance * self.scale
    }

    /// Writes the conductances of the faces of row `iy`: of each element to the next along x, and along y. The face of an element to
    /// itself, where there is only one, has none.
    pub(crate) fn write_conductances<T: Real>(&self, iy: usize, east: &mut [T], north: &mut [T]) {
        let (nx, ny) = (self.grid.nx(), self.grid.ny());
        let [row, above] = [iy, (iy + 1) % ny].map(|iy| &self.resistances[iy * nx..(iy + 1) * nx]);
        let [x, y] = self.aspects;
        for (out, pair) in east.iter_mut().zip(row.windows(2)) {
            *out = T::of(x / (pair[0] + pair[1]));
        }
        east[nx - 1] = if nx > 1 { T::of(x / (row[nx - 1] + row[0])) } else { T::ZERO };
        for (out, (r, s)) in north.iter_mut().zip(row.iter().zip(above)) {
            *out = if ny > 1 { T::of(y / (r + s)) } else { T::ZERO };
        }
    }

    /// Calls `visit` with the fluxes of the rows from `first` to before `end` under the pressure `pressure` that is added to a
    /// fall of `fall` per element along x and along y.
    pub(crate) fn visit_fluxes(
        &self,
        [first, end]: [usize; 2],
        pressure: Potential<'_>,
        fall: [f64; 2],
        visit: &mut dyn FnMut(RowFluxes<'_>),
    ) {
        let (nx, ny) = (self.grid.nx(), self.grid.ny());
        let row_of = |iy: usize| {
            let range = (iy % ny) * nx..(iy % ny + 1) * nx;
            (&pressure.values[range.clone()], &self.resistances[range])
        };
        let rest_of = |iy: usize| pressure.rest.map(|rest| &rest[(iy % ny) * nx..(iy % ny + 1) * nx]);
        let across_y = |out: &mut [f64], below: (&[f64], &[f64]), above: (&[f64], &[f64])| {
            let (below, above) = (below.0.iter().zip(below.1), above.0.iter().zip(above.1));
            for (out, ((p, r), (q, s))) in out.iter_mut().zip(below.zip(above)) {
                *out = self.aspects[1] / (r + s) * (p - q + fall[1]);
            }
        };
        let mut rows = [vec![0.0; nx], vec![0.0; nx], vec![0.0; nx]];
        let [east, north, south] = &mut rows;
        across_y(south, row_of(first + ny - 1), row_of(first));
        self.add_rest(south, first + ny - 1, [rest_of(first + ny - 1), rest_of(first)]);
        for iy in first..end {
            let (row, resistances) = row_of(iy);
            across_y(north, (row, resistances), row_of(iy + 1));
            self.add_rest(north, iy, [rest_of(iy), rest_of(iy + 1)]);
            let aspect = self.aspects[0];
            let pairs = row.windows(2).zip(resistances.windows(2));
            for (out, (p, r)) in east.iter_mut().zip(pairs) {
                *out = aspect / (r[0] + r[1]) * (p[0] - p[1] + fall[0]);
            }
            let last = nx - 1;
            east[last] = aspect / (resistances[last] + resistances[0]) * (row[last] - row[0] + fall[0]);
            if let Some(rest) = rest_of(iy) {
                for ix in 0..nx {
                    let next = if ix < last { ix + 1 } else { 0 };
                    let conductance = aspect / (resistances[ix] + resistances[next]);
                    east[ix] += conductance * (f64::from(rest[ix]) - f64::from(rest[next]));
                }
            }
            visit(RowFluxes { iy, east, north, south });
            std::mem::swap(north, south);
        }
    }

    /// Adds to the fluxes from row `iy` to the next what the rest of the pressure drives.
    fn add_rest(&self, fluxes: &mut [f64], iy: usize, rest: [Option<&[f32]>; 2]) {
        let (nx, ny) = (self.grid.nx(), self.grid.ny());
        let [Some(below), Some(above)] = rest else { return };
        let [r, s] = [iy, iy + 1].map(|iy| &self.resistances[(iy % ny) * nx..(iy % ny + 1) * nx]);
        for (ix, flux) in fluxes.iter_mut().enumerate() {
            *flux += self.aspects[1] / (r[ix] + s[ix]) * (f64::from(below[ix]) - f64::from(above[ix]));
        }
    }

    /// Blocks of rows: first, and one after the last.
    pub(crate) fn blocks(&self) -> Vec<[usize; 2]> {
        let rows = parallel::rows_per_block(self.grid.nx());
        (0..self.grid.ny()).step_by(rows).map(|first| [first, (first + rows).min(self.grid.ny())]).collect()
    }

    /// Power of the flow, Σ conductance · fall²: the permeance for a unit fall across the cell, where the pressure is exact, and an upper
    /// bound of it for any pressure.
    pub(crate) fn power(&self, pressure: Potential<'_>, fall: [f64; 2]) -> f64 {
        let nx = self.grid.nx();
        parallel::sum(self.blocks(), |block| {
            let mut power = 0.0;
            self.visit_fluxes(block, pressure, fall, &mut |row| {
                let above = (row.iy + 1) % self.grid.ny();
                let [here, above] = [row.iy, above].map(|iy| &self.resistances[iy * nx..(iy + 1) * nx]);
                let along_x: f64 = (0..nx).map(|ix| work(row.east[ix], here[ix] + here[(ix + 1) % nx])).sum();
                let along_y: f64 = (0..nx).map(|ix| work(row.north[ix], here[ix] + above[ix])).sum();
                power += along_x / self.aspects[0] + along_y / self.aspects[1];
            });
            power
        })
    }

    /// Flow through each section across `axis`, summed over the section in its order.
    pub(crate) fn sections(&self, pressure: Potential<'_>, fall: [f64; 2], axis: Axis) -> Vec<f64> {
        let blocks = parallel::map(self.blocks(), |block| {
            let mut sums = match axis {
                Axis::X => vec![0.0; self.grid.nx()],
                Axis::Y => Vec::with_capacity(block[1] - block[0]),
            };
            self.visit_fluxes(block, pressure, fall, &mut |row| match axis {
                Axis::X => sums.iter_mut().zip(row.east).for_each(|(sum, flux)| *sum += flux),
                Axis::Y => sums.push(row.north.iter().sum()),
            });
            sums
        });
        match axis {
            Axis::Y => blocks.concat(),
            Axis::X => blocks.into_iter().fold(vec![0.0; self.grid.nx()], |mut total, sums| {
                total.iter_mut().zip(sums).for_each(|(total, sum)| *total += sum);
                total
            }),
        }
    }
}

/// Power of a flux through a resistance; walls have none.
pub(crate) fn work(flux: f64, resistance: f64) -> f64 {
    if flux == 0.0 { 0.0 } else { flux * flux * resistance }
}
