//! The embedded font: pictures look the same on every machine, without system fonts.

use std::sync::Once;

use plotters::style::{FontStyle, register_font as register};

/// The family under which the embedded font is registered; SVG files name it, and viewers substitute their own.
pub const FONT: &str = "sans-serif";

/// A subset of `DejaVu` Sans: the letters and signs that pictures use.
static BYTES: &[u8] = include_bytes!("../assets/DejaVuSans-subset.ttf");

/// Registers the embedded font under [`FONT`]; needed once before text is drawn, and done by the `save` functions.
///
/// # Panics
/// Never: a test draws with the font.
pub fn register_font() {
    static REGISTERED: Once = Once::new();
    REGISTERED.call_once(|| {
        let registered = register(FONT, FontStyle::Normal, BYTES);
        assert!(registered.is_ok(), "the embedded font is a valid font");
    });
}
