//! Tests of files of microscopes and profilers, which are built byte by byte in every variant.

use rc_heights::{Format, FormatError, HeightMap, ReadParams, Scales, Unit, channels_of, parse, parse_with};

use crate::build_instruments::{self, f32s, i16s, with};
use crate::build_microscopes as build;
use crate::built::{assert_map, read};
use crate::instruments::assert_map_rounded;
use crate::parts::HEIGHTS;

/// Sides of the built files, which have 2 µm x 3 µm between points.
const SIDES: Option<[f64; 2]> = Some([6e-6, 6e-6]);

/// Asserts heights of 1 to 6 nm, of which point 4 is missing.
fn assert_point_4_is_missing(name: &str, map: &HeightMap) {
    assert_eq!(map.missing(), 1, "{name}: {:?}", map.heights.values());
    assert!(map.heights.values()[4].is_nan(), "{name}: {:?}", map.heights.values());
    assert!((map.heights.values()[5] - 6e-9).abs() < 1e-14, "{name}: {:?}", map.heights.values());
}

fn listed(bytes: &[u8], format: Format) -> Vec<(String, bool)> {
    let channels = channels_of(bytes, format, &ReadParams::default()).expect("channels");
    channels.into_iter().map(|channel| (channel.name, channel.is_height)).collect()
}

fn channel(bytes: &[u8], format: Format, name: &str) -> Result<HeightMap, FormatError> {
    parse_with(bytes, format, &ReadParams { channel: Some(name.into()), ..ReadParams::default() })
}

fn list(channels: &[(&str, bool)]) -> Vec<(String, bool)> {
    channels.iter().map(|(name, is_height)| ((*name).to_owned(), *is_height)).collect()
}

#[test]
fn built_files_of_every_kind_are_the_same_map_whatever_they_are_called() {
    for (name, format, bytes) in build::all() {
        let map = read(name, &bytes, format);
        assert_map_rounded(name, &map, SIDES);
        assert_eq!((map.missing(), map.height_unit), (0, Unit::Metre), "{name}");
        assert_eq!(Format::of("map.bin".as_ref(), &bytes), Ok(format), "{name}");
    }
}

#[test]
fn a_name_without_its_mark_is_refused_with_what_the_file_must_begin_with() {
    for (name, expected) in [
        ("a.vk6", "VK6"),
        ("a.nid", "[DataSet]"),
        ("a.stp", "SxM Image file"),
        ("a.opdx", "VCA DATA"),
        ("a.frt", "FRTM_GLIDERV"),
        ("a.bcrf", "fileformat = bcrf"),
    ] {
        let error = Format::of(name.as_ref(), b"other").expect_err(name).to_string();
        assert!(error.contains(expected) && error.lines().count() == 1, "{error}");
    }
    // Other files of WSxM are texts.
    let text = b"WSxM file copyright\nWSxM ASCII Matrix file\n1 2\n";
    assert_eq!(Format::of("map.txt".as_ref(), text), Ok(Format::Csv));
}

#[test]
fn channels_are_listed_and_read_by_name() {
    let nid = build::nid_three();
    let names = list(&[("Deflection", false), ("Z-Axis", true), ("Z-Axis backward", true)]);
    assert_eq!(listed(&nid, Format::Nid), names);
    let back = channel(&nid, Format::Nid, "z-axis backward").expect("the way back");
    assert!((back.heights.values()[0] - 6e-9).abs() < 1e-14, "{:?}", back.heights.values());
    assert_eq!(channel(&nid, Format::Nid, "Deflection").expect("a force").height_unit, Unit::NotLength);
    // A section is one data set, even if the list has it twice.
    let twice = String::from_utf8_lossy(&nid).replace("Gr1-Ch0=C", "Gr1-Ch0=C\r\nGr1-Ch1=A");
    assert_eq!(listed(twice.as_bytes(), Format::Nid).len(), 3);
    let long = build::opdx(&[build::opdx_map(&"n".repeat(600), &build::opdx_items())]);
    let refused = channel(&long, Format::Opdx, "1").expect_err("a long path").to_string();
    assert!(refused.contains("length of the path of a container"), "{refused}");
    // The main map comes first.
    assert_eq!(listed(&build::opdx_two(), Format::Opdx), list(&[("Height", true), ("Intensity", false)]));
    let two = build::vk6(b"VK7", &build_instruments::vk4(16, 2));
    assert_eq!(listed(&two, Format::Vk4), list(&[("Height", true), ("Height 2", true)]));
    assert_map("vk7", &crate::files::as_stored(channel(&two, Format::Vk4, "Height 2").expect("2")), 1e-9, 0.0, SIDES);
    assert_eq!(listed(&build::park_floats(), Format::Tiff), list(&[("Z Height", true)]));
    let mut blocks = build::frt_blocks(build::tenths());
    let image = |kind: u32| [[kind, 3, 2, 16].map(u32::to_le_bytes).concat(), i16s(build::tenths())].concat();
    blocks.push((0x7d, [vec![0; 8], image(2), image(0x1000_0004)].concat()));
    let frt = build::frt(&blocks);
    let names = list(&[("Intensity", false), ("Topography of the bottom sensor", true)]);
    assert_eq!(listed(&frt, Format::Frt), names);
    assert_map("images", &read("images", &frt, Format::Frt), 1e-9, 0.0, SIDES);
}

