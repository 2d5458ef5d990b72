//! Partial slip: `rc solve --friction` and `rc shear`.

use serde_json::Value;

use crate::support::{Place, assert_refused, assert_solved, text};

/// A small problem on rubber.
const RUBBER: &str = "--waves 8 --grid 64 --young 3MPa --poisson 0.5";

fn run(place: &Place, words: &str) -> std::process::Output {
    place.run(&words.split_whitespace().collect::<Vec<_>>())
}

fn number(json: &Value, key: &str) -> f64 {
    json[key].as_f64().unwrap_or_else(|| panic!("no {key}"))
}

/// Cattaneo and Mindlin: stick area over contact area is (1 - τ/μσ0)^(2/3).
#[test]
fn a_sphere_slips_as_mindlin_says() {
    let place = Place::new();
    for part in [0.25_f64, 0.5, 0.75] {
        let shear = part * 0.3e-3;
        let words = format!(
            "solve --shape sphere --radius 1 --cell 1 --grid 256 --boundary free --young 1 --poisson 0 --pressure 1e-3 --friction .3 \
             --shear-pressure {shear} --quiet --out r"
        );
        assert_solved(&run(&place, &words));
        let summary = place.json("r/summary.json");
        let ratio = number(&summary, "stick_area_fraction") / number(&summary, "area_fraction");
        let expected = (1.0 - part).powf(2.0 / 3.0);
        assert!((ratio / expected - 1.0).abs() < 0.02, "{part}: {ratio} for {expected}");
        assert!((number(&summary, "shear_pressure") / shear - 1.0).abs() < 1e-9);
        let stiffness = number(&summary, "tangential_stiffness") / number(&summary, "contact_stiffness");
        assert!((stiffness - 1.0).abs() < 1e-12, "{stiffness}");
    }
}

#[test]
fn the_files_of_a_shear_belong_together() {
    let place = Place::new();
    let words =
        format!("solve {RUBBER} --pressure 20kPa --friction 0.4 --shear-pressure 3kPa --shear-angle 90 --out r");
    let output = run(&place, &words);
    assert_solved(&output);
    assert!(text(&output.stdout).contains("stick, slip area"), "{}", text(&output.stdout));
    assert!(!text(&output.stderr).contains("note"), "rubber is uncoupled");
    let read = |name: &str| rc_heights::npy::read(&place.path(name)).expect("a field").into_values();
    let [x, y, slip, pressure] = ["r/shear_x.npy", "r/shear_y.npy", "r/slip.npy", "r/pressure.npy"].map(read);
    let mean = y.iter().sum::<f64>() / y.len() as f64;
    assert!((mean / 3e3 - 1.0).abs() < 1e-9, "{mean} Pa");
    let (mut slips, mut sticks) = (0, 0);
    for i in 0..x.len() {
        let (traction, limit) = (x[i].hypot(y[i]), 0.4 * pressure[i]);
        assert!(traction <= limit * (1.0 + 1e-9));
        slips += usize::from(slip[i] > 0.0);
        sticks += usize::from(pressure[i] > 0.0 && slip[i] == 0.0);
        assert!(slip[i] == 0.0 || traction >= limit * (1.0 - 1e-6), "slip below the friction");
    }
    let summary = place.json("r/summary.json");
    let part = number(&summary, "stick_area_fraction") / number(&summary, "area_fraction");
    let counted = sticks as f64 / (sticks + slips) as f64;
    assert!((part - counted).abs() < 1e-12, "{part} for {counted}");
    assert!(number(&summary, "shear_error") <= 0.01 && number(&summary, "shear_rounds") > 0.0);
    // The page has the map, and the scene repeats the result.
    assert_solved(&run(&place, "report r --quiet"));
    assert!(text(&place.bytes("r/report.html")).contains("Stick and slip"));
    assert_solved(&run(&place, "solve r --quiet --out again"));
    for name in ["shear_x.npy", "slip.npy"] {
        assert!(place.bytes(&format!("r/{name}")) == place.bytes(&format!("again/{name}")), "{name}");
    }
    // Without friction, the files of the shear are gone.
    assert_solved(&run(&place, &format!("solve {RUBBER} --pressure 20kPa --quiet --out again")));
    assert!(!place.names("again").contains(&"slip.npy".to_owned()), "{:?}", place.names("again"));
}

