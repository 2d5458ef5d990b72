//! Tests with files of instruments.
//!
//! Some are in data/formats/ as other programs wrote them. Others are built byte by byte in every variant.

use rc_heights::{Format, FormatError, HeightMap, ReadParams, Unit, channels_of, parse, parse_with};

use crate::build_instruments as build;
use crate::built::{assert_map, read};
use crate::files::{as_stored, expected, folder, map};
use crate::parts::HEIGHTS;

/// Sides of the built files, which have 2 µm x 3 µm between points.
const SIDES: Option<[f64; 2]> = Some([6e-6, 6e-6]);

fn parsed(name: &str, bytes: &[u8], format: Format) -> Result<HeightMap, FormatError> {
    parse(bytes, format).inspect(|map| assert_eq!(map.height_unit, Unit::Metre, "{name}"))
}

/// Files of the folder, with expected values.
///
/// They are the offset of heights from `expected.csv`, the tolerance (both nm), and the sides (µm). Errors are half a
/// digit of the file, or the rounding of its 32-bit floats.
const FILES: [(&str, f64, f64, [f64; 2]); 16] = [
    ("surfalize.sur", 0.0, 5e-4, [24.0, 24.0]),
    ("surfalize-zlib.sur", 0.0, 5e-4, [24.0, 24.0]),
    // The file counts heights from the middle of its integers.
    ("rosettasciio-zlib.sur", -1450.0, 5e-4, [24.0, 24.0]),
    ("python-16bit.sur", 0.0, 1e-9, [24.0, 24.0]),
    ("python-zlib.sur", 0.0, 1e-4, [24.0, 24.0]),
    ("surfalize.al3d", 0.0, 2e-4, [24.0, 24.0]),
    ("python.al3d", 0.0, 2e-4, [24.0, 24.0]),
    ("python-two-channels.spm", 0.0, 1e-9, [24.0, 24.0]),
    ("python-32bit.spm", 0.0, 2e-6, [24.0, 24.0]),
    ("python-wide.spm", 0.0, 1e-9, [24.0, 24.0]),
    ("python-int16.opd", 0.0, 1e-9, [24.0, 24.0]),
    ("python-float.opd", 0.0, 1e-3, [24.0, 24.0]),
    // The distance of points is a single number for both axes.
    ("python.dat", 0.0, 6e-3, [24.0, 16.0]),
    ("python.plu", 0.0, 2e-4, [24.0, 24.0]),
    ("python.plux", 0.0, 2e-4, [24.0, 24.0]),
    // Heights are relative to the lowest.
    ("python.vk4", 950.0, 1e-9, [24.0, 24.0]),
];

#[test]
fn the_files_of_the_folder_have_their_heights_sides_and_missing_point() {
    let expected = expected();
    for (name, offset, tolerance, sides) in FILES {
        let map = map(name);
        let whole = [".spm", ".vk4"].iter().any(|end| name.ends_with(end)) || name.starts_with("rosettasciio");
        assert_eq!(map.missing(), usize::from(!whole), "{name}");
        assert!(whole || map.heights.at(3, 2).is_nan(), "{name}: the missing point is another");
        let heights = map.heights.values().iter().zip(expected.values());
        let errors = heights.map(|(found, height)| (found * 1e9 - height - offset).abs());
        let worst = errors.filter(|error| !error.is_nan()).fold(0.0, f64::max);
        assert!(worst <= tolerance, "{name}: off by {worst:e} nm");
        let found = map.sides.expect(name);
        assert!((0..2).all(|i| (found[i] / (1e-6 * sides[i]) - 1.0).abs() < 1e-7), "{name}: sides {found:?}");
        assert_eq!((map.height_unit, map.side_unit), (Unit::Metre, Unit::Metre), "{name}");
    }
}

