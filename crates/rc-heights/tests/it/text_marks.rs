//! Tests of missing points in texts: words, empty fields, and numbers that the file or the user gives.

use rc_heights::{Format, HeightMap, Mask, ReadParams, parse, parse_with};

/// Heights of seven columns and six rows, with the word `mark` in row 2, column 3.
fn text(separator: &str, mark: &str, decimal: &str) -> String {
    let cell = |ix: usize, iy: usize| {
        if (ix, iy) == (3, 2) { mark.to_owned() } else { format!("{:.3}", height(ix, iy)).replace('.', decimal) }
    };
    let row = |iy: usize| (0..7).map(|ix| cell(ix, iy)).collect::<Vec<_>>().join(separator) + "\n";
    (0..6).map(row).collect()
}

/// A height that is no whole number.
fn height(ix: usize, iy: usize) -> f64 {
    0.125 + (ix * ix + 3 * iy * iy) as f64
}

/// Asserts that only the point in row 2, column 3 is missing, and that the others have their heights.
fn assert_one_missing(text: &str, map: &HeightMap, factor: f64) {
    let grid = map.heights.grid();
    assert_eq!((grid.nx(), grid.ny(), map.missing()), (7, 6, 1), "{text}");
    assert!(map.heights.at(3, 2).is_nan(), "{text}");
    let off = |i: usize| (map.heights.values()[i] / (height(i % 7, i / 7) * factor) - 1.0).abs();
    assert!((0..42).filter(|i| *i != 17).all(|i| off(i) < 1e-12), "{text}");
}

#[test]
fn words_are_missing_points_beside_every_separator() {
    let marks = [
        "Bad", "BAD", "bad", "NaN", "nan", "-nan", "NA", "N/A", "#N/A", "null", "NULL", "None", "-1.#IND", "1.#QNAN",
        "No Data", "no data", "NoData", "***", "---", "--", "\"NA\"", "#DIV/0!",
    ];
    for mark in marks {
        for (separator, decimal) in [
            (",", "."),
            (", ", "."),
            (";", "."),
            (";", ","),
            ("\t", "."),
            ("\t", ","),
            (" ", "."),
            ("  ", ","),
            (" ,", "."),
        ] {
            let text = text(separator, mark, decimal);
            let map = parse(text.as_bytes(), Format::Csv).unwrap_or_else(|error| panic!("{text}: {error}"));
            assert_one_missing(&text, &map, 1.0);
            let windows = text.replace('\n', "\r\n");
            assert_one_missing(&windows, &parse(windows.as_bytes(), Format::Csv).expect(&windows), 1.0);
        }
    }
}

#[test]
fn empty_fields_are_missing_points_and_final_separators_are_none() {
    for (separator, decimal) in [(",", "."), (", ", "."), (";", ","), ("\t", "."), ("\t", ",")] {
        let plain = text(separator, "", decimal);
        let closed = plain.replace('\n', &format!("{separator}\n"));
        let quoted = text(separator, "\"\"", decimal);
        for text in [plain, closed, quoted] {
            let map = parse(text.as_bytes(), Format::Csv).unwrap_or_else(|error| panic!("{text}: {error}"));
            assert_one_missing(&text, &map, 1.0);
        }
    }
    // The first and the last field of a row.
    let map = parse(b",2,3\n4,5,\n7,8,9\n", Format::Csv).expect("a map");
    let missing: Vec<usize> = (0..9).filter(|i| map.heights.values()[*i].is_nan()).collect();
    assert_eq!(missing, [0, 5]);
    let map = parse(b"\t2\t3\n4\t5\t\n7\t8\t9\n", Format::Csv).expect("a map");
    assert_eq!(map.missing(), 2);
}

#[test]
fn a_first_row_of_marks_is_a_row_and_infinite_heights_are_refused() {
    for mark in ["NaN", "#N/A", "---", "No Data"] {
        let text = format!("{mark},{mark},{mark}\n1.5,2,3\n4,5,6\n");
        let map = parse(text.as_bytes(), Format::Csv).expect(&text);
        assert_eq!((map.heights.grid().ny(), map.missing()), (3, 3), "{text}");
    }
    for word in ["inf", "-inf", "1.#INF", "1e999"] {
        let error = parse(text(",", word, ".").as_bytes(), Format::Csv).expect_err(word).to_string();
        assert!(error.contains("row 2, column 3") && error.contains("finite"), "{error}");
    }
}

#[test]
fn a_number_marks_missing_points_before_any_unit() {
    let user = |mark: f64| ReadParams { missing: vec![mark], mask: Mask::Use, ..ReadParams::default() };
    let headings = ["# Width: 7 mm\n# Height: 6 mm\n# Value units: nm\n", "height conversion factor (-> m)=1e-9\n"];
    for heading in headings {
        for (word, mark) in
            [("-9999", -9999.0), ("3.4028235e+38", f64::from(f32::MAX)), ("0", 0.0), ("-9999.0000", -9999.0)]
        {
            let text = heading.to_owned() + &text(",", word, ".");
            let map = parse_with(text.as_bytes(), Format::Csv, &user(mark)).expect(&text);
            assert_one_missing(&text, &map, 1e-9);
        }
    }
    // A height in metres that happens to equal the mark is no mark.
    let text = "# Value units: nm\n1 2 5\n4 5 1e9\n";
    assert_eq!(parse_with(text.as_bytes(), Format::Csv, &user(1.0)).expect(text).missing(), 1);
    let points = "x [um],y [um],z [nm]\n0,0,-9999\n1,0,2\n0,1,3\n1,1,4\n";
    assert_eq!(parse_with(points.as_bytes(), Format::Xyz, &user(-9999.0)).expect(points).missing(), 1);
    let grid = "ncols 2\nnrows 2\ncellsize 1\n1 2\n3 -1\n";
    assert_eq!(parse_with(grid.as_bytes(), Format::EsriGrid, &user(-1.0)).expect(grid).missing(), 1);
}

#[test]
fn a_mark_that_the_text_declares_is_applied() {
    let declarations = [
        "NODATA_value -9999",
        "nodata_value: -9999",
        "Bad data value: -9999",
        "# missing value: -9999",
        "NoDataValue=-9999",
        "No data;-9999",
        "% nodata -9999",
        "Missing value,-9999",
        "# Fill value = -9999",
        "\"NoData\",\"-9999\"",
    ];
    for declaration in declarations {
        for unit in ["", "Z units: µm\n"] {
            let text = format!("{declaration}\n{unit}{}", text("\t", "-9999", "."));
            let map = parse(text.as_bytes(), Format::Csv).unwrap_or_else(|error| panic!("{text}: {error}"));
            assert_one_missing(&text, &map, if unit.is_empty() { 1.0 } else { 1e-6 });
        }
    }
    let undeclared = text("\t", "-9999", ".");
    assert_eq!(
        parse(undeclared.as_bytes(), Format::Csv).expect("a map").missing(),
        0,
        "only who knows it may leave it out"
    );
}
