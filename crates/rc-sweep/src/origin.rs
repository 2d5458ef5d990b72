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

impl MapOrigin {
    /// The treatment that made the map periodic, if one did.
    #[must_use]
    pub fn periodic_step(&self) -> Option<&str> {
        let makes_periodic = |step: &&String| {
            ["periodic mirror", "periodic window", "repeat"].iter().any(|start| step.starts_with(start))
        };
        self.treatments.iter().find(makes_periodic).map(String::as_str)
    }
}
