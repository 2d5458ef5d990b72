//! Small files of microscopes and profilers, built byte by byte.
//!
//! They have 3 x 2 points at distances of 2 µm and 3 µm, with the heights 1 to 6 nm, as those of `build_instruments`.

use rc_heights::Format;
use zip::CompressionMethod;

use crate::build_instruments::{f32s, i16s, vk4};
use crate::parts::{HEIGHTS, zipped};

pub(crate) fn f64s(values: &[f64]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

fn u32s(values: &[u32]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

/// A picture, then an archive with `content` as the file of version 4.
pub(crate) fn vk6(mark: &[u8], content: &[u8]) -> Vec<u8> {
    let picture = b"BM a picture";
    let archive = zipped(&[("Vk4File", content), ("other", b"x")], CompressionMethod::Deflated);
    [mark, &u32s(&[picture.len() as u32]), picture, &archive].concat()
}

/// The section of a data set of 16-bit integers whose unit is 1e-9 times `unit`.
pub(crate) fn nid_section(name: &str, frame: &str, quantity: &str, unit: &str) -> String {
    format!(
        "[{name}]\r\nPoints=3\r\nLines=2\r\nFrame={frame}\r\nDim0Unit=m\r\nDim0Range=6e-6\r\nDim1Unit=m\r\nDim1Range=6e-6\r\n\
         Dim2Name={quantity}\r\nDim2Unit={unit}\r\nDim2Range=65536e-9\r\nDim2Min=-32768e-9\r\nSaveMode=Binary\r\nSaveBits=16\r\n\
         SaveSign=Signed\r\nSaveOrder=Intel\r\n\r\n"
    )
}

/// A list of two data sets, their sections, and their integers.
pub(crate) fn nid(sections: &str, data: &[u8]) -> Vec<u8> {
    let list = "[DataSet]\r\nGroupCount=2\r\nGr0-Ch0=A\r\nGr0-Ch3=B\r\nGr1-Ch0=C\r\n\r\n";
    [format!("{list}{sections}\r\n#!").as_bytes(), data].concat()
}

/// A file with a force, heights, and heights of the way back.
pub(crate) fn nid_three() -> Vec<u8> {
    let sections = nid_section("A", "Scan forward", "Deflection", "N")
        + &nid_section("B", "Scan forward", "Z-Axis", "m")
        + &nid_section("C", "Scan backward", "Z-Axis", "m");
    nid(&sections, &[i16s([0.0; 6]), i16s(HEIGHTS), i16s([6.0, 5.0, 4.0, 3.0, 2.0, 1.0])].concat())
}

pub(crate) const WSXM_HEADER: &str = "[Control]\r\n\r\n    X Amplitude: 6 um\r\n    Y Amplitude: 6000 nm\r\n\r\n[General Info]\r\n\r\n    \
     Acquisition channel: Topography\r\n    Image Data Type: double\r\n    Number of columns: 3\r\n    \
     Number of rows: 2\r\n    Z Amplitude: 5 nm\r\n\r\n";

/// The numbers begin at the right of each row.
pub(crate) const WSXM_NUMBERS: [f64; 6] = [3.0, 2.0, 1.0, 6.0, 5.0, 4.0];

pub(crate) fn wsxm(header: &str, numbers: &[u8]) -> Vec<u8> {
    let start = "WSxM file copyright UAM\r\nSxM Image file\r\nImage header size: 4607\r\n\r\n";
    [format!("{start}{header}[Header end]\r\n").as_bytes(), numbers].concat()
}

/// Bytes after their number in four bytes.
pub(crate) fn named(bytes: &[u8]) -> Vec<u8> {
    [&u32s(&[bytes.len() as u32]), bytes].concat()
}

/// Bytes after their number in one, two or four bytes.
pub(crate) fn sized(bytes: &[u8]) -> Vec<u8> {
    let length = bytes.len() as u32;
    match length {
        0..256 => [&[1, length as u8], bytes].concat(),
        256..65536 => [&[2], &length.to_le_bytes()[..2], bytes].concat(),
        _ => [&[4], &length.to_le_bytes()[..], bytes].concat(),
    }
}

/// An item of a type with its content.
pub(crate) fn item(name: &str, kind: u8, content: &[u8]) -> Vec<u8> {
    [&named(name.as_bytes()), &[kind][..], content].concat()
}

pub(crate) fn container(name: &str, items: &[Vec<u8>]) -> Vec<u8> {
    let end = item("", 0x7f, &[0xff, 0xff]);
    item(name, 0x7d, &sized(&[&items.concat(), &end[..]].concat()))
}

pub(crate) fn quantity(name: &str, value: f64, symbol: &str) -> Vec<u8> {
    item(name, 0x13, &sized(&[f64s(&[value]), named(b"a unit"), named(symbol.as_bytes())].concat()))
}

pub(crate) fn matrix(columns: u32, values: &[f64]) -> Vec<u8> {
    let content = [u32s(&[values.len() as u32 / columns, columns]), f32s(values)].concat();
    item("Matrix", 0, &[named(b"a type"), u32s(&[0]), named(b"a name"), sized(&content)].concat())
}

pub(crate) fn opdx_map(name: &str, items: &[Vec<u8>]) -> Vec<u8> {
    // An axis has a value, a name, a symbol, a divisor and other bytes.
    let axis = [f64s(&[6.0]), named(b"Micrometres"), named(b"um"), f64s(&[1.0]), vec![0; 12]].concat();
    let positions = [named(b"a type"), sized(&axis.repeat(2))].concat();
    let other = [item("Inverted", 1, &[0]), item("PositionFunction", 0x7c, &positions)].concat();
    container(name, &[items.concat(), other])
}

/// The items of a map.
pub(crate) fn opdx_items() -> Vec<Vec<u8>> {
    vec![
        quantity("DataScale", 1e-3, "\u{b5}m"),
        matrix(3, &HEIGHTS),
        quantity("Dimension1Extent", 3.0, "\u{b5}m"),
        quantity("Dimension2Extent", 4e-3, "mm"),
        item("Dimension1Points", 7, &u32s(&[2])),
        item("Dimension2Points", 7, &u32s(&[3])),
        item("DataKind", 0x12, &sized(b"Height")),
    ]
}

/// A file with `maps`. The name of its main map is Height.
pub(crate) fn opdx(maps: &[Vec<u8>]) -> Vec<u8> {
    let list = item("Channels", 0x42, &[named(b"a list"), sized(&named(b"Height"))].concat());
    let about = [
        item("Count", 7, &[1, 0, 0, 0]),
        item("Scale", 0x0d, &[0; 8]),
        item("Time", 0x15, &[0; 9]),
        item("DataKind", 0x12, &sized(b"Surface Height")),
        item("PrimaryData2D", 0x12, &sized(b"Height")),
        list,
    ];
    let end = item("", 0x7f, &[0xff; 8]);
    [b"VCA DATA\x01\0\0\x55".to_vec(), container("MetaData", &about), container("2D_Data", maps), end].concat()
}

pub(crate) fn opdx_two() -> Vec<u8> {
    let mut other = opdx_items();
    other[0] = quantity("DataScale", 1.0, "V");
    opdx(&[opdx_map("Intensity", &other), opdx_map("Height", &opdx_items())])
}

/// Blocks, each with its type.
pub(crate) fn frt(blocks: &[(u16, Vec<u8>)]) -> Vec<u8> {
    let mut bytes = [b"FRTM_GLIDERV1.00".as_slice(), &(blocks.len() as u16).to_le_bytes()].concat();
    for (kind, content) in blocks {
        bytes.extend([&kind.to_le_bytes(), &u32s(&[content.len() as u32])[..], content].concat());
    }
    bytes
}

/// Blocks with integers of 0.1 nm, since the integer 1 is a missing point.
pub(crate) fn frt_blocks(integers: [f64; 6]) -> Vec<(u16, Vec<u8>)> {
    vec![
        (0x65, b"a map".to_vec()),
        (0x66, u32s(&[3, 2, 16])),
        (0x67, [f64s(&[6e-6, 6e-6, 0.0, 0.0, 1.0]), u32s(&[1])].concat()),
        (0x6c, [u32s(&[5]), f64s(&[1e-10])].concat()),
        (0x0b, i16s(integers)),
        (0x70, u32s(&[5, 65529])),
    ]
}

pub(crate) fn tenths() -> [f64; 6] {
    HEIGHTS.map(|height| 10.0 * height)
}

/// The header of an image of Park Systems with 32-bit floats of 1 µm x 1e-3.
pub(crate) fn park_header(grid: [u32; 2], sides: [f64; 2], is_turned: bool) -> Vec<u8> {
    let mut header = vec![0; 580];
    let mut put = |at: usize, bytes: &[u8]| header[at..at + bytes.len()].copy_from_slice(bytes);
    let wide = |text: &str| text.encode_utf16().flat_map(u16::to_le_bytes).collect::<Vec<u8>>();
    put(4, &wide("Z Height"));
    put(100, &u32s(&grid));
    put(136, &u32s(&[is_turned.into()]));
    put(140, &f64s(&sides));
    put(220, &f64s(&[1e-3, 1.0, 0.0]));
    put(244, &wide("\u{b5}m"));
    put(348, &u32s(&[2]));
    header
}

/// A thumbnail of one point, and the private tags.
pub(crate) fn park(header: &[u8], data: &[u8]) -> Vec<u8> {
    let (tags, start) = (12, 8 + 2 + 12 * 12 + 4);
    let mut bytes = [b"II*\0".as_slice(), &u32s(&[8]), &[tags, 0]].concat();
    let entry = |tag: u16, kind: u16, count: usize, value: usize| {
        [tag.to_le_bytes(), kind.to_le_bytes()].concat().into_iter().chain(u32s(&[count as u32, value as u32]))
    };
    for (tag, value) in [(256, 1), (257, 1), (258, 8), (259, 1), (262, 1), (273, start), (278, 1), (279, 1)] {
        bytes.extend(entry(tag, 4, 1, value));
    }
    bytes.extend(entry(50432, 4, 1, 0x0e03_1301));
    bytes.extend(entry(50433, 4, 1, 0x0100_0002));
    bytes.extend(entry(50434, 1, data.len(), start + 1 + header.len()));
    bytes.extend(entry(50435, 7, header.len(), start + 1));
    [&bytes[..], &[0; 4], &[0], header, data].concat()
}

pub(crate) fn park_floats() -> Vec<u8> {
    park(&park_header([3, 2], [6.0, 6.0], false), &f32s(&HEIGHTS))
}

/// A file in Latin-1 or in UTF-16, with integers of 0.5 nm or floats of 1 nm.
pub(crate) fn bcr(kind: &str, numbers: &[u8]) -> Vec<u8> {
    let header = format!(
        "fileformat = {kind}\n% a comment\nheadersize = 1024\nxpixels = 3\nypixels = 2\nxlength = 6000\nylength = 6\nyunit = um\n\
         bit2nm = 0.5\nzunit = nm\nintelmode = 1\n"
    );
    let mut bytes = header.into_bytes();
    bytes.resize(1024, b' ');
    if kind.ends_with("unicode") {
        bytes = bytes.into_iter().flat_map(|byte| [byte, 0]).collect();
    }
    [&bytes, numbers].concat()
}

/// A valid file of each kind.
pub(crate) fn all() -> Vec<(&'static str, Format, Vec<u8>)> {
    vec![
        ("vk6", Format::Vk4, vk6(b"VK6", &vk4(32, 1))),
        ("vk7", Format::Vk4, vk6(b"VK7", &vk4(16, 2))),
        ("nid", Format::Nid, nid_three()),
        ("wsxm", Format::Wsxm, wsxm(WSXM_HEADER, &f64s(&WSXM_NUMBERS))),
        ("opdx", Format::Opdx, opdx_two()),
        ("frt", Format::Frt, frt(&frt_blocks(tenths()))),
        ("tiff of Park", Format::Tiff, park_floats()),
        ("bcr", Format::Bcr, bcr("bcrstm", &i16s(HEIGHTS.map(|height| 2.0 * height)))),
        ("bcr of UTF-16", Format::Bcr, bcr("bcrf_unicode", &f32s(&HEIGHTS))),
    ]
}
