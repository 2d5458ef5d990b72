//! Tests of arrays that are points, profiles, meshes or frames, and of what stands beside arrays and images.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use rc_heights::{
    Format, HeightMap, Layout, ReadParams, Scales, Unit, channels, may_have_sides, parse, parse_with, read, read_with,
};

use crate::files::{as_stored, expected, folder, map, worst};

/// The numbers of an array as NumPy writes them, in C order.
pub(crate) fn npy(shape: &str, descr: &str, values: &[u8]) -> Vec<u8> {
    let mut header = format!("{{'descr': {descr}, 'fortran_order': False, 'shape': {shape}, }}");
    let padding = 64 - (10 + header.len() + 1) % 64;
    writeln!(header, "{:padding$}", "").expect("a text");
    let length = u16::try_from(header.len()).expect("a short header");
    [b"\x93NUMPY\x01\x00".as_slice(), &length.to_le_bytes(), header.as_bytes(), values].concat()
}

fn doubles(values: impl IntoIterator<Item = f64>) -> Vec<u8> {
    values.into_iter().flat_map(f64::to_le_bytes).collect()
}

/// Points of a grid of `nx` x `ny`, in an order of no meaning.
fn points(nx: usize, ny: usize) -> Vec<[f64; 3]> {
    let n = nx * ny;
    // 7 and n have no common divisor for the sides that are tried.
    let at = |i: usize| [(i % nx) as f64 * 2e-6, (i / nx) as f64 * 3e-6, (i * i % 101) as f64];
    (0..n).map(|i| at(i * 7 % n)).collect()
}

fn assert_is_of_points(name: &str, map: &HeightMap, nx: usize, ny: usize, unit: Unit) {
    let grid = map.heights.grid();
    assert_eq!((grid.nx(), grid.ny(), map.missing()), (nx, ny, 0), "{name}");
    assert!(map.heights.values().iter().enumerate().all(|(i, z)| (z - (i * i % 101) as f64).abs() < 1e-9), "{name}");
    let [x, y] = map.sides.unwrap_or_else(|| panic!("{name}: no sides"));
    let is_close = |side: f64, expected: f64| (side / expected - 1.0).abs() < 1e-6;
    assert!(is_close(x, nx as f64 * 2e-6) && is_close(y, ny as f64 * 3e-6), "{name}: {x} x {y}");
    assert_eq!((map.height_unit, map.side_unit), (unit, unit), "{name}");
}

#[test]
fn an_array_of_points_is_a_map_where_they_are_on_a_grid() {
    for (nx, ny) in [(30, 20), (11, 13), (3, 5)] {
        let points = points(nx, ny);
        let n = points.len();
        let columns = (0..3).flat_map(|axis| points.iter().map(move |point| point[axis]));
        let records = points.iter().flat_map(|[x, y, z]| {
            [&7_i32.to_le_bytes()[..], &z.to_be_bytes(), &x.to_le_bytes(), &(*y as f32).to_le_bytes()].concat()
        });
        let fields = "[('id', '<i4'), ('Z', '>f8'), ('X', '<f8'), ('Y', '<f4')]";
        let files = [
            npy(&format!("({n}, 3)"), "'<f8'", &doubles(points.as_flattened().iter().copied())),
            npy(&format!("(3, {n})"), "'<f8'", &doubles(columns)),
            npy(&format!("({n},)"), fields, &records.collect::<Vec<u8>>()),
        ];
        for (file, name) in files.iter().zip(["rows", "columns", "records"]) {
            let map = parse(file, Format::Npy).unwrap_or_else(|error| panic!("{name} of {n}: {error}"));
            assert_is_of_points(name, &map, nx, ny, Unit::Array);
            let metres = map.in_metres(Scales::default()).expect("metres");
            assert_eq!(metres.notes, [], "arrays are in metres by definition");
        }
    }
}

