//! The rows of a study: its treated maps and its contacts.

use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

use rc_core::PeriodicCell;
use rc_solver::{Feature, Solution};
use rc_sweep::memory::Budget;
use rc_sweep::{ControlKind, FileMark, PlannedSurface, SweepPlan, SweepRow};
use serde_json::json;

use super::pictures;
use super::variants::Variant;
use crate::error::CliError;
use crate::scene::features;
use crate::scene::keys::ContactKeys;
use crate::scene::loaded::LoadedSurface;
use crate::scene::resolve::{self, ContactSetup};
use crate::surface::treated::{self, MapRead};
use crate::sweep::problems::RowScenes;

/// The columns that tell the treatments apart.
pub(super) const STEP: &str = "step";
pub(super) const TREATMENT: &str = "treatment";

/// The column with the treatment that has the same map, and whose results these are.
pub(super) const SAME_AS: &str = "same_as";

/// Maps and contacts of a study. A map is treated when its first row is due.
pub(super) struct StudyRows {
    read: MapRead,
    pub(super) variants: Vec<Variant>,
    contact: ContactKeys,
    budget: Budget,
    slots: Vec<Mutex<Slot>>,
    pictures: Pictures,
}

/// Where pictures of the contact are kept, and under which load.
pub(super) struct Pictures {
    /// The folder of the study.
    pub(super) folder: PathBuf,
    /// Mean pressure (Pa).
    pub(super) pressure: f64,
}

/// What is known of a variant.
#[derive(Default)]
struct Slot {
    cell: Option<PeriodicCell>,
    /// The treated map, until a row takes it.
    surface: Option<LoadedSurface>,
}

impl StudyRows {
    /// `contact` has no load.
    pub(super) fn new(
        read: MapRead,
        variants: Vec<Variant>,
        contact: ContactKeys,
        budget: Budget,
        pictures: Pictures,
    ) -> Self {
        let slots = variants.iter().map(|_| Mutex::default()).collect();
        Self { read, variants, contact, budget, slots, pictures }
    }

    /// The plan of the study. The map is known by the content of its file.
    ///
    /// # Errors
    /// [`CliError::Input`] when the file cannot be read.
    pub(super) fn plan(&self, pressures: &[f64]) -> Result<SweepPlan, CliError> {
        let mark = FileMark::of(&self.read.path)?;
        let mut keys = self.read.keys.clone();
        keys.heights = self.read.path.file_name().map(Into::into);
        let planned = |variant: &Variant| {
            let steps: Vec<String> = variant.treatments.iter().map(ToString::to_string).collect();
            let contact = ContactKeys { boundary: variant.boundary, ..self.contact.clone() };
            PlannedSurface {
                varied: vec![(STEP.to_owned(), json!(variant.step)), (TREATMENT.to_owned(), json!(variant.name))],
                surface: json!({ "map": keys, "treatments": steps }),
                contact: json!(contact),
                loads: pressures.to_vec(),
                map: Some(mark),
                ..PlannedSurface::default()
            }
        };
        Ok(SweepPlan::new(ControlKind::Pressure, self.variants.iter().map(planned).collect()))
    }

    /// `use_slot` of the variant with number `number`, whose map is treated unless its cell is known.
    fn slot<T>(&self, number: usize, use_slot: impl FnOnce(&mut Slot) -> T) -> Result<T, CliError> {
        // A slot is written in one step, so it is complete even after a panic.
        let mut slot = self.slots[number].lock().unwrap_or_else(PoisonError::into_inner);
        if slot.cell.is_none() {
            *slot = self.treat(number)?;
        }
        Ok(use_slot(&mut slot))
    }

    /// The cell of the variant with number `number`.
    fn cell(&self, number: usize) -> Result<PeriodicCell, CliError> {
        let cell = self.slot(number, |slot| slot.cell)?;
        cell.ok_or_else(|| CliError::input("the map has no cell"))
    }

    fn treat(&self, number: usize) -> Result<Slot, CliError> {
        let prepared = treated::treat(self.read.clone(), &self.variants[number].treatments, self.budget)?;
        let mut surface = prepared.surface;
        surface.warnings = prepared.warnings;
        Ok(Slot { cell: Some(prepared.cell), surface: Some(surface) })
    }

    /// The contact of a variant under `pressure` (Pa) in `cell`.
    ///
    /// # Errors
    /// [`CliError::Input`].
    pub(super) fn contact_in(
        contact: &ContactKeys,
        variant: &Variant,
        pressure: f64,
        cell: PeriodicCell,
    ) -> Result<ContactSetup, CliError> {
        let keys = ContactKeys { pressure: Some(pressure), boundary: variant.boundary, ..contact.clone() };
        features::check(&keys, [Feature::Sweep])?;
        let mut setup = resolve::contact(keys, cell)?;
        // The memory of a machine must not change the digits of a row.
        setup.params.method_follows_memory = false;
        Ok(setup)
    }
}

impl RowScenes<SweepRow> for StudyRows {
    fn load(&self, row: &SweepRow) -> Result<LoadedSurface, CliError> {
        match self.slot(row.surface, |slot| slot.surface.take())? {
            Some(surface) => Ok(surface),
            // Another row has it, and no longer shares it.
            None => self.treat(row.surface)?.surface.ok_or_else(|| CliError::input("the map was not treated")),
        }
    }

    fn contact(&self, row: &SweepRow) -> Result<ContactSetup, CliError> {
        Self::contact_in(&self.contact, &self.variants[row.surface], row.load, self.cell(row.surface)?)
    }

    fn see(&self, row: &SweepRow, solution: &Solution<'_>) -> Result<(), CliError> {
        let Pictures { folder, pressure } = &self.pictures;
        if row.load.total_cmp(pressure).is_ne() {
            return Ok(());
        }
        let name = &self.variants[row.surface].name;
        let side = self.cell(row.surface)?.side();
        pictures::write(&pictures::path_in(folder, name), name, (row.load, side), solution)
    }
}
