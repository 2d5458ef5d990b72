//! Tests of readers with files that are built byte by byte from specifications.
//!
//! Headers that claim too much or make no sense are refused.

use rc_heights::{Format, HeightMap, LengthUnit, Scales, Unit, parse};
use zip::CompressionMethod;

use crate::build;
use crate::files::as_stored;
use crate::parts::HEIGHTS;

/// Asserts that heights are `scale` times 1 to 6 plus `offset`, within rounding.
///
/// Sides must be as given.
pub(crate) fn assert_map(name: &str, map: &HeightMap, scale: f64, offset: f64, sides: Option<[f64; 2]>) {
    assert_eq!((map.heights.grid().nx(), map.heights.grid().ny()), (3, 2), "{name}");
    for (found, height) in map.heights.values().iter().zip(HEIGHTS) {
        let expected = scale * height + offset;
        assert!((found - expected).abs() <= 1e-12 * expected.abs(), "{name}: {found}, expected {expected}");
    }
    let difference = |(a, b): (&[f64; 2], &[f64; 2])| a.iter().zip(b).all(|(a, b)| (a / b - 1.0).abs() < 1e-12);
    assert_eq!(map.sides.is_some(), sides.is_some(), "{name}: {:?}", map.sides);
    assert!(map.sides.iter().zip(&sides).all(difference), "{name}: {:?}, expected {sides:?}", map.sides);
}

/// The map of a file, with rows in the order of the file.
pub(crate) fn read(name: &str, bytes: &[u8], format: Format) -> HeightMap {
    as_stored(parse(bytes, format).unwrap_or_else(|error| panic!("{name}: {error}")))
}

#[test]
fn surfer_grids_of_all_versions_are_the_same_map() {
    let sides = Some([6.0, 6.0]);
    let mut files = vec![build::surfer_text("1 2 3\n4 5 6"), build::surfer_6(HEIGHTS)];
    files.extend([1, 2].map(|version| build::surfer_7(version, HEIGHTS, 1.70141e38)));
    for bytes in files {
        let map = read("grd", &bytes, Format::Surfer);
        assert_map("grd", &map, 1.0, 0.0, sides);
        assert_eq!((map.height_unit, map.side_unit), (Unit::Unnamed, Unit::Unnamed));
    }
}

#[test]
fn missing_points_are_missing_in_every_format_that_has_them() {
    let mut heights = HEIGHTS;
    heights[4] = 1.70141e38;
    let mut low = HEIGHTS;
    low[4] = -9999.0;
    let i16s: Vec<u8> = [1, 2, 3, 4, i16::MIN, 6].iter().flat_map(|v| v.to_le_bytes()).collect();
    let files = [
        (Format::Csv, b"1 2 3\n4 nan 6".to_vec()),
        (Format::Xyz, b"0 0 1\n1 0 2\n2 0 3\n0 1 4\n2 1 6\n".to_vec()),
        (Format::Surfer, build::surfer_text("1 2 3\n4 1.70141e+038 6")),
        (Format::Surfer, build::surfer_6(heights)),
        (Format::Surfer, build::surfer_7(1, heights, 1.70141e38)),
        (Format::Surfer, build::surfer_7(2, low, -9999.0)),
        (Format::Sdf, build::sdf_text("1 2 3\r\n4 BAD 6")),
        (Format::Sdf, build::sdf_binary("ISO-1.0", 5, &i16s)),
        (Format::X3p, build::x3p(CompressionMethod::Deflated)),
        (Format::X3p, build::x3p_list("1 2 3 4 - 6")),
    ];
    for (format, bytes) in files {
        let map = read(&format.to_string(), &bytes, format);
        assert_eq!(map.missing(), 1, "{format}");
        assert!(map.heights.values()[4].is_nan(), "{format}: {:?}", map.heights.values());
    }
}

