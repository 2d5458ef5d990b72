//! Layers and patches: keys, files, sweeps, pages, refusals.

use serde_json::Value;

use crate::solve::assert_close;
use crate::support::{Place, assert_refused, assert_solved, bumps, f8, npy, text};

const LAYER: [&str; 2] = ["--layer-thickness", "3e-4"];
const MAP: [&str; 8] = ["--heights", "map.npy", "--cell", "1e-3", "--e-star", "1e9", "--boundary", "free"];

/// A folder with a map.
fn place() -> Place {
    let place = Place::new();
    place.write("map.npy", npy("<f8", false, "(64, 64)", &f8(&bumps(64))));
    place.write("flat.npy", npy("<f8", false, "(32, 32)", &f8(&[0.5; 1024])));
    place
}

/// The summary of `rc solve` with these arguments.
fn summary(place: &Place, words: &[&str]) -> Value {
    let solved = place.run(&[&["solve", "--quiet", "--json"], words].concat());
    assert_solved(&solved);
    serde_json::from_slice(&solved.stdout).expect("a summary")
}

fn number(summary: &Value, key: &str) -> f64 {
    summary[key].as_f64().unwrap_or_else(|| panic!("{key} is {}", summary[key]))
}

#[test]
fn a_layer_is_compressed_by_the_mean_pressure() {
    let place = place();
    let small = ["--waves", "8", "--grid", "128", "--pressure", "4e5"];
    let on_half_space = summary(&place, &[&small[..], &["--method", "uniform"]].concat());
    let on_layer = summary(&place, &[&small[..], &LAYER, &["--out", "layer"]].concat());
    let reason = on_layer["method_reason"].as_str().expect("a reason");
    assert!(reason.starts_with("uniform: the base grid of the adaptive method is too coarse"), "{reason}");
    assert!(number(&on_layer, "area_fraction") < number(&on_half_space, "area_fraction"), "a layer is stiffer");
    // This is uniaxial compression with the example's 0.4 GPa and 0.45.
    let compressed = 4e5 * 3e-4 * (1.45 * 0.1) / (0.55 * 0.4e9);
    let gap = number(&on_layer, "penetration_full_contact") - number(&on_layer, "penetration") + compressed;
    assert_close("mean gap", number(&on_layer, "mean_gap"), gap, 1e-9);
    let field = rc_heights::npy::read(&place.path("layer/gap.npy")).expect("a field");
    let overlap = field.mean() / gap - 1.0;
    assert!((-1e-12..1e-8).contains(&overlap), "gaps of the file are at least zero: {overlap:e}");
    let scene = text(&place.bytes("layer/scene.toml"));
    assert!(scene.contains("layer_thickness = 0.0003") && !scene.contains("boundary"), "{scene}");
    assert_solved(&place.run(&["solve", "layer/scene.toml", "--out", "again", "--quiet"]));
    assert!(place.bytes("layer/pressure.npy") == place.bytes("again/pressure.npy"));
    let thick = summary(&place, &[&small[..], &["--layer-thickness", "1"]].concat());
    assert_close("a thick layer", number(&thick, "area_fraction"), number(&on_half_space, "area_fraction"), 1e-4);
}

#[test]
fn poissons_ratio_of_a_layer_is_that_of_its_material() {
    let place = place();
    let small = ["--waves", "8", "--grid", "128", "--pressure", "4e5", "--layer-thickness", "3e-4"];
    let with = |more: &[&str]| summary(&place, &[&small[..], more].concat());
    let [by_material, by_layer] = [with(&["--poisson", "0.3"]), with(&["--layer-poisson", "0.3"])];
    assert_eq!(by_material["area_fraction"], by_layer["area_fraction"]);
    assert_eq!(by_material["penetration"], by_layer["penetration"]);
    let e_star = format!("{}", 0.4e9 / (1.0 - 0.09));
    let by_e_star = with(&["--e-star", &e_star, "--layer-poisson", "0.3"]);
    assert_close("area", number(&by_e_star, "area_fraction"), number(&by_layer, "area_fraction"), 1e-9);
    let refused = place.run(&[&["solve"], &small[..], &["--e-star", "1e9"]].concat());
    assert_refused(&refused, "layer_poisson: is missing; e_star does not contain");
    let thin = ["solve", "--waves", "8", "--grid", "128", "--pressure", "1e5", "--layer-thickness", "1e-5"];
    assert_refused(
        &place.run(&thin),
        "layer_thickness: 1e-5 m is below 0.25 of the side of an element (7.8125e-5 m, 128 x 128 elements)",
    );
}

