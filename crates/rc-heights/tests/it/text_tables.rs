//! Tests of tables that are no plain map: counters, coordinates, titles, sizes and units of programs and instruments.

use rc_heights::{Format, HeightMap, ReadNote, ReadParams, Unit, format_of, may_have_sides, read};

const NX: usize = 12;
const NY: usize = 9;

/// A height that is no whole number.
fn height(ix: usize, iy: usize) -> f64 {
    ((ix * 7 + iy * 5) as f64).sin()
}

/// The rows of the map. `begin` makes what is before the heights of a row.
fn rows(separator: &str, decimal: &str, begin: impl Fn(usize) -> String) -> String {
    let cell = |ix, iy| format!("{:.5}", height(ix, iy)).replace('.', decimal);
    let row = |iy: usize| begin(iy) + &(0..NX).map(|ix| cell(ix, iy)).collect::<Vec<_>>().join(separator) + "\n";
    (0..NY).map(row).collect()
}

fn plain(separator: &str) -> String {
    rows(separator, ".", |_| String::new())
}

/// The points of the map, at distances of 0.5 and 0.25. `begin` makes what is before a point.
fn points(separator: &str, begin: impl Fn(usize) -> String) -> String {
    let point = |i: usize| {
        let (ix, iy) = (i % NX, i / NX);
        let [x, y] = [0.5 * ix as f64, 0.25 * iy as f64];
        begin(i) + &format!("{x:.3}{separator}{y:.3}{separator}{:.5}\n", height(ix, iy))
    };
    (0..NX * NY).map(point).collect()
}

/// Fifty lines.
fn lines(line: impl Fn(usize) -> String) -> String {
    (0..50).map(line).collect::<Vec<_>>().join("\n") + "\n"
}

/// Numbers joined by `separator`.
fn list(separator: &str, number: impl Fn(usize) -> String) -> String {
    (0..NX).map(number).collect::<Vec<_>>().join(separator)
}

/// Reads a text as a file with the extension `extension`.
fn open(extension: &str, text: &str) -> Result<HeightMap, String> {
    let dir = tempfile::tempdir().expect("a temporary folder");
    let path = dir.path().join(format!("map.{extension}"));
    std::fs::write(&path, text).expect("a text");
    let map = read(&path).map_err(|error| error.to_string());
    if map.as_ref().is_ok_and(|map| map.sides.is_some()) {
        assert_eq!(may_have_sides(&path, &ReadParams::default()), Ok(true), "{text}");
    }
    map
}

/// Asserts heights times `factor` (`None` if their unit is not named), and sides in m or without unit.
fn assert_map(text: &str, map: &HeightMap, factor: Option<f64>, sides: Option<([f64; 2], Unit)>) {
    let grid = map.heights.grid();
    assert_eq!((grid.nx(), grid.ny()), (NX, NY), "{text}");
    let off = |i: usize| (map.heights.values()[i] - factor.unwrap_or(1.0) * height(i % NX, i / NX)).abs();
    let worst = (0..grid.len()).map(off).fold(0.0, f64::max);
    assert!(worst < 6e-6 * factor.unwrap_or(1.0), "{text}: off by {worst}");
    assert_eq!(map.height_unit, if factor.is_some() { Unit::Metre } else { Unit::Unnamed }, "{text}");
    match (map.sides, sides) {
        (Some(found), Some((sides, unit))) => {
            let near = (0..2).all(|k| (found[k] / sides[k] - 1.0).abs() < 1e-9);
            assert!(near && map.side_unit == unit, "{text}: {found:?} {:?}", map.side_unit);
        }
        (found, sides) => assert_eq!(found, sides.map(|(sides, _)| sides), "{text}"),
    }
}