#[test]
fn missing_points_have_the_marks_of_their_format() {
    let mut floats = HEIGHTS;
    floats[4] = f64::NAN;
    let mut items = build::opdx_items();
    items[1] = build::matrix(3, &floats);
    let opdx = build::opdx(&[build::opdx_map("Height", &items)]);
    assert_point_4_is_missing("opdx", &read("opdx", &opdx, Format::Opdx));
    // The mark, and integers that are not valid: 4 is too low, and 65530 too high.
    for mark in [1.0, 4.0, -6.0] {
        let mut integers = build::tenths();
        integers[4] = mark;
        let frt = build::frt(&build::frt_blocks(integers));
        assert_point_4_is_missing("frt", &read("frt", &frt, Format::Frt));
    }
    let mut integers = HEIGHTS.map(|height| 2.0 * height);
    integers[4] = 32767.0;
    let bcr = build::bcr("bcrstm_unicode", &i16s(integers));
    assert_point_4_is_missing("bcr", &read("bcr", &bcr, Format::Bcr));
    floats[4] = 3.402_823e38;
    let bcr = build::bcr("bcrf", &f32s(&floats));
    assert_point_4_is_missing("bcrf", &read("bcrf", &bcr, Format::Bcr));
}

#[test]
fn numbers_of_every_type_and_byte_order_are_the_same_map() {
    let section = build::nid_section("A", "Scan forward", "Z-Axis", "m");
    let of = |from: &str, to: &str, data: &[u8]| {
        let map = read(to, &build::nid(&section.replace(from, to), data), Format::Nid);
        assert_map_rounded(to, &map, SIDES);
    };
    let big: Vec<u8> = HEIGHTS.iter().flat_map(|height| (*height as i16).to_be_bytes()).collect();
    of("SaveOrder=Intel", "SaveOrder=Motorola", &big);
    let unsigned: Vec<u8> = HEIGHTS.iter().flat_map(|height| (32768 + *height as u16).to_le_bytes()).collect();
    of("SaveSign=Signed", "SaveSign=Unsigned", &unsigned);
    let wide: Vec<u8> = HEIGHTS.iter().flat_map(|height| (65536 * *height as i32).to_le_bytes()).collect();
    of("SaveBits=16", "SaveBits=32", &wide);
    let header = build::WSXM_HEADER;
    for (kind, data) in [("float", f32s(&build::WSXM_NUMBERS)), ("short", i16s(build::WSXM_NUMBERS))] {
        let bytes = build::wsxm(&header.replace("double", kind), &data);
        assert_map(kind, &read(kind, &bytes, Format::Wsxm), 1e-9, 0.0, SIDES);
    }
    let bare = build::wsxm(&header.replace("    Image Data Type: double\r\n", ""), &i16s(build::WSXM_NUMBERS));
    assert_map("without a type", &read("without a type", &bare, Format::Wsxm), 1e-9, 0.0, SIDES);
}

#[test]
fn a_park_image_has_an_offset_and_may_be_turned() {
    // Integers of 2 pm from 1 nm on, scanned along y: the last line is at the left.
    let header = with(build::park_header([2, 3], [6.0, 6.0], true), &[(228, &2e-3_f64.to_le_bytes())]);
    let header = with(header, &[(236, &1e-3_f64.to_le_bytes()), (220, &1e-3_f64.to_le_bytes()), (348, &[0])]);
    let header = with(header, &[(220, &1e-3_f64.to_le_bytes()), (244, b"u\0m\0\0\0")]);
    let map = read("turned", &build::park(&header, &i16s([5.0, 6.0, 3.0, 4.0, 1.0, 2.0])), Format::Tiff);
    assert_eq!((map.heights.grid().nx(), map.heights.grid().ny()), (3, 2));
    for (found, integer) in map.heights.values().iter().zip([1.0, 3.0, 5.0, 2.0, 4.0, 6.0]) {
        assert!((found - (1e-12 + integer * 2e-12)).abs() < 1e-20, "{:?}", map.heights.values());
    }
    let volts = with(build::park_header([3, 2], [6.0, 6.0], false), &[(244, b"V\0\0\0")]);
    let error = parse(&build::park(&volts, &f32s(&HEIGHTS)), Format::Tiff).expect_err("volts").to_string();
    assert!(error.contains("no channel has heights"), "{error}");
}

