//! The origin of a height map, for `source` in records and summaries.

use std::path::Path;

use rc_sweep::MapOrigin;
use serde::Deserialize;

use crate::files::beside;

/// The origin of the map at `path`, of which `channel` is read.
///
/// A map in a folder of rc has the origin in the record beside it.
pub(crate) fn of(path: &Path, channel: Option<&str>) -> MapOrigin {
    #[derive(Deserialize)]
    struct Record {
        source: MapOrigin,
    }
    let of_file =
        || MapOrigin { file: path.display().to_string(), channel: channel.map(str::to_owned), treatments: Vec::new() };
    beside::records(path).next().map_or_else(of_file, |Record { source }| source)
}
