//! `rc export`: a result as files of other programs: VTK for ParaView, PyVista and VisIt.

mod vtk;

use std::path::Path;

use crate::args::ExportArgs;
use crate::error::CliError;
use crate::npy;
use crate::output::{self, Staged};
use crate::result::ResultFolder;
use crate::surface::HEIGHTS_FILE;
use vtk::{Array, Dataset, Values};

/// Elements of methods that have their own.
const ELEMENTS_FILE: &str = "elements.csv";

/// Number of a quadrilateral among VTK's cells.
const VTK_QUAD: u8 = 9;

/// Runs `rc export`.
///
/// # Errors
/// [`CliError`].
pub(crate) fn run(args: &ExportArgs) -> Result<(), CliError> {
    let result = ResultFolder::read_finite(&args.folder)?;
    let target = args.out.as_deref().unwrap_or(&args.folder);
    output::check_folder(target)?;
    let fields = fields(&args.folder, result)?;
    let elements = args.folder.join(ELEMENTS_FILE);
    let elements = elements.is_file().then(|| read_elements(&elements)).transpose()?;
    let mut staged = Staged::new(target)?;
    staged.add("fields.vti", |path| vtk::write(path, &fields))?;
    if let Some(elements) = elements {
        staged.add("elements.vtu", |path| vtk::write(path, &mesh(&elements)))?;
    }
    let names = staged.names().to_vec();
    staged.commit()?;
    if args.quiet { Ok(()) } else { output::print_names(target, &names) }
}

/// Pressure, gap, contact, and heights if the result has them, as values of the cells of an image: a value belongs to the
/// element, not to its corners.
fn fields(folder: &Path, result: ResultFolder) -> Result<Dataset, CliError> {
    let ResultFolder { side, pressure, gap, .. } = result;
    let grid = pressure.grid();
    let contact = pressure.values().iter().map(|p| u8::from(*p > 0.0)).collect();
    let mut cells = vec![
        Array::new("contact", 1, Values::UInt8(contact)),
        Array::new("pressure", 1, Values::Float64(pressure.into_values())),
        Array::new("gap", 1, Values::Float64(gap.into_values())),
    ];
    let heights = folder.join(HEIGHTS_FILE);
    if heights.is_file() {
        let field = npy::read(&heights)?;
        // With --output-grid, pressure and gap are coarser than the heights.
        if field.grid() == grid {
            cells.push(Array::new("height", 1, Values::Float64(field.into_values())));
        }
    }
    let (dx, dy) = (side / grid.nx() as f64, side / grid.ny() as f64);
    let extent = format!("0 {} 0 {} 0 0", grid.nx(), grid.ny());
    let whole = vec![
        ("WholeExtent", extent.clone()),
        ("Origin", "0 0 0".to_owned()),
        ("Spacing", format!("{dx:e} {dy:e} {dx:e}")),
    ];
    Ok(Dataset { kind: "ImageData", whole, piece: vec![("Extent", extent)], sections: vec![("CellData", cells)] })
}

/// An element as its file has it.
#[derive(Clone, Copy, Debug, serde::Deserialize)]
struct Element {
    x: f64,
    y: f64,
    size: f64,
    pressure: f64,
}

fn read_elements(path: &Path) -> Result<Vec<Element>, CliError> {
    let fail = |cause: csv::Error| CliError::in_file(path, format_args!("not elements of rc solve: {cause}"));
    csv::Reader::from_path(path).map_err(fail)?.deserialize().collect::<Result<_, _>>().map_err(fail)
}

/// The elements as quadrilaterals, each with corners of its own, so that elements of different sizes need no common points.
fn mesh(elements: &[Element]) -> Dataset {
    const CORNERS: [[f64; 2]; 4] = [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]];
    let n = elements.len();
    let corner = |e: Element, [dx, dy]: [f64; 2]| [e.x + dx * e.size, e.y + dy * e.size, 0.0];
    let points = elements.iter().flat_map(|&e| CORNERS.into_iter().flat_map(move |at| corner(e, at))).collect();
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
            ("Points", vec![Array::new("points", 3, Values::Float64(points))]),
            ("Cells", cells),
            ("CellData", data),
        ],
    }
}