#[test]
fn a_shear_that_cannot_be_is_refused_with_its_key() {
    let place = Place::new();
    let solve = |more: &str| {
        let poisson = if more.contains("--poisson") { "" } else { "--poisson 0.5" };
        run(&place, &format!("solve --waves 8 --grid 64 --young 3MPa --pressure 20kPa {poisson} {more}"))
    };
    for (more, expected) in [
        ("--friction 0.4", "friction: Coulomb's coefficient belongs to a shear"),
        ("--shear-pressure 1kPa", "shear_pressure: a shear needs friction"),
        ("--uncoupled", "uncoupled: a shear needs friction"),
        ("--friction 0 --shear-pressure 1kPa", "friction: must be above 0"),
        ("--friction 0.4 --shear-pressure -1", "shear_pressure: must be positive"),
        (
            "--friction 0.4 --shear-pressure 8kPa",
            "shear_pressure: 8 kPa slides as a whole, because friction holds 8 kPa",
        ),
        ("--friction 0.4 --shear-displacement 1m", "shear_displacement: at 1 m the surface slides as a whole"),
        (
            "--friction 0.4 --shear-pressure 1kPa --shear-displacement 1nm",
            "shear_displacement: give it or shear_pressure",
        ),
        ("--friction 0.4 --shear-pressure 1kPa --shear-angle nan", "shear_angle: must be an angle"),
        ("--friction 0.4 --shear-pressure 1kPa --poisson 0.3", "friction: these bodies couple pressure and traction"),
        (
            "--friction 0.4 --shear-pressure 1kPa --hardness 1MPa",
            "friction: friction with partial slip cannot be combined with a hardness",
        ),
        (
            "--friction 0.4 --shear-pressure 1kPa --layer-thickness 1mm",
            "friction: friction with partial slip cannot be combined with an elastic layer",
        ),
        (
            "--friction 0.4 --shear-pressure 1kPa --method gauss-seidel",
            "method: the method gauss-seidel cannot be combined",
        ),
        (
            "--friction 0.4 --shear-pressure 1kPa --speed 1 --glassy-ratio 9 --relaxation-time 1",
            "cannot be combined with a sliding surface",
        ),
        ("--friction 0.4 --shear-pressure 1e-9", "shear_pressure: 1e-9 Pa cannot be told from no shear"),
        ("--friction 0.4 --shear-displacement 1e-30", "shear_displacement: 1e-30 m cannot be told from no shear"),
        ("--friction 0.4 --shear-pressure 1kPa --dry-run", "cannot be combined with a dry run"),
    ] {
        assert_refused(&solve(more), expected);
    }
    let sweep = format!("sweep {RUBBER} --pressures 1e4,2e4 --friction 0.4 --shear-pressure 1kPa --out s");
    assert_refused(&run(&place, &sweep), "friction: friction with partial slip cannot be combined with a sweep");
    // What neglects the coupling says so.
    for (more, expected) in [("--poisson 0.3 --uncoupled", "Dundurs' β = 0.286"), ("--poisson 0", "Dundurs' β = 0.500")]
    {
        let output = solve(&format!("--friction 0.4 --shear-pressure 1kPa {more}"));
        assert_solved(&output);
        assert!(text(&output.stderr).contains(expected), "{}", text(&output.stderr));
        let output = solve(&format!("--friction 0.4 --shear-pressure 1kPa --json {more}"));
        let summary: Value = serde_json::from_str(&text(&output.stdout)).expect("a summary");
        assert!(summary["shear_note"].as_str().is_some_and(|note| note.contains(expected)), "{summary}");
    }
    let exact = solve("--friction 0.4 --shear-pressure 1kPa --json");
    let summary: Value = serde_json::from_str(&text(&exact.stdout)).expect("a summary");
    assert!(summary.get("shear_note").is_none(), "{summary}");
}

