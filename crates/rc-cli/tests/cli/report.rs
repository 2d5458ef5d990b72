//! `rc report`: pages of results.

use std::process::Command;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use serde_json::Value;

use crate::support::{Place, assert_refused, assert_solved, map, small, text};

/// The data in a page.
fn data(page: &str) -> Value {
    let (_, rest) = page.split_once("id=\"data\">").expect("the element with the data");
    serde_json::from_str(rest.split("</script>").next().expect("its end")).expect("valid JSON")
}

/// The data of a page. Fails if its file needs another file.
fn self_contained(place: &Place, name: &str) -> Value {
    let page = text(&place.bytes(name));
    let addresses = page.matches("http").count();
    assert_eq!(addresses, page.matches("\"http://www.w3.org/2000/svg\"").count() + 1, "an address that is no name");
    let (_, policy) = page.split_once("http-equiv=\"Content-Security-Policy\" content=\"").expect("the last of them");
    let policy = policy.split('"').next().expect("its end");
    assert!(policy.starts_with("default-src 'none';"), "{policy}");
    assert!(policy.ends_with("img-src data:"), "the picture of the leakage is data: {policy}");
    for word in ["src=", "href=", "@import", "url(data", "fetch("] {
        assert!(!page.contains(word), "{word} in the page");
    }
    assert!(page.len() < 2_500_000, "{} bytes", page.len());
    data(&page)
}

/// Runs a command line from a page.
fn repeat(place: &Place, line: &Value) {
    let line = line["text"].as_str().expect("a command line");
    let words: Vec<&str> = line.split(' ').collect();
    assert_eq!(words[0], "rc", "{line}");
    assert_solved(&place.run(&words[1..]));
}

#[test]
fn the_page_of_a_result_has_its_fields_and_the_commands_that_repeat_it() {
    let place = Place::new();
    assert_solved(&place.run(&small("1e5", &["--seed", "3", "--out", "r"])));
    assert_solved(&place.run(&["report", "r"]));
    let page = self_contained(&place, "r/report.html");
    assert_eq!((&page["kind"], &page["status"]), (&"result".into(), &"converged".into()));
    let field = &page["maps"]["pressure"];
    let bytes = STANDARD.decode(field["data"].as_str().expect("text")).expect("base64");
    let max = field["max"].as_f64().expect("a number");
    let stored = rc_heights::npy::read(&place.path("r/pressure.npy")).expect("the pressure");
    assert_eq!(bytes.len(), 2 * stored.grid().len());
    for (pair, p) in bytes.chunks(2).zip(stored.values()) {
        let shown = f64::from(u16::from_le_bytes([pair[0], pair[1]])) * max / 65535.0;
        assert!((shown - p).abs() <= max / 65535.0, "{p} is shown as {shown}");
        assert_eq!(shown > 0.0, *p > 0.0, "contact is shown as it is");
    }
    assert_eq!(page["maps"]["of_elements"], true);
    // The energy error and the load have limits. The other rows were not asked for.
    let rows = page["certificate"]["rows"].as_array().expect("rows");
    let holds: Vec<Option<bool>> = rows.iter().map(|row| row["holds"].as_bool()).collect();
    assert_eq!(holds, [Some(true), None, None, Some(true)]);
    assert_eq!(rows[3]["name"], "load");
    let counts = page["spots"]["counts"].as_array().expect("counts").iter().filter_map(Value::as_u64).sum::<u64>();
    assert_eq!(page["spots"]["rows"][0][1], counts.to_string().as_str(), "spots in the bins and in the table");
    let commands = page["commands"].as_array().expect("commands");
    assert_eq!(commands.len(), 2, "{commands:?}");
    for command in commands {
        repeat(&place, command);
        assert!(place.bytes("again/pressure.npy") == place.bytes("r/pressure.npy"), "{command} gives another result");
    }
}

