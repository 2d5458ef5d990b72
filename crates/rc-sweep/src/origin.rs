//! Where the heights of a map come from.

use serde::{Deserialize, Serialize};

/// The measured file of a height map, and what was done to it.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct MapOrigin {
    /// The file, as the user named it.
    pub file: String,
    /// Its channel, if the user named one.
    pub channel: Option<String>,
    /// The treatments since, in their order.
    pub treatments: Vec<String>,
}