#[test]
fn files_that_are_cut_at_any_64th_are_refused_or_the_same_map() {
    // Missing points are NaN, so the bits of maps are compared.
    let bits = |map: &HeightMap| map.heights.values().iter().map(|height| height.to_bits()).collect::<Vec<_>>();
    for (name, ..) in FILES {
        let path = folder().join(name);
        let bytes = std::fs::read(&path).expect(name);
        let format = Format::of(&path, &bytes).expect(name);
        let whole = bits(&parse(&bytes, format).expect(name));
        for part in 0..64 {
            match parse(&bytes[..bytes.len() * part / 64], format) {
                Ok(map) => assert!(bits(&map) == whole, "{name}: {part} of 64 parts are read as another map"),
                Err(error) => assert_eq!(error.to_string().lines().count(), 1, "{name}: {error}"),
            }
        }
    }
}

#[test]
fn channels_are_listed_and_read_by_name() {
    let names = |name: &str, format| {
        let bytes = std::fs::read(folder().join(name)).expect(name);
        let channels = channels_of(&bytes, format, &ReadParams::default()).expect(name);
        let list: Vec<_> = channels.into_iter().map(|channel| (channel.name, channel.is_height)).collect();
        (bytes, list)
    };
    let named =
        |list: &[(&str, bool)]| list.iter().map(|(name, height)| ((*name).to_owned(), *height)).collect::<Vec<_>>();
    let (spm, list) = names("python-two-channels.spm", Format::Nanoscope);
    assert_eq!(list, named(&[("Phase", false), ("Height Retrace", true)]));
    let phase = ReadParams { channel: Some("Phase".into()), ..ReadParams::default() };
    let phase = parse_with(&spm, Format::Nanoscope, &phase).expect("a phase");
    // Integers from -40 on, each 360° / 2^16.
    assert_eq!((phase.height_unit, phase.heights.at(1, 0)), (Unit::NotLength, -39.0 * 360.0 / 65536.0));
    let (_, list) = names("python-16bit.sur", Format::Sur);
    assert_eq!(list, named(&[("Scan", true), ("Grey", false)]));
    let (_, list) = names("python-int16.opd", Format::Opd);
    assert_eq!(list, named(&[("RAW_DATA", true), ("Image", false)]));
    let (plu, list) = names("python.plu", Format::Plu);
    assert_eq!(list, named(&[("layer 1", true), ("layer 2", true)]));
    let second = ReadParams { channel: Some("layer 2".into()), ..ReadParams::default() };
    let second = parse_with(&plu, Format::Plu, &second).expect("a layer");
    // Heights are twice those of the first layer. This one is 500 nm there.
    let second = as_stored(second);
    assert!((second.heights.at(0, 0) - 1000e-9).abs() < 1e-13, "{}", second.heights.at(0, 0));
}

#[test]
fn built_files_of_every_instrument_are_the_same_map() {
    for (name, format, bytes) in build::all() {
        // In MetroPro the distance of points is a single number.
        let sides = if format == Format::MetroPro { Some([6e-6, 4e-6]) } else { SIDES };
        let map = read(name, &bytes, format);
        assert_map_rounded(name, &map, sides);
        assert_eq!(map.missing(), 0, "{name}");
    }
}

/// Asserts heights of 1 to 6 nm, within the rounding of 32-bit floats.
pub(crate) fn assert_map_rounded(name: &str, map: &HeightMap, sides: Option<[f64; 2]>) {
    assert_eq!((map.heights.grid().nx(), map.heights.grid().ny()), (3, 2), "{name}");
    for (found, height) in map.heights.values().iter().zip(HEIGHTS) {
        assert!((found / (height * 1e-9) - 1.0).abs() < 1e-6, "{name}: {found:e}, expected {height} nm");
    }
    assert_eq!(map.sides.is_some(), sides.is_some(), "{name}: {:?}", map.sides);
    let close = |(a, b): (&f64, &f64)| (a / b - 1.0).abs() < 1e-6;
    assert!(map.sides.iter().flatten().zip(sides.iter().flatten()).all(close), "{name}: {:?}", map.sides);
}

