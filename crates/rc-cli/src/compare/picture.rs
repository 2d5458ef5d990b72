//! The picture of a difference: pressure and gap beside each other.

use plotters::prelude::DrawingBackend;
use rc_plot::{Area, Map, Palette, Picture, PictureError, Shade, bitmap_size, draw_map, map_extent};

use super::fields::{Difference, Differences};

/// Longer side of a map, size of its text, and space around it, in pixels.
const SIDE: u32 = 900;
const TEXT: f64 = 30.0;
const MARGIN: u32 = 36;

impl Differences {
    /// Size of a map with its text.
    fn panel(&self) -> (u32, u32) {
        map_extent(bitmap_size(self.pressure.field.grid(), (SIDE, SIDE)), TEXT, true)
    }
}

impl Picture for Differences {
    fn size(&self) -> (u32, u32) {
        let (width, height) = self.panel();
        (2 * width + 3 * MARGIN, height + MARGIN)
    }

    fn draw<B: DrawingBackend>(&self, area: &Area<B>) -> Result<(), PictureError> {
        let (width, height) = self.panel();
        let panels = [("Pressure, B minus A", &self.pressure, "Pa"), ("Gap, B minus A", &self.gap, "m")];
        for (i, (title, difference, unit)) in panels.into_iter().enumerate() {
            let left = (i as u32 * (width + MARGIN) + MARGIN) as i32;
            let map = Map { title, field: &difference.field, shade: shade(difference, unit), side: self.side };
            draw_map(&area.clone().shrink((left, (MARGIN / 2) as i32), (width, height)), &map, TEXT)?;
        }
        Ok(())
    }
}

/// Colours that are white without a difference.
fn shade(difference: &Difference, unit: &'static str) -> Shade {
    let greatest = difference.numbers().max;
    // Equal fields are white on the scale of the fields themselves.
    let scales = [greatest, difference.scale, 1.0];
    let end = scales.into_iter().find(|end| *end > 0.0).unwrap_or(1.0);
    Shade::Values { range: (-end, end), palette: Palette::Difference, factor: 1.0, unit }
}
