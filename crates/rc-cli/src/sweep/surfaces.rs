//! The surfaces of a sweep: scenes times seeds.
//!
//! They are resolved and checked before anything is written.

use std::path::{Path, PathBuf};

use rc_solver::Feature;
use rc_sweep::{ControlKind, FileMark, Loads, MAX_ROWS, PlannedSurface, Seeds, SweepPlan, SweepRow};
use serde_json::json;

use super::args::SweepArgs;
use super::creep::{self, Creep, Crept};
use super::map_mark::MapMark;
use super::varied::{Variation, Varied};
use crate::error::CliError;
use crate::files::names::SCENE_FILE;
use crate::run::threads;
use crate::scene::keys::{ContactKeys, RunKeys, Scene};
use crate::scene::resolve::{self, ContactSetup};
use crate::scene::surface::{Source, SurfaceSetup};
use crate::scene::{features, like, written};
use crate::solve::memory_factor;

/// One surface with its loads.
#[derive(Clone, Debug)]
pub(super) struct SweptSurface {
    /// Name of the scene, which is its file's name without folder and extension.
    scene: String,
    /// Values of the keys that are varied.
    varied: Varied,
    /// Seed; `None` for a surface from a file.
    seed: Option<u64>,
    pub(super) setup: SurfaceSetup,
    /// Resolved keys without a load.
    contact: ContactKeys,
    loads: Vec<f64>,
    /// The solid that has crept, whose loads these are.
    creep: Option<Crept>,
    /// Mark that identifies a height map which a program holds.
    held: Option<FileMark>,
}

/// The surfaces from the scenes and lists of the command line.
///
/// They are ordered by scene and then by seed, in the given order.
#[derive(Clone, Debug)]
pub(super) struct Surfaces {
    control: ControlKind,
    all: Vec<SweptSurface>,
    n_scenes: usize,
    keeps_fields: bool,
    pub(super) run: RunKeys,
    /// Number of worker threads of the process.
    pub(super) threads: usize,
}

impl Surfaces {
    /// Starts the threads, and reads and checks scenes and lists.
    ///
    /// # Errors
    /// [`CliError::Input`].
    pub(super) fn new(args: &SweepArgs) -> Result<Self, CliError> {
        check_alternatives(args)?;
        let scenes = scenes(args)?;
        let without = "applies to the files of the rows; give --fields";
        for (_, scene) in &scenes {
            written::check(&args.scene.contact, scene, (!args.fields).then_some(without))?;
        }
        let run = scenes.first().map(|(_, scene)| scene.run.clone()).unwrap_or_default();
        // Files of waves are read with these threads.
        let threads = threads::start(run.threads)?;
        let n_scenes = scenes.len();
        let scenes = varied(args, scenes)?;
        let control = control(args, &scenes)?;
        let given = args.pressures.as_ref().map_or(&[][..], |Loads(pressures)| pressures);
        let times = Creep { times: args.times.as_ref(), control, loads: given, fields: args.fields };
        let scenes = creep::after_times(times, scenes)?;
        let mut surfaces = Vec::new();
        for (name, values, scene, creep) in &scenes {
            let mut loads = loads(args, control, &scene.contact)?;
            for load in &mut loads {
                *load *= creep.as_ref().map_or(1.0, |crept| crept.ratio);
            }
            check_rows(scenes.len(), args.seeds.as_ref(), loads.len().max(1))?;
            // One scene alone needs no name.
            let in_scene = |error| match error {
                CliError::Input(message) if n_scenes > 1 => CliError::Input(format!("scene {name}: {message}")),
                other => other,
            };
            for keys in seeded(args.seeds.as_ref(), name, scene)? {
                let surface = SweptSurface::new(name, keys, control, &loads).map_err(in_scene)?;
                surfaces.push(surface.with(values.clone(), creep.clone()));
            }
        }
        Ok(Self { control, all: surfaces, n_scenes, keeps_fields: args.fields, run, threads })
    }

    /// The plan of the sweep.
    ///
    /// Height maps are read once for marks that identify them later.
    ///
    /// # Errors
    /// [`CliError::Input`] when a map cannot be read.
    pub(super) fn plan(&self) -> Result<SweepPlan, CliError> {
        let surfaces = self.all.iter().map(SweptSurface::planned).collect::<Result<_, _>>()?;
        Ok(SweepPlan {
            names_scenes: self.n_scenes > 1,
            keeps_fields: self.keeps_fields,
            ..SweepPlan::new(self.control, surfaces)
        })
    }

