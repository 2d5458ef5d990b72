//! Cases solved to 1e-10 by two independent programs (`data/reference/README.md`).

use rc_core::{Field, Grid};
use rc_kernel::Spectral;
use rc_solver::Control;
use serde::Deserialize;

use crate::{data_path, solved};

#[derive(Deserialize)]
struct Case {
    mean_pressure: f64,
    area_fraction_cells: f64,
    perimeter_edges: usize,
    rms_pressure: f64,
    max_pressure: f64,
    penetration: f64,
    mean_gap: f64,
    h_max: f64,
    heights: String,
}

fn heights(name: &str) -> Field {
    let path = data_path("reference").join(name);
    let bytes = std::fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let file = npyz::NpyFile::new(&bytes[..]).expect("an npy file");
    let (ny, nx) = (file.shape()[0] as usize, file.shape()[1] as usize);
    let values = file.into_vec::<f64>().expect("f64 values");
    Field::new(Grid::new(nx, ny).expect("grid"), values).expect("shape of the file")
}

fn assert_close(what: &str, case: usize, value: f64, reference: f64, relative: f64) {
    let error = (value / reference - 1.0).abs();
    assert!(error <= relative, "case {case}: {what} is {value:e}, reference {reference:e}, off by {error:.1e}");
}

#[test]
fn spectral_solutions_agree_with_independent_programs() {
    let text = std::fs::read_to_string(data_path("reference/spectral-256.json")).expect("reference cases");
    let cases: Vec<Case> = serde_json::from_str(&text).expect("reference cases parse");
    for (number, case) in cases.iter().enumerate() {
        let heights = heights(&case.heights);
        let control = Control::MeanPressure(case.mean_pressure);
        let solution = solved(&heights, &Spectral, control, 1e-9);
        let observed = solution.observables();
        let area = observed.area.cells;
        assert!((area - case.area_fraction_cells).abs() <= 2e-4, "case {number}: area {area}");
        let edges = observed.area.perimeter_edges.abs_diff(case.perimeter_edges);
        assert!(edges <= 16, "case {number}: perimeter {} edges", observed.area.perimeter_edges);
        assert_close("h_max", number, heights.max(), case.h_max, 1e-14);
        assert_close("rms pressure", number, observed.rms_pressure, case.rms_pressure, 1e-6);
        assert_close("max pressure", number, observed.max_pressure, case.max_pressure, 1e-5);
        assert_close("penetration", number, solution.info().penetration, case.penetration, 1e-6);
        assert!((observed.mean_gap - case.mean_gap).abs() <= 1e-6 * case.h_max, "case {number}: mean gap");
    }
}
