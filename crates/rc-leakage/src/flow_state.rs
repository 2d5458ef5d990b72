//! Fluxes through faces, from a pressure and from a correction that makes the flow conserved.

use crate::network::{Axis, Network};
use crate::parallel;
use crate::real::Real;
use crate::step::Step;
use crate::tree::SpanningTree;

/// A flow through the network.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FlowState<'a> {
    pub(crate) network: &'a Network,
    /// Pressure of each element, without the mean fall.
    pub(crate) pressure: &'a [f64],
    /// Mean fall of the pressure per element, along x and along y.
    pub(crate) fall: [f64; 2],
    pub(crate) correction: Option<Correction<'a>>,
}

/// Flow along the bonds of a tree, from each element to its parent.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Correction<'a> {
    pub(crate) tree: &'a SpanningTree,
    pub(crate) flow: &'a [f64],
}

/// Fluxes through the faces of one row of elements.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RowFluxes<'a> {
    /// Index of the row.
    pub(crate) iy: usize,
    /// Flux from each element to the next along x.
    pub(crate) east: &'a [f64],
    /// Flux from each element to the next along y.
    pub(crate) north: &'a [f64],
    /// Flux from each element of the previous row to this row.
    pub(crate) south: &'a [f64],
}

impl RowFluxes<'_> {
    /// Flux into element `ix` from the previous one along x.
    pub(crate) fn west(&self, ix: usize) -> f64 {
        self.east[if ix == 0 { self.east.len() - 1 } else { ix - 1 }]
    }

    /// Writes the outflow of each element minus its inflow.
    pub(crate) fn write_outflow(&self, out: &mut [f64]) {
        let rows = out.iter_mut().zip(self.east).zip(self.north.iter().zip(self.south));
        rows.for_each(|((out, east), (north, south))| *out = east + (north - south));
        let Some((first, rest)) = out.split_first_mut() else { return };
        *first -= self.west(0);
        rest.iter_mut().zip(self.east).for_each(|(out, west)| *out -= west);
    }
}

impl<'a> FlowState<'a> {
    /// The state of a pressure without a correction.
    pub(crate) fn of(network: &'a Network, pressure: &'a [f64], fall: [f64; 2]) -> Self {
        Self { network, pressure, fall, correction: None }
    }

