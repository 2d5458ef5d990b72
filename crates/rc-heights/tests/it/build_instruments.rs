//! Small files of instruments, built byte by byte.
//!
//! They have 3 x 2 points at distances of 2 µm and 3 µm, with the heights 1 to 6 nm.

use std::io::Write as _;

use flate2::Compression;
use flate2::write::ZlibEncoder;
use rc_heights::Format;
use zip::CompressionMethod;

use crate::parts::{HEIGHTS, zipped};

/// `bytes` with changes at some places.
pub(crate) fn with(mut bytes: Vec<u8>, changes: &[(usize, &[u8])]) -> Vec<u8> {
    for (at, change) in changes {
        bytes[*at..at + change.len()].copy_from_slice(change);
    }
    bytes
}

pub(crate) fn f32s(values: &[f64]) -> Vec<u8> {
    values.iter().flat_map(|value| (*value as f32).to_le_bytes()).collect()
}

pub(crate) fn i16s(values: [f64; 6]) -> Vec<u8> {
    values.iter().flat_map(|value| (*value as i16).to_le_bytes()).collect()
}

/// An object of Digital Surf with 16-bit integers of 1 nm.
///
/// All points are measured, and the lowest is 1.
pub(crate) fn sur(integers: [f64; 6]) -> Vec<u8> {
    let (count, texts) = (|n: i32| n.to_le_bytes(), |text: &str| text.as_bytes().to_vec());
    let header = with(
        vec![0; 512],
        &[
            (0, b"DIGITAL SURF"),
            (18, &2_u16.to_le_bytes()),
            (98, &16_u16.to_le_bytes()),
            (100, &count(1)),
            (108, &count(3)),
            (112, &count(2)),
            (116, &count(6)),
            (120, &f32s(&[2.0, 3.0, 1.0])),
            (180, &texts("um")),
            (196, &texts("um")),
            (212, &texts("nm")),
            (334, &2_u16.to_le_bytes()),
        ],
    );
    [header, b"hi".to_vec(), i16s(integers)].concat()
}

/// The object of [`sur`], compressed in two streams.
pub(crate) fn sur_zlib() -> Vec<u8> {
    let plain = sur(HEIGHTS);
    let (header, integers) = plain.split_at(514);
    let streams = [&integers[..4], &integers[4..]].map(|part| {
        let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
        encoder.write_all(part).expect("memory");
        (part.len(), encoder.finish().expect("memory"))
    });
    let mut bytes = with(header.to_vec(), &[(0, b"DSCOMPRESSED")]);
    bytes.extend(2_u32.to_le_bytes());
    for (length, stream) in &streams {
        bytes.extend([(*length as u32).to_le_bytes(), (stream.len() as u32).to_le_bytes()].concat());
    }
    bytes.extend(streams.iter().flat_map(|(_, stream)| stream));
    bytes
}

/// Length of the header of [`nanoscope`].
pub(crate) const NANOSCOPE_HEADER: usize = 1024;

/// The lines of an image that starts `offset` bytes after the header.
pub(crate) fn nanoscope_image(name: &str, z_scale: &str, offset: usize) -> String {
    let offset = NANOSCOPE_HEADER + offset;
    format!(
        "\\*Ciao image list\r\n\\Data offset: {offset}\r\n\\Data length: 12\r\n\\Bytes/pixel: 2\r\n\\Samps/line: 3\r\n\
         \\Number of lines: 2\r\n\\Aspect Ratio: 1:1\r\n\\Scan Size: 6 6 ~m\r\n\\@2:Image Data: S [x] \"{name}\"\r\n\
         \\@2:Z scale: {z_scale}\r\n"
    )
}

pub(crate) const Z_SCALE: &str = "V [Sens. Zsens] (0.0001 V/LSB) 6.5536 V";

