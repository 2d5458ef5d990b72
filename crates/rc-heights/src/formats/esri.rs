//! ESRI ASCII grids.
//!
//! Lines `name value` precede the heights, which may be on any number of lines. The first height is that of the upper
//! left point.

use rc_core::Grid;

use super::channel::{Channels, only};
use super::decode::decoded;
use super::field::{field, flip};
use super::fields::{positive, refused, shown};
use super::lines::{cell, data_lines, lines, number, unquoted, words};
use super::marks::Marks;
use crate::{Format, FormatError, HeightMap, ReadNote, Unit};

/// Names of the header, in small letters.
const NAMES: [&str; 13] = [
    "ncols",
    "nrows",
    "xllcorner",
    "xllcenter",
    "xllcentre",
    "yllcorner",
    "yllcenter",
    "yllcentre",
    "cellsize",
    "dx",
    "dy",
    "nodata_value",
    "nodata",
];

/// Mark of a missing point, if the header gives none.
const NO_DATA: f64 = -9999.0;

/// Whether the first lines of a text are those of such a grid: the numbers of columns and rows, in any order.
pub(super) fn is_grid(text: &str) -> bool {
    let names: Vec<String> = lines(text).map_while(|(_, line)| pair(line)).map(|(name, _)| name).collect();
    let has = |name: &str| names.iter().any(|other| other == name);
    has("ncols") && has("nrows")
}

/// The name in small letters and the value of a line of the header.
fn pair(line: &str) -> Option<(String, &str)> {
    let line = line.trim();
    let end = line.find(|c: char| c.is_whitespace() || ",;:=".contains(c))?;
    let name = line[..end].trim_matches('"').to_ascii_lowercase();
    let value = line[end..].trim_matches(|c: char| c.is_whitespace() || ",;:=".contains(c));
    NAMES.contains(&name.as_str()).then_some((name, unquoted(value)))
}

/// The lines before the heights.
#[derive(Debug, Default)]
struct Header {
    size: [Option<usize>; 2],
    spacing: [Option<f64>; 2],
    missing: Option<f64>,
    /// Number of the first line with heights, from 1.
    first: usize,
}

impl Header {
    fn of(text: &str) -> Result<Self, FormatError> {
        let mut header = Self::default();
        for (n, line) in lines(text) {
            let Some((name, value)) = pair(line) else {
                header.first = n;
                break;
            };
            match name.as_str() {
                "ncols" => header.size[0] = Some(count("ncols", value)?),
                "nrows" => header.size[1] = Some(count("nrows", value)?),
                "dx" => header.spacing[0] = Some(length("dx", value)?),
                "dy" => header.spacing[1] = Some(length("dy", value)?),
                "cellsize" => header.spacing = [Some(length("cellsize", value)?); 2],
                "nodata_value" | "nodata" => header.missing = number(value, true),
                _ => {}
            }
        }
        Ok(header)
    }

    fn grid(&self) -> Result<Grid, FormatError> {
        let missing = |field| FormatError::Missing { format: Format::EsriGrid, field };
        Ok(Grid::new(self.size[0].ok_or(missing("ncols"))?, self.size[1].ok_or(missing("nrows"))?)?)
    }
}

fn count(field: &'static str, value: &str) -> Result<usize, FormatError> {
    value.parse().map_err(|_| refused(Format::EsriGrid, field, value, "a number of points"))
}

fn length(field: &'static str, value: &str) -> Result<f64, FormatError> {
    let value = number(value, true).ok_or_else(|| refused(Format::EsriGrid, field, value, "a number"))?;
    positive(Format::EsriGrid, field, value)
}

/// The only channel of a grid. `missing` has the marks of missing points that the user gives.
pub(super) fn channels<'a>(bytes: &'a [u8], missing: &[f64]) -> Channels<'a> {
    let text = decoded(bytes);
    let header = Header::of(&text)?;
    let marks = Marks::new(missing, &[header.missing.unwrap_or(NO_DATA)]);
    Ok(only(move || map(&text, &header, &marks)))
}

