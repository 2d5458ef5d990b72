//! Tests of what a file says is missing: masks of Gwyddion, and scans of Nanoscope that were stopped.

use rc_heights::{Format, FormatError, HeightMap, Mask, ReadNote, ReadParams, Scales, Unit, parse, parse_with};

use crate::build::{gwy, gwy_field};
use crate::build_instruments as build;
use crate::files::as_stored;
use crate::parts::HEIGHTS;

/// A file of 3 x 2 points with a mask.
fn masked(mask: &[f64], grid: [u32; 2]) -> Vec<u8> {
    let heights = gwy_field([3, 2], Some([6e-6, 6e-6]), "m", &HEIGHTS);
    gwy(&[("/0/data", heights), ("/0/mask", gwy_field(grid, None, "", mask))])
}

/// Places of the missing points, in the order of the file.
fn missing(map: HeightMap) -> Vec<usize> {
    let map = as_stored(map);
    let values = map.heights.values();
    (0..values.len()).filter(|i| values[*i].is_nan()).collect()
}

#[test]
fn masked_points_of_gwyddion_are_missing_unless_the_mask_is_ignored() {
    let bytes = masked(&[0.0, 1.0, 0.0, 0.4, 0.5, 0.0], [3, 2]);
    let map = parse(&bytes, Format::Gwy).expect("a map");
    assert_eq!(map.notes, [ReadNote::Masked { points: 2 }, ReadNote::RowsReversed]);
    assert_eq!(missing(map), [1, 4]);
    let ignore = ReadParams { mask: Mask::Ignore, ..ReadParams::default() };
    let map = parse_with(&bytes, Format::Gwy, &ignore).expect("a map");
    assert_eq!((map.missing(), &map.notes[..]), (0, &[ReadNote::RowsReversed][..]));
    let nothing = parse(&masked(&[0.0; 6], [3, 2]), Format::Gwy).expect("a map");
    assert_eq!(nothing.notes, [ReadNote::RowsReversed]);
    for (mask, grid, expected) in [
        (&[0.0; 4][..], [2, 2], "the mask is '2 x 2 points, for 3 x 2'"),
        (&[1.0; 6], [3, 2], "the mask is 'one of all points'"),
        (&[0.0; 5], [3, 2], "shorter than its header says"),
    ] {
        let bytes = masked(mask, grid);
        let error = parse(&bytes, Format::Gwy).expect_err(expected).to_string();
        assert!(error.contains(expected), "{error}");
        assert!(parse_with(&bytes, Format::Gwy, &ignore).is_ok(), "{expected}");
    }
}

#[test]
fn each_channel_of_gwyddion_has_its_own_mask() {
    let field = || gwy_field([3, 2], Some([6e-6, 6e-6]), "m", &HEIGHTS);
    let mask = gwy_field([3, 2], None, "", &[0.0, 0.0, 1.0, 0.0, 0.0, 0.0]);
    // A mask may come before its data, and without any data.
    let bytes = gwy(&[("/1/mask", mask.clone()), ("/0/data", field()), ("/1/data", field()), ("/7/mask", mask)]);
    let of = |channel: &str| {
        let params = ReadParams { channel: Some(channel.to_owned()), ..ReadParams::default() };
        missing(parse_with(&bytes, Format::Gwy, &params).expect(channel))
    };
    assert_eq!((of("1"), of("2")), (vec![], vec![2]));
}

#[test]
fn sides_of_gwyddion_are_known_only_if_the_file_says_them() {
    let read = |sides, unit| parse(&gwy(&[("/0/data", gwy_field([3, 2], sides, unit, &HEIGHTS))]), Format::Gwy);
    for (sides, unit) in [(None, "m"), (None, ""), (Some([1.0, 1.0]), ""), (Some([3.0, 2.0]), "px")] {
        let map = read(sides, unit).expect("a map");
        assert_eq!((map.sides, map.side_unit), (None, Unit::Unnamed), "{sides:?} {unit}");
    }
    assert_eq!(read(Some([1.0, 1.0]), "m").expect("a map").sides, Some([1.0, 1.0]));
    let map = read(Some([30.0, 20.0]), "").expect("a map");
    assert_eq!((map.sides, map.side_unit), (Some([30.0, 20.0]), Unit::Unnamed));
    assert!(map.in_metres(Scales::default()).expect("lengths").sides_are_assumed());
    assert!(read(Some([30.0, 20.0]), "deg").is_err());
}

