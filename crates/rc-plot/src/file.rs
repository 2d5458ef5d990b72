//! PNG and SVG files of pictures.

use std::path::Path;

use plotters::prelude::DrawingBackend;
use plotters::prelude::{BLACK, BitMapBackend, IntoDrawingArea as _, SVGBackend, WHITE};
use plotters_backend::{BackendColor, BackendCoord, BackendStyle, BackendTextStyle, DrawingErrorKind};

use crate::font::register_font;
use crate::{Area, Picture, PictureError};

/// Saves a picture as PNG.
///
/// # Errors
/// [`PictureError`] of the drawing or of the file.
pub fn save_png(picture: &impl Picture, path: &Path) -> Result<(), PictureError> {
    save(path, &png_bytes(&pixels(picture)?, picture.size(), |_| ())?)
}

/// Saves a picture of few colours as a small PNG, for files that are archived.
///
/// The file is several times smaller than that of [`save_png`], but takes longer to write.
///
/// # Errors
/// [`PictureError`] of the drawing or of the file.
pub fn save_small_png(picture: &impl Picture, path: &Path) -> Result<(), PictureError> {
    let smallest = |encoder: &mut png::Encoder<'_, &mut Vec<u8>>| {
        encoder.set_compression(png::Compression::Best);
        // Rows of plain colours compress best without a filter.
        encoder.set_filter(png::FilterType::NoFilter);
    };
    save(path, &png_bytes(&pixels(picture)?, picture.size(), smallest)?)
}

/// The pixels of a picture, three bytes each, rows from top to bottom.
fn pixels(picture: &impl Picture) -> Result<Vec<u8>, PictureError> {
    let (width, height) = picture.size();
    let mut rgb = vec![0; 3 * width as usize * height as usize];
    draw(picture, &BitMapBackend::with_buffer(&mut rgb, (width, height)).into_drawing_area())?;
    Ok(rgb)
}

/// Saves a picture as SVG. Maps are embedded as bitmaps.
///
/// # Errors
/// [`PictureError`] of the drawing or of the file.
pub fn save_svg(picture: &impl Picture, path: &Path) -> Result<(), PictureError> {
    let (mut text, mut bitmaps) = (String::new(), Vec::new());
    let backend = SvgWithBitmaps { svg: SVGBackend::with_string(&mut text, picture.size()), bitmaps: &mut bitmaps };
    draw(picture, &backend.into_drawing_area())?;
    save(path, with_bitmaps(&text, &bitmaps)?.as_bytes())
}

/// The document with bitmaps in place of their placeholders.
fn with_bitmaps(text: &str, bitmaps: &[String]) -> Result<String, PictureError> {
    let (mut document, mut rest) = (String::with_capacity(text.len()), text);
    for (number, image) in bitmaps.iter().enumerate() {
        let size = placeholder_size(number);
        let tag = format!("width=\"{size}\" height=\"{size}\"");
        let place = rest.find(&tag).and_then(|at| Some((rest[..at].rfind('<')?, at + rest[at..].find('>')? + 1)));
        let (start, end) = place.ok_or_else(|| {
            PictureError::new("a bitmap has lost its place in the SVG document (an error of rc; please report it)")
        })?;
        document.push_str(&rest[..start]);
        document.push_str(image);
        rest = &rest[end..];
    }
    document.push_str(rest);
    Ok(document)
}

/// Width and height of the placeholder of a bitmap. No picture draws a rectangle of this size.
fn placeholder_size(number: usize) -> i32 {
    -1_000_000 - number as i32
}

fn draw<B: DrawingBackend>(picture: &impl Picture, area: &Area<B>) -> Result<(), PictureError> {
    register_font();
    area.fill(&WHITE).map_err(PictureError::new)?;
    picture.draw(area)?;
    area.present().map_err(PictureError::new)
}

fn save(path: &Path, bytes: &[u8]) -> Result<(), PictureError> {
    std::fs::write(path, bytes).map_err(PictureError::new)
}