#[test]
fn a_simple_field_has_its_units() {
    let map = read("gsf", &build::gsf(build::GSF_FIELDS), Format::Gsf);
    assert_map("gsf", &map, 1e-9, 0.0, Some([6e-6, 9e-6]));
    let bare = read("gsf", &build::gsf("XRes=3\nYRes=2\n"), Format::Gsf);
    assert_map("gsf", &bare, 1.0, 0.0, None);
    assert_eq!((map.height_unit, bare.height_unit), (Unit::Metre, Unit::Unnamed));
    // Sides of 1 without a unit are the default of the format. Others are lengths in a unit that is not named.
    let unnamed =
        |side: f64| read("gsf", &build::gsf(&format!("XRes=3\nYRes=2\nXReal={side}\nYReal={side}\n")), Format::Gsf);
    assert_eq!(unnamed(1.0).sides, None);
    assert_eq!((unnamed(6.0).sides, unnamed(6.0).side_unit), (Some([6.0, 6.0]), Unit::Unnamed));
    let assumed =
        |unit| unnamed(6.0).in_metres(Scales { unit, ..Scales::default() }).expect("lengths").sides_are_assumed();
    assert_eq!((assumed(None), assumed(Some(LengthUnit::Micrometre))), (true, false));
    for other in ["V", "A"] {
        let map = read("gsf", &build::gsf(&format!("XRes=3\nYRes=2\nZUnits={other}\n")), Format::Gsf);
        assert_eq!(map.height_unit, Unit::NotLength, "{other}");
        let height_scale = Some(1e-9);
        let unit_alone = Scales { unit: Some(LengthUnit::Nanometre), height_scale, ..Scales::default() };
        let error = map.clone().in_metres(unit_alone).expect_err("a unit").to_string();
        assert!(error.contains("not lengths") && !error.contains("levels"), "{error}");
        assert_map(other, &map.in_metres(Scales { height_scale, ..Scales::default() }).expect(other), 1e-9, 0.0, None);
    }
}

#[test]
fn surface_data_files_of_every_kind_are_the_same_map() {
    let sides = Some([6e-6, 6e-6]);
    assert_map("text", &read("text", &build::sdf_text("1 2 3 4 5 6"), Format::Sdf), 1e-9, 0.0, sides);
    for version in ["ISO-1.0", "ISO-2.0", "BCR-1.0"] {
        for (kind, data) in build::sdf_types() {
            let map = read(version, &build::sdf_binary(version, kind, &data), Format::Sdf);
            assert_map(&format!("{version}, type {kind}"), &map, 1e-9, 0.0, sides);
        }
    }
}

#[test]
fn the_standard_marks_missing_points_by_the_lowest_number_and_bcr_by_the_greatest() {
    for (version, greatest) in [("ISO-1.0", false), ("ISO-2.0", false), ("BCR-1.0", true), ("BCR-0.0", true)] {
        for (kind, data) in build::sdf_limits() {
            let map = read(version, &build::sdf_binary(version, kind, &data), Format::Sdf);
            let unsigned = kind <= 2;
            // The standard has no mark for bytes.
            let expected = match (greatest || unsigned, kind) {
                (_, 0) if !greatest => vec![],
                (true, _) => vec![4],
                (false, _) => vec![3],
            };
            let missing: Vec<usize> = (0..6).filter(|i| map.heights.values()[*i].is_nan()).collect();
            assert_eq!(missing, expected, "{version}, type {kind}");
        }
    }
    let bytes = build::sdf_binary("BCR-0.0", 7, &[0; 48]);
    assert_eq!(Format::of("map".as_ref(), &bytes), Ok(Format::Sdf));
    assert_eq!(Format::of("map".as_ref(), b"aBCR-0.0\n"), Ok(Format::Sdf));
}

