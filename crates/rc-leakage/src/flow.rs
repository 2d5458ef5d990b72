//! The front door of the crate: permeances, percolation and constrictions of a gap.

use rc_core::{Field, Grid};

use crate::aggregation::{Aggregation, Graph};
use crate::bounds::Bounds;
use crate::clusters::Clusters;
use crate::constriction::{Constriction, Thresholds};
use crate::descent::{self, Solved, Target};
use crate::error::LeakageError;
use crate::flow_state::{Correction, FlowState};
use crate::flux::Flux;
use crate::multigrid::Multigrid;
use crate::network::{Axis, Network};
use crate::tree::SpanningTree;
use crate::variants::{coarser, error_bar, opened};

/// Accuracy and limits of the computation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeakageParams {
    /// Maximum relative difference of the upper and the lower bound of the permeance.
    pub error: f64,
    /// Maximum relative difference of the flow through a section from the mean over all sections.
    pub conservation: f64,
    /// Maximum number of iterations of one flow.
    pub max_iterations: usize,
    /// Whether the flow is also computed on three grids of half the resolution.
    ///
    /// This gives the error bar of the grid.
    pub half_grid: bool,
}

impl Default for LeakageParams {
    fn default() -> Self {
        Self { error: 1e-9, conservation: 1e-10, max_iterations: 500, half_grid: true }
    }
}

/// The flow along both axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Leakage {
    /// The flow along x, and along y.
    pub flows: [Flow; 2],
    /// The flux of the flow along [`Leakage::flow_axis`]; `None` without a flow.
    ///
    /// It has components along x and along y.
    pub flux: Option<Flux>,
}

/// The flow along one axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flow {
    /// Flow in λ³, for a pressure that falls by 1 across the cell and 12 η = 1.
    ///
    /// It is 0 without percolation. It is an upper bound of the permeance of the network, by the principle of
    /// Dirichlet; see [`FlowInfo::error`].
    pub permeance: f64,
    /// Error bar of the grid, in λ³. It holds for about 98 % of resolved rough contacts.
    ///
    /// It is half of the range of the permeances on the grid and on three grids of half the resolution: every second
    /// element, those diagonally between, and means of two by two elements. If some of these are 0, it is the whole
    /// range. For a permeance of 0, the range has also the permeance for edges of contacts one element further in.
    ///
    /// `None` without [`LeakageParams::half_grid`], if a side has fewer than four elements, or if one of these flows
    /// does not converge.
    pub permeance_error: Option<f64>,
    /// Whether a cluster of elements out of contact winds around the cell along this axis.
    pub percolates: bool,
    /// The narrowest place on the widest path, if the film percolates.
    pub constriction: Option<Constriction>,
    /// Information on the computation.
    pub info: FlowInfo,
}

/// Information on the computation of a flow.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FlowInfo {
    /// Number of iterations.
    pub iterations: usize,
    /// Maximum relative error of the network's permeance.
    ///
    /// It is 1 minus the ratio of the lower bound to the upper bound. The upper bound is [`Flow::permeance`]. The lower
    /// bound follows from the principle of Thomson.
    pub error: f64,
    /// Maximum relative difference of the flow through a section from the mean over all sections.
    pub conservation: f64,
}

impl Leakage {
    /// The axis with the larger permeance, x if both are equal; `None` without a flow.
    #[must_use]
    pub fn flow_axis(&self) -> Option<Axis> {
        let permeances = self.flows.each_ref().map(|flow| flow.permeance);
        permeances.iter().any(|permeance| *permeance > 0.0).then(|| larger(permeances))
    }
}

/// The flow through `gap` (in λ; 0 in contact), periodic along both axes.
///
/// # Errors
/// [`LeakageError::Gap`] for a gap that is negative or not finite, [`LeakageError::NotConverged`].
pub fn leakage(gap: &Field, params: &LeakageParams) -> Result<Leakage, LeakageError> {
    check(gap)?;
    let (half, variants) = if params.half_grid { on_coarser_grids(gap, params) } else { (None, None) };
    let solved = flows(gap, params, Role::Whole { half: half.as_ref() })?;
    let bars = variants.map_or([None; 2], |variants| bars(gap, &solved, &variants, params));
    let flows = Axis::BOTH.map(|axis| {
        let i = axis.index();
        let (permeance, info) = solved.results[i];
        Flow {
            permeance,
            permeance_error: bars[i],
            percolates: solved.percolates[i],
            constriction: solved.constrictions[i],
            info,
        }
    });
    Ok(Leakage { flows, flux: solved.flux })
}

