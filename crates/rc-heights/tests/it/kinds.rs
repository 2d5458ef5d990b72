//! Tests of files that are not read: a message names them.

use rc_heights::{Format, read};

/// Names, first bytes, and what the message says.
const FILES: &[(&str, &[u8], &str)] = &[
    ("a.jpk", b"II*\0more", "a JPK image"),
    ("a.jpk", b"other", "a JPK image"),
    ("a.jpk-force", b"other", "force curves"),
    ("scan.tom", b"\0\0", "a WSxM file"),
    ("scan.oir", b"OLYMPUSRAWFORMAT", "an Olympus file (.oir)"),
    ("scan.poir", b"other", "an Olympus file; such files are not read: export .x3p, .sur or text"),
    ("scan.nms", b"other", "a file of an instrument; such files are not read"),
    ("scan.mi", b"fileType      Image", "a PicoScan file"),
    ("part.stl", b"\0\0\0\0", "an STL mesh"),
    ("part.txt", b"solid part\n facet normal 0 0 1\n", "an STL mesh"),
    ("part.stp", b"ISO-10303-21;\nHEADER;\n", "a body of CAD"),
    ("part.obj", b"v 0 0 0\n", "a mesh"),
    ("part.dat", b"ply\nformat ascii 1.0\n", "a PLY mesh"),
    ("a.off", b"OFF\n3 1 0\n", "an OFF mesh"),
    ("a.pcd", b"# .PCD v.7\n", "a point cloud"),
    ("a.zon", b"KPK0", "a Keyence file (.zon)"),
    ("a.mnt", b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", "a document of Mountains"),
    ("a.xls", b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", "an old Excel workbook"),
    ("a.dat", b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", "a document of Office"),
    ("a.pro", b"other", "not a surface"),
    ("a.lext", b"II*\0", "Olympus LEXT"),
    ("a.csv", b"\xff\xd8\xff\xe0", "a JPEG picture"),
    ("a.bmp", b"BM\0\0", "a BMP picture"),
    ("a.gif", b"GIF89a", "a GIF picture"),
    ("a", b"%PDF-1.7", "a PDF"),
    ("a.pkl", b"\x80\x04\x95", "a Python pickle"),
    ("a.opj", b"CPYA 4.3", "an Origin project"),
    ("a.vtk", b"# vtk DataFile Version 3.0\n", "a VTK file"),
    ("a.vti", b"<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\">", "a VTK file"),
    ("a.gwy", b"GWYO", "a file of Gwyddion 1"),
    ("a.hdf", b"\x0e\x03\x13\x01", "an HDF4 file"),
    ("a.csv.zst", b"\x28\xb5\x2f\xfd", "packed by zstd"),
    ("a.csv.xz", b"\xfd7zXZ\0", "packed by xz"),
    ("a.csv.bz2", b"BZh91AY", "packed by bzip2"),
    ("a.7z", b"7z\xbc\xaf\x27\x1c", "an archive (7z)"),
    ("a.rar", b"Rar!\x1a\x07\x01\0", "an archive (rar)"),
    ("a.mat", b"\0\0\0\0", "version 4"),
];

#[test]
fn a_file_of_another_kind_is_named_with_what_to_do() {
    for (name, start, expected) in FILES {
        let error = Format::of(name.as_ref(), start).expect_err(name).to_string();
        assert!(error.contains(expected) && error.contains(';') && error.lines().count() == 1, "{name}: {error}");
        assert!(error.len() < 200, "{name}: {error}");
    }
}

#[test]
fn formats_that_are_read_are_not_taken_for_another_kind() {
    for (name, kind, bytes) in crate::build::all() {
        for extension in ["csv", "stl", "bmp", "pkl", "xls", "dat"] {
            // Texts and one format have no mark: their names tell them.
            if !matches!(kind, Format::Csv | Format::Xyz | Format::Plu) {
                let found = Format::of(format!("map.{extension}").as_ref(), &bytes);
                assert_eq!(found, Ok(kind), "{name}.{extension}");
            }
        }
    }
    // Tables that begin like another kind.
    for text in ["BM,1,2,3\n1,2,3,4\n", "solid 1 2\n1 2\n", "WSxM file copyright\nWSxM ASCII Matrix file\n1 2\n"] {
        assert_eq!(Format::of("map.csv".as_ref(), text.as_bytes()), Ok(Format::Csv), "{text}");
    }
}

#[test]
fn archives_of_arrays_and_of_force_curves_are_named() {
    let dir = tempfile::tempdir().expect("a temporary folder");
    for (name, member, expected) in [
        ("maps.npz", "heights.npy", "numpy.save"),
        ("curves.jpk-force", "header.properties", "force curves"),
        ("scan.poir", "data/a.oir", "Olympus"),
        ("part.3mf", "3D/3dmodel.model", "mesh"),
    ] {
        let path = dir.path().join(name);
        let bytes = crate::parts::zipped(&[(member, b"x".as_slice())], zip::CompressionMethod::Stored);
        std::fs::write(&path, bytes).expect("an archive");
        let error = read(&path).expect_err(name).to_string();
        assert!(error.contains(expected), "{error}");
    }
}
