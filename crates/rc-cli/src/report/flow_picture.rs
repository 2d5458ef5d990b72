//! The picture of a flow on the page of a result.

use std::path::Path;

use base64::Engine as _;
use rc_sweep::Summary;
use serde::Serialize;

use crate::files::flow::PICTURE_FILE;

/// The picture of the flow, as a PNG in base64.
#[derive(Clone, Debug, Serialize)]
pub(super) struct FlowPicture {
    png: String,
    note: &'static str,
}

impl FlowPicture {
    /// The picture of `rc solve --leakage`, if it exists.
    pub(super) fn of(folder: &Path, summary: &Summary) -> Option<Self> {
        summary.leakage.as_ref()?;
        let png = std::fs::read(folder.join(PICTURE_FILE)).ok()?;
        let png = base64::engine::general_purpose::STANDARD.encode(png);
        let note = "The flux of a film whose pressure falls across the cell. Its unit is the mean flux. Nothing flows in contact \
                    (grey), and in pockets that contact closes (brown). The ring is the critical constriction.";
        Some(Self { png, note })
    }
}
