//! Names of files in folders of results and of surfaces.

/// A height map.
pub(crate) const HEIGHTS_FILE: &str = "heights.npy";

/// The statistics of a surface.
pub(crate) const RECORD_FILE: &str = "surface.json";

/// The steps of `rc prepare`.
pub(crate) const PREPARE_FILE: &str = "prepare.json";

/// The scene.
pub(crate) const SCENE_FILE: &str = "scene.toml";

/// File with the summary of a solve.
pub(crate) const SUMMARY_FILE: &str = "summary.json";

/// The table of an isotropic spectrum.
pub(crate) const PSD_FILE: &str = "psd.csv";

/// A page.
pub(crate) const PAGE_FILE: &str = "report.html";

/// The record of a study.
pub(crate) const STUDY_FILE: &str = "study.json";

/// The record of shear curves.
pub(crate) const SHEAR_FILE: &str = "shear.json";

/// The table of shear curves.
pub(crate) const SHEAR_TABLE: &str = "shear.csv";

/// The table of their means over surfaces.
pub(crate) const SHEAR_MEANS: &str = "shear_mean.csv";

/// The picture of a running solve.
pub(crate) const WATCH_FILE: &str = "watch.png";

/// The Zarr group of the fields.
pub(crate) const GROUP: &str = "fields.zarr";

/// The record of a comparison.
pub(crate) const COMPARISON_FILE: &str = "compare.json";

/// The picture of a comparison.
pub(crate) const DIFFERENCE_FILE: &str = "difference.png";

/// The coefficients of waves.
pub(crate) const WAVES_FILE: &str = "spectrum.txt";

/// Tangential tractions along x and y of a sheared contact, and the length of its slip.
pub(crate) const SHEAR_FILES: [&str; 3] = ["shear_x.npy", "shear_y.npy", "slip.npy"];

/// The pressure of a fluid (Pa) that was given.
pub(crate) const FLUID_FILE: &str = "fluid_pressure.npy";

/// The unloaded surface after a history of loads.
pub(crate) const RESIDUAL_FILE: &str = "residual.npy";

/// The overlap that plastic flow has removed, with a hardness.
pub(crate) const PLASTIC_GAP_FILE: &str = "plastic_gap.npy";
