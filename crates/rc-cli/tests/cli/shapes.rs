//! Shapes, forces, units and two bodies.

use rc_core::{Elasticity, Field, Grid};
use rc_theory::cone::Cone;
use rc_theory::hertz::Hertz;
use rc_theory::westergaard::Westergaard;
use serde_json::Value;

use crate::solve::assert_close;
use crate::support::{Place, assert_refused, assert_solved, codes, text};

/// The summary of `rc solve` with these words, separated by blanks.
fn solved(place: &Place, words: &str) -> Value {
    let words: Vec<&str> = ["solve", "--quiet", "--json"].into_iter().chain(words.split_whitespace()).collect();
    let output = place.run(&words);
    assert_solved(&output);
    serde_json::from_slice(&output.stdout).expect("a summary")
}

fn number(summary: &Value, key: &str) -> f64 {
    summary[key].as_f64().unwrap_or_else(|| panic!("{key} is {}", summary[key]))
}

/// Fails unless the exact value of a quantity is within its error bar.
fn assert_within_bar(summary: &Value, [key, bar]: [&str; 2], exact: f64) {
    let (value, bar) = (number(summary, key), number(summary, bar));
    assert!((value - exact).abs() <= bar, "{key} is {value:e} ± {bar:e}, exactly {exact:e}");
}

const AREA: [&str; 2] = ["area_fraction", "area_fraction_error"];
const PENETRATION: [&str; 2] = ["penetration", "penetration_error_bar"];

/// Fails unless `rc solve FOLDER` repeats the fields in `folder`, without other files.
fn assert_repeats(place: &Place, folder: &str) {
    std::fs::rename(place.path(folder), place.path("moved")).expect("a folder");
    assert_solved(&place.run(&["solve", "moved", "--quiet", "--threads", "1", "--out", "again"]));
    for name in ["pressure.npy", "gap.npy"] {
        assert!(place.bytes(&format!("moved/{name}")) == place.bytes(&format!("again/{name}")), "{folder}: {name}");
    }
    std::fs::remove_dir_all(place.path("again")).expect("a folder");
    std::fs::rename(place.path("moved"), place.path(folder)).expect("a folder");
}

/// Hertz's sphere, whose numbers have units. All results are those of the closed form.
#[test]
fn a_sphere_under_a_force_is_hertzs() {
    let place = Place::new();
    let words = "--shape sphere --radius 10mm --cell 1mm --grid 256 --boundary free --e-star 115GPa --force 10N";
    let found = solved(&place, &format!("{words} --out hertz"));
    let sphere = Hertz { radius: 10.0 };
    let a = sphere.contact_radius_at_load(10.0 / 115e9 / 1e-6);
    assert_within_bar(&found, AREA, std::f64::consts::PI * a * a);
    assert_within_bar(&found, PENETRATION, 1e-3 * sphere.penetration(a));
    assert_close("area", number(&found, "area_fraction"), std::f64::consts::PI * a * a, 5e-3);
    assert_close("maximum pressure", number(&found, "max_pressure"), 115e9 * sphere.peak_pressure(a), 2e-3);
    assert_close("mean pressure", number(&found, "mean_pressure"), 1e7, 1e-10);
    assert_eq!(codes(&found), [""; 0], "a sphere is steep far from the contact only");
    let rms = (1.0_f64 / 90.0).sqrt() / 2.0 / 10.0 * 1e-3;
    assert_close("rms height", number(&found, "rms_height"), rms, 1e-4);
    assert_repeats(&place, "hertz");
    let scene = text(&place.bytes("hertz/scene.toml"));
    assert!(scene.contains("force = 10.0") && !scene.contains("waves"), "{scene}");
    let by_depth =
        solved(&place, &format!("{} --penetration {}m", &words[..words.len() - 12], number(&found, "penetration")));
    assert_close("load", number(&by_depth, "mean_pressure"), 1e7, 1e-3);
}