#[test]
fn numbers_of_rows_and_columns_are_left_out_where_they_are_known() {
    let (row, column) = (ReadNote::Counter { what: "row" }, ReadNote::Counter { what: "column" });
    let number = |i: usize| i.to_string();
    let both = || vec![column.clone(), row.clone()];
    let cases = [
        (format!(",{}\n{}", list(",", number), rows(",", ".", |iy| format!("{iy},"))), both()),
        (format!(";{}\n{}", list(";", number), rows(";", ",", |iy| format!("{iy};"))), both()),
        (format!("\t{}\n{}", list("\t", number), rows("\t", ".", |iy| format!("{iy}\t"))), both()),
        (format!("   {}\n{}", list("  ", number), rows("  ", ".", |iy| format!("{iy}  "))), both()),
        (format!("index,{}\n{}", list(",", number), rows(",", ".", |iy| format!("{iy},"))), both()),
        (format!("{}\n{}", list(",", number), plain(",")), vec![row.clone()]),
        (format!("{}\n{}", list("\t", |i| format!("\"{i}\"")), plain("\t")), vec![row.clone()]),
        (
            format!("DataLine,{}\n{}", list(",", |i| format!("POS = {i}")), rows(",", ".", |iy| format!("{iy},"))),
            vec![column.clone()],
        ),
        (
            format!("Row;{}\n{}", list(";", |i| format!("C{i}")), rows(";", ",", |iy| format!("{};", iy + 1))),
            vec![column.clone()],
        ),
        (
            format!("{}\n{}", list(" ", |i| format!("\"V{i}\"")), rows(" ", ".", |iy| format!("\"{}\" ", iy + 1))),
            vec![column.clone()],
        ),
        (plain(","), Vec::new()),
    ];
    for (text, notes) in cases {
        let map = open("csv", &text).unwrap_or_else(|error| panic!("{text}: {error}"));
        assert_map(&text, &map, None, None);
        assert_eq!(map.notes, notes, "{text}");
    }
    // Without a title, nobody knows what a column counts.
    let text = rows(",", ".", |iy| format!("{iy},"));
    assert_eq!(open("csv", &text).expect("a map").heights.grid().nx(), NX + 1);
    // Whole numbers may be heights.
    let levels = "0,1,2,3\n1,0,3,2\n2,3,0,1\n5,5,5,5\n";
    assert_eq!(open("csv", levels).expect("a map").heights.grid().ny(), 4);
}

#[test]
fn coordinates_at_the_borders_are_sides() {
    let x = |i: usize| format!("{:.2}", 0.5 * i as f64);
    let y = |separator: &'static str| move |iy: usize| format!("{:.2}{separator}", 0.25 * iy as f64);
    let (unnamed, metre) = (Some(([6.0, 2.25], Unit::Unnamed)), Some(([6e-6, 2.25e-6], Unit::Metre)));
    let cases = [
        (format!(",{}\n{}", list(",", x), rows(",", ".", y(","))), None, unnamed),
        (format!("\t{}\n{}", list("\t", x), rows("\t", ".", y("\t"))), None, unnamed),
        (format!("y\\x;{}\n{}", list(";", x), rows(";", ",", y(";"))), None, unnamed),
        (format!("y/x [um],{}\n{}", list(",", x), rows(",", ".", y(","))), Some(1e-6), metre),
        (format!("Z units: nm\ny/x (um),{}\n{}", list(",", x), rows(",", ".", y(","))), Some(1e-9), metre),
    ];
    for (text, factor, sides) in cases {
        let map = open("csv", &text).unwrap_or_else(|error| panic!("{text}: {error}"));
        assert_map(&text, &map, factor, sides);
        assert_eq!(map.notes, [], "{text}");
    }
    let falling = format!(",{}\n{}", list(",", x), rows(",", ".", |iy| format!("{:.2},", 2.0 - 0.25 * iy as f64)));
    let map = open("csv", &falling).expect("a map");
    assert_eq!(map.notes, [ReadNote::RowsReversed]);
    assert!((map.heights.at(3, NY - 1) - height(3, 0)).abs() < 1e-5);
    // Titles that are neither: the first number is damaged.
    let error = open("csv", "l,2,5,3\n4,5,6,7\n7,8,9,1\n3,4,4,4\n").expect_err("damaged");
    assert!(error.contains("line 1, value 1: 'l'"), "{error}");
}