#[test]
fn points_off_a_grid_and_profiles_are_refused_and_the_user_may_call_them_a_map() {
    let values = doubles((0..1800).map(|i| f64::from(i * i % 1783)));
    let matrix = ReadParams { layout: Some(Layout::Matrix), ..ReadParams::default() };
    for (shape, expected) in [
        ("(600, 3)", Some("an array of 600 x 3 numbers is taken as a list of points x y z, not as a map")),
        ("(3, 600)", Some("an array of 3 x 600 numbers")),
        ("(900, 2)", Some("an array of 900 x 2 numbers is a profile, not a map")),
        ("(1, 1800)", Some("an array of 1 x 1800 numbers is a profile")),
        ("(450, 4)", None),
        ("(8, 3)", None),
    ] {
        let values = if shape == "(8, 3)" { &values[..8 * 24] } else { &values };
        let file = npy(shape, "'<f8'", values);
        let read = parse(&file, Format::Npy);
        match expected {
            None => assert!(read.is_ok(), "{shape}"),
            Some(expected) => {
                let error = read.expect_err(shape).to_string();
                assert!(error.contains(expected) && !error.contains('\n'), "{error}");
                // No advice makes heights of the x of a profile.
                assert_eq!(error.contains("matrix"), !error.contains("profile"), "{error}");
                assert!(parse_with(&file, Format::Npy, &matrix).is_ok(), "{shape}");
            }
        }
    }
    let line = parse(&npy("(600,)", "'<f8'", &values), Format::Npy).expect_err("a line").to_string();
    assert!(line.contains("an array of 600 numbers is a profile"), "{line}");
    let xyz = ReadParams { layout: Some(Layout::Xyz), ..ReadParams::default() };
    let few = npy("(4, 3)", "'<f8'", &doubles([0., 0., 1., 1., 0., 2., 0., 1., 3., 1., 1., 4.]));
    assert_eq!(parse(&few, Format::Npy).map(|map| map.heights.grid().nx()), Ok(3));
    assert_eq!(parse_with(&few, Format::Npy, &xyz).map(|map| map.heights.values().to_vec()), Ok(vec![1., 2., 3., 4.]));
    let error = parse_with(&npy("(450, 4)", "'<f8'", &values), Format::Npy, &xyz).expect_err("no points").to_string();
    assert!(error.contains("points in an array of 450 x 4"), "{error}");
}

fn path(name: &str) -> PathBuf {
    folder().join(name)
}

fn channel(file: &Path, name: &str) -> HeightMap {
    let params = ReadParams { channel: Some(name.to_owned()), ..ReadParams::default() };
    as_stored(read_with(file, &params).unwrap_or_else(|error| panic!("{name}: {error}")))
}

#[test]
fn hdf5_has_points_meshes_axes_and_sizes_in_many_forms() {
    let (metre, unnamed) = (Unit::Metre, Unit::Unnamed);
    for (name, scale, sides, missing) in [
        ("points/p", 1e-9, metre, 0),
        ("meshes/ZZ", 1e-9, unnamed, 0),
        // The first index is x.
        ("other/height", 1e-9, unnamed, 0),
        ("attributes/a", 1e-9, metre, 0),
        ("siblings/s", 1e-9, metre, 0),
        ("nexus/data", 1e-9, metre, 0),
        ("zygo/surface", 1e-9, metre, 3),
    ] {
        let map = channel(&path("h5py-groups.h5"), name);
        assert_eq!((map.missing(), map.side_unit), (missing, sides), "{name}");
        let [x, y] = map.sides.unwrap_or_else(|| panic!("{name}: no sides"));
        assert!((x / 24e-6 - 1.0).abs() < 1e-12 && (y / 24e-6 - 1.0).abs() < 1e-12, "{name}: {x} x {y}");
        let worst = worst_measured(&map, scale);
        assert!(worst < 1e-20, "{name}: off by {worst:e}");
    }
    let map = channel(&path("h5py-groups.h5"), "marked/m");
    assert_eq!((map.missing(), worst_measured(&map, 1.0)), (3, 0.0), "NoData");
}

/// The largest deviation of measured heights from those expected (nm) times `scale`.
fn worst_measured(map: &HeightMap, scale: f64) -> f64 {
    let mut found = map.heights.clone();
    let expected = expected();
    for (height, expected) in found.values_mut().iter_mut().zip(expected.values()) {
        *height = if height.is_nan() { scale * expected } else { *height };
    }
    worst(&found, &expected, scale)
}

#[test]
fn coordinates_are_no_channels_and_frames_are() {
    let file = path("h5py-groups.h5");
    let names: Vec<String> =
        channels(&file, &ReadParams::default()).expect("channels").into_iter().map(|channel| channel.name).collect();
    for name in ["meshes/XX", "meshes/YY", "other/x_grid", "other/y_grid", "frames/f", "frames/f[3]"] {
        assert!(!names.contains(&name.to_owned()), "{name} in {names:?}");
    }
    let (first, second) = (channel(&file, "frames/f[0]"), channel(&file, "frames/f[1]"));
    assert!(worst(&second.heights, &first.heights, 2.0) < 1e-20 && worst_measured(&first, 1e-9) < 1e-20);
    let layers = [channel(&file, "layers/l[0]"), channel(&file, "layers/l[1]")];
    assert!(worst(&layers[1].heights, &layers[0].heights, 2.0) < 1e-20);
    assert!(worst_measured(&channel(&file, "one/o"), 1e-9) < 1e-20, "dimensions of length 1");
    let vectors = map("h5py-vectors.h5");
    assert!(worst_measured(&vectors, 1e-9) < 1e-20 && vectors.sides.is_some(), "vectors x, y and z");
}

