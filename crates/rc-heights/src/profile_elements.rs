//! The mean width of profile elements, RSm of ISO 21920-2 and ISO 4287.

/// Least height of a hill or dale relative to the height of the profile, and least width relative to a section.
///
/// They are the defaults of ISO 4287, 3.2.7, and ISO 21920-2 keeps the height.
const LEAST_HEIGHT: f64 = 0.1;
const LEAST_WIDTH: f64 = 0.01;

/// A hill or a dale: a part of the profile on one side of the mean line.
#[derive(Clone, Copy)]
struct Part {
    /// Where the profile crosses the mean line before it, in steps from the first point.
    start: f64,
    /// Where it crosses the line after it.
    end: f64,
    /// Largest distance from the mean line.
    height: f64,
    is_hill: bool,
}

/// The mean width of the profile elements of `heights`, in steps. `None` if there is no whole element.
///
/// An element is a hill and the dale beside it. Hills and dales lower than 10 % of `z` (Rz, or Pz), or narrower than 1 %
/// of `section` (steps), belong to what is before them. Elements are counted from the first crossing of the mean line,
/// and what remains after the last whole element is not used. Crossings are between points, on a straight line.
///
/// *Accuracy*: test `a_wave_has_its_length`.
#[must_use]
pub fn mean_width_of_elements(heights: &[f64], z: f64, section: f64) -> Option<f64> {
    let mean = heights.iter().sum::<f64>() / heights.len() as f64;
    let counts = |part: &Part| part.height >= LEAST_HEIGHT * z && part.end - part.start >= LEAST_WIDTH * section;
    let mut of_parts = parts(heights, mean).into_iter().filter(counts);
    let mut is_hill = of_parts.next()?.is_hill;
    let mut crossings = Vec::new();
    for part in of_parts.filter(|part| part.height > 0.0) {
        if part.is_hill != is_hill {
            is_hill = part.is_hill;
            crossings.push(part.start);
        }
    }
    let elements = crossings.len().saturating_sub(1) / 2;
    (elements > 0).then(|| (crossings[2 * elements] - crossings[0]) / elements as f64)
}

/// All hills and dales, in their order. A point on the line belongs to the part before it.
fn parts(heights: &[f64], mean: f64) -> Vec<Part> {
    let mut parts: Vec<Part> = Vec::new();
    for (i, height) in heights.iter().map(|height| height - mean).enumerate() {
        let same = parts.last().is_some_and(|part| height == 0.0 || part.is_hill == (height > 0.0));
        if let (true, Some(part)) = (same, parts.last_mut()) {
            (part.end, part.height) = (i as f64, part.height.max(height.abs()));
            continue;
        }
        let before = if i > 0 { heights[i - 1] - mean } else { height };
        // The line is crossed between the two points.
        let start = if i > 0 { i as f64 - height / (height - before) } else { 0.0 };
        if let Some(part) = parts.last_mut() {
            part.end = start;
        }
        parts.push(Part { start, end: i as f64, height: height.abs(), is_hill: height > 0.0 });
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    #[test]
    fn a_wave_has_its_length() {
        for phase in [0.0, 0.3, 2.0, 4.0] {
            let mut heights: Vec<f64> = (0..2000).map(|i| 5.0 + (TAU * f64::from(i) / 99.0 + phase).sin()).collect();
            let width = |heights: &[f64]| mean_width_of_elements(heights, 2.0, 400.0).expect("whole elements");
            // The mean of a part of a wave is off by up to 1 %, which moves crossings by up to 0.3 steps.
            assert!((width(&heights) - 99.0).abs() < 0.1, "{}", width(&heights));
            // Ripples below a tenth of the height, and a scratch narrower than a hundredth of a section.
            for (i, height) in heights.iter_mut().enumerate() {
                *height += 0.08 * (TAU * i as f64 / 7.0).sin();
            }
            heights[1300] -= 3.0;
            heights[1400] += 3.0;
            assert!((width(&heights) - 99.0).abs() < 0.5, "{}", width(&heights));
        }
    }

    #[test]
    fn less_than_one_element_has_no_width() {
        for heights in [&[][..], &[1.0], &[1.0, 1.0, 1.0], &[0.0, 1.0, 2.0, 3.0], &[0.0, 2.0, 2.0, 0.0, 0.0]] {
            assert_eq!(mean_width_of_elements(heights, 2.0, 4.0), None, "{heights:?}");
        }
        // Up, down and up again: crossings at 0.5, 2.5 and 4.5.
        assert_eq!(mean_width_of_elements(&[-1.0, 1.0, 1.0, -1.0, -1.0, 1.0], 2.0, 5.0), Some(4.0));
    }
}