#[test]
fn the_page_of_a_sweep_has_its_curves_and_the_command_that_repeats_it() {
    let place = Place::new();
    let sweep = ["sweep", "--waves", "8", "--grid", "64", "--pressures", "1e4:1e6:3", "--seeds", "1..2"];
    assert_solved(&place.run(&[&sweep[..], &["--quiet", "--out", "s"]].concat()));
    assert_solved(&place.run(&["report", "s", "--out", "page.html", "--quiet"]));
    let page = self_contained(&place, "page.html");
    assert_eq!(page["kind"], "sweep");
    let seeds = page["scenes"][0]["seeds"].as_array().expect("curves");
    assert_eq!((seeds.len(), seeds[0].as_array().map(Vec::len)), (2, Some(3)));
    let mean = |key: &str, i: usize| page["scenes"][0]["mean"][i][key].as_f64().expect("a number");
    assert!(mean("area", 0) < mean("area", 1) && mean("penetration", 1) < mean("penetration", 2), "curves rise");
    assert_eq!((&page["status"], &page["good"]), (&"all converged".into(), &true.into()));
    let whole = place.bytes("s/sweep.csv");
    let cut = whole[..whole.len() - 1].iter().rposition(|&byte| byte == b'\n').expect("lines") + 1;
    std::fs::create_dir(place.path("part")).expect("a folder");
    place.write("part/sweep.csv", &whole[..cut]);
    place.write("part/sweep.jsonl", place.bytes("s/sweep.jsonl"));
    assert_solved(&place.run(&["report", "part"]));
    assert_eq!(data(&text(&place.bytes("part/report.html")))["status"], "5 of 6 rows");
    repeat(&place, &page["commands"][0]);
    let without_times = |name: &str| -> Vec<String> {
        let table = text(&place.bytes(name));
        table.lines().map(|line| line.split(',').take(8).collect::<Vec<_>>().join(",")).collect()
    };
    assert_eq!(without_times("again/sweep.csv"), without_times("s/sweep.csv"));
}

#[test]
fn pages_of_full_contact_of_no_convergence_and_of_height_maps_are_made() {
    let place = Place::new();
    assert_solved(&place.run(&small("1e9", &["--out", "full"])));
    assert_solved(&place.run(&["surface", "--waves", "8", "--grid", "64", "--quiet", "--out", "map.npy"]));
    assert_solved(&place.run(&map("solve", "map.npy", &["--pressure", "1e5", "--quiet", "--out", "map"])));
    for folder in ["full", "map"] {
        assert_solved(&place.run(&["report", folder]));
        self_contained(&place, &format!("{folder}/report.html"));
    }
    let full = data(&text(&place.bytes("full/report.html")));
    assert_eq!(
        (&full["status"], full["maps"]["gap"]["max"].as_f64()),
        (&"full contact".into(), Some(0.0)),
        "rounding is no gap"
    );
    let page = data(&text(&place.bytes("map/report.html")));
    assert_eq!(page["commands"].as_array().map(Vec::len), Some(1), "flags alone do not bring a map back");
    let mut summary = place.json("map/summary.json");
    summary["status"] = "not_converged".into();
    place.write("map/summary.json", summary.to_string());
    assert_solved(&place.run(&["report", "map"]));
    assert_eq!(data(&text(&place.bytes("map/report.html")))["good"], false);
}

#[test]
fn means_over_blocks_are_not_taken_for_elements() {
    let place = Place::new();
    assert_solved(&place.run(&small("1e5", &["--output-grid", "32", "--out", "r"])));
    assert_solved(&place.run(&["report", "r"]));
    let page = self_contained(&place, "r/report.html");
    assert_eq!(page["maps"]["of_elements"], false);
    let says = page["maps"]["averaged"].as_str().expect("text");
    assert!(says.contains("32 x 32 means over blocks (output_grid) instead of values on 128 x 128 elements"), "{says}");
    let sections = page["surface"]["sections"].as_array().expect("sections");
    assert_eq!((sections.len(), page["surface"]["of_blocks"].as_bool()), (2, Some(true)));
    assert_eq!(sections[0]["points"].as_array().map(Vec::len), Some(32));
    // The elastic surface is above the mean of the rigid one by the mean gap, also in touched blocks.
    let gap = |point: &Value| point[2].as_f64().expect("a height") - point[1].as_f64().expect("a height");
    let points =
        sections[0]["points"].as_array().expect("points").iter().zip(sections[0]["contact"].as_array().expect("flags"));
    let of_touched: Vec<f64> = points.filter(|(_, touched)| **touched == true).map(|(point, _)| gap(point)).collect();
    assert!(
        !of_touched.is_empty() && of_touched.iter().all(|gap| *gap >= 0.0) && of_touched.iter().any(|gap| *gap > 0.0)
    );
    assert!(page["stress"].is_null() && page["spots"].is_null(), "what needs the elements is left out");
    assert_solved(&place.run(&["export", "r", "--quiet"]));
    let head = text(&place.bytes("r/fields.vti"));
    assert!(head.contains("Name=\"touched\"") && !head.contains("Name=\"contact\""), "{}", &head[..2000]);
    assert_solved(&place.run(&["export", "r", "--zarr", "--quiet", "--out", "z"]));
    let names = place.names("z/fields.zarr");
    assert!(names.contains(&"touched".to_owned()) && !names.contains(&"contact".to_owned()), "{names:?}");
}