#[test]
fn a_cone_is_sneddons() {
    let place = Place::new();
    let words = "--shape cone --angle 5deg --cell 1mm --grid 256 --boundary free --e-star 1GPa --force 500mN";
    let found = solved(&place, words);
    let cone = Cone { slope: 5.0_f64.to_radians().tan() };
    let a = (2.0 * 0.5e-3 / (std::f64::consts::PI * cone.slope)).sqrt();
    assert_close("load", cone.load(a), 0.5 / 1e9 / 1e-6, 1e-12);
    assert_within_bar(&found, AREA, std::f64::consts::PI * a * a);
    assert_within_bar(&found, PENETRATION, 1e-3 * cone.penetration(a));
    let steep = solved(&place, &words.replace("5deg", "0.5rad"));
    assert!(codes(&steep).contains(&"slope".to_owned()), "{:?}", codes(&steep));
}

/// Hertz's line contact. The images of the cylinder bend the surface, which changes the radius in second order.
#[test]
fn a_cylinder_is_a_line_contact() {
    let place = Place::new();
    let words = "--shape cylinder --radius 10mm --cell 1mm --grid 512 --e-star 1GPa --pressure 100kPa";
    let found = solved(&place, words);
    let load = 1e-4;
    let radius = 1.0 / (0.1 + 2.0 * std::f64::consts::PI * load / 3.0);
    let half_width = (4.0 * load * radius / std::f64::consts::PI).sqrt();
    assert_within_bar(&found, AREA, 2.0 * half_width);
    let peak = 1e9 * 2.0 * load / (std::f64::consts::PI * half_width);
    assert_close("maximum pressure", number(&found, "max_pressure"), peak, 2e-3);
}

#[test]
fn a_wave_is_westergaards() {
    let place = Place::new();
    let words = "--shape wave --wavelength 1mm --wave-amplitude 1um --cell 1mm --grid 512 --e-star 1GPa";
    let found = solved(&place, &format!("{words} --pressure 1MPa"));
    let wave = Westergaard { amplitude: 1e-3 };
    assert_within_bar(&found, AREA, wave.area_fraction(1e-3));
    assert_close("maximum pressure", number(&found, "max_pressure"), 1e9 * wave.pressure(0.0, 1e-3), 1e-4);
    assert_close("rms height", number(&found, "rms_height"), 1e-6 / 2.0_f64.sqrt(), 1e-12);
    // Two waves of half the size are the same contact twice.
    let two = words.replace("--wavelength 1mm --wave-amplitude 1um", "--wavelength 0.5mm --wave-amplitude 0.5um");
    let two = solved(&place, &format!("{two} --pressure 1MPa"));
    let one = solved(&place, &format!("{} --pressure 1MPa", words.replace("512", "256")));
    for key in ["area_fraction", "max_pressure", "rms_pressure"] {
        assert_close(key, number(&two, key), number(&one, key), 1e-3);
    }
    let odd = words.replace("--wavelength 1mm", "--wavelength 0.3mm");
    let odd: Vec<&str> = ["solve"].into_iter().chain(odd.split(' ')).chain(["--pressure", "1e6"]).collect();
    assert_refused(&place.run(&odd), "wavelength: 3.33333 waves in the cell do not repeat");
    assert_solved(&place.run(&[&odd[..], &["--boundary", "free", "--quiet"]].concat()));
}

#[test]
fn a_flat_needs_free_borders() {
    let place = Place::new();
    let words = "--shape flat --cell 1mm --grid 64 --e-star 1GPa --force 1N";
    let found = solved(&place, &format!("{words} --boundary free"));
    assert_close("area", number(&found, "area_fraction"), 1.0, 0.0);
    let periodic: Vec<&str> = ["solve"].into_iter().chain(words.split(' ')).collect();
    assert_refused(&place.run(&periodic), "shape: a flat surface in a periodic cell has no contact problem");
}

