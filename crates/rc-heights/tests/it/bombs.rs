//! Tests that what a file unpacks to, and what its header claims, stays within the limit of memory.
//!
//! Each file is small and unpacks to 4 MB or more. With a limit of 1 MB it is refused, in one line and at once. Those
//! that are whole maps are read with a larger limit.

use std::io::Write as _;
use std::path::Path;
use std::time::{Duration, Instant};

use flate2::Compression;
use flate2::write::{GzEncoder, ZlibEncoder};
use rc_heights::{FormatError, ReadError, ReadParams, read_with};
use zip::CompressionMethod;

use crate::arrays::npy;
use crate::build_instruments::{PLUX_XML, sur, with};
use crate::files::folder;
use crate::parts::{HEIGHTS, zipped};
use crate::{build, build_instruments};

/// Points along a side of the maps.
const SIDE: usize = 2000;

/// Time in which a file is refused, on a busy machine.
const AT_ONCE: Duration = Duration::from_secs(10);

fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(bytes).expect("memory");
    encoder.finish().expect("memory")
}

fn zlib(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(bytes).expect("memory");
    encoder.finish().expect("memory")
}

/// The same limit for packed and plain files.
fn within(max_bytes: u64) -> ReadParams {
    ReadParams { max_bytes, max_plain_bytes: max_bytes, ..ReadParams::default() }
}

fn read_within(path: &Path, max_bytes: u64) -> Result<(usize, usize), ReadError> {
    let map = read_with(path, &within(max_bytes))?;
    Ok((map.heights.grid().nx(), map.heights.grid().ny()))
}

/// Asserts that a file is refused with a limit of 1 MB as too large.
fn assert_is_refused(path: &Path) {
    let name = path.display();
    let start = Instant::now();
    let error = read_within(path, 1 << 20).expect_err("more than a megabyte");
    assert!(start.elapsed() < AT_ONCE, "{name}: {:?}", start.elapsed());
    let (problem, message) = (&error.problem, error.to_string());
    assert!(matches!(problem, FormatError::TooLarge { limit: 0x0010_0000, .. }), "{name}: {message}");
    assert!(message.contains("1.049 MB that --memory-limit allows") && !message.contains('\n'), "{message}");
}

/// Texts that unpack to 4 MB or more, and whether they are maps.
fn texts() -> Vec<(&'static str, Vec<u8>, bool)> {
    let row = b"0 ".repeat(SIDE);
    let rows = [&row[..], b"\n"].concat().repeat(SIDE);
    let utf_16: Vec<u8> = [0xff, 0xfe].into_iter().chain(rows.iter().flat_map(|byte| [*byte, 0])).collect();
    let points: Vec<String> = (0..700 * 700).map(|i| format!("{} {} 1\n", i % 700, i / 700)).collect();
    vec![
        ("rows.txt", rows.clone(), true),
        ("utf-16.txt", utf_16, true),
        ("points.xyz", points.concat().into_bytes(), true),
        ("comments.csv", b"# comment\n".repeat(1_000_000), false),
        ("words.csv", [b"x; ".repeat(500), b"\n".to_vec()].concat().repeat(4000), false),
        ("latin-1.dat", b"\xb5\xe4\xf6 \xfc\n".repeat(1_000_000), false),
    ]
}

#[test]
fn packed_and_plain_texts_stay_within_the_limit() {
    let dir = tempfile::tempdir().expect("a temporary folder");
    for (name, text, is_map) in texts() {
        for (name, bytes) in [(format!("{name}.gz"), gzip(&text)), (name.to_owned(), text)] {
            let path = dir.path().join(&name);
            std::fs::write(&path, &bytes).expect("a file");
            assert_is_refused(&path);
            assert_eq!(read_within(&path, 1 << 30).is_ok(), is_map, "{name}");
        }
    }
}

#[test]
fn a_text_with_an_endless_line_or_word_is_refused_where_memory_is_plenty() {
    let dir = tempfile::tempdir().expect("a temporary folder");
    let path = dir.path().join("map.txt.gz");
    for (text, expected) in [
        (b"0 ".repeat(2_000_000), "line 1 has 1048577 values, or more, but a row has at most 1048576"),
        (b"0".repeat(18_000_000), "line 1, value 1: 'a word of more than 16777216 characters'"),
    ] {
        std::fs::write(&path, gzip(&text)).expect("a file");
        let error = read_within(&path, 1 << 30).expect_err("endless").to_string();
        assert!(error.contains(expected), "{error}");
    }
}