/// Whether the film in `gap` (0 in contact) winds around the periodic cell along x, and along y.
#[must_use]
pub fn percolates(gap: &Field) -> [bool; 2] {
    Clusters::above(gap, 0.0, false).percolates()
}

/// Maximum relative difference of the bounds on coarser grids. An error bar needs a few digits only.
const ERROR_OF_COARSER: f64 = 1e-4;

/// Maximum relative difference of the bounds where the film was closed, and contacts are made smaller.
const ERROR_OF_OPENED: f64 = 1e-2;

/// The flows on every second element, and the permeances on all coarser grids.
fn on_coarser_grids(gap: &Field, params: &LeakageParams) -> (Option<OfGrid>, Option<Vec<[f64; 2]>>) {
    let params = LeakageParams { error: params.error.max(ERROR_OF_COARSER), ..*params };
    let mut grids = coarser(gap).into_iter().map(|gap| flows(&gap, &params, Role::Variant { axes: [true; 2] }).ok());
    let half = grids.next().flatten();
    let others: Option<Vec<[f64; 2]>> = grids.map(|flows| Some(flows?.permeances())).collect();
    let all = half.as_ref().zip(others).map(|(half, others)| [vec![half.permeances()], others].concat());
    (half, all)
}

/// Error bars of both permeances, from those on coarser grids.
///
/// For axes along which the film does not percolate, contacts are also made smaller.
fn bars(gap: &Field, solved: &OfGrid, coarser: &[[f64; 2]], params: &LeakageParams) -> [Option<f64>; 2] {
    let closed = solved.percolates.map(|percolates| !percolates);
    let with_opened = || {
        let params = LeakageParams { error: params.error.max(ERROR_OF_OPENED), ..*params };
        flows(&opened(gap), &params, Role::Variant { axes: closed }).ok().map(|flows| flows.permeances())
    };
    let opened = if closed.contains(&true) { with_opened() } else { None };
    [0, 1].map(|i| {
        let mut variants: Vec<f64> = coarser.iter().map(|permeances| permeances[i]).collect();
        if closed[i] {
            variants.push(opened?[i]);
        }
        Some(error_bar(solved.results[i].0, &variants))
    })
}

fn check(gap: &Field) -> Result<(), LeakageError> {
    let nx = gap.grid().nx();
    match gap.values().iter().position(|gap| !(gap.is_finite() && *gap >= 0.0)) {
        None => Ok(()),
        Some(index) => Err(LeakageError::Gap { ix: index % nx, iy: index / nx, value: gap.values()[index] }),
    }
}

/// What a grid is solved for.
#[derive(Clone, Copy)]
enum Role<'a> {
    /// Permeances along these axes for the error bar of the grid, and pressures for a start.
    Variant { axes: [bool; 2] },
    /// The results. The flows start from those of every second element.
    Whole { half: Option<&'a OfGrid> },
}

/// The flows on one grid.
struct OfGrid {
    /// Permeances along both axes.
    results: [(f64, FlowInfo); 2],
    percolates: [bool; 2],
    constrictions: [Option<Constriction>; 2],
    flux: Option<Flux>,
    /// Pressures of both flows of a variant.
    ///
    /// Empty for [`Role::Whole`], and for a flow that does not percolate.
    pressures: [Vec<f64>; 2],
}

impl OfGrid {
    fn permeances(&self) -> [f64; 2] {
        self.results.map(|(permeance, _)| permeance)
    }
}

/// Gaps below this multiple of the smaller critical gap count as closed.
///
/// The critical gap of an axis is the gap at its constriction. An element at the limit has 1e-15 of the conductance of
/// a constriction. Where only such elements connect a part of the film to the rest, rounding would decide the pressure
/// of this part.
const CLOSED: f64 = 1e-5;

/// Limit of gaps, as a multiple of the critical gap of an axis.
///
/// Wider gaps are replaced by the limit. An element at the limit has 1e-14 of the resistance of a constriction. In a
/// wider gap, the pressure difference that drives the flow would be lost in rounding.
const WIDE: f64 = 5e4;

