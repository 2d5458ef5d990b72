//! Displacement by a tangential traction on one element of a half-space.

use std::f64::consts::FRAC_1_PI;

use rc_core::DVec2;

/// The part of the response that Poisson's ratio adds, for ν/(1 - ν) = 1: (xx, yy, xy) at `offset`.
///
/// A traction t on a half-space with E* = 1 displaces its surface by ∫ t/(πr) + ν/(1 - ν) ∫ r (r·t)/(πr³) (Johnson,
/// Contact Mechanics, 1985, Eq. 3.75). This is the second integral over a rectangle with these half-sides, in λ/E*. Its
/// error is about 1e-16 times the ratio of the distance to the shorter side, relative to the response at the centre.
pub(super) fn rectangle(offset: DVec2, half_sides: DVec2) -> [f64; 3] {
    let corners = [(1.0, 1.0), (-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)];
    let mut sum = [0.0; 3];
    for (sx, sy) in corners {
        let at = offset + half_sides * DVec2::new(sx, sy);
        let sign = sx * sy * FRAC_1_PI;
        sum[0] += sign * area(at.x, at.y);
        sum[1] += sign * area(at.y, at.x);
        sum[2] -= sign * at.length();
    }
    sum
}

/// A function with the mixed second derivative x²/r³: y asinh(x/|y|).
fn area(x: f64, y: f64) -> f64 {
    if y == 0.0 { 0.0 } else { y * (x / y.abs()).asinh() }
}

#[cfg(test)]
mod tests {
    use rc_kernel::love_rectangle_displacement;

    use super::*;

    #[test]
    fn the_parts_of_a_rectangle_add_up_to_the_normal_response() {
        // x²/r³ + y²/r³ = 1/r.
        let sides = DVec2::new(0.5, 0.3);
        for offset in [DVec2::ZERO, DVec2::new(0.5, 0.1), DVec2::new(-3.0, 2.0), DVec2::new(20.0, 0.0)] {
            let [xx, yy, _] = rectangle(offset, sides);
            let normal = love_rectangle_displacement(offset, sides);
            assert!((xx + yy - normal).abs() < 1e-13, "{offset}: {xx} + {yy} for {normal}");
        }
    }

    #[test]
    fn a_distant_rectangle_is_a_point() {
        let (offset, sides) = (DVec2::new(40.0, 30.0), DVec2::new(0.5, 0.5));
        let found = rectangle(offset, sides);
        let r = offset.length();
        let point =
            [offset.x * offset.x, offset.y * offset.y, offset.x * offset.y].map(|xy| xy * FRAC_1_PI / r.powi(3));
        for (found, point) in found.into_iter().zip(point) {
            // The next term of the expansion is smaller by (side/r)²/4.
            assert!((found / point - 1.0).abs() < 1e-4, "{found} for {point}");
        }
    }
}
