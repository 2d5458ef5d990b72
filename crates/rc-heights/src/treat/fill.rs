//! Heights for points that were not measured.

use std::collections::VecDeque;
use std::fmt;
use std::str::FromStr;

use super::TreatError;
use crate::HeightMap;

/// How missing points get heights.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fill {
    /// The smoothest membrane through the points around (∇²h = 0): no new peaks, no new valleys.
    Laplace,
    /// The height of the nearest measured point.
    Nearest,
    /// The lowest measured height: what was too deep or too steep to be measured does not touch.
    Lowest,
}

impl fmt::Display for Fill {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Laplace => "laplace",
            Self::Nearest => "nearest",
            Self::Lowest => "lowest",
        })
    }
}

impl FromStr for Fill {
    type Err = TreatError;

    fn from_str(text: &str) -> Result<Self, TreatError> {
        let how = [Self::Laplace, Self::Nearest, Self::Lowest].into_iter().find(|how| how.to_string() == text);
        let expected = "a way to fill missing points: laplace, nearest or lowest";
        how.ok_or_else(|| TreatError::Unknown { found: text.to_owned(), expected })
    }
}

/// Most steps of the iteration for [`Fill::Laplace`]: enough for holes of some thousand points across.
const MOST_STEPS: usize = 20_000;

/// Part of the first residual at which the iteration ends.
const TOLERANCE: f64 = 1e-8;

/// A map without a measured point is returned as it is.
pub(super) fn fill(mut map: HeightMap, how: Fill) -> HeightMap {
    let holes: Vec<usize> = (0..map.heights.values().len()).filter(|i| map.heights.values()[*i].is_nan()).collect();
    if holes.is_empty() || holes.len() == map.heights.values().len() {
        return map;
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
            laplace(&mut map, &holes);
        }
    }
    map
}

/// The points beside point `i`, those along x first.
fn neighbours(i: usize, nx: usize, ny: usize) -> impl Iterator<Item = (usize, bool)> {
    let (ix, iy) = (i % nx, i / nx);
    let along_x = [(ix > 0).then(|| i - 1), (ix + 1 < nx).then_some(i + 1)];
    let along_y = [(iy > 0).then(|| i - nx), (iy + 1 < ny).then_some(i + nx)];
    let along = |points: [Option<usize>; 2], x| points.into_iter().flatten().map(move |point| (point, x));
    along(along_x, true).chain(along(along_y, false))
}

/// Fronts that start at all measured points and go one point at a time; ties in a fixed order.
fn nearest(map: &mut HeightMap) {
    let (nx, ny) = (map.heights.grid().nx(), map.heights.grid().ny());
    let values = map.heights.values_mut();
    let at_hole = |values: &[f64], i: usize| neighbours(i, nx, ny).any(|(j, _)| values[j].is_nan());
    let mut front: VecDeque<usize> =
        (0..values.len()).filter(|i| !values[*i].is_nan() && at_hole(values, *i)).collect();
    while let Some(i) = front.pop_front() {
        for (j, _) in neighbours(i, nx, ny) {
            if values[j].is_nan() {
                values[j] = values[i];
                front.push_back(j);
            }
        }
    }
}

/// Conjugate gradients for Σ w (h_i - h_j) = 0 over the neighbours of each hole, from the heights that the holes have.
fn laplace(map: &mut HeightMap, holes: &[usize]) {
    let (nx, ny) = (map.heights.grid().nx(), map.heights.grid().ny());
    let [dx, dy] = map.spacing();
    let weight = |along_x: bool| if along_x { dy / dx } else { dx / dy };
    let values = map.heights.values_mut();
    let mut number = vec![u32::MAX; values.len()];
    holes.iter().enumerate().for_each(|(n, i)| number[*i] = n as u32);
    // Differences to neighbours; of a direction, those to measured points count in full.
    let residual = |values: &[f64]| -> Vec<f64> {
        let at = |i: &usize| neighbours(*i, nx, ny).map(|(j, x)| weight(x) * (values[j] - values[*i])).sum();
        holes.iter().map(at).collect()
    };
    let apply = |p: &[f64]| -> Vec<f64> {
        let at = |(n, i): (usize, &usize)| {
            let of = |j: usize| p.get(number[j] as usize).copied().unwrap_or(0.0);
            neighbours(*i, nx, ny).map(|(j, x)| weight(x) * (p[n] - of(j))).sum()
        };
        holes.iter().enumerate().map(at).collect()
    };
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let mut r = residual(values);
    let mut p = r.clone();
    let mut rr = dot(&r, &r);
    let enough = rr * TOLERANCE * TOLERANCE;
    for _ in 0..MOST_STEPS {
        if rr <= enough {
            return;
        }
        let ap = apply(&p);
        let alpha = rr / dot(&p, &ap);
        holes.iter().zip(&p).for_each(|(i, p)| values[*i] += alpha * p);
        r.iter_mut().zip(&ap).for_each(|(r, ap)| *r -= alpha * ap);
        let next = dot(&r, &r);
        p.iter_mut().zip(&r).for_each(|(p, r)| *p = r + next / rr * *p);
        rr = next;
    }
}