#[test]
fn formats_are_known_by_their_marks_whatever_they_are_called() {
    for (name, format, bytes) in build::all() {
        let found = Format::of("map.bin".as_ref(), &bytes);
        match format {
            // This format has no mark.
            Format::Plu => {
                assert_eq!((found, Format::of("map.PLU".as_ref(), &bytes)), (Err(FormatError::Unknown), Ok(format)));
            }
            _ if format != Format::Plux => assert_eq!(found, Ok(format), "{name}"),
            _ => {}
        }
    }
    for (name, expected) in [
        ("a.sur", "DIGITAL SURF"),
        ("a.spm", "*File list"),
        ("a.opd", "Directory"),
        ("a.al3d", "Alicona"),
        ("a.vk4", "VK4_"),
    ] {
        let error = Format::of(name.as_ref(), b"other").expect_err(name).to_string();
        assert!(error.contains(expected), "{error}");
    }
}

#[test]
fn digital_surf_has_offsets_missing_points_and_replicas() {
    let plain = build::sur(HEIGHTS);
    let shifted = build::with(plain.clone(), &[(474, &build::f32s(&[1000.0]))]);
    assert_map("offset", &read("offset", &shifted, Format::Sur), 1e-9, 1e-6, SIDES);
    // The lowest integer is 1, so -1 marks a missing point if there are such points.
    let mut integers = HEIGHTS;
    integers[4] = -1.0;
    for (special, missing) in [(0_u16, 0), (1, 1)] {
        let bytes = build::with(build::sur(integers), &[(86, &special.to_le_bytes())]);
        let map = read("special", &bytes, Format::Sur);
        assert_eq!((map.missing(), map.heights.values()[4].is_nan()), (missing, missing == 1));
    }
    let orders = [(1_u16, [1, 2, 3, 4, 5, 6]), (2, [3, 2, 1, 6, 5, 4]), (3, [4, 5, 6, 1, 2, 3])];
    for (inversion, order) in orders {
        let map = read("replica", &build::with(plain.clone(), &[(290, &inversion.to_le_bytes())]), Format::Sur);
        for (found, height) in map.heights.values().iter().zip(order) {
            assert!((found + f64::from(height) * 1e-9).abs() < 1e-20, "{inversion}: {:?}", map.heights.values());
        }
    }
    // Axes that are not lengths, and a micrometre in several code pages.
    let seconds = read("s", &build::with(plain.clone(), &[(180, b"s ")]), Format::Sur);
    assert_map("s", &seconds, 1e-9, 0.0, None);
    for micro in [&b"\xb5m"[..], b"\xe6m", "µm".as_bytes()] {
        assert_map("µm", &read("µm", &build::with(plain.clone(), &[(180, micro)]), Format::Sur), 1e-9, 0.0, SIDES);
    }
}

#[test]
fn nanoscope_sizes_follow_the_scan_where_the_image_is_wrong() {
    let image = build::nanoscope_image("Height", build::Z_SCALE, 0);
    let data = build::i16s(HEIGHTS);
    let built = |global: &str, image: &str| read(global, &build::nanoscope(global, image, &data), Format::Nanoscope);
    let scan = "\\*Ciao scan list\r\n\\Scan size: 6000 nm\r\n";
    assert_map(
        "slow axis",
        &built(&format!("{scan}\\Slow Axis Size: 3 ~m\r\n"), &image),
        1e-9,
        0.0,
        Some([6e-6, 3e-6]),
    );
    assert_map("one length", &built("", &image.replace("6 6 ~m", "6000 nm")), 1e-9, 0.0, SIDES);
    // Four lines were planned.
    let stopped = built(&format!("{scan}\\Samps/line: 3\r\n\\Lines: 4\r\n"), &image.replace("1:1", "2:1"));
    assert_map("stopped", &stopped, 1e-9, 0.0, Some([6e-6, 3e-6]));
    // The image claims one line. The length is that of the two lines of the scan.
    let wrong =
        built(&format!("{scan}\\Samps/line: 3\r\n\\Lines: 2\r\n"), &image.replace("of lines: 2", "of lines: 1"));
    assert_map("wrong size", &wrong, 1e-9, 0.0, Some([6e-6, 12e-6]));
}

