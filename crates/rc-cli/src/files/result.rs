//! Reader of result folders.

use std::path::Path;

use rc_core::{DVec2, Field, Grid, PeriodicCell};

use crate::error::CliError;
use crate::files::names::{PLASTIC_GAP_FILE, SHEAR_FILES, SUMMARY_FILE};
use crate::scene::file;
use crate::scene::heights::check_finite;
use crate::scene::resolve;
use crate::scene::resolve::sliding::SlidingSolid;
use rc_heights::npy;
use rc_sweep::Summary;

/// A folder that `rc solve --out` has written.
#[derive(Clone, Debug)]
pub struct ResultFolder {
    /// The summary.
    pub summary: Summary,
    /// Side λ of the cell along x (m), from the solved scene. The grid of the fields gives the other side.
    pub side: f64,
    /// E* (Pa), from the solved scene.
    pub e_star: f64,
    /// Unit vector of the direction in which the surface slides.
    pub direction: Option<DVec2>,
    /// Pressure (Pa).
    pub pressure: Field,
    /// Gap (m).
    pub gap: Field,
    /// Overlap that plastic flow has removed (m), with a hardness.
    pub plastic_gap: Option<Field>,
    /// Length of the slip (m) of a sheared contact.
    pub slip: Option<Field>,
}

/// Why `path` is not the folder of `what`.
pub(crate) fn no_folder(path: &Path, what: &str) -> String {
    if path.exists() {
        "is a file; give the folder that it is in".to_owned()
    } else {
        format!("no such folder; give the --out folder of {what}")
    }
}

impl ResultFolder {
    /// Reads a result folder.
    ///
    /// # Errors
    /// [`CliError::Input`] with the name of the file that is missing or wrong.
    pub fn read(folder: &Path) -> Result<Self, CliError> {
        if !folder.is_dir() {
            return Err(CliError::in_file(folder, no_folder(folder, "a solve")));
        }
        let path = folder.join(SUMMARY_FILE);
        if !path.exists() {
            return Err(CliError::in_file(
                folder,
                "not a result, because it has no summary.json; give the --out folder of a solve, or a folder rows/... of a \
                 sweep with --fields",
            ));
        }
        let text = std::fs::read_to_string(&path)
            .map_err(|cause| CliError::in_file(&path, format_args!("cannot read this summary: {cause}")))?;
        let summary: Summary = serde_json::from_str(&text)
            .map_err(|cause| CliError::in_file(&path, format_args!("not a summary of rc solve: {cause}")))?;
        let scene_path = folder.join("scene.toml");
        let scene = file::read(&scene_path)?;
        let side = scene.surface.cell;
        let side = side.filter(|side| *side > 0.0 && side.is_finite());
        let side =
            side.ok_or_else(|| CliError::in_file(&scene_path, "cell: must be given, positive and finite (m)"))?;
        let cell = PeriodicCell::new(side).map_err(|cause| CliError::in_file(&scene_path, cause))?;
        let contact = resolve::contact(scene.contact, cell)?;
        let e_star = contact.units.elasticity().e_star();
        let direction = contact.sliding.as_ref().and_then(SlidingSolid::heading);
        let field = |name: &str| in_cell(&folder.join(name), scene.surface.cell_y.map_or(1.0, |side_y| side_y / side));
        let (pressure, gap) = (field("pressure.npy")?, field("gap.npy")?);
        let optional = |name: &str| folder.join(name).is_file().then(|| field(name)).transpose();
        let (plastic_gap, slip) = (optional(PLASTIC_GAP_FILE)?, optional(SHEAR_FILES[2])?);
        let fields =
            [("gap.npy", Some(&gap)), (PLASTIC_GAP_FILE, plastic_gap.as_ref()), (SHEAR_FILES[2], slip.as_ref())];
        for (name, gap) in fields {
            if let Some(gap) = gap.filter(|gap| gap.grid() != pressure.grid()) {
                let message = format_args!(
                    "{} elements, but pressure.npy has {}; the files are of different solves, so solve again",
                    gap.grid(),
                    pressure.grid()
                );
                return Err(CliError::in_file(&folder.join(name), message));
            }
        }
        Ok(Self { summary, side, e_star, direction, pressure, gap, plastic_gap, slip })
    }

    /// Sides of the cell along x and y (m).
    #[must_use]
    pub fn sides(&self) -> [f64; 2] {
        [self.side, self.side * self.pressure.grid().cell_ratio()]
    }

    /// Whether it is the line contact of a profile, which has one row.
    #[must_use]
    pub fn is_line(&self) -> bool {
        self.summary.grid[1] == 1
    }

    /// Whether the fields have one value for each element.
    ///
    /// Otherwise they are means over blocks of elements (`output_grid`).
    #[must_use]
    pub fn is_of_elements(&self) -> bool {
        let grid = self.pressure.grid();
        self.summary.grid == [grid.nx(), grid.ny()]
    }

    /// Reads a result folder whose fields must be finite, for drawings and exports.
    ///
    /// # Errors
    /// Those of [`ResultFolder::read`], and [`CliError::Input`] for a value that is not finite.
    pub fn read_finite(folder: &Path) -> Result<Self, CliError> {
        let result = Self::read(folder)?;
        check_finite(&folder.join("pressure.npy"), &result.pressure)?;
        check_finite(&folder.join("gap.npy"), &result.gap)?;
        if let Some(plastic_gap) = &result.plastic_gap {
            check_finite(&folder.join(PLASTIC_GAP_FILE), plastic_gap)?;
        }
        if let Some(slip) = &result.slip {
            check_finite(&folder.join(SHEAR_FILES[2]), slip)?;
        }
        Ok(result)
    }
}

/// Reads a field on a cell with the given ratio of sides.
///
/// `cell_ratio` is the ratio of the side along y to that along x.
///
/// # Errors
/// [`CliError::Input`].
pub fn in_cell(path: &Path, cell_ratio: f64) -> Result<Field, CliError> {
    let field = npy::read(path)?;
    let grid = Grid::in_cell(field.grid().nx(), field.grid().ny(), cell_ratio);
    let grid = grid.map_err(|cause| CliError::in_file(path, format_args!("cell_y of its scene.toml: {cause}")))?;
    Field::new(grid, field.into_values()).map_err(|cause| CliError::in_file(path, cause))
}