fn map(text: &str, header: &Header, marks: &Marks) -> Result<HeightMap, FormatError> {
    let grid = header.grid()?;
    let mut values = if header.first == 0 { Vec::new() } else { heights(text, header.first)? };
    if values.len() != grid.len() {
        let found = format!("{grid}, for {} heights", values.len());
        let expected = "the number of heights that are there; the file is truncated";
        return Err(refused(Format::EsriGrid, "ncols x nrows", &found, expected));
    }
    let counts = data_lines(text, header.first).map(|(_, row)| words(row).0.filter(|word| !word.is_empty()).count());
    let lines: Vec<usize> = counts.collect();
    let (nx, ny) = (grid.nx(), grid.ny());
    if nx != ny && lines.len() == nx && lines.iter().all(|n| *n == ny) {
        let found = format!("{nx} x {ny}, for {nx} lines of {ny} heights");
        return Err(refused(Format::EsriGrid, "ncols x nrows", &found, "heights per line x lines; exchange them"));
    }
    marks.erase(&mut values);
    flip(&mut values, grid, [false, true]);
    let sides = match header.spacing {
        [Some(x), Some(y)] => Some([x * grid.nx() as f64, y * grid.ny() as f64]),
        _ => None,
    };
    let map = HeightMap::new(field(grid, values), Unit::Unnamed, sides, Unit::Unnamed);
    Ok(map.with_note(ReadNote::RowsReversed))
}

/// The numbers from line `first` on.
fn heights(text: &str, first: usize) -> Result<Vec<f64>, FormatError> {
    let mut values = Vec::new();
    for (line, row) in data_lines(text, first) {
        let (words, comma) = words(row);
        let mut words: Vec<&str> = words.collect();
        // A separator may end each line.
        words.pop_if(|word| word.is_empty());
        for (i, word) in words.into_iter().enumerate() {
            let no_number = || FormatError::NoNumber { line, value: i + 1, text: shown(word) };
            values.push(cell(word, comma).ok_or_else(no_number)?);
        }
    }
    Ok(values)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<HeightMap, FormatError> {
        crate::parse(text.as_bytes(), Format::EsriGrid)
    }

    #[test]
    fn a_grid_is_read_from_its_header_in_any_case_and_order() {
        let heights = "5 6 -9999\n1 2 3\n";
        let headers = [
            "ncols 3\nnrows 2\nxllcorner 239145.0\nyllcorner 3274515.0\ncellsize 2\nNODATA_value -9999\n",
            "NROWS 2\nNCOLS 3\nXLLCENTER 0\nYLLCENTER 0\nCELLSIZE 2.0\n",
            "nCols\t3\r\nnRows\t2\r\nnodata_value\t-9999\r\ndx\t2\r\ndy\t2\r\n",
            "ncols,3\nnrows,2\ncellsize,2\n",
            "\"ncols\";3\nnrows;2\ncellsize;2,0\n",
            "ncols: 3\nnrows = 2\ncellsize: 2\n",
        ];
        let bodies = [
            heights,
            "5 6\n-9999 1\n2\n3",
            "5 6 -9999 1 2 3",
            "5,0 6,0 -9999\n1,0 2,0 3,0\n",
            "5,6,-9999\n1,2,3,\n",
            "5,6,\n,1,2,3",
        ];
        for header in headers {
            assert!(is_grid(header), "{header}");
            for body in bodies {
                let map = read(&format!("{header}{body}")).unwrap_or_else(|error| panic!("{header}{body}: {error}"));
                assert_eq!(map.heights.values()[..5], [1.0, 2.0, 3.0, 5.0, 6.0], "{header}{body}");
                assert!(map.heights.at(2, 1).is_nan());
                assert_eq!(
                    (map.sides, map.side_unit, map.height_unit),
                    (Some([6.0, 4.0]), Unit::Unnamed, Unit::Unnamed)
                );
                assert_eq!(map.notes, [ReadNote::RowsReversed]);
            }
        }
    }

    #[test]
    fn cells_may_have_unequal_sides_and_damaged_grids_are_refused() {
        let map = read("ncols 2\nnrows 1\ndx 2\ndy 0.5\n1 2").expect("a map");
        assert_eq!(map.sides, Some([4.0, 0.5]));
        let cases = [
            ("ncols 3\nnrows 2\ncellsize 1\n1 2 3 4 5\n", "3 x 2, for 5 heights"),
            ("ncols 3\nnrows 2\ncellsize 1\n1 2 3 4 5 6 7\n", "3 x 2, for 7 heights"),
            ("ncols 3\nnrows 2\n", "for 0 heights"),
            ("ncols 3\nnrows 2\ncellsize 1\n1 2\n3 4\n5 6\n", "for 3 lines of 2 heights"),
            ("ncols 3\nnrows two\n1 2 3\n", "nrows is 'two'"),
            ("ncols 3\ncellsize 1\n1 2 3\n", "nrows is missing"),
            ("ncols 3\nnrows 1\ncellsize 0\n1 2 3\n", "cellsize is '0'"),
            ("ncols 3\nnrows 1\ncellsize 1\n1 x 3\n", "line 4, value 2: 'x'"),
        ];
        for (text, expected) in cases {
            let error = read(text).expect_err(text).to_string();
            assert!(error.contains(expected) && !error.contains('\n'), "{text:?}: {error}");
        }
    }
}
