//! What `rc prepare` did: `prepare.json` and the text on the terminal.

use rc_core::quantity::{count, engineering};
use rc_heights::Effect;
use rc_sweep::{MapOrigin, Warning};
use serde::Serialize;

use crate::inspect::mirrored;
use crate::inspect::record::{SurfaceRecord, TreatmentRow};
use crate::inspect::text::{surface_lines, treatments};
use crate::text::aligned;

/// Every step from the file to the prepared map.
#[derive(Clone, Debug, Serialize)]
pub(super) struct PrepareRecord<'a> {
    /// The file, and the names of the treatments.
    source: &'a Option<MapOrigin>,
    /// What the reader did with directions and missing points, one line each.
    orientation: Vec<String>,
    /// The map as read, and after each treatment.
    steps: &'a [TreatmentRow],
    /// The points that were despiked.
    spikes: Vec<SpikeRow>,
    /// Elements of the prepared map along x and y.
    grid: [usize; 2],
    /// Sides of its cell along x and y (m).
    sides: [f64; 2],
    /// Doubts about the map.
    warnings: &'a [Warning],
}

/// A point that was despiked.
#[derive(Clone, Copy, Debug, Serialize)]
struct SpikeRow {
    /// Column and row of the cropped map, from 0.
    at: [usize; 2],
    /// Height above the one that replaces it (m).
    height: f64,
}

impl<'a> PrepareRecord<'a> {
    /// The record of the prepared map in `surface`, after the steps of `effects`.
    pub(super) fn new(surface: &'a SurfaceRecord, effects: &[Effect]) -> Self {
        let spike = |effect: &Effect, (i, height): (usize, f64)| SpikeRow {
            at: [i % effect.grid.nx(), i / effect.grid.nx()],
            height,
        };
        let removed = effects.iter().flat_map(|effect| effect.removed.iter().map(|removed| spike(effect, *removed)));
        let unchanged = || vec!["rows and columns are in the order of the file".to_owned()];
        let notes: Vec<_> = surface.notes.iter().filter(|note| *note != mirrored::NOTE).cloned().collect();
        Self {
            source: &surface.source,
            orientation: if notes.is_empty() { unchanged() } else { notes },
            steps: &surface.treatments,
            spikes: removed.collect(),
            grid: surface.grid,
            sides: [surface.cell, surface.cell_y],
            warnings: &surface.warnings,
        }
    }

    /// The steps as a table, and the statistics of the prepared map.
    pub(super) fn text(&self, surface: &SurfaceRecord) -> String {
        let mut lines = surface_lines(surface);
        lines.insert(0, ("spikes", self.spikes_text()));
        lines.extend(self.orientation.iter().map(|note| ("orientation", note.clone())));
        treatments(self.steps) + &aligned(&lines)
    }

    fn spikes_text(&self) -> String {
        let largest = self.spikes.iter().map(|spike| spike.height.abs()).fold(0.0, f64::max);
        match self.spikes.len() {
            0 => "none".to_owned(),
            n => format!("{}, up to {}, replaced (despiked.png)", count(n, "point"), engineering(largest, "m")),
        }
    }
}