#[test]
fn wyko_arrays_of_every_type_have_their_missing_points() {
    let mut blocks = build::opd_blocks();
    let size = |bytes: u16| [3, 2, bytes].map(u16::to_le_bytes).concat();
    let integers = build::i16s([1.0, 4.0, 2.0, 32766.0, 3.0, 6.0]);
    let floats = build::f32s(&[1.0, 4.0, 2.0, 1e38, 3.0, 6.0]);
    for array in [[size(2), integers].concat(), [size(4), floats].concat()] {
        blocks[1].2 = array;
        let map = read("opd", &build::opd(&blocks), Format::Opd);
        assert!(map.heights.values()[4].is_nan() && map.missing() == 1, "{:?}", map.heights.values());
    }
    blocks[1].2 = [size(1), vec![1, 4, 2, 5, 3, 6]].concat();
    assert_map_rounded("bytes", &read("bytes", &build::opd(&blocks), Format::Opd), SIDES);
    // Without the last three blocks the wavelength is not divided, and the size is not known.
    blocks.truncate(3);
    blocks[2].2 = build::f32s(&[1.0]);
    assert_map_rounded("few blocks", &read("few blocks", &build::opd(&blocks), Format::Opd), None);
}

#[test]
fn metropro_phases_have_a_sign_a_resolution_and_missing_points() {
    let plain = build::metropro([1, 2, 3, 4, 5, 6]);
    let short = |value: u16| value.to_be_bytes();
    let turned = build::with(build::metropro([-1, -2, -3, -4, -5, -6]), &[(232, &short(1))]);
    assert_map_rounded("sign", &read("sign", &turned, Format::MetroPro), Some([6e-6, 4e-6]));
    let fine = build::with(plain.clone(), &[(218, &short(2)), (164, &16_f32.to_be_bytes())]);
    assert_map_rounded("resolution", &read("resolution", &fine, Format::MetroPro), Some([6e-6, 4e-6]));
    let uncalibrated = build::with(plain, &[(184, &[0; 4])]);
    assert_map_rounded("no size", &read("no size", &uncalibrated, Format::MetroPro), None);
    let missing = read("missing", &build::metropro([1, 2, 3, 4, 2_147_483_640, 6]), Format::MetroPro);
    assert!(missing.heights.values()[4].is_nan() && missing.missing() == 1);
}

#[test]
fn keyence_heights_have_8_16_or_32_bits_and_up_to_three_images() {
    for bits in [8, 16, 32] {
        assert_map("vk4", &read("vk4", &build::vk4(bits, 1), Format::Vk4), 1e-9, 0.0, SIDES);
    }
    let channels = channels_of(&build::vk4(16, 3), Format::Vk4, &ReadParams::default()).expect("three images");
    assert_eq!(
        channels.iter().map(|channel| channel.name.as_str()).collect::<Vec<_>>(),
        ["Height", "Height 2", "Height 3"]
    );
}

#[test]
fn members_of_a_plux_archive_may_begin_with_a_dot() {
    assert_map_rounded("plux", &read("plux", &build::plux(build::PLUX_XML, "./z.raw"), Format::Plux), SIDES);
}

#[test]
fn alicona_marks_missing_points_by_a_value_of_the_header() {
    let tags = |value| [&build::AL3D_TAGS[..], &[("InvalidPixelValue", value)]].concat();
    for (value, missing) in [("NaN", 0), ("5.000000e-09", 1), ("1e+10", 0)] {
        let map = read(value, &build::al3d(&tags(value)), Format::Al3d);
        assert_eq!((map.missing(), map.heights.values()[4].is_nan()), (missing, missing == 1), "{value}");
    }
}

