//! Tests that a reader answers any bytes with a map or an error.
//!
//! An error is one line. A reader never panics.

use proptest::prelude::*;
use rc_heights::{Format, FormatError, HeightMap, parse};

use crate::build;

/// The files of [`build::all`], made once.
fn files() -> &'static [(&'static str, Format, Vec<u8>)] {
    static FILES: std::sync::OnceLock<Vec<(&str, Format, Vec<u8>)>> = std::sync::OnceLock::new();
    FILES.get_or_init(build::all)
}

/// Asserts that an answer is valid.
///
/// An error is one line. A map is not larger than the bytes allow.
fn assert_answer(name: &str, bytes: &[u8], answer: &Result<HeightMap, FormatError>) {
    match answer {
        Ok(map) => {
            let points = map.heights.values().len();
            assert!(points <= 3000 * bytes.len(), "{name}: {points} points from {} bytes", bytes.len());
            assert!(map.heights.values().iter().all(|height| !height.is_infinite()), "{name}: infinite heights");
            let positive = |sides: [f64; 2]| sides.iter().all(|side| *side > 0.0);
            assert!(map.sides.is_none_or(positive), "{name}: sides {:?}", map.sides);
        }
        Err(error) => {
            let message = error.to_string();
            assert!(!message.is_empty() && !message.contains('\n') && message.len() < 600, "{name}: {message}");
        }
    }
}

#[test]
fn every_truncation_of_every_file_is_refused_or_still_whole() {
    for (name, format, bytes) in build::all() {
        let whole = parse(&bytes, format).unwrap_or_else(|error| panic!("{name}: {error}"));
        // Every byte of a small file, and every 1/64 of the length of a large file.
        for length in (0..bytes.len()).step_by(if bytes.len() < 1000 { 1 } else { bytes.len().div_ceil(64) }) {
            let answer = parse(&bytes[..length], format);
            assert_answer(name, &bytes, &answer);
            // Texts may end anywhere. The bytes after the heights (remarks, end marks, directories) may be missing.
            let text = matches!(format, Format::Csv | Format::Xyz | Format::EsriGrid | Format::Zygo);
            if let (Ok(map), false) = (answer, text) {
                let same = map.heights.grid() == whole.heights.grid() && map.missing() == whole.missing();
                assert!(same, "{name}: {length} of {} bytes were read as another map", bytes.len());
            }
        }
    }
}

#[test]
fn a_flipped_bit_of_a_checked_container_is_noticed() {
    for (name, format, bytes) in build::all() {
        if !matches!(format, Format::X3p | Format::Plux | Format::Png) {
            continue;
        }
        let whole = parse(&bytes, format).expect(name).heights;
        let changed = (0..bytes.len()).filter(|at| {
            let mut flipped = bytes.clone();
            flipped[*at] ^= 1;
            // Missing points are NaN, so the bits of maps are compared.
            let bits = |field: &rc_core::Field| field.values().iter().map(|v| v.to_bits()).collect::<Vec<_>>();
            parse(&flipped, format).is_ok_and(|map| bits(&map.heights) != bits(&whole))
        });
        assert_eq!(changed.count(), 0, "{name}: heights changed unnoticed");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn arbitrary_bytes_never_panic(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        for format in Format::ALL {
            assert_answer("arbitrary", &bytes, &parse(&bytes, format));
        }
    }

    #[test]
    fn arbitrary_bytes_after_a_mark_never_panic(which in any::<prop::sample::Index>(), bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        let (name, format, valid) = which.get(files());
        let start = valid.len().min(30);
        let bytes = [&valid[..start], &bytes].concat();
        assert_answer(name, &bytes, &parse(&bytes, *format));
    }

    #[test]
    fn mutated_files_never_panic(
        which in any::<prop::sample::Index>(),
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8),
        cut in any::<prop::sample::Index>(),
    ) {
        let (name, format, mut bytes) = which.get(files()).clone();
        for (at, byte) in &changes {
            let at = at.index(bytes.len());
            bytes[at] = *byte;
        }
        assert_answer(name, &bytes, &parse(&bytes, format));
        bytes.truncate(cut.index(bytes.len()));
        assert_answer(name, &bytes, &parse(&bytes, format));
    }

    #[test]
    fn texts_of_numbers_never_panic(text in "[-0-9eE.,; \\n#naif\\t\"D*]{0,200}") {
        for format in [Format::Csv, Format::Xyz] {
            assert_answer("text", text.as_bytes(), &parse(text.as_bytes(), format));
        }
        let zygo = String::from_utf8(build::zygo("XYZ", "")).expect("a text");
        let ascii = String::from_utf8(build::zygo("ASCII", "#\n")).expect("a text");
        for (head, format) in [
            ("ncols 3\nnrows 2\ncellsize 2\n", Format::EsriGrid),
            ("# Width: 3 um\n# dx=2 nm, dy=3\nno data: 1\n", Format::Csv),
            ("nx: 3\nny: 2\npixel size: 1 um\n", Format::Csv),
            ("y/x [um],0,1,2\n", Format::Csv),
            (",0,1,2\n", Format::Csv),
            (",x,y,z\n", Format::Xyz),
            ("# x [um]  y [um]  z [nm]\n", Format::Xyz),
            (zygo.as_str(), Format::Zygo),
            (ascii.as_str(), Format::Zygo),
        ] {
            assert_answer(head, (head.to_owned() + &text).as_bytes(), &parse((head.to_owned() + &text).as_bytes(), format));
        }
        for head in ["DSAA\n3 2\n0 1\n0 1\n0 1\n", "aISO-1.0\n"] {
            let bytes = [head.as_bytes(), text.as_bytes()].concat();
            let format = if head.starts_with('D') { Format::Surfer } else { Format::Sdf };
            assert_answer(head, &bytes, &parse(&bytes, format));
        }
    }
}
