//! Small files of each format, built byte by byte from its specification.
//!
//! They have 3 x 2 points with the heights 1 to 6.

use rc_heights::Format;
use zip::CompressionMethod;

use crate::parts::{HEIGHTS, zipped};

fn concat<const N: usize>(values: impl IntoIterator<Item = f64>, bytes: impl Fn(f64) -> [u8; N]) -> Vec<u8> {
    values.into_iter().flat_map(bytes).collect()
}

fn f32s(values: [f64; 6]) -> Vec<u8> {
    concat(values, |v| (v as f32).to_le_bytes())
}

fn f64s(values: impl IntoIterator<Item = f64>) -> Vec<u8> {
    concat(values, f64::to_le_bytes)
}

pub(crate) fn npy() -> Vec<u8> {
    let mut header = "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 3), }".to_owned();
    while !(10 + header.len() + 1).is_multiple_of(64) {
        header.push(' ');
    }
    header.push('\n');
    [b"\x93NUMPY\x01\x00".as_slice(), &(header.len() as u16).to_le_bytes(), header.as_bytes(), &f64s(HEIGHTS)].concat()
}

/// A text of Zygo of three by two pixels of 2 µm, XYZ or ASCII.
pub(crate) fn zygo(kind: &str, body: &str) -> Vec<u8> {
    let lines = [
        &format!("Zygo {kind} Data File - Format 1"),
        "0 3 0 0 \"Tue Aug 25 16:59:23 2026\"",
        "0 0 3 2 1 255",
        "0 0 3 2",
        "\"\"",
        "\"\"",
        "\"\"",
        "0 0.5 6.328e-07 0 1 0 2e-06 1787677163",
        "3 2 0 0 0 666666 0 \"\"",
        "0 0 1 33 0 0 0.1 60.4318 2 50",
        "1 1 100 0 0 0 0 0 0 0",
        "0 \"\"",
        "1.5 0",
        "#",
        body,
    ];
    lines.join("\n").into_bytes()
}

/// Grid lines at x = 10, 12, 14 and y = 5, 8.
pub(crate) fn surfer_text(heights: &str) -> Vec<u8> {
    format!("DSAA\n3 2\n10 14\n5 8\n1 6\n{heights}\n").into_bytes()
}

pub(crate) fn surfer_6(heights: [f64; 6]) -> Vec<u8> {
    let counts = [3_u16.to_le_bytes(), 2_u16.to_le_bytes()].concat();
    [b"DSBB".to_vec(), counts, f64s([10.0, 14.0, 5.0, 8.0, 1.0, 6.0]), f32s(heights)].concat()
}

/// `blank` is the value in the grid section. A section that rc does not know precedes the data.
pub(crate) fn surfer_7(version: u32, heights: [f64; 6], blank: f64) -> Vec<u8> {
    let section = |tag: &[u8; 4], content: Vec<u8>| {
        [tag.to_vec(), (content.len() as u32).to_le_bytes().to_vec(), content].concat()
    };
    let counts = [2_u32.to_le_bytes(), 3_u32.to_le_bytes()].concat();
    let grid = [counts, f64s([10.0, 5.0, 2.0, 3.0, 1.0, 6.0, 0.0, blank])].concat();
    [
        section(b"DSRB", version.to_le_bytes().to_vec()),
        section(b"GRID", grid),
        section(b"FLTI", vec![0; 12]),
        section(b"DATA", f64s(heights)),
    ]
    .concat()
}

/// `fields` are lines of the header, which is padded as the specification requires.
pub(crate) fn gsf(fields: &str) -> Vec<u8> {
    let mut bytes = format!("Gwyddion Simple Field 1.0\n{fields}").into_bytes();
    let zeros = 4 - bytes.len() % 4;
    bytes.resize(bytes.len() + zeros, 0);
    [bytes, f32s(HEIGHTS)].concat()
}

/// A component of a tree of Gwyddion: name, type and value.
fn gwy_value(name: &str, kind: u8, value: &[u8]) -> Vec<u8> {
    [name.as_bytes(), &[0, kind], value].concat()
}

fn gwy_object(name: &str, content: &[u8]) -> Vec<u8> {
    [name.as_bytes(), &[0], &(content.len() as u32).to_le_bytes(), content].concat()
}

