//! A sweep that is continued with more surfaces or more loads. Its finished rows get the numbers of the new plan.

use std::collections::{HashMap, HashSet};
use std::path::Path;
use std::{fs, io};

use serde_json::{Map, Value};

use crate::content::{Content, Header};
use crate::files::{self, FileError};
use crate::folder::{ROWS_FOLDER, fields_folder, row_name};
use crate::hidden::PARTIAL;
use crate::shard::Shard;

/// The surfaces of a journal: each as text without its loads, and its loads.
type Surfaces<'a> = Vec<(String, &'a [Value])>;

/// The new number of each row of the sweep in a journal.
///
/// `None` if the sweeps are equal, or if the new one does not have all rows of the other.
pub(crate) fn places(there: &Header, here: &Header) -> Option<Vec<usize>> {
    if there == here || [there.shard, here.shard] != [Shard::WHOLE; 2] {
        return None;
    }
    let ((rest, old), (other_rest, new)) = (parts(there)?, parts(here)?);
    // Rows have the column of scenes only if there are several.
    if rest != other_rest || has_scenes(there) != has_scenes(here) {
        return None;
    }
    let numbers: HashMap<&str, usize> = new.iter().enumerate().map(|(i, (surface, _))| (surface.as_str(), i)).collect();
    let mut places = Vec::new();
    for (surface, loads) in &old {
        let number = *numbers.get(surface.as_str())?;
        for load in *loads {
            let place = new[number].1.iter().position(|other| other == load)?;
            places.push(number * here.shape.loads + place);
        }
    }
    Some(places)
}

/// The settings but the surfaces, and the surfaces. `None` for a journal of another kind.
fn parts(header: &Header) -> Option<(Map<String, Value>, Surfaces<'_>)> {
    let mut rest = header.settings.as_object()?.clone();
    rest.shift_remove("surfaces")?;
    let surface = |value: &Value| -> Option<_> {
        let mut surface = value.as_object()?.clone();
        surface.shift_remove("loads")?;
        Some(Value::Object(surface).to_string())
    };
    let surfaces = header.settings["surfaces"].as_array()?.iter();
    let surfaces: Surfaces<'_> =
        surfaces.map(|value| Some((surface(value)?, value["loads"].as_array()?.as_slice()))).collect::<Option<_>>()?;
    let has_shape =
        surfaces.len() == header.shape.surfaces && surfaces.iter().all(|(_, loads)| loads.len() == header.shape.loads);
    has_shape.then_some((rest, surfaces))
}

/// Whether the surfaces are of several scenes.
fn has_scenes(header: &Header) -> bool {
    let surfaces = header.settings["surfaces"].as_array();
    let names: HashSet<_> = surfaces.into_iter().flatten().map(|surface| surface["scene"].as_str()).collect();
    names.len() > 1
}

/// The content with the first line `header` and its rows in these places.
pub(crate) fn moved(content: Content, header: Header, places: &[usize]) -> Content {
    let rows = content.rows.into_iter().map(|(row, cells)| (places[row], cells)).collect();
    let mut content = Content { header, rows, whole: 0 };
    content.whole = content.text().len() as u64;
    content
}

/// Folders of rows on their way to new numbers.
///
/// A process that is killed on the way leaves rows without fields, which are solved again. It never leaves fields under
/// the number of another row.
pub(crate) struct MovedFields<'a> {
    folder: &'a Path,
    rows: Vec<usize>,
}

impl<'a> MovedFields<'a> {
    /// Hides the folders of rows that get other numbers.
    ///
    /// # Errors
    /// [`FileError`] when a folder cannot be renamed.
    pub(crate) fn hide(folder: &'a Path, places: &[usize]) -> Result<Self, FileError> {
        files::remove_leftovers(&folder.join(ROWS_FOLDER));
        let mut rows = Vec::new();
        for (row, &place) in places.iter().enumerate().filter(|(row, place)| row != *place) {
            if rename(&fields_folder(folder, row), &hidden(folder, place))? {
                rows.push(place);
            }
        }
        Ok(Self { folder, rows })
    }

    /// Gives the folders their new numbers.
    ///
    /// # Errors
    /// [`FileError`] when a folder cannot be renamed.
    pub(crate) fn show(self) -> Result<(), FileError> {
        for place in self.rows {
            rename(&hidden(self.folder, place), &fields_folder(self.folder, place))?;
        }
        Ok(())
    }
}

fn hidden(folder: &Path, row: usize) -> std::path::PathBuf {
    folder.join(ROWS_FOLDER).join(format!("{PARTIAL}{}", row_name(row)))
}

/// Renames a folder, and returns whether there was one.
fn rename(from: &Path, to: &Path) -> Result<bool, FileError> {
    match fs::rename(from, to) {
        Ok(()) => Ok(true),
        Err(cause) if cause.kind() == io::ErrorKind::NotFound => Ok(false),
        Err(cause) => Err(FileError::write(to, cause)),
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;
    use crate::shard::SweepShape;

    fn header(seeds: &[u64], loads: &[f64]) -> Header {
        let surfaces: Vec<Value> =
            seeds.iter().map(|seed| json!({ "surface": { "seed": seed }, "loads": loads })).collect();
        let shape = SweepShape { surfaces: seeds.len(), loads: loads.len() };
        Header::whole(shape, json!({ "version": "1", "surfaces": surfaces }))
    }

    #[test]
    fn rows_keep_their_surface_and_load() {
        let old = header(&[1, 2], &[1e5, 4e5]);
        assert_eq!(places(&old, &header(&[1, 2, 3], &[1e5, 4e5])), Some(vec![0, 1, 2, 3]));
        assert_eq!(places(&old, &header(&[2, 9, 1], &[1e5, 2e5, 4e5])), Some(vec![6, 8, 0, 2]));
        assert_eq!(places(&old, &header(&[1, 2], &[4e5, 1e5])), Some(vec![1, 0, 3, 2]));
    }

    #[test]
    fn a_sweep_without_all_the_rows_is_another_one() {
        let old = header(&[1, 2], &[1e5, 4e5]);
        let mut version = header(&[1, 2, 3], &[1e5, 4e5]);
        version.settings["version"] = json!("2");
        let mut shard = header(&[1, 2, 3], &[1e5, 4e5]);
        shard.shard = Shard { index: 1, count: 2 };
        let mut scenes = header(&[1, 2, 3], &[1e5, 4e5]);
        scenes.settings["surfaces"][2]["scene"] = json!("b");
        for other in [old.clone(), header(&[1], &[1e5, 4e5]), header(&[1, 2], &[1e5, 3e5]), version, shard, scenes] {
            assert_eq!(places(&old, &other), None, "{other:?}");
        }
    }
}