#[test]
fn sizes_and_units_are_those_that_the_heading_names() {
    let um = |x: f64, y: f64| Some(([x * 1e-6, y * 1e-6], Unit::Metre));
    let headings = [
        ("XResolution[um],0.5\nYResolution[um],0.25\nZUnit,nm\n", Some(1e-9), um(6.0, 2.25)),
        ("X Resolution (um): 0.5\nY Resolution (um): 0.25\nZ unit: nm\n", Some(1e-9), um(6.0, 2.25)),
        ("XResolution[um];0,5\nYResolution[um];0,25\n", Some(1e-6), um(6.0, 2.25)),
        ("# XSpacing = 0.5 um\n# YSpacing = 250 nm\n# Value units: nm\n", Some(1e-9), um(6.0, 2.25)),
        ("Spacing X\t0.5 µm\nSpacing Y\t0.25 µm\n", Some(1e-6), um(6.0, 2.25)),
        ("Pixel pitch: 0.5 um/px\nHeight units = mm\n", Some(1e-3), um(6.0, 4.5)),
        ("Lateral resolution (µm),0.5\n", Some(1e-6), um(6.0, 4.5)),
        ("Pixel size 0.5 x 0.25 µm\nZ units nm\n", Some(1e-6), um(6.0, 2.25)),
        ("# nx=12, ny=9, dx=0.5 um, dy=0.25 um\n", Some(1e-6), um(6.0, 2.25)),
        ("Scan Size: 10 um\nExported image units: nm\n", Some(1e-9), um(10.0, 7.5)),
        (
            "Scan size: 5000 nm\nSamps/line: 12\nNumber of lines: 9\nExported image units: nm\n",
            Some(1e-9),
            um(5.0, 3.75),
        ),
        ("Scan size: 10 x 20 um\n", Some(1e-6), um(10.0, 20.0)),
        ("\"XY calibration\",\"500\",\"nm\"\n\"Unit\",\"um\"\n\"Horizontal\",\"12\"\n", Some(1e-6), um(6.0, 4.5)),
        ("# units: um\n# xspacing 0.5\n# yspacing 0.25\n", Some(1e-6), um(6.0, 2.25)),
        ("Width [um]; 10\nHeight [um]; 20\n", Some(1e-6), um(10.0, 20.0)),
        ("dx: 0.5\ndy: 0.25\n", None, Some(([6.0, 2.25], Unit::Unnamed))),
        (
            "WSxM file copyright UAM\nWSxM ASCII Matrix file\nX Amplitude: 10 nm\nY Amplitude: 20 nm\nZ Amplitude: 3.1 Å\n\n",
            Some(1e-10),
            um(0.01, 0.02),
        ),
        ("Resolution: 512\n", None, None),
    ];
    for (heading, factor, sides) in headings {
        for separator in ["\t", " ", ","] {
            if heading.contains("Z units nm") && separator == " " {
                continue;
            }
            let text = heading.to_owned() + &plain(separator);
            for text in [text.clone(), text.replace('\n', "\r\n")] {
                let map = open("txt", &text).unwrap_or_else(|error| panic!("{text}: {error}"));
                assert_map(&text, &map, factor, sides);
            }
        }
    }
    for count in
        ["PixelsX,13\nPixelsY,9\n", "ncol: 12\nnrow: 10\n", "Samps/line: 12\nNumber of lines: 512\n", "PixelsY,8\n"]
    {
        let error = open("csv", &(count.to_owned() + &plain(","))).expect_err(count);
        assert!(error.contains("truncated") && !error.contains('\n'), "{error}");
    }
    let error = open("txt", &("Exported image units: V\n".to_owned() + &plain(" "))).expect("a map");
    assert_eq!(error.height_unit, Unit::NotLength);
}

