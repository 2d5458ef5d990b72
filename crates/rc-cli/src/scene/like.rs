//! Height maps and profiles whose twins are generated.

use std::path::{Path, PathBuf};

use rc_core::{Field, Grid};
use rc_fractal::{Twin, TwinParams};
use rc_heights::{BorderStep, HeightMap, ReadParams, hann};

use super::heights::{self, CellOfMap};
use super::keys::SurfaceKeys;
use super::{file, values::HeightsLike};
use crate::error::CliError;
use crate::files::names::{HEIGHTS_FILE, SCENE_FILE};

/// A map in metres, with its sides.
#[derive(Clone, Debug)]
pub(crate) struct Reference {
    pub(crate) path: PathBuf,
    pub(crate) map: HeightMap,
    /// Sides of the map (m).
    pub(crate) sides: [f64; 2],
    /// Whether the keys alone give its size, which is then that of the twin.
    pub(crate) is_sized_by_keys: bool,
    /// What was assumed about the map.
    pub(crate) assumed: Vec<String>,
}

/// The file of the map that `like` names, which may be a folder.
pub(crate) fn file_of(like: &Path) -> PathBuf {
    if like.is_dir() { like.join(HEIGHTS_FILE) } else { like.to_owned() }
}

/// Reads the map that `like` names, which may be a profile: a map of one row.
///
/// # Errors
/// [`CliError::Input`] when it cannot be read.
pub(crate) fn read_map(like: &Path, keys: &SurfaceKeys) -> Result<HeightMap, CliError> {
    let params = ReadParams { row_is_map: true, ..keys.read_params() };
    heights::read(&file_of(like), &params, keys.scales())
}

impl Reference {
    /// Reads the map that `like` names.
    ///
    /// # Errors
    /// [`CliError::Input`] when it cannot be read, has missing points, is flat, or has no size.
    pub(crate) fn read(like: &Path, keys: &SurfaceKeys) -> Result<Self, CliError> {
        Self::of(like, read_map(like, keys)?, keys)
    }

    /// The `map` that was read from `like`.
    ///
    /// # Errors
    /// As [`Reference::read`].
    pub(crate) fn of(like: &Path, mut map: HeightMap, keys: &SurfaceKeys) -> Result<Self, CliError> {
        let path = file_of(like);
        if map.sides.is_none() && like.is_dir() {
            let scene = file::read(&like.join(SCENE_FILE))?.surface;
            map.sides = scene.cell.map(|cell| [cell, scene.cell_y.unwrap_or(cell)]);
        }
        let is_sized_by_keys = map.sides.is_none() || map.sides_are_assumed() && keys.cell.is_some();
        let given = if is_sized_by_keys { [keys.cell, keys.cell_y] } else { [None, None] };
        let CellOfMap { cell, cell_y, assumed } = CellOfMap::of(&path, &map, given)?;
        let Some(side) = cell else {
            return Err(CliError::in_file(&path, "like: a map without a size needs cell (m) too"));
        };
        heights::check_heights(&path, &map.heights, &keys.read_params())?;
        if map.heights.max() <= map.heights.min() {
            return Err(CliError::in_file(&path, "like: all heights are equal; a flat map has no twin"));
        }
        let sides = [side, cell_y.unwrap_or(side)];
        Ok(Self { path, map, sides, is_sized_by_keys, assumed })
    }

    /// Sides of the twin (m) under `keys`: those given, or those of the map.
    pub(crate) fn sides_of_twin(&self, keys: &SurfaceKeys) -> [f64; 2] {
        match (keys.cell, keys.cell_y) {
            _ if self.is_sized_by_keys => self.sides,
            (None, None) => self.sides,
            (None, Some(y)) => [self.sides[0], y],
            (Some(x), y) => [x, y.unwrap_or(x * self.sides[1] / self.sides[0])],
        }
    }

    /// Elements of the twin with the spacings of the map, in a cell with these sides (m).
    pub(crate) fn points(&self, sides: [f64; 2]) -> [usize; 2] {
        let grid = self.map.heights.grid();
        let points = [grid.nx(), grid.ny()];
        std::array::from_fn(|i| ((points[i] as f64 * sides[i] / self.sides[i]).round() as usize).max(2))
    }

    /// The twin with this seed on `grid` of a cell with these sides (m).
    ///
    /// # Errors
    /// [`CliError::Input`] when the ratio of the cell's sides is too large.
    pub(crate) fn twin(
        self,
        (grid, sides): (Grid, [f64; 2]),
        seed: u64,
        like: HeightsLike,
    ) -> Result<HeightMap, CliError> {
        let points = self.map.heights.grid();
        let fail = |cause: &dyn std::fmt::Display| CliError::in_file(&self.path, cause);
        let own = Grid::in_cell(points.nx(), points.ny(), self.sides[1] / self.sides[0]).map_err(|c| fail(&c))?;
        let grid = Grid::in_cell(grid.nx(), grid.ny(), sides[1] / sides[0]).map_err(|c| fail(&c))?;
        let map = Field::new(own, self.map.heights.into_values()).map_err(|c| fail(&c))?;
        let waves = if BorderStep::of(&map).is_periodic() { map.clone() } else { hann(&map) };
        let ratios = [sides[0] / self.sides[0], sides[1] / self.sides[1]];
        let has_heights_of_map = like == HeightsLike::Map;
        let twin = Twin::of(&map, &waves, &TwinParams { grid, sides: ratios, has_heights_of_map, seed });
        Ok(HeightMap { sides: Some(sides), ..HeightMap::bare(twin.heights) })
    }
}

/// What a twin is, for the notes of a surface.
pub(crate) fn note(path: &Path, seed: u64, like: HeightsLike) -> String {
    let heights = match like {
        HeightsLike::Map => "heights and spectrum",
        HeightsLike::Gaussian => "spectrum",
    };
    format!("a random surface with the {heights} of {}, seed {seed}", path.display())
}
