//! Pictures of maps: `contact.png` with contact and pressure, and a single map.

use plotters::prelude::DrawingBackend;
use plotters::style::text_anchor::HPos;
use rc_core::{DVec2, Field, Grid};

use crate::map::{arrow, text};
use crate::{Area, Map, Palette, Picture, PictureError, PixelMean, Shade, bitmap_size, draw_map, map_extent};

/// Contact map and pressure beside each other, at the resolution of the picture.
#[derive(Clone, Debug)]
pub struct ContactPicture {
    /// Part of each pixel that is in contact.
    contact: Field,
    /// Mean pressure of each pixel.
    pressure: Field,
    /// Part of the values that is above zero.
    fraction: f64,
    /// Whether the values belong to elements, and not to blocks of elements.
    of_elements: bool,
    /// Maximum pressure.
    greatest: f64,
    /// Pressure of the value 1, in Pa.
    pressure_unit: f64,
    /// Side λ of the cell (m).
    side: f64,
    /// Text above both maps; empty without one.
    caption: String,
    /// Unit vector of the direction in which the surface slides.
    direction: Option<DVec2>,
}

impl ContactPicture {
    /// The picture of a pressure field.
    ///
    /// `pressure_unit` is the pressure of the value 1 in Pa, and `side` is λ in m.
    #[must_use]
    pub fn of(pressure: &Field, pressure_unit: f64, side: f64) -> Self {
        let mut rows = ContactRows::new(pressure.grid());
        rows.take(pressure.values());
        rows.finish(pressure_unit, side)
    }

    /// The same picture with colours up to the pressure `greatest`, in its own unit.
    ///
    /// Several pictures with the same end can be compared.
    #[must_use]
    pub fn up_to(self, greatest: f64) -> Self {
        Self { greatest, ..self }
    }

    /// The same picture with a text above both maps.
    #[must_use]
    pub fn captioned(self, caption: String) -> Self {
        Self { caption, ..self }
    }

    /// The same picture with an arrow in the direction in which the surface slides.
    #[must_use]
    pub fn sliding(self, direction: Option<DVec2>) -> Self {
        Self { direction, ..self }
    }

    /// The same picture for means over blocks.
    ///
    /// A block with a pressure is touched, but not in contact everywhere.
    #[must_use]
    pub fn of_blocks(self) -> Self {
        Self { of_elements: false, ..self }
    }
}

/// A [`ContactPicture`] that is made from the rows of a pressure field.
///
/// The field need not be in memory completely.
#[derive(Clone, Debug)]
pub struct ContactRows {
    grid: Grid,
    contact: PixelMean,
    pressure: PixelMean,
    in_contact: usize,
    greatest: f64,
}

impl ContactRows {
    /// An empty picture of a field on `grid`.
    #[must_use]
    pub fn new(grid: Grid) -> Self {
        let mean = PixelMean::new(grid, SIDE as usize);
        Self { grid, contact: mean.clone(), pressure: mean, in_contact: 0, greatest: f64::NEG_INFINITY }
    }

    /// Adds the next rows of pressures.
    ///
    /// # Panics
    /// When there are more rows than the grid has.
    pub fn take(&mut self, rows: &[f64]) {
        for row in rows.chunks_exact(self.grid.nx()) {
            self.contact.take(|ix| if row[ix] > 0.0 { 1.0 } else { 0.0 });
            self.pressure.take(|ix| row[ix]);
            self.in_contact += row.iter().filter(|p| **p > 0.0).count();
            self.greatest = row.iter().copied().fold(self.greatest, f64::max);
        }
    }

    /// The picture after the last row. `pressure_unit` and `side` as in [`ContactPicture::of`].
    #[must_use]
    pub fn finish(self, pressure_unit: f64, side: f64) -> ContactPicture {
        ContactPicture {
            contact: self.contact.finish(),
            pressure: self.pressure.finish(),
            fraction: self.in_contact as f64 / self.grid.len() as f64,
            of_elements: true,
            // The pressure of an unfinished solve may have no finite value, or no positive value.
            greatest: if self.greatest.is_finite() { self.greatest.max(0.0) } else { 0.0 },
            pressure_unit,
            side,
            caption: String::new(),
            direction: None,
        }
    }
}

/// Longer side of a map, size of its text, and space around it, in pixels.
const SIDE: u32 = 900;
const TEXT: f64 = 30.0;
const MARGIN: u32 = 36;

impl ContactPicture {
    /// Sizes of the two maps including text.
    fn panels(&self) -> [(u32, u32); 2] {
        let bitmap = bitmap_size(self.contact.grid(), (SIDE, SIDE));
        [false, true].map(|colour_bar| map_extent(bitmap, TEXT, colour_bar))
    }

    /// Height of the line of the caption.
    fn head(&self) -> u32 {
        if self.caption.is_empty() { 0 } else { (1.6 * TEXT) as u32 }
    }
}

impl Picture for ContactPicture {
    fn size(&self) -> (u32, u32) {
        let [(contact, height), (pressure, _)] = self.panels();
        (contact + pressure + 3 * MARGIN, height + MARGIN + self.head())
    }

