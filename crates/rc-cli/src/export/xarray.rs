//! The fields of a result as a Zarr group for xarray.
//!
//! xarray opens it as a data set, whose variables have the dimensions y and x.

use rc_core::Grid;
use serde_json::{Value, json};

use super::fields::Fields;
use super::zarr::{Array, Group, Values};

/// Dimensions of a field: rows, columns.
const PLANE: &[&str] = &["y", "x"];

/// Pressure, gap, contact, heights if there are any, and coordinates of elements' centres.
pub(super) fn group(fields: &Fields) -> Group<'_> {
    let Fields { status, side, e_star, pressure, gap, plastic_gap, height, others, contact_name } = fields;
    let grid = pressure.grid();
    let plane = |name, units, meaning, values| Array {
        name,
        dimensions: PLANE,
        shape: vec![grid.ny(), grid.nx()],
        units,
        meaning,
        values,
    };
    let axis = |name, dimensions, centres: Vec<f64>| Array {
        name,
        dimensions,
        shape: vec![centres.len()],
        units: "m",
        meaning: "centre of the element",
        values: Values::Float64(centres.into()),
    };
    let mut arrays = vec![
        plane("pressure", "Pa", "contact pressure", Values::Float64(pressure.values().into())),
        plane("gap", "m", "gap between the surfaces", Values::Float64(gap.values().into())),
        plane(contact_name, "1", "1 where the pressure is positive", Values::UInt8(fields.contact())),
    ];
    arrays.extend(plastic_gap.iter().map(|plastic_gap| {
        let meaning = "overlap that plastic flow has removed";
        plane("plastic_gap", "m", meaning, Values::Float64(plastic_gap.values().into()))
    }));
    arrays.extend(height.iter().map(|height| {
        let meaning = "height of the rigid surface, positive towards the half-space";
        plane("height", "m", meaning, Values::Float64(height.values().into()))
    }));
    arrays.extend(others.iter().map(|(name, field)| {
        let (units, meaning) = unit_and_meaning(name);
        plane(name, units, meaning, Values::Float64(field.values().into()))
    }));
    arrays.push(axis("y", &["y"], (0..grid.ny()).map(|iy| grid.centre(0, iy).y * side).collect()));
    arrays.push(axis("x", &["x"], (0..grid.nx()).map(|ix| grid.centre(ix, 0).x * side).collect()));
    Group { attributes: attributes(status, grid, *side, *e_star), arrays }
}

/// Unit and meaning of another field.
fn unit_and_meaning(name: &str) -> (&'static str, &'static str) {
    match name {
        "shear_x" | "shear_y" => ("Pa", "tangential traction on the elastic body"),
        "slip" => ("m", "length of the slip, 0 where the surfaces stick"),
        "fluid_pressure" => ("Pa", "pressure of the fluid, which adds to the contact pressure"),
        _ => ("m2", "flux of the film times 12 viscosity, divided by the pressure drop across the cell"),
    }
}

/// The attributes of the group: its origin, the cell and the material.
///
/// `side` is the cell's side along x in m, and `e_star` is E* in Pa.
pub(crate) fn attributes(status: &str, grid: Grid, side: f64, e_star: f64) -> Value {
    json!({
        "source": concat!("rc ", env!("CARGO_PKG_VERSION")),
        "status": status,
        "cell": side,
        "cell_units": "m",
        "cell_y": side * grid.cell_ratio(),
        "cell_meaning": "side of the periodic cell along x; cell_y is that along y",
        "e_star": e_star,
        "e_star_units": "Pa",
    })
}
