//! Tests with files of arrays, Gwyddion, Igor and texts, in data/formats/.
//!
//! Other programs wrote these files. The README there says which and how.

use rc_heights::{
    ChannelInfo, Format, HeightMap, Layout, ReadParams, Unit, channels, format_of, may_have_sides, parse, read,
    read_with,
};

use crate::files::{expected, folder, map, worst};

/// Asserts the sides of 12 x 8 points at distances of 2 µm and 3 µm.
fn assert_sides(name: &str, map: &HeightMap) {
    let [x, y] = map.sides.unwrap_or_else(|| panic!("{name}: no sides"));
    assert!((x / 24e-6 - 1.0).abs() < 1e-12 && (y / 24e-6 - 1.0).abs() < 1e-12, "{name}: {x} x {y}");
}

/// Asserts that heights are those expected (nm) times `scale`.
///
/// If `is_missing`, the point in row 2, column 3 is missing.
fn assert_heights(name: &str, map: &HeightMap, [scale, tolerance]: [f64; 2], is_missing: bool) {
    let (mut found, expected) = (map.heights.clone(), expected());
    assert_eq!((found.grid().nx(), found.grid().ny()), (12, 8), "{name}");
    if is_missing {
        assert_eq!(map.missing(), 1, "{name}");
        assert!(found.at(3, 2).is_nan(), "{name}");
        found.values_mut()[2 * 12 + 3] = scale * expected.at(3, 2);
    }
    let worst = worst(&found, &expected, scale);
    assert!(worst < tolerance, "{name}: off by {worst:e}");
}

#[test]
fn heights_units_sizes_axes_and_missing_points_come_from_the_file() {
    let (metre, unnamed) = (Unit::Metre, Unit::Unnamed);
    // Name, scale and tolerance, whether a point is missing, units of heights and sides.
    let files = [
        ("gwyfile.gwy", [1e-9, 1e-20], true, metre, metre),
        ("h5py-chunked.h5", [1e-9, 1e-20], true, metre, metre),
        ("netcdf4-classic.nc", [1e-9, 1e-20], true, metre, metre),
        // The first index is x, and y decreases.
        ("netcdf4-64bit.nc", [1e-9, 1e-20], true, metre, metre),
        ("netcdf4-zlib.nc", [1e-9, 1e-20], true, metre, metre),
        // Meshes, and vectors whose y decreases.
        ("scipy-mesh.mat", [1e-9, 1e-20], true, unnamed, unnamed),
        ("scipy-vectors.mat", [1.0, 1e-12], false, unnamed, unnamed),
        // Dimensions in reverse order, vectors of two dimensions, and meshes.
        ("h5py-matlab.mat", [1e-9, 1e-20], false, unnamed, unnamed),
        ("h5py-matlab-mesh.mat", [1e-9, 1e-20], false, unnamed, unnamed),
        ("igorwriter.ibw", [1e-9, 1e-20], false, metre, metre),
        ("igorwriter-stack.ibw", [1e-9, 1e-12], true, metre, metre),
        ("gwyddion.txt", [1e-9, 1e-20], false, metre, metre),
        ("gwyddion-utf16.txt", [1e-9, 1e-20], false, metre, metre),
        ("interferometer.dat", [1e-9, 1e-20], false, metre, metre),
        ("columns.csv", [1e-9, 1e-20], true, metre, metre),
        ("zipfile-folder.x3p", [1e-9, 1e-20], false, metre, metre),
    ];
    for (name, scale, is_missing, heights, sides) in files {
        let map = map(name);
        assert_heights(name, &map, scale, is_missing);
        assert_eq!((map.height_unit, map.side_unit), (heights, sides), "{name}");
        // Pixels of the interferometer are square.
        if name == "interferometer.dat" {
            assert_eq!(map.sides, Some([24e-6, 16e-6]));
        } else {
            assert_sides(name, &map);
        }
    }
}

#[test]
fn arrays_without_coordinates_and_units_are_bare() {
    for name in ["h5py-contiguous.h5", "expected.asc.gz"] {
        let map = map(name);
        assert_heights(name, &map, [1.0, 1e-12], false);
        assert_eq!((map.sides, map.height_unit), (None, Unit::Unnamed), "{name}");
    }
}

