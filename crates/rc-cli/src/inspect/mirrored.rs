//! The measured part of a mirrored map.
//!
//! A mirrored map is a sum of cosines alone, so its spectrum is not that of the surface. The spectrum of the measured
//! part is.

use rc_core::Field;
use rc_sweep::MapOrigin;

/// What a record says about the spectrum of a mirrored map.
pub(crate) const NOTE: &str =
    "the spectrum is that of the measured part, because its mirror images change the spectrum";

/// Largest difference between heights and their mirror images, relative to the range of heights.
///
/// Filters change the symmetry only by rounding.
const SYMMETRY: f64 = 1e-6;

/// The part of `heights` of which the rest are mirror images, or `None` if there is no such part.
///
/// `heights` are in sides of their cell, those of the part in its sides. Copies of a mirrored map have none.
pub(super) fn measured_part(heights: &Field, origin: &MapOrigin) -> Option<Field> {
    let at = origin.treatments.iter().rposition(|step| step == "periodic mirror")?;
    let has_copies = origin.treatments[at..].iter().any(|step| step.starts_with("repeat"));
    let all = heights.grid();
    let is_row = all.ny() == 1;
    let has_halves = all.nx().is_multiple_of(2) && (is_row || all.ny().is_multiple_of(2));
    if has_copies || !has_halves || !is_symmetric(heights) {
        return None;
    }
    let (nx, ny) = (all.nx() / 2, if is_row { 1 } else { all.ny() / 2 });
    let grid = all.with_elements(nx, ny).ok()?;
    let values = (0..ny).flat_map(|iy| heights.row(iy)[..nx].iter().map(|height| 2.0 * height)).collect();
    Field::new(grid, values).ok()
}

/// Whether the second half of all rows and columns is the first one backwards.
fn is_symmetric(heights: &Field) -> bool {
    let (grid, most) = (heights.grid(), SYMMETRY * (heights.max() - heights.min()));
    (0..grid.ny()).all(|iy| {
        let (row, image) = (heights.row(iy), heights.row(grid.ny() - 1 - iy));
        let along_x = row.iter().zip(row.iter().rev());
        along_x.chain(row.iter().zip(image)).all(|(a, b)| (a - b).abs() <= most)
    })
}
