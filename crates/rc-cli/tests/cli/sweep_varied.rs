//! Sweeps over other keys, and sweeps that are continued with more rows.

use crate::support::{Place, assert_refused, assert_solved, text};
use crate::sweep::{TINY, result, table};

/// The sweep with these words, separated by blanks.
fn run(place: &Place, words: &str) -> std::process::Output {
    place.run(&TINY.into_iter().chain(words.split_whitespace()).collect::<Vec<_>>())
}

/// The cells of a column.
fn column(rows: &[Vec<String>], name: &str) -> Vec<String> {
    let at = rows[0].iter().position(|column| column == name).unwrap_or_else(|| panic!("no {name}: {:?}", rows[0]));
    rows[1..].iter().map(|row| row[at].clone()).collect()
}

#[test]
fn varied_keys_have_columns_and_rows_are_those_of_single_solves() {
    let place = Place::new();
    assert_solved(&run(
        &place,
        "--pressures 1e5,200kPa --vary layer-thickness=0.5mm,2mm --vary hardness=5MPa,1e7 --out s",
    ));
    let rows = table(&place.path("s"));
    assert_eq!(column(&rows, "control_value"), ["100000.0", "200000.0"].repeat(4));
    let thickness = ["0.0005"; 4].into_iter().chain(["0.002"; 4]).collect::<Vec<_>>();
    assert_eq!(column(&rows, "layer_thickness"), thickness);
    let hardness = [["5000000.0"; 2], ["10000000.0"; 2]].concat().repeat(2);
    assert_eq!(column(&rows, "hardness"), hardness);
    assert_solved(&place.run(&["report", "s"]));
    let page = text(&place.bytes("s/report.html"));
    assert!(page.contains("layer thickness = 2 mm, hardness = 10 MPa"), "a curve for each variation");
    let words = "solve --waves 4 --grid 128 --quiet --pressure 2e5 --layer-thickness 2e-3 --hardness 5e6 --out one";
    assert_solved(&place.run(&words.split(' ').collect::<Vec<_>>()));
    let one = place.json("one/summary.json")["area_fraction"].to_string();
    assert_eq!(column(&rows, "area_fraction")[5], one);
    let refused = run(&place, "--pressures 1e5 --vary hardness=1e4,1e7 --out t");
    assert_refused(&refused, "hardness: 10000 Pa cannot bear a mean pressure of 100000 Pa");
    assert_refused(&run(&place, "--pressures 1e5 --vary pressure=1,2 --out t"), "give --pressures");
    assert_refused(&run(&place, "--pressures 1e5 --vary hardness=1mm --out t"), "which is a length");
    // A list of forces, each with its mean pressure on the cell of 1e-4 m².
    assert_refused(&run(&place, "--pressure 1e5 --vary force=10N,20N --out t"), "a sweep has one control");
    assert_solved(&run(&place, "--vary force=10N,20N --out forces"));
    let rows = table(&place.path("forces"));
    assert_eq!(column(&rows, "force"), ["10.0", "20.0"]);
    let pressures: Vec<f64> =
        column(&rows, "control_value").iter().map(|cell| cell.parse().expect("a number")).collect();
    assert!((pressures[0] / 1e5 - 1.0).abs() < 1e-12 && (pressures[1] / 2e5 - 1.0).abs() < 1e-12, "{pressures:?}");
}

/// The page of a varied sweep has one command, which gives the same rows.
#[test]
fn the_command_of_the_page_repeats_a_varied_sweep() {
    for words in [
        "--pressures 1e5,2e5 --seeds 1..2 --vary layer-thickness=0.5mm,2mm --vary kernel=love,spectral --out s",
        "--e-star 1e9 --vary cell=1mm,2mm --vary force=1N,2N --out s",
    ] {
        let place = Place::new();
        assert_solved(&run(&place, words));
        assert_solved(&place.run(&["report", "s"]));
        let page = text(&place.bytes("s/report.html"));
        let commands: Vec<&str> = page.match_indices("rc sweep --").map(|(at, _)| &page[at..]).collect();
        let [command] = commands[..] else { panic!("{} commands for {words}", commands.len()) };
        let command = command.split('"').next().expect("the end of a text");
        assert_solved(&place.run(&command.split(' ').skip(1).collect::<Vec<_>>()));
        assert_eq!(result(&place.path("again")), result(&place.path("s")), "{command}");
    }
}

#[test]
fn more_seeds_and_loads_keep_the_rows_that_exist() {
    let place = Place::new();
    for fields in ["", " --fields"] {
        let (short, whole) = (format!("short{fields}"), format!("whole{fields}"));
        let [short, whole] = [&short, &whole].map(|name| name.replace(" --", "-"));
        assert_solved(&run(&place, &format!("--pressures 1e5,4e5 --seeds 2,3 --threads 1 --out {short}{fields}")));
        let first = place.bytes(&format!("{short}/sweep.jsonl"));
        let more = "--pressures 1e5,2e5,4e5 --seeds 1..3 --threads 1";
        let resumed = run(&place, &format!("{more} --out {short} --resume{fields}"));
        assert_solved(&resumed);
        assert_solved(&run(&place, &format!("{more} --out {whole}{fields}")));
        assert_eq!(result(&place.path(&short)), result(&place.path(&whole)));
        // The times of the rows that exist are those of the first run.
        let lines = text(&place.bytes(&format!("{short}/sweep.jsonl")));
        for line in text(&first).lines().skip(1) {
            let cells = line.split_once("\"cells\":").expect("cells").1.split_once(",\"crc32\"").expect("a checksum").0;
            assert!(lines.contains(cells), "{cells} was solved again");
        }
        if fields.is_empty() {
            continue;
        }
        for row in 1..=9 {
            let [a, b] = [&short, &whole].map(|name| place.bytes(&format!("{name}/rows/{row:04}/pressure.npy")));
            assert!(a == b, "row {row} has the fields of another one");
        }
        assert_eq!(place.names(&format!("{short}/rows")).len(), 9, "hidden folders are left");
    }
    // A sweep without all the rows is another one.
    assert_refused(
        &run(&place, "--pressures 1e5,4e5 --seeds 1..2 --out short --resume"),
        "the number of surfaces is 3 in the folder and 2 now",
    );
    assert_refused(
        &run(&place, "--pressures 1e5,2e5,3e5,4e5 --seeds 1..3 --rms 1e-5 --out short --resume"),
        "this folder holds another sweep",
    );
}