#[test]
fn an_export_of_nanoscope_as_text_has_the_size_and_unit_of_its_header() {
    let header = "\\*File list\r\n\\Version: 0x05120130\r\n\\*Ciao scan list\r\n\\Scan size: 9000 nm\r\n\\Samps/line: 12\r\n\
         \\*Ciao image list\r\n\\Samps/line: 12\r\n\\Number of lines: 9\r\n\\Scan size: 6 4.5 ~m\r\n\\@2:Image Data: S [Height] \"Height\"\r\n\
         \\*File list end\r\n\\Exported image units: nm\r\n";
    let filler = "\\@Sens. Zscan: V 10.0 nm/V\r\n".repeat(300);
    let quoted = header.lines().map(|line| format!("\"{line}\"")).collect::<Vec<_>>().join("\n") + "\n";
    for header in [header.to_owned(), header.replacen("\\*Ciao scan", &(filler + "\\*Ciao scan"), 1), quoted] {
        let text = header + &plain("\t");
        let map = open("txt", &text).unwrap_or_else(|error| panic!("{error}"));
        assert_map("Nanoscope", &map, Some(1e-9), Some(([6e-6, 4.5e-6], Unit::Metre)));
    }
}

#[test]
fn titles_of_points_may_be_comments_and_leave_other_columns_out() {
    let (unnamed, um, mm) =
        (([6.0, 2.25], Unit::Unnamed), ([6e-6, 2.25e-6], Unit::Metre), ([6e-3, 2.25e-3], Unit::Metre));
    let none = |_| String::new();
    let counter = vec![ReadNote::Counter { what: "column" }];
    let cases = [
        (format!("# x [um]  y [um]  z [nm]\n{}", points("  ", none)), Some(1e-9), um, vec![]),
        (format!("% X(mm),Y(mm),Z(um)\n{}", points(",", none)), Some(1e-6), mm, vec![]),
        (format!("X (mm)\tY (mm)\tZ (µm)\n{}", points("\t", none)), Some(1e-6), mm, vec![]),
        (format!("\"x [um]\";\"y [um]\";\"z\"\n{}", points(";", none)), Some(1e-6), um, vec![]),
        (format!("x_um,y_um,height\n{}", points(",", none)), Some(1e-6), um, vec![]),
        (
            format!("WSxM file copyright UAM\nWSxM ASCII XYZ file\nX[um]\tY[um]\tZ[nm]\n\n{}", points("\t", none)),
            Some(1e-9),
            um,
            vec![],
        ),
        (format!("# units: um\n{}", points(" ", none)), Some(1e-6), um, vec![]),
        (format!(",x,y,z\n{}", points(",", |i| format!("{i},"))), None, unnamed, counter.clone()),
        (
            format!("Point;X [um];Y [um];Z [nm]\n{}", points(";", |i| format!("{};", i + 1))),
            Some(1e-9),
            um,
            counter.clone(),
        ),
        (format!(",0,1,2\n{}", points(",", |i| format!("{i},"))), None, unnamed, counter),
        (format!("0,1,2\n{}", points(",", none)), None, unnamed, vec![ReadNote::Counter { what: "row" }]),
        (format!("x,y,z,intensity\n{}", points(",", none).replace('\n', ",17\n")), None, unnamed, vec![]),
        (points(",", none).replace('\n', ",\n"), None, unnamed, vec![]),
    ];
    for (text, factor, sides, notes) in cases {
        let map = open("csv", &text).unwrap_or_else(|error| panic!("{text}: {error}"));
        assert_map(&text, &map, factor, Some(sides));
        assert_eq!(map.notes, notes, "{text}");
    }
}

