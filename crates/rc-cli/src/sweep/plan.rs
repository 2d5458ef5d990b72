//! What a sweep solves: surfaces (scenes times seeds) and loads, checked before anything is written.

use std::path::{Path, PathBuf};

use super::lists::{Loads, Seeds};
use super::shard::Shape;
use crate::args::SweepArgs;
use crate::error::CliError;
use crate::resolve::{self, ContactProblem};
use crate::scene::{ContactKeys, RunKeys, Scene};
use crate::surface::{Source, SurfaceProblem};

/// Most rows of a sweep; beyond it a number was mistyped.
pub(super) const MOST_ROWS: usize = 1_000_000;

/// What is prescribed in every row of a sweep.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ControlKind {
    Pressure,
    Penetration,
}

impl ControlKind {
    /// Its key in scenes and summaries.
    pub(super) fn key(self) -> &'static str {
        match self {
            Self::Pressure => "pressure",
            Self::Penetration => "penetration",
        }
    }

    /// `keys` under the load `value`, and no other.
    pub(super) fn with_load(self, keys: &ContactKeys, value: Option<f64>) -> ContactKeys {
        let (pressure, penetration) = match self {
            Self::Pressure => (value, None),
            Self::Penetration => (None, value),
        };
        ContactKeys { pressure, penetration, ..keys.clone() }
    }
}

/// One surface with its loads.
#[derive(Clone, Debug)]
pub(super) struct PlannedSurface {
    /// Name of the scene: of its file, without folder and extension.
    pub(super) scene: String,
    /// `None` for a height map.
    pub(super) seed: Option<u64>,
    pub(super) problem: SurfaceProblem,
    /// The keys as resolved, without a load.
    pub(super) contact: ContactKeys,
    pub(super) loads: Vec<f64>,
}

impl PlannedSurface {
    /// Checks the keys of `scene`, under the first load: everything but the load is the same for all of them.
    fn new(name: &str, scene: Scene, control: ControlKind, loads: &[f64]) -> Result<Self, CliError> {
        let problem = resolve::surface(scene.surface)?;
        let seed = problem.keys.seed.filter(|_| matches!(problem.source, Source::Random { .. }));
        let keys = control.with_load(&scene.contact, loads.first().copied());
        let contact = resolve::contact(keys, problem.cell.side(), problem.elements_per_wave())?;
        let contact = control.with_load(&contact.keys, None);
        Ok(Self { scene: name.to_owned(), seed, problem, contact, loads: loads.to_vec() })
    }
}

/// A checked sweep. Rows are ordered by scene, then seed, then load, each as given.
#[derive(Clone, Debug)]
pub(super) struct Plan {
    pub(super) control: ControlKind,
    pub(super) surfaces: Vec<PlannedSurface>,
    /// Whether rows say which scene they are of.
    pub(super) names_scenes: bool,
    /// Whether each row keeps its fields.
    pub(super) fields: bool,
    pub(super) run: RunKeys,
}

/// One row.
pub(super) struct Row<'a> {
    /// From 0.
    pub(super) index: usize,
    pub(super) surface: &'a PlannedSurface,
    /// Pressure in Pa or penetration in m.
    pub(super) load: f64,
    pub(super) contact: ContactProblem,
}

impl Plan {
    /// Reads and checks scenes and lists.
    ///
    /// # Errors
    /// [`CliError::Input`].
    pub(super) fn new(args: &SweepArgs) -> Result<Self, CliError> {
        check_alternatives(args)?;
        let scenes = scenes(args)?;
        let control = control(args, &scenes)?;
        let mut surfaces = Vec::new();
        for (name, scene) in &scenes {
            let loads = loads(args, control, &scene.contact)?;
            let n_seeds = args.seeds.as_ref().map_or(1, |Seeds(seeds)| seeds.len());
            if scenes.len().saturating_mul(n_seeds).saturating_mul(loads.len()) > MOST_ROWS {
                let message = format_args!(
                    "{} scenes x {n_seeds} seeds x {} loads are more than {MOST_ROWS} rows; give shorter lists",
                    scenes.len(),
                    loads.len()
                );
                return Err(CliError::input(message));
            }
            for keys in seeded(args.seeds.as_ref(), name, scene)? {
                surfaces.push(PlannedSurface::new(name, keys, control, &loads)?);
            }
        }
        let run = scenes.first().map(|(_, scene)| scene.run.clone()).unwrap_or_default();
        Ok(Self { control, surfaces, names_scenes: scenes.len() > 1, fields: args.fields, run })
    }

    /// Number of surfaces and loads.
    pub(super) fn shape(&self) -> Shape {
        Shape { surfaces: self.surfaces.len(), loads: self.surfaces.first().map_or(0, |surface| surface.loads.len()) }
    }

    /// The folder for the fields of row `index`, if they are kept.
    pub(super) fn fields_folder(&self, index: usize) -> Option<PathBuf> {
        let folder = self.run.out.as_deref().filter(|_| self.fields)?;
        Some(super::fields_folder(folder, index))
    }