    /// Calls `visit` with the fluxes of the rows from `first` to before `end`.
    pub(crate) fn visit(&self, [first, end]: [usize; 2], visit: &mut dyn FnMut(RowFluxes<'_>)) {
        let (nx, ny) = (self.network.grid().nx(), self.network.grid().ny());
        let mut rows = [vec![0.0; nx], vec![0.0; nx], vec![0.0; nx]];
        let [east, north, south] = &mut rows;
        self.write_north((first + ny - 1) % ny, south);
        for iy in first..end {
            self.write_north(iy, north);
            self.write_east(iy, east);
            visit(RowFluxes { iy, east, north, south });
            std::mem::swap(north, south);
        }
    }

    fn row(&self, iy: usize) -> (&[f64], &[f64]) {
        let nx = self.network.grid().nx();
        (&self.pressure[iy * nx..(iy + 1) * nx], self.network.resistances(iy))
    }

    fn write_north(&self, iy: usize, out: &mut [f64]) {
        let ny = self.network.grid().ny();
        let above = (iy + 1) % ny;
        let ((p, r), (q, s)) = (self.row(iy), self.row(above));
        let [aspect, fall] = [self.network.aspects()[1], self.fall[1]];
        for (out, ((p, r), (q, s))) in out.iter_mut().zip(p.iter().zip(r).zip(q.iter().zip(s))) {
            *out = aspect / (r + s) * (p - q + fall);
        }
        if let Some(correction) = self.correction {
            let (here, above) = (correction.row(iy, out.len()), correction.row(above, out.len()));
            for (out, ((step, flow), (step_above, flow_above))) in out.iter_mut().zip(here.zip(above)) {
                *out += if *step == Step::North { *flow } else { 0.0 };
                *out -= if *step_above == Step::South { *flow_above } else { 0.0 };
            }
        }
    }

    fn write_east(&self, iy: usize, out: &mut [f64]) {
        let (p, r) = self.row(iy);
        let [aspect, fall] = [self.network.aspects()[0], self.fall[0]];
        for (out, (p, r)) in out.iter_mut().zip(p.windows(2).zip(r.windows(2))) {
            *out = aspect / (r[0] + r[1]) * (p[0] - p[1] + fall);
        }
        let last = out.len() - 1;
        out[last] = aspect / (r[last] + r[0]) * (p[last] - p[0] + fall);
        if let Some(correction) = self.correction {
            for (ix, (step, flow)) in correction.row(iy, out.len()).enumerate() {
                match step {
                    Step::East => out[ix] += flow,
                    Step::West => out[if ix == 0 { last } else { ix - 1 }] -= flow,
                    _ => {}
                }
            }
        }
    }

    /// Writes the inflow of each element minus its outflow, and returns the dissipation.
    pub(crate) fn write_excess<T: Real>(&self, out: &mut [T]) -> f64 {
        let (nx, ny) = (self.network.grid().nx(), self.network.grid().ny());
        let block = parallel::rows_per_block(nx) * nx;
        let blocks = out.chunks_mut(block).zip(self.network.blocks()).collect();
        parallel::sum(blocks, |(excess, rows): (&mut [T], [usize; 2])| {
            let (mut outflow, mut power) = (vec![0.0; nx], 0.0);
            self.visit(rows, &mut |row| {
                power += self.power_of(&row, (row.iy + 1) % ny);
                row.write_outflow(&mut outflow);
                let excess = &mut excess[(row.iy - rows[0]) * nx..][..nx];
                excess.iter_mut().zip(&outflow).for_each(|(excess, outflow)| *excess = T::of(-*outflow));
            });
            power
        })
    }

    /// Dissipation Σ flux²/conductance, and the flow through each section across `axis`.
    ///
    /// The flow is summed over a section in the order of its elements.
    pub(crate) fn power_and_sections(&self, axis: Axis) -> (f64, Vec<f64>) {
        let (nx, ny) = (self.network.grid().nx(), self.network.grid().ny());
        let blocks = parallel::map(self.network.blocks(), |block| {
            let mut power = 0.0;
            let mut sections = match axis {
                Axis::X => vec![0.0; nx],
                Axis::Y => Vec::with_capacity(block[1] - block[0]),
            };
            self.visit(block, &mut |row| {
                power += self.power_of(&row, (row.iy + 1) % ny);
                match axis {
                    Axis::X => sections.iter_mut().zip(row.east).for_each(|(sum, flux)| *sum += flux),
                    Axis::Y => sections.push(row.north.iter().sum()),
                }
            });
            (power, sections)
        });
        let power = blocks.iter().map(|(power, _)| power).sum();
        let sections = blocks.into_iter().map(|(_, sections)| sections);
        let sections = match axis {
            Axis::Y => sections.collect::<Vec<_>>().concat(),
            Axis::X => sections.fold(vec![0.0; nx], |mut total, sums| {
                total.iter_mut().zip(sums).for_each(|(total, sum)| *total += sum);
                total
            }),
        };
        (power, sections)
    }

    fn power_of(&self, row: &RowFluxes<'_>, above: usize) -> f64 {
        let [here, above] = [row.iy, above].map(|iy| self.network.resistances(iy));
        let last = here.len() - 1;
        let inner = row.east.iter().zip(here.windows(2)).map(|(flux, pair)| work(*flux, pair[0] + pair[1]));
        let along_x = inner.sum::<f64>() + work(row.east[last], here[last] + here[0]);
        let along_y: f64 = row.north.iter().zip(here.iter().zip(above)).map(|(flux, (r, s))| work(*flux, r + s)).sum();
        let [x, y] = self.network.aspects();
        along_x / x + along_y / y
    }
}

impl<'a> Correction<'a> {
    fn row(self, iy: usize, nx: usize) -> impl Iterator<Item = (&'a Step, &'a f64)> {
        let range = iy * nx..(iy + 1) * nx;
        self.tree.steps()[range.clone()].iter().zip(&self.flow[range])
    }
}

/// Power of a flux through a resistance; walls do not have a flux.
fn work(flux: f64, resistance: f64) -> f64 {
    if flux == 0.0 { 0.0 } else { flux * flux * resistance }
}
