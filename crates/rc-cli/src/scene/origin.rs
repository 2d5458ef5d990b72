//! The origin of a height map, for `source` in records and summaries.

use std::path::Path;

use rc_sweep::MapOrigin;
use serde::Deserialize;

use super::form::FormName;
use super::keys::SurfaceKeys;
use crate::files::beside;

/// What made a surface of a spectrum, before the number of the seed.
const OF_TABLE: &str = "surface with this spectrum, seed ";
const OF_PROFILE: &str = "surface with the spectrum of this profile, seed ";

/// The origin of a realisation of the spectrum in `path`, which may be a profile.
///
/// A table in a folder of rc has the file in the record beside it, and its treatments before the realisation.
pub(crate) fn of_spectrum(path: &Path, channel: Option<&str>, (seed, is_profile): (u64, bool)) -> MapOrigin {
    let made_by = |origin: &MapOrigin, how: &str| origin.treatments.last().is_some_and(|made| made.starts_with(how));
    let is_table = |origin: &MapOrigin| made_by(origin, OF_TABLE) || made_by(origin, OF_PROFILE);
    let mut origin = Some(of(path, channel)).filter(is_table).unwrap_or_else(|| of_file(path, channel));
    let of_profile = is_profile || made_by(&origin, OF_PROFILE);
    origin.treatments.pop();
    origin.treatments.push(format!("{}{seed}", if of_profile { OF_PROFILE } else { OF_TABLE }));
    origin
}

/// The origin of the map at `path`, of which `channel` is read.
///
/// A map in a folder of rc has the origin in the record beside it.
pub(crate) fn of(path: &Path, channel: Option<&str>) -> MapOrigin {
    #[derive(Deserialize)]
    struct Record {
        source: MapOrigin,
    }
    beside::records(path).next().map_or_else(|| of_file(path, channel), |Record { source }| source)
}

/// The origin of a map to which the shape and the other body of `keys` are added.
///
/// A generated surface has no file, so the origin of its sum is the file of the other body.
pub(crate) fn with_added(origin: Option<MapOrigin>, keys: &SurfaceKeys) -> Option<MapOrigin> {
    let Some(mut origin) = origin else {
        let other = keys.add.as_ref()?;
        let treatments = vec!["mirrored along x and added to a generated surface".to_owned()];
        return Some(MapOrigin { treatments, ..of_file(other, None) });
    };
    if keys.shape.is_some_and(|shape| shape != FormName::Flat) {
        origin.treatments.push("shape added".to_owned());
    }
    if let Some(other) = &keys.add {
        origin.treatments.push(format!("{} added, mirrored along x", other.display()));
    }
    Some(origin)
}

fn of_file(path: &Path, channel: Option<&str>) -> MapOrigin {
    MapOrigin { file: path.display().to_string(), channel: channel.map(str::to_owned), treatments: Vec::new() }
}
