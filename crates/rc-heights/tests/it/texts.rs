//! Tests of texts, archives and their names: refusals, and lines before the numbers.

use std::fmt::Write as _;

use rc_heights::{Format, Layout, ReadParams, Scales, Unit, format_of, may_have_sides, read, read_with};

use crate::files::folder;

#[test]
fn the_numbers_of_a_text_are_found_behind_any_number_of_comments() {
    let dir = tempfile::tempdir().expect("a temporary folder");
    let path = dir.path().join("map.txt");
    let comments = (0..600).fold(String::new(), |mut text, i| {
        writeln!(text, "# setting {i} of the instrument").expect("a text");
        text
    });
    std::fs::write(&path, format!("{comments}0 0 1\n1 0 2\n2 0 3\n0 3 4\n1 3 5\n2 3 6\n")).expect("a text");
    assert_eq!(format_of(&path), Ok(Format::Xyz));
    let map = read(&path).expect("a map");
    assert_eq!((map.heights.grid().nx(), map.heights.grid().ny(), map.sides), (3, 2, Some([3.0, 6.0])));
    std::fs::write(&path, format!("{comments}# Width: 3 um\n# Height: 2 um\n1 2 3\n4 5 6\n")).expect("a text");
    assert_eq!(may_have_sides(&path, &ReadParams::default()), Ok(true));
    assert_eq!(read(&path).expect("a map").side_unit, Unit::Metre);
}

#[test]
fn a_profile_is_a_map_only_where_the_user_says_so() {
    let dir = tempfile::tempdir().expect("a temporary folder");
    let path = dir.path().join("profile.csv");
    let text = (0..100).fold("x,z\n".to_owned(), |text, i| text + &format!("{i},{}\n", i * i));
    for text in [text.as_str(), &text[4..]] {
        std::fs::write(&path, text).expect("a text");
        let error = read(&path).expect_err("a profile").to_string();
        // Heights of positions would be advice for a wrong number.
        assert!(error.contains("profile") && !error.contains("matrix") && !error.contains('\n'), "{error}");
        let params = ReadParams { layout: Some(Layout::Matrix), ..ReadParams::default() };
        let map = read_with(&path, &params).expect("a map");
        assert_eq!((map.heights.grid().nx(), map.heights.grid().ny()), (2, 100));
    }
}

#[test]
fn a_text_of_another_quantity_needs_a_scale() {
    let dir = tempfile::tempdir().expect("a temporary folder");
    let path = dir.path().join("map.txt");
    std::fs::write(&path, "# Value units: V\n1 2 3 4\n5 6 7 8\n").expect("a text");
    let map = read(&path).expect("a map");
    assert_eq!(map.height_unit, Unit::NotLength);
    assert!(map.clone().in_metres(Scales::default()).is_err(), "V are not lengths");
    let scaled = map.in_metres(Scales { height_scale: Some(2.0), ..Scales::default() }).expect("a map");
    assert_eq!(scaled.heights.values()[..2], [2.0, 4.0]);
}

#[test]
fn damaged_archives_and_texts_with_zero_bytes_are_refused_by_what_they_should_be() {
    let dir = tempfile::tempdir().expect("a temporary folder");
    let cut = |name: &str| {
        let bytes = std::fs::read(folder().join(name)).expect(name);
        bytes[..bytes.len() / 2].to_vec()
    };
    let zeros: Vec<u8> = "1 2 3\n4 5 6\n".encode_utf16().flat_map(u16::to_le_bytes).collect();
    let files = [
        ("map.plux", cut("python.plux"), "not a valid plux file: the archive is cut off or damaged"),
        ("map.x3p", cut("surfalize.x3p"), "not a valid x3p file: the archive is cut off or damaged"),
        ("map.zip", cut("surfalize.x3p"), "it is a zip archive that is cut off or damaged"),
        ("map.txt", zeros, "byte-order mark"),
    ];
    for (name, bytes, expected) in files {
        let path = dir.path().join(name);
        std::fs::write(&path, bytes).expect(name);
        let error = read(&path).expect_err(name).to_string();
        assert!(error.contains(expected) && !error.contains('\n'), "{error}");
    }
}