/// Permeances along both axes, and the flux along the axis with the larger one.
fn flows(gap: &Field, params: &LeakageParams, role: Role<'_>) -> Result<OfGrid, LeakageError> {
    let percolates = percolates(gap);
    let mut thresholds = Thresholds::new(gap);
    let constrictions =
        Axis::BOTH.map(|axis| if percolates[axis.index()] { thresholds.constriction(axis) } else { None });
    let critical = constrictions.iter().flatten().map(|place| place.gap).fold(f64::INFINITY, f64::min);
    let mut clusters = Clusters::above(gap, CLOSED * critical, true);
    let masks = Axis::BOTH.map(|axis| clusters.winding(axis));
    let largest = gap.max();
    let widest = constrictions.map(|place| place.map_or(largest, |place| largest.min(WIDE * place.gap)));
    let network = |i: usize| network_of((gap, widest[i]), &clusters, &masks[i]);
    let mut results = [(0.0, FlowInfo::default()); 2];
    let mut pressures = [Vec::new(), Vec::new()];
    let mut kept: Option<(Axis, Solved)> = None;
    let mut prepared: Option<(usize, Prepared)> = None;
    let serves = |of: usize, i: usize| masks[of] == masks[i] && widest[of].total_cmp(&widest[i]).is_eq();
    let wanted = match role {
        Role::Variant { axes } => [0, 1].map(|i| percolates[i] && axes[i]),
        Role::Whole { .. } => percolates,
    };
    for axis in weaker_first(&constrictions).into_iter().filter(|axis| wanted[axis.index()]) {
        let i = axis.index();
        let (of, mut network) = match prepared.take() {
            Some((of, network)) if serves(of, i) => (of, network),
            _ => (i, Prepared::new(network(i))),
        };
        // This saves memory while the second flow is solved. If the first flow is the larger one, its correction is
        // computed again.
        if let Some((_, solved)) = &mut kept {
            solved.correction = Vec::new();
        }
        let start = match role {
            Role::Variant { .. } => None,
            Role::Whole { half } => {
                half.map(|half| half.pressures[i].as_slice()).filter(|pressure| !pressure.is_empty())
            }
        };
        let mut solved = network.solved(axis, params, start)?;
        results[i] = network.result(axis, &solved);
        match role {
            Role::Variant { .. } => pressures[i] = std::mem::take(&mut solved.pressure),
            Role::Whole { .. } if kept.is_none() || axis == larger(results.map(|(permeance, _)| permeance)) => {
                kept = Some((axis, solved));
            }
            Role::Whole { .. } => {}
        }
        prepared = Some((of, network));
    }
    let flux = kept.zip(prepared).map(|((axis, solved), (of, prepared))| {
        let i = axis.index();
        let (network, tree) = if serves(of, i) { (prepared.network, prepared.tree) } else { with_tree(network(i)) };
        flux(solved, &network, &tree, axis)
    });
    Ok(OfGrid { results, percolates, constrictions, flux, pressures })
}

/// The axis with the larger permeance, x if both are equal.
fn larger([x, y]: [f64; 2]) -> Axis {
    if y > x { Axis::Y } else { Axis::X }
}

/// Both axes. The flow through the wider constriction is second, since it is more likely to be the larger one.
fn weaker_first(constrictions: &[Option<Constriction>; 2]) -> [Axis; 2] {
    let [x, y] = constrictions.map(|place| place.map_or(0.0, |place| place.gap));
    if y < x { [Axis::Y, Axis::X] } else { Axis::BOTH }
}

/// The network of the runs that carry a flow (`carries`).
fn network_of((gap, widest): (&Field, f64), clusters: &Clusters, carries: &[bool]) -> Network {
    Network::new(gap, widest, &|iy, open: &mut [bool]| {
        let range = clusters.first_of_row[iy]..clusters.first_of_row[iy + 1];
        for (run, _) in clusters.runs[range.clone()].iter().zip(&carries[range]).filter(|(_, carries)| **carries) {
            open[run.start as usize..run.end as usize].fill(true);
        }
    })
}

fn with_tree(network: Network) -> (Network, SpanningTree) {
    let tree = SpanningTree::new(&network);
    (network, tree)
}

