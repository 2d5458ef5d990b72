//! Fields as bitmaps of any size.

use plotters::style::RGBColor;
use rc_core::Field;

/// A bitmap, rows from top to bottom, three bytes a pixel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Raster {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Red, green, blue of each pixel.
    pub rgb: Vec<u8>,
}

impl Raster {
    /// A picture of `field` with y upwards. A pixel has the colour of the mean of `value` over the elements that it shows;
    /// where pixels are smaller than elements, that of its element.
    #[must_use]
    pub fn of(
        field: &Field,
        (width, height): (u32, u32),
        value: impl Fn(f64) -> f64,
        colour: impl Fn(f64) -> RGBColor,
    ) -> Self {
        let grid = field.grid();
        let columns: Vec<_> = (0..width as usize).map(|i| span(i, width as usize, grid.nx())).collect();
        let mut rgb = Vec::with_capacity(3 * width as usize * height as usize);
        for pixel_row in (0..height as usize).rev() {
            let rows = span(pixel_row, height as usize, grid.ny());
            for &(first, end) in &columns {
                let sum: f64 =
                    (rows.0..rows.1).map(|iy| field.row(iy)[first..end].iter().map(|v| value(*v)).sum::<f64>()).sum();
                let RGBColor(r, g, b) = colour(sum / ((end - first) * (rows.1 - rows.0)) as f64);
                rgb.extend([r, g, b]);
            }
        }
        Self { width, height, rgb }
    }
}

/// First and one past the last of the `elements` that pixel `i` of `pixels` shows; never empty.
fn span(i: usize, pixels: usize, elements: usize) -> (usize, usize) {
    let first = i * elements / pixels;
    (first, ((i + 1) * elements / pixels).max(first + 1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use rc_core::Grid;

    #[test]
    fn pixels_share_the_elements_among_them() {
        for (pixels, elements) in [(3, 10), (10, 10), (7, 100)] {
            let spans: Vec<_> = (0..pixels).map(|i| span(i, pixels, elements)).collect();
            assert_eq!(spans[0].0, 0);
            assert_eq!(spans[pixels - 1].1, elements);
            assert!(spans.windows(2).all(|pair| pair[0].1 == pair[1].0), "{spans:?}");
        }
    }

    #[test]
    fn y_points_upwards_and_small_fields_are_enlarged() {
        let field = Field::new(Grid::new(1, 2).expect("a grid"), vec![0.0, 200.0]).expect("a field");
        let raster = Raster::of(&field, (2, 4), |v| v, |v| RGBColor(v as u8, 0, 0));
        let red: Vec<u8> = raster.rgb.iter().step_by(3).copied().collect();
        assert_eq!(red, [200, 200, 200, 200, 0, 0, 0, 0]);
    }
}