#[test]
fn channels_are_listed_and_picked_and_heights_are_the_default() {
    let files = [
        ("gwyfile.gwy", vec![("Phase", false), ("Height", true)]),
        ("h5py-chunked.h5", vec![("scan/phase", false), ("scan/topography", true)]),
        ("igorwriter-stack.ibw", vec![("Phase", false), ("Height", true)]),
        ("netcdf4-classic.nc", vec![("z", true)]),
        ("scipy-mesh.mat", vec![("Z", true)]),
        // A text of MATLAB is not a map.
        ("h5py-matlab.mat", vec![("z", true)]),
        ("gwyddion.txt", vec![("Height", true)]),
        ("expected.csv", vec![("", true)]),
    ];
    for (name, listed) in files {
        let path = folder().join(name);
        let info = |(name, is_height): &(&str, bool)| ChannelInfo { name: (*name).to_owned(), is_height: *is_height };
        let expected: Vec<ChannelInfo> = listed.iter().map(info).collect();
        assert_eq!(channels(&path, &ReadParams::default()), Ok(expected), "{name}");
        let params = |channel: &str| ReadParams { channel: Some(channel.to_owned()), ..ReadParams::default() };
        if listed.len() == 2 {
            let phase = read_with(&path, &params(listed[0].0)).expect(name);
            assert_eq!(phase.height_unit, Unit::NotLength, "{name}");
            assert!((phase.heights.max() - 90.0).abs() < 1e-4, "{name}: {}", phase.heights.max());
            assert!(phase.in_metres(rc_heights::Scales::default()).is_err(), "{name}: degrees are not lengths");
        }
        let error = read_with(&path, &params("slope")).expect_err(name).to_string();
        assert!(error.contains(if listed[0].0.is_empty() { "omit channel" } else { listed[0].0 }), "{error}");
    }
}

#[test]
fn a_picture_of_a_park_microscope_without_its_measurement_is_refused() {
    let error = read(&folder().join("tifffile-park.tif")).expect_err("a thumbnail").to_string();
    assert!(error.contains("the tag 50435 of Park Systems is missing"), "{error}");
}

#[test]
fn an_archive_is_told_apart_by_its_members() {
    let dir = tempfile::tempdir().expect("a temporary folder");
    let stored = zip::CompressionMethod::Stored;
    let cases: [(&str, &[&str], &str); 3] = [
        ("book.x3p", &["[Content_Types].xml", "xl/workbook.xml"], "an Excel workbook"),
        ("maps.zip", &["a.csv", "b.csv", "c.csv", "d.csv"], "a zip archive with a.csv, b.csv, c.csv, …; unpack it"),
        ("maps", &["not-main.xml"], "a zip archive with not-main.xml"),
    ];
    for (name, members, expected) in cases {
        let path = dir.path().join(name);
        let members: Vec<(&str, &[u8])> = members.iter().map(|name| (*name, b"".as_slice())).collect();
        std::fs::write(&path, crate::parts::zipped(&members, stored)).expect("an archive");
        let error = read(&path).expect_err(name).to_string();
        assert!(error.contains(expected), "{error}");
    }
    let folder = folder().join("zipfile-folder.x3p");
    let other = dir.path().join("no-name");
    std::fs::copy(folder, &other).expect("a copy");
    assert_eq!(format_of(&other), Ok(Format::X3p));
}

#[test]
fn gzip_holds_any_format() {
    use std::io::Write as _;
    let dir = tempfile::tempdir().expect("a temporary folder");
    for name in ["surfalize.x3p", "gwyfile.gwy", "pillow.png", "interferometer.dat", "expected.csv"] {
        let path = dir.path().join(format!("{name}.gz"));
        let bytes = std::fs::read(folder().join(name)).expect(name);
        let mut packed = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
        packed.write_all(&bytes).expect("in memory");
        let packed = packed.finish().expect("in memory");
        std::fs::write(&path, &packed).expect("a packed file");
        let (found, expected) = (read(&path).expect(name), map(name));
        assert_eq!((found.missing(), found.sides), (expected.missing(), expected.sides), "{name}");
        std::fs::write(&path, &packed[..packed.len() / 2]).expect("half a file");
        let error = read(&path).expect_err(name).to_string();
        assert!(error.contains("cannot be unpacked by gzip"), "{error}");
    }
}

#[test]
fn groups_that_contain_themselves_are_refused() {
    let error = read(&folder().join("h5py-cycle.h5")).expect_err("a cycle").to_string();
    assert!(error.contains("more than 1024 groups, or some inside each other more than 32 deep"), "{error}");
}

