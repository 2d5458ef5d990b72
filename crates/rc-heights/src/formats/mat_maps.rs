//! Maps in MATLAB 5 files, with the coordinates, sizes and units beside them.

use std::rc::Rc;

use rc_core::Grid;

use super::channel::{Channel, Channels};
use super::field::{field, flip, transposed};
use super::layout::Layout;
use super::mat::{Array, Class, arrays};
use super::points::{self, Kind};
use super::scalings::{Entries, Scalings, Value};
use super::{axes, limit};
use crate::{Format, FormatError, HeightMap, Unit};

/// Maximum number of frames of an array that are channels.
const MOST_FRAMES: usize = 256;

/// Number of values above which a vector is a profile or an axis, not a few settings.
const FEW: usize = 8;

/// The arrays of a file, and how they are read.
struct File<'a> {
    arrays: Vec<Array<'a>>,
    layout: Option<Layout>,
    max_bytes: u64,
}

pub(super) fn channels(bytes: &[u8], layout: Option<Layout>, max_bytes: u64) -> Channels<'_> {
    let file = Rc::new(File { arrays: arrays(bytes)?, layout, max_bytes });
    let mut channels = Vec::new();
    for i in (0..file.arrays.len()).filter(|i| file.is_map(*i)) {
        let array = &file.arrays[i];
        for frame in 0..array.frames.min(MOST_FRAMES) {
            let name = if array.frames == 1 { array.name.clone() } else { format!("{}[{frame}]", array.name) };
            let (file, is_height) = (file.clone(), array.class == Class::Number);
            channels.push(Channel { name, is_height, read: Box::new(move || file.map(i, frame)) });
        }
    }
    if channels.is_empty() {
        channels.extend(of_vectors(&file)?);
    }
    Ok(channels)
}

/// The points of three vectors, of which two are called x and y.
///
/// # Errors
/// [`FormatError::Profile`] when there are vectors, but not three of one length.
fn of_vectors<'a>(file: &Rc<File<'a>>) -> Result<Option<Channel<'a>>, FormatError> {
    let vectors: Vec<(usize, usize)> =
        (0..file.arrays.len()).filter_map(|i| Some((i, file.arrays[i].length()?))).filter(|(_, n)| *n > FEW).collect();
    let Some((_, first)) = vectors.first() else { return Ok(None) };
    let axis = |i: usize| axes::axis_of(&file.arrays[i].name);
    let of = |wanted: Option<usize>, n: usize| {
        vectors.iter().find(|(i, length)| axis(*i) == wanted && *length == n).map(|(i, _)| *i)
    };
    for (z, n) in vectors.iter().filter(|(i, _)| axis(*i).is_none()) {
        if let (Some(x), Some(y)) = (of(Some(0), *n), of(Some(1), *n)) {
            let (name, file, places, n) = (file.arrays[*z].name.clone(), file.clone(), [x, y, *z], *n);
            return Ok(Some(Channel { name, is_height: true, read: Box::new(move || file.points(places, n)) }));
        }
    }
    Err(FormatError::profile_in_array(&first.to_string(), ""))
}

