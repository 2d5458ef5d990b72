//! Maps in HDF5 and NetCDF files, with the coordinates, sizes and units beside them.
//!
//! Every array of numbers with two dimensions longer than 1 is a channel. Its name is its path. Of an array with three,
//! each frame is a channel. The attribute `units` (or `unit`) of an array is its unit. Coordinates are the variables of
//! the dimensions in NetCDF, those that the attribute `axes` of a group names (NeXus), or arrays called `x` and `y`, or
//! the like, beside the map. Without them, attributes and single numbers say the size.
//!
//! The last index is x, with three exceptions: the dimensions are called x and y in this order, the coordinates have
//! these lengths, or MATLAB wrote the array. Files of MATLAB have dimensions in reverse order, and vectors of two
//! dimensions.

use std::rc::Rc;

use netcdf_reader::{NcGroup, NcSliceInfo, NcSliceInfoElem, NcVariable};
use rc_core::Grid;

use super::channel::{Channel, Channels};
use super::field::{field, flip, transposed};
use super::layout::Layout;
use super::netcdf::{Arrays, is_number, open};
use super::netcdf_axes::{self, Beside, Coordinates};
use super::netcdf_beside::{FEW, attributes, long, others, scalings, with_units};
use super::points::{self, Kind};
use super::scalings::Scalings;
use super::{axes, netcdf_lines, unit};
use crate::{Format, FormatError, HeightMap, ReadParams, Unit};

/// Maximum number of frames of an array that are channels.
const MOST_FRAMES: u64 = 256;

/// Maximum length of a last dimension whose indices are frames. They are layers of one scan.
const MOST_LAYERS: u64 = 16;

/// An array, or a frame of it, that may be a map.
#[derive(Clone)]
struct Listed {
    path: String,
    /// The dimension that frames have, and the frame.
    frame: Option<(usize, u64)>,
    unit: Unit,
}

pub(super) fn channels<'a>(bytes: &[u8], format: Format, params: &ReadParams) -> Channels<'a> {
    let (layout, max_bytes) = (params.layout, params.max_bytes);
    let arrays = Rc::new(open(bytes, format, max_bytes)?);
    let mut listed = Vec::new();
    list(&arrays, arrays.root()?, "", &mut listed)?;
    if listed.is_empty() && (params.row_is_map || params.is_profile) {
        return netcdf_lines::channels(&arrays, arrays.root()?);
    }
    if listed.is_empty() {
        return of_vectors(&arrays, arrays.root()?, "", max_bytes);
    }
    let units: Vec<Unit> = listed.iter().map(|array| array.unit).collect();
    let channel = |(array, is_height): (Listed, bool)| {
        let arrays = arrays.clone();
        let name = array.frame.map_or_else(|| array.path.clone(), |(_, frame)| format!("{}[{frame}]", array.path));
        Channel { name, is_height, read: Box::new(move || map(&arrays, &array, layout, max_bytes)) }
    };
    Ok(listed.into_iter().zip(unit::are_heights(&units)).map(channel).collect())
}

/// Paths and units of the maps in a group.
fn list(arrays: &Arrays, group: &NcGroup, path: &str, found: &mut Vec<Listed>) -> Result<(), FormatError> {
    let is_coordinate = |variable: &NcVariable| {
        let is_map = |other: &NcVariable| {
            is_map(other) && other.shape() == variable.shape() && axes::axis_of(other.name()).is_none()
        };
        axes::axis_of(variable.name()).is_some() && group.variables.iter().any(is_map)
    };
    let maps: Vec<&NcVariable> =
        group.variables.iter().filter(|variable| is_map(variable) && !is_coordinate(variable)).collect();
    if !maps.is_empty() {
        let others = others(arrays, path)?;
        for variable in maps {
            let unit = Scalings::of(&attributes(variable.attributes()), &others).heights().0;
            let path = format!("{path}{}", variable.name());
            let frames = frames(variable)
                .map_or(vec![None], |(axis, n)| (0..n.min(MOST_FRAMES)).map(|frame| Some((axis, frame))).collect());
            found.extend(frames.into_iter().map(|frame| Listed { path: path.clone(), frame, unit }));
        }
    }
    group.groups.iter().try_for_each(|inner| list(arrays, inner, &format!("{path}{}/", inner.name), found))
}

