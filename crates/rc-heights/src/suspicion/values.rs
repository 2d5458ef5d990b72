//! Values that are no heights: marks of missing points, and numbers of rows or columns.

use rc_core::Field;

/// Values that programs write where nothing was measured, without their signs.
///
/// They are those of geographic grids, of signed and unsigned integers, of Surfer, of NetCDF, of MetroPro, and of
/// 32-bit and 64-bit floats.
const MARKS: [f64; 25] = [
    999.0,
    9999.0,
    99_999.0,
    999_999.0,
    9_999_999.0,
    999.25,
    32_767.0,
    32_768.0,
    32_766.0,
    65_535.0,
    65_534.0,
    2_147_483_640.0,
    2_147_483_641.0,
    2_147_483_642.0,
    2_147_483_643.0,
    2_147_483_644.0,
    2_147_483_645.0,
    2_147_483_646.0,
    2_147_483_647.0,
    2_147_483_648.0,
    4_294_967_295.0,
    9.969_209_968_386_869e36,
    1.701_41e38,
    3.402_823_466_385_288_6e38,
    1.797_693_134_862_315_7e308,
];

/// Powers of ten that programs write where nothing was measured.
const ROUND_MARKS: [f64; 5] = [1e10, 1e20, 1e30, 1e37, 1e38];

/// Factors that readers may have applied: units of length.
const FACTORS: [f64; 7] = [1.0, 1e-3, 1e-6, 1e-9, 1e-10, 1e-2, 1e-12];

/// Largest relative difference of a value from a mark: that of 32-bit floats and of marks with six digits.
const SAME: f64 = 3e-6;

/// Largest relative difference of a power of ten from itself in 32-bit floats.
const ROUND: f64 = 6e-8;

/// Distance of a mark from the heights, in ranges of the heights.
///
/// Heights that contain one of these numbers by chance have others near it. A single wrong height is a spike.
const FAR: f64 = 3.0;

/// The same distance for a mark that many points have exactly, so that it is no wrong height.
const FAR_IF_OFTEN: f64 = 0.1;

/// Fewest points that have a value often.
const OFTEN: usize = 5;

/// Most different values that are far from the others. Files use one or two marks.
const MOST_MARKS: usize = 2;

/// Fewest values of a row or column that counts. Three heights may be equally far apart by chance.
const FEWEST: usize = 4;

/// Fewest coordinates along a side, those without a corner.
const FEWEST_COORDINATES: usize = 12;

/// Largest difference of coordinates from even spacing, in steps. They have three or more digits.
const SPACED: f64 = 0.02;

/// The same for heights beside them, which are not evenly spaced unless the map is a tilted plane.
const NOT_SPACED: f64 = 0.2;

/// A value that usually marks missing points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mark {
    /// The value, in the unit of the heights.
    pub value: f64,
    /// Number of points with it.
    pub count: usize,
}

/// What counts instead of having heights.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Counter {
    /// The first row.
    Row,
    /// The first column.
    Column,
}

/// The value that usually marks missing points and is far from all other heights, or `None`.
///
/// If there are two such values, it is the more frequent one.
#[must_use]
pub fn marks(heights: &Field) -> Option<Mark> {
    let mut found: Vec<Mark> = Vec::new();
    while found.len() < MOST_MARKS {
        #[expect(clippy::float_cmp, reason = "all points with a mark have the same value")]
        let others = |height: &f64| height.is_finite() && found.iter().all(|mark| mark.value != *height);
        let values = || heights.values().iter().copied().filter(others);
        let Some(mark) = farthest(&values).filter(|mark| is_mark(mark.value)) else { break };
        found.push(mark);
    }
    found.into_iter().max_by_key(|mark| mark.count)
}

