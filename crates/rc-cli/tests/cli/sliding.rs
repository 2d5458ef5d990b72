//! Surfaces that slide over a solid that relaxes.

use rc_core::{DVec2, Field, Silent};
use rc_kernel::{Relaxation, Spectral, Viscoelastic};
use rc_solver::{ContactProblem, Control, SolveParams};
use serde_json::Value;

use crate::support::{Place, assert_refused, assert_solved, text};
use crate::sweep::table;

/// A small problem on a soft solid.
const SOFT: &str = "--waves 8 --grid 64 --young 3MPa --poisson 0.49";

/// A file of two terms.
const RUBBER: &str = "# of a compound\ng, tau (ms)\n3, 1\n6, 100\n";

fn run(place: &Place, words: &str) -> std::process::Output {
    place.run(&words.split_whitespace().collect::<Vec<_>>())
}

fn number(json: &Value, key: &str) -> f64 {
    json[key].as_f64().unwrap_or_else(|| panic!("no {key}"))
}

#[test]
fn friction_is_that_of_the_library() {
    let place = Place::new();
    place.write("rubber.csv", RUBBER);
    assert_solved(&run(&place, "surface --waves 8 --grid 64 --cell 0.01 --quiet --out map.npy"));
    let words = "solve --heights map.npy --cell 0.01 --e-star 1e9 --pressure 2e6 --kernel spectral --speed 2cm/s --direction 30 --prony rubber.csv --quiet --out r";
    assert_solved(&run(&place, words));
    let summary = place.json("r/summary.json");
    let map = rc_heights::npy::read(&place.path("map.npy")).expect("a map");
    let heights = Field::new(map.grid(), map.values().iter().map(|h| h / 0.01).collect()).expect("heights");
    let material = Relaxation::prony(&[[3.0, 1e-3], [6.0, 0.1]]).expect("a material");
    let kernel = Viscoelastic::new(Spectral, &material, 2.0 * DVec2::from_angle(30_f64.to_radians()));
    let problem = ContactProblem::new(&heights, Control::MeanPressure(2e-3)).with_kernel(&kernel);
    let solution = problem.solve(&SolveParams::certified(), &Silent).expect("a solution");
    let friction = solution.info().friction.expect("it slides");
    for (key, expected) in [
        ("friction", friction.coefficient),
        ("friction_error", friction.error),
        ("friction_bound", friction.bound),
        ("lateral_friction", friction.lateral),
        ("max_loss_tangent", friction.max_loss_tangent),
        ("dissipated_power", friction.power * 1e9 * 0.01),
    ] {
        let found = number(&summary, key);
        assert!((found - expected).abs() <= 1e-9 * expected.abs(), "{key}: {found} for {expected}");
    }
    let power = number(&summary, "friction") * number(&summary, "mean_pressure") * 0.02;
    assert!((number(&summary, "dissipated_power") / power - 1.0).abs() < 1e-9, "W/m²");
    assert!(friction.coefficient > 5.0 * friction.error && friction.coefficient > 1e-3, "{friction:?}");
    // The scene of the result has the terms, and repeats it without the file.
    std::fs::remove_file(place.path("rubber.csv")).expect("the file is there");
    assert_solved(&run(&place, "solve r --quiet --out again"));
    assert_eq!(place.json("again/summary.json")["friction"], summary["friction"]);
}

