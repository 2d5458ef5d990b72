//! Tests of the order of rows: row 0 of a map is the lowest, whatever the order in the file is.

use rc_heights::{Format, ReadNote, Unit, parse, read};

use crate::build;
use crate::files::{expected, folder};

#[test]
fn the_top_of_a_picture_is_the_last_row() {
    // 1 2 3 above 4 5 6 in the file, in the unit of the file.
    for (name, format, bytes) in build::all() {
        let map = parse(&bytes, format).expect(name);
        let is_reversed = map.notes.contains(&ReadNote::RowsReversed);
        if format == Format::Csv {
            assert_eq!(is_reversed, name.contains("Gwyddion") || name.contains("UTF-16"), "{name}");
            continue;
        }
        // The measurement is in other tags than the picture.
        let is_top_first = format.first_row_is_top() && name != "tiff of Park";
        assert_eq!(is_reversed, is_top_first, "{name}");
        if map.heights.grid().len() == 6 {
            let is_lower_first = map.heights.at(0, 0) > map.heights.at(0, 1);
            assert_eq!(is_lower_first, is_reversed, "{name}: {:?}", map.heights.values());
        }
    }
}

#[test]
fn every_program_gives_the_same_picture() {
    // The first row of expected.csv is the first in each of these files. All have the same heights and a known order.
    let expected = expected();
    for (name, top) in [
        ("gwyfile.gwy", true),
        ("surfalize.x3p", false),
        ("surfalize.sur", true),
        ("gwyddion.txt", true),
        ("python.al3d", true),
        ("python-32bit.spm", false),
        ("python-int16.opd", false),
        ("igorwriter.ibw", false),
        ("expected.asc.gz", false),
    ] {
        let map = read(&folder().join(name)).expect(name);
        let scale = if map.height_unit == Unit::Unnamed { 1.0 } else { 1e-9 };
        let row = if top { 7 } else { 0 };
        for ix in 0..12 {
            let (found, wanted) = (map.heights.at(ix, row), scale * expected.at(ix, 0));
            assert!((found - wanted).abs() < scale, "{name}, column {ix}: {found}, expected {wanted}");
        }
    }
}

#[test]
fn one_row_has_no_order() {
    let bytes = b"Gwyddion Simple Field 1.0\nXRes = 3\nYRes = 1\n\0\0\0\0".as_slice();
    let bytes = [bytes, &[0; 12]].concat();
    let map = parse(&bytes, Format::Gsf).expect("a row");
    assert!(map.notes.is_empty(), "{:?}", map.notes);
}
