//! Files in the format of the published reference, for tests.

use std::io::Write as _;

use flate2::Compression;
use flate2::write::ZlibEncoder;

/// Codes of the types of elements.
const MATRIX: u32 = 14;
const COMPRESSED: u32 = 15;

fn tagged(kind: u32, data: &[u8]) -> Vec<u8> {
    let mut bytes = [kind.to_le_bytes(), (data.len() as u32).to_le_bytes()].concat();
    bytes.extend(data);
    bytes.resize(bytes.len().next_multiple_of(8), 0);
    bytes
}

/// The bytes of a file with these arrays of doubles, compressed.
pub(super) fn file(arrays: &[(&str, usize, &[f64])]) -> Vec<u8> {
    let mut bytes = vec![b' '; 124];
    bytes.extend(b"\0\x01IM");
    for (name, rows, values) in arrays {
        let dimensions: Vec<u8> =
            [*rows as i32, (values.len() / rows) as i32].iter().flat_map(|n| n.to_le_bytes()).collect();
        let values: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        let parts = [
            tagged(6, &[6, 0, 0, 0, 0, 0, 0, 0]),
            tagged(5, &dimensions),
            tagged(1, name.as_bytes()),
            tagged(9, &values),
        ];
        let mut encoder = ZlibEncoder::new(Vec::new(), Compression::fast());
        encoder.write_all(&tagged(MATRIX, &parts.concat())).expect("memory");
        let packed = encoder.finish().expect("memory");
        bytes.extend([COMPRESSED.to_le_bytes(), (packed.len() as u32).to_le_bytes()].concat());
        bytes.extend(packed);
    }
    bytes
}