/// A data field of `grid` points with a unit of the sides, which are `sides` if they are given.
pub(crate) fn gwy_field(grid: [u32; 2], sides: Option<[f64; 2]>, unit: &str, values: &[f64]) -> Vec<u8> {
    let si_unit = |name: &str| gwy_object("GwySIUnit", &gwy_value("unitstr", b's', &[name.as_bytes(), &[0]].concat()));
    let mut content = gwy_value("xres", b'i', &grid[0].to_le_bytes());
    content.extend(gwy_value("yres", b'i', &grid[1].to_le_bytes()));
    for (name, side) in ["xreal", "yreal"].into_iter().zip(sides.into_iter().flatten()) {
        content.extend(gwy_value(name, b'd', &side.to_le_bytes()));
    }
    content.extend(gwy_value("si_unit_xy", b'o', &si_unit(unit)));
    content.extend(gwy_value("si_unit_z", b'o', &si_unit("nm")));
    let count = (values.len() as u32).to_le_bytes();
    content.extend(gwy_value("data", b'D', &[count.to_vec(), f64s(values.iter().copied())].concat()));
    gwy_object("GwyDataField", &content)
}

/// A file with these fields, each with its key.
pub(crate) fn gwy(fields: &[(&str, Vec<u8>)]) -> Vec<u8> {
    let content: Vec<u8> = fields.iter().flat_map(|(key, field)| gwy_value(key, b'o', field)).collect();
    [b"GWYP".to_vec(), gwy_object("GwyContainer", &content)].concat()
}

pub(crate) const GSF_FIELDS: &str =
    "XRes = 3\nYRes=2\nXReal = 6e-6\nYReal = 9e-6\nXYUnits = m\nZUnits = nm\nTitle = h\n";

pub(crate) fn sdf_text(heights: &str) -> Vec<u8> {
    let head = "aISO-1.0\r\nManufacID = rc\r\nCreateDate = 010120260000\r\nModDate = 010120260000\r\nNumPoints = 3\r\n\
                NumProfiles = 2\r\nXscale = 2e-6\r\nYscale = 3e-6\r\nZscale = 1e-9\r\nZresolution = -1\r\nCompression = 0\r\n\
                DataType = 7\r\nCheckType = 0\r\n*\r\n";
    format!("{head}{heights}\r\n*\r\nRemark = none\r\n*\r\n").into_bytes()
}

pub(crate) fn sdf_binary(version: &str, data_type: u8, data: &[u8]) -> Vec<u8> {
    let mut bytes = format!("b{version}rc        010120260000010120260000").into_bytes();
    for count in [3_u32, 2] {
        let size = if version == "ISO-2.0" { 4 } else { 2 };
        bytes.extend(&count.to_le_bytes()[..size]);
    }
    bytes.extend(f64s([2e-6, 3e-6, 1e-9, -1.0]));
    bytes.extend([0, data_type, 0]);
    bytes.extend(data);
    bytes
}

/// Heights in each type of numbers of the format.
///
/// The fourth is the minimum of the type, the fifth is the maximum, and the others are 0.
pub(crate) fn sdf_limits() -> Vec<(u8, Vec<u8>)> {
    macro_rules! limits {
        ($type:ident) => {
            [$type::default(), $type::default(), $type::default(), $type::MIN, $type::MAX, $type::default()]
                .map($type::to_le_bytes)
                .concat()
        };
    }
    vec![
        (0, limits!(u8)),
        (1, limits!(u16)),
        (2, limits!(u32)),
        (3, limits!(f32)),
        (4, limits!(i8)),
        (5, limits!(i16)),
        (6, limits!(i32)),
        (7, limits!(f64)),
    ]
}

/// The heights 1 to 6 in each type of numbers of the format, with its number there.
pub(crate) fn sdf_types() -> Vec<(u8, Vec<u8>)> {
    vec![
        (0, concat(HEIGHTS, |v| [v as u8])),
        (1, concat(HEIGHTS, |v| (v as u16).to_le_bytes())),
        (2, concat(HEIGHTS, |v| (v as u32).to_le_bytes())),
        (3, f32s(HEIGHTS)),
        (4, concat(HEIGHTS, |v| (v as i8).to_le_bytes())),
        (5, concat(HEIGHTS, |v| (v as i16).to_le_bytes())),
        (6, concat(HEIGHTS, |v| (v as i32).to_le_bytes())),
        (7, f64s(HEIGHTS)),
    ]
}

