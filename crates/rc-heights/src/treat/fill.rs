//! Heights for points that were not measured.

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::str::FromStr;

use super::error::TreatError;
use super::treatment::Fill;
use crate::HeightMap;

impl FromStr for Fill {
    type Err = TreatError;

    fn from_str(text: &str) -> Result<Self, TreatError> {
        let how = [Self::Laplace, Self::Nearest, Self::Lowest].into_iter().find(|how| how.to_string() == text);
        let expected = "a way to fill missing points: laplace, nearest or lowest";
        how.ok_or_else(|| TreatError::Unknown { found: text.to_owned(), expected })
    }
}

/// Maximum number of steps of the iteration for [`Fill::Laplace`].
///
/// It is enough for holes of some thousand points across.
const MOST_STEPS: usize = 20_000;

/// Residual, relative to the first residual, at which the iteration ends.
const TOLERANCE: f64 = 1e-8;

/// Number of a point that is missing.
const MISSING: u32 = u32::MAX - 1;

/// The filled map, and a remark about the result.
///
/// A map without a measured point is returned unchanged.
pub(super) fn fill(mut map: HeightMap, how: Fill) -> (HeightMap, String) {
    let mut note = String::new();
    let holes: Vec<usize> = (0..map.heights.values().len()).filter(|i| map.heights.values()[*i].is_nan()).collect();
    if holes.is_empty() || holes.len() == map.heights.values().len() {
        return (map, note);
    }
    match how {
        Fill::Lowest => {
            let lowest = map.heights.min();
            for i in &holes {
                map.heights.values_mut()[*i] = lowest;
            }
        }
        Fill::Nearest => nearest(&mut map),
        Fill::Laplace => {
            nearest(&mut map);
            let left = laplace(&mut map, &holes, MOST_STEPS);
            if left > TOLERANCE {
                note = format!(", which stopped after {MOST_STEPS} steps at {left:.0e} of its first residual");
            }
        }
    }
    (map, note)
}

/// Replaces the heights of `points` by a membrane through the measured points around them.
///
/// Missing points stay missing. A point without a measured one around it keeps its height.
pub(super) fn replace(map: &mut HeightMap, points: &[usize]) {
    let (nx, ny) = (map.heights.grid().nx(), map.heights.grid().ny());
    let values = map.heights.values_mut();
    let before: Vec<f64> = points.iter().map(|i| std::mem::replace(&mut values[*i], f64::NAN)).collect();
    let mean_around = |i: &usize| {
        let there = around(*i, nx, ny).map(|j| values[j]).filter(|height| !height.is_nan());
        let (sum, n) = there.fold((0.0, 0), |(sum, n), height| (sum + height, n + 1));
        sum / f64::from(n)
    };
    let starts: Vec<f64> = points.iter().map(mean_around).collect();
    for ((i, start), before) in points.iter().zip(&starts).zip(before) {
        values[*i] = if start.is_nan() { before } else { *start };
    }
    let replaced = points.iter().zip(&starts).filter(|(_, start)| !start.is_nan());
    laplace(map, &replaced.map(|(i, _)| *i).collect::<Vec<_>>(), MOST_STEPS);
}

/// The points beside point `i`. Neighbours along x are first.
fn neighbours(i: usize, nx: usize, ny: usize) -> impl Iterator<Item = (usize, bool)> {
    let (ix, iy) = (i % nx, i / nx);
    let along_x = [(ix > 0).then(|| i - 1), (ix + 1 < nx).then_some(i + 1)];
    let along_y = [(iy > 0).then(|| i - nx), (iy + 1 < ny).then_some(i + nx)];
    let along = |points: [Option<usize>; 2], x| points.into_iter().flatten().map(move |point| (point, x));
    along(along_x, true).chain(along(along_y, false))
}

