//! The area at which a load curve loses percolation.

use rc_core::quantity::{count, digits};

/// Scene and seed of a surface.
type Surface = (String, Option<u64>);

/// A sentence about the contact areas at which the flow ends.
///
/// A row has a surface, an area and the permeances along both axes. `None` without rows.
pub(super) fn note(mut rows: Vec<(Surface, f64, [f64; 2])>) -> Option<String> {
    rows.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let surfaces = rows.chunk_by(|a, b| a.0 == b.0);
    let brackets: Vec<[f64; 2]> = surfaces.flat_map(|rows| [0, 1].map(|axis| bracket(rows, axis))).flatten().collect();
    if rows.is_empty() {
        return None;
    }
    if brackets.is_empty() {
        return Some(
            "On each surface and along each axis, the film percolates at all of its loads, or at none.".to_owned(),
        );
    }
    let low = brackets.iter().map(|bracket| bracket[0]).fold(f64::INFINITY, f64::min);
    let high = brackets.iter().map(|bracket| bracket[1]).fold(0.0, f64::max);
    Some(format!(
        "Percolation is lost between the rows with contact areas of {} and {} %, for {} of one axis of one surface.",
        digits(100.0 * low, 3),
        digits(100.0 * high, 3),
        count(brackets.len(), "flow")
    ))
}

/// The last area with a flow and the first area without.
///
/// All rows are of one surface.
fn bracket(rows: &[(Surface, f64, [f64; 2])], axis: usize) -> Option<[f64; 2]> {
    let pair = rows.windows(2).find(|pair| pair[0].2[axis] > 0.0 && pair[1].2[axis] <= 0.0)?;
    Some([pair[0].1, pair[1].1])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_threshold_is_between_the_last_flow_and_the_first_row_without() {
        let row = |seed, area, flows| ((String::new(), Some(seed)), area, flows);
        let rows =
            vec![row(1, 0.3, [1.0, 2.0]), row(1, 0.5, [0.0, 0.0]), row(2, 0.5, [0.1, 0.0]), row(2, 0.4, [1.0, 1.0])];
        let text = note(rows).expect("flows");
        assert!(text.contains("between the rows with contact areas of 30 and 50 %, for 3 flows"), "{text}");
        assert_eq!(note(Vec::new()), None);
        let never_lost = vec![row(1, 0.3, [1.0, 2.0]), row(2, 0.3, [0.0, 0.0])];
        assert!(note(never_lost).expect("flows").contains("On each surface and along each axis"));
    }
}