impl File<'_> {
    /// Whether array `i` has a map, not coordinates of another.
    fn is_map(&self, i: usize) -> bool {
        let array = &self.arrays[i];
        let has_same_shape = |other: &Array<'_>| (other.rows, other.columns) == (array.rows, array.columns);
        let is_other_map =
            |other: &Array<'_>| other.is_map() && has_same_shape(other) && axes::axis_of(&other.name).is_none();
        array.is_map() && !(axes::axis_of(&array.name).is_some() && self.arrays.iter().any(is_other_map))
    }

    /// A frame of array `i` as a map, with sides if there are coordinates or sizes.
    fn map(&self, i: usize, frame: usize) -> Result<HeightMap, FormatError> {
        let array = &self.arrays[i];
        let shape = [array.rows as u64, array.columns as u64];
        let kind = if array.frames == 1 { Kind::of(Format::Mat, shape, self.layout)? } else { Kind::Map };
        let scalings = Scalings::of(&Entries::new(), &self.entries());
        let mut map = match kind {
            Kind::Map => self.grid_map(i, frame, &scalings)?,
            Kind::Rows => self.table(array, Kind::Columns)?,
            Kind::Columns => self.table(array, Kind::Rows)?,
        };
        scalings.apply(&mut map);
        Ok(map)
    }

    /// The points in an array, which is stored column by column.
    fn table(&self, array: &Array<'_>, kind: Kind) -> Result<HeightMap, FormatError> {
        points::check(array.rows.max(array.columns) as u64, self.max_bytes)?;
        points::map(
            &array.numbers(0, array.rows.saturating_mul(array.columns), self.max_bytes)?,
            kind,
            [array.rows as u64, array.columns as u64],
        )
    }

    /// The map of points in three vectors.
    fn points(&self, places: [usize; 3], n: usize) -> Result<HeightMap, FormatError> {
        points::check(n as u64, self.max_bytes)?;
        let [x, y, z] = places.map(|i| self.arrays[i].numbers(0, n, self.max_bytes));
        let points = x?.into_iter().zip(y?).zip(z?).map(|((x, y), z)| [x, y, z]);
        let mut map = points::map_of(&points.collect::<Vec<_>>(), [n as u64, 3])?;
        Scalings::of(&Entries::new(), &self.entries()).apply(&mut map);
        Ok(map)
    }

    fn grid_map(&self, i: usize, frame: usize, scalings: &Scalings) -> Result<HeightMap, FormatError> {
        let coordinates = self.coordinates(i)?;
        let (mut grid, mut values) = self.arrays[i].values(frame, self.max_bytes)?;
        axes::refuse_mesh(Format::Mat, &self.arrays[i].name, &values, grid.nx())?;
        let Some(([x, y], x_is_first)) = coordinates else {
            let (sides, unit) = scalings.sides(grid).map_or((None, Unit::Unnamed), |(sides, unit)| (Some(sides), unit));
            return Ok(HeightMap::new(field(grid, values), Unit::Unnamed, sides, unit));
        };
        if x_is_first {
            grid = Grid::new(grid.ny(), grid.nx())?;
            values = transposed(&values, grid);
        }
        let steps = [axes::step("x", &x)?, axes::step("y", &y)?];
        flip(&mut values, grid, steps.map(|step| step < 0.0));
        let sides = [steps[0].abs() * grid.nx() as f64, steps[1].abs() * grid.ny() as f64];
        Ok(HeightMap::new(field(grid, values), Unit::Unnamed, Some(sides), Unit::Unnamed))
    }

    /// Coordinates of array `i` along x and y, and whether its first index is x.
    ///
    /// `None` unless there are arrays with these names and of the right lengths.
    fn coordinates(&self, i: usize) -> Result<Option<axes::Meshes>, FormatError> {
        let map = &self.arrays[i];
        let of = |axis: usize, is: &dyn Fn(&Array<'_>) -> bool| {
            let mut others = self.arrays.iter().enumerate();
            others.find(|(j, other)| *j != i && axes::axis_of(&other.name) == Some(axis) && is(other)).map(|(_, a)| a)
        };
        let vectors = |[nx, ny]: [usize; 2]| {
            let is_vector = |array: &Array<'_>, n: usize| array.length() == Some(n);
            Some((of(0, &|array| is_vector(array, nx))?, of(1, &|array| is_vector(array, ny))?))
        };
        let numbers = |array: &Array<'_>, n: usize| array.numbers(0, n, self.max_bytes);
        if let Some((x, y)) = vectors([map.columns, map.rows]) {
            return Ok(Some(([numbers(x, map.columns)?, numbers(y, map.rows)?], false)));
        }
        if let Some((x, y)) = vectors([map.rows, map.columns]) {
            return Ok(Some(([numbers(x, map.rows)?, numbers(y, map.columns)?], true)));
        }
        let is_mesh = |array: &Array<'_>| {
            array.class == Class::Number && (array.rows, array.columns, array.frames) == (map.rows, map.columns, 1)
        };
        let (Some(x), Some(y)) = (of(0, &is_mesh), of(1, &is_mesh)) else { return Ok(None) };
        let points = (map.rows as u64).saturating_mul(map.columns as u64);
        limit::check(points.saturating_mul(32), self.max_bytes)?;
        Ok(axes::of_meshes(&x.values(0, self.max_bytes)?.1, &y.values(0, self.max_bytes)?.1, map.columns))
    }

    /// Texts and single numbers of the file.
    fn entries(&self) -> Entries {
        let value = |array: &Array<'_>| match (array.class, array.length()) {
            (Class::Text, _) => array.text().map(Value::Text),
            (Class::Number, Some(n @ (1 | 2))) => array.numbers(0, n, self.max_bytes).ok().map(Value::Numbers),
            _ => None,
        };
        self.arrays.iter().filter_map(|array| Some((array.name.clone(), value(array)?))).collect()
    }
}