#[test]
fn texts_of_programs_are_known_by_their_first_words_whatever_they_are_called() {
    let dir = tempfile::tempdir().expect("a temporary folder");
    let grid = b"NCOLS 3\nNROWS 2\nXLLCENTER 0\nYLLCENTER 0\nCELLSIZE 2\n4 -9999 6\n1 2 3\n".to_vec();
    let zygo = crate::build::zygo("XYZ", "0 0 4\n1 0 No Data\n2 0 6\n0 1 1\n1 1 2\n2 1 3\n#\n");
    for (bytes, format) in [(grid, Format::EsriGrid), (zygo, Format::Zygo)] {
        for name in ["map.asc", "map.txt", "map.grd", "map.csv", "map.xyz", "map.dat", "map"] {
            let path = dir.path().join(name);
            std::fs::write(&path, &bytes).expect(name);
            assert_eq!(format_of(&path), Ok(format), "{name}");
            assert_eq!(may_have_sides(&path, &ReadParams::default()), Ok(true), "{name}");
            let map = read(&path).expect(name);
            assert_eq!(
                (map.heights.grid().nx(), map.missing(), map.notes),
                (3, 1, vec![ReadNote::RowsReversed]),
                "{name}"
            );
        }
    }
    let strangers: [(&str, &[u8], &str); 3] = [
        ("part.stl", b"solid part\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n", "STL"),
        (
            "scan.top",
            b"WSxM file copyright Nanotec Electronica\nSxM Image file\nImage header size: 2048\n\0\x01",
            "WSxM",
        ),
        ("part.txt", b"ply\nformat ascii 1.0\n", "PLY"),
    ];
    for (name, bytes, what) in strangers {
        let path = dir.path().join(name);
        std::fs::write(&path, bytes).expect(name);
        let error = read(&path).expect_err(name).to_string();
        assert!(error.contains(what) && error.contains("; ") && !error.contains('\n'), "{error}");
    }
}

#[test]
fn every_kind_of_profile_is_called_a_profile() {
    let profile = |separator: &str| lines(|i| format!("{i}e-6{separator}{:.4}e-9", height(i, 0)));
    let line = |x: &str, y: &str| {
        let at = |coordinate: &str, i: usize| coordinate.replace('i', &i.to_string());
        lines(|i| format!("{} {} {:.4}", at(x, i), at(y, i), height(i, 0)))
    };
    let texts = [
        profile(","),
        profile(";"),
        profile("\t"),
        profile(" "),
        "x,z\n".to_owned() + &profile(","),
        "x [um]\tz [nm]\n".to_owned() + &profile("\t"),
        "# x z\n".to_owned() + &profile(" "),
        "Spacing: 0.5 um\n".to_owned() + &lines(|i| format!("{:.4}", height(i, 0))),
        lines(|i| format!("{:.4}", height(i, 0))),
        list(" ", |i| format!("{:.4}", height(i, 0))) + "\n",
        line("i", "0"),
        line("3.5", "i"),
    ];
    for text in texts {
        let error = open("txt", &text).expect_err(&text);
        assert!(error.contains("profile") && !error.contains("matrix") && !error.contains('\n'), "{text}: {error}");
    }
}

#[test]
fn two_maps_in_one_text_are_doubted_and_blank_lines_are_not() {
    let dir = tempfile::tempdir().expect("a temporary folder");
    let path = dir.path().join("map.txt");
    let notes = |text: String| {
        std::fs::write(&path, text).expect("a file");
        read(&path).expect("a map").notes.into_iter().filter(ReadNote::is_assumption).collect::<Vec<_>>()
    };
    let one = plain(" ");
    assert_eq!(notes(one.clone() + "\n" + &one), [ReadNote::Blocks { blocks: 2, rows: NY }]);
    assert_eq!(notes(one.clone() + "# frame 2\n" + &one), [ReadNote::Blocks { blocks: 2, rows: NY }]);
    assert_eq!(notes(one.replace('\n', "\n\n")), []);
    assert_eq!(notes("# map\n\n".to_owned() + &one + "\n\n"), []);
}
