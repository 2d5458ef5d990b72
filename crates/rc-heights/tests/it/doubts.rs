//! Files of other programs give no doubts about their values.

use rc_heights::suspicion::Suspicions;

use crate::files::{folder, map};

#[test]
fn the_files_of_other_programs_are_not_doubted() {
    for entry in std::fs::read_dir(folder()).expect("a folder") {
        let name = entry.expect("a file").file_name().into_string().expect("a name");
        let is_other = ["README.md", "h5py-huge.h5", "h5py-cycle.h5", "tifffile-park.tif"].contains(&name.as_str());
        // Waves are read elsewhere.
        if !is_other && !name.starts_with("h5py-waves") {
            assert_eq!(Suspicions::of(&map(&name).heights), Suspicions::default(), "{name}");
        }
    }
}
