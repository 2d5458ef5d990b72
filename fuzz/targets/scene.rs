//! Scene files. A scene that parses is resolved as well; other input must give one line.

use rc_cli::scene::{file, resolve};
use rc_core::PeriodicCell;

pub(crate) fn run(data: &[u8]) -> bool {
    let Ok(text) = std::str::from_utf8(data) else { return false };
    match file::parse(text) {
        Ok(mut scene) => {
            // Files of the machine must not take part.
            scene.surface.heights = None;
            let _ = resolve::surface(scene.surface);
            let _ = resolve::contact(scene.contact, PeriodicCell::new(1.0).expect("a cell"));
            true
        }
        Err(message) => {
            assert!(!message.is_empty());
            false
        }
    }
}