/// The value in column and row of a map.
type Value = fn(usize, usize) -> f64;

/// A MATLAB 5 file of doubles, column by column, with texts as rows of characters.
fn mat(arrays: &[(&str, &[i32], Vec<f64>)], texts: &[(&str, &str)]) -> Vec<u8> {
    let tagged = |kind: u32, data: &[u8]| {
        let mut bytes = [kind.to_le_bytes(), (data.len() as u32).to_le_bytes()].concat();
        bytes.extend(data);
        bytes.resize(bytes.len().next_multiple_of(8), 0);
        bytes
    };
    let array = |class: u8, name: &str, sizes: &[i32], values: Vec<u8>| {
        let sizes: Vec<u8> = sizes.iter().flat_map(|n| n.to_le_bytes()).collect();
        let head = [tagged(6, &[class, 0, 0, 0, 0, 0, 0, 0]), tagged(5, &sizes), tagged(1, name.as_bytes())].concat();
        tagged(14, &[head, values].concat())
    };
    let mut bytes = b"MATLAB 5.0 MAT-file".to_vec();
    bytes.resize(124, b' ');
    bytes.extend(b"\0\x01IM");
    for (name, sizes, values) in arrays {
        bytes.extend(array(6, name, sizes, tagged(9, &doubles(values.iter().copied()))));
    }
    for (name, text) in texts {
        let units: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
        bytes.extend(array(4, name, &[1, text.len() as i32], tagged(4, &units)));
    }
    bytes
}

#[test]
fn matlab_files_have_points_meshes_frames_and_sizes() {
    let (nx, ny) = (11_usize, 13_usize);
    let points = points(nx, ny);
    let n = (nx * ny) as i32;
    let column = |axis: usize| points.iter().map(move |point| point[axis]).collect::<Vec<f64>>();
    let all = [column(0), column(1), column(2)];
    let table = mat(&[("pts", &[n, 3], all.concat())], &[]);
    assert_is_of_points("table", &parse(&table, Format::Mat).expect("a table"), nx, ny, Unit::Unnamed);
    let [x, y, z] = all;
    let vectors = mat(&[("x", &[n, 1], x), ("y", &[n, 1], y), ("height", &[n, 1], z)], &[]);
    assert_is_of_points("vectors", &parse(&vectors, Format::Mat).expect("vectors"), nx, ny, Unit::Unnamed);

    // Column by column, so y runs first, or x for `ij`.
    let (rows, columns) = (ny as i32, nx as i32);
    let of = |value: Value| (0..nx).flat_map(|ix| (0..ny).map(move |iy| value(ix, iy))).collect::<Vec<_>>();
    let of_ij = |value: Value| (0..ny).flat_map(|iy| (0..nx).map(move |ix| value(ix, iy))).collect::<Vec<_>>();
    let x: Value = |ix, _| ix as f64 * 2e-6;
    let y: Value = |_, iy| iy as f64 * 3e-6;
    let z: Value = |ix, iy| ((ix + 11 * iy) * (ix + 11 * iy) % 101) as f64;
    for names in [["XX", "YY", "ZZ"], ["x_grid", "y_grid", "h"], ["Xq", "Yq", "Zq"]] {
        let xy = mat(
            &[
                (names[0], &[rows, columns], of(x)),
                (names[1], &[rows, columns], of(y)),
                (names[2], &[rows, columns], of(z)),
            ],
            &[],
        );
        assert_is_of_points(names[0], &parse(&xy, Format::Mat).expect("meshes"), nx, ny, Unit::Unnamed);
        let ij = [(names[0], of_ij(x)), (names[2], of_ij(z)), (names[1], of_ij(y))].map(|(name, v)| (name, v));
        let ij: Vec<(&str, &[i32], Vec<f64>)> = ij.into_iter().map(|(name, v)| (name, &[11, 13][..], v)).collect();
        assert_is_of_points("ij", &parse(&mat(&ij, &[]), Format::Mat).expect("meshes"), nx, ny, Unit::Unnamed);
    }
    let sizes = mat(
        &[("z", &[rows, columns], of(z)), ("dx", &[1, 1], vec![2.0]), ("dy", &[1, 1], vec![3.0])],
        &[("unit", "um")],
    );
    let sized = parse(&sizes, Format::Mat).expect("a map");
    assert_eq!((sized.side_unit, sized.height_unit), (Unit::Metre, Unit::Metre));
    assert!(sized.sides.is_some_and(|[x, y]| (x / 22e-6 - 1.0).abs() < 1e-12 && (y / 39e-6 - 1.0).abs() < 1e-12));
    let frames = mat(&[("f", &[rows, columns, 2], [of(z), of(y)].concat())], &[]);
    let second = ReadParams { channel: Some("f[1]".into()), ..ReadParams::default() };
    let second = parse_with(&frames, Format::Mat, &second).expect("a frame");
    assert!((second.heights.at(4, 12) - 36e-6).abs() < 1e-15);
    let profile = parse(&mat(&[("x", &[1, n], column(0)), ("z", &[1, n], column(2))], &[]), Format::Mat);
    assert!(profile.expect_err("a profile").to_string().contains("is a profile, not a map"));
}