#[test]
fn headers_of_instruments_that_promise_terabytes_are_refused_before_memory_is_taken() {
    let million = 1_048_576_u32.to_le_bytes();
    let large = |bytes, places: &[usize]| places.iter().fold(bytes, |bytes, at| build::with(bytes, &[(*at, &million)]));
    let mut blocks = build::opd_blocks();
    blocks[1].2[..4].fill(0xff);
    let tags = [("Cols", "1048576"), ("Rows", "1048576"), ("PixelSizeXMeter", "1"), ("PixelSizeYMeter", "1")];
    let image = build::nanoscope_image("Height", build::Z_SCALE, 0).replace("line: 3", "line: 1048576");
    let xml = build::PLUX_XML.replace(">3<", ">1048576<").replace(">2<", ">1048576<");
    // The number of points is an i32.
    let many = |bytes| {
        build::with(
            bytes,
            &[
                (108, &32768_u32.to_le_bytes()),
                (112, &32767_u32.to_le_bytes()),
                (116, &(32768_u32 * 32767).to_le_bytes()),
            ],
        )
    };
    let files = [
        (Format::Sur, many(build::sur(HEIGHTS))),
        (Format::Sur, many(build::sur_zlib())),
        (Format::Nanoscope, build::nanoscope("", &image, &[0; 12])),
        (Format::Opd, build::opd(&blocks)),
        (Format::MetroPro, build::with(build::metropro([0; 6]), &[(68, &[0xff; 4])])),
        (Format::Al3d, build::al3d(&tags)),
        (Format::Plu, large(build::plu(1), &[500, 504])),
        (Format::Plux, build::plux(&xml, "z.raw")),
        (Format::Vk4, large(build::vk4(32, 1), &[264, 268])),
    ];
    for (format, bytes) in files {
        let error = parsed("large", &bytes, format).expect_err("a promise").to_string();
        assert!(error.contains("shorter than its header says"), "{format}: {error}");
    }
}

#[test]
#[expect(clippy::too_many_lines, reason = "a table of cases")]
fn wrong_headers_of_instruments_are_named_with_their_field() {
    let sur = |at: usize, bytes: &[u8]| (Format::Sur, build::with(build::sur(HEIGHTS), &[(at, bytes)]));
    let spm = |from: &str, to: &str| {
        let image = build::nanoscope_image("Height", build::Z_SCALE, 0).replace(from, to);
        (Format::Nanoscope, build::nanoscope("", &image, &build::i16s(HEIGHTS)))
    };
    let opd = |block: usize, content: Vec<u8>| {
        let mut blocks = build::opd_blocks();
        blocks[block].2 = content;
        (Format::Opd, build::opd(&blocks))
    };
    let metropro = |at: usize, bytes: &[u8]| (Format::MetroPro, build::with(build::metropro([0; 6]), &[(at, bytes)]));
    let plux = |from: &str, to: &str| (Format::Plux, build::plux(&build::PLUX_XML.replace(from, to), "z.raw"));
    let vk4 = |at: usize, bytes: &[u8]| (Format::Vk4, build::with(build::vk4(32, 1), &[(at, bytes)]));
    let spectra = build::with(build::sur(HEIGHTS), &[(18, &[21]), (94, &[9])]);
    let al3d = |tag: usize, value| {
        let mut tags = build::AL3D_TAGS;
        tags[tag].1 = value;
        (Format::Al3d, build::al3d(&tags))
    };
    let cases = [
        (sur(12, &[1, 1]), "format is '257'"),
        (sur(98, &[24]), "bits of a point is '24'"),
        (sur(116, &[7]), "number of points is '7'"),
        (sur(120, &[0; 4]), "spacing along x is '0'; it must be a positive length"),
        (sur(128, &[0; 4]), "spacing along z"),
        (sur(212, b"V "), "no channel has heights"),
        ((Format::Sur, spectra), "9 values a point"),
        (sur(0, b"ANALOG  SURF"), "not a valid Digital Surf file"),
        (spm("Samps/line: 3", "Samps/line: x"), "samps/line is 'x'"),
        (spm("\\Data offset", "\\Data"), "data offset is missing"),
        (spm("\\@2:Z scale", "\\@2:Z"), "Z scale is missing"),
        (spm("6.5536 V", "much"), "Z scale is"),
        (spm("6.5536 V", "0 V"), "Z scale is '0'"),
        (spm("Bytes/pixel: 2", "Bytes/pixel: 3"), "Bytes/pixel is '3'"),
        (spm("6 6 ~m", "6 6 V"), "Scan size is '6 6 V'"),
        (spm("Zsens] (0.0001 V/LSB) 6.5536 V", "None] (0.0001 V/LSB) 6.5536 V"), "no channel has heights"),
        ((Format::Nanoscope, build::nanoscope("\\Operating mode: Force\r\n", "", &[])), "force curves"),
        ((Format::Nanoscope, build::nanoscope("", "", &[])), "the file has no 2-D array of numbers"),
        (opd(2, Vec::new()), "Wavelength is missing"),
        (opd(3, vec![0, 0]), "Wavelength / Mult"),
        (opd(5, vec![0; 4]), "Pixel_size is '0'"),
        (opd(1, [3_u16, 2, 8].map(u16::to_le_bytes).concat()), "bytes of a point is '8'"),
        (metropro(6, &[0, 0, 4, 0]), "size of the header is '1024'"),
        (metropro(218, &[0, 3]), "resolution of phases is '3'"),
        (metropro(168, &[0; 4]), "scale of heights"),
        (metropro(184, &[0xff; 4]), "lateral resolution"),
        (al3d(0, "many"), "Cols is 'many'"),
        (al3d(2, "0"), "PixelSizeXMeter is '0'"),
        ((Format::Al3d, build::al3d(&build::AL3D_TAGS[1..])), "Cols is missing"),
        ((Format::Plu, build::with(build::plu(1), &[(428, &[1])])), "type of measurement is '1'"),
        ((Format::Plu, build::with(build::plu(1), &[(404, &[0; 4])])), "distance of points along x"),
        (plux("FOV_X", "FOV_Z"), "FOV_X is missing"),
        (plux("z.raw", "none.raw"), "none.raw"),
        (plux(">3<", ">2<"), "more than the 16 bytes"),
        (plux("<LAYER_0>", "<LAYER_0"), "not a valid plux file"),
        (vk4(264 + 8, &[24]), "bits of a height is '24'"),
        (vk4(264 + 12, &[1]), "compressed heights"),
        (vk4(84 + 176, &[0; 4]), "length of a digit along z"),
        (vk4(84 + 168, &[0; 4]), "length of a pixel along x"),
    ];
    for ((format, bytes), expected) in cases {
        let error = parse(&bytes, format).expect_err(expected).to_string();
        assert!(error.contains(expected), "no '{expected}' in: {error}");
    }
}

