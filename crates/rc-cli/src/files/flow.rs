//! Names of the files of a flow.

/// Picture of the flux.
pub(crate) const PICTURE_FILE: &str = "leakage.png";

/// Files of the flux along x and along y (m²).
pub(crate) const FLUX_FILES: [&str; 2] = ["flow_x.npy", "flow_y.npy"];
