//! Contact under the pressure of a fluid.

use crate::support::{Place, assert_refused, assert_solved};

/// E* is a power of two, so that loads add up without rounding.
const SCENE: [&str; 8] = ["solve", "--waves", "8", "--grid", "64", "--e-star", "1073741824", "--quiet"];

fn with<'a>(more: &[&'a str]) -> Vec<&'a str> {
    [&SCENE[..], more].concat()
}

/// Lines of 64 values (Pa), the value of each element from its row and column.
fn map(value: impl Fn(usize, usize) -> f64) -> String {
    let line = |iy| (0..64).map(|ix| format!("{}", value(iy, ix))).collect::<Vec<_>>().join(" ");
    (0..64).map(line).collect::<Vec<_>>().join("\n")
}

fn number(summary: &serde_json::Value, key: &str) -> f64 {
    summary[key].as_f64().unwrap_or_else(|| panic!("{key}: {}", summary[key]))
}

#[test]
fn a_uniform_fluid_is_the_contact_under_the_rest_of_the_load() {
    let place = Place::new();
    place.write("fluid.txt", map(|_, _| 262_144.0));
    for method in ["adaptive", "uniform"] {
        let fluid = ["--pressure", "1048576", "--fluid-pressure", "fluid.txt", "--method", method, "--out", "wet"];
        assert_solved(&place.run(&with(&fluid)));
        assert_solved(&place.run(&with(&["--pressure", "786432", "--method", method, "--out", "dry"])));
        assert!(place.bytes("wet/pressure.npy") == place.bytes("dry/pressure.npy"), "{method}");
        assert!(place.bytes("wet/gap.npy") == place.bytes("dry/gap.npy"), "{method}");
        let [wet, dry] = ["wet", "dry"].map(|folder| place.json(&format!("{folder}/summary.json")));
        for key in ["area_fraction", "rms_pressure", "max_pressure", "mean_gap", "penetration", "contact_stiffness"] {
            assert_eq!(wet[key], dry[key], "{method}: {key}");
        }
        let parts = ["mean_pressure", "mean_fluid_pressure", "mean_contact_pressure"].map(|key| number(&wet, key));
        for (found, expected) in parts.into_iter().zip([1_048_576.0, 262_144.0, 786_432.0]) {
            assert!((found / expected - 1.0).abs() < 1e-9, "{method}: {found} for {expected}");
        }
        assert!(dry.get("mean_fluid_pressure").is_none(), "{method}");
    }
}

#[test]
fn a_result_under_a_fluid_is_repeated_by_its_scene_and_drawn() {
    let place = Place::new();
    place.write("fluid.txt", map(|iy, ix| 1e4 * (ix + iy / 8) as f64));
    let free = ["--boundary", "free", "--penetration", "10um", "--fluid-pressure", "fluid.txt", "--out", "wet"];
    assert_solved(&place.run(&with(&free)));
    assert_solved(&place.run(&["solve", "wet/scene.toml", "--out", "twin", "--quiet"]));
    for name in ["pressure.npy", "gap.npy", "fluid_pressure.npy", "scene.toml"] {
        assert!(place.bytes(&format!("wet/{name}")) == place.bytes(&format!("twin/{name}")), "{name}");
    }
    let summary = place.json("wet/summary.json");
    assert!((number(&summary, "penetration") / 1e-5 - 1.0).abs() < 1e-9, "{summary}");
    for command in
        [&["report", "wet", "--quiet"][..], &["plot", "wet", "--quiet"], &["export", "wet", "--vtk", "--quiet"]]
    {
        assert_solved(&place.run(command));
    }
    assert_solved(&place.run(&with(&["--pressure", "1e5", "--out", "wet"])));
    assert!(!place.names("wet").contains(&"fluid_pressure.npy".to_owned()), "a file of the solve before is left");
    assert_solved(&place.run(&["solve", "twin/scene.toml", "--dry-run", "--quiet"]));
}

#[test]
fn a_fluid_that_cannot_be_solved_under_is_refused_in_one_line() {
    let place = Place::new();
    place.write("fluid.txt", map(|_, ix| 1e4 * ix as f64));
    place.write("small.txt", "1 2 3\n4 5 6\n7 8 9\n");
    place.write("negative.txt", map(|iy, ix| if (iy, ix) == (2, 5) { -1.0 } else { 1.0 }));
    let cases = [
        (
            &["--pressure", "1e6", "--fluid-pressure", "small.txt"][..],
            "3 x 3 values, but the solve has 64 x 64 elements",
        ),
        (&["--pressure", "1e6", "--fluid-pressure", "negative.txt"], "row 2, column 5 (from 0) is -1"),
        (&["--pressure", "1e6", "--fluid-pressure", "absent.txt"], "absent.txt"),
        (&["--pressure", "3e5", "--fluid-pressure", "fluid.txt"], "fluid_pressure: its mean, 315000 Pa, already bears"),
        (&["--pressure", "1e6", "--fluid-pressure", "fluid.txt", "--hardness", "1e7"], "fluid_pressure: "),
        (&["--pressure", "1e6", "--fluid-pressure", "fluid.txt", "--border-level", "1"], "fluid_pressure: "),
    ];
    for (more, expected) in cases {
        assert_refused(&place.run(&with(more)), expected);
    }
    let sweep = ["sweep", "--waves", "8", "--grid", "64", "--pressures", "1e5,1e6", "--fluid-pressure", "fluid.txt"];
    assert_refused(
        &place.run(&[&sweep[..], &["--out", "s"]].concat()),
        "fluid_pressure: the pressure of a fluid cannot",
    );
}