    /// The surface of `row`.
    pub(super) fn surface(&self, row: &SweepRow) -> &SurfaceSetup {
        &self.all[row.surface].setup
    }

    /// The contact of `row`, ready to be solved.
    ///
    /// # Errors
    /// [`CliError::Input`] for keys of the contact. They are the same for all rows of a surface.
    pub(super) fn contact_of(&self, row: &SweepRow) -> Result<ContactSetup, CliError> {
        self.all[row.surface].contact(self.control, row.load)
    }

    /// All surfaces.
    pub(super) fn all(&self) -> &[SweptSurface] {
        &self.all
    }

    /// Whether flows are computed, whose end under a greater load is sought.
    pub(super) fn leak(&self) -> bool {
        self.all.iter().any(|surface| surface.leaks() && surface.creep.is_none())
    }

    /// Quantity of the loads.
    pub(super) fn control(&self) -> ControlKind {
        self.control
    }

    /// The surface, if there is only one.
    ///
    /// # Errors
    /// [`CliError::Input`].
    pub(super) fn only(&self) -> Result<&SweptSurface, CliError> {
        match &self.all[..] {
            [surface] => Ok(surface),
            _ => Err(CliError::input("scenes: give one")),
        }
    }

    /// Number of elements of the largest surface.
    ///
    /// With a flow, it is the number of elements that take the same memory without the flow.
    pub(super) fn max_elements(&self) -> f64 {
        let elements = |surface: &SweptSurface| surface.setup.max_elements() * surface.memory_factor();
        self.all.iter().map(elements).fold(0.0, f64::max)
    }
}

impl SweptSurface {
    /// Whether flows are computed.
    pub(super) fn leaks(&self) -> bool {
        self.contact.leakage
    }

    /// The seed of a random surface.
    pub(super) fn seed(&self) -> Option<u64> {
        self.seed
    }

    /// The scene with its varied values, as `a, hardness 5e6`; empty if there is one alone.
    pub(super) fn name(&self) -> String {
        let varied = self.varied.iter().map(|(key, value)| format!("{key} {value}"));
        std::iter::once(self.scene.clone()).filter(|name| !name.is_empty()).chain(varied).collect::<Vec<_>>().join(", ")
    }

    /// Ratio of the memory of a row to that of its contact alone.
    pub(super) fn memory_factor(&self) -> f64 {
        memory_factor(&self.contact)
    }

    /// The surface with these values of varied keys, under the loads of a solid that has crept.
    pub(super) fn with(self, varied: Varied, creep: Option<Crept>) -> Self {
        Self { varied, creep, ..self }
    }

    /// Checks the keys of `scene` under the first load. The loads share all other keys.
    pub(super) fn new(name: &str, scene: Scene, control: ControlKind, loads: &[f64]) -> Result<Self, CliError> {
        resolve::check_size_and_material(&scene.surface, &scene.contact)?;
        // A sweep may have many maps.
        let setup = resolve::surface(scene.surface)?.without_map();
        Self::on(setup, name, &scene.contact, (control, loads))
    }

    /// Checks the keys of a scene with a height map that a program holds.
    ///
    pub(super) fn of_map(
        name: &str,
        scene: Scene,
        loads: (ControlKind, &[f64]),
        MapMark { sides, points, mark }: MapMark,
    ) -> Result<Self, CliError> {
        let (keys, assumed) = scene.surface.of_map(sides, points)?;
        resolve::check_cell_and_material(&keys, &scene.contact)?;
        let setup = SurfaceSetup { assumed, ..resolve::surface_in_cell(keys)? };
        Ok(Self { held: Some(mark), ..Self::on(setup, name, &scene.contact, loads)? })
    }

    fn on(
        setup: SurfaceSetup,
        name: &str,
        contact: &ContactKeys,
        (control, loads): (ControlKind, &[f64]),
    ) -> Result<Self, CliError> {
        let seed =
            setup.keys.seed.filter(|_| setup.keys.is_realisation() || matches!(setup.source, Source::Random { .. }));
        let loads = match contact.force {
            Some(force) if loads.is_empty() => vec![resolve::mean_pressure(force, setup.cell)?],
            _ => loads.to_vec(),
        };
        let keys = with_load(control, contact, loads.first().copied());
        features::check(&keys, [Feature::Sweep])?;
        let contact = resolve::contact(keys, setup.cell)?;
        let setup = setup.bounded(contact.boundary)?;
        let contact = with_load(control, &contact.keys, None);
        let (scene, varied) = (name.to_owned(), Varied::new());
        Ok(Self { scene, varied, seed, setup, contact, loads, creep: None, held: None })
    }

