//! The material ratio curve of heights (Abbott and Firestone), and the parameters that ISO 25178-2 takes from it.

use rc_core::Field;

/// Number of heights of the curve, at equal steps of material ratio.
const CLASSES: usize = 10_000;

/// Width of the central region, in material ratio.
const CENTRAL: f64 = 0.4;

/// Height as a function of the part of the surface that is higher.
///
/// The curve is the quantile function of the measured heights from the highest (0) to the lowest (1), at 10 000 equal
/// steps, and linear between them. Heights are about any level, in any unit.
///
/// Source: ISO 25178-2, annex B.1, and ISO 13565-2. Test `parameters_are_those_of_surfalize`.
#[derive(Clone, Debug, PartialEq)]
pub struct MaterialRatio {
    heights: Vec<f64>,
}

/// Core, peaks and valleys: the parameters of the equivalent straight line through the middle of the curve.
///
/// Heights have the unit of the map, material ratios are from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoreParameters {
    /// Height Sk of the core.
    pub sk: f64,
    /// Reduced height Spk of the peaks above the core.
    pub spk: f64,
    /// Reduced depth Svk of the valleys below the core.
    pub svk: f64,
    /// Material ratio Smr1 between peaks and core.
    pub smr1: f64,
    /// Material ratio Smr2 between core and valleys.
    pub smr2: f64,
    /// Height of the equivalent line at the material ratio 0, the upper end of the core.
    pub top: f64,
}

impl MaterialRatio {
    /// The curve of `heights`, of which those that are `NaN` are missing. `None` if all are.
    #[must_use]
    pub fn of(heights: &Field) -> Option<Self> {
        let mut sorted: Vec<f64> = heights.values().iter().copied().filter(|height| !height.is_nan()).collect();
        sorted.sort_unstable_by(|a, b| b.total_cmp(a));
        let last = sorted.len().checked_sub(1)?;
        let quantile = |class: usize| between(&sorted, last as f64 * class as f64 / (CLASSES - 1) as f64);
        Some(Self { heights: (0..CLASSES).map(quantile).collect() })
    }

    /// The height that this part of the surface, from 0 to 1, is above.
    #[must_use]
    pub fn height(&self, ratio: f64) -> f64 {
        between(&self.heights, ratio.clamp(0.0, 1.0) * (CLASSES - 1) as f64)
    }

    /// The part of the surface above `height`.
    #[must_use]
    pub fn ratio(&self, height: f64) -> f64 {
        let after = self.heights.partition_point(|of_class| *of_class > height);
        if after == 0 || after == CLASSES {
            return if after == 0 { 0.0 } else { 1.0 };
        }
        let (above, below) = (self.heights[after - 1], self.heights[after]);
        ((after - 1) as f64 + (above - height) / (above - below)) / (CLASSES - 1) as f64
    }

    /// Material volume per area above the height of material ratio `ratio`: Vm = ∫ (h - h(ratio)) over the part above.
    #[must_use]
    pub fn material_volume(&self, ratio: f64) -> f64 {
        self.area_above(ratio) - ratio * self.height(ratio)
    }

    /// Void volume per area below the height of material ratio `ratio`: Vv = ∫ (h(ratio) - h) over the part below.
    #[must_use]
    pub fn void_volume(&self, ratio: f64) -> f64 {
        (1.0 - ratio) * self.height(ratio) - (self.area_above(1.0) - self.area_above(ratio))
    }

    /// Sk, Spk, Svk, Smr1 and Smr2.
    ///
    /// The central region is the 40 % of the curve with the smallest secant slope. The equivalent line fits its heights
    /// by least squares and ends at the material ratios 0 and 1. Peaks and valleys become triangles of equal area.
    #[must_use]
    pub fn core(&self) -> CoreParameters {
        let (top, bottom) = self.equivalent_line();
        let (smr1, smr2) = (self.ratio(top), self.ratio(bottom));
        let peaks = self.area_above(smr1) - smr1 * top;
        let valleys = (1.0 - smr2) * bottom - (self.area_above(1.0) - self.area_above(smr2));
        let triangle = |area: f64, base: f64| if area > 0.0 && base > 0.0 { 2.0 * area / base } else { 0.0 };
        let [spk, svk] = [triangle(peaks, smr1), triangle(valleys, 1.0 - smr2)];
        CoreParameters { sk: top - bottom, spk, svk, smr1, smr2, top }
    }