/// A file of 3 x 4 points with lines `valid` in its header, and `data` of `length` bytes.
fn stopped(valid: &str, version: &str, data: &[u8], length: usize) -> Vec<u8> {
    let image = build::nanoscope_image("Height", build::Z_SCALE, 0)
        .replace("of lines: 2", "of lines: 4")
        .replace("length: 12", &format!("length: {length}"))
        + valid;
    let bytes = build::nanoscope("", &image, data);
    let text = String::from_utf8_lossy(&bytes[..build::NANOSCOPE_HEADER]).replace("0x05310001", version);
    [text.as_bytes(), &bytes[build::NANOSCOPE_HEADER..]].concat()
}

fn i16s(values: std::ops::Range<i16>) -> Vec<u8> {
    values.flat_map(i16::to_le_bytes).collect()
}

/// Name, header, version, data, first line and number of lines, height (nm) of the first measured point.
type Case<'a> = (&'a str, String, &'a str, &'a [u8], [usize; 2], f64);

#[test]
fn lines_that_a_stopped_scan_did_not_measure_are_missing() {
    let lines = |first: usize, n: usize| {
        let is_there = move |i: &usize| (first..first + n).contains(&(i / 3));
        (0..12).filter(|i| !is_there(i)).collect::<Vec<_>>()
    };
    let y = |start: usize, n: usize| {
        format!(
            "\\Valid data start X: 0\r\n\\Valid data start Y: {start}\r\n\\Valid data len X: 3\r\n\\Valid data len Y: {n}\r\n"
        )
    };
    let (all, two, old, new) = (i16s(1..13), i16s(1..7), "0x05310001", "0x09400000");
    let four: Vec<u8> = (1..7_i32).flat_map(i32::to_le_bytes).collect();
    let cases: [Case<'_>; 9] = [
        ("whole", y(0, 4), old, &all, [0, 4], 1.0),
        ("no keys", String::new(), old, &all, [0, 4], 1.0),
        ("valid lines of all", y(0, 2), old, &all, [0, 2], 1.0),
        ("the last lines", y(2, 2), old, &all, [2, 2], 7.0),
        ("only the first lines are stored", y(0, 2), old, &two, [0, 2], 1.0),
        ("only the last lines are stored", y(2, 2), old, &two, [2, 2], 1.0),
        ("a short length", String::new(), old, &two, [0, 2], 1.0),
        ("a short length, all valid", y(0, 4), old, &two, [0, 2], 1.0),
        ("four bytes", y(0, 2), new, &four, [0, 2], 1.0),
    ];
    for (name, valid, version, data, [first, n], height) in cases {
        let bytes = stopped(&valid, version, data, data.len());
        let map = parse(&bytes, Format::Nanoscope).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!((map.heights.grid().nx(), map.heights.grid().ny()), (3, 4), "{name}");
        let found = map.heights.at(0, first);
        assert!((found / (height * 1e-9) - 1.0).abs() < 1e-12, "{name}: {found}");
        let notes = if n < 4 { vec![ReadNote::Unfinished { rows: n, all: 4 }] } else { vec![] };
        assert_eq!(map.notes, notes, "{name}");
        assert_eq!(map.sides, parse(&stopped("", old, &all, 24), Format::Nanoscope).expect("whole").sides, "{name}");
        assert_eq!(missing(map), lines(first, n), "{name}");
    }
}

