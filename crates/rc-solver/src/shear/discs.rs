//! Tractions within the discs |t| ≤ μp.

use rc_core::DVec2;

/// Steps of Newton's method. It ends after about ten.
const MOST_STEPS: usize = 100;

/// Relative error of the mean at which it ends.
const MEAN_ERROR: f64 = 1e-13;

/// The vector nearest to `value` in the disc of this radius.
pub(super) fn clipped(value: DVec2, radius: f64) -> DVec2 {
    let length = value.length();
    if length <= radius { value } else { value * (radius / length) }
}

/// Moves `values` to the nearest ones within their discs whose sum is `total`.
///
/// They are clip(value + c) with one vector c for all, which minimises the convex sum of Huber's functions of value + c,
/// minus c·total. Newton's method with halved steps finds it. |total| must be below the sum of the radii.
pub(super) fn project(values: &mut [DVec2], radii: &[f64], total: DVec2) {
    let bound: f64 = radii.iter().sum();
    let mut shift = DVec2::ZERO;
    let mut at = Sums::of(values, radii, shift);
    for _ in 0..MOST_STEPS {
        let excess = at.total - total;
        if excess.length() <= MEAN_ERROR * bound {
            break;
        }
        let step = at.solve(excess);
        let objective = |sums: &Sums, shift: DVec2| sums.huber - shift.dot(total);
        let before = objective(&at, shift);
        let mut part = 1.0;
        loop {
            let next = shift - part * step;
            let sums = Sums::of(values, radii, next);
            let is_lower = objective(&sums, next) <= before - 1e-4 * part * excess.dot(step);
            // Near the end the objective no longer tells steps apart, but the residual does.
            if is_lower || (sums.total - total).length() < 0.5 * excess.length() || part < 1e-9 {
                (shift, at) = (next, sums);
                break;
            }
            part *= 0.5;
        }
    }
    for (value, &radius) in values.iter_mut().zip(radii) {
        *value = clipped(*value + shift, radius);
    }
}

/// Sums over clip(value + c).
struct Sums {
    total: DVec2,
    /// Huber's function, whose gradient is the clipped vector.
    huber: f64,
    /// Second derivatives xx, yy, xy of the sum.
    hessian: [f64; 3],
}

impl Sums {
    fn of(values: &[DVec2], radii: &[f64], shift: DVec2) -> Self {
        let mut sums = Self { total: DVec2::ZERO, huber: 0.0, hessian: [0.0; 3] };
        for (value, &radius) in values.iter().zip(radii) {
            let moved = *value + shift;
            let length = moved.length();
            if length <= radius {
                sums.total += moved;
                sums.huber += 0.5 * length * length;
                sums.hessian[0] += 1.0;
                sums.hessian[1] += 1.0;
            } else {
                let unit = moved / length;
                let across = radius / length;
                sums.total += radius * unit;
                sums.huber += radius * (length - 0.5 * radius);
                sums.hessian[0] += across * unit.y * unit.y;
                sums.hessian[1] += across * unit.x * unit.x;
                sums.hessian[2] -= across * unit.x * unit.y;
            }
        }
        sums
    }

    /// The step of Newton's method for the residual `right`.
    fn solve(&self, right: DVec2) -> DVec2 {
        let [xx, yy, xy] = self.hessian;
        // If all slip, the sum does not change along them. A small stiffness gives a long step then.
        let least = 1e-6 * (xx + yy) + f64::MIN_POSITIVE;
        let [xx, yy] = [xx + least, yy + least];
        DVec2::new(yy * right.x - xy * right.y, xx * right.y - xy * right.x) / (xx * yy - xy * xy)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_projection_is_feasible_and_the_nearest() {
        let n = 50;
        let at = |i: usize| (i as f64 * 0.7).sin();
        let radii: Vec<f64> = (0..n).map(|i| 0.1 + at(3 * i + 1).abs()).collect();
        let values: Vec<DVec2> = (0..n).map(|i| DVec2::new(2.0 * at(i), at(5 * i + 2))).collect();
        for part in [0.0, 0.3, 0.9, 0.999] {
            let total = part * radii.iter().sum::<f64>() * DVec2::new(0.8, -0.6);
            let mut found = values.clone();
            project(&mut found, &radii, total);
            let error = (found.iter().sum::<DVec2>() - total).length();
            assert!(error < 1e-11, "{part}: the sum is off by {error:e}");
            // The shift from a value to the projection is one vector inside all discs, and points outwards of it at
            // their borders.
            let inside = (0..n).find(|&i| found[i].length() < radii[i] * (1.0 - 1e-9));
            if let Some(shift) = inside.map(|i| found[i] - values[i]) {
                for i in 0..n {
                    let error = (found[i] - clipped(values[i] + shift, radii[i])).length();
                    assert!(error < 1e-10, "{part}, {i}: {error:e}");
                }
            }
            assert!(found.iter().zip(&radii).all(|(t, r)| t.length() <= r * (1.0 + 1e-15)));
        }
    }
}