#[test]
fn eight_bytes_that_olympus_adds_to_the_header_are_no_heights() {
    let data = &build::sdf_types()[5].1;
    let extra = |version: &str, bytes: &[u8]| build::sdf_binary(version, 5, &[bytes, data].concat());
    let map = read("Olympus", &extra("ISO-1.0", &[5, 0, 0, 0, 1, 0, 0, 0]), Format::Sdf);
    assert_map("Olympus", &map, 1e-9, 0.0, Some([6e-6, 6e-6]));
    // Other lengths and versions have remarks after the heights.
    for (version, bytes) in [("ISO-1.0", &[0; 7][..]), ("ISO-2.0", &[0; 8])] {
        let map = read(version, &extra(version, bytes), Format::Sdf);
        assert!(map.heights.values()[0].abs() < 1e-15, "{version}: {:?}", map.heights.values());
    }
}

#[test]
fn the_header_of_a_surface_data_file_ends_with_a_line_of_a_star() {
    let text = String::from_utf8_lossy(&build::sdf_text("1 2 3 4 5 6")).replace("ManufacID = rc", "ManufacID = r*c");
    assert_map("star", &read("star", text.as_bytes(), Format::Sdf), 1e-9, 0.0, Some([6e-6, 6e-6]));
}

#[test]
fn a_tile_may_be_larger_than_its_image() {
    for side in [16, 1024] {
        assert_map("tiles", &read("tiles", &build::tiff_tiled(side), Format::Tiff), 1.0, 0.0, None);
    }
}

#[test]
fn an_x3p_file_has_increments_and_offset() {
    let xml = build::x3p_xml("D", build::X3P_SIZE, "");
    let data: Vec<u8> = HEIGHTS.iter().flat_map(|v| v.to_le_bytes()).collect();
    let members = [("main.xml", xml.as_bytes()), ("bindata/data.bin", data.as_slice())];
    let map = read("x3p", &crate::parts::zipped(&members, CompressionMethod::Stored), Format::X3p);
    assert_map("x3p", &map, 1e-9, 1e-6, Some([6e-6, 6e-6]));
}

#[test]
fn images_are_levels_of_grey() {
    for (name, bytes, format) in [("png", build::png_16(), Format::Png), ("tiff", build::tiff(), Format::Tiff)] {
        let map = read(name, &bytes, format);
        assert_map(name, &map, 1.0, 0.0, None);
        assert_eq!(map.height_unit, Unit::GreyLevel, "{name}");
    }
}

#[test]
fn headers_that_promise_terabytes_are_refused_before_memory_is_taken() {
    let million = "1048576";
    let mut binary = build::sdf_binary("ISO-2.0", 7, &[0; 64]);
    // The counts follow mark, manufacturer and dates.
    for at in [42, 46] {
        binary[at..at + 4].copy_from_slice(&(1_u32 << 20).to_le_bytes());
    }
    let mut surfer = build::surfer_6(HEIGHTS);
    surfer[4..8].fill(0x7f);
    let size = build::X3P_SIZE.replace(">3<", ">1048576<").replace(">2<", ">1048576<");
    let xml = build::x3p_xml("D", &size, "");
    let x3p = crate::parts::zipped(
        &[("main.xml", xml.as_bytes()), ("bindata/data.bin", &[0; 64])],
        CompressionMethod::Deflated,
    );
    let mut tiff = build::tiff();
    // The directory follows header and heights. It has a count, then entries of 12 bytes with their values at 8.
    for entry in [0, 1, 7] {
        // Width, height, rows of a strip.
        let at = 22 + 12 * entry;
        tiff[at + 8..at + 10].copy_from_slice(&0xffff_u16.to_le_bytes());
    }
    let files = [
        (
            Format::Npy,
            [&build::npy()[..10], b"{'descr': '<f8', 'fortran_order': False, 'shape': (1048576, 1048576), }\n"]
                .concat(),
        ),
        (Format::Surfer, format!("DSAA\n{million} {million}\n0 1\n0 1\n0 1\n1 2 3\n").into_bytes()),
        (Format::Surfer, surfer),
        (Format::Gsf, build::gsf(&format!("XRes = {million}\nYRes = {million}\n"))),
        (
            Format::Sdf,
            String::from_utf8_lossy(&build::sdf_text("1 2"))
                .replace("= 3\r", "= 1048576\r")
                .replace("= 2\r", "= 1048576\r")
                .into_bytes(),
        ),
        (Format::Sdf, binary),
        (Format::X3p, x3p),
        (Format::Tiff, tiff),
    ];
    for (format, mut bytes) in files {
        if format == Format::Npy {
            bytes[8..10].copy_from_slice(&72_u16.to_le_bytes());
        }
        let error = parse(&bytes, format).expect_err("a promise").to_string();
        assert!(error.contains("shorter than its header says"), "{format}: {error}");
    }
}