/// The flux of a solved flow, scaled so that it carries the permeance.
///
/// The flow's relative error is the square root of the permeance's.
fn flux(solved: Solved, network: &Network, tree: &SpanningTree, axis: Axis) -> Flux {
    let Solved { pressure, correction: mut flow, bounds, .. } = solved;
    let state = FlowState::of(network, &pressure, axis.unit());
    if flow.is_empty() {
        flow.resize(pressure.len(), 0.0);
        state.write_excess(&mut flow);
        tree.route(&mut flow);
    }
    let state = FlowState { correction: Some(Correction { tree, flow: &flow }), ..state };
    let n = elements_along(network.grid(), axis) as f64;
    Flux::of(state, network.unscaled(bounds.upper / (n * bounds.flow)) / n)
}

/// Elements along `axis`.
fn elements_along(grid: Grid, axis: Axis) -> usize {
    match axis {
        Axis::X => grid.nx(),
        Axis::Y => grid.ny(),
    }
}

/// Maximum number of iterations with coarser grids in the preconditioner.
///
/// Films that are resolved take three to six. After the maximum, all coarser levels are aggregates, which are groups of
/// elements with strong bonds. Before, only the levels below the coarser grids are aggregates.
const ON_GRIDS: usize = 12;

/// A network with its tree and its preconditioner.
struct Prepared {
    network: Network,
    tree: SpanningTree,
    preconditioner: Precondition,
}

/// The preconditioner of a network.
///
/// It uses coarser grids until a flow shows that they do not represent the network.
enum Precondition {
    Grids(Multigrid<f32>),
    Aggregates(Aggregation),
}

impl Prepared {
    fn new(network: Network) -> Self {
        let preconditioner = Precondition::Grids(Multigrid::new(&network));
        Self { tree: SpanningTree::new(&network), network, preconditioner }
    }

    /// The flow along one axis. It starts from the pressure of every second element, `half`.
    fn solved(&mut self, axis: Axis, params: &LeakageParams, half: Option<&[f64]>) -> Result<Solved, LeakageError> {
        let target = Target { axis, error: params.error, conservation: params.conservation };
        let of = (&self.network, &self.tree);
        let n = self.network.grid().len();
        let mut solved = Solved::start(n);
        if let Precondition::Grids(multigrid) = &mut self.preconditioner {
            if let Some(start) = half.and_then(|half| multigrid.pressure_between(half, axis.unit())) {
                solved.pressure = start;
            }
            solved = descent::solve(of, solved, multigrid, target, params.max_iterations.min(ON_GRIDS));
            if !target.is_met(&solved.bounds) {
                self.preconditioner = Precondition::Aggregates(Aggregation::new(graph_of(&self.network)));
                // It starts without a pressure again. In single precision, rounding may have raised the pressure of
                // weakly connected pools so much that no digits are left for the others.
                solved = Solved { iterations: solved.iterations, ..Solved::start(n) };
            }
        }
        if let Precondition::Aggregates(aggregation) = &mut self.preconditioner
            && !target.is_met(&solved.bounds)
        {
            let rest = params.max_iterations.saturating_sub(solved.iterations);
            solved = descent::solve(of, solved, aggregation, target, rest);
        }
        if target.is_met(&solved.bounds) {
            return Ok(solved);
        }
        let Bounds { conservation, .. } = solved.bounds;
        Err(LeakageError::NotConverged {
            axis: axis.name(),
            grid: self.network.grid(),
            error: solved.bounds.relative(),
            conservation,
            iterations: solved.iterations,
        })
    }

    /// The permeance, and information on the computation.
    fn result(&self, axis: Axis, solved: &Solved) -> (f64, FlowInfo) {
        let bounds = &solved.bounds;
        let info =
            FlowInfo { iterations: solved.iterations, error: bounds.relative(), conservation: bounds.conservation };
        let n = elements_along(self.network.grid(), axis) as f64;
        (self.network.unscaled(bounds.upper) / (n * n), info)
    }
}

fn graph_of(network: &Network) -> Graph {
    Graph::new(network.grid().len(), &|element, bonds| {
        let all = network.bonds_of(element).into_iter().filter(|(_, bond)| *bond > 0.0);
        bonds.extend(all.map(|(other, bond)| (other as u32, bond)));
    })
}
