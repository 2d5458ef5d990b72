//! Pictures: maps of fields and line plots, as PNG or SVG, with an embedded font.
//!
//! A [`Picture`] draws itself on any backend. [`save_png`], [`save_small_png`] and [`save_svg`] write it to a file.
//! [`draw_map`] and [`draw_lines`] fill an area of a larger picture, so a figure is assembled from them.

mod colour;
mod file;
mod font;
mod lines;
mod map;
mod maps;
mod raster;

use plotters::coord::Shift;
use plotters::prelude::{DrawingArea, DrawingBackend};
use thiserror::Error;

pub use colour::{CURVES, Palette};
pub use file::{save_png, save_small_png, save_svg};
pub use font::{FONT, register_font};
pub use lines::{LinePlot, LineStyle, LogAxes, Series, draw_lines, draw_lines_on};
pub use map::{Map, Shade, WALL, bitmap_size, draw_map, map_extent, range_of_most};
pub use maps::{ContactPicture, ContactRows, MapPicture};
pub use raster::{PixelMean, Raster};

/// A picture that could not be drawn or saved. The text comes from the plotting library.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{0}")]
pub struct PictureError(String);

impl PictureError {
    /// Wraps an error of the plotting library.
    pub fn new(cause: impl std::fmt::Display) -> Self {
        Self(cause.to_string())
    }
}

/// The area of a picture to draw in.
pub type Area<B> = DrawingArea<B, Shift>;

/// A picture that draws itself on any backend.
pub trait Picture {
    /// Width and height in pixels.
    fn size(&self) -> (u32, u32);

    /// Draws on `area`, which has this size and is white.
    ///
    /// # Errors
    /// [`PictureError`] of the backend.
    fn draw<B: DrawingBackend>(&self, area: &Area<B>) -> Result<(), PictureError>;
}