/// A file with the lines `global` and `images` in its header.
pub(crate) fn nanoscope(global: &str, images: &str, data: &[u8]) -> Vec<u8> {
    let start = "\\*File list\r\n\\Version: 0x05310001\r\n\\*Scanner list\r\n\\@Sens. Zsens: V 10000.0 nm/V\r\n";
    let mut bytes = format!("{start}{global}{images}\\*File list end\r\n").into_bytes();
    bytes.push(0x1a);
    bytes.resize(NANOSCOPE_HEADER, 0);
    [&bytes, data].concat()
}

/// A file with an image of a phase and an image of heights.
pub(crate) fn nanoscope_two() -> Vec<u8> {
    let images = nanoscope_image("Phase", "V [Sens. Phase] (0.005 deg/LSB) 65536 deg", 0)
        + &nanoscope_image("Height", Z_SCALE, 12);
    nanoscope("\\*Ciao scan list\r\n\\@Sens. Phase: V 1.0 \r\n", &images, &[i16s(HEIGHTS), i16s(HEIGHTS)].concat())
}

/// A Wyko file of blocks, each with name, type and content.
pub(crate) fn opd(blocks: &[(&str, u16, Vec<u8>)]) -> Vec<u8> {
    let entry = |name: &str, kind: u16, length: usize| {
        let mut entry = name.as_bytes().to_vec();
        entry.resize(16, 0);
        entry.extend(kind.to_le_bytes());
        entry.extend((length as u32).to_le_bytes());
        entry.extend([0, 0]);
        entry
    };
    let mut bytes = [vec![1, 0], entry("Directory", 1, 24 * (blocks.len() + 1))].concat();
    for (name, kind, content) in blocks {
        bytes.extend(entry(name, *kind, content.len()));
    }
    bytes.extend(blocks.iter().flat_map(|(.., content)| content));
    bytes
}

/// Blocks with integers of 1 nm, column by column.
pub(crate) fn opd_blocks() -> Vec<(&'static str, u16, Vec<u8>)> {
    let size = [3_u16, 2, 2].map(u16::to_le_bytes).concat();
    vec![
        ("Title", 5, b"a map".to_vec()),
        ("RAW_DATA", 3, [size, i16s([1.0, 4.0, 2.0, 5.0, 3.0, 6.0])].concat()),
        ("Wavelength", 7, f32s(&[500.0])),
        ("Mult", 6, 500_u16.to_le_bytes().to_vec()),
        ("Aspect", 7, f32s(&[1.5])),
        ("Pixel_size", 7, f32s(&[0.002])),
    ]
}

/// Phases of 1 nm, after intensities of 2 x 1 points.
pub(crate) fn metropro(phases: [i32; 6]) -> Vec<u8> {
    let float = |value: f32| value.to_be_bytes();
    let short = |value: u16| value.to_be_bytes();
    let header = with(
        vec![0; 834],
        &[
            (0, b"\x88\x1b\x03\x6f"),
            (4, &short(1)),
            (6, &834_u32.to_be_bytes()),
            (52, &[short(2), short(1), short(1)].concat()),
            (68, &[short(3), short(2)].concat()),
            (164, &float(0.5)),
            (168, &float(8192e-9)),
            (176, &float(1.0)),
            (184, &float(2e-6)),
        ],
    );
    let phases = phases.iter().flat_map(|phase| phase.to_be_bytes());
    header.into_iter().chain([0; 4]).chain(phases).collect()
}

/// A file whose rows are padded to 16 bytes.
pub(crate) fn al3d(tags: &[(&str, &str)]) -> Vec<u8> {
    let count = (tags.len() + 1).to_string();
    let offset = (17 + 52 * (tags.len() + 3)).to_string();
    let mut bytes = b"AliconaImaging\0\r\n".to_vec();
    let first = [("Version", "1"), ("TagCount", &count)];
    for (name, value) in first.iter().chain(tags).chain(&[("DepthImageOffset", offset.as_str())]) {
        for (text, length) in [(name, 20), (value, 30)] {
            bytes.extend(text.as_bytes());
            bytes.resize(bytes.len() + length - text.len(), 0);
        }
        bytes.extend(b"\r\n");
    }
    for row in HEIGHTS.chunks(3) {
        bytes.extend(f32s(&[row[0] * 1e-9, row[1] * 1e-9, row[2] * 1e-9, 7.0]));
    }
    bytes
}

