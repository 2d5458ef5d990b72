//! Axes of the pictures of curves.

use rc_core::quantity::Scale;

use crate::study::record::takes_prefix;

/// What a logarithmic axis of results shows, over its largest value: below is rounding.
pub(super) const ROUNDING: f64 = 1e-7;

/// An axis over the values that it has to show.
#[derive(Clone, Debug)]
pub(super) struct Axis {
    /// SI value of 1 on the axis.
    factor: f64,
    pub(super) label: String,
    pub(super) range: (f64, f64),
    pub(super) is_log: bool,
}

impl Axis {
    /// The axis for `values` (SI), with their name in words and their SI unit.
    ///
    /// A logarithmic one shows values from the part `log` of the largest.
    pub(super) fn of(words: &str, unit: &'static str, log: Option<f64>, values: impl Iterator<Item = f64>) -> Self {
        let is_log = log.is_some();
        let usable = values.filter(|value| value.is_finite() && (!is_log || *value > 0.0));
        let (low, high) = usable.fold((f64::INFINITY, 0.0_f64), |(low, high), v| (low.min(v), high.max(v)));
        let high = if high > 0.0 { high } else { 1.0 };
        let (factor, unit) = if unit.is_empty() || !takes_prefix(unit) {
            (1.0, unit.to_owned())
        } else {
            let scale = Scale::of(high, unit);
            (scale.factor, scale.unit())
        };
        let label = if unit.is_empty() { words.to_owned() } else { format!("{words} ({unit})") };
        let low = if low.is_finite() { low } else { high };
        let range = match log {
            Some(part) => ((low / 1.3).max(high * part) / factor, 1.3 * high / factor),
            None => (low.min(0.0) / factor, 1.05 * high / factor),
        };
        Self { factor, label, range, is_log }
    }

    /// The place of an SI value on the axis; `None` if it is not on it.
    pub(super) fn place(&self, value: f64) -> Option<f64> {
        let place = value / self.factor;
        (self.range.0..=self.range.1).contains(&place).then_some(place)
    }

    /// The place of an SI value, moved to the nearest end if it is not on the axis.
    pub(super) fn clamped(&self, value: f64) -> f64 {
        (value / self.factor).clamp(self.range.0, self.range.1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_have_prefixes_and_room_for_their_values() {
        let axis = Axis::of("mean pressure", "Pa", Some(ROUNDING), [1e4, 1e6, 0.0].into_iter());
        assert_eq!(axis.label, "mean pressure (MPa)");
        assert!(axis.range.0 < 0.01 && axis.range.1 > 1.0 && axis.place(0.0).is_none(), "{axis:?}");
        let axis = Axis::of("permeance", "m³", None, [1e-15].into_iter());
        assert_eq!((axis.label.as_str(), axis.range.0, axis.place(1e-15)), ("permeance (m³)", 0.0, Some(1e-15)));
        assert!((axis.clamped(9.0) - axis.range.1).abs() < 1e-30);
    }
}
