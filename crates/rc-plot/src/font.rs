//! The embedded font, with which pictures look the same on every machine.

use std::sync::Once;

use plotters::style::{FontStyle, register_font as register};

/// The family under which the embedded font is registered.
///
/// SVG files contain its name, and viewers use their own font of this family.
pub const FONT: &str = "sans-serif";

/// A subset of `DejaVu` Sans with the letters and signs of pictures.
static BYTES: &[u8] = include_bytes!("../assets/DejaVuSans-subset.ttf");

/// Registers the embedded font under [`FONT`].
///
/// This is needed once before text is drawn. The `save` functions do it.
///
/// # Panics
/// Never, because a test draws with the font.
pub fn register_font() {
    static REGISTERED: Once = Once::new();
    REGISTERED.call_once(|| {
        let registered = register(FONT, FontStyle::Normal, BYTES);
        assert!(registered.is_ok(), "the embedded font is a valid font");
    });
}
