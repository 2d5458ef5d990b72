//! The treatments of a study that give different maps.

use rc_core::Boundary;
use rc_sweep::FileMark;
use rc_sweep::memory::Budget;

use super::record::Skipped;
use super::rows::StudyRows;
use super::variants::Variant;
use crate::error::CliError;
use crate::scene::keys::ContactKeys;
use crate::solve::memory_factor;
use crate::solve::solved::ProblemSetup;
use crate::surface::treated::{self, MapRead, Prepared};
use crate::warnings::shown;

/// What identifies the contact of a treatment: heights in cells, elements, sides in m as bits, and boundary.
type Identity = (FileMark, [usize; 2], [u64; 2], Boundary);

/// The treatments that can be solved.
#[derive(Default)]
pub(super) struct Distinct {
    /// All treatments, in their order.
    pub(super) all: Vec<Variant>,
    /// Those with a map of their own.
    pub(super) solved: Vec<Variant>,
    /// For each of `all`, the place in `solved` of the one with the same map.
    pub(super) place: Vec<usize>,
    pub(super) skipped: Vec<Skipped>,
    identities: Vec<Identity>,
}

/// What all treatments have in common.
pub(super) struct Common<'a> {
    pub(super) read: &'a MapRead,
    /// The contact without a load.
    pub(super) contact: &'a ContactKeys,
    /// Mean pressures (Pa).
    pub(super) pressures: &'a [f64],
    pub(super) budget: Budget,
    /// Whether a warning about the unchanged treatments refuses the study.
    pub(super) strict: bool,
}

impl Distinct {
    /// Treats the map in all ways of `variants`, and compares the results.
    ///
    /// # Errors
    /// [`CliError::Input`] when the first way is impossible, or gives a warning in a strict study.
    pub(super) fn of(variants: Vec<Variant>, common: &Common<'_>) -> Result<Self, CliError> {
        let mut found = Self::default();
        for variant in variants {
            match common.treated(&variant) {
                Ok(prepared) => {
                    if common.strict && found.all.is_empty() {
                        common.refuse(&variant, &prepared)?;
                    }
                    found.add(variant, &prepared)?;
                }
                Err(error) if found.all.is_empty() => return Err(error),
                Err(error) => found.skipped.push(Skipped { treatment: variant.name, reason: error.to_string() }),
            }
        }
        Ok(found)
    }

    /// Number of elements of the largest contact under the keys `contact`.
    ///
    /// With a flow, it is the number of elements that take the same memory without the flow.
    pub(super) fn max_elements(&self, contact: &ContactKeys) -> f64 {
        let elements = |(_, [nx, ny], _, boundary): &Identity| {
            let keys = ContactKeys { boundary: Some(*boundary), ..contact.clone() };
            (nx * ny) as f64 * memory_factor(&keys)
        };
        self.identities.iter().map(elements).fold(0.0, f64::max)
    }

    fn add(&mut self, variant: Variant, prepared: &Prepared) -> Result<(), CliError> {
        let (grid, sides) = (prepared.surface.grid, prepared.cell.sides());
        let mark = FileMark::of_values(prepared.surface.heights()?.values());
        let boundary = variant.boundary.unwrap_or_default();
        let identity = (mark, [grid.nx(), grid.ny()], sides.map(f64::to_bits), boundary);
        let same = self.identities.iter().position(|other| *other == identity);
        let place = same.unwrap_or(self.solved.len());
        if same.is_none() {
            self.identities.push(identity);
            self.solved.push(variant.clone());
        }
        self.place.push(place);
        self.all.push(variant);
        Ok(())
    }

    /// The earlier treatment that has the map of treatment `number`.
    pub(super) fn same_as(&self, number: usize) -> Option<&str> {
        let first = self.place.iter().position(|place| *place == self.place[number])?;
        (first < number).then(|| self.all[first].name.as_str())
    }
}

impl Common<'_> {
    /// The treated map, if it is one and bears the contact.
    fn treated(&self, variant: &Variant) -> Result<Prepared, CliError> {
        let prepared = treated::treat(self.read.clone(), &variant.treatments, self.budget)?;
        for pressure in self.pressures {
            StudyRows::contact_in(self.contact, variant, *pressure, prepared.cell)?.kernel()?;
        }
        Ok(prepared)
    }

    /// Refuses doubts that are known before the rows.
    ///
    /// Those of the unchanged treatments count alone. Other treatments may be doubtful, such as the lowest height in
    /// holes, and are solved to show what they do.
    fn refuse(&self, variant: &Variant, prepared: &Prepared) -> Result<(), CliError> {
        const AFTER: &str = "; nothing was solved or written";
        shown::refuse(&prepared.warnings, true, AFTER)?;
        for pressure in self.pressures {
            let contact = StudyRows::contact_in(self.contact, variant, *pressure, prepared.cell)?;
            let kernel = contact.kernel()?;
            let (surface, budget) = (&prepared.surface, Budget::UNLIMITED);
            let problem = ProblemSetup { surface, contact: &contact, kernel: &*kernel, budget };
            shown::refuse(&problem.warnings(), true, AFTER)?;
        }
        Ok(())
    }
}