#[test]
fn what_is_no_result_has_no_page() {
    let place = Place::new();
    assert_refused(&place.run(&["report", "nothing"]), "nothing");
    std::fs::create_dir(place.path("empty")).expect("a folder");
    assert_refused(&place.run(&["report", "empty"]), "give the --out folder of a solve, a sweep or a study");
    std::fs::create_dir(place.path("s")).expect("a folder");
    place.write("s/sweep.csv", "seed,control_value\n1,2\n");
    assert_refused(&place.run(&["report", "s"]), "sweep.csv");
    place.write("s/sweep.csv", "");
    assert_refused(&place.run(&["report", "s"]), "no rows");
    assert_eq!(place.names("s"), ["sweep.csv"], "something was written");
    assert_solved(&place.run(&small("1e5", &["--out", "r"])));
    assert_refused(&place.run(&["report", "r", "--out", "empty"]), "is a folder");
}

/// Draws the page in a browser, if this machine has Chromium.
///
/// No other test draws the page.
#[test]
#[expect(clippy::print_stderr, reason = "a test that looked at nothing says so")]
fn a_browser_draws_the_page() {
    let browsers = ["chromium", "chromium-browser", "google-chrome", "chrome"];
    let here = |name: &&str| Command::new(name).arg("--version").output().is_ok_and(|output| output.status.success());
    let Some(browser) = browsers.into_iter().find(here) else {
        eprintln!("no Chromium on this machine: the script of the page was not run");
        return;
    };
    let place = Place::new();
    assert_solved(&place.run(&small("1e5", &["--out", "r"])));
    assert_solved(&place.run(&["report", "r"]));
    let address = format!("file://{}", place.path("r/report.html").display());
    let flags = ["--headless", "--no-sandbox", "--disable-gpu", "--dump-dom"];
    let output = Command::new(browser).args(flags).arg(address).output().expect("the browser runs");
    let page = text(&output.stdout);
    assert!(page.contains("data-ready=\"yes\""), "the script failed: {}", text(&output.stderr));
    assert_eq!(page.matches("<div class=\"map\"").count(), 4, "maps");
    let charts = "two sections, two of both bodies, spectrum, heights, material ratio, stress and spots";
    assert_eq!(page.matches("class=\"legend\"").count(), 9, "{charts}");
    for text in ["3-D view", "download", "κ = ", "spectrum", "through the maximum pressure"] {
        assert!(page.contains(text), "{text} is not on the page");
    }
}

#[test]
fn the_page_of_a_result_has_its_surface_and_sections_through_both_bodies() {
    let place = Place::new();
    assert_solved(&place.run(&small("1e5", &["--seed", "3", "--out", "r"])));
    assert_solved(&place.run(&["report", "r"]));
    let page = self_contained(&place, "r/report.html");
    let summary = place.json("r/summary.json");
    let surface = &page["surface"];
    let kappa = page["kappa"].as_str().expect("a light load");
    let shown = kappa.split("p = ").nth(1).and_then(|rest| rest.split(' ').next()?.parse::<f64>().ok());
    assert!(shown.is_some_and(|shown| (1.5..2.6).contains(&shown)), "{kappa}");
    let max = summary["max_pressure"].as_f64().expect("a number");
    assert!((page["maps"]["pressure"]["max"].as_f64().expect("a number") / max - 1.0).abs() < 1e-9);
    let gap = rc_heights::npy::read(&place.path("r/gap.npy")).expect("the gap");
    let pressure = rc_heights::npy::read(&place.path("r/pressure.npy")).expect("the pressure");
    let n = gap.grid().nx();
    let peak =
        (0..gap.grid().len()).max_by(|a, b| pressure.values()[*a].total_cmp(&pressure.values()[*b])).expect("elements");
    let section = &surface["sections"][0];
    let points = section["points"].as_array().expect("points");
    assert_eq!((points.len(), &section["axis"]), (n, &"x".into()));
    for (ix, point) in points.iter().enumerate() {
        let [rigid, elastic] = [1, 2].map(|i| point[i].as_f64().expect("a number"));
        let i = peak / n * n + ix;
        let expected = if pressure.values()[i] > 0.0 { 0.0 } else { gap.values()[i] };
        assert!((elastic - rigid - expected).abs() < 1e-6 * gap.max(), "{ix}: {rigid}, {elastic}, gap {expected}");
        assert_eq!(section["contact"][ix], pressure.values()[i] > 0.0);
    }
    // Eight waves are too few for a power law.
    assert!(surface["law"].is_null(), "{}", surface["law"]);
    assert!(surface["material_ratio"].as_array().is_some_and(|curve| curve.len() > 50));
    assert!(surface["parameters"].to_string().contains("Sk, Spk, Svk"));
    assert!(surface["spectrum"].as_array().is_some_and(|spectrum| spectrum.len() > 3));
}