#[test]
fn images_have_sizes_marks_and_numbers_as_stored() {
    let (metre, unnamed) = (Unit::Metre, Unit::Unnamed);
    for (name, side, unit, missing) in [
        ("tifffile-white.tif", None, unnamed, 0),
        ("tifffile-pages.tif", None, unnamed, 0),
        ("tifffile-imagej.tif", Some(24e-6), metre, 0),
        ("tifffile-ome.tif", Some(24e-6), metre, 0),
        ("tifffile-geo.tif", Some(24.0), metre, 3),
    ] {
        let map = map(name);
        assert_eq!((map.missing(), map.side_unit, map.height_unit), (missing, unit, Unit::GreyLevel), "{name}");
        assert!(worst_measured(&map, 1.0) < 1e-4, "{name}");
        let is_close = |sides: [f64; 2], side: f64| sides.iter().all(|found| (found / side - 1.0).abs() < 1e-6);
        assert_eq!(map.sides.is_some(), side.is_some(), "{name}");
        assert!(map.sides.zip(side).is_none_or(|(sides, side)| is_close(sides, side)), "{name}: {:?}", map.sides);
        assert_eq!(may_have_sides(&path(name), &ReadParams::default()), Ok(side.is_some()), "{name}");
    }
    let second = channel(&path("tifffile-pages.tif"), "2");
    assert!(worst(&second.heights, &expected(), 2.0) < 1e-12, "64-bit floats of the second image");
    let levels = map("tifffile-white-levels.tif");
    let lowest = levels.heights.values().iter().copied().fold(f64::INFINITY, f64::min);
    assert!(lowest.abs() < 1e-12, "the lowest number is white, and numbers are read as stored");
}

#[test]
fn gwyddion_writes_sizes_and_heights_into_png() {
    let texts =
        [("XReal", "3e-6"), ("YReal", "2e-6"), ("XYUnit", "m"), ("ZMin", "-1e-6"), ("ZMax", "2e-6"), ("ZUnit", "m")];
    let image = |texts: &[(&str, &str)], density: Option<u32>| {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, 3, 2);
        encoder.set_color(png::ColorType::Grayscale);
        encoder.set_depth(png::BitDepth::Sixteen);
        let unit = png::Unit::Meter;
        encoder.set_pixel_dims(density.map(|density| png::PixelDimensions { xppu: density, yppu: density, unit }));
        for (name, text) in texts {
            encoder.add_text_chunk(format!("Gwy::{name}"), (*text).to_owned()).expect("a text");
        }
        let mut writer = encoder.write_header().expect("a header");
        let levels: Vec<u8> = [0_u16, 65535, 21845, 1, 2, 3].iter().flat_map(|level| level.to_be_bytes()).collect();
        writer.write_image_data(&levels).expect("levels");
        writer.finish().expect("an image");
        parse(&bytes, Format::Png).expect("a map")
    };
    let of_gwyddion = image(&texts, None);
    assert_eq!((of_gwyddion.sides, of_gwyddion.height_unit), (Some([3e-6, 2e-6]), Unit::Metre));
    // The first row of an image is the top.
    let heights = &of_gwyddion.heights.values()[3..];
    assert!(heights.iter().zip([-1e-6, 2e-6, 0.0]).all(|(a, b)| (a - b).abs() < 1e-15), "{heights:?}");
    // 300 points per inch are those of a printer.
    assert_eq!(image(&[], Some(11811)).sides, None);
    assert_eq!(image(&[], Some(1_000_000)).sides, Some([3e-6, 2e-6]));
    assert_eq!(image(&[], None).height_unit, Unit::GreyLevel);
}

#[test]
fn archives_of_numpy_are_named() {
    let dir = tempfile::tempdir().expect("a temporary folder");
    let path = dir.path().join("maps.npz");
    let mut archive = zip::ZipWriter::new(std::fs::File::create(&path).expect("a file"));
    for name in ["XX.npy", "heights.npy"] {
        archive.start_file(name, zip::write::SimpleFileOptions::default()).expect("a member");
        archive.write_all(&npy("(2, 2)", "'<f8'", &doubles([1., 2., 3., 4.]))).expect("an array");
    }
    archive.finish().expect("an archive");
    let error = read(&path).expect_err("an archive").to_string();
    assert!(error.contains("a NumPy archive (.npz) of XX, heights; save the array of heights"), "{error}");
}