pub(crate) const AL3D_TAGS: [(&str, &str); 4] =
    [("Cols", "3"), ("Rows", "2"), ("PixelSizeXMeter", "2e-6"), ("PixelSizeYMeter", "3e-6")];

/// A file with `layers` of the same heights, each with an image.
pub(crate) fn plu(layers: u8) -> Vec<u8> {
    let header = with(
        vec![0; 500],
        &[(388 + 16, &f32s(&[2.0, 3.0])), (428, &3_u32.to_le_bytes()), (489, &[layers]), (492, &[1])],
    );
    let mut layer = [2_u32, 3].map(u32::to_le_bytes).concat();
    layer.extend(f32s(&HEIGHTS.map(|height| height * 1e-3)));
    layer.extend(f32s(&[1e-3, 6e-3]));
    layer.extend([128; 18]);
    [header, layer.repeat(usize::from(layers))].concat()
}

pub(crate) const PLUX_XML: &str = "<xml><GENERAL><IMAGE_SIZE_X>3</IMAGE_SIZE_X><IMAGE_SIZE_Y>2</IMAGE_SIZE_Y><FOV_X>2.0</FOV_X>\
     <FOV_Y>3.0</FOV_Y></GENERAL><LAYER_0><FILENAME_Z>z.raw</FILENAME_Z></LAYER_0></xml>";

pub(crate) fn plux(xml: &str, file: &str) -> Vec<u8> {
    let heights = f32s(&HEIGHTS.map(|height| height * 1e-3));
    zipped(&[("index.xml", xml.as_bytes()), (file, &heights)], CompressionMethod::Deflated)
}

/// A file with one or two images of heights of 1 nm, with integers of `bits`.
pub(crate) fn vk4(bits: u32, images: usize) -> Vec<u8> {
    let size = bits as usize / 8;
    let mut image: Vec<u8> = [3, 2, bits, 0, 6 * bits / 8, 0, 0].map(u32::to_le_bytes).concat();
    image.resize(28 + 768, 0);
    image.extend(HEIGHTS.iter().flat_map(|height| (*height as u32).to_le_bytes().into_iter().take(size)));
    let mut bytes = with(vec![0; 84 + 180], &[(0, b"VK4_"), (12, &84_u32.to_le_bytes())]);
    bytes = with(bytes, &[(84 + 168, &[2_000_000_u32, 3_000_000, 1000].map(u32::to_le_bytes).concat())]);
    for i in 0..images {
        let place = bytes.len() as u32;
        bytes = with(bytes, &[(36 + 4 * i, &place.to_le_bytes())]);
        bytes.extend(&image);
    }
    bytes
}

/// A valid file of each kind.
pub(crate) fn all() -> Vec<(&'static str, Format, Vec<u8>)> {
    vec![
        ("sur", Format::Sur, sur(HEIGHTS)),
        ("two sur", Format::Sur, [sur(HEIGHTS), sur(HEIGHTS)].concat()),
        ("sur zlib", Format::Sur, sur_zlib()),
        ("nanoscope", Format::Nanoscope, nanoscope_two()),
        ("opd", Format::Opd, opd(&opd_blocks())),
        ("metropro", Format::MetroPro, metropro([1, 2, 3, 4, 5, 6])),
        ("al3d", Format::Al3d, al3d(&AL3D_TAGS)),
        ("plu", Format::Plu, plu(2)),
        ("plux", Format::Plux, plux(PLUX_XML, "z.raw")),
        ("vk4", Format::Vk4, vk4(32, 1)),
    ]
}
