//! Pictures of maps: `contact.png` (where the surfaces touch, and how hard), and one map alone.

use plotters::prelude::DrawingBackend;
use rc_core::Field;

use super::{Area, Map, Palette, Picture, PictureError, Shade, draw_map, map_extent};

/// Contact map and pressure side by side.
#[derive(Clone, Copy, Debug)]
pub struct ContactPicture<'a> {
    /// The pressure.
    pub pressure: &'a Field,
    /// A pressure of 1 of the field, in Pa.
    pub pressure_unit: f64,
    /// Side λ of the cell (m).
    pub side: f64,
}

/// Side of a map, its text, and the space around it, in pixels.
const SIDE: u32 = 900;
const TEXT: f64 = 30.0;
const MARGIN: u32 = 36;

impl Picture for ContactPicture<'_> {
    fn size(&self) -> (u32, u32) {
        let (contact, height) = map_extent(SIDE, TEXT, false);
        let (pressure, _) = map_extent(SIDE, TEXT, true);
        (contact + pressure + 3 * MARGIN, height + MARGIN)
    }

    fn draw<B: DrawingBackend>(&self, area: &Area<B>) -> Result<(), PictureError> {
        let (contact, height) = map_extent(SIDE, TEXT, false);
        let (pressure, _) = map_extent(SIDE, TEXT, true);
        let panel = |left: u32, width: u32| area.clone().shrink((left as i32, (MARGIN / 2) as i32), (width, height));
        let fraction =
            self.pressure.values().iter().filter(|p| **p > 0.0).count() as f64 / self.pressure.values().len() as f64;
        let title = format!("Contact: {} % of the elements", crate::quantity::digits(100.0 * fraction, 3));
        let contact_map = Map { title: &title, field: self.pressure, shade: Shade::Contact, side: self.side };
        draw_map(&panel(MARGIN, contact), &contact_map, TEXT)?;
        let shade = Shade::Values {
            range: (0.0, self.pressure.max()),
            palette: Palette::Heat,
            factor: self.pressure_unit,
            unit: "Pa",
        };
        let pressure_map = Map { title: "Pressure", field: self.pressure, shade, side: self.side };
        draw_map(&panel(contact + 2 * MARGIN, pressure), &pressure_map, TEXT)
    }
}

/// One map as a picture of its own.
#[derive(Clone, Copy, Debug)]
pub struct MapPicture<'a>(pub Map<'a>);

impl Picture for MapPicture<'_> {
    fn size(&self) -> (u32, u32) {
        let (width, height) = map_extent(SIDE, TEXT, matches!(self.0.shade, Shade::Values { .. }));
        (width + 2 * MARGIN, height + MARGIN)
    }

    fn draw<B: DrawingBackend>(&self, area: &Area<B>) -> Result<(), PictureError> {
        let (width, height) = self.size();
        let inner = ((width - 2 * MARGIN), (height - MARGIN));
        draw_map(&area.clone().shrink((MARGIN as i32, (MARGIN / 2) as i32), inner), &self.0, TEXT)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::{save_png, save_svg};
    use rc_core::Grid;

    #[test]
    fn a_picture_has_its_size_and_maps_in_svg_are_bitmaps() {
        let dir = tempfile::tempdir().expect("a temporary folder");
        let pressure = Field::from_fn(Grid::new(60, 50).expect("a grid"), |x, y| (x - y).max(0.0));
        let picture = ContactPicture { pressure: &pressure, pressure_unit: 3e6, side: 1e-2 };
        let (png, svg) = (dir.path().join("a.png"), dir.path().join("a.svg"));
        save_png(&picture, &png).expect("a PNG file");
        save_svg(&picture, &svg).expect("an SVG file");
        let bytes = std::fs::read(png).expect("the PNG file");
        // Width and height are the first fields of the header chunk.
        let field = |at: usize| u32::from_be_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]);
        assert_eq!((field(16), field(20)), picture.size());
        let text = std::fs::read_to_string(svg).expect("the SVG file");
        assert_eq!(text.matches("<image").count(), 3, "two maps and a colour bar");
        assert!(text.contains("MPa") && text.len() < 1_000_000, "{} bytes", text.len());
    }

    #[test]
    fn fields_without_contact_or_contrast_are_drawn() {
        let dir = tempfile::tempdir().expect("a temporary folder");
        for value in [0.0, 3.0] {
            let pressure = Field::from_fn(Grid::new(1, 1).expect("a grid"), |_, _| value);
            let picture = ContactPicture { pressure: &pressure, pressure_unit: 1.0, side: 1.0 };
            save_png(&picture, &dir.path().join("a.png")).expect("a PNG file");
        }
    }
}
