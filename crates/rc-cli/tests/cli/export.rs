//! `rc export`: files for other programs.

use rc_core::Field;
use serde_json::json;

use crate::support::{Place, array, assert_refused, assert_solved, bumps, f8, npy, small, text};

fn bytes_of(field: &Field) -> Vec<u8> {
    field.values().iter().flat_map(|value| value.to_le_bytes()).collect()
}

fn field(place: &Place, name: &str) -> Field {
    rc_heights::npy::read(&place.path(name)).expect("a field")
}

#[test]
fn a_result_is_exported_for_paraview() {
    let place = Place::new();
    assert_solved(&place.run(&small("1e5", &["--elements", "--out", "r"])));
    assert_solved(&place.run(&["export", "r", "--vtk", "--out", "vtk"]));
    assert_eq!(place.names("vtk"), ["elements.vtu", "fields.vti"]);
    let bytes = place.bytes("vtk/fields.vti");
    let mark = b"<AppendedData encoding=\"raw\">_";
    let start = bytes.windows(mark.len()).position(|window| window == mark).expect("the arrays") + mark.len();
    let head = text(&bytes[..start]);
    assert!(
        head.contains("WholeExtent=\"0 128 0 128 0 0\"") && head.contains("Spacing=\"7.8125e-5 7.8125e-5"),
        "{head}"
    );
    let stored = rc_heights::npy::read(&place.path("r/pressure.npy")).expect("the pressure");
    // The contact comes first, as a length and one byte per element. The length of the pressure follows.
    let first = start + 8 + stored.grid().len() + 8;
    for (i, p) in stored.values().iter().enumerate() {
        let at = first + 8 * i;
        assert_eq!(bytes[at..at + 8], p.to_le_bytes(), "element {i}");
    }
    let elements = text(&place.bytes("r/elements.csv")).lines().count() - 1;
    let head = text(&place.bytes("vtk/elements.vtu"));
    assert!(head.contains(&format!("NumberOfCells=\"{elements}\"")), "{elements} elements");
    assert_solved(&place.run(&small("1e5", &["--method", "uniform", "--out", "u"])));
    assert_solved(&place.run(&["export", "u", "--quiet"]));
    assert!(
        place.names("u").contains(&"fields.vti".to_owned()) && !place.names("u").contains(&"elements.vtu".to_owned())
    );
    assert_refused(&place.run(&["export", "vtk"]), "summary.json");
}

