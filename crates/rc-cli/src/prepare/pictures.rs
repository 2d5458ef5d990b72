//! Pictures of a map before its treatments, and of the points that were despiked.

use rc_core::quantity::count;
use rc_core::{Field, Grid};
use rc_heights::HeightMap;
use rc_plot::{Map, MapPicture, Shade, save_png};
use rc_sweep::files::{FileError, Staged};

/// Part of a side that the mark of a despiked point takes.
const MARK: f64 = 1.0 / 200.0;

/// Adds `before.png`: the map as read.
pub(super) fn add_before(staged: &mut Staged, map: &HeightMap) -> Result<(), FileError> {
    let title = if map.missing() > 0 { "Height as read (red: missing)" } else { "Height as read" };
    add(staged, "before.png", map, title)
}

/// Adds `despiked.png`: `map` before it was despiked, with the points that went in red.
pub(super) fn add_despiked(staged: &mut Staged, mut map: HeightMap, points: &[usize]) -> Result<(), FileError> {
    let lowest = map.heights.min();
    for height in map.heights.values_mut().iter_mut().filter(|height| height.is_nan()) {
        *height = lowest;
    }
    mark(&mut map.heights, points);
    add(staged, "despiked.png", &map, &format!("Despiked: {} (red)", count(points.len(), "point")))
}

fn add(staged: &mut Staged, name: &str, map: &HeightMap, title: &str) -> Result<(), FileError> {
    let grid = map.heights.grid();
    let [side, side_y] = map.sides.unwrap_or_else(|| map.sides_of_width(1.0));
    let in_cell = Grid::in_cell(grid.nx(), grid.ny(), side_y / side).unwrap_or(grid);
    let field = Field::new(in_cell, map.heights.values().to_vec()).expect("as many values as points");
    let picture = MapPicture(Map { title, field: &field, shade: Shade::of_heights(&field, 1.0), side });
    staged.add(name, |path| save_png(&picture, path))
}

/// Makes the points in a square about each of `points` missing.
fn mark(heights: &mut Field, points: &[usize]) {
    let grid = heights.grid();
    let (nx, ny) = (grid.nx(), grid.ny());
    let half = (0.5 * MARK * nx.max(ny) as f64).ceil() as usize;
    for point in points {
        let (x, y) = (point % nx, point / nx);
        for iy in y.saturating_sub(half)..(y + half + 1).min(ny) {
            let row = grid.index(0, iy);
            heights.values_mut()[row + x.saturating_sub(half)..row + (x + half + 1).min(nx)].fill(f64::NAN);
        }
    }
}