#[test]
fn columns_that_a_scan_did_not_measure_are_missing() {
    let valid =
        "\\Valid data start X: 1\r\n\\Valid data start Y: 1\r\n\\Valid data len X: 2\r\n\\Valid data len Y: 3\r\n";
    let expected = [0, 1, 2, 3, 6, 9];
    let whole = parse(&stopped(valid, "0x05310001", &i16s(1..13), 24), Format::Nanoscope).expect("whole");
    assert!((whole.heights.at(1, 1) / 5e-9 - 1.0).abs() < 1e-12, "{}", whole.heights.at(1, 1));
    let packed = parse(&stopped(valid, "0x05310001", &i16s(1..7), 12), Format::Nanoscope).expect("packed");
    assert!((packed.heights.at(1, 1) / 1e-9 - 1.0).abs() < 1e-12, "{}", packed.heights.at(1, 1));
    assert!((packed.heights.at(2, 3) / 6e-9 - 1.0).abs() < 1e-12, "{}", packed.heights.at(2, 3));
    assert_eq!((missing(whole), missing(packed)), (expected.to_vec(), expected.to_vec()));
}

#[test]
fn a_damaged_length_of_a_scan_is_refused() {
    // Nothing is there, or the file is shorter than its list says.
    for (data, length) in [(vec![], 0), (i16s(1..4), 4), (i16s(1..4), 24), (i16s(1..4), 12)] {
        let error = parse(&stopped("", "0x05310001", &data, length), Format::Nanoscope).expect_err("damage");
        assert!(matches!(error, FormatError::CutShort { .. }), "{error}");
    }
    // One line of a million is no map, and takes no memory.
    let image = build::nanoscope_image("Height", build::Z_SCALE, 0).replace("of lines: 2", "of lines: 1000000");
    let error = parse(&build::nanoscope("", &image, &build::i16s(HEIGHTS)), Format::Nanoscope).expect_err("a promise");
    assert!(matches!(error, FormatError::CutShort { .. }), "{error}");
}

#[test]
fn objects_of_digital_surf_are_surfaces_if_they_have_lines() {
    let of = |kind: u16, lines: u32| {
        let bytes = build::with(build::sur(HEIGHTS), &[(18, &kind.to_le_bytes())]);
        build::with(bytes, &[(108, &(6 / lines).to_le_bytes()), (112, &lines.to_le_bytes())])
    };
    let surface = parse(&of(2, 2), Format::Sur).expect("a surface");
    // Gwyddion writes surfaces as type 1. A series of surfaces, layers and intensities have surfaces.
    for kind in [1, 5, 8, 11, 13, 16] {
        assert_eq!(parse(&of(kind, 2), Format::Sur), Ok(surface.clone()), "{kind}");
    }
    for (kind, lines, expected) in [
        (1, 1, "a profile, not a map"),
        (4, 2, "a series of profiles"),
        (6, 2, "polar"),
        (7, 1, "a profile of several layers"),
        (14, 1, "a force curve"),
        (17, 1, "a contour"),
        (3, 2, "no channel has heights"),
        (12, 2, "no channel has heights"),
    ] {
        let error = parse(&of(kind, lines), Format::Sur).expect_err(expected).to_string();
        assert!(error.contains(expected), "{error}");
    }
    // A profile that is asked for is read, whose axis y has no unit and no step.
    let profile = build::with(of(1, 1), &[(124, &[0; 4]), (196, &[0; 2])]);
    let params = rc_heights::ReadParams { is_profile: true, ..rc_heights::ReadParams::default() };
    let profile = rc_heights::parse_with(&profile, Format::Sur, &params).expect("a profile");
    // The rows of the surface are reversed.
    assert_eq!(profile.heights.values()[..3], surface.heights.values()[3..]);
    let length = profile.sides.expect("sides")[0];
    assert!((length / 12e-6 - 1.0).abs() < 1e-6, "{length}");
    // A surface beside a profile is read.
    let both = [of(1, 1), of(2, 2)].concat();
    assert_eq!(parse(&both, Format::Sur).map(|map| map.heights), Ok(surface.heights));
}