#[test]
fn a_result_is_exported_as_a_zarr_group_digit_by_digit() {
    let place = Place::new();
    place.write("map.npy", npy("<f8", false, "(64, 64)", &f8(&bumps(64))));
    let solve = ["solve", "--heights", "map.npy", "--cell", "3e-3", "--e-star", "1e9", "--pressure", "2e5", "--quiet"];
    assert_solved(&place.run(&[&solve[..], &["--out", "r"]].concat()));
    let output = place.run(&["export", "r", "--zarr", "--out", "z"]);
    assert_solved(&output);
    assert!(text(&output.stdout).trim_end().ends_with("fields.zarr"), "{}", text(&output.stdout));
    assert_eq!(place.names("z"), ["fields.zarr"]);
    let group = "z/fields.zarr";
    assert_eq!(
        place.names(group),
        [".zattrs", ".zgroup", ".zmetadata", "contact", "gap", "height", "pressure", "x", "y"]
    );
    assert_eq!(place.json(&format!("{group}/.zgroup")), json!({ "zarr_format": 2 }));
    let attributes = place.json(&format!("{group}/.zattrs"));
    assert_eq!((&attributes["cell"], &attributes["e_star"]), (&json!(3e-3), &json!(1e9)));
    assert_eq!(attributes["status"], "converged");
    for (name, file, units) in
        [("pressure", "pressure.npy", "Pa"), ("gap", "gap.npy", "m"), ("height", "heights.npy", "m")]
    {
        let (description, attributes, bytes) = array(&place, &format!("{group}/{name}"));
        let expected = json!({
            "zarr_format": 2, "shape": [64, 64], "chunks": [64, 64], "dtype": "<f8", "order": "C", "filters": null,
            "compressor": { "id": "zlib", "level": 1 }, "fill_value": null,
        });
        assert_eq!(description, expected, "{name}");
        assert_eq!(attributes["_ARRAY_DIMENSIONS"], json!(["y", "x"]), "{name}");
        assert_eq!(attributes["units"], units, "{name}");
        assert!(bytes == bytes_of(&field(&place, &format!("r/{file}"))), "{name} has other digits");
    }
    let (description, _, contact) = array(&place, &format!("{group}/contact"));
    assert_eq!(description["dtype"], "|u1");
    let pressure = field(&place, "r/pressure.npy");
    assert!(contact.iter().zip(pressure.values()).all(|(&contact, &p)| contact == u8::from(p > 0.0)));
    let (description, attributes, x) = array(&place, &format!("{group}/x"));
    assert_eq!((&description["shape"], &attributes["_ARRAY_DIMENSIONS"]), (&json!([64]), &json!(["x"])));
    assert_eq!(x[..8], (0.5 / 64.0 * 3e-3_f64).to_le_bytes(), "a value belongs to the centre of its element");
    // One file has the metadata of all arrays.
    let all = place.json(&format!("{group}/.zmetadata"));
    assert_eq!(all["zarr_consolidated_format"], 1);
    for (name, value) in all["metadata"].as_object().expect("an object") {
        assert_eq!(*value, place.json(&format!("{group}/{name}")), "{name}");
    }
    assert_eq!(all["metadata"].as_object().map(serde_json::Map::len), Some(2 + 2 * 6));
}

#[test]
fn large_fields_are_cut_into_chunks_and_put_together_again() {
    let place = Place::new();
    // Neither side is a multiple of the chunk, and one side is smaller than the chunk.
    let solve = ["solve", "--waves", "4", "--grid", "1500x600", "--pressure", "1e5", "--method", "uniform", "--quiet"];
    assert_solved(&place.run(&[&solve[..], &["--tolerance", "1e-2", "--out", "r"]].concat()));
    assert_solved(&place.run(&["export", "r", "--zarr", "--quiet"]));
    let (description, _, bytes) = array(&place, "r/fields.zarr/pressure");
    assert_eq!((&description["shape"], &description["chunks"]), (&json!([600, 1500]), &json!([600, 1024])));
    assert!(bytes == bytes_of(&field(&place, "r/pressure.npy")), "other digits");
    let (_, _, x) = array(&place, "r/fields.zarr/x");
    assert_eq!(x.len(), 8 * 1500);
}

#[test]
fn an_export_replaces_an_earlier_one_as_a_whole_and_no_other_folder() {
    let place = Place::new();
    assert_solved(&place.run(&small("1e5", &["--elements", "--out", "r"])));
    assert_solved(&place.run(&["export", "r", "--vtk", "--zarr", "--out", "z"]));
    assert_eq!(place.names("z"), ["elements.vtu", "fields.vti", "fields.zarr"]);
    place.write("z/fields.zarr/pressure/7.7", "a chunk of a larger field");
    assert_solved(&place.run(&["export", "r", "--zarr", "--out", "z"]));
    assert_eq!(place.names("z/fields.zarr/pressure"), [".zarray", ".zattrs", "0.0"]);
    std::fs::create_dir_all(place.path("other/fields.zarr")).expect("a folder");
    place.write("other/fields.zarr/mine", "mine");
    assert_refused(&place.run(&["export", "r", "--zarr", "--out", "other"]), "not a Zarr group");
    assert_eq!(place.names("other/fields.zarr"), ["mine"]);
    place.write("z/file", "");
    assert_refused(&place.run(&["export", "r", "--zarr", "--out", "z/file"]), "not a folder");
    assert_refused(&place.run(&["export", "z", "--zarr"]), "summary.json");
}