/// Whether a variable has numbers along two or three dimensions. Other dimensions must have length 1.
fn is_map(variable: &NcVariable) -> bool {
    let is_text = netcdf_axes::class_of_matlab(variable).is_some_and(|class| class == "char");
    is_number(variable.dtype()) && !is_text && matches!(long(variable).len(), 2 | 3)
}

/// The dimension of the frames of a variable, and its length.
fn frames(variable: &NcVariable) -> Option<(usize, u64)> {
    let [first, second, last] = *<&[_; 3]>::try_from(long(variable).as_slice()).ok()?;
    let are_layers = last.1 <= MOST_LAYERS && first.1.min(second.1) > MOST_LAYERS;
    Some(if are_layers { last } else { first })
}

/// The points of three vectors of a group, of which two are called x and y.
///
/// # Errors
/// [`FormatError::Profile`] when there are vectors, but not three of one length.
fn of_vectors<'a>(arrays: &Rc<Arrays>, group: &NcGroup, path: &str, max_bytes: u64) -> Channels<'a> {
    let vectors = || group.variables.iter().filter(|variable| is_number(variable.dtype()) && long(variable).len() == 1);
    let axis = |variable: &&NcVariable| axes::axis_of(variable.name());
    for z in vectors().filter(|variable| axis(variable).is_none()) {
        let of =
            |wanted: usize| vectors().find(|other| axis(other) == Some(wanted) && long(other)[0].1 == long(z)[0].1);
        if let (Some(x), Some(y), true) = (of(0), of(1), long(z)[0].1 > FEW) {
            let (name, arrays) = (format!("{path}{}", z.name()), arrays.clone());
            let paths = [x, y, z].map(|variable| format!("{path}{}", variable.name()));
            let read = Box::new(move || of_paths(&arrays, &paths, max_bytes));
            return Ok(vec![Channel { name, is_height: true, read }]);
        }
    }
    for inner in &group.groups {
        let found = of_vectors(arrays, inner, &format!("{path}{}/", inner.name), max_bytes)?;
        if !found.is_empty() {
            return Ok(found);
        }
    }
    match vectors().map(|vector| long(vector)[0].1).find(|n| *n > FEW) {
        Some(n) => Err(FormatError::profile_in_array(&n.to_string(), "")),
        None => Ok(Vec::new()),
    }
}

/// The map of points whose coordinates and heights are three vectors.
fn of_paths(arrays: &Arrays, paths: &[String; 3], max_bytes: u64) -> Result<HeightMap, FormatError> {
    let [x, y, z] = paths;
    points::check(long(arrays.variable(z)?).first().map_or(1, |(_, n)| *n), max_bytes)?;
    let [x_values, y_values, z_values] = [x, y, z].map(|path| arrays.values(path, None));
    let places = x_values?.into_iter().zip(y_values?).zip(z_values?).map(|((x, y), z)| [x, y, z]);
    let places: Vec<[f64; 3]> = places.collect();
    let n = places.len();
    let mut map = points::map_of(&places, [n as u64, 3])?;
    let units = [netcdf_axes::unit_name(arrays.variable(x)?), netcdf_axes::unit_name(arrays.variable(y)?)];
    if let Some(sides) = map.sides {
        (map.sides, map.side_unit) = with_units(arrays.format, sides, &units)?;
    }
    scalings(arrays, z)?.apply(&mut map);
    Ok(map)
}

