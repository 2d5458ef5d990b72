//! The plan of a sweep: surfaces, and the loads on each.

use std::io;
use std::path::Path;

use rc_core::Units;
use rc_solver::Control;
use serde::Serialize;
use serde_json::{Map, Value, json};

use crate::content::Cells;
use crate::deal::Deal;
use crate::error::SweepError;
use crate::row::Row;
use crate::shard::{Shard, SweepShape};

pub use crate::shard::MAX_ROWS;

/// Quantity that is prescribed in every row of a sweep.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ControlKind {
    /// The mean pressure (Pa).
    Pressure,
    /// The penetration (m).
    Penetration,
}

impl ControlKind {
    /// Key of the quantity in scenes and summaries.
    #[must_use]
    pub fn key(self) -> &'static str {
        match self {
            Self::Pressure => "pressure",
            Self::Penetration => "penetration",
        }
    }

    /// The load `value` (Pa or m) in units of λ and E*.
    #[must_use]
    pub fn of(self, value: f64, units: Units) -> Control {
        match self {
            Self::Pressure => Control::pascals(value, units),
            Self::Penetration => Control::metres(value, units),
        }
    }
}

impl From<Control> for ControlKind {
    fn from(control: Control) -> Self {
        match control {
            Control::MeanPressure(_) => Self::Pressure,
            Control::Penetration(_) => Self::Penetration,
        }
    }
}

/// A surface with its loads, and the settings that determine its rows.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct PlannedSurface {
    /// Name of the scene of the surface. It is empty if there is only one scene.
    pub scene: String,
    /// Values of the settings that the sweep varies, by their names.
    ///
    /// Each row has them as columns.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub varied: Vec<(String, Value)>,
    /// Seed of a random surface.
    #[serde(skip)]
    pub seed: Option<u64>,
    /// The settings of the surface, as an object.
    pub surface: Value,
    /// The settings of the contact without the load, as an object.
    pub contact: Value,
    /// Pressures (Pa) or penetrations (m).
    ///
    /// Every surface of a sweep has the same number of loads.
    pub loads: Vec<f64>,
    /// The height map, if the surface is one. Its content determines the rows, but its path does not.
    pub map: Option<FileMark>,
    /// The height map of the other body, if it is added.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub added: Option<FileMark>,
}

/// Length and checksum, which identify a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct FileMark {
    /// Length of the file.
    pub bytes: u64,
    /// Checksum of the file.
    pub crc32: u32,
}

impl FileMark {
    /// Reads the file at `path`.
    ///
    /// # Errors
    /// [`SweepError::Read`] when it cannot be read.
    pub fn of(path: &Path) -> Result<Self, SweepError> {
        let fail = |cause: io::Error| SweepError::Read { path: path.to_owned(), cause: cause.to_string() };
        let mut file = std::fs::File::open(path).map_err(fail)?;
        let mut checksum = Checksum(crc32fast::Hasher::new());
        let bytes = io::copy(&mut file, &mut checksum).map_err(fail)?;
        Ok(Self { bytes, crc32: checksum.0.finalize() })
    }
}

impl FileMark {
    /// The mark of numbers in memory that are not in a file.
    #[must_use]
    pub fn of_values(values: &[f64]) -> Self {
        let mut checksum = crc32fast::Hasher::new();
        for value in values {
            checksum.update(&value.to_le_bytes());
        }
        Self { bytes: 8 * values.len() as u64, crc32: checksum.finalize() }
    }
}

/// A checksum as a writer.
struct Checksum(crc32fast::Hasher);

impl io::Write for Checksum {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.update(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// A sweep. Rows are ordered by surface, then by load, each in the given order.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepPlan {
    /// Quantity that the loads prescribe.
    pub control: ControlKind,
    /// The surfaces.
    pub surfaces: Vec<PlannedSurface>,
    /// Whether rows contain the name of their scene.
    pub names_scenes: bool,
    /// Whether the fields of each row are stored, in a folder for each row.
    pub keeps_fields: bool,
    /// Distribution of rows to shards.
    pub deal: Deal,
}

/// One row of a sweep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SweepRow {
    /// Index of the row, from 0.
    pub index: usize,
    /// Index of the surface in the plan, from 0.
    pub surface: usize,
    /// Pressure (Pa) or penetration (m).
    pub load: f64,
}

