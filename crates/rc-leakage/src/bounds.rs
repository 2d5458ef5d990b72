//! Bounds of the permeance, from any pressure and any conserved flow.
//!
//! The pressure gives an upper bound (Dirichlet's principle): its power is at least that of the solution. Its fluxes,
//! made conserved along a spanning tree, give a lower bound (Thomson's principle): their power for a given flow is at
//! least that of the solution.

use crate::flow_state::{Correction, FlowState};
use crate::network::Axis;
use crate::tree::SpanningTree;

/// Bounds of a flow, for a pressure that falls by 1 per element along its axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bounds {
    /// Upper bound of the power of the flow.
    pub(crate) upper: f64,
    /// Lower bound of the power of the flow.
    pub(crate) lower: f64,
    /// Conserved flow through a section.
    pub(crate) flow: f64,
    /// Maximum relative difference of the conserved flow between a section and the mean.
    pub(crate) conservation: f64,
}

impl Bounds {
    /// Bounds from the pressure in `state`.
    ///
    /// `excess` receives the flow along the tree that conserves the flow of this pressure.
    pub(crate) fn of(
        (state, upper): (FlowState<'_>, f64),
        tree: &SpanningTree,
        axis: Axis,
        excess: &mut [f64],
    ) -> Self {
        tree.route(excess);
        let conserved = FlowState { correction: Some(Correction { tree, flow: excess }), ..state };
        let (dissipation, sections) = conserved.power_and_sections(axis);
        let n = sections.len() as f64;
        let flow = sections.iter().sum::<f64>() / n;
        let lower = if flow > 0.0 { (n * flow).powi(2) / dissipation } else { 0.0 };
        let largest = sections.iter().map(|section| (section - flow).abs()).fold(0.0, f64::max);
        Self { upper, lower, flow, conservation: if flow > 0.0 { largest / flow } else { f64::INFINITY } }
    }

    /// Maximum relative error of the upper bound.
    pub(crate) fn relative(&self) -> f64 {
        // This avoids a negative error by rounding.
        if self.upper > 0.0 { (1.0 - self.lower / self.upper).abs() } else { f64::INFINITY }
    }
}