/// `bytes` with the first `from` replaced by `to`, which has the same length.
fn replaced(bytes: &[u8], from: &str, to: &str) -> Vec<u8> {
    assert_eq!(from.len(), to.len(), "{from}");
    let at = bytes.windows(from.len()).position(|part| part == from.as_bytes()).expect(from);
    [&bytes[..at], to.as_bytes(), &bytes[at + from.len()..]].concat()
}

#[test]
fn a_damaged_channel_leaves_the_others() {
    let spm = std::fs::read(folder().join("python-two-channels.spm")).expect("a file");
    let whole = parse(&spm, Format::Nanoscope).expect("heights");
    let damaged = replaced(&spm, "OL\r\n\\Samps/line: 12", "OL\r\n\\Samps/line: no");
    assert_eq!(parse(&damaged, Format::Nanoscope).expect("heights"), whole);
    let phase = ReadParams { channel: Some("Phase".into()), ..ReadParams::default() };
    let error = parse_with(&damaged, Format::Nanoscope, &phase).expect_err("a damaged channel").to_string();
    assert!(error.contains("samps/line is 'no'"), "{error}");
    // The unit is not a length any more, and a channel without a unit does not have heights.
    let gwy = std::fs::read(folder().join("gwyfile.gwy")).expect("a file");
    let list = |bytes: &[u8]| channels_of(bytes, Format::Gwy, &ReadParams::default()).expect("channels");
    assert_eq!(list(&gwy).iter().map(|c| c.is_height).collect::<Vec<_>>(), [false, true]);
    let degrees = replaced(&gwy, "deg\0", "   \0");
    assert_eq!(list(&degrees).iter().map(|c| c.is_height).collect::<Vec<_>>(), [false, true]);
}