#[test]
fn all_forms_of_a_material_are_one() {
    let place = Place::new();
    place.write("rubber.csv", RUBBER);
    place.write("pascals.txt", "E_i [MPa];tau_i\n9;1e-3\n18;0.1\n");
    let base = format!("solve {SOFT} --pressure 2kPa --quiet --json");
    let scene = "waves = 8\ngrid = 64\nyoung = 3e6\npoisson = 0.49\npressure = 2e3\nspeed = \"1cm/s\"\n";
    place.write("list.toml", format!("{scene}prony = [[3, 0.001], [6, 0.1]]\n"));
    place.write("file.toml", format!("{scene}prony = \"rubber.csv\"\n"));
    place.write("solid.toml", format!("{scene}fractional = {{ alpha = 1, glassy_ratio = 4, tau = 1e-3 }}\n"));
    let friction = |output: &std::process::Output| {
        assert_solved(output);
        number(&serde_json::from_slice(&output.stdout).expect("JSON"), "friction")
    };
    let first = friction(&run(&place, &format!("{base} --speed 0.01 --prony rubber.csv")));
    for words in [
        format!("{base} --speed 1cm/s --prony [[3,0.001],[6,0.1]]"),
        "solve list.toml --quiet --json".to_owned(),
        "solve file.toml --quiet --json".to_owned(),
    ] {
        assert_eq!(friction(&run(&place, &words)).to_bits(), first.to_bits(), "{words}");
    }
    let in_pascals = friction(&run(&place, &format!("{base} --speed 0.01 --prony pascals.txt")));
    assert!((in_pascals / first - 1.0).abs() < 1e-9, "{in_pascals} for {first}");
    // A flag takes the place of the material in the scene.
    let single = friction(&run(&place, "solve list.toml --glassy-ratio 4 --relaxation-time 1ms --quiet --json"));
    let fractional = friction(&run(&place, "solve solid.toml --quiet --json"));
    let with_unit = friction(&run(&place, "solve solid.toml --fractional 1,4,1ms --quiet --json"));
    assert_eq!(with_unit.to_bits(), fractional.to_bits(), "a time with its unit");
    assert!((fractional / single - 1.0).abs() < 1e-3 && (first / single - 1.0).abs() > 0.1, "{single}");
    let at_rest = friction(&run(&place, "solve list.toml --speed 0 --quiet --json"));
    assert_eq!(at_rest.to_bits(), 0, "at rest");
    let printed = run(&place, &format!("solve {SOFT} --pressure 2kPa --speed 0.01 --prony rubber.csv"));
    let told = text(&printed.stdout);
    assert!(told.contains("friction ") && text(&printed.stderr).is_empty(), "{printed:?}");
    assert!(told.contains("10 mm/s along 0°, over a solid of 2 relaxation times and the glassy ratio 10"), "{told}");
    // The longest wave has ωτ of 0.00628 and 0.628, so E'' and E' are 2.721 and 2.697 times the relaxed modulus.
    assert!(told.contains(", loss tangent up to 1.01"), "{told}");
    let fast = run(&place, &format!("solve {SOFT} --pressure 2kPa --speed 1e6 --prony rubber.csv"));
    let glassy = "note: at this speed the solid is nearly glassy along the sliding direction, with E* = 39.48 MPa";
    assert!(text(&fast.stderr).contains(glassy), "{fast:?}");
    let slow = run(&place, &format!("solve {SOFT} --pressure 2kPa --speed 1e-9 --prony rubber.csv"));
    assert!(text(&slow.stderr).contains("the solid is elastic, with E* = 3.948 MPa"), "{slow:?}");
}

#[test]
fn a_summit_that_coarser_grids_do_not_touch_has_a_friction_with_its_error() {
    let place = Place::new();
    let solid = format!("{SOFT} --glassy-ratio 10 --relaxation-time 1ms --speed 0.01");
    assert_solved(&run(&place, &format!("solve {solid} --penetration 1pm --quiet --out r")));
    let summary = place.json("r/summary.json");
    assert!(number(&summary, "friction").abs() > 0.0 && number(&summary, "friction_error") > 0.0, "{summary}");
    let told = text(&run(&place, "inspect r").stdout);
    assert!(told.contains("  friction  "), "{told}");
}