fn map(arrays: &Arrays, listed: &Listed, layout: Option<Layout>, max_bytes: u64) -> Result<HeightMap, FormatError> {
    let variable = arrays.variable(&listed.path)?;
    let scalings = scalings(arrays, &listed.path)?;
    let sides: Vec<(usize, u64)> =
        long(variable).into_iter().filter(|(i, _)| listed.frame.is_none_or(|(axis, _)| axis != *i)).collect();
    let &[first, second] = sides.as_slice() else {
        return Err(FormatError::Missing { format: arrays.format, field: "an array of two dimensions" });
    };
    let kind = if listed.frame.is_none() { Kind::of(arrays.format, [first.1, second.1], layout)? } else { Kind::Map };
    let mut map = if kind == Kind::Map {
        grid_map(arrays, listed, [first, second], &scalings)?
    } else {
        points::check(first.1.max(second.1), max_bytes)?;
        points::map(&arrays.values(&listed.path, None)?, kind, [first.1, second.1])?
    };
    scalings.apply(&mut map);
    if kind != Kind::Map && map.side_unit == Unit::Unnamed && map.height_unit == Unit::Metre {
        // The unit of the array is that of its three columns.
        let metres = scalings.heights().1;
        map.sides = map.sides.map(|sides| sides.map(|side| side * metres));
        map.side_unit = Unit::Metre;
    }
    Ok(map)
}

/// A map of heights, with sides from coordinates or from what stands beside it.
fn grid_map(
    arrays: &Arrays,
    listed: &Listed,
    [first, second]: [(usize, u64); 2],
    scalings: &Scalings,
) -> Result<HeightMap, FormatError> {
    let variable = arrays.variable(&listed.path)?;
    let name = |axis: usize| variable.dimensions().get(axis).map_or("", |dimension| dimension.name.as_str());
    let of_matlab = netcdf_axes::class_of_matlab(variable).is_some();
    let x_is_first = of_matlab || name(first.0).eq_ignore_ascii_case("x") && name(second.0).eq_ignore_ascii_case("y");
    let [along_x, along_y] = if x_is_first { [first, second] } else { [second, first] };
    let side = |n: u64| usize::try_from(n).unwrap_or(usize::MAX);
    let mut grid = Grid::new(side(along_x.1), side(along_y.1))?;
    let stored = arrays.values(&listed.path, part(variable, listed.frame).as_ref())?;
    if stored.len() != grid.len() {
        let (needed, found) = (grid.len() as u64, stored.len() as u64);
        return Err(FormatError::CutShort { grid, needed, found });
    }
    let mut values = if x_is_first { transposed(&stored, grid) } else { stored };
    axes::refuse_mesh(arrays.format, &listed.path, &values, grid.nx())?;
    let dimensions = [name(along_x.0), name(along_y.0)];
    let beside = Beside { path: &listed.path, dimensions, grid, of_matlab };
    let Some((coordinates, is_other_way)) = netcdf_axes::coordinates(arrays, &beside)? else {
        let (sides, unit) = scalings.sides(grid).map_or((None, Unit::Unnamed), |(sides, unit)| (Some(sides), unit));
        return Ok(HeightMap::new(field(grid, values), Unit::Unnamed, sides, unit));
    };
    if is_other_way {
        grid = Grid::new(grid.ny(), grid.nx())?;
        values = transposed(&values, grid);
    }
    let [Coordinates { values: x, unit: of_x }, Coordinates { values: y, unit: of_y }] = coordinates;
    let steps = [axes::step("x", &x)?, axes::step("y", &y)?];
    flip(&mut values, grid, steps.map(|step| step < 0.0));
    let sides = [steps[0].abs() * grid.nx() as f64, steps[1].abs() * grid.ny() as f64];
    let (sides, side_unit) = with_units(arrays.format, sides, &[of_x, of_y])?;
    Ok(HeightMap::new(field(grid, values), Unit::Unnamed, sides, side_unit))
}

/// The part of a variable that is a frame.
fn part(variable: &NcVariable, frame: Option<(usize, u64)>) -> Option<NcSliceInfo> {
    let (axis, frame) = frame?;
    let mut part = NcSliceInfo::all(variable.ndim());
    *part.selections.get_mut(axis)? = NcSliceInfoElem::Index(frame);
    Some(part)
}
