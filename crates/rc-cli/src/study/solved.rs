//! A study from its arguments to its record and its files.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::{Args as _, FromArgMatches as _};
use rc_core::quantity::{count, engineering};
use rc_core::{Boundary, Observer};
use rc_sweep::files::Staged;
use rc_sweep::memory::Budget;
use rc_sweep::{Loads, MAX_ROWS, MapOrigin, Shard, Sweep, SweepRows, WarningCode, files, to_csv, to_json};
use serde_json::json;

use super::args::StudyArgs;
use super::distinct::{Common, Distinct};
use super::ranges;
use super::record::{StudyRecord, TreatmentOf, lines};
use super::rows::{Pictures, SAME_AS, STEP, StudyRows, TREATMENT};
use super::variants::Base;
use crate::error::CliError;
use crate::files::kind::Kind;
use crate::files::names::{PAGE_FILE, STUDY_FILE};
use crate::prepare::args::{after_crops, check_filled, treatments};
use crate::report;
use crate::run::threads;
use crate::scene::keys::{ContactKeys, RunKeys, Scene};
use crate::scene::{origin, resolve, written};
use crate::surface::treated;
use crate::sweep::interrupt::WriteRows;
use crate::sweep::solved::{self, HowRows, SolvedRows};

/// Table of the rows of all treatments.
const TABLE_FILE: &str = "study.csv";

/// Folder of the rows in that of the study.
const ROWS_FOLDER: &str = "sweep";

/// A study for a program.
#[derive(Clone, Debug)]
pub struct StudyOutcome {
    /// The text of `study.json`.
    pub record: String,
    /// The warnings of the rows, one for each code.
    pub warnings: Vec<String>,
}

/// A study whose rows are solved, or as many as could be.
pub(super) struct SolvedStudy {
    pub(super) record: StudyRecord,
    /// The rows that were solved, or kept from before.
    pub(super) rows: SweepRows,
    /// Number of all rows.
    pub(super) n_rows: usize,
    pub(super) n_threads: usize,
    pub(super) run: RunKeys,
    pub(super) folder: PathBuf,
    /// How the solution ended.
    pub(super) ended: Result<SolvedRows, CliError>,
}

impl SolvedStudy {
    /// Tells the warnings of all rows, and fails where rows are missing or did not converge.
    ///
    /// In a strict study, warnings of the unchanged treatments fail too.
    pub(super) fn verdict(self) -> Result<(), CliError> {
        let Self { record, rows, n_rows, run, ended, .. } = self;
        ended?.verdict(&rows, n_rows, &RunKeys { strict: false, ..run.clone() })?;
        let unchanged = record.rows.iter().filter(|row| row[STEP] == "none");
        let mut codes = unchanged.filter_map(|row| row.get("warnings")?.as_array()).flatten();
        match codes.find_map(|code| WarningCode::ALL.into_iter().find(|known| *code == known.name())) {
            Some(code) if run.strict => {
                Err(CliError::input(format_args!("strict: {} ({code}); the rows are kept", code.meaning())))
            }
            _ => Ok(()),
        }
    }
}

/// A study before its rows.
struct Study {
    rows: StudyRows,
    distinct: Distinct,
    pressures: Vec<f64>,
    /// Number of elements of the largest treated map, with those that a flow stands for.
    max_elements: f64,
    source: MapOrigin,
    command: String,
}

/// Runs the study of these arguments of `rc study`, without the name of the command.
///
/// `stop` says when no further row is begun. The rows before are kept, and rows that did not converge are marked.
///
/// # Errors
/// [`CliError::Input`], [`CliError::Write`], and [`CliError::Interrupted`] when `stop` left rows.
pub fn of_words(words: &[OsString], stop: &dyn Observer) -> Result<StudyOutcome, CliError> {
    let command = StudyArgs::augment_args(clap::Command::new("study").no_binary_name(true));
    let matches = command.try_get_matches_from(words).map_err(|error| CliError::from(&error))?;
    let args = StudyArgs::from_arg_matches(&matches).map_err(|error| CliError::from(&error))?;
    let study = run(args, Some(stop))?;
    if study.rows.len() < study.n_rows && stop.should_stop() {
        let rows = count(study.n_rows, "row");
        let message = format!("interrupted with {} of {rows}; --resume continues", study.rows.len());
        return Err(CliError::Interrupted(message));
    }
    let record = to_json(&study.record);
    let warnings = study.ended.as_ref().map_or_else(|_| Vec::new(), SolvedRows::warnings);
    match study.verdict() {
        // The rows say so.
        Ok(()) | Err(CliError::NotConverged(_)) => {}
        Err(error) => return Err(error),
    }
    Ok(StudyOutcome { record, warnings: warnings.into_iter().map(|one| one.text).collect() })
}