#[test]
fn tractions_are_compared_with_units_and_exported() {
    let place = Place::new();
    for (name, shear) in [("a", "2kPa"), ("b", "4kPa")] {
        let words =
            format!("solve {RUBBER} --pressure 20kPa --friction 0.4 --shear-pressure {shear} --quiet --out {name}");
        assert_solved(&run(&place, &words));
    }
    let told = run(&place, "compare a b");
    assert_solved(&told);
    let told = text(&told.stdout);
    for (key, unit) in [("shear pressure", "Pa"), ("shear force", "N"), ("shear displacement", "m"), ("slip work", "J")]
    {
        let line =
            told.lines().find(|line| line.trim_start().starts_with(key)).unwrap_or_else(|| panic!("no {key}: {told}"));
        assert!(line.contains(unit), "{line}");
    }
    assert_solved(&run(&place, "export a --vtk --zarr --quiet"));
    let names = ["shear_x", "shear_y", "slip"];
    let fields = String::from_utf8_lossy(&place.bytes("a/fields.vti")).into_owned();
    for name in names {
        assert!(fields.contains(&format!("Name=\"{name}\"")), "fields.vti has no {name}");
        let attributes = place.json(&format!("a/fields.zarr/{name}/.zattrs"));
        assert!(attributes["units"].as_str().is_some_and(|unit| unit != "m2"), "{name}: {attributes}");
    }
}

#[test]
fn several_surfaces_have_a_mean_shear_curve_with_its_spread() {
    let place = Place::new();
    let sweep = format!("sweep {RUBBER} --pressures 1e4:1e5:5 --seeds 1..3 --quiet --out s");
    assert_solved(&run(&place, &sweep));
    let told = run(&place, "shear s --friction 0.4 --out shear");
    assert_solved(&told);
    assert!(text(&told.stdout).contains("mean of 3 surfaces"), "{}", text(&told.stdout));
    let record = place.json("shear/shear.json");
    let curves = record["curves"].as_array().expect("curves");
    let mean = &record["means"][0];
    assert_eq!((curves.len(), mean["surfaces"].as_u64()), (3, Some(3)));
    for key in ["shear_displacement", "slip_area_fraction", "loss_per_cycle"] {
        let values = curves.iter().map(|curve| number(&curve["points"][50], key));
        let expected = values.clone().sum::<f64>() / 3.0;
        let spread = (values.map(|value| (value - expected).powi(2)).sum::<f64>() / 2.0).sqrt();
        let point = &mean["points"][50];
        let found = [number(point, key), number(point, &format!("{key}_spread"))];
        assert!(
            (found[0] / expected - 1.0).abs() < 1e-12 && (found[1] / spread - 1.0).abs() < 1e-9,
            "{key}: {found:?}"
        );
    }
    let table = text(&place.bytes("shear/shear_mean.csv"));
    let header = "scene,surfaces,mean_pressure,shear_pressure,shear_displacement,shear_displacement_spread";
    assert!(table.starts_with(header), "{}", &table[..200]);
    assert_eq!(table.lines().count(), 1 + mean["points"].as_array().expect("points").len());
    assert_solved(&run(&place, "report shear --quiet"));
    // One surface has no mean.
    assert_solved(&run(&place, &format!("sweep {RUBBER} --pressures 1e4:1e5:5 --quiet --out one")));
    assert_solved(&run(&place, "shear one --friction 0.4 --quiet --out shear"));
    assert!(!place.names("shear").contains(&"shear_mean.csv".to_owned()));
}

/// A table with loads and penetrations of σ0 ∝ exp(Δ/u0), u0 = 1 µm.
fn exponential(loads: &[f64]) -> String {
    let head = "seed,control_value,status,control,mean_pressure,penetration,area_fraction,contact_stiffness\n";
    let line = |load: &f64| {
        format!(
            "1,{load},converged,pressure,{load},{},{},{}\n",
            2e-5 + 1e-6 * (load / 1e6).ln(),
            load * 1e-7,
            load / 1e-6
        )
    };
    head.to_owned() + &loads.iter().map(line).collect::<String>()
}

