//! The front door: permeances, percolation and constrictions of a gap.

use rc_core::{Field, Grid};

use crate::clusters::Clusters;
use crate::constriction::{Constriction, Thresholds};
use crate::descent::{self, Pressure, Target, elements_along};
use crate::error::LeakageError;
use crate::flux::Flux;
use crate::multigrid::Multigrid;
use crate::network::{Axis, Network};

/// How the flow is computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeakageParams {
    /// Largest difference of the flow through two sections of the cell, relative to the flow.
    pub conservation: f64,
    /// Most iterations of one flow.
    pub max_iterations: usize,
    /// Whether the flow is computed on every second element along both axes too, which gives the error bar of the grid.
    pub half_grid: bool,
}

impl Default for LeakageParams {
    fn default() -> Self {
        Self { conservation: 1e-10, max_iterations: 500, half_grid: true }
    }
}

/// The flow along both axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Leakage {
    /// Along x, and along y.
    pub flows: [Flow; 2],
    /// The flux of the axis [`Leakage::flow_axis`]; `None` where nothing flows.
    pub flux: Option<Flux>,
}

/// The flow along one axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Flow {
    /// Flow for a pressure that falls by one across the cell and 12 η = 1, in λ³: 0 where nothing percolates. An upper bound of the
    /// permeance of the network, by the principle of Dirichlet.
    pub permeance: f64,
    /// Estimated error of the grid: the difference from the permeance of every second element; `None` where it was not computed, or the
    /// sides are odd.
    pub permeance_error: Option<f64>,
    /// Whether a cluster of elements out of contact winds around the cell along this axis.
    pub percolates: bool,
    /// The narrowest place of the widest path, where the film percolates.
    pub constriction: Option<Constriction>,
    /// What was done.
    pub info: FlowInfo,
}

/// What was done to compute a flow.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FlowInfo {
    /// Iterations.
    pub iterations: usize,
    /// Largest difference of the flow through a section from the mean of all, relative to it.
    pub conservation: f64,
}

impl Leakage {
    /// The axis with the larger permeance, x if they are equal; `None` where nothing flows.
    #[must_use]
    pub fn flow_axis(&self) -> Option<Axis> {
        let [x, y] = self.flows.each_ref().map(|flow| flow.permeance);
        match (x > 0.0 || y > 0.0, y > x) {
            (false, _) => None,
            (true, false) => Some(Axis::X),
            (true, true) => Some(Axis::Y),
        }
    }
}

/// The flow through `gap` (in λ; 0 in contact), periodic along both axes.
///
/// # Errors
/// [`LeakageError::Gap`] for a gap that is negative or not finite, [`LeakageError::NotConverged`].
pub fn leakage(gap: &Field, params: &LeakageParams) -> Result<Leakage, LeakageError> {
    check(gap)?;
    let (permeances, solved) = flows(gap, params, true)?;
    let halves = match half(gap).filter(|_| params.half_grid && solved.percolates != [false; 2]) {
        Some(half) => Some(flows(&half, params, false)?.0),
        None => None,
    };
    let mut thresholds = Thresholds::new(gap);
    let flows = Axis::BOTH.map(|axis| {
        let i = axis.index();
        let (permeance, info) = permeances[i];
        let percolates = solved.percolates[i];
        Flow {
            permeance,
            permeance_error: halves.filter(|_| percolates).map(|halves| (permeance - halves[i].0).abs()),
            percolates,
            constriction: if percolates { thresholds.constriction(axis) } else { None },
            info,
        }
    });
    Ok(Leakage { flows, flux: solved.flux })
}

fn check(gap: &Field) -> Result<(), LeakageError> {
    let nx = gap.grid().nx();
    match gap.values().iter().position(|gap| !(gap.is_finite() && *gap >= 0.0)) {
        None => Ok(()),
        Some(index) => Err(LeakageError::Gap { ix: index % nx, iy: index / nx, value: gap.values()[index] }),
    }
}

/// Every second element along both axes, where the sides are even.
fn half(gap: &Field) -> Option<Field> {
    let grid = gap.grid();
    let (nx, ny) = (grid.nx(), grid.ny());
    if !(nx.is_multiple_of(2) && ny.is_multiple_of(2) && nx.min(ny) >= 4) {
        return None;
    }
    let rows = (0..ny).step_by(2).flat_map(|iy| gap.row(iy).iter().copied().step_by(2));
    Field::new(grid.with_elements(nx / 2, ny / 2).ok()?, rows.collect()).ok()
}

struct Solved {
    percolates: [bool; 2],
    flux: Option<Flux>,
}

/// Permeances along both axes, and the flux along that of the larger one.
fn flows(gap: &Field, params: &LeakageParams, with_flux: bool) -> Result<([(f64, FlowInfo); 2], Solved), LeakageError> {
    let mut clusters = Clusters::above(gap, 0.0, false);
    let percolates = clusters.percolates();
    let masks = Axis::BOTH.map(|axis| clusters.winding(axis));
    let mut results = [(0.0, FlowInfo::default()); 2];
    let mut kept: Option<(Target, Pressure)> = None;
    let mut prepared: Option<(usize, Network, Multigrid)> = None;
    for axis in Axis::BOTH.into_iter().filter(|axis| percolates[axis.index()]) {
        let i = axis.index();
        let (of, network, mut multigrid) = match prepared.take() {
            Some((of, network, multigrid)) if masks[of] == masks[i] => (of, network, multigrid),
            _ => {
                let network = network_of(gap, &clusters, &masks[i]);
                let multigrid = Multigrid::new(&network);
                (i, network, multigrid)
            }
        };
        let target = Target { axis, conservation: params.conservation, max_iterations: params.max_iterations };
        let (result, pressure) = one_flow(&network, &mut multigrid, target)?;
        results[i] = result;
        if with_flux && (kept.is_none() || results[1].0 > results[0].0) {
            kept = Some((target, pressure));
        }
        prepared = Some((of, network, multigrid));
    }
    drop(prepared);
    let flux = kept.map(|(target, pressure)| {
        let network = network_of(gap, &clusters, &masks[target.axis.index()]);
        let factor = network.unscaled(1.0) / elements_along(gap.grid(), target.axis) as f64;
        Flux::of(&network, pressure.potential(), target, factor)
    });
    Ok((results, Solved { percolates, flux }))
}

/// The network of the runs that `carries` says carry a flow.
fn network_of(gap: &Field, clusters: &Clusters, carries: &[bool]) -> Network {
    Network::new(gap, &|iy, open: &mut [bool]| {
        let range = clusters.first_of_row[iy]..clusters.first_of_row[iy + 1];
        for (run, _) in clusters.runs[range.clone()].iter().zip(&carries[range]).filter(|(_, carries)| **carries) {
            open[run.start as usize..run.end as usize].fill(true);
        }
    })
}

/// Permeance and pressure of the flow along one axis.
fn one_flow(
    network: &Network,
    multigrid: &mut Multigrid,
    target: Target,
) -> Result<((f64, FlowInfo), Pressure), LeakageError> {
    let grid: Grid = network.grid();
    let pressure = descent::solve(network, multigrid, target);
    let info = FlowInfo { iterations: pressure.iterations, conservation: pressure.conservation };
    if !(pressure.conservation <= target.conservation) {
        return Err(LeakageError::NotConverged {
            axis: target.axis.name(),
            grid,
            conservation: info.conservation,
            iterations: info.iterations,
        });
    }
    let n = elements_along(grid, target.axis) as f64;
    let permeance = network.unscaled(network.power(pressure.potential(), target.fall())) / (n * n);
    Ok(((permeance, info), pressure))
}