/// Solves the rows of a study and writes its files.
///
/// # Errors
/// [`CliError`], when there are no rows at all.
pub(super) fn run(args: StudyArgs, stop: Option<&dyn Observer>) -> Result<SolvedStudy, CliError> {
    check_loads(&args.scene.contact)?;
    let scene = resolve::layers(Some(&args.file), args.scene.clone())?;
    if scene.surface.heights.is_none() {
        let message = "has no height map; give a measured map, or heights.npy in a folder of rc surface";
        return Err(CliError::in_file(&args.file, message));
    }
    if scene.surface.line {
        let message =
            "line: a study is for maps; omit --line, or solve each treated profile (rc surface --line, rc solve)";
        return Err(CliError::input(message));
    }
    written::check(&args.scene.contact, &scene, Some("a study keeps no fields of its rows; omit it"))?;
    let run = scene.run.clone();
    resolve::check_size_and_material(&scene.surface, &scene.contact)?;
    let n_threads = threads::start(run.threads)?;
    let folder = run.out.clone().unwrap_or_else(|| PathBuf::from("."));
    Kind::Study.check_out(&folder)?;
    let resume = args.resume;
    let study = Arc::new(Study::new(args, scene)?);
    let plan = study.rows.plan(&study.pressures)?;
    let sweep = Arc::new(Sweep::start(plan, Shard::WHOLE, &folder.join(ROWS_FOLDER), resume)?);
    let at_interrupt = study.written_into(&folder);
    let (max_elements, at_interrupt) = (study.max_elements, Some(&at_interrupt));
    let how = HowRows { run: &run, threads: n_threads, max_elements, stop, at_interrupt };
    let ended = solved::rows(&study.rows, &sweep, how);
    let kept = sweep.kept();
    let rows = kept.rows().clone();
    if rows.is_empty() {
        ended?.verdict(&rows, sweep.n_rows(), &run)?;
        return Err(CliError::Interrupted("interrupted before the first row".to_owned()));
    }
    let record = study.record(&rows);
    write(&folder, &record)?;
    Ok(SolvedStudy { record, rows, n_rows: sweep.n_rows(), n_threads, run, folder, ended })
}

/// Refuses loads besides the list.
fn check_loads(contact: &ContactKeys) -> Result<(), CliError> {
    if contact.pressure.or(contact.penetration).is_some() || contact.area_error.is_some() {
        let message =
            "pressures: a study has this list alone; omit --pressure, --penetration, --force and --area-error";
        return Err(CliError::input(message));
    }
    Ok(())
}

impl Study {
    fn new(args: StudyArgs, scene: Scene) -> Result<Self, CliError> {
        let command = command(&args);
        let budget = Budget::new(scene.run.memory_limit);
        let Scene { surface, contact, run } = scene;
        let folder = run.out.unwrap_or_default();
        let is_patch = contact.boundary == Some(Boundary::Free);
        let keys = if is_patch { args.steps.for_patch() } else { args.steps }.keys();
        let read = treated::read(surface)?;
        let source = origin::of(&read.path, read.keys.channel.as_deref());
        check_once(&read.path, &source)?;
        let unchanged = treatments(&keys)?;
        let first = rc_heights::apply(read.map.clone(), &unchanged[..after_crops(&unchanged)]);
        let (cropped, _) = first.map_err(|cause| CliError::in_file(&read.path, cause))?;
        check_filled(&read.path, &keys, &cropped)?;
        let sides = cropped.sides.unwrap_or_else(|| cropped.sides_of_width(1.0));
        // A force in the file of the scene is overridden by the list.
        if let Some(force) = args.scene.contact.force {
            return Err(refused_force(force, sides));
        }
        let Some(Loads(pressures)) = args.pressures else {
            return Err(CliError::input("pressures: must be given (Pa), for example 1e5,1e6"));
        };
        let contact = ContactKeys { pressure: None, penetration: None, force: None, ..contact };
        let base = Base { keys: &keys, boundary: contact.boundary, cropped: &cropped };
        let variants = base.variants()?;
        if variants.len().saturating_mul(pressures.len()) > MAX_ROWS {
            return Err(CliError::input(format_args!("pressures: more than {MAX_ROWS} rows; shorten the list")));
        }
        let common = Common { read: &read, contact: &contact, pressures: &pressures, budget, strict: run.strict };
        let distinct = Distinct::of(variants, &common)?;
        let pressure = pressures.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let max_elements = distinct.max_elements(&contact);
        let rows = StudyRows::new(read, distinct.solved.clone(), contact, budget, Pictures { folder, pressure });
        Ok(Self { rows, distinct, pressures, max_elements, source, command })
    }

