//! Rows of squares and of their parts: shares, means, interpolation, and the transpose of each.
//!
//! A square has two parts along each axis. Where the number of parts is odd, the last square has one part. The missing
//! part counts as empty.

use std::ops::Range;

use crate::parallel;

/// Minimum number of values that one task works on.
pub(super) const TASK: usize = 4096;

/// Squares that are active in part.
pub(crate) struct Parts {
    /// The part of the elements of each square that is active.
    active: Vec<f32>,
    weight: Weight,
}

/// Weight of a square of which the part x is active.
#[derive(Clone, Copy)]
pub(crate) enum Weight {
    /// On a grid, x^(3/4). `docs/constants.md` compares it with other powers.
    OfSquare,
    /// In a row, x^(1/4). A contact displaces a half-plane to a distance that hardly depends on its width.
    OfLine,
}

impl Weight {
    #[inline]
    fn of(self, x: f32) -> f32 {
        match self {
            Self::OfSquare => x.sqrt() * x.sqrt().sqrt(),
            Self::OfLine => x.sqrt().sqrt(),
        }
    }

    /// Factor on the mean over all elements of a square, active or not.
    #[inline]
    fn own(self, x: f32) -> f32 {
        // The mean over all elements is x times the mean over the active ones.
        if x > 0.0 { self.of(x) / x } else { 0.0 }
    }

    /// Factor on the value that larger squares have at the place of the square.
    #[inline]
    pub(crate) fn rest(self, x: f32) -> f32 {
        if x > 0.0 { 1.0 - self.of(x) } else { 1.0 }
    }
}

impl Parts {
    pub(crate) fn new(n: usize, weight: Weight) -> Self {
        Self { active: parallel::zeros(n), weight }
    }

    /// Sets the parts of squares that are active, which are the first of `parts`.
    pub(crate) fn set(&mut self, parts: &[f32]) {
        let parts = &parts[..self.active.len()];
        parallel::for_each(self.active.chunks_mut(TASK).zip(parts.chunks(TASK)), |(own, parts)| {
            own.copy_from_slice(parts);
        });
    }

    /// The parts of a range of squares, and their weight.
    pub(crate) fn of(&self, range: Range<usize>) -> (&[f32], Weight) {
        (&self.active[range], self.weight)
    }

    pub(crate) fn shares(&self) -> Shares<'_> {
        Shares::Parts { active: &self.active, weight: self.weight }
    }
}

/// The shares of u that are own values, and values around.
#[derive(Clone, Copy)]
pub(crate) enum Shares<'a> {
    /// Elements, of which active ones have their own value, and the others the value around.
    Active(&'a [bool]),
    /// Squares that are active in part.
    Parts { active: &'a [f32], weight: Weight },
}

impl Shares<'_> {
    /// The shares of a range of values.
    pub(crate) fn part(&self, range: Range<usize>) -> Shares<'_> {
        match self {
            Self::Active(active) => Shares::Active(&active[range]),
            Self::Parts { active, weight } => Shares::Parts { active: &active[range], weight: *weight },
        }
    }

    /// Changes own values to u.
    pub(crate) fn blend(self, around: &[f32], values: &mut [f32]) {
        let values = values.iter_mut().zip(around);
        match self {
            Self::Active(active) => {
                for ((value, &around), &active) in values.zip(active) {
                    *value = if active { *value } else { around };
                }
            }
            Self::Parts { active, weight } => {
                for ((value, around), &x) in values.zip(active) {
                    *value = weight.own(x) * *value + weight.rest(x) * around;
                }
            }
        }
    }

    /// Adds a multiple of the values around to a line, from a row of values for u.
    pub(super) fn add_rest(self, weight: f32, row: &[f32], line: &mut [f32]) {
        let values = line.iter_mut().zip(row);
        match self {
            Self::Active(active) => {
                for ((sum, value), &active) in values.zip(active) {
                    *sum += if active { 0.0 } else { weight * value };
                }
            }
            Self::Parts { active, weight: of_part } => {
                for ((sum, value), &x) in values.zip(active) {
                    *sum += weight * of_part.rest(x) * value;
                }
            }
        }
    }

    /// Changes values for u to values for own values, with the values `over` them from coarser squares.
    pub(crate) fn hand_down(self, over: &[f32], values: &mut [f32]) {
        let values = values.iter_mut().zip(over);
        match self {
            Self::Active(active) => {
                for ((value, over), &active) in values.zip(active) {
                    *value = if active { *value + over } else { 0.0 };
                }
            }
            Self::Parts { active, weight } => {
                for ((value, over), &x) in values.zip(active) {
                    *value = weight.own(x) * *value + over;
                }
            }
        }
    }

    /// Whether any u has a part of its own value.
    pub(crate) fn any_own(self) -> bool {
        match self {
            Self::Active(active) => active.iter().any(|&active| active),
            Self::Parts { .. } => true,
        }
    }
}

