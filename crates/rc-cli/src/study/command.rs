//! The command, from the file to the table.

use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use rc_core::quantity::{count, digits};
use rc_core::{Boundary, PeriodicCell};
use rc_sweep::files::Staged;
use rc_sweep::memory::Budget;
use rc_sweep::{Loads, MAX_ROWS, Shard, Sweep, SweepRows, files, to_csv, to_json};

use super::args::StudyArgs;
use super::ranges;
use super::record::{Skipped, StudyRecord, lines};
use super::rows::StudyRows;
use super::variants::{Base, Variant, after_crops};
use crate::error::CliError;
use crate::prepare::args::treatments;
use crate::report::PAGE_FILE;
use crate::run::threads;
use crate::scene::keys::{ContactKeys, Scene};
use crate::scene::{origin, resolve};
use crate::surface::treated::{self, MapRead};
use crate::sweep::solved::{self, HowRows};
use crate::{report, terminal, text};

/// Folder of the rows in that of the study.
const ROWS_FOLDER: &str = "sweep";

/// A study before its rows.
struct Study {
    rows: StudyRows,
    skipped: Vec<Skipped>,
    pressures: Vec<f64>,
    /// Number of elements of the largest treated map.
    max_elements: f64,
    source: rc_sweep::MapOrigin,
}

/// Runs `rc study`.
///
/// # Errors
/// [`CliError`].
pub(crate) fn run(args: StudyArgs) -> Result<(), CliError> {
    let started = Instant::now();
    check_loads(&args.scene.contact)?;
    let scene = resolve::layers(Some(&args.file), args.scene.clone())?;
    let run = scene.run.clone();
    resolve::check_size_and_material(&scene.surface, &scene.contact)?;
    let threads = threads::start(run.threads)?;
    let folder = run.out.as_deref().unwrap_or(Path::new("."));
    files::check_folder(folder)?;
    let resume = args.resume;
    let study = Study::new(args, scene)?;
    let plan = study.rows.plan(&study.pressures)?;
    let sweep = Arc::new(Sweep::start(plan, Shard::WHOLE, &folder.join(ROWS_FOLDER), resume)?);
    let how = HowRows { run: &run, threads, max_elements: study.max_elements };
    let solved = solved::rows(&study.rows, &sweep, how);
    let kept = sweep.kept();
    if kept.rows().is_empty() {
        return solved.map(drop);
    }
    let record = study.record(kept.rows());
    write(folder, &record, kept.rows())?;
    match (run.json, run.quiet) {
        (true, _) => terminal::print(&to_json(&record))?,
        (false, true) => {}
        (false, false) => {
            let seconds = digits(started.elapsed().as_secs_f64(), 3);
            let rows = format!("{} in {seconds} s, {}\n", count(kept.rows().len(), "row"), count(threads, "thread"));
            terminal::print(&(record.text() + &rows + &text::written(Some(folder))))?;
        }
    }
    solved?.verdict(kept.rows(), sweep.n_rows(), &run)
}

/// Refuses a load besides the list.
fn check_loads(contact: &ContactKeys) -> Result<(), CliError> {
    if contact.n_loads() > 0 || contact.area_error.is_some() {
        let message =
            "pressures: a study has this list alone; omit --pressure, --penetration, --force and --area-error";
        return Err(CliError::input(message));
    }
    Ok(())
}

impl Study {
    fn new(args: StudyArgs, scene: Scene) -> Result<Self, CliError> {
        let Loads(pressures) = args.pressures;
        let budget = Budget::new(scene.run.memory_limit);
        let Scene { surface, contact, .. } = scene;
        let contact = ContactKeys { pressure: None, penetration: None, force: None, ..contact };
        let is_patch = contact.boundary == Some(Boundary::Free);
        let keys = if is_patch { args.steps.for_patch() } else { args.steps }.keys();
        let read = treated::read(surface)?;
        let unchanged = treatments(&keys)?;
        let first = rc_heights::apply(read.map.clone(), &unchanged[..after_crops(&unchanged)]);
        let (cropped, _) = first.map_err(|cause| CliError::in_file(&read.path, cause))?;
        let sides = cropped.sides.unwrap_or_else(|| cropped.sides_of_width(1.0));
        let cell = PeriodicCell::rectangle(sides[0], sides[1]).map_err(CliError::input)?;
        let base = Base { keys: &keys, boundary: contact.boundary, cropped: &cropped };
        let check = Check { read: &read, contact: &contact, pressures: &pressures, cell };
        let (mut variants, mut skipped, mut max_elements) = (Vec::new(), Vec::new(), 0.0_f64);
        for variant in base.variants()? {
            match check.elements(&variant) {
                Ok(elements) => {
                    max_elements = max_elements.max(elements);
                    variants.push(variant);
                }
                Err(error) if variants.is_empty() => return Err(error),
                Err(error) => skipped.push(Skipped { treatment: variant.name, reason: error.to_string() }),
            }
        }
        if variants.len().saturating_mul(pressures.len()) > MAX_ROWS {
            return Err(CliError::input(format_args!("pressures: more than {MAX_ROWS} rows; shorten the list")));
        }
        let source = origin::of(&read.path, read.keys.channel.as_deref());
        let rows = StudyRows::new(read, variants, contact, budget);
        Ok(Self { rows, skipped, pressures, max_elements, source })
    }

    fn record(&self, rows: &SweepRows) -> StudyRecord {
        let first = self.rows.variants.first().and_then(|variant| variant.boundary).unwrap_or_default();
        let boundaries = self.rows.variants.iter().map(|variant| variant.boundary.unwrap_or_default());
        let has_boundary: Vec<bool> = boundaries.map(|boundary| boundary == first).collect();
        StudyRecord {
            source: self.source.clone(),
            treatments: self.rows.variants.iter().map(Into::into).collect(),
            skipped: self.skipped.clone(),
            loads: ranges::of_rows(rows, &self.pressures, &has_boundary),
            rows: lines(rows).into_values().collect(),
        }
    }
}

/// What a variant must go together with.
struct Check<'a> {
    read: &'a MapRead,
    contact: &'a ContactKeys,
    pressures: &'a [f64],
    cell: PeriodicCell,
}

impl Check<'_> {
    /// Number of elements of the treated map, if it is one and bears the contact.
    fn elements(&self, variant: &Variant) -> Result<f64, CliError> {
        let grids = rc_heights::grids_after(&self.read.map, &variant.treatments);
        let grids = grids.map_err(|cause| CliError::in_file(&self.read.path, cause))?;
        for pressure in self.pressures {
            StudyRows::contact_in(self.contact, variant, *pressure, self.cell)?.kernel()?;
        }
        Ok(grids.last().map_or(self.read.map.heights.grid().len(), |grid| grid.len()) as f64)
    }
}

/// Writes `study.csv`, `study.json` and the page.
fn write(folder: &Path, record: &StudyRecord, rows: &SweepRows) -> Result<(), CliError> {
    let csv = to_csv(&lines(rows)).map_err(|cause| CliError::write(&folder.join("study.csv"), cause))?;
    let mut staged = Staged::new(folder)?;
    staged.add("study.csv", |path| files::write_synced(path, &csv))?;
    staged.add_text("study.json", &to_json(record))?;
    staged.add_text(PAGE_FILE, &report::of_study(record))?;
    Ok(staged.commit()?)
}
