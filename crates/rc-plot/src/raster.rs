//! Fields as bitmaps of any size.

use plotters::style::RGBColor;
use rc_core::{Field, Grid};

/// A bitmap with rows from top to bottom, and three bytes for each pixel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Raster {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Red, green and blue of each pixel.
    pub rgb: Vec<u8>,
}

impl Raster {
    /// A picture of `field` with y upwards.
    ///
    /// A pixel has the colour of the mean of `value` over the elements in it. A pixel that is smaller than an element
    /// has the colour of its element.
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

/// Means of a value over the elements of pixels, from rows of a field.
///
/// The field need not be in memory completely. The [`Raster`] of the means, with the same number of pixels, equals that
/// of the field bit for bit.
#[derive(Clone, Debug)]
pub struct PixelMean {
    grid: Grid,
    sums: Field,
    next_row: usize,
}

impl PixelMean {
    /// Means of fields on `grid`, with at most `most` pixels per side.
    ///
    /// If there are fewer elements, each element is a pixel.
    ///
    /// # Panics
    /// When `most` is 0.
    #[must_use]
    pub fn new(grid: Grid, most: usize) -> Self {
        let pixels =
            grid.with_elements(grid.nx().min(most), grid.ny().min(most)).expect("not more pixels than elements");
        Self { grid, sums: Field::zeros(pixels), next_row: 0 }
    }

    /// Adds the next row.
    ///
    /// # Panics
    /// When there are more rows than the grid has.
    pub fn take(&mut self, row: impl Fn(usize) -> f64) {
        let pixels = self.sums.grid();
        // The pixel whose range contains the row.
        let start = pixels.index(0, ((self.next_row + 1) * pixels.ny() - 1) / self.grid.ny());
        for (i, sum) in self.sums.values_mut()[start..start + pixels.nx()].iter_mut().enumerate() {
            let (first, end) = span(i, pixels.nx(), self.grid.nx());
            *sum += (first..end).map(&row).sum::<f64>();
        }
        self.next_row += 1;
    }

    /// The mean of each pixel.
    #[must_use]
    pub fn finish(mut self) -> Field {
        let pixels = self.sums.grid();
        let length = |(first, end): (usize, usize)| end - first;
        for iy in 0..pixels.ny() {
            let rows = length(span(iy, pixels.ny(), self.grid.ny()));
            let start = pixels.index(0, iy);
            for (ix, sum) in self.sums.values_mut()[start..start + pixels.nx()].iter_mut().enumerate() {
                *sum /= (rows * length(span(ix, pixels.nx(), self.grid.nx()))) as f64;
            }
        }
        self.sums
    }
}

/// Range of the elements that pixel `i` of `pixels` shows, as first and last + 1.
///
/// It is never empty.
fn span(i: usize, pixels: usize, elements: usize) -> (usize, usize) {
    let first = i * elements / pixels;
    (first, ((i + 1) * elements / pixels).max(first + 1))
}

#[cfg(test)]
mod tests {
    use rc_core::DVec2;

    use super::*;

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
    fn means_over_pixels_give_the_same_picture_bit_for_bit() {
        for (nx, ny) in [(50, 70), (7, 90), (3, 2)] {
            let field =
                Field::from_fn(Grid::new(nx, ny).expect("a grid"), |DVec2 { x, y }| (7.0 * x).sin() * (y - 0.3));
            let mut mean = PixelMean::new(field.grid(), 16);
            (0..ny).for_each(|iy| mean.take(|ix| field.at(ix, iy)));
            let colour = |v: f64| {
                let bytes = v.to_bits().to_be_bytes();
                RGBColor(bytes[0] ^ bytes[5], bytes[1] ^ bytes[6], bytes[2] ^ bytes[7])
            };
            let raster = |field: &Field| Raster::of(field, (16, 16), |v| v, colour);
            assert!(raster(&mean.finish()) == raster(&field), "{nx} x {ny}");
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