/// Means over squares from the two rows of their parts. The second row may be missing.
///
/// `value` is applied to each part, which has this `share` of a square.
pub(super) fn means<T: Copy>(rows: [Option<&[T]>; 2], share: f32, value: impl Fn(T) -> f32, means: &mut [f32]) {
    means.fill(0.0);
    for row in rows.into_iter().flatten() {
        let (pairs, rest) = row.as_chunks::<2>();
        for (mean, &[a, b]) in means.iter_mut().zip(pairs) {
            *mean += share * (value(a) + value(b));
        }
        if let (Some(mean), &[last]) = (means.last_mut(), rest) {
            *mean += share * value(last);
        }
    }
}

/// Interpolates between the centres of squares along both axes.
///
/// The parts are those of row `iy`. `values` are those of the squares, `width` to a row. `line` is scratch.
pub(super) fn interpolate(values: &[f32], width: usize, iy: usize, line: &mut Vec<f32>, parts: &mut [f32]) {
    let height = values.len() / width;
    let (near, far) = (iy / 2, if iy.is_multiple_of(2) { iy / 2 + height - 1 } else { iy / 2 + 1 } % height);
    let (near, far) = (&values[near * width..][..width], &values[far * width..][..width]);
    // The last square comes before the first, and the first after the last.
    line.clear();
    line.push(0.0);
    line.extend(near.iter().zip(far).map(|(near, far)| 0.75 * near + 0.25 * far));
    line[0] = line[width];
    line.push(line[1]);
    let (pairs, rest) = parts.as_chunks_mut::<2>();
    for (x, [a, b]) in pairs.iter_mut().enumerate() {
        let [before, here, after] = [line[x], line[x + 1], line[x + 2]];
        *a = 0.75 * here + 0.25 * before;
        *b = 0.75 * here + 0.25 * after;
    }
    if let [last] = rest {
        *last = 0.75 * line[width] + 0.25 * line[width - 1];
    }
}

/// Row `iy` of `height` rows of squares, by the transpose of [`interpolate`] times the `share` of a part.
///
/// `add_part(weight, y, line)` adds a multiple of row `y` of the `n` rows of parts to a line of `width` values.
pub(super) fn collect(
    [width, n]: [usize; 2],
    ([iy, height], share): ([usize; 2], f32),
    add_part: impl Fn(f32, usize, &mut [f32]),
    squares: &mut [f32],
) {
    // Two squares' parts before and after. Missing parts are zero.
    let padded = 2 * squares.len() + 2;
    let mut line = vec![0.0; padded];
    let [before, after] = [(iy + height - 1) % height, (iy + 1) % height];
    for (y, weight) in [(2 * before + 1, 0.25), (2 * iy, 0.75), (2 * iy + 1, 0.75), (2 * after, 0.25)] {
        if y < n {
            add_part(share * weight, y, &mut line[1..=width]);
        }
    }
    line[0] = line[padded - 2];
    line[padded - 1] = line[1];
    for (square, parts) in squares.iter_mut().zip(line.windows(4).step_by(2)) {
        *square = 0.75 * (parts[1] + parts[2]) + 0.25 * (parts[0] + parts[3]);
    }
}