#[test]
fn headers_that_promise_terabytes_are_refused_before_memory_is_taken() {
    let section = build::nid_section("A", "Scan forward", "Z-Axis", "m").replace("=3\r", "=1048576\r");
    let wsxm = build::WSXM_HEADER.replace(": 3\r", ": 1048576\r");
    let mut items = build::opdx_items();
    // Rows and columns follow the name, the type, two names and lengths.
    let place = items[1].len() - 32;
    items[1] = with(items[1].clone(), &[(place, &[0, 0, 0x10, 0, 0, 0, 0x10, 0])]);
    let mut blocks = build::frt_blocks(build::tenths());
    blocks[1].1 = [1_048_576_u32, 1_048_576, 16].map(u32::to_le_bytes).concat();
    let park = build::park_header([1_048_576; 2], [6.0, 6.0], true);
    let bcr = String::from_utf8(build::bcr("bcrstm", &[0; 12])).expect("a text");
    let bcr = bcr.replace("pixels = 3\n", "pixels=1000000\n").replace("pixels = 2\n", "pixels=1000000\n");
    for (format, bytes) in [
        (Format::Nid, build::nid(&section, &[0; 12])),
        (Format::Wsxm, build::wsxm(&wsxm, &[0; 48])),
        (Format::Opdx, build::opdx(&[build::opdx_map("Height", &items)])),
        (Format::Frt, build::frt(&blocks)),
        (Format::Tiff, build::park(&park, &[0; 24])),
        (Format::Bcr, bcr.into_bytes()),
        (
            Format::Vk4,
            build::vk6(b"VK6", &with(build_instruments::vk4(32, 1), &[(264, &[0, 0, 16, 0]), (268, &[0, 0, 16, 0])])),
        ),
    ] {
        let error = parse(&bytes, format).expect_err("a promise").to_string();
        assert!(error.contains("shorter than its header says"), "{format}: {error}");
    }
}

#[test]
#[expect(clippy::too_many_lines, reason = "a table of cases")]
fn wrong_headers_are_named_with_their_field() {
    let nid = |from: &str, to: &str| {
        let section = build::nid_section("A", "Scan forward", "Z-Axis", "m").replace(from, to);
        (Format::Nid, build::nid(&section, &i16s(HEIGHTS)))
    };
    let wsxm = |from: &str, to: &str| (Format::Wsxm, build::wsxm(&build::WSXM_HEADER.replace(from, to), &[0; 48]));
    let opdx = |at: usize, item: Vec<u8>| {
        let mut items = build::opdx_items();
        items[at] = item;
        (Format::Opdx, build::opdx(&[build::opdx_map("Height", &items)]))
    };
    let frt = |at: usize, content: Vec<u8>| {
        let mut blocks = build::frt_blocks(build::tenths());
        blocks[at].1 = content;
        (Format::Frt, build::frt(&blocks))
    };
    let park = |at: usize, change: &[u8]| {
        let header = with(build::park_header([3, 2], [6.0, 6.0], false), &[(at, change)]);
        (Format::Tiff, build::park(&header, &f32s(&HEIGHTS)))
    };
    let deep = (0..20).fold(Vec::new(), |inner, _| build::container("a", &[inner]));
    let cases = [
        (nid("Points=3", "Points=x"), "Points is 'x'"),
        (nid("SaveBits=16", "SaveBits=24"), "SaveBits is '24'"),
        (nid("SaveMode=Binary", "SaveMode=Text"), "SaveMode is 'Text'"),
        (nid("Dim0Range=6e-6", "Dim0Range=0"), "Dim0Range is '0'"),
        (nid("Dim2Range=65536e-9", "Dim2Range=0"), "Dim2Range is '0'"),
        (nid("Dim2Unit=m", "Dim2Unit=V"), "no channel has heights"),
        ((Format::Nid, b"[DataSet]\r\n".to_vec()), "the mark #!"),
        (wsxm("columns: 3", "columns: -3"), "Number of columns is '-3'"),
        (wsxm("double", "triple"), "Image Data Type is 'triple'"),
        (wsxm("Z Amplitude: 5 nm", "Z Amplitude: nm"), "Z Amplitude is 'nm'"),
        (wsxm("X Amplitude: 6 um", "X Amplitude: 0 um"), "X or Y Amplitude"),
        (wsxm("a", "a"), "Z Amplitude / range of numbers is 'inf'"),
        (wsxm("Z Amplitude: 5 nm", "Z Amplitude: 5 V"), "no channel has heights"),
        ((Format::Wsxm, b"WSxM file copyright UAM\nSxM Image file\n".to_vec()), "[Header end] is missing"),
        ((Format::Wsxm, build::wsxm(build::WSXM_HEADER, &[0; 49])), "longer than its header says"),
        (opdx(0, build::quantity("Scale", 1.0, "m")), "DataScale is missing"),
        (opdx(0, build::quantity("DataScale", 0.0, "m")), "DataScale is '0'"),
        (opdx(2, build::quantity("Dimension1Extent", 1.0, "V")), "Dimension1Extent is 'V'"),
        (opdx(3, build::quantity("Dimension2Extent", -1.0, "m")), "Dimension2Extent is '-1.5'"),
        (opdx(0, build::item("Odd", 0x33, &[])), "type of an item is '51'"),
        (opdx(0, build::item("Odd", 0x13, &[3, 0, 0, 0])), "bytes of a length is '3'"),
        ((Format::Opdx, build::opdx(&[deep])), "depth of containers"),
        ((Format::Opdx, build::opdx(&[])), "the file has no 2-D array"),
        (frt(2, vec![0; 44]), "side along x is '0'"),
        (frt(3, vec![0; 12]), "scale of heights is '0'"),
        (frt(1, [3_u32, 2, 8].map(u32::to_le_bytes).concat()), "bits of a point is '8'"),
        ((Format::Frt, build::frt(&[])), "block 0x67 of the sides is missing"),
        ((Format::Frt, b"FRTM_GLIDERV2.00\0\0".to_vec()), "version is '2.00'"),
        (park(0, &[1]), "a profile of a Park AFM"),
        (park(140, &[0; 8]), "side along x of Park Systems is '0'"),
        (park(220, &[0; 8]), "scale of heights of Park Systems is '0'"),
        (park(348, &[7]), "type of numbers of Park Systems is '7'"),
        ((Format::Bcr, build::bcr("bcrx", &[0; 24])), "fileformat is 'bcrx'"),
        ((Format::Vk4, build::vk6(b"VK6", b"VK5_")), "it must begin with VK4_"),
        ((Format::Vk4, b"VK6\0\0\0\0PK".to_vec()), "not a valid Keyence VK file"),
        ((Format::X3p, crate::build::x3p_list("1 2 3 4 5")), "DataList is '5 elements for 3 x 2 points'"),
        ((Format::X3p, crate::build::x3p_list("1 2 3 4 five 6")), "Datum is 'five'"),
    ];
    for ((format, bytes), expected) in cases {
        let error = parse(&bytes, format).expect_err(expected).to_string();
        assert!(error.contains(expected) && error.lines().count() == 1, "no '{expected}' in: {error}");
    }
}

