//! A writer of NetCDF classic files ("NetCDF Classic Format Specification", 64-bit offsets).
//!
//! A file has the coordinates `x` and `y` of the centres of points (m), and the variable `height(y, x)` (m). The first
//! row has the lowest y.

use std::fs::File;
use std::io::{self, BufWriter, Write as _};
use std::path::Path;

use rc_core::{Field, Grid};

/// Tags of the lists of dimensions, variables and attributes.
const DIMENSIONS: u32 = 10;
const VARIABLES: u32 = 11;
const ATTRIBUTES: u32 = 12;

/// Types of values: characters and 64-bit floats.
const CHARACTERS: u32 = 2;
const DOUBLE: u32 = 6;

/// Bytes of a value.
const SIZE: u64 = 8;

/// Writes a field as `height` with its coordinates, with heights and `sides` in m.
///
/// Heights are multiplied by `factor`. A missing point is NaN, which is `_FillValue` of the variable.
///
/// # Errors
/// Errors of the file system.
pub fn write(path: &Path, field: &Field, factor: f64, sides: [f64; 2]) -> io::Result<()> {
    let grid = field.grid();
    let (nx, ny) = (grid.nx(), grid.ny());
    let mut out = BufWriter::with_capacity(1 << 16, File::create(path)?);
    // The length of the header does not depend on the places in it.
    let start = header(grid, 0).len() as u64;
    out.write_all(&header(grid, start))?;
    for (n, side) in [(ny, sides[1]), (nx, sides[0])] {
        for i in 0..n {
            out.write_all(&((i as f64 + 0.5) * (side / n as f64)).to_be_bytes())?;
        }
    }
    for height in field.values() {
        out.write_all(&(height * factor).to_be_bytes())?;
    }
    out.into_inner().map_err(io::IntoInnerError::into_error)?.sync_all()
}

/// The header of a file whose values begin at `start`.
fn header(grid: Grid, start: u64) -> Vec<u8> {
    let (nx, ny) = (grid.nx() as u64, grid.ny() as u64);
    let mut out = Header(b"CDF\x02".to_vec());
    out.numbers(&[0]); // No records.
    out.numbers(&[DIMENSIONS, 2]);
    for (name, n) in [("y", ny), ("x", nx)] {
        out.text(name);
        out.numbers(&[n as u32]);
    }
    out.numbers(&[0, 0]); // No attributes of the file.
    out.numbers(&[VARIABLES, 3]);
    out.variable("y", &[0], ny, start);
    out.variable("x", &[1], nx, start + SIZE * ny);
    out.variable("height", &[0, 1], nx * ny, start + SIZE * (ny + nx));
    out.0
}

/// Bytes of a header. Numbers are big-endian, and texts are padded to multiples of four bytes.
struct Header(Vec<u8>);

impl Header {
    fn numbers(&mut self, numbers: &[u32]) {
        self.0.extend(numbers.iter().flat_map(|number| number.to_be_bytes()));
    }

    fn text(&mut self, text: &str) {
        self.numbers(&[text.len() as u32]);
        self.0.extend(text.as_bytes());
        self.0.resize(self.0.len().next_multiple_of(4), 0);
    }

    /// A variable of `n` values in m.
    fn variable(&mut self, name: &str, dimensions: &[u32], n: u64, start: u64) {
        self.text(name);
        self.numbers(&[dimensions.len() as u32]);
        self.numbers(dimensions);
        let has_missing = dimensions.len() == 2;
        self.numbers(&[ATTRIBUTES, 1 + u32::from(has_missing)]);
        self.text("units");
        self.numbers(&[CHARACTERS]);
        self.text("m");
        if has_missing {
            self.text("_FillValue");
            self.numbers(&[DOUBLE, 1]);
            self.0.extend(f64::NAN.to_be_bytes());
        }
        // By the specification, a size that does not fit is the greatest number.
        self.numbers(&[DOUBLE, u32::try_from(SIZE * n).unwrap_or(u32::MAX)]);
        self.0.extend(start.to_be_bytes());
    }
}
