//! Profiles in HDF5 and NetCDF files: a vector of heights beside a vector of x.

use std::rc::Rc;

use netcdf_reader::{NcGroup, NcVariable};
use rc_core::Grid;

use super::axes;
use super::channel::{Channel, Channels};
use super::field::field;
use super::netcdf::{Arrays, is_number};
use super::netcdf_axes::unit_name;
use super::netcdf_beside::{FEW, long, scalings, with_units};
use crate::{FormatError, HeightMap, Unit};

/// The profiles of a group, as maps of one row.
///
/// # Errors
/// [`FormatError::Profile`] when a vector of heights has no vector x of its length.
pub(super) fn channels<'a>(arrays: &Rc<Arrays>, group: &NcGroup) -> Channels<'a> {
    let is_vector = |variable: &&NcVariable| is_number(variable.dtype()) && long(variable).len() == 1;
    let length = |variable: &NcVariable| long(variable).first().map_or(1, |(_, n)| *n);
    let vectors: Vec<&NcVariable> =
        group.variables.iter().filter(is_vector).filter(|variable| length(variable) > FEW).collect();
    let heights = vectors.iter().filter(|variable| axes::axis_of(variable.name()).is_none());
    heights
        .map(|z| {
            let is_x = |other: &&&NcVariable| axes::axis_of(other.name()) == Some(0) && length(other) == length(z);
            let x = vectors.iter().find(is_x);
            let x = x.ok_or_else(|| FormatError::profile_in_array(&length(z).to_string(), ""))?;
            let (names, arrays) = ([x.name().to_owned(), z.name().to_owned()], arrays.clone());
            let read = Box::new(move || row(&arrays, &names));
            Ok(Channel { name: z.name().to_owned(), is_height: true, read })
        })
        .collect()
}

/// The row of heights in one vector, at the equal steps of another.
fn row(arrays: &Arrays, [x, z]: &[String; 2]) -> Result<HeightMap, FormatError> {
    let (places, mut values) = (arrays.values(x, None)?, arrays.values(z, None)?);
    let grid = Grid::new(values.len(), 1)?;
    let step = axes::step("x", &places)?;
    // Heights of falling x are reversed, as rows of a map are.
    if step < 0.0 {
        values.reverse();
    }
    let step = step.abs();
    let unit = unit_name(arrays.variable(x)?);
    let sides = [step * values.len() as f64, step];
    let (sides, side_unit) = with_units(arrays.format, sides, &[unit.clone(), unit])?;
    let mut map = HeightMap::new(field(grid, values), Unit::Unnamed, sides, side_unit);
    scalings(arrays, z)?.apply(&mut map);
    Ok(map)
}