    /// Row `index`, ready to be solved.
    ///
    /// # Errors
    /// [`CliError::Input`] for keys of the contact, the same for all rows of a surface.
    ///
    /// # Panics
    /// When there is no such row.
    pub(super) fn row(&self, index: usize) -> Result<Row<'_>, CliError> {
        let loads = self.shape().loads;
        let surface = &self.surfaces[index / loads];
        let load = surface.loads[index % loads];
        let keys = self.control.with_load(&surface.contact, Some(load));
        let contact = resolve::contact(keys, surface.problem.cell.side(), surface.problem.elements_per_wave())?;
        // The memory of a machine must not decide on the digits of a row.
        let contact = ContactProblem { is_one_of_many: true, ..contact };
        Ok(Row { index, surface, load, contact })
    }
}

impl Row<'_> {
    /// The row in a message, counted from 1 as in the table.
    pub(super) fn describe(&self, control: ControlKind) -> String {
        let seed = self.surface.seed.map_or_else(String::new, |seed| format!("seed {seed}, "));
        format!("row {} ({seed}{} {:e})", self.index + 1, control.key(), self.load)
    }
}

/// Flags that exclude each other.
fn check_alternatives(args: &SweepArgs) -> Result<(), CliError> {
    let contact = &args.scene.contact;
    let given = [
        ("--pressures", args.pressures.is_some()),
        ("--penetrations", args.penetrations.is_some()),
        ("--pressure", contact.pressure.is_some()),
        ("--penetration", contact.penetration.is_some()),
    ];
    let given: Vec<&str> = given.iter().filter(|(_, given)| *given).map(|(flag, _)| *flag).collect();
    if let [first, second, ..] = given[..] {
        let message = format_args!("{first} and {second} are both given; a sweep has one control, so give exactly one");
        return Err(CliError::input(message));
    }
    if args.seeds.is_some() && args.scene.surface.seed.is_some() {
        return Err(CliError::input("--seeds and --seed are both given; give one of them"));
    }
    Ok(())
}

/// The scenes with their names, flags laid over each.
fn scenes(args: &SweepArgs) -> Result<Vec<(String, Scene)>, CliError> {
    let files: Vec<Option<&PathBuf>> =
        if args.scene_files.is_empty() { vec![None] } else { args.scene_files.iter().map(Some).collect() };
    let mut scenes: Vec<(String, Scene)> = Vec::new();
    for file in files {
        let name = file.and_then(|path| path.file_stem()).unwrap_or_default().to_string_lossy().into_owned();
        if scenes.iter().any(|(other, _)| *other == name) {
            let message = format_args!("scenes: two are called '{name}', which rows could not tell apart; rename one");
            return Err(CliError::input(message));
        }
        scenes.push((name, resolve::layers(file.map(Path::new), args.scene.clone())?));
    }
    Ok(scenes)
}

/// The one control of the sweep.
fn control(args: &SweepArgs, scenes: &[(String, Scene)]) -> Result<ControlKind, CliError> {
    if args.pressures.is_some() {
        return Ok(ControlKind::Pressure);
    }
    if args.penetrations.is_some() {
        return Ok(ControlKind::Penetration);
    }
    let of_scene = |scene: &Scene| match (scene.contact.pressure, scene.contact.penetration) {
        (Some(_), None) => Some(ControlKind::Pressure),
        (None, Some(_)) => Some(ControlKind::Penetration),
        _ => None,
    };
    let mut found = None;
    for (name, scene) in scenes {
        match (of_scene(scene), found) {
            (None, _) => {
                let message = "the loads are missing: give --pressures or --penetrations, as first:last:count";
                return Err(CliError::input(message));
            }
            (Some(kind), Some(other)) if kind != other => {
                return Err(CliError::input(format_args!(
                    "{name} has a {}, the scenes before a {}; a sweep has one control",
                    kind.key(),
                    other.key()
                )));
            }
            (kind, _) => found = kind,
        }
    }
    found.ok_or_else(|| CliError::input("no scene to solve"))
}

/// The loads of a scene: those of the command line, or its own.
fn loads(args: &SweepArgs, control: ControlKind, keys: &ContactKeys) -> Result<Vec<f64>, CliError> {
    let (list, own) = match control {
        ControlKind::Pressure => (&args.pressures, keys.pressure),
        ControlKind::Penetration => (&args.penetrations, keys.penetration),
    };
    match (list, own) {
        (Some(Loads(values)), _) => Ok(values.clone()),
        (None, Some(value)) => Ok(vec![value]),
        (None, None) => Err(CliError::input(format_args!("{}: must be given", control.key()))),
    }
}

/// The scene with each of the seeds; as it is when there are none.
fn seeded(seeds: Option<&Seeds>, name: &str, scene: &Scene) -> Result<Vec<Scene>, CliError> {
    let Some(Seeds(seeds)) = seeds else { return Ok(vec![scene.clone()]) };
    if scene.surface.heights.is_some() {
        let of = if name.is_empty() { String::new() } else { format!(" of {name}") };
        return Err(CliError::input(format_args!("seeds: the height map{of} has none; leave --seeds away")));
    }
    let with = |seed: &u64| {
        let mut scene = scene.clone();
        scene.surface.seed = Some(*seed);
        scene
    };
    Ok(seeds.iter().map(with).collect())
}