#[test]
fn a_profile_of_a_stylus_is_named() {
    let profile = build::container("1D_Data", &[build::quantity("Extent", 1.0, "mm")]);
    let bytes = [b"VCA DATA\x01\0\0\x55".to_vec(), profile].concat();
    assert!(matches!(parse(&bytes, Format::Opdx), Err(FormatError::Profile { .. })));
}

/// A Dektak file with a profile alone.
#[test]
fn a_profile_of_a_dektak_is_read_where_one_is_asked_for() {
    let array = |name: &str, values: &[f64]| {
        let content = [vec![0x0d, 8, 0, 0, 0], build::f64s(values)].concat();
        build::item(name, 0x40, &[build::named(b"double *"), build::sized(&content)].concat())
    };
    let file = |places: &[f64]| {
        let items = [
            build::quantity("DataScale", 1e-3, "\u{b5}m"),
            build::quantity("Extent", 6.0, "\u{b5}m"),
            array("PositionArray", places),
            array("Array", &[1.0, -2.0, 3.0, 4.0]),
        ];
        let profiles = build::container("1D_Data", &[build::container("Raw", &items)]);
        [b"VCA DATA\x01\0\0\x55".to_vec(), profiles].concat()
    };
    let params = ReadParams { is_profile: true, ..ReadParams::default() };
    let read = |bytes: &[u8]| parse_with(bytes, Format::Opdx, &params);
    let map = read(&file(&[0.0, 2.0, 4.0, 6.0])).expect("a profile").in_metres(Scales::default()).expect("metres");
    for (found, expected) in map.heights.values().iter().zip([1e-9, -2e-9, 3e-9, 4e-9]) {
        assert!((found / expected - 1.0).abs() < 1e-12, "{found} for {expected}");
    }
    assert!((map.sides.expect("sides")[0] / 8e-6 - 1.0).abs() < 1e-12, "{:?}", map.sides);
    let refused = |result: Result<HeightMap, FormatError>| result.expect_err("no such profile").to_string();
    assert!(refused(read(&file(&[0.0, 1.0, 4.0, 6.0]))).contains("not equally spaced"));
    assert!(refused(read(&file(&[0.0, 2.0, 4.0]))).contains("number of places is '3'"));
    assert!(refused(parse(&file(&[0.0, 2.0, 4.0, 6.0]), Format::Opdx)).contains("or --line"));
}
