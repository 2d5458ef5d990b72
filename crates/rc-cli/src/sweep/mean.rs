//! `rc sweep --error-of-mean`: a mean over realisations.
//!
//! It solves as many realisations as the wanted error needs.

use std::sync::Arc;
use std::time::Instant;

use rc_core::Grid;
use rc_core::quantity::{count, digits};
use rc_sweep::files::{self, write_synced};
use rc_sweep::memory::Budget;
use rc_sweep::{ControlKind, Ensemble, EnsembleLevel, EnsembleMean, EnsemblePlan, WantedMean, Workers, to_json};

use super::args::SweepArgs;
use super::bar::RowBar;
use super::doubts::{Doubts, refuse_early};
use super::interrupt;
use super::messages;
use super::problems::SceneProblems;
use super::realisations::{MeanResults, Realisations};
use super::results::Results;
use super::surfaces::{Surfaces, SweptSurface};
use crate::error::CliError;
use crate::files::kind::Kind;
use crate::scene::surface::Source;
use crate::{terminal, text};

/// File of the means in the folder of an ensemble.
pub(crate) const MEAN_FILE: &str = "mean.json";

/// Minimum number of elements per shortest wave, and minimum number per side.
const COARSEST: [usize; 2] = [4, 64];

/// Runs `rc sweep --error-of-mean`.
///
/// # Errors
/// [`CliError`] of every kind.
pub(super) fn run(args: &SweepArgs, wanted: &WantedMean) -> Result<(), CliError> {
    check_alternatives(args)?;
    let surfaces = Surfaces::new(args)?;
    let run = &surfaces.run;
    let missing = || CliError::input("out: the realisations of a mean are kept in a folder; give --out DIR");
    let folder = run.out.clone().ok_or_else(missing)?;
    let (surface, control) = (surfaces.only()?, surfaces.control());
    let plan = plan(surface, control)?;
    if !args.resume {
        Kind::Sweep.check_out(&folder)?;
    }
    refuse_early(&surfaces)?;
    let threads = surfaces.threads;
    let started = Instant::now();
    let ensemble = Arc::new(Ensemble::start(plan, &folder, args.resume)?);
    let n_before = ensemble.kept().rows().len();
    let bar = RowBar::new(n_before, n_before, run.quiet);
    let handled = (Arc::clone(&ensemble), bar.clone());
    interrupt::install(move || interrupt::end(&handled.0.kept(), None, &handled.1, None));
    let doubts = Doubts::default();
    let budget = Budget::new(run.memory_limit);
    let realisations = Realisations { surface, control };
    let problems = SceneProblems::new(&realisations, budget);
    let results = MeanResults { control, results: Results::new(threads, &doubts, run.time_limit, bar.clone()) };
    let factor = surface.memory_factor();
    let workers = |elements: f64| Workers { threads, at_once: budget.solves_at_once(factor * elements) };
    let finished = ensemble.solve(wanted, &problems, &results, workers);
    bar.clear();
    let doubted = doubts.tell(run);
    let Some(means) = finished.map_err(messages::of_run)? else {
        return Err(messages::mean_out_of_time(run.time_limit, ensemble.kept().rows().len()));
    };
    let path = folder.join(MEAN_FILE);
    files::write_file(&path, |path| write_synced(path, to_json(&means).as_bytes()))?;
    match (run.json, run.quiet) {
        (true, _) => terminal::print(&to_json(&means))?,
        (false, true) => {}
        (false, false) => {
            let seconds = digits(started.elapsed().as_secs_f64(), 3);
            let before =
                if n_before > 0 { format!(" ({} kept from before)", count(n_before, "solve")) } else { String::new() };
            let means: String = means.iter().map(lines).collect();
            terminal::print(&format!(
                "{means}{seconds} s, {}{before}\n\nwritten to {}\n",
                count(threads, "thread"),
                path.display()
            ))?;
        }
    }
    messages::check_means(&means).and(doubted)
}

/// Refuses flags that select the rows in another way.
fn check_alternatives(args: &SweepArgs) -> Result<(), CliError> {
    let given = [
        ("seeds", args.seeds.is_some(), "it chooses the seeds; --seed gives the first one"),
        ("vary", !args.vary.is_empty(), "a mean has one problem"),
        ("times", args.times.is_some(), "a mean has one problem"),
        ("speeds", args.speeds.is_some(), "a mean has one problem"),
        ("shard", args.shard.is_some(), "what is solved next depends on earlier results"),
        ("list", args.list.is_some(), "what is solved next depends on earlier results"),
        ("fields", args.fields, "its rows have none"),
        ("scenes", args.scene_files.len() > 1, "a mean has one scene"),
    ];
    match given.iter().find(|(_, given, _)| *given) {
        None => Ok(()),
        Some((name, _, why)) => {
            Err(CliError::input(format_args!("{name}: cannot be combined with --error-of-mean: {why}")))
        }
    }
}

