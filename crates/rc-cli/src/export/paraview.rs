//! The data sets of a result for ParaView.
//!
//! Fields are an image, and elements are a mesh.

use super::fields::{Element, Fields};
use super::vtk::{Array, Dataset, Values};

/// Number of a quadrilateral among VTK's cells.
const VTK_QUAD: u8 = 9;

/// The fields as values of the cells of an image.
///
/// A value belongs to an element, not to its corners.
pub(super) fn image(fields: &Fields) -> Dataset<'_> {
    let Fields { side, pressure, gap, plastic_gap, height, others, .. } = fields;
    let grid = pressure.grid();
    let mut cells = vec![
        Array::new(fields.contact_name, 1, Values::UInt8(fields.contact())),
        Array::new("pressure", 1, Values::Float64(pressure.values().into())),
        Array::new("gap", 1, Values::Float64(gap.values().into())),
    ];
    for (name, field) in [("plastic_gap", plastic_gap), ("height", height)] {
        cells.extend(field.iter().map(|field| Array::new(name, 1, Values::Float64(field.values().into()))));
    }
    cells.extend(others.iter().map(|(name, field)| Array::new(name, 1, Values::Float64(field.values().into()))));
    let (dx, dy) = (side / grid.nx() as f64, side * grid.cell_ratio() / grid.ny() as f64);
    let extent = format!("0 {} 0 {} 0 0", grid.nx(), grid.ny());
    let whole = vec![
        ("WholeExtent", extent.clone()),
        ("Origin", "0 0 0".to_owned()),
        ("Spacing", format!("{dx:e} {dy:e} {dx:e}")),
    ];
    Dataset { kind: "ImageData", whole, piece: vec![("Extent", extent)], sections: vec![("CellData", cells)] }
}

/// The elements as quadrilaterals, each with its own corners.
///
/// Elements of different sizes then need no common points.
pub(super) fn mesh(elements: &[Element]) -> Dataset<'static> {
    const CORNERS: [[f64; 2]; 4] = [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]];
    let n = elements.len();
    let corner = |e: Element, [dx, dy]: [f64; 2]| [e.x + dx * e.size, e.y + dy * e.size, 0.0];
    let points: Vec<f64> =
        elements.iter().flat_map(|&e| CORNERS.into_iter().flat_map(move |at| corner(e, at))).collect();
    let cells = vec![
        Array::new("connectivity", 1, Values::Int64((0..4 * n as i64).collect())),
        Array::new("offsets", 1, Values::Int64((1..=n as i64).map(|i| 4 * i).collect())),
        Array::new("types", 1, Values::UInt8(vec![VTK_QUAD; n])),
    ];
    let of = |value: fn(&Element) -> f64| Values::Float64(elements.iter().map(value).collect());
    let data = vec![Array::new("pressure", 1, of(|e| e.pressure)), Array::new("size", 1, of(|e| e.size))];
    Dataset {
        kind: "UnstructuredGrid",
        whole: Vec::new(),
        piece: vec![("NumberOfPoints", (4 * n).to_string()), ("NumberOfCells", n.to_string())],
        sections: vec![
            ("Points", vec![Array::new("points", 3, Values::Float64(points.into()))]),
            ("Cells", cells),
            ("CellData", data),
        ],
    }
}
