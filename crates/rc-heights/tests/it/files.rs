//! Tests with files that other programs wrote, in data/formats/ (its README says which and how).

use std::path::{Path, PathBuf};

use rc_core::Field;
use rc_heights::{AreaParameters, FormatError, HeightMap, MaterialRatio, ReadNote, Unit, read};

pub(crate) fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/formats")
}

/// The map of a file, with rows in the order of the file.
pub(crate) fn map(name: &str) -> HeightMap {
    as_stored(read(&folder().join(name)).unwrap_or_else(|error| panic!("{error}")))
}

/// The map with rows in the order of its file.
pub(crate) fn as_stored(mut map: HeightMap) -> HeightMap {
    if map.notes.contains(&ReadNote::RowsReversed) {
        let nx = map.heights.grid().nx();
        map.heights.values_mut().reverse();
        map.heights.values_mut().chunks_mut(nx).for_each(<[f64]>::reverse);
    }
    map
}

/// The heights of all files, in nm.
pub(crate) fn expected() -> Field {
    map("expected.csv").heights
}

pub(crate) fn worst(found: &Field, expected: &Field, scale: f64) -> f64 {
    assert_eq!(found.grid(), expected.grid());
    let differences = found.values().iter().zip(expected.values()).map(|(a, b)| (a - scale * b).abs());
    differences.fold(0.0, f64::max)
}

#[test]
fn surface_formats_of_surfalize_have_heights_and_sides_in_metres() {
    let expected = expected();
    // The text has ten decimals of heights that are scaled to at most ten.
    for (name, tolerance) in [("surfalize.x3p", 1e-20), ("surfalize-binary.sdf", 1e-20), ("surfalize-text.sdf", 1e-16)]
    {
        let map = map(name);
        let worst = worst(&map.heights, &expected, 1e-9);
        assert!(worst < tolerance, "{name}: off by {worst:e} m");
        let [x, y] = map.sides.expect("sides");
        assert!((x / 24e-6 - 1.0).abs() < 1e-12 && (y / 24e-6 - 1.0).abs() < 1e-12, "{name}: {x} x {y}");
        assert_eq!((map.height_unit, map.side_unit), (Unit::Metre, Unit::Metre), "{name}");
    }
}

#[test]
fn a_point_that_surfalize_left_out_is_missing() {
    let map = map("surfalize-missing.sdf");
    assert_eq!(map.missing(), 1);
    assert!(map.heights.at(3, 2).is_nan());
}

#[test]
fn images_of_pillow_and_tifffile_have_their_levels() {
    let expected = expected();
    let (low, span) = (expected.min(), expected.max() - expected.min());
    let mut levels = expected.clone();
    levels.values_mut().iter_mut().for_each(|height| *height = ((*height - low) / span * 65535.0).round());
    for name in ["pillow.png", "pillow-lzw.tif", "tifffile-be.tif"] {
        // The tolerance is half of a level, because NumPy rounds halves to even.
        let worst = worst(&map(name).heights, &levels, 1.0);
        assert!(worst <= 1.0, "{name}: off by {worst} levels");
    }
    let worst = worst(&map("tifffile-float.tif").heights, &expected, 1.0);
    assert!(worst < 1e-4, "floats are off by {worst}, heights are up to 1500");
}

#[test]
fn parameters_are_those_of_surfalize() {
    let map = map("surfalize.x3p");
    let p = AreaParameters::of(&map.heights, map.sides.expect("sides"));
    // Printed by surfalize 0.19.2 for the same heights (µm, and % for Sdr).
    let others = [
        ("Sa", p.sa, 0.5907421875e-6),
        ("Sq", p.sq, 0.70065932119326e-6),
        ("Ssk", p.ssk, 0.11681164880039642),
        ("Sku", p.sku, 2.1176664829001077),
        ("Sp", p.sp, 1.478125e-6),
        ("Sv", p.sv, 1.421875e-6),
        ("Sz", p.sz, 2.9e-6),
        ("Sdq", p.sdq, 0.2841113738083583),
    ];
    for (name, value, reference) in others {
        assert!((value / reference - 1.0).abs() < 1e-12, "{name}: {value}, surfalize {reference}");
    }
    let curve = MaterialRatio::of(&map.heights).expect("points");
    let core = curve.core();
    let others = [
        ("Sk", core.sk, 2.018328718936544e-6, 1e-12),
        ("Smr1", core.smr1, 0.09542330289555393, 1e-12),
        ("Smr2", core.smr2, 0.9483467012585294, 1e-12),
        // surfalize ends its integrals at the nearest of 10 000 heights.
        ("Spk", core.spk, 0.390_780_12e-6, 5e-3),
        ("Svk", core.svk, 0.293_228_91e-6, 5e-3),
        ("Vm", curve.material_volume(0.1), 0.022_228_182e-6, 5e-3),
        ("Vvv", curve.void_volume(0.8), 0.052_850_589e-6, 5e-3),
    ];
    for (name, value, reference, tolerance) in others {
        assert!((value / reference - 1.0).abs() < tolerance, "{name}: {value}, surfalize {reference}");
    }
    // surfalize divides the surface into other triangles. At 8 points per wave the difference is a few percent.
    assert!((p.sdr / 0.03878553951034358 - 1.0).abs() < 0.05, "Sdr {}, surfalize 0.0388", p.sdr);
}

#[test]
fn a_file_is_known_by_its_first_bytes_whatever_it_is_called() {
    let dir = tempfile::tempdir().expect("a temporary folder");
    let other = dir.path().join("map.dat");
    std::fs::copy(folder().join("surfalize.x3p"), &other).expect("a copy");
    assert_eq!(as_stored(read(&other).expect("a map")).heights, map("surfalize.x3p").heights);
    for (name, expected) in
        [("map.grd", "DSAA"), ("map.sdf", "aISO-1.0"), ("map.abc", ".npy"), ("map.npy", "not a valid npy")]
    {
        let path = dir.path().join(name);
        std::fs::write(&path, "1,2\n").expect("a file");
        let error = read(&path).expect_err(name).to_string();
        assert!(error.contains(expected) && error.contains(name), "{error}");
    }
    // Lines of three numbers are points, in a .csv file as in a .txt file.
    for (name, columns) in [("points.csv", 3), ("points.txt", 3), ("rows.csv", 4)] {
        let path = dir.path().join(name);
        let line = |i: u32| format!("{},{},{}{}\n", i % 2, i / 2, i * 7, if columns == 4 { ",1" } else { "" });
        std::fs::write(&path, (0..4).map(line).collect::<String>()).expect("a file");
        let map = read(&path).expect(name);
        assert_eq!(
            (map.heights.grid().nx(), map.sides.is_some()),
            (if columns == 4 { 4 } else { 2 }, columns == 3),
            "{name}"
        );
    }
    let missing = read(&dir.path().join("none.npy")).expect_err("no file");
    assert!(matches!(missing.problem, FormatError::Unreadable(_)), "{missing}");
}