/// A shape on a random surface, and on a map of it, is one sum.
#[test]
fn a_shape_is_added_to_a_surface() {
    let place = Place::new();
    let random = "--waves 8 --grid 64 --rms 1um --cell 1mm";
    let shape = "--shape sphere --radius 20mm --boundary free --e-star 1GPa --force 100mN --method uniform";
    let on_random = solved(&place, &format!("{random} {shape} --out random"));
    let surface: Vec<&str> = ["surface", "--quiet", "--out", "map.npy"].into_iter().chain(random.split(' ')).collect();
    assert_solved(&place.run(&surface));
    let on_map = solved(&place, &format!("map.npy --cell 1mm {shape} --out map"));
    for key in ["area_fraction", "penetration", "max_pressure", "rms_height", "rms_slope"] {
        assert_close(key, number(&on_map, key), number(&on_random, key), 1e-6);
    }
    assert!(number(&on_random, "rms_height") > 1.5e-6, "{on_random}");
    assert_repeats(&place, "random");
    assert_repeats(&place, "map");
    let scene = text(&place.bytes("map/scene.toml"));
    assert!(!scene.contains("shape"), "the sphere is in heights.npy: {scene}");
    // A flat changes nothing.
    let flat = "--shape flat --e-star 1GPa --pressure 1e5 --method uniform --out";
    solved(&place, &format!("{random} {flat} flat"));
    solved(&place, &format!("{random} {} none", flat.replace("--shape flat ", "")));
    assert!(place.bytes("flat/pressure.npy") == place.bytes("none/pressure.npy"));
}

#[test]
fn two_elastic_bodies_have_one_modulus() {
    let place = Place::new();
    let words = "--waves 4 --grid 64 --pressure 50MPa --rms 100um --method uniform";
    let found =
        solved(&place, &format!("{words} --young 200GPa --poisson 0.3 --young2 70GPa --poisson2 0.33 --out two"));
    let body = |young, poisson| Elasticity::from_young_poisson(young, poisson).expect("a body").e_star();
    let e_star = 1.0 / (1.0 / body(200e9, 0.3) + 1.0 / body(70e9, 0.33));
    let one = solved(&place, &format!("{words} --e-star {e_star}"));
    for key in ["area_fraction", "penetration", "max_pressure", "contact_stiffness"] {
        assert_close(key, number(&found, key), number(&one, key), 1e-9);
    }
    assert_repeats(&place, "two");
    assert_eq!(found["second_body"], serde_json::json!({ "young": 70e9, "poisson": 0.33 }));
    for (more, expected) in [
        ("--young2 70GPa", "poisson2: is missing"),
        ("--poisson2 0.3", "young2: is missing"),
        ("--young2 70GPa --poisson2 0.6", "poisson2: must be above -1 and at most 0.5"),
        ("--young2 70GPa --poisson2 0.3 --e-star 1GPa", "e_star is that of both bodies"),
        ("--young2 70GPa --poisson2 0.3 --layer-thickness 1mm", "young2: a layer is pressed by a rigid body"),
    ] {
        let words = format!("solve {words} {more}");
        assert_refused(&place.run(&words.split(' ').collect::<Vec<_>>()), expected);
    }
}

/// Heights (m) of a rough map that is not symmetrical.
fn rough(n: usize) -> Field {
    let height = |at: rc_core::DVec2| 1e-6 * ((20.0 * at.x).sin() + (33.0 * at.x * at.y + 1.0).cos());
    Field::from_fn(Grid::square(n).expect("a grid"), height)
}

