//! What the folder of `--out` holds already.

use std::path::Path;

use rc_sweep::files::{self, Staged};
use rc_sweep::settings_in;

use super::flow;
use super::names::{
    COMPARISON_FILE, DIFFERENCE_FILE, FLUID_FILE, GROUP, HEIGHTS_FILE, PAGE_FILE, PLASTIC_GAP_FILE, PREPARE_FILE,
    PSD_FILE, RECORD_FILE, RESIDUAL_FILE, SCENE_FILE, SHEAR_FILE, SHEAR_FILES, SHEAR_MEANS, SHEAR_TABLE, STUDY_FILE,
    SUMMARY_FILE, WATCH_FILE, WAVES_FILE,
};
use crate::error::CliError;

/// The kinds of folders that commands fill.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Of `rc solve`.
    Result,
    /// Of `rc surface` and `rc prepare`.
    Surface,
    /// Of `rc sweep`.
    Sweep,
    /// Of `rc study`.
    Study,
    /// Of `rc shear`.
    Shear,
}

/// Files of the surface in a result or a prepared folder, with the pictures of `rc plot` and `rc inspect`.
const OF_SURFACE: [&str; 13] = [
    HEIGHTS_FILE,
    WAVES_FILE,
    PSD_FILE,
    RECORD_FILE,
    SCENE_FILE,
    PAGE_FILE,
    "surface.png",
    "spectrum.png",
    "spectrum.svg",
    "distribution.png",
    "distribution.svg",
    "material_ratio.png",
    "material_ratio.svg",
];

/// Files of `rc prepare`.
const OF_PREPARE: [&str; 3] = [PREPARE_FILE, "before.png", "despiked.png"];

/// Files of a solve, with those that `rc plot`, `rc export` and `rc compare` add.
const OF_RESULT: [&str; 24] = [
    SUMMARY_FILE,
    "pressure.npy",
    "gap.npy",
    FLUID_FILE,
    PLASTIC_GAP_FILE,
    RESIDUAL_FILE,
    SHEAR_FILES[0],
    SHEAR_FILES[1],
    SHEAR_FILES[2],
    "elements.csv",
    "contact.png",
    flow::PICTURE_FILE,
    flow::FLUX_FILES[0],
    flow::FLUX_FILES[1],
    WATCH_FILE,
    GROUP,
    "touched.png",
    "gap.png",
    "sections.png",
    "sections.svg",
    "fields.vti",
    "elements.vtu",
    COMPARISON_FILE,
    DIFFERENCE_FILE,
];

impl Kind {
    /// What `folder` holds; `None` for any other folder.
    fn of(folder: &Path) -> Option<Self> {
        let has = |name: &str| folder.join(name).is_file();
        let kinds = [
            (Self::Study, has(STUDY_FILE)),
            (Self::Shear, has(SHEAR_FILE)),
            (Self::Sweep, settings_in(folder).is_some()),
            (Self::Result, has(SUMMARY_FILE) && has(SCENE_FILE)),
            (Self::Surface, has(RECORD_FILE) && has(SCENE_FILE)),
        ];
        kinds.into_iter().find_map(|(kind, is)| is.then_some(kind))
    }

    /// The name for messages.
    fn name(self) -> &'static str {
        match self {
            Self::Result => "the result of rc solve",
            Self::Surface => "a surface of rc surface or rc prepare",
            Self::Sweep => "a sweep",
            Self::Study => "a study",
            Self::Shear => "shear curves",
        }
    }

    /// Checks that files can be created in `folder`, and that it does not hold a folder of another kind.
    ///
    /// # Errors
    /// [`CliError::Input`].
    pub fn check_out(self, folder: &Path) -> Result<(), CliError> {
        files::check_folder(folder)?;
        match Self::of(folder).filter(|kind| *kind != self) {
            None => Ok(()),
            Some(other) => Err(CliError::input(format_args!(
                "out: {} is {}, whose files would be replaced; give another folder",
                folder.display(),
                other.name()
            ))),
        }
    }

    /// A set of files for `folder`.
    ///
    /// If the folder is of this kind, the set replaces all its files, and those that were made from them.
    ///
    /// # Errors
    /// [`files::FileError::Write`].
    pub(crate) fn stage(self, folder: &Path) -> Result<Staged, files::FileError> {
        let is_same = Self::of(folder) == Some(self);
        let more: &[&str] = match self {
            Self::Result => &OF_RESULT,
            Self::Surface => &OF_PREPARE,
            Self::Shear => &[SHEAR_FILE, SHEAR_TABLE, SHEAR_MEANS],
            Self::Sweep | Self::Study => return Staged::new(folder),
        };
        let staged = Staged::new(folder)?;
        Ok(if is_same { staged.instead_of(OF_SURFACE.iter().chain(more).copied()) } else { staged })
    }
}