pub(crate) fn x3p_xml(kind: &str, size: &str, mask: &str) -> String {
    format!(
        "<?xml version=\"1.0\"?><p:ISO5436_2 xmlns:p=\"http://www.opengps.eu/2008/ISO5436_2\"><Record1><Revision>ISO5436 - \
         2000</Revision><FeatureType>SUR</FeatureType><Axes><CX><AxisType>I</AxisType><DataType>D</DataType>\
         <Increment>2e-6</Increment><Offset>0</Offset></CX><CY><AxisType>I</AxisType><Increment>3e-6</Increment></CY><CZ>\
         <AxisType>A</AxisType><DataType>{kind}</DataType><Increment>1e-9</Increment><Offset>1e-6</Offset></CZ></Axes>\
         </Record1><Record3><MatrixDimension>{size}</MatrixDimension><DataLink><PointDataLink>bindata/data.bin\
         </PointDataLink>{mask}</DataLink></Record3></p:ISO5436_2>"
    )
}

pub(crate) const X3P_SIZE: &str = "<SizeX>3</SizeX><SizeY>2</SizeY><SizeZ>1</SizeZ>";

/// 16-bit integers, where point 4 is marked as missing.
pub(crate) fn x3p(method: CompressionMethod) -> Vec<u8> {
    let xml = x3p_xml("I", X3P_SIZE, "<ValidPointsLink>bindata/valid.bin</ValidPointsLink>");
    let data = concat(HEIGHTS, |v| (v as i16).to_le_bytes());
    zipped(&[("main.xml", xml.as_bytes()), ("bindata/data.bin", &data), ("bindata/valid.bin", &[0b0010_1111])], method)
}

/// Heights in `main.xml`, where - is a missing point.
pub(crate) fn x3p_list(heights: &str) -> Vec<u8> {
    let link = "<DataLink><PointDataLink>bindata/data.bin</PointDataLink></DataLink>";
    let datum = |word| if word == "-" { "<Datum/>".to_owned() } else { format!("\n<Datum> {word} </Datum>") };
    let list: String = heights.split(' ').map(datum).collect();
    let xml = x3p_xml("D", X3P_SIZE, "").replace(link, &format!("<DataList>{list}</DataList>"));
    zipped(&[("main.xml", xml.as_bytes())], CompressionMethod::Deflated)
}

/// 16-bit grayscale, from the encoder of the png crate.
pub(crate) fn png(colour: png::ColorType, depth: png::BitDepth, data: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 3, 2);
    encoder.set_color(colour);
    encoder.set_depth(depth);
    encoder.write_header().expect("a header").write_image_data(data).expect("an image");
    bytes
}

pub(crate) fn png_16() -> Vec<u8> {
    png(png::ColorType::Grayscale, png::BitDepth::Sixteen, &concat(HEIGHTS, |v| (v as u16).to_be_bytes()))
}

/// One strip without compression, little-endian.
pub(crate) fn tiff() -> Vec<u8> {
    tiff_of(
        &concat(HEIGHTS, |v| (v as u16).to_le_bytes()),
        &[
            (256, 3, 3),
            (257, 3, 2),
            (258, 3, 16),
            (259, 3, 1),
            (262, 3, 1),
            (273, 4, 8),
            (277, 3, 1),
            (278, 3, 2),
            (279, 4, 12),
        ],
    )
}

/// The same image in the corner of one tile of `side` x `side` points.
pub(crate) fn tiff_tiled(side: usize) -> Vec<u8> {
    let mut tile = vec![0; 2 * side * side];
    for (i, height) in HEIGHTS.iter().enumerate() {
        let at = 2 * (i / 3 * side + i % 3);
        tile[at..at + 2].copy_from_slice(&(*height as u16).to_le_bytes());
    }
    let (n, bytes) = (side as u32, tile.len() as u32);
    tiff_of(
        &tile,
        &[
            (256, 3, 3),
            (257, 3, 2),
            (258, 3, 16),
            (259, 3, 1),
            (262, 3, 1),
            (277, 3, 1),
            (322, 3, n),
            (323, 3, n),
            (324, 4, 8),
            (325, 4, bytes),
        ],
    )
}

/// `data`, then the only directory: tag, type (3: short, 4: long), value.
fn tiff_of(data: &[u8], entries: &[(u16, u16, u32)]) -> Vec<u8> {
    let mut bytes = [b"II*\0".as_slice(), &(8 + data.len() as u32).to_le_bytes()].concat();
    bytes.extend(data);
    bytes.extend((entries.len() as u16).to_le_bytes());
    for (tag, kind, value) in entries {
        bytes.extend([tag.to_le_bytes(), kind.to_le_bytes()].concat());
        bytes.extend([1_u32.to_le_bytes(), value.to_le_bytes()].concat());
    }
    bytes.extend([0; 4]);
    bytes
}