#[test]
fn what_cannot_slide_is_refused() {
    let place = Place::new();
    place.write("rubber.csv", RUBBER);
    for (name, content) in [
        ("negative.csv", "g tau\n3 1\n\n-6 2\n"),
        ("three.csv", "3 1\n6 2 5\n"),
        ("word.csv", "3 1\n6 fast\n"),
        ("empty.csv", "# g tau\n"),
        ("unit.csv", "E (psi), tau (s)\n3 1\n"),
        ("shear.csv", "G (MPa), tau (s)\n3 1\n"),
    ] {
        place.write(name, content);
    }
    let rubber = "--prony rubber.csv";
    for (words, expected) in [
        ("--prony negative.csv --speed 1", "negative.csv: line 4: a modulus must be above 0 and finite, not -6"),
        ("--prony three.csv --speed 1", "three.csv: line 2 has 3 values, but it must have two: g and tau (s)"),
        ("--prony word.csv --speed 1", "word.csv: line 2, value 2: 'fast'"),
        ("--prony empty.csv --speed 1", "empty.csv: it has no numbers"),
        ("--prony none.csv --speed 1", "none.csv: cannot read"),
        ("--prony unit.csv --speed 1", "unit.csv: line 1: 'psi' is not a unit of pressure or time"),
        (
            "--prony shear.csv --speed 1",
            "shear.csv: line 1: the first column is 'G'; it must be g, relative to the relaxed",
        ),
        ("--prony [[1,2] --speed 1", "must be a file, or a list such as [[3,0.001],[6,0.1]]"),
        ("--prony [[1,0]] --speed 1", "prony: term 1: a modulus of 1 and a relaxation time of 0"),
        ("--speed 1", "speed: sliding changes nothing without a material that relaxes; give prony"),
        (rubber, "prony: a material that relaxes needs speed (m/s)"),
        ("--direction 90", "direction: is that of a surface that slides; give speed"),
        (
            "--speed 1 --prony rubber.csv --glassy-ratio 3 --relaxation-time 1",
            "prony: is given with relaxation_time; a solid has one material",
        ),
        ("--speed 1 --glassy-ratio 3", "relaxation_time: is missing"),
        ("--speed 1 --glassy-ratio 3 --relaxation-time -1", "relaxation_time: a relaxation time of -1"),
        ("--speed 1 --glassy-ratio 1 --relaxation-time 1", "glassy_ratio: a glassy ratio of 1"),
        ("--speed 1 --fractional 2,3,1", "fractional: an exponent alpha of 2"),
        ("--speed 1 --fractional 0.2,10,1m", "fractional <ALPHA,RATIO,S>': must be a time in s, such as 1e-3"),
        ("--speed 1 --fractional 2,3", "must be alpha, glassy ratio and relaxation time (s)"),
        ("--speed -1 --prony rubber.csv", "not -1; for the other way give --direction 180"),
        ("--speed 1km --prony rubber.csv", "must be a speed in m/s"),
        ("--speed 1 --glassy-ratio 3 --relaxation-time 1m", "must be a time in s"),
        (
            "--speed 1 --prony rubber.csv --boundary free",
            "speed: a sliding surface cannot be combined with free borders",
        ),
        ("--speed 1 --direction 30 --prony rubber.csv --method adaptive", "method: "),
        ("--speed 1 --prony rubber.csv --method gauss-seidel", "method: "),
        ("--speed 1 --prony rubber.csv --border-level 1", "speed: "),
        ("--speed 1 --prony rubber.csv --young2 1GPa --poisson2 0.3", "young2: the other body is rigid"),
    ] {
        let words = format!("solve {SOFT} --pressure 2kPa --quiet {words}");
        assert_refused(&run(&place, &words), expected);
    }
}

#[test]
fn moduli_in_pascals_and_profiles_have_their_own_refusals() {
    let place = Place::new();
    place.write("rubber.csv", RUBBER);
    place.write("pascals.csv", "E tau\n3 1\n");
    let of_e_star = "solve --waves 8 --grid 64 --e-star 4MPa --pressure 2kPa --speed 1 --prony pascals.csv";
    assert_refused(
        &run(&place, of_e_star),
        "pascals.csv: its moduli are in Pa, so the relaxed modulus must be given as young",
    );
    let point = |i: u32| format!("{} {}\n", f64::from(i) * 1e-4, 1e-6 * (f64::from(i) * 0.2).sin());
    let profile = (0..64).map(point).collect::<Vec<_>>().concat();
    place.write("profile.txt", profile);
    let line = "solve --heights profile.txt --line --unit m --e-star 4MPa --pressure 2kPa --speed 1 --prony rubber.csv --direction 90";
    assert_refused(&run(&place, line), "direction: a profile slides along x; give 0 or 180, not 90");
}