#[test]
fn wrong_headers_are_named_with_their_field() {
    let sdf = |from: &str, to: &str| {
        let text = String::from_utf8_lossy(&build::sdf_text("1 2 3 4 5 6")).replace(from, to);
        (Format::Sdf, text.into_bytes())
    };
    let gsf = |fields: &str| (Format::Gsf, build::gsf(fields));
    let xml = |xml: String| {
        let members = [("main.xml", xml.as_bytes()), ("bindata/data.bin", &[0; 48])];
        (Format::X3p, crate::parts::zipped(&members, CompressionMethod::Stored))
    };
    let surfer = |text: &str| (Format::Surfer, text.as_bytes().to_vec());
    let mut checked = build::sdf_binary("ISO-1.0", 7, &[0; 48]);
    // The last byte of the header.
    checked[80] = 3;
    let cases = [
        (sdf("NumPoints = 3", "NumPoints = many"), "NumPoints is 'many'"),
        (sdf("NumPoints = 3", "Points = 3"), "NumPoints is missing"),
        (sdf("NumPoints = 3", "NumPoints = 0"), "1 to 1048576"),
        (sdf("Xscale = 2e-6", "Xscale = -2e-6"), "Xscale is '-0.000002'; it must be a positive length"),
        (sdf("Zscale = 1e-9", "Zscale = 0"), "Zscale"),
        (sdf("Compression = 0", "Compression = 1"), "compressed"),
        (sdf("DataType = 7", "DataType = 9"), "DataType"),
        (sdf("CheckType = 0", "CheckType = 1"), "a checksum (CheckType 1)"),
        ((Format::Sdf, checked), "a checksum (CheckType 3)"),
        (sdf("4 5 6", "4 x 6"), "line 15, value 5: 'x'"),
        (sdf(" 4 5 6", " 4 5"), "of which 5 heights"),
        (sdf("*", ""), "shorter than the header"),
        (gsf("XRes=3\nYRes=2\nXReal=1\nYReal=1\nXYUnits=A\n"), "XYUnits is 'A'"),
        (gsf("XRes=3\nYRes=2\nXReal=-1\nYReal=1\n"), "XReal"),
        (gsf("XRes=3\n"), "YRes is missing"),
        (gsf("XRes=3\nYRes=2\nXReal=1\n"), "YReal is missing"),
        (gsf("XRes=3\nYRes=2\nYReal=1\n"), "XReal is missing"),
        ((Format::Gsf, [build::gsf(build::GSF_FIELDS), vec![0]].concat()), "need 24 bytes, but the file has 25"),
        ((Format::Surfer, [build::surfer_6(HEIGHTS), vec![0; 4]].concat()), "need 24 bytes, but the file has 28"),
        ((Format::Surfer, build::surfer_text("1 2 3\n4 5 6\n7")), "of which 7 heights"),
        ((Format::Surfer, build::surfer_text("1 2 3\n4 inf 6")), "row 1, column 1 (from 0) is inf"),
        ((Format::Surfer, build::surfer_6([1.0, 2.0, 3.0, 4.0, f64::INFINITY, 6.0])), "is inf"),
        (xml(build::x3p_xml("Q", build::X3P_SIZE, "")), "CZ DataType is 'Q'"),
        (xml(build::x3p_xml("D", "<SizeX>3</SizeX>", "")), "SizeY is missing"),
        (xml(build::x3p_xml("D", "<SizeX>3</SizeX><SizeY>2</SizeY><SizeZ>4</SizeZ>", "")), "layer"),
        (xml(build::x3p_xml("D", build::X3P_SIZE, "").replace("<AxisType>I<", "<AxisType>A<")), "coordinates"),
        (xml(build::x3p_xml("D", build::X3P_SIZE, "").replace("data.bin", "none.bin")), "none.bin"),
        (xml("<a>".repeat(100_000)), "x3p"),
        (surfer("DSAA\n3 2\n0 0\n0 1\n0 1\n1 2 3 4 5 6"), "along x"),
        (surfer("DSAA\n3 2\n0 1\n0 1\n0 1\n1 2 3 4 b 6"), "height is 'b'"),
        (surfer("DSAA\n3 2\n0 1\n0 1\n0 1\n1 2 3 4 5555"), "of which 5"),
        (surfer("DSAA\n3 x"), "rows is 'x'"),
        ((Format::Png, build::png(png::ColorType::Grayscale, png::BitDepth::Eight, &[0; 6])), "16-bit"),
        ((Format::Png, build::png(png::ColorType::Rgb, png::BitDepth::Sixteen, &[0; 36])), "16-bit"),
    ];
    for ((format, bytes), expected) in cases {
        let error = parse(&bytes, format).expect_err(expected).to_string();
        assert!(error.contains(expected), "no '{expected}' in: {error}");
    }
}