    /// The contact under `load`, ready to be solved.
    ///
    /// # Errors
    /// [`CliError::Input`] for keys of the contact.
    pub(super) fn contact(&self, control: ControlKind, load: f64) -> Result<ContactSetup, CliError> {
        let keys = with_load(control, &self.contact, Some(load));
        let mut contact = resolve::contact(keys, self.setup.cell)?;
        // The memory of a machine must not change the digits of a row.
        contact.params.method_follows_memory = false;
        contact.creep = self.creep.as_ref().map(|crept| crept.ratio);
        Ok(contact)
    }

    /// The contacts under all loads.
    pub(super) fn contacts(&self, control: ControlKind) -> impl Iterator<Item = Result<ContactSetup, CliError>> {
        self.loads.iter().map(move |load| self.contact(control, *load))
    }

    /// The settings that determine the rows of this surface.
    ///
    /// The folder of a file does not, so only its name and its content count.
    pub(super) fn planned(&self) -> Result<PlannedSurface, CliError> {
        let mut surface = self.setup.keys.clone();
        let map = match &self.setup.source {
            Source::Random { .. } | Source::Shape { .. } => None,
            Source::File { path, .. } => {
                surface.heights = path.file_name().map(Into::into);
                Some(self.held.map_or_else(|| FileMark::of(path), Ok)?)
            }
            Source::Waves { path, .. } => {
                surface.spectrum = path.file_name().map(Into::into);
                Some(FileMark::of(path)?)
            }
            Source::Twin { like, .. } => {
                surface.like = like.file_name().map(Into::into);
                Some(FileMark::of(&like::file_of(like))?)
            }
            Source::Spectrum { path, .. } => {
                let key = if surface.like.is_some() { &mut surface.like } else { &mut surface.psd };
                *key = path.file_name().map(Into::into);
                Some(FileMark::of(path)?)
            }
        };
        let added = match &self.setup.keys.add {
            None => None,
            Some(path) => {
                surface.add = path.file_name().map(Into::into);
                Some(FileMark::of(&like::file_of(path))?)
            }
        };
        Ok(PlannedSurface {
            scene: self.scene.clone(),
            varied: self.varied.clone(),
            seed: self.seed,
            surface: json!(surface),
            contact: match &self.creep {
                Some(crept) => json!(crept.keys.clone().over(self.contact.clone())),
                None => json!(self.contact),
            },
            loads: self.loads.clone(),
            map,
            added,
        })
    }
}

/// `keys` with the load `value` as their only load.
fn with_load(control: ControlKind, keys: &ContactKeys, value: Option<f64>) -> ContactKeys {
    let (pressure, penetration) = match control {
        ControlKind::Pressure => (value, None),
        ControlKind::Penetration => (None, value),
    };
    ContactKeys { pressure, penetration, force: None, ..keys.clone() }
}

/// Refuses an unreasonable number of rows.
pub(super) fn check_rows(n_scenes: usize, seeds: Option<&Seeds>, n_loads: usize) -> Result<(), CliError> {
    let n_seeds = seeds.map_or(1, |Seeds(seeds)| seeds.len());
    if n_scenes.saturating_mul(n_seeds).saturating_mul(n_loads) <= MAX_ROWS {
        return Ok(());
    }
    Err(CliError::input(format_args!(
        "{n_scenes} scenes x {n_seeds} seeds x {n_loads} loads are more than {MAX_ROWS} rows; shorten the lists"
    )))
}

/// Refuses flags that exclude each other.
fn check_alternatives(args: &SweepArgs) -> Result<(), CliError> {
    let contact = &args.scene.contact;
    let given = [
        ("--pressures", args.pressures.is_some()),
        ("--penetrations", args.penetrations.is_some()),
        ("--pressure", contact.pressure.is_some()),
        ("--penetration", contact.penetration.is_some()),
        ("--force", contact.force.is_some()),
        ("--vary force", args.vary.iter().any(|variation| variation.key() == "force")),
    ];
    let given: Vec<&str> = given.iter().filter(|(_, given)| *given).map(|(flag, _)| *flag).collect();
    if let [first, second, ..] = given[..] {
        let message = format_args!("{first} and {second} are both given; a sweep has one control, so give exactly one");
        return Err(CliError::input(message));
    }
    if args.speeds.is_some() && contact.speed.is_some() {
        return Err(CliError::input("--speeds and --speed are both given; give one of them"));
    }
    if args.seeds.is_some() && args.scene.surface.seed.is_some() {
        return Err(CliError::input("--seeds and --seed are both given; give one of them"));
    }
    Ok(())
}