    fn draw<B: DrawingBackend>(&self, area: &Area<B>) -> Result<(), PictureError> {
        let [(contact, height), (pressure, _)] = self.panels();
        let top = (MARGIN / 2 + self.head()) as i32;
        let panel = |left: u32, width: u32| area.clone().shrink((left as i32, top), (width, height));
        if !self.caption.is_empty() {
            let middle = (self.size().0 / 2) as i32;
            text(area, &self.caption, (middle, (0.8 * TEXT) as i32), HPos::Center, TEXT)?;
        }
        let (name, values) = if self.of_elements { ("Contact", "elements") } else { ("Touched", "blocks") };
        let title = format!("{name}: {} % of the {values}", rc_core::quantity::digits(100.0 * self.fraction, 3));
        let contact_map = Map { title: &title, field: &self.contact, shade: Shade::PartOfContact, side: self.side };
        draw_map(&panel(MARGIN, contact), &contact_map, TEXT)?;
        if let Some(direction) = self.direction {
            let (width, _) = bitmap_size(self.contact.grid(), (SIDE, SIDE));
            arrow(&panel(MARGIN, contact), direction, (width, height), TEXT)?;
        }
        let shade = Shade::Values {
            range: (0.0, self.greatest),
            palette: Palette::Heat,
            factor: self.pressure_unit,
            unit: "Pa",
        };
        let pressure_map = Map { title: "Pressure", field: &self.pressure, shade, side: self.side };
        draw_map(&panel(contact + 2 * MARGIN, pressure), &pressure_map, TEXT)
    }
}

/// A single map as a picture.
#[derive(Clone, Copy, Debug)]
pub struct MapPicture<'a>(pub Map<'a>);

impl Picture for MapPicture<'_> {
    fn size(&self) -> (u32, u32) {
        let bitmap = bitmap_size(self.0.field.grid(), (SIDE, SIDE));
        let (width, height) = map_extent(bitmap, TEXT, self.0.shade.has_colour_bar());
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
    use crate::{save_png, save_svg};

    #[test]
    fn a_picture_has_its_size_and_maps_in_svg_are_bitmaps() {
        let dir = tempfile::tempdir().expect("a temporary folder");
        let pressure = Field::from_fn(Grid::new(60, 50).expect("a grid"), |DVec2 { x, y }| (x - y).max(0.0));
        let picture = ContactPicture::of(&pressure, 3e6, 1e-2);
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
        assert!(!text.contains(">\nsliding\n"), "nothing slides");
        let sliding = dir.path().join("c.svg");
        save_svg(&picture.clone().sliding(Some(DVec2::NEG_X)), &sliding).expect("an SVG file");
        let arrow = std::fs::read_to_string(sliding).expect("the SVG file");
        assert!(
            arrow.contains("\nsliding\n")
                && arrow.matches("<polyline").count() == text.matches("<polyline").count() + 2
        );
        let named = picture.clone().captioned("seed 1, pressure 2 MPa".to_owned());
        assert!(named.size().1 > picture.size().1);
        save_svg(&named, &dir.path().join("b.svg")).expect("an SVG file");
        let text = std::fs::read_to_string(dir.path().join("b.svg")).expect("the SVG file");
        assert!(text.contains("seed 1, pressure 2 MPa"));
    }

    #[test]
    fn means_over_blocks_are_touched() {
        let dir = tempfile::tempdir().expect("a temporary folder");
        let svg = dir.path().join("a.svg");
        let pressure = Field::from_fn(Grid::square(4).expect("a grid"), |at| (at.x - 0.5).max(0.0));
        let title = |picture: &ContactPicture| {
            save_svg(picture, &svg).expect("an SVG file");
            let text = std::fs::read_to_string(&svg).expect("the SVG file");
            text.lines().find(|line| line.contains(" % of ")).map(|line| line.trim().to_owned())
        };
        let picture = ContactPicture::of(&pressure, 1.0, 1.0);
        assert_eq!(title(&picture).as_deref(), Some("Contact: 50 % of the elements"));
        assert_eq!(title(&picture.of_blocks()).as_deref(), Some("Touched: 50 % of the blocks"));
    }

    #[test]
    fn pictures_have_the_shape_of_the_cell_up_to_one_to_four() {
        for (ratio, expected) in
            [(1.0, (900, 900)), (0.5, (900, 450)), (3.0, (300, 900)), (50.0, (225, 900)), (0.02, (900, 225))]
        {
            let grid = Grid::in_cell(64, 64, ratio).expect("a grid");
            assert_eq!(bitmap_size(grid, (SIDE, SIDE)), expected, "{ratio}");
        }
    }

    #[test]
    fn fields_without_contact_or_contrast_are_drawn() {
        let dir = tempfile::tempdir().expect("a temporary folder");
        for value in [0.0, 3.0] {
            let pressure = Field::from_fn(Grid::new(1, 1).expect("a grid"), |_| value);
            let picture = ContactPicture::of(&pressure, 1.0, 1.0);
            save_png(&picture, &dir.path().join("a.png")).expect("a PNG file");
        }
    }
}