#[test]
fn a_load_curve_becomes_its_shear_curve() {
    let place = Place::new();
    place.write("curve.csv", exponential(&[1e4, 1e5, 3e5, 1e6]));
    let output = run(&place, "shear curve.csv --friction 0.4 --out s");
    assert_solved(&output);
    assert!(text(&output.stderr).contains("taken as 0"), "{}", text(&output.stderr));
    let csv = text(&place.bytes("s/shear.csv"));
    let mut reader = csv::Reader::from_reader(csv.as_bytes());
    let heads = reader.headers().expect("heads").clone();
    let mut n_lines = 0;
    for record in reader.records() {
        let record = record.expect("a line");
        let of = |key: &str| -> Option<f64> {
            let i = heads.iter().position(|head| head == key).unwrap_or_else(|| panic!("no column {key}"));
            record[i].parse().ok()
        };
        let tau = of("shear_pressure").expect("τ");
        let left = 1.0 - tau / 0.4e6;
        let expected = -0.4e-6 * left.ln();
        let found = of("shear_displacement").expect("d");
        assert!((found - expected).abs() <= 1e-12 * expected + 1e-20, "{tau}: {found} for {expected}");
        let stiffness = of("tangential_stiffness").expect("dτ/dd");
        assert!((stiffness / (left * 1e12) - 1.0).abs() < 1e-9, "{tau}: {stiffness}");
        assert_eq!(of("loss_factor").is_some(), tau > 0.0);
        n_lines += 1;
    }
    assert_eq!(n_lines, 104);
    let curve = &place.json("s/shear.json")["curves"][0];
    assert!((number(curve, "sliding_pressure") - 4e5).abs() < 1e-9);
    assert_solved(&run(&place, "report s --quiet"));
    assert!(text(&place.bytes("s/report.html")).contains("\"kind\":\"shear\""));
    // ν = 0.5 makes displacements half as large again.
    assert_solved(&run(&place, "shear curve.csv --friction 0.4 --poisson 0.5 --every-load --out s --quiet"));
    let curves = place.json("s/shear.json")["curves"].as_array().cloned().expect("curves");
    assert_eq!(curves.len(), 1, "four loads make one curve");
    assert!((number(&curves[0], "tangential_stiffness") * 1.5 / 1e12 - 1.0).abs() < 1e-9);
}

#[test]
fn a_sweep_has_a_shear_curve_for_each_seed_that_agrees_with_a_solve() {
    let place = Place::new();
    let sweep = format!("sweep {RUBBER} --pressures 1kPa:40kPa:9 --seeds 1..2 --quiet --out curve");
    assert_solved(&run(&place, &sweep));
    assert_solved(&run(&place, "shear curve --friction 0.4 --poisson 0 --every-load --quiet --out s"));
    let record = place.json("s/shear.json");
    let curves = record["curves"].as_array().expect("curves");
    assert_eq!(curves.len(), 2 * 6, "loads 4 to 9 of two seeds");
    // The last curve of seed 1, at the shear that a solve with ν = 0 has too.
    let points = curves[5]["points"].as_array().expect("points");
    let middle = &points[53];
    let shear = number(middle, "shear_pressure");
    // The same E*, with ν = 0.
    let solve = format!(
        "solve --waves 8 --grid 64 --young 4MPa --poisson 0 --pressure 40kPa --friction 0.4 --shear-pressure {shear} --json --quiet"
    );
    let output = run(&place, &solve);
    assert_solved(&output);
    let summary: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let [found, expected] = [number(middle, "shear_displacement"), number(&summary, "shear_displacement")];
    let stated = number(middle, "shear_displacement_error");
    assert!((found - expected).abs() <= stated + 1e-3 * expected, "{found} for {expected} ± {stated}");
}

#[test]
fn what_is_no_load_curve_is_refused() {
    let place = Place::new();
    place.write("few.csv", exponential(&[1e4, 1e5, 1e6]));
    place.write("down.csv", exponential(&[1e4, 1e6, 1e5, 2e6]));
    let hard = exponential(&[1e4, 1e5, 3e5, 1e6]).replace("contact_stiffness", "hardness");
    place.write("hard.csv", hard);
    place.write("open.csv", exponential(&[1e4, 1e5, 3e5, 1e6]).replace("1000000,converged", "1000000,not_converged"));
    for (words, expected) in [
        ("few.csv --friction 0.4", "it has 3 loads, and a shear curve needs at least 4"),
        ("down.csv --friction 0.4", "its loads must be positive and increase from row to row"),
        ("hard.csv --friction 0.4", "cannot be combined with a hardness"),
        ("open.csv --friction 0.4", "the row at 1 MPa did not converge"),
        ("none --friction 0.4", "not a table of rc sweep"),
        ("few.csv --friction -1", "friction: must be above 0"),
        ("few.csv --friction 0.4 --poisson 0.6", "poisson: must be above -1 and at most 0.5"),
    ] {
        assert_refused(&run(&place, &format!("shear {words} --out s")), expected);
    }
    assert_solved(&run(&place, &format!("solve {RUBBER} --pressure 20kPa --quiet --out r")));
    place.write("curve.csv", exponential(&[1e4, 1e5, 3e5, 1e6]));
    assert_refused(&run(&place, "shear curve.csv --friction 0.4 --out r"), "out: r is the result of rc solve");
}