/// The scenes with their names, with flags laid over each.
fn scenes(args: &SweepArgs) -> Result<Vec<(String, Scene)>, CliError> {
    let files: Vec<Option<&PathBuf>> =
        if args.scene_files.is_empty() { vec![None] } else { args.scene_files.iter().map(Some).collect() };
    let mut scenes: Vec<(String, Scene)> = Vec::new();
    for file in files {
        let name = file.map(|path| name_of(path)).unwrap_or_default();
        if scenes.iter().any(|(other, _)| *other == name) {
            let message =
                format_args!("scenes: two are called '{name}', so that their rows could not be told apart; rename one");
            return Err(CliError::input(message));
        }
        scenes.push((name, resolve::layers(file.map(Path::new), args.scene.clone())?));
    }
    Ok(scenes)
}

/// The scenes with their names, in all variations.
fn varied(args: &SweepArgs, scenes: Vec<(String, Scene)>) -> Result<Vec<(String, Varied, Scene)>, CliError> {
    let variations: Vec<Variation> = args.vary.iter().chain(&args.speeds).cloned().collect();
    let mut all = Vec::new();
    for (name, scene) in scenes {
        let varied = super::varied::scenes(&variations, &scene)?;
        all.extend(varied.into_iter().map(|(values, scene)| (name.clone(), values, scene)));
    }
    Ok(all)
}

/// The name of a scene: its file's name, or that of the folder for a folder or its `scene.toml`.
fn name_of(path: &Path) -> String {
    let is_of_folder = path.file_name().is_some_and(|name| name == SCENE_FILE);
    let named = if is_of_folder { path.parent().filter(|folder| folder.file_name().is_some()) } else { None };
    let is_folder = named.is_some() || path.is_dir();
    let path = named.unwrap_or(path);
    // The name of a folder has no extension.
    let name = if is_folder { path.file_name() } else { path.file_stem() };
    name.unwrap_or_default().to_string_lossy().into_owned()
}

/// The quantity of the loads, which is the same for all scenes.
fn control(args: &SweepArgs, scenes: &[(String, Varied, Scene)]) -> Result<ControlKind, CliError> {
    if args.pressures.is_some() {
        return Ok(ControlKind::Pressure);
    }
    if args.penetrations.is_some() {
        return Ok(ControlKind::Penetration);
    }
    let of_scene = |Scene { contact, .. }: &Scene| match (contact.n_loads(), contact.penetration) {
        (1, None) => Some(ControlKind::Pressure),
        (1, Some(_)) => Some(ControlKind::Penetration),
        _ => None,
    };
    let mut found = None;
    for (name, _, scene) in scenes {
        match (of_scene(scene), found) {
            (None, _) => {
                let message = "the loads are missing: give --pressures or --penetrations, for example 1e4:1e6:8";
                return Err(CliError::input(message));
            }
            (Some(kind), Some(other)) if kind != other => {
                return Err(CliError::input(format_args!(
                    "{name} gives a {}, but the scenes before it give a {}; a sweep has one control",
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
///
/// There are none for a force, whose mean pressure depends on the cell.
fn loads(args: &SweepArgs, control: ControlKind, keys: &ContactKeys) -> Result<Vec<f64>, CliError> {
    let (list, own) = match control {
        ControlKind::Pressure => (&args.pressures, keys.pressure),
        ControlKind::Penetration => (&args.penetrations, keys.penetration),
    };
    match (list, own) {
        (Some(Loads(values)), _) => Ok(values.clone()),
        (None, Some(value)) => Ok(vec![value]),
        // A history is refused where its scene is checked.
        (None, None) if keys.force.is_some() || keys.history.is_some() => Ok(Vec::new()),
        (None, None) => Err(CliError::input(format_args!("{}: must be given", control.key()))),
    }
}

/// The scene with each of the seeds, or unchanged without seeds.
pub(super) fn seeded(seeds: Option<&Seeds>, name: &str, scene: &Scene) -> Result<Vec<Scene>, CliError> {
    let Some(Seeds(seeds)) = seeds else { return Ok(vec![scene.clone()]) };
    if let Some((key @ ("heights" | "spectrum"), _)) = scene.surface.file() {
        let what = if key == "heights" { "height map" } else { "file of waves" };
        let of = if name.is_empty() { String::new() } else { format!(" of {name}") };
        return Err(CliError::input(format_args!("seeds: the {what}{of} has no seed; omit --seeds")));
    }
    let with = |seed: &u64| {
        let mut scene = scene.clone();
        scene.surface.seed = Some(*seed);
        scene
    };
    Ok(seeds.iter().map(with).collect())
}
