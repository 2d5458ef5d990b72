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