/// The lowest or highest value, if it is far from the others and one of them is a mark.
#[expect(clippy::float_cmp, reason = "all points with a mark have the same value")]
fn farthest<I: Iterator<Item = f64>>(values: &impl Fn() -> I) -> Option<Mark> {
    let (low, high) = values().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
    if !is_mark(low) && !is_mark(high) {
        return None;
    }
    // The next values after the ends.
    let (mut second, mut last, mut counts) = (f64::INFINITY, f64::NEG_INFINITY, [0; 2]);
    for value in values() {
        if value == low {
            counts[0] += 1;
        } else {
            second = second.min(value);
        }
        if value == high {
            counts[1] += 1;
        } else {
            last = last.max(value);
        }
    }
    // Any other height is far from a plate. Only one of hundreds of metres is then a mark.
    let is_far = |gap: f64, range: f64, count: usize| {
        let far = if count < OFTEN { FAR } else { FAR_IF_OFTEN };
        gap > if range > 0.0 { far * range } else { MARKS[0] - 1.0 } && gap.is_finite()
    };
    if is_far(second - low, high - second, counts[0]) {
        Some(Mark { value: low, count: counts[0] })
    } else if is_far(high - last, last - low, counts[1]) {
        Some(Mark { value: high, count: counts[1] })
    } else {
        None
    }
}

/// Whether a value is a mark, possibly times a factor of units.
fn is_mark(value: f64) -> bool {
    let is = |mark: f64| FACTORS.iter().any(|factor| (value.abs() / (mark * factor) - 1.0).abs() < SAME);
    let power = 10_f64.powf(value.abs().log10().round());
    // 1e-6 is no 999 999 pm.
    if value.abs() < 1e6 && (value.abs() / power - 1.0).abs() < ROUND {
        return false;
    }
    // Heights of 1, 10 or 1e-6 are not rare, but none is 1000 km.
    MARKS.iter().any(|mark| is(*mark)) || ROUND_MARKS.iter().any(|mark| is(*mark)) && value.abs() > 1e6
}

/// Whether the first row or column counts 0, 1, 2, … or 1, 2, 3, …, or is evenly spaced as coordinates are, and the
/// others are not.
///
/// The corner of coordinates may be anything.
#[must_use]
pub fn counter(heights: &Field) -> Option<Counter> {
    let (nx, ny) = (heights.grid().nx(), heights.grid().ny());
    let row = |iy: usize| heights.row(iy).to_vec();
    let column = |ix: usize| (0..ny).map(|iy| heights.at(ix, iy)).collect::<Vec<_>>();
    let is_counter = |first: &[f64], next: &[f64]| {
        counts(first) && !is_even(next)
            || first.len() > FEWEST_COORDINATES && is_spaced(&first[1..], SPACED) && !is_spaced(&next[1..], NOT_SPACED)
    };
    if ny > 1 && is_counter(&row(0), &row(1)) {
        Some(Counter::Row)
    } else if nx > 1 && is_counter(&column(0), &column(1)) {
        Some(Counter::Column)
    } else {
        None
    }
}

/// Whether values are 0, 1, 2, … or 1, 2, 3, …, possibly times a factor of units.
fn counts(values: &[f64]) -> bool {
    let [a, b, ..] = values else { return false };
    let step = b - a;
    let is_unit = FACTORS.iter().any(|factor| (step / factor - 1.0).abs() < SAME);
    let from = a / step;
    let is_from = from == 0.0 || (from - 1.0).abs() < SAME;
    let is_next = |(i, value): (usize, &f64)| (value / step - (from + i as f64)).abs() < SAME * (1.0 + i as f64);
    values.len() >= FEWEST && is_unit && is_from && values.iter().enumerate().all(is_next)
}

/// Whether values are on a line from the first to the last, up to a `part` of the step between neighbours.
fn is_spaced(values: &[f64], part: f64) -> bool {
    let [first, .., last] = values else { return false };
    let step = (last - first) / (values.len() - 1) as f64;
    let is_near = |(i, value): (usize, &f64)| (value - first - i as f64 * step).abs() <= part * step.abs();
    step != 0.0 && values.iter().enumerate().all(is_near)
}

/// Whether values are evenly spaced or equal, as on a plane.
fn is_even(values: &[f64]) -> bool {
    let [a, b, ..] = values else { return true };
    let step = b - a;
    let tolerance = SAME * values.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
    values.iter().enumerate().all(|(i, value)| (value - a - i as f64 * step).abs() <= tolerance)
}
