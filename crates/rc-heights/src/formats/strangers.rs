//! Texts and files of programs that are recognised by their first words, but are not height maps that rc reads.

/// First words of a file, and what it is.
const FIRST_WORDS: [(&str, &str); 6] = [
    ("# vtk DataFile", "a file of VTK; export points x y z, or a row of heights in each line"),
    ("#VRML", "a mesh of triangles (VRML); export points x y z of the measured grid"),
    ("ply\n", "a mesh of triangles (PLY); export points x y z of the measured grid"),
    ("ply\r\n", "a mesh of triangles (PLY); export points x y z of the measured grid"),
    ("<?xml", "an XML text; export points x y z, or a row of heights in each line"),
    ("{\\rtf", "a text with formatting (RTF); save it as plain text"),
];

/// What the file is whose first bytes are `start`, if it is known by them.
pub(super) fn named(start: &str) -> Option<&'static str> {
    let words = start.trim_start();
    // Maps of WSxM that are texts say so in their second line.
    if words.starts_with("WSxM file") && !words.contains("ASCII") {
        return Some("a binary file of WSxM; export it from WSxM as ASCII, as a matrix or as XYZ");
    }
    if words.starts_with("solid") && words.contains("facet") {
        return Some("a mesh of triangles (STL); export points x y z, or a row of heights in each line");
    }
    FIRST_WORDS.iter().find(|(first, _)| words.starts_with(first)).map(|(_, what)| *what)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_of_other_programs_are_named() {
        for (start, name) in [
            ("solid surface\n facet normal 0 0 1\n  outer loop\n", "STL"),
            ("WSxM file copyright Nanotec Electronica\nSxM Image file\nImage header size: 2048\n", "WSxM"),
            ("ply\nformat ascii 1.0\n", "PLY"),
            ("#VRML V2.0 utf8\n", "VRML"),
        ] {
            assert!(named(start).is_some_and(|what| what.contains(name) && what.contains("export")), "{start}");
        }
        for start in ["WSxM file copyright UAM\nWSxM ASCII XYZ file\n", "1 2 3\n", "", "solid state\n1 2 3\n"] {
            assert_eq!(named(start), None, "{start}");
        }
    }
}
