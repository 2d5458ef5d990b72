//! A short run of the fuzz targets in `fuzz/targets`, without a fuzzer: fixed random changes of good files.

#[path = "../../fuzz/targets/heights.rs"]
mod heights;
#[path = "../../fuzz/targets/resume.rs"]
mod resume;
#[path = "../../fuzz/targets/scene.rs"]
mod scene;

use rc_cli::scene::keys::EXAMPLE;
use rc_heights::{Format, format_of};

use crate::data_path;

/// Numbers and signs at which readers break: limits of sizes, ends of lines, nesting, exponents.
const PIECES: [&[u8]; 12] = [
    b"\0\0\0\0",
    b"\xff\xff\xff\xff",
    b"\x7f\xff\xff\xff",
    b"\x80\0\0\0",
    b"-1",
    b"1e999",
    b"nan",
    b"99999999999",
    b"\n",
    b"[[",
    b"\"",
    b"=",
];

/// The SplitMix64 sequence, the same on every machine.
struct Random(u64);

impl Random {
    /// A number below `end`.
    fn below(&mut self, end: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((mixed ^ (mixed >> 31)) % end.max(1) as u64) as usize
    }

    /// One of the files with a few changes.
    fn changed(&mut self, files: &[Vec<u8>]) -> Vec<u8> {
        let mut bytes = files[self.below(files.len())].clone();
        for _ in 0..=self.below(4) {
            self.change(&mut bytes, files);
        }
        bytes
    }

    fn change(&mut self, bytes: &mut Vec<u8>, files: &[Vec<u8>]) {
        // Headers are where sizes and kinds are.
        let reach = if self.below(2) == 0 { bytes.len() } else { bytes.len().min(512) };
        let start = self.below(reach);
        let end = (start + self.below(16)).min(bytes.len());
        match self.below(6) {
            0 => bytes.truncate(start),
            1 => drop(bytes.drain(start..end)),
            2 => bytes.extend_from_within(start..end),
            3 => drop(bytes.splice(start..end, PIECES[self.below(PIECES.len())].iter().copied())),
            4 => {
                let other = &files[self.below(files.len())];
                let from = self.below(other.len());
                let part = other[from..].iter().copied().take(64);
                drop(bytes.splice(start..end, part));
            }
            _ => {
                if let Some(byte) = bytes.get_mut(start) {
                    *byte ^= 1 << self.below(8);
                }
            }
        }
    }
}

/// Gives `target` this number of changed files. A panic names the one that caused it.
///
/// Some must be accepted: otherwise the changes reach nothing behind the first check of a reader.
fn fuzz(target: fn(&[u8]) -> bool, files: &[Vec<u8>], inputs: u64) {
    let mut accepted = 0;
    for seed in 0..inputs {
        let bytes = Random(seed).changed(files);
        let Ok(is_accepted) = std::panic::catch_unwind(|| target(&bytes)) else {
            panic!("input {seed} of {inputs}: {}", String::from_utf8_lossy(&bytes[..bytes.len().min(200)]));
        };
        accepted += u64::from(is_accepted);
    }
    assert!(accepted > inputs / 100, "only {accepted} of {inputs} are accepted");
}

#[test]
fn changed_height_maps_never_panic() {
    let folder = std::fs::read_dir(data_path("formats")).expect("files of every format");
    let mut paths: Vec<_> = folder.map(|entry| entry.expect("a file").path()).collect();
    paths.sort();
    let file = |path: &std::path::PathBuf| {
        let format = format_of(path).ok()?;
        let index = Format::ALL.iter().position(|other| *other == format)?;
        Some([vec![index as u8], std::fs::read(path).expect("a file")].concat())
    };
    let files: Vec<Vec<u8>> = paths.iter().filter_map(file).collect();
    assert!(files.len() > 40, "only {} files", files.len());
    fuzz(heights::run, &files, 10_000);
}

#[test]
fn changed_scenes_never_panic() {
    fuzz(scene::run, &[EXAMPLE.as_bytes().to_vec()], 10_000);
}

#[test]
fn changed_journals_never_panic() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let out = folder.path().join("sweep");
    let words = ["rc", "sweep", "--waves=4", "--grid=32", "--pressures=1e5,1e6", "--seeds=1..2", "--quiet", "--out"];
    let words = words.into_iter().map(Into::into).chain([out.as_os_str().to_owned()]);
    rc_cli::run_words(words).expect("a sweep");
    let journal = std::fs::read(out.join("sweep.jsonl")).expect("a journal");
    fuzz(resume::run, &[journal], 20_000);
}