#[test]
fn a_mirrored_map_shows_its_measured_part_and_a_result_without_its_map_has_a_page() {
    let place = Place::new();
    assert_solved(&place.run(&["surface", "--waves", "8", "--grid", "32", "--quiet", "--out", "named.npy"]));
    assert_solved(&place.run(&["prepare", "named.npy", "--cell", "1e-3", "--out", "p"]));
    let solve = ["solve", "p", "--e-star", "1e9", "--pressure", "1e5", "--quiet", "--out", "r"];
    assert_solved(&place.run(&solve));
    assert_solved(&place.run(&["report", "r"]));
    let page = self_contained(&place, "r/report.html");
    let surface = &page["surface"];
    assert_eq!(surface["mirrored"], true);
    assert!(surface["note"].as_str().is_some_and(|note| note.contains("measured quarter")), "{}", surface["note"]);
    let source = surface["lines"][0].to_string();
    assert!(source.contains("named.npy; treatments: ") && source.contains("periodic mirror"), "{source}");
    std::fs::remove_file(place.path("r/heights.npy")).expect("the map");
    assert_solved(&place.run(&["report", "r"]));
    let page = self_contained(&place, "r/report.html");
    assert!(page["surface"].is_null() && page["kappa"].is_null());
    assert!(page["no_surface"].as_str().is_some_and(|cause| cause.contains("heights.npy")), "{}", page["no_surface"]);
}

#[test]
fn a_hardness_a_shape_and_a_layer_have_no_constant_of_the_area() {
    let place = Place::new();
    let sphere =
        ["solve", "--shape", "sphere", "--radius", "1e-2", "--cell", "1e-3", "--grid", "64", "--e-star", "1e9"];
    assert_solved(&place.run(&[&sphere[..], &["--pressure", "1e4", "--quiet", "--out", "sphere"]].concat()));
    assert_solved(&place.run(&small("1e5", &["--hardness", "1e8", "--out", "hard"])));
    assert_solved(&place.run(&small("1e5", &["--layer-thickness", "1e-2", "--out", "layer"])));
    for folder in ["sphere", "hard", "layer"] {
        assert_solved(&place.run(&["report", folder]));
        let page = self_contained(&place, &format!("{folder}/report.html"));
        assert!(page["kappa"].is_null(), "{folder}: {}", page["kappa"]);
        assert_eq!(page["surface"]["sections"].as_array().map(Vec::len), Some(2), "{folder}");
    }
}

#[test]
fn the_page_of_a_mean_has_its_levels_and_the_command_that_repeats_it() {
    let place = Place::new();
    let mean = ["sweep", "--waves", "8", "--grid", "128", "--pressures", "2e5,4e5", "--error-of-mean", "10%"];
    assert_solved(&place.run(&[&mean[..], &["--quiet", "--out", "m"]].concat()));
    assert_solved(&place.run(&["report", "m"]));
    let page = self_contained(&place, "m/report.html");
    assert_eq!((&page["kind"], &page["status"], &page["good"]), (&"mean".into(), &"converged".into(), &true.into()));
    let means = place.json("m/mean.json");
    for (drawn, mean) in page["means"].as_array().expect("means").iter().zip(means.as_array().expect("means")) {
        assert_eq!((&drawn["load"], &drawn["mean"]), (&mean["control_value"], &mean["mean"]));
        let [error, statistics, grid] = [&drawn["error"], &mean["standard_error"], &mean["grid_error"]]
            .map(|value| value.as_f64().expect("a number"));
        assert!((error / statistics.hypot(grid) - 1.0).abs() < 1e-12, "{error}: {statistics}, {grid}");
        let variances: Vec<&Value> =
            mean["levels"].as_array().expect("levels").iter().map(|level| &level["variance"]).collect();
        assert_eq!(drawn["variances"].as_array().expect("variances").iter().collect::<Vec<_>>(), variances);
        assert_eq!(drawn["levels"].as_array().map(Vec::len), Some(variances.len()));
    }
    assert_eq!(page["rows"].as_array().map(Vec::len), Some(2));
    let first = means[0]["mean"].as_f64().expect("a number");
    let shown = page["rows"][0][1].as_str().and_then(|text| text.split(' ').next()?.parse::<f64>().ok());
    assert!(shown.is_some_and(|shown| (shown / first - 1.0).abs() < 0.2), "{first} is shown as {shown:?}");
    repeat(&place, &page["commands"][0]);
    assert!(place.bytes("again/mean.json") == place.bytes("m/mean.json"), "{} gives other means", page["commands"][0]);
    // Interrupted: there are solves, and no mean.
    std::fs::remove_file(place.path("m/mean.json")).expect("a file");
    assert_refused(&place.run(&["report", "m"]), "has no mean.json yet: the mean is not finished");
}