#[test]
fn deep_brackets_in_an_array_header_do_not_overflow_the_stack() {
    for (length, expected) in [(60_000_usize, "at most 4096"), (4000, "npy")] {
        let header = "(".repeat(length);
        let bytes = [b"\x93NUMPY\x01\x00".as_slice(), &(length as u16).to_le_bytes(), header.as_bytes()].concat();
        let error = parse(&bytes, Format::Npy).expect_err("brackets").to_string();
        assert!(error.contains(expected), "{error}");
    }
}

#[test]
fn what_gsf_and_netcdf_files_store_is_read_back() {
    let dir = tempfile::tempdir().expect("a temporary folder");
    // Heights in units of 2 µm that 32-bit floats do not have, a missing point, and points 0.1 µm x 0.3 µm apart.
    for (nx, ny) in [(1, 1), (3, 2), (17, 5), (64, 33)] {
        let grid = rc_core::Grid::new(nx, ny).expect("a grid");
        let height = |i: usize| if i == 1 { f64::NAN } else { (i as f64 * 0.7).sin() / 3.0 };
        let field = rc_core::Field::new(grid, (0..grid.len()).map(height).collect()).expect("heights");
        let sides = [0.1e-6 * nx as f64, 0.3e-6 * ny as f64];
        let (gsf, nc) = (dir.path().join("map.gsf"), dir.path().join("map.nc"));
        rc_heights::gsf::write(&gsf, &field, 2e-6, sides).expect("a file");
        rc_heights::netcdf::write(&nc, &field, 2e-6, sides).expect("a file");
        for (path, single) in [(gsf, true), (nc, false)] {
            if nx == 1 && !single {
                // A single coordinate has no spacing.
                continue;
            }
            let map = rc_heights::read(&path).unwrap_or_else(|error| panic!("{error}"));
            assert_eq!((map.heights.grid(), map.height_unit, map.side_unit), (grid, Unit::Metre, Unit::Metre));
            let stored = |height: &f64| if single { f64::from((height * 2e-6) as f32) } else { height * 2e-6 };
            let same = map.heights.values().iter().zip(field.values()).all(|(a, b)| a.to_bits() == stored(b).to_bits());
            assert!(same, "{}: {nx} x {ny}", path.display());
            let found = map.sides.expect("sides");
            let close = |i: usize| (found[i] / sides[i] - 1.0).abs() < if single { 1e-15 } else { 1e-12 };
            assert!(close(0) && close(1), "{}: {found:?}, expected {sides:?}", path.display());
        }
    }
}