/// Containers of a map of zeros, and whether they are whole.
fn containers() -> Vec<(&'static str, Vec<u8>)> {
    let n = SIDE * SIDE;
    let (count, side) = ((n as i32).to_le_bytes(), (SIDE as i32).to_le_bytes());
    let shape = format!("({SIDE}, {SIDE})");
    let header = |plain: &[u8]| with(plain.to_vec(), &[(108, &side), (112, &side), (116, &count)]);
    let of_sur = header(&sur(HEIGHTS)[..514]);
    let stream = zlib(&vec![0; 2 * n]);
    let directory: Vec<u8> = [1, 2 * n as u32, stream.len() as u32].iter().flat_map(|n| n.to_le_bytes()).collect();
    let size = format!("<SizeX>{SIDE}</SizeX><SizeY>{SIDE}</SizeY><SizeZ>1</SizeZ>");
    let (xml, heights) = (build::x3p_xml("I", &size, ""), vec![0; 2 * n]);
    let plux = PLUX_XML.replace(">3<", &format!(">{SIDE}<")).replace(">2<", &format!(">{SIDE}<"));
    let packed = CompressionMethod::Deflated;
    vec![
        ("array.npy.gz", gzip(&npy(&shape, "'<f4'", &vec![0; 4 * n]))),
        ("array.npy", npy(&shape, "'|u1'", &vec![0; n])),
        ("points.npy.gz", gzip(&npy(&format!("({n}, 3)"), "'|u1'", &vec![0; 3 * n]))),
        ("plain.sur.gz", gzip(&[of_sur.clone(), vec![0; 2 * n]].concat())),
        ("streams.sur", [with(of_sur, &[(0, b"DSCOMPRESSED")]), directory, stream].concat()),
        ("map.x3p", zipped(&[("main.xml", xml.as_bytes()), ("bindata/data.bin", &heights)], packed)),
        ("map.plux", zipped(&[("index.xml", plux.as_bytes()), ("z.raw", &vec![0; 4 * n])], packed)),
        (
            "map.x3p.gz",
            gzip(&zipped(&[("main.xml", xml.as_bytes()), ("bindata/data.bin", &heights)], CompressionMethod::Stored)),
        ),
        ("map.vk7", vk7()),
        ("map.png", png()),
        ("map.tif", tiff()),
        ("map.mat", mat()),
    ]
}

/// An image of bytes in an archive.
fn vk7() -> Vec<u8> {
    let image = build_instruments::vk4(8, 1);
    let side = (SIDE as u32).to_le_bytes();
    let image = with(image, &[(264, &side), (268, &side)]);
    crate::build_microscopes::vk6(b"VK7", &[image, vec![0; SIDE * SIDE]].concat())
}

fn png() -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, SIDE as u32, SIDE as u32);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::Sixteen);
    encoder.write_header().expect("a header").write_image_data(&vec![0; 2 * SIDE * SIDE]).expect("an image");
    bytes
}

/// One strip of 32-bit floats, deflated.
fn tiff() -> Vec<u8> {
    use tiff::encoder::{Compression, TiffEncoder, colortype::Gray32Float};
    let mut bytes = std::io::Cursor::new(Vec::new());
    let encoder = TiffEncoder::new(&mut bytes).expect("a file");
    let mut encoder = encoder.with_compression(Compression::Deflate(tiff::encoder::DeflateLevel::Best));
    encoder.write_image::<Gray32Float>(SIDE as u32, SIDE as u32, &vec![0.0; SIDE * SIDE]).expect("an image");
    bytes.into_inner()
}