/// The plan of the realisations.
///
/// Waves are solved on the grid of the scene, and on those from halving it as long as they resolve the waves. A twin has
/// the grid of its map, and its short waves. On half of the grid it would be another surface.
fn plan(surface: &SweptSurface, control: ControlKind) -> Result<EnsemblePlan, CliError> {
    let no_other =
        |what: &str| CliError::input(format_args!("error_of_mean: a {what} has no other realisations; omit it"));
    let (sides, first_seed) = match &surface.setup.source {
        Source::Random { spectrum, grid } => (several(*grid, spectrum.waves)?, spectrum.seed),
        Source::Spectrum { table, grid, seed, .. } => (sides(*grid, table.waves()), *seed),
        Source::Twin { grid, seed, .. } => (vec![grid.nx().max(grid.ny())], *seed),
        Source::File { .. } => return Err(no_other("height map")),
        Source::Waves { .. } => return Err(no_other("file of waves")),
        Source::Shape { .. } => return Err(no_other("shape")),
    };
    let mut planned = surface.planned()?;
    // Seed and grid of the scene do not apply to all rows.
    if let Some(keys) = planned.surface.as_object_mut() {
        keys.remove("seed");
        if sides.len() > 1 {
            keys.remove("grid");
        }
    }
    let plan = EnsemblePlan { control, surface: planned, sides, first_seed };
    match plan.greatest_seed().and_then(|seed| i64::try_from(seed).ok()) {
        Some(_) => Ok(plan),
        None => Err(CliError::input(format_args!("seed: {first_seed} leaves no room for those that follow it"))),
    }
}

/// The sides of `grid` and of the grids from halving it that resolve `waves`, coarsest first.
///
/// They are the longer side alone if the grid is no square, or if its half is too coarse.
fn sides(grid: Grid, waves: usize) -> Vec<usize> {
    if grid.nx() != grid.ny() {
        return vec![grid.nx().max(grid.ny())];
    }
    let halvings = (1..16).map_while(|i| grid.nx().is_multiple_of(1 << i).then(|| grid.nx() >> i));
    let mut sides: Vec<usize> = halvings.take_while(|&side| side >= coarsest(waves)).collect();
    sides.insert(0, grid.nx());
    sides.reverse();
    sides
}

/// The sides of several grids.
///
/// # Errors
/// [`CliError::Input`] when there is only one.
fn several(grid: Grid, waves: usize) -> Result<Vec<usize>, CliError> {
    if grid.nx() != grid.ny() {
        return Err(CliError::input(format_args!("grid: a mean needs square grids, not {grid}")));
    }
    let sides = sides(grid, waves);
    if sides.len() < 2 {
        return Err(CliError::input(format_args!(
            "grid: the mean needs an even number of at least {} elements per side, not {grid}",
            2 * coarsest(waves)
        )));
    }
    Ok(sides)
}

/// Elements per side of the coarsest grid for these waves.
fn coarsest(waves: usize) -> usize {
    COARSEST[1].max(COARSEST[0] * waves)
}

/// A mean as aligned lines of text.
fn lines(mean: &EnsembleMean) -> String {
    let percent = digits(100.0 * mean.relative_error, 2);
    let value = text::with_error(mean.mean, mean.standard_error.hypot(mean.grid_error.unwrap_or(0.0)));
    let state = if mean.status == "converged" { "" } else { "NOT CONVERGED: " };
    let unit = if mean.control == "pressure" { "Pa" } else { "m" };
    let grid = mean.grid_error.map_or_else(|| "one grid".to_owned(), |error| format!("grid {}", digits(error, 2)));
    let head = format!(
        "{state}mean {} at {} {} {unit}: {value} ({percent} %; statistics {}, {grid})\n",
        mean.mean_of,
        mean.control,
        digits(mean.control_value, 6),
        digits(mean.standard_error, 2)
    );
    let names = ["grid", "realisations", "mean", "std deviation", "cost of each"].map(str::to_owned);
    let levels: String = [names].into_iter().chain(mean.levels.iter().map(cells)).map(columns).collect();
    if mean.grid_error.is_none() {
        return head + &levels;
    }
    let part = digits(mean.cost / mean.cost_of_plain_mean, 2);
    format!(
        "{head}{levels}  cost (elements times applications of the operator): {part} times the estimated cost on the finest grid alone\n"
    )
}

/// The cells of a line about a level.
fn cells(level: &EnsembleLevel) -> [String; 5] {
    let found = &level.found;
    let grid =
        level.coarser_grid.map_or_else(|| level.grid.to_string(), |coarser| format!("{} minus {coarser}", level.grid));
    let [mean, deviation, cost] = [found.mean, found.variance.sqrt(), found.cost].map(|value| digits(value, 4));
    [grid, found.realisations.to_string(), mean, deviation, cost]
}

fn columns([grid, realisations, mean, deviation, cost]: [String; 5]) -> String {
    format!("  {grid:<16}{realisations:>13}{mean:>16}{deviation:>16}{cost:>14}\n")
}