/// Fills each hole with the height of a nearest measured point.
///
/// Fronts start at all measured points. A hole gets the height of the nearest among the points that fill its
/// neighbours. This is the nearest of all points, except for differences below a distance of points. Ties have a fixed
/// order.
fn nearest(map: &mut HeightMap) {
    let (nx, ny) = (map.heights.grid().nx(), map.heights.grid().ny());
    let [dx, dy] = map.spacing();
    // Squared lengths are not negative, so the order of their bits is their order.
    let squared = |i: usize, j: usize| {
        let [x, y] = [(i % nx).abs_diff(j % nx) as f64 * dx, (i / nx).abs_diff(j / nx) as f64 * dy];
        (x * x + y * y).to_bits()
    };
    let values = map.heights.values_mut();
    let mut front = BinaryHeap::new();
    for i in (0..values.len()).filter(|i| !values[*i].is_nan()) {
        let holes = around(i, nx, ny).filter(|j| values[*j].is_nan());
        front.extend(holes.map(|hole| Reverse((squared(hole, i), hole, i))));
    }
    while let Some(Reverse((_, hole, from))) = front.pop() {
        if values[hole].is_nan() {
            values[hole] = values[from];
            let holes = around(hole, nx, ny).filter(|j| values[*j].is_nan());
            front.extend(holes.map(|next| Reverse((squared(next, from), next, from))));
        }
    }
}

/// The points among the eight around point `i` that are inside the map.
fn around(i: usize, nx: usize, ny: usize) -> impl Iterator<Item = usize> {
    let (ix, iy) = (i % nx, i / nx);
    let rows = iy.saturating_sub(1)..(iy + 2).min(ny);
    let columns = ix.saturating_sub(1)..(ix + 2).min(nx);
    rows.flat_map(move |y| columns.clone().map(move |x| y * nx + x)).filter(move |j| *j != i)
}

/// Solves Σ w (h_i - h_j) = 0 over the neighbours of each hole by conjugate gradients.
///
/// Missing points are not neighbours. The iteration starts from the present heights of the holes and has at most `most`
/// steps. Returns the ratio of the
/// last to the first residual.
fn laplace(map: &mut HeightMap, holes: &[usize], most: usize) -> f64 {
    let (nx, ny) = (map.heights.grid().nx(), map.heights.grid().ny());
    let [dx, dy] = map.spacing();
    let weight = |along_x: bool| if along_x { dy / dx } else { dx / dy };
    let values = map.heights.values_mut();
    let mut number: Vec<u32> = values.iter().map(|v| if v.is_nan() { MISSING } else { u32::MAX }).collect();
    holes.iter().enumerate().for_each(|(n, i)| number[*i] = n as u32);
    let beside = |i: usize| neighbours(i, nx, ny).filter(|(j, _)| number[*j] != MISSING);
    // Differences to neighbours. For a direction, measured points have the value 0.
    let residual = |values: &[f64]| -> Vec<f64> {
        let at = |i: &usize| beside(*i).map(|(j, x)| weight(x) * (values[j] - values[*i])).sum();
        holes.iter().map(at).collect()
    };
    let apply = |p: &[f64]| -> Vec<f64> {
        let at = |(n, i): (usize, &usize)| {
            let of = |j: usize| p.get(number[j] as usize).copied().unwrap_or(0.0);
            beside(*i).map(|(j, x)| weight(x) * (p[n] - of(j))).sum()
        };
        holes.iter().enumerate().map(at).collect()
    };
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let mut r = residual(values);
    let mut p = r.clone();
    let mut rr = dot(&r, &r);
    let first = rr;
    for _ in 0..most {
        if rr <= first * TOLERANCE * TOLERANCE {
            break;
        }
        let ap = apply(&p);
        let alpha = rr / dot(&p, &ap);
        holes.iter().zip(&p).for_each(|(i, p)| values[*i] += alpha * p);
        r.iter_mut().zip(&ap).for_each(|(r, ap)| *r -= alpha * ap);
        let next = dot(&r, &r);
        p.iter_mut().zip(&r).for_each(|(p, r)| *p = r + next / rr * *p);
        rr = next;
    }
    if first > 0.0 { (rr / first).sqrt() } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use rc_core::{DVec2, Field, Grid};

    use super::*;

    /// A number of steps equal to the number of holes is enough, up to rounding.
    #[test]
    fn an_iteration_that_was_stopped_says_how_far_it_came() {
        let map = || {
            let mut heights = Field::from_fn(Grid::square(20).expect("a grid"), |DVec2 { x, y }| x * x + 3.0 * x * y);
            heights.values_mut()[105..290].fill(f64::NAN);
            HeightMap::bare(heights)
        };
        let holes: Vec<usize> = (105..290).collect();
        let left = |most| {
            let mut map = map();
            nearest(&mut map);
            laplace(&mut map, &holes, most)
        };
        assert!(left(3) > 1e-3 && left(200) <= TOLERANCE, "{:e} after 3 steps, {:e} after 200", left(3), left(200));
        assert_eq!(fill(map(), Fill::Laplace).1, "", "an iteration that came to its end");
    }
}