    /// What writes the files of the rows that are finished into `folder`.
    fn written_into(self: &Arc<Self>, folder: &Path) -> Arc<WriteRows> {
        let (study, folder) = (Arc::clone(self), folder.to_owned());
        Arc::new(move |rows: &SweepRows| {
            write(&folder, &study.record(rows))?;
            Ok(folder.join(TABLE_FILE))
        })
    }

    fn record(&self, solved: &SweepRows) -> StudyRecord {
        let rows = self.all_rows(solved);
        let boundaries = self.distinct.all.iter().map(|variant| variant.boundary.unwrap_or_default());
        let boundaries: Vec<Boundary> = boundaries.collect();
        let has_boundary: Vec<bool> = boundaries.iter().map(|boundary| *boundary == boundaries[0]).collect();
        let treatment = |(number, variant)| TreatmentOf::new(variant, self.distinct.same_as(number));
        StudyRecord {
            command: self.command.clone(),
            source: self.source.clone(),
            treatments: self.distinct.all.iter().enumerate().map(treatment).collect(),
            skipped: self.distinct.skipped.clone(),
            loads: ranges::of_rows(&rows, &self.pressures, &has_boundary),
            rows: lines(&rows).into_values().collect(),
        }
    }

    /// The rows of all treatments. Those of the same map are the same but for their names.
    fn all_rows(&self, solved: &SweepRows) -> SweepRows {
        let n = self.pressures.len();
        let row = |index: usize| {
            let (number, load) = (index / n, index % n);
            let variant = &self.distinct.all[number];
            let mut cells = solved.get(&(self.distinct.place[number] * n + load))?.clone();
            cells.insert(STEP.to_owned(), json!(variant.step));
            cells.insert(TREATMENT.to_owned(), json!(variant.name));
            cells.insert(SAME_AS.to_owned(), json!(self.distinct.same_as(number)));
            Some((index, cells))
        };
        (0..n * self.distinct.all.len()).filter_map(row).collect()
    }
}

/// The command that repeats the study.
fn command(args: &StudyArgs) -> String {
    let file = report::quoted(&args.file.display().to_string());
    let Loads(pressures) = args.pressures.clone().unwrap_or(Loads(Vec::new()));
    let pressures: Vec<String> = pressures.iter().map(|pressure| json!(pressure).to_string()).collect();
    let (surface, contact) = (report::flags(&args.scene.surface), report::flags(&args.scene.contact));
    format!("rc study {file}{surface}{}{contact} --pressures {} --out again", args.steps.flags(), pressures.join(","))
}

/// Refuses a map that was made periodic before, which would be mirrored or faded twice.
fn check_once(path: &Path, source: &MapOrigin) -> Result<(), CliError> {
    let Some(step) = source.periodic_step() else { return Ok(()) };
    Err(CliError::in_file(
        path,
        format_args!(
            "is treated already ({step}), and a study treats the map itself; give the file that was measured, {}",
            source.file
        ),
    ))
}

/// The refusal of a force (N), with the pressure that it is on the measured rectangle (sides in m).
fn refused_force(force: f64, [x, y]: [f64; 2]) -> CliError {
    CliError::input(format_args!(
        "force: the maps of a study differ in size, so it compares equal mean pressures; {} on the map of {} x {} are \
         --pressures {:e}",
        engineering(force, "N"),
        engineering(x, "m"),
        engineering(y, "m"),
        force / (x * y)
    ))
}

/// Writes the table, `study.json` and the page.
fn write(folder: &Path, record: &StudyRecord) -> Result<(), CliError> {
    let rows: SweepRows = record.rows.iter().cloned().enumerate().collect();
    let csv = to_csv(&rows).map_err(|cause| CliError::write(&folder.join(TABLE_FILE), cause))?;
    let mut staged = Staged::new(folder)?;
    staged.add(TABLE_FILE, |path| files::write_synced(path, &csv))?;
    staged.add_text(STUDY_FILE, &to_json(record))?;
    staged.add_text(PAGE_FILE, &report::of_study(folder, record))?;
    Ok(staged.commit()?)
}