    /// Heights of the equivalent line at the material ratios 0 and 1.
    fn equivalent_line(&self) -> (f64, f64) {
        let step = 1.0 / (CLASSES - 1) as f64;
        let (mut first, mut flattest) = (0, f64::INFINITY);
        let windows = (0..CLASSES).take_while(|class| *class as f64 * step <= 1.0 - CENTRAL);
        for class in windows {
            let drop = self.heights[class] - self.height(class as f64 * step + CENTRAL);
            // The first of equal ones, as ISO 13565-2 has it.
            if drop < flattest {
                (first, flattest) = (class, drop);
            }
        }
        let last = ((first as f64 * step + CENTRAL) / step).floor() as usize;
        let points = &self.heights[first..=last.min(CLASSES - 1)];
        let n = points.len() as f64;
        let (middle, mean) = ((n - 1.0) / 2.0, points.iter().sum::<f64>() / n);
        let sums = points.iter().enumerate().fold([0.0; 2], |[xy, xx], (i, height)| {
            let x = i as f64 - middle;
            [xy + x * (height - mean), xx + x * x]
        });
        let slope = sums[0] / sums[1];
        let at = |class: f64| mean + slope * (class - first as f64 - middle);
        (at(0.0), at((CLASSES - 1) as f64))
    }

    /// ∫ h from the material ratio 0 to `ratio`.
    fn area_above(&self, ratio: f64) -> f64 {
        let place = ratio.clamp(0.0, 1.0) * (CLASSES - 1) as f64;
        let whole = place.floor() as usize;
        let classes: f64 = self.heights[..=whole].windows(2).map(|pair| 0.5 * (pair[0] + pair[1])).sum();
        let rest = (place - whole as f64) * 0.5 * (self.heights[whole] + between(&self.heights, place));
        (classes + rest) / (CLASSES - 1) as f64
    }
}

/// The value at a `place` between two of `values`.
fn between(values: &[f64], place: f64) -> f64 {
    let first = (place.floor() as usize).min(values.len() - 1);
    let second = (first + 1).min(values.len() - 1);
    values[first] + (place - first as f64) * (values[second] - values[first])
}

#[cfg(test)]
mod tests {
    use rc_core::Grid;

    use super::*;

    /// A ramp from 0 to 1 with a tenth of it raised to a peak and two tenths lowered to a valley, of slopes known.
    #[test]
    fn core_peaks_and_valleys_of_a_curve_of_three_lines() {
        let height = |ratio: f64| {
            let core = 1.0 - ratio;
            core + 30.0 * (0.1 - ratio).max(0.0) - 5.0 * (ratio - 0.8).max(0.0)
        };
        let field = Field::from_fn(Grid::new(1000, 100).expect("a grid"), |at| height(at.x));
        let curve = MaterialRatio::of(&field).expect("points");
        let core = curve.core();
        // The slope of the core is -1. Peaks rise 3 above it, valleys fall 1 below it, along straight lines that begin at
        // the ratios 0.1 and 0.8. The line from 1 to 0 is met by the peak where it leaves it.
        let expected = [
            ("Sk", core.sk, 1.0),
            // Above h = 1, the peak of slope -31 has a base of 3/31.
            ("Smr1", core.smr1, 3.0 / 31.0),
            ("Spk", core.spk, 3.0),
            ("Smr2", core.smr2, 0.8 + 0.2 / 6.0),
            ("Svk", core.svk, 1.0),
            ("Vm", curve.material_volume(0.1), 0.5 * 0.1 * 3.1),
            ("Vvv", curve.void_volume(0.8), 0.5 * 0.2 * 1.2),
            ("height", curve.height(0.5), 0.5),
            ("ratio", curve.ratio(0.5), 0.5),
        ];
        for (name, value, reference) in expected {
            assert!((value / reference - 1.0).abs() < 5e-3, "{name}: {value}, exact {reference}");
        }
    }

    #[test]
    fn a_constant_map_has_no_core_and_missing_points_do_not_count() {
        let grid = Grid::square(4).expect("a grid");
        let core = MaterialRatio::of(&Field::from_fn(grid, |_| 2.0)).expect("points").core();
        assert_eq!((core.sk, core.spk, core.svk), (0.0, 0.0, 0.0));
        assert_eq!(MaterialRatio::of(&Field::from_fn(grid, |_| f64::NAN)), None);
        let holed = Field::from_fn(grid, |at| if at.x < 0.5 { f64::NAN } else { at.y });
        let highest = MaterialRatio::of(&holed).expect("points").height(0.0);
        assert!((highest - 0.875).abs() < 1e-15, "{highest}");
    }
}
