//! Writer of VTK's XML files.
//!
//! A head of XML gives the place of each array. The arrays follow as they are in memory ("appended raw").
//!
//! Format: *VTK File Formats*, <https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html>.

use std::borrow::Cow;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

use quick_xml::Writer;
use quick_xml::events::{BytesDecl, Event};

/// A named array.
#[derive(Clone, Debug)]
pub(super) struct Array<'a> {
    name: &'static str,
    /// Number of values for each point or cell.
    components: usize,
    values: Values<'a>,
}

/// The values of an array.
#[derive(Clone, Debug)]
pub(super) enum Values<'a> {
    Float64(Cow<'a, [f64]>),
    Int64(Vec<i64>),
    UInt8(Vec<u8>),
}

/// A data set of one piece.
#[derive(Clone, Debug)]
pub(super) struct Dataset<'a> {
    /// VTK's name of its kind.
    pub(super) kind: &'static str,
    /// Attributes of the whole data set.
    pub(super) whole: Vec<(&'static str, String)>,
    /// Attributes of its one piece.
    pub(super) piece: Vec<(&'static str, String)>,
    /// Arrays of each section.
    pub(super) sections: Vec<(&'static str, Vec<Array<'a>>)>,
}

impl<'a> Array<'a> {
    pub(super) fn new(name: &'static str, components: usize, values: Values<'a>) -> Self {
        Self { name, components, values }
    }
}

impl Values<'_> {
    fn kind(&self) -> &'static str {
        match self {
            Self::Float64(_) => "Float64",
            Self::Int64(_) => "Int64",
            Self::UInt8(_) => "UInt8",
        }
    }

    fn bytes(&self) -> u64 {
        match self {
            Self::Float64(values) => 8 * values.len() as u64,
            Self::Int64(values) => 8 * values.len() as u64,
            Self::UInt8(values) => values.len() as u64,
        }
    }

    fn write(&self, out: &mut impl Write) -> io::Result<()> {
        match self {
            Self::Float64(values) => values.iter().try_for_each(|value| out.write_all(&value.to_le_bytes())),
            Self::Int64(values) => values.iter().try_for_each(|value| out.write_all(&value.to_le_bytes())),
            Self::UInt8(values) => out.write_all(values),
        }
    }
}

/// Writes `data` to `path`, little-endian.
///
/// # Errors
/// Those of the file system.
pub(super) fn write(path: &Path, data: &Dataset<'_>) -> io::Result<()> {
    let mut xml = Writer::new_with_indent(BufWriter::new(File::create(path)?), b' ', 2);
    xml.write_event(Event::Decl(BytesDecl::new("1.0", None, None)))?;
    let file = [("type", data.kind), ("version", "1.0"), ("byte_order", "LittleEndian"), ("header_type", "UInt64")];
    xml.create_element("VTKFile").with_attributes(file).write_inner_content(|xml| {
        write_head(xml, data)?;
        xml.create_element("AppendedData").with_attribute(("encoding", "raw")).write_inner_content(|xml| {
            let out = xml.get_mut();
            // This mark precedes the first byte, from which offsets are counted.
            out.write_all(b"_")?;
            data.arrays().try_for_each(|array| {
                out.write_all(&array.values.bytes().to_le_bytes())?;
                array.values.write(out)
            })
        })?;
        Ok(())
    })?;
    let file = xml.into_inner().into_inner().map_err(io::IntoInnerError::into_error)?;
    file.sync_all()
}

/// Writes the kinds and the places of all arrays.
fn write_head(xml: &mut Writer<impl Write>, data: &Dataset<'_>) -> io::Result<()> {
    let mut offset = 0;
    let whole = data.whole.iter().map(|(name, value)| (*name, value.as_str()));
    xml.create_element(data.kind).with_attributes(whole).write_inner_content(|xml| {
        let piece = data.piece.iter().map(|(name, value)| (*name, value.as_str()));
        xml.create_element("Piece").with_attributes(piece).write_inner_content(|xml| {
            data.sections.iter().try_for_each(|(section, arrays)| {
                xml.create_element(*section).write_inner_content(|xml| {
                    arrays.iter().try_for_each(|array| write_array_head(xml, array, &mut offset))
                })?;
                Ok(())
            })
        })?;
        Ok(())
    })?;
    Ok(())
}

/// Writes the line of one array, and moves `offset` to the next array.
fn write_array_head(xml: &mut Writer<impl Write>, array: &Array<'_>, offset: &mut u64) -> io::Result<()> {
    let [components, at] = [array.components.to_string(), offset.to_string()];
    let attributes = [
        ("type", array.values.kind()),
        ("Name", array.name),
        ("NumberOfComponents", &components),
        ("format", "appended"),
        ("offset", &at),
    ];
    xml.create_element("DataArray").with_attributes(attributes).write_empty()?;
    // Each array begins with its length.
    *offset += 8 + array.values.bytes();
    Ok(())
}

impl Dataset<'_> {
    fn arrays(&self) -> impl Iterator<Item = &Array<'_>> {
        self.sections.iter().flat_map(|(_, arrays)| arrays)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_array_is_where_the_head_says() {
        let data = Dataset {
            kind: "ImageData",
            whole: vec![("WholeExtent", "0 2 0 1 0 0".to_owned())],
            piece: vec![("Extent", "0 2 0 1 0 0".to_owned())],
            sections: vec![(
                "CellData",
                vec![
                    Array::new("a", 1, Values::UInt8(vec![7, 9])),
                    Array::new("b", 1, Values::Float64(vec![1.5, -2.0].into())),
                    Array::new("c", 1, Values::Int64(vec![-3])),
                ],
            )],
        };
        let dir = tempfile::tempdir().expect("a temporary folder");
        let path = dir.path().join("a.vti");
        write(&path, &data).expect("a file");
        let bytes = std::fs::read(&path).expect("the file");
        let mark = b"<AppendedData encoding=\"raw\">_";
        let start = bytes.windows(mark.len()).position(|window| window == mark).expect("the mark") + mark.len();
        let head = String::from_utf8_lossy(&bytes[..start]);
        for (name, offset, length, first) in [
            ("a", 0, 2, vec![7, 9]),
            ("b", 10, 16, 1.5_f64.to_le_bytes().to_vec()),
            ("c", 34, 8, (-3_i64).to_le_bytes().to_vec()),
        ] {
            let line = head.lines().find(|line| line.contains(&format!("Name=\"{name}\""))).expect("a line");
            assert!(line.contains(&format!("offset=\"{offset}\"")), "{line}");
            let at = start + offset;
            assert_eq!(bytes[at..at + 8], u64::to_le_bytes(length), "{name}");
            assert_eq!(bytes[at + 8..at + 8 + first.len()], first, "{name}");
        }
        assert!(bytes.ends_with(b"</VTKFile>"), "the file ends early");
    }
}