#[test]
fn a_sweep_over_speeds_has_the_friction_of_each_solve_and_its_curves() {
    let place = Place::new();
    let solid = format!("{SOFT} --glassy-ratio 10 --relaxation-time 1ms");
    assert_solved(&run(&place, &format!("sweep {solid} --pressure 2kPa --speeds 1mm/s:1m/s:4 --quiet --out s")));
    let rows = table(&place.path("s"));
    let column = |name: &str| -> Vec<String> {
        let at = rows[0].iter().position(|head| head == name).expect("a column");
        rows[1..].iter().map(|row| row[at].clone()).collect()
    };
    assert_eq!(column("speed"), ["0.001", "0.01", "0.1", "1.0"]);
    assert_solved(&run(&place, &format!("solve {solid} --pressure 2kPa --speed 0.01 --quiet --out one")));
    assert_eq!(column("friction")[1], place.json("one/summary.json")["friction"].to_string());
    let friction: Vec<f64> = column("friction").iter().map(|cell| cell.parse().expect("a number")).collect();
    assert!(friction[2] > friction[0] && friction[2] > friction[3], "{friction:?}");
    assert_solved(&run(&place, "plot s --out pictures --quiet"));
    assert!(place.names("pictures").contains(&"friction.svg".to_owned()), "{:?}", place.names("pictures"));
    assert!(text(&place.bytes("pictures/friction.svg")).contains("speed (m/s)"));
    let told = text(&run(&place, "inspect s").stdout);
    assert!(told.contains("friction coefficient") && told.contains("100 mm/s"), "{told}");
    assert_solved(&run(&place, "report s --out page.html --quiet"));
    let page = text(&place.bytes("page.html"));
    assert!(
        page.contains("\"against\":\"speed\"") && page.contains("--vary speed=0.001,0.01,0.1,1.0"),
        "a page of speeds"
    );
    let with_list = format!("sweep {solid} --pressure 2kPa --speeds 1,2 --speed 1 --out t");
    assert_refused(&run(&place, &with_list), "--speeds and --speed are both given");
    let bad = format!("sweep {solid} --pressure 2kPa --speeds 1,2Pa --out t");
    assert_refused(&run(&place, &bad), "'--speeds <LIST>': must be a speed in m/s");
    for (speeds, expected) in [
        ("nan", "must be finite speeds (m/s), not 'nan'"),
        ("1,inf", "must be finite speeds (m/s), not 'inf'"),
        ("0:1:3", "a range must begin and end above 0 (m/s); give 0 in a list, such as 0,1mm/s,1cm/s"),
    ] {
        let bad = format!("sweep {solid} --pressure 2kPa --speeds {speeds} --out t");
        assert_refused(&run(&place, &bad), &format!("'--speeds <LIST>': {expected}"));
    }
}