/// One compressed array of bytes.
fn mat() -> Vec<u8> {
    let words = |words: &[u32]| words.iter().flat_map(|word| word.to_le_bytes()).collect::<Vec<u8>>();
    let (side, n) = (SIDE as u32, (SIDE * SIDE) as u32);
    let name = [words(&[0x0001_0001]), b"z\0\0\0".to_vec()].concat();
    let head = [words(&[6, 8, 6, 0, 5, 8, side, side]), name, words(&[2, n])].concat();
    let array = [words(&[14, head.len() as u32 + n]), head, vec![0; n as usize]].concat();
    let packed = zlib(&array);
    let mut bytes = b"MATLAB 5.0 MAT-file".to_vec();
    bytes.resize(124, b' ');
    [bytes, b"\0\x01IM".to_vec(), words(&[15, packed.len() as u32]), packed].concat()
}

#[test]
fn packed_numbers_stay_within_the_limit() {
    let dir = tempfile::tempdir().expect("a temporary folder");
    for (name, bytes) in containers() {
        let path = dir.path().join(name);
        std::fs::write(&path, &bytes).expect("a file");
        assert_is_refused(&path);
        match name {
            // All points are at one place.
            "points.npy.gz" => assert!(read_within(&path, 1 << 30).is_err(), "{name}"),
            name => assert_eq!(read_within(&path, 1 << 30), Ok((SIDE, SIDE)), "{name}"),
        }
    }
    for name in ["h5py-zeros.h5", "netcdf4-zeros.nc"] {
        assert_is_refused(&folder().join(name));
        assert_eq!(read_within(&folder().join(name), 1 << 30), Ok((2048, 2048)), "{name}");
    }
}

#[test]
fn heights_in_a_packed_xml_text_stay_within_the_limit() {
    let dir = tempfile::tempdir().expect("a temporary folder");
    let path = dir.path().join("list.x3p");
    let size = format!("<SizeX>{SIDE}</SizeX><SizeY>100</SizeY><SizeZ>1</SizeZ>");
    let list = format!("<DataList>{}</DataList>", "<Datum>1</Datum>".repeat(SIDE * 100));
    let xml = build::x3p_xml("D", &size, "").replace("<PointDataLink>bindata/data.bin</PointDataLink>", "");
    let xml = xml.replace("<DataLink>", &format!("{list}<DataLink>"));
    std::fs::write(&path, zipped(&[("main.xml", xml.as_bytes())], CompressionMethod::Deflated)).expect("a file");
    assert_is_refused(&path);
    assert_eq!(read_within(&path, 1 << 30), Ok((SIDE, 100)));
}

#[test]
fn a_classic_netcdf_file_that_promises_a_large_map_is_refused() {
    let words = |words: &[u32]| words.iter().flat_map(|word| word.to_be_bytes()).collect::<Vec<u8>>();
    // Dimensions x and y, then a variable z of both with doubles, whose values are missing.
    let file = [
        b"CDF\x01".to_vec(),
        words(&[0, 10, 2, 1]),
        b"y\0\0\0".to_vec(),
        words(&[30_000, 1]),
        b"x\0\0\0".to_vec(),
        words(&[30_000, 0, 0, 11, 1, 1]),
        b"z\0\0\0".to_vec(),
        words(&[2, 0, 1, 0, 0, 6, u32::MAX, 120]),
    ];
    let dir = tempfile::tempdir().expect("a temporary folder");
    let path = dir.path().join("map.nc");
    for values in [0, 1 << 20] {
        std::fs::write(&path, [file.concat(), vec![0; values]].concat()).expect("a file");
        for limit in [3 << 20, 1 << 40] {
            let start = Instant::now();
            let error = read_within(&path, limit).expect_err("a promise").to_string();
            assert!(!error.contains('\n') && start.elapsed() < AT_ONCE, "{error}");
        }
    }
}

#[test]
fn every_file_is_read_within_a_limit_that_is_a_multiple_of_its_size() {
    let dir = tempfile::tempdir().expect("a temporary folder");
    for (name, format, bytes) in
        build::all().into_iter().chain(build_instruments::all()).chain(crate::build_microscopes::all())
    {
        let path = dir.path().join("map");
        std::fs::write(&path, &bytes).expect("a file");
        let params = within(64 * bytes.len() as u64 + 4096);
        // The others have no mark, or are whole only with their name.
        if rc_heights::format_of(&path) == Ok(format) {
            assert!(read_with(&path, &params).is_ok(), "{name}");
        }
        let params = within(10);
        assert!(read_with(&path, &params).is_err(), "{name}");
    }
}