/// A file of data/formats that is small enough to be damaged byte by byte.
fn written(name: &str) -> Vec<u8> {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/formats");
    std::fs::read(folder.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// A valid file of each kind.
pub(crate) fn all() -> Vec<(&'static str, Format, Vec<u8>)> {
    let mut all = vec![
        ("npy", Format::Npy, npy()),
        ("csv", Format::Csv, b"1,2,3\n4,5,6\n".to_vec()),
        ("xyz", Format::Xyz, b"0 0 1\n1 0 2\n2 0 3\n0 1 4\n1 1 5\n2 1 6\n".to_vec()),
        ("csv of pandas", Format::Csv, b",0,1,2\n0,1.5,2,3\n1,4,NA,6\n".to_vec()),
        ("csv with coordinates", Format::Csv, b"y [um],0,1,2\n0,1,2,3\n2,4,,6\n4,7,8,9\n".to_vec()),
        ("points near a grid", Format::Xyz, b"X,Y,Z\n0,0,1\n1.01,0.02,2\n1.99,0,3\n0,1,4\n1,1,5\n2.01,1,6\n".to_vec()),
        ("ESRI", Format::EsriGrid, b"NCOLS 3\nNROWS 2\nCELLSIZE 2\n1 2 3\n4 -9999 6\n".to_vec()),
        ("Zygo XYZ", Format::Zygo, zygo("XYZ", "0 0 1\n1 0 2\n2 0 3\n0 1 4\n1 1 No Data\n2 1 6\n#\n")),
        ("Zygo ASCII", Format::Zygo, zygo("ASCII", "#\n1 2 3\n4 5 2147483640\n#\n")),
        ("DSAA", Format::Surfer, surfer_text("1 2 3\n4 5 6")),
        ("DSBB", Format::Surfer, surfer_6(HEIGHTS)),
        ("DSRB", Format::Surfer, surfer_7(1, HEIGHTS, 1.70141e38)),
        ("gsf", Format::Gsf, gsf(GSF_FIELDS)),
        ("sdf text", Format::Sdf, sdf_text("1 2 3\r\n4 5 6")),
        ("sdf binary", Format::Sdf, sdf_binary("ISO-1.0", 7, &f64s(HEIGHTS))),
        ("x3p stored", Format::X3p, x3p(CompressionMethod::Stored)),
        ("x3p deflated", Format::X3p, x3p(CompressionMethod::Deflated)),
        ("png", Format::Png, png_16()),
        ("tiff", Format::Tiff, tiff()),
        ("tiff of OME", Format::Tiff, written("tifffile-ome.tif")),
        ("tiff of GDAL", Format::Tiff, written("tifffile-geo.tif")),
        ("tiff whose white is zero", Format::Tiff, written("tifffile-white.tif")),
        ("tiff of 64 bits", Format::Tiff, written("tifffile-pages.tif")),
        ("gwy", Format::Gwy, written("gwyfile.gwy")),
        ("h5 chunked", Format::Hdf5, written("h5py-chunked.h5")),
        ("h5 groups", Format::Hdf5, written("h5py-groups.h5")),
        ("h5 vectors", Format::Hdf5, written("h5py-vectors.h5")),
        ("h5 contiguous", Format::Hdf5, written("h5py-contiguous.h5")),
        ("ibw", Format::Ibw, written("igorwriter-stack.ibw")),
        ("mat compressed", Format::Mat, written("scipy-mesh.mat")),
        ("mat", Format::Mat, written("scipy-vectors.mat")),
        ("nc", Format::NetCdf, written("netcdf4-classic.nc")),
        ("nc of HDF5", Format::Hdf5, written("netcdf4-zlib.nc")),
        ("Gwyddion's text", Format::Csv, written("gwyddion.txt")),
        ("text of UTF-16", Format::Csv, written("gwyddion-utf16.txt")),
        ("columns", Format::Xyz, written("columns.csv")),
    ];
    all.extend(crate::build_instruments::all());
    all.extend(crate::build_microscopes::all());
    all.push(("x3p with a list", Format::X3p, x3p_list("1 2 3 4 - 6")));
    all
}