impl Row for SweepRow {
    fn load(&self) -> f64 {
        self.load
    }

    fn shared_surface(&self) -> Option<usize> {
        Some(self.surface)
    }
}

impl SweepPlan {
    /// A sweep of these surfaces under their loads.
    ///
    /// Rows do not contain the name of their scene, and their fields are not stored. Shards are dealt load by load.
    #[must_use]
    pub fn new(control: ControlKind, surfaces: Vec<PlannedSurface>) -> Self {
        Self { control, surfaces, names_scenes: false, keeps_fields: false, deal: Deal::default() }
    }

    /// Distributes the rows to shards by their expected processor time in seconds.
    ///
    /// The longest row comes first, and each row goes to the shard with the lowest total. `seconds` is called for the
    /// loads of the first surface of each scene with the same varied settings, and applies to all these surfaces. Where
    /// it returns `None`, the mean is used.
    #[must_use]
    pub fn dealt_by(mut self, mut seconds: impl FnMut(&SweepRow) -> Option<f64>) -> Self {
        let (mut scenes, mut first) = (Vec::new(), 0);
        for surfaces in self.surfaces.chunk_by(|a, b| a.scene == b.scene && a.varied == b.varied) {
            let loads = surfaces.first().map_or(&[][..], |surface| &surface.loads);
            let row = |(i, &load)| SweepRow { index: first * loads.len() + i, surface: first, load };
            scenes.push((surfaces.len(), loads.iter().enumerate().map(|row_at| seconds(&row(row_at))).collect()));
            first += surfaces.len();
        }
        self.deal = Deal::by_cost(scenes);
        self
    }

    /// Refuses a shard without rows.
    ///
    /// # Errors
    /// [`SweepError::EmptyShard`] for such a shard.
    pub fn check_shard(&self, shard: Shard) -> Result<(), SweepError> {
        let rows = self.shape().rows();
        if (1..=rows).contains(&shard.count) { Ok(()) } else { Err(SweepError::EmptyShard { shard, rows }) }
    }

    /// Number of surfaces and loads.
    #[must_use]
    pub fn shape(&self) -> SweepShape {
        SweepShape {
            surfaces: self.surfaces.len(),
            loads: self.surfaces.first().map_or(0, |surface| surface.loads.len()),
        }
    }

    /// Row `index`.
    ///
    /// # Panics
    /// When there is no such row.
    #[must_use]
    pub fn row(&self, index: usize) -> SweepRow {
        let loads = self.shape().loads;
        let surface = index / loads;
        SweepRow { index, surface, load: self.surfaces[surface].loads[index % loads] }
    }

    /// Name of a row in a message: `row 3 (hardness 5e6, seed 1, pressure 1e5)`.
    ///
    /// It counts from 1, as in the table.
    ///
    /// # Panics
    /// When there is no such row.
    #[must_use]
    pub fn describe(&self, row: &SweepRow) -> String {
        let PlannedSurface { varied, seed, .. } = &self.surfaces[row.surface];
        let mut words: Vec<String> = varied.iter().map(|(key, value)| format!("{key} {value}")).collect();
        words.extend(seed.map(|seed| format!("seed {seed}")));
        words.push(format!("{} {:e}", self.control.key(), row.load));
        format!("row {} ({})", row.index + 1, words.join(", "))
    }

    /// The first columns of a row: scene if there are several, seed, load, varied settings.
    pub(crate) fn leading_cells(&self, row: &SweepRow) -> Cells {
        let surface = &self.surfaces[row.surface];
        let mut cells = Map::new();
        if self.names_scenes {
            cells.insert("scene".into(), json!(surface.scene));
        }
        cells.insert("seed".into(), json!(surface.seed));
        cells.insert("control_value".into(), json!(row.load));
        cells.extend(surface.varied.iter().cloned());
        cells
    }

    /// The settings that determine the rows, which identify a sweep.
    ///
    /// They are plain text, so that a difference can be named.
    pub(crate) fn settings(&self) -> Value {
        json!({
            "version": env!("CARGO_PKG_VERSION"),
            "control": self.control.key(),
            "fields": self.keeps_fields,
            "surfaces": self.surfaces,
        })
    }
}
