//! A folder in which tests run `rc`, and checks of its output.

use std::fs;
use std::io::Read as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;
use tempfile::TempDir;

/// A problem that is small enough for every test: 8 waves on 128 x 128 elements.
pub(crate) const SMALL: [&str; 6] = ["solve", "--waves", "8", "--grid", "128", "--quiet"];

/// Size and material of the example, which a height map must be given.
pub(crate) const CELL: [&str; 2] = ["--cell", "0.01"];
pub(crate) const MATERIAL: [&str; 4] = ["--young", "0.4e9", "--poisson", "0.45"];

/// Arguments for the height map in `file`, with cell and material of the example.
///
/// `more` arguments follow.
pub(crate) fn map<'a>(command: &'a str, file: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    [&[command, "--heights", file], &CELL[..], &MATERIAL, more].concat()
}

/// Arguments of the small problem at `pressure` Pa, followed by `more`.
pub(crate) fn small<'a>(pressure: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    [&SMALL[..], &["--pressure", pressure], more].concat()
}

/// The pictures of a surface that `rc inspect --out` and `rc plot` write.
pub(crate) const SURFACE_PICTURES: [&str; 7] = [
    "distribution.png",
    "distribution.svg",
    "material_ratio.png",
    "material_ratio.svg",
    "spectrum.png",
    "spectrum.svg",
    "surface.png",
];

/// A folder in which commands run.
pub(crate) struct Place(TempDir);

impl Place {
    pub(crate) fn new() -> Self {
        Self(tempfile::tempdir().expect("a temporary folder"))
    }

    pub(crate) fn folder(&self) -> &Path {
        self.0.path()
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub(crate) fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        fs::write(self.path(name), content).expect("a file in the temporary folder");
    }

    pub(crate) fn run(&self, args: &[&str]) -> Output {
        Command::new(env!("CARGO_BIN_EXE_rc")).args(args).current_dir(self.folder()).output().expect("rc runs")
    }

    /// Sorted names of the entries of `folder`, with hidden ones.
    pub(crate) fn names(&self, folder: &str) -> Vec<String> {
        let entries = fs::read_dir(self.path(folder)).expect("a folder");
        let name = |entry: std::io::Result<fs::DirEntry>| entry.expect("an entry").file_name();
        let mut names: Vec<String> = entries.map(|entry| name(entry).to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    pub(crate) fn bytes(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap_or_else(|cause| panic!("{name}: {cause}"))
    }

    /// Names and contents of the files in `folder`.
    pub(crate) fn contents(&self, folder: &str) -> Vec<(String, Vec<u8>)> {
        self.names(folder).into_iter().map(|name| (name.clone(), self.bytes(&format!("{folder}/{name}")))).collect()
    }

    pub(crate) fn json(&self, name: &str) -> serde_json::Value {
        serde_json::from_slice(&self.bytes(name)).expect("valid JSON")
    }
}

pub(crate) fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

pub(crate) fn assert_solved(output: &Output) {
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
}

/// The codes of the warnings in a summary or in the record of a surface.
pub(crate) fn codes(json: &serde_json::Value) -> Vec<String> {
    let list = json["warnings"].as_array().expect("a list of warnings");
    list.iter().map(|warning| warning["code"].as_str().expect("a code").to_owned()).collect()
}

/// Fails unless the exit code is 2 and the only output is one line with `expected`.
///
/// The line must be on standard error.
pub(crate) fn assert_refused(output: &Output, expected: &str) {
    let message = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(output.stdout.is_empty(), "standard output: {}", text(&output.stdout));
    assert_eq!(message.lines().count(), 1, "not one line: {message}");
    assert!(message.starts_with("error: ") && message.contains(expected), "no '{expected}' in: {message}");
}

/// An npy file of version 1.0.
pub(crate) fn npy(dtype: &str, fortran: bool, shape: &str, data: &[u8]) -> Vec<u8> {
    let order = if fortran { "True" } else { "False" };
    let mut header = format!("{{'descr': '{dtype}', 'fortran_order': {order}, 'shape': {shape}, }}");
    while (10 + header.len() + 1) % 64 != 0 {
        header.push(' ');
    }
    header.push('\n');
    let length = u16::try_from(header.len()).expect("a short header");
    [b"\x93NUMPY\x01\x00".as_slice(), &length.to_le_bytes(), header.as_bytes(), data].concat()
}

/// Heights (m) of a bumpy surface on n x n points, exact in `f32`.
pub(crate) fn bumps(n: usize) -> Vec<f32> {
    let wave = |i: usize, k: f64| (std::f64::consts::TAU * k * (i as f64 + 0.5) / n as f64).cos();
    let height = |i: usize| 1e-5 * (wave(i % n, 2.0) + 0.5 * wave(i / n, 3.0) * wave(i % n, 5.0));
    (0..n * n).map(|i| height(i) as f32).collect()
}

/// The bytes of the values as little-endian `f64`.
pub(crate) fn f8(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|v| f64::from(*v).to_le_bytes()).collect()
}

/// Description, attributes and bytes of an array of a Zarr group, version 2.
///
/// The bytes are put together from chunks, row by row.
pub(crate) fn array(place: &Place, folder: &str) -> (Value, Value, Vec<u8>) {
    let description = place.json(&format!("{folder}/.zarray"));
    let numbers = |key: &str| -> Vec<usize> { serde_json::from_value(description[key].clone()).expect("lengths") };
    let (shape, chunks) = (numbers("shape"), numbers("chunks"));
    let size = if description["dtype"] == "|u1" { 1 } else { 8 };
    let (nx, width) = (shape[shape.len() - 1], chunks[chunks.len() - 1]);
    let (ny, height) = if shape.len() == 1 { (1, 1) } else { (shape[0], chunks[0]) };
    let mut bytes = vec![0; nx * ny * size];
    let mut n_chunks = 0;
    for row in 0..ny.div_ceil(height) {
        for column in 0..nx.div_ceil(width) {
            let name = if shape.len() == 1 { column.to_string() } else { format!("{row}.{column}") };
            let file = place.bytes(&format!("{folder}/{name}"));
            let mut chunk = Vec::new();
            flate2::read::ZlibDecoder::new(&file[..]).read_to_end(&mut chunk).expect("a zlib stream");
            assert_eq!(chunk.len(), height * width * size, "{folder}/{name}: all chunks are equally large");
            let columns = width.min(nx - column * width);
            for line in 0..height.min(ny - row * height) {
                let at = ((row * height + line) * nx + column * width) * size;
                bytes[at..at + columns * size].copy_from_slice(&chunk[line * width * size..][..columns * size]);
            }
            n_chunks += 1;
        }
    }
    assert_eq!(place.names(folder).len(), n_chunks + 2, "{folder}: files that are no chunks");
    (description, place.json(&format!("{folder}/.zattrs")), bytes)
}