#[test]
fn a_solid_that_creeps_has_the_area_of_the_elastic_contact_under_the_load_that_grows() {
    let place = Place::new();
    let solid = format!("{SOFT} --glassy-ratio 10 --relaxation-time 1ms");
    assert_solved(&run(
        &place,
        &format!("sweep {solid} --pressure 2kPa --times 1us,10ms,1s --leakage --quiet --out s"),
    ));
    let rows = table(&place.path("s"));
    let column = |name: &str| -> Vec<f64> {
        let at = rows[0].iter().position(|head| head == name).unwrap_or_else(|| panic!("no {name}"));
        rows[1..].iter().map(|row| row[at].parse().expect("a number")).collect()
    };
    assert_eq!(column("time"), [1e-6, 1e-2, 1.0]);
    // J(t)/J∞ = 1 - 0.9 exp(-t/10 ms).
    for (load, time) in column("control_value").into_iter().zip([1e-6, 1e-2, 1.0]) {
        let expected = 2e3 * (1.0 - 0.9 * (-time / 1e-2_f64).exp());
        assert!((load / expected - 1.0).abs() < 1e-12, "{load} for {expected}");
    }
    assert!(
        column("mean_pressure").iter().all(|pressure| (pressure / 2e3 - 1.0).abs() < 1e-12),
        "the load is constant"
    );
    // The pressure of a half-space rises by at least the load wherever there is contact, so no point has to pull.
    let rises = column("least_pressure_rise");
    assert!(rises.iter().all(|rise| *rise > 1.0) && rises[2] < rises[0], "{rises:?}");
    for absent in ["max_pressure", "rms_pressure", "contact_stiffness", "elastic_energy", "friction"] {
        assert!(!rows[0].iter().any(|head| head == absent), "{absent} is not that of a solid that creeps");
    }
    let loads = column("control_value").iter().map(f64::to_string).collect::<Vec<_>>().join(",");
    assert_solved(&run(&place, &format!("sweep {SOFT} --pressures {loads} --leakage --quiet --out elastic")));
    let elastic = table(&place.path("elastic"));
    for name in ["area_fraction", "penetration", "mean_gap", "permeance_x"] {
        let at = elastic[0].iter().position(|head| head == name).expect("a column");
        let expected: Vec<f64> = elastic[1..].iter().map(|row| row[at].parse().expect("a number")).collect();
        assert_eq!(column(name), expected, "{name}");
    }
    assert_solved(&run(&place, "report s --quiet"));
    let page = text(&place.bytes("s/report.html"));
    assert!(page.contains("\"against\":\"time\"") && !page.contains("--vary time"), "a page of times");
    let (_, command) = page.split_once("\"text\":\"rc sweep").expect("a command");
    let command = command.split(" --out again").next().expect("its end");
    assert!(command.contains(" --times 1e-6,0.01,1.0") && command.contains(" --pressure 2000.0"), "{command}");
    assert_solved(&run(&place, &format!("sweep{command} --quiet --out repeated")));
    let repeated = table(&place.path("repeated"));
    for name in ["time", "control_value", "area_fraction", "permeance_x", "least_pressure_rise"] {
        let at = rows[0].iter().position(|head| head == name).expect("a column");
        assert!(repeated.iter().zip(&rows).all(|(one, other)| one[at] == other[at]), "{name}");
    }
}

#[test]
fn what_cannot_creep_is_refused() {
    let place = Place::new();
    let solid = format!("{SOFT} --glassy-ratio 10 --relaxation-time 1ms");
    for (words, expected) in [
        ("--pressures 1kPa,2kPa --times 1,2", "times: the load is constant; give one --pressure"),
        (
            "--pressures 2kPa,1kPa --times 1,2",
            "times: after the load falls, a contact that shrinks is not an elastic one",
        ),
        ("--penetration 1um --times 1,2", "times: a solid creeps under a constant load"),
        ("--pressure 1kPa --times 1,2 --fields", "times: the pressure after a time is not that of an elastic contact"),
        ("--pressure 1kPa --times 1,2 --speed 1", "times: the surface is at rest; omit speed"),
        ("--pressure 1kPa --times 1,2 --hardness 1MPa", "times: a solid with a hardness"),
        ("--pressure 1kPa --times 0,2", "each time must be above 0"),
        ("--pressure 1kPa --times 1,2m", "must be a time in s"),
    ] {
        assert_refused(&run(&place, &format!("sweep {solid} {words} --out t")), expected);
    }
    let elastic = format!("sweep {SOFT} --pressure 1kPa --times 1,2 --out t");
    assert_refused(&run(&place, &elastic), "times: an elastic solid does not creep; give prony");
    let fractional = format!("{elastic} --fractional 0.3,10,1");
    assert_refused(&run(&place, &fractional), "fractional: its creep is not known; give prony");
}

#[test]
fn the_page_of_a_sliding_contact_shows_its_direction() {
    let place = Place::new();
    place.write("rubber.csv", RUBBER);
    let words = format!("solve {SOFT} --pressure 2kPa --speed 0.01 --direction 90 --prony rubber.csv --quiet --out r");
    assert_solved(&run(&place, &words));
    assert_solved(&run(&place, "report r"));
    let page = text(&place.bytes("r/report.html"));
    assert!(page.contains("\"direction\":[0.0,1.0]"), "the direction on the map");
    assert!(
        page.contains("10 mm/s along 90°, over a solid of 2 relaxation times and the glassy ratio 10"),
        "the material"
    );
    let (_, command) = page.split_once("rc solve --").expect("a command");
    let command = command.split(" --out").next().expect("its end").replace('\'', "");
    assert_solved(&run(&place, &format!("solve --{command} --quiet --out again")));
    assert!(place.bytes("again/pressure.npy") == place.bytes("r/pressure.npy"), "{command}");
}