/// Bytes of a PNG file with these pixels.
///
/// Pixels have three bytes each, with rows from top to bottom. `configure` sets up the encoder.
fn png_bytes(
    rgb: &[u8],
    (width, height): (u32, u32),
    configure: impl Fn(&mut png::Encoder<'_, &mut Vec<u8>>),
) -> Result<Vec<u8>, PictureError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgb);
    configure(&mut encoder);
    let mut writer = encoder.write_header().map_err(PictureError::new)?;
    writer.write_image_data(rgb).map_err(PictureError::new)?;
    writer.finish().map_err(PictureError::new)?;
    Ok(bytes)
}

/// An SVG backend that embeds bitmaps as PNG.
///
/// The plotting library would use an image library for this. That library takes longer to compile than everything else
/// that pictures need.
struct SvgWithBitmaps<'a> {
    svg: SVGBackend<'a>,
    /// The `image` elements, in the order of drawing.
    bitmaps: &'a mut Vec<String>,
}

/// Result of a drawing command.
type Drawn<E> = Result<(), DrawingErrorKind<E>>;

impl<'a> DrawingBackend for SvgWithBitmaps<'a> {
    type ErrorType = <SVGBackend<'a> as DrawingBackend>::ErrorType;

    fn get_size(&self) -> (u32, u32) {
        self.svg.get_size()
    }

    fn ensure_prepared(&mut self) -> Drawn<Self::ErrorType> {
        self.svg.ensure_prepared()
    }

    fn present(&mut self) -> Drawn<Self::ErrorType> {
        self.svg.present()
    }

    fn draw_pixel(&mut self, at: BackendCoord, colour: BackendColor) -> Drawn<Self::ErrorType> {
        self.svg.draw_pixel(at, colour)
    }

    fn draw_line<S: BackendStyle>(&mut self, from: BackendCoord, to: BackendCoord, s: &S) -> Drawn<Self::ErrorType> {
        self.svg.draw_line(from, to, s)
    }

    fn draw_rect<S: BackendStyle>(
        &mut self,
        from: BackendCoord,
        to: BackendCoord,
        style: &S,
        fill: bool,
    ) -> Drawn<Self::ErrorType> {
        self.svg.draw_rect(from, to, style, fill)
    }

    fn draw_path<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        path: I,
        style: &S,
    ) -> Drawn<Self::ErrorType> {
        self.svg.draw_path(path, style)
    }

    fn draw_circle<S: BackendStyle>(
        &mut self,
        centre: BackendCoord,
        radius: u32,
        style: &S,
        fill: bool,
    ) -> Drawn<Self::ErrorType> {
        self.svg.draw_circle(centre, radius, style, fill)
    }

    fn fill_polygon<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        corners: I,
        style: &S,
    ) -> Drawn<Self::ErrorType> {
        self.svg.fill_polygon(corners, style)
    }

    fn draw_text<S: BackendTextStyle>(&mut self, text: &str, style: &S, at: BackendCoord) -> Drawn<Self::ErrorType> {
        self.svg.draw_text(text, style, at)
    }

    fn estimate_text_size<S: BackendTextStyle>(
        &self,
        text: &str,
        style: &S,
    ) -> Result<(u32, u32), DrawingErrorKind<Self::ErrorType>> {
        self.svg.estimate_text_size(text, style)
    }

    /// Draws a placeholder for a bitmap.
    ///
    /// It is at the place of the bitmap, so that later drawings lie above it.
    fn blit_bitmap(&mut self, (x, y): BackendCoord, size: (u32, u32), rgb: &[u8]) -> Drawn<Self::ErrorType> {
        use base64::Engine as _;

        let bytes = png_bytes(rgb, size, |_| ())
            .map_err(|error| DrawingErrorKind::DrawingError(std::io::Error::other(error.to_string())))?;
        let data = base64::engine::general_purpose::STANDARD.encode(bytes);
        let (width, height) = size;
        let image = format!(
            "<image x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" href=\"data:image/png;base64,{data}\"/>"
        );
        let corner = placeholder_size(self.bitmaps.len());
        self.bitmaps.push(image);
        self.svg.draw_rect((x, y), (x + corner, y + corner), &BLACK, false)
    }
}