#[test]
fn a_patch_has_a_result_like_any_other() {
    let place = place();
    let solved = place.run(&[&["solve"], &MAP[..], &["--pressure", "2e6", "--out", "patch"]].concat());
    assert_solved(&solved);
    assert!(text(&solved.stdout).contains("mean displacement"), "{}", text(&solved.stdout));
    let found = place.json("patch/summary.json");
    let reason = found["method_reason"].as_str().expect("a reason");
    assert!(reason.starts_with("uniform: it is cheaper on this grid"), "{reason}");
    let [pressure, gap] = ["pressure", "gap"]
        .map(|name| rc_heights::npy::read(&place.path(&format!("patch/{name}.npy"))).expect("a field"));
    assert_close("load", pressure.mean(), 2e6, 1e-10);
    assert_close("mean gap", gap.mean(), number(&found, "mean_gap"), 1e-9);
    let scene = text(&place.bytes("patch/scene.toml"));
    assert!(scene.contains("boundary = \"free\""), "{scene}");
    assert_solved(&place.run(&["solve", "patch/scene.toml", "--out", "again", "--quiet", "--threads", "1"]));
    assert!(place.bytes("patch/pressure.npy") == place.bytes("again/pressure.npy"));
    for words in [&["report", "patch"][..], &["export", "patch", "--vtk"], &["plot", "patch"], &["inspect", "patch"]] {
        assert_solved(&place.run(words));
    }
    let words = ["--pressure", "2e6", "--method", "adaptive", "--out", "adaptive"];
    let adaptive = summary(&place, &[&MAP[..], &words].concat());
    for key in ["area_fraction", "penetration", "mean_gap", "elastic_energy", "rms_pressure"] {
        assert_close(key, number(&adaptive, key), number(&found, key), 1e-4);
    }
    assert_eq!((&adaptive["method"], adaptive["iterations"].is_u64()), (&Value::from("adaptive"), true));
    assert_solved(&place.run(&["report", "adaptive"]));
    let periodic = summary(&place, &[&MAP[..6], &["--pressure", "2e6", "--boundary", "periodic"]].concat());
    assert!(number(&periodic, "penetration") < number(&found, "penetration"), "a patch sinks as a whole");
    let by_depth = format!("{}", number(&found, "penetration"));
    let by_depth = summary(&place, &[&MAP[..], &["--penetration", &by_depth]].concat());
    assert_close("load", number(&by_depth, "mean_pressure"), 2e6, 1e-3);
}

/// A flat patch in contact everywhere is a flat punch, with F = 1.1523 E* δ side.
///
/// A patch does not have a full contact beyond it.
#[test]
fn a_flat_patch_is_a_punch() {
    let place = place();
    let flat = ["--heights", "flat.npy", "--cell", "1e-3", "--e-star", "1e9"];
    let found =
        summary(&place, &[&flat[..], &["--boundary", "free", "--penetration", "1e-6", "--out", "punch"]].concat());
    assert_close("load", number(&found, "mean_pressure"), 1.1523e6, 1.5e-2);
    assert_close("stiffness", number(&found, "contact_stiffness"), 1.1523e12, 1.5e-2);
    assert_close("area", number(&found, "area_fraction"), 1.0, 1e-12);
    assert_solved(&place.run(&["report", "punch"]));
    assert_refused(&place.run(&[&["solve"], &flat[..], &["--pressure", "1e6"]].concat()), "a flat surface");
}

#[test]
fn sweeps_solve_layers_and_patches() {
    let place = place();
    let loads = ["--pressures", "1e5,1e6", "--quiet"];
    let patch = [&["sweep"], &MAP[..], &loads, &["--out", "patches"]].concat();
    assert_solved(&place.run(&patch));
    let layers = ["sweep", "--waves", "8", "--grid", "128", "--seeds", "1..2", "--out", "layers"];
    assert_solved(&place.run(&[&layers[..], &loads, &LAYER].concat()));
    for (folder, rows) in [("patches", 2), ("layers", 4)] {
        let table = text(&place.bytes(&format!("{folder}/sweep.csv")));
        assert_eq!(table.lines().count(), 1 + rows, "{table}");
        assert_eq!(table.matches("converged").count(), rows, "{table}");
    }
    let single = summary(&place, &[&MAP[..], &["--pressure", "1e6"]].concat());
    let table = text(&place.bytes("patches/sweep.csv"));
    let penetration = format!(",{:e},", number(&single, "penetration"));
    assert!(table.contains(&penetration), "{penetration} is not in {table}");
}