#[test]
fn another_body_is_mirrored_and_added() {
    let place = Place::new();
    let (n, map) = (32, rough(32));
    let sum = |ix: usize, iy: usize| map.at(ix, iy) + map.at(n - 1 - ix, iy);
    let sum = Field::new(map.grid(), (0..n * n).map(|i| sum(i % n, i / n)).collect()).expect("a map");
    for (name, field) in [("a.npy", &map), ("sum.npy", &sum)] {
        rc_heights::npy::write(&place.path(name), field, 1.0).expect("a file");
    }
    let words = "--cell 1mm --boundary free --e-star 1GPa --pressure 100kPa --out";
    solved(&place, &format!("a.npy --add a.npy {words} two"));
    solved(&place, &format!("sum.npy {words} one"));
    for name in ["pressure.npy", "gap.npy", "heights.npy"] {
        assert!(place.bytes(&format!("two/{name}")) == place.bytes(&format!("one/{name}")), "{name}");
    }
    assert_repeats(&place, "two");
    // The other body of a random surface, and of a shape.
    for (first, out) in
        [("--waves 4 --rms 1um --grid 32", "random"), ("--shape sphere --radius 10mm --grid 32", "sphere")]
    {
        solved(&place, &format!("{first} --add a.npy {words} {out}"));
        assert_repeats(&place, out);
    }
    let heights = rc_heights::npy::read(&place.path("sphere/heights.npy")).expect("a map");
    let at = |i: usize| ((i as f64 + 0.5) / 32.0 - 0.5) * 1e-3;
    for (ix, iy) in [(3, 5), (20, 31), (16, 16)] {
        let expected = map.at(n - 1 - ix, iy) - (at(ix).powi(2) + at(iy).powi(2)) / 2e-2;
        assert!((heights.at(ix, iy) - expected).abs() < 1e-18, "{ix}, {iy}");
    }
    // A folder has its map and the size of it.
    for (cell, folder) in [("1mm", "of-1mm"), ("2mm", "of-2mm")] {
        assert_solved(&place.run(&["surface", "--heights", "a.npy", "--cell", cell, "--quiet", "--out", folder]));
    }
    solved(&place, &format!("a.npy --add of-1mm {words} of-folder"));
    assert!(place.bytes("two/pressure.npy") == place.bytes("of-folder/pressure.npy"));
    rc_heights::npy::write(&place.path("small.npy"), &rough(16), 1.0).expect("a file");
    rc_heights::gsf::write(&place.path("wide.gsf"), &map, 1.0, [2e-3; 2]).expect("a file");
    for (other, expected) in [
        ("small.npy", "add: small.npy has 16 x 16 points, but the surface has 32 x 32; both bodies need the same grid"),
        ("wide.gsf", "add: wide.gsf is 2 mm x 2 mm, but the cell is 1 mm x 1 mm; both bodies need the same cell"),
        ("none.npy", "none.npy"),
        (
            "of-2mm",
            "add: of-2mm/heights.npy is 2 mm x 2 mm, but the cell is 1 mm x 1 mm; both bodies need the same cell",
        ),
    ] {
        let words = format!("solve a.npy --add {other} --cell 1mm --e-star 1e9 --pressure 1e5 --quiet");
        assert_refused(&place.run(&words.split(' ').collect::<Vec<_>>()), expected);
    }
}

#[test]
fn numbers_have_units_in_scene_files_too() {
    let place = Place::new();
    place.write("a.toml", "waves = 4\ngrid = 64\ncell = \"1mm\"\nrms = \"0.5 µm\"\nyoung = \"0.2GPa\"\npoisson = 0.3\npressure = \"50kPa\"\n");
    let with_units = solved(&place, "a.toml --out a");
    let bare =
        solved(&place, "--waves 4 --grid 64 --cell 1e-3 --rms 5e-7 --young 2e8 --poisson 0.3 --pressure 5e4 --out b");
    assert_eq!(with_units["area_fraction"], bare["area_fraction"]);
    assert!(place.bytes("a/scene.toml") == place.bytes("b/scene.toml"));
    place.write("b.toml", "waves = 4\npressure = \"50mm\"\n");
    assert_refused(
        &place.run(&["solve", "b.toml"]),
        "line 2: pressure: must be a pressure in Pa, or with a unit such as 10kPa, not '50mm', which is a length",
    );
    for (words, expected) in [
        ("solve --waves 4 --cell 5N --pressure 1e5", "not '5N', which is a force"),
        ("solve --waves 4 --pressure 10KPa", "'KPa' is not a known unit"),
        ("sweep --waves 4 --pressures 1mm,2mm --out s", "not '1mm', which is a length"),
        ("surface --waves 4 --rms 1kPa", "which is a pressure"),
        ("solve --waves 4 --pressure 1e5 --force 1N", "both pressure and force are given; give exactly one"),
        ("solve --waves 4 --force -1N", "force: must be positive"),
        (
            "solve --shape sphere --radius 1mm --force 1N",
            "shape: a shape alone needs cell (m), and e_star (Pa) or young",
        ),
        ("solve --radius 1mm --pressure 1e5", "radius: belongs to a shape; give --shape too"),
    ] {
        assert_refused(&place.run(&words.split(' ').collect::<Vec<_>>()), expected);
    }
}
