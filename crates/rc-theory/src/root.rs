//! The root of an increasing function.
//!
//! It serves formulas that are explicit in the opposite direction.

/// Maximum number of steps, far more than bisection needs for all bits of an `f64`.
const MAX_STEPS: usize = 200;

/// The x in [`low`, `high`] where an increasing function is 0.
///
/// The function returns (value, derivative). Newton's method begins at `start`. It bisects whenever a step would leave
/// the interval that is known to contain the root. The result is accurate to a few units in the last place of x, or to
/// the rounding of the function if this is coarser.
pub(crate) fn increasing_root(
    (mut low, mut high): (f64, f64),
    start: f64,
    function: impl Fn(f64) -> (f64, f64),
) -> f64 {
    let mut x = start.clamp(low, high);
    for _ in 0..MAX_STEPS {
        let (value, derivative) = function(x);
        if value == 0.0 {
            break;
        }
        if value > 0.0 {
            high = x;
        } else {
            low = x;
        }
        let newton = x - value / derivative;
        let next = if (low..=high).contains(&newton) { newton } else { low.midpoint(high) };
        let step = (next - x).abs();
        x = next;
        if step <= 2.0 * f64::EPSILON * x.abs() {
            break;
        }
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn newton_finds_a_smooth_root() {
        let root = increasing_root((0.0, 2.0), 1.0, |x| (x * x - 2.0, 2.0 * x));
        assert!((root - 2.0_f64.sqrt()).abs() <= 4.0 * f64::EPSILON, "{root}");
    }

    #[test]
    fn bisection_takes_over_where_the_derivative_misleads() {
        let root = increasing_root((-1.0, 8.0), 8.0, |x: f64| (x.atan() - 0.5, 1.0 / (1.0 + x * x)));
        assert!((root - 0.5_f64.tan()).abs() <= 4.0 * f64::EPSILON, "{root}");
        let flat = increasing_root((-1.0, 3.0), 0.0, |x: f64| ((x - 1.0).powi(3), 3.0 * (x - 1.0).powi(2)));
        assert!((flat - 1.0).abs() <= 1e-12, "{flat}");
    }
}