#[test]
fn layers_and_patches_have_a_hardness() {
    let place = place();
    let layer = ["--waves", "8", "--grid", "128", "--pressure", "4e5", "--layer-thickness", "3e-4"];
    let patch = [&MAP[..], &["--pressure", "2e6"]].concat();
    for (folder, words) in [("layer", &layer[..]), ("patch", &patch)] {
        let elastic = summary(&place, words);
        let hardness = format!("{:e}", 0.5 * number(&elastic, "max_pressure"));
        let solved = place.run(&[&["solve"], words, &["--hardness", &hardness, "--out", folder]].concat());
        assert_solved(&solved);
        let found = place.json(&format!("{folder}/summary.json"));
        assert!(number(&found, "plastic_area_fraction") > 0.0, "{folder}: {found}");
        assert!(number(&found, "area_fraction") > number(&elastic, "area_fraction"), "{folder}: {found}");
        let gap = rc_heights::npy::read(&place.path(&format!("{folder}/gap.npy"))).expect("a field");
        assert_close("mean gap", gap.mean(), number(&found, "mean_gap"), 1e-6);
        let displacement = number(&found, "mean_gap") - number(&found, "mean_plastic_gap")
            + number(&found, "penetration")
            - number(&found, "penetration_full_contact");
        let said = format!("mean displacement {}", rc_core::quantity::engineering(displacement, "m"));
        assert!(text(&solved.stdout).contains(&said), "{folder}: {said} is not in {}", text(&solved.stdout));
        assert_solved(&place.run(&["report", folder]));
    }
    let soft = place.run(&[&["solve"], &patch[..], &["--hardness", "1e6"]].concat());
    assert_refused(&soft, "hardness: 1000000 Pa cannot bear a mean pressure of 2000000 Pa");
}

#[test]
fn both_methods_solve_a_layer_that_the_base_grid_resolves() {
    let place = place();
    let words = ["--waves", "16", "--grid", "256", "--pressure", "4e5", "--energy-tolerance", "1e-3"];
    let of = |method| summary(&place, &[&words[..], &["--layer-thickness", "1.25e-3", "--method", method]].concat());
    let [adaptive, uniform] = [of("adaptive"), of("uniform")];
    assert_close("area", number(&adaptive, "area_fraction"), number(&uniform, "area_fraction"), 3e-4);
    assert_close("penetration", number(&adaptive, "penetration"), number(&uniform, "penetration"), 1e-4);
    let thin = [&["solve"], &words[..6], &["--layer-thickness", "2e-4", "--method", "adaptive"]].concat();
    assert_refused(
        &place.run(&thin),
        "layer_thickness: 2e-4 m is too thin for the base grid of the adaptive method; give at least 4.00e-4 m, or --method uniform",
    );
    let thick_enough = [&["solve", "--quiet"], &words[..6], &["--layer-thickness", "4e-4", "--method", "adaptive"]];
    assert_solved(&place.run(&thick_enough.concat()));
}

#[test]
fn a_coating_is_the_half_space_or_a_layer_in_its_limits() {
    let place = place();
    let words = ["--waves", "8", "--grid", "128", "--young", "4e8", "--poisson", "0.45", "--pressure", "4e5"];
    let uniform = ["--method", "uniform", "--energy-tolerance", "1e-4"];
    let rms = |more: &[&str]| number(&summary(&place, &[&words[..], &uniform, more].concat()), "rms_pressure");
    let coated =
        |young, poisson| ["--layer-thickness", "1e-3", "--substrate-young", young, "--substrate-poisson", poisson];
    assert_close("one material", rms(&coated("4e8", "0.45")), rms(&[]), 1e-5);
    assert_close("a stiff substrate", rms(&coated("4e14", "0.3")), rms(&["--layer-thickness", "1e-3"]), 1e-3);
    let soft = [&words[..], &coated("4MPa", "0.3"), &["--out", "soft"]].concat();
    let found = summary(&place, &soft);
    let scene = text(&place.bytes("soft/scene.toml"));
    assert!(scene.contains("substrate_young = 4000000.0") && scene.contains("substrate_poisson = 0.3"), "{scene}");
    assert_solved(&place.run(&["solve", "soft/scene.toml", "--out", "again", "--quiet"]));
    assert!(place.bytes("soft/pressure.npy") == place.bytes("again/pressure.npy"));
    assert!(number(&found, "rms_pressure") < rms(&[]), "a soft substrate spreads the load");
    assert_solved(&place.run(&["report", "soft"]));
}