/// `file` with the 32-bit number `from` after `name` replaced by 2^20, little-endian.
fn promising(file: &str, name: &[u8], from: u32) -> Vec<u8> {
    let mut bytes = std::fs::read(folder().join(file)).expect(file);
    let pattern = [name, &from.to_le_bytes()].concat();
    let places: Vec<usize> = (0..bytes.len()).filter(|at| bytes[*at..].starts_with(&pattern)).collect();
    assert!(!places.is_empty(), "{file} has no {pattern:?}");
    for at in places {
        bytes[at + name.len()..][..4].copy_from_slice(&(1_u32 << 20).to_le_bytes());
    }
    bytes
}

#[test]
fn arrays_that_promise_terabytes_are_refused_before_memory_is_taken() {
    use std::io::Write as _;
    let gwy = promising("gwyfile.gwy", b"xres\0i", 12);
    let mat = promising("scipy-vectors.mat", &8_u32.to_le_bytes(), 12);
    // The same claim in an element that is compressed.
    let tag = [14_u32.to_le_bytes(), u32::MAX.to_le_bytes()].concat();
    let flags = [6_u32, 8, 6, 0].map(u32::to_le_bytes).concat();
    let sizes = [5_u32, 8, 1 << 20, 1 << 20].map(u32::to_le_bytes).concat();
    let name = [1_u32 | 1 << 16, 0x41].map(u32::to_le_bytes).concat();
    let values = [9_u32, u32::MAX].map(u32::to_le_bytes).concat();
    let mut packed = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::fast());
    packed.write_all(&[tag, flags, sizes, name, values, vec![0; 4096]].concat()).expect("in memory");
    let packed = packed.finish().expect("in memory");
    let tag = [15_u32, packed.len() as u32].map(u32::to_le_bytes).concat();
    let deflated = [&mat[..128], &tag, &packed].concat();
    let files = [
        (Format::Gwy, gwy),
        (Format::Ibw, huge_wave()),
        (Format::Mat, mat),
        (Format::Mat, deflated),
        (Format::Hdf5, std::fs::read(folder().join("h5py-huge.h5")).expect("a file")),
    ];
    for (format, bytes) in files {
        let error = parse(&bytes, format).expect_err("a promise").to_string();
        assert!(error.contains("shorter than its header says"), "{format}: {error}");
    }
}

/// The image of Igor with a claim of 2^20 x 2^20 points, and the correct checksum.
fn huge_wave() -> Vec<u8> {
    let mut bytes = std::fs::read(folder().join("igorwriter.ibw")).expect("a file");
    for at in [132, 136] {
        bytes[at..at + 4].copy_from_slice(&(1_u32 << 20).to_le_bytes());
    }
    bytes[2..4].fill(0);
    let words = bytes[..384].chunks(2).map(|word| u16::from_le_bytes([word[0], word[1]]));
    let sum = words.fold(0_u16, u16::wrapping_add);
    bytes[2..4].copy_from_slice(&sum.wrapping_neg().to_le_bytes());
    bytes
}

#[test]
fn the_layout_of_a_text_may_be_said() {
    let dir = tempfile::tempdir().expect("a temporary folder");
    let path = dir.path().join("map.txt");
    std::fs::write(&path, "0 0 1\n0 1 2\n1 0 3\n1 1 4\n").expect("a text");
    let params = |layout| ReadParams { layout: Some(layout), ..ReadParams::default() };
    let grid = |layout| read_with(&path, &params(layout)).map(|map| (map.heights.grid().nx(), map.heights.grid().ny()));
    assert_eq!(grid(Layout::Matrix), Ok((3, 4)));
    assert_eq!(grid(Layout::Xyz), Ok((2, 2)));
    assert_eq!(may_have_sides(&path, &params(Layout::Xyz)), Ok(true));
    assert_eq!(may_have_sides(&path, &params(Layout::Matrix)), Ok(false));
    assert_eq!(may_have_sides(&folder().join("gwyddion.txt"), &ReadParams::default()), Ok(true));
    std::fs::write(&path, "1 2 3\n2 3 4\n4.4 7 10\n").expect("a text");
    let error = read(&path).expect_err("no points").to_string();
    assert!(error.contains("grid lines"), "{error}");
}