#[test]
fn a_bad_coating_is_refused_in_one_line() {
    let place = place();
    let on = ["--layer-thickness", "1e-3"];
    for (layer, more, expected) in [
        (false, "--substrate-young 1e9 --substrate-poisson 0.3", "substrate_young: is given without layer_thickness"),
        (true, "--substrate-young 1e9", "substrate_poisson: is missing"),
        (true, "--substrate-poisson 0.3", "substrate_young: is missing"),
        (true, "--substrate-young 1e9 --substrate-poisson 0.51", "substrate_poisson: must be from 0 to 0.5, not 0.51"),
        (true, "--substrate-young 1e9 --substrate-poisson -0.1", "substrate_poisson: must be from 0 to 0.5, not -0.1"),
        (true, "--substrate-young 0 --substrate-poisson 0.3", "substrate_young: must be positive"),
        (true, "--substrate-young -1 --substrate-poisson 0.3", "substrate_young: must be positive"),
        (true, "--substrate-young 1e9 --substrate-poisson 0.3 --boundary free", "boundary: free borders cannot be"),
        (
            true,
            "--substrate-young 1e9 --substrate-poisson 0.3 --young2 1e9 --poisson2 0.3",
            "young2: a layer is pressed",
        ),
        (
            true,
            "--substrate-young 1e9 --substrate-poisson 0.3 --speed 1 --glassy-ratio 9 --relaxation-time 1e-3",
            "speed: a sliding surface cannot be combined with a coating on an elastic substrate",
        ),
        (
            true,
            "--substrate-young 1e9 --substrate-poisson 0.3 --method gauss-seidel",
            "method: the method gauss-seidel cannot be combined with an elastic layer",
        ),
    ] {
        let words: Vec<&str> = more.split(' ').collect();
        let layer = if layer { &on[..] } else { &[] };
        let small = ["solve", "--waves", "8", "--grid", "128", "--pressure", "1e5"];
        assert_refused(&place.run(&[&small[..], layer, &words].concat()), expected);
    }
    let times = ["sweep", "--waves", "8", "--grid", "128", "--pressures", "1e5", "--times", "1,2", "--out", "creep"];
    let rubber =
        ["--glassy-ratio", "9", "--relaxation-time", "1", "--substrate-young", "1e9", "--substrate-poisson", "0"];
    assert_refused(&place.run(&[&times[..], &on, &rubber].concat()), "times: a coating creeps");
}

/// A layer has a flow as a half-space has, but no conductance.
///
/// Current spreads in the two bodies behind the contact, whose size is that of the cell.
#[test]
fn a_layer_leaks_and_conducts_by_its_spots() {
    let place = place();
    let small = ["--waves", "8", "--grid", "128", "--pressure", "4e5", "--leakage"];
    let on_half_space = summary(&place, &[&small[..], &["--method", "uniform"]].concat());
    let solved = place.run(&[&["solve"], &small[..], &LAYER, &["--out", "layer"]].concat());
    assert_solved(&solved);
    assert!(text(&solved.stdout).contains("\n  conductance  "), "{}", text(&solved.stdout));
    let on_layer = place.json("layer/summary.json");
    let [of_layer, of_half_space] = [&on_layer, &on_half_space].map(|found| number(found, "contact_conductance"));
    assert!(of_layer < of_half_space, "{of_layer}, {of_half_space}: fewer spots");
    // Another program solved the potential of these spots with the symbol 2/|q|.
    assert_close("conductance of the spots", of_layer, 56.8735, 0.01);
    let permeance = |summary: &Value| summary["leakage"]["permeance"][0].as_f64().expect("a permeance");
    assert!(permeance(&on_layer) > permeance(&on_half_space), "less contact, and a wider gap");
}

#[test]
fn what_does_not_go_with_a_patch_is_refused() {
    let place = place();
    for (more, expected) in [
        (
            &["--kernel", "spectral"][..],
            "kernel: the kernel spectral cannot be combined with free borders: its waves are periodic",
        ),
        (
            &["--method", "gauss-seidel"],
            "method: the method gauss-seidel cannot be combined with free borders: it solves on a periodic cell only; give adaptive or uniform",
        ),
        (
            &["--layer-thickness", "1e-3", "--layer-poisson", "0.3"],
            "boundary: free borders cannot be combined with an elastic layer",
        ),
        (&["--viscosity", "1mPas"], "viscosity: the flow in m³/s also needs pressure_drop"),
        (&["--penetration", "-1"], "penetration"),
        (&["--boundary", "open"], "boundary"),
    ] {
        let load = if more[0] == "--penetration" { &[][..] } else { &["--pressure", "1e6"] };
        let map = if more[0] == "--boundary" { &MAP[..6] } else { &MAP[..] };
        let refused = place.run(&[&["solve"], map, load, more].concat());
        assert_eq!(refused.status.code(), Some(2), "{more:?}: {}", text(&refused.stderr));
        assert!(text(&refused.stderr).contains(expected), "{more:?}: {}", text(&refused.stderr));
    }
}
