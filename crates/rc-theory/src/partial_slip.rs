//! Partial slip from a load curve: shear curve, slip area, loops and their losses.
//!
//! Two bodies are pressed together by σ0 and then sheared by τ < μσ0. If pressure and shear are not coupled and both
//! stiffnesses are alike, the traction is the pressure under σ0 minus that under σ0 - τ/μ, times μ. So the load curve
//! Δ(σ0) gives the shear curve
//!
//! d(τ) = μ (Δ(σ0) - Δ(σ0 - τ/μ)),
//!
//! whatever the surface (Ciavarella, J. Mech. Phys. Solids 46, 1998, 411; Jäger, Arch. Appl. Mech. 68, 1998, 335). It is
//! exact for ν = 0, and for any ν in plane strain along a profile. Otherwise Mindlin's ratio of compliances, (2 - ν)/(2 (1 - ν)),
//! multiplies d, which is an approximation where the contact slips. An oscillation between ±τ has loops by Masing's rule.
//!
//! Loads and lengths have any units: stiffnesses are loads per length.

use thiserror::Error;

/// The smallest number of loads of a curve.
pub const FEWEST_LOADS: usize = 4;

/// Points and weights of Gauss's rule on [-1, 1] for polynomials up to degree 9.
const GAUSS: [(f64, f64); 5] = [
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683, 0.478_628_670_499_366_5),
    (-0.538_469_310_105_683, 0.478_628_670_499_366_5),
    (0.906_179_845_938_664, 0.236_926_885_056_189_1),
    (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
];

/// Parts of an interval between loads, on each of which Gauss's rule is used.
const PARTS: usize = 4;

/// A contact under one load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadPoint {
    /// Mean pressure σ0.
    pub load: f64,
    /// Penetration Δ.
    pub penetration: f64,
    /// Stiffness dσ0/dΔ, if it is known. It is infinite in full contact.
    pub stiffness: Option<f64>,
    /// Contact area, relative to the nominal area.
    pub area: f64,
}

/// Why points are not a load curve.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum LoadCurveError {
    /// There are too few points.
    #[error("it has {n} loads, and a shear curve needs at least {FEWEST_LOADS}")]
    TooFew {
        /// Their number.
        n: usize,
    },
    /// A load is not above the one before, or not positive.
    #[error("its loads must be positive and increase from row to row, but {after:.4e} follows {before:.4e}")]
    Loads {
        /// The load before.
        before: f64,
        /// The load.
        after: f64,
    },
    /// A penetration is below the one before.
    #[error("its penetration must not decrease, but {after:.4e} follows {before:.4e}")]
    Penetrations {
        /// The penetration before.
        before: f64,
        /// The penetration.
        after: f64,
    },
}

/// Δ and A as functions of the load, between its loads.
///
/// Both are cubic polynomials of ln σ0 on each interval. They are monotone (Fritsch & Carlson, SIAM J. Numer. Anal. 17,
/// 1980, 238). The slopes of Δ follow from the stiffness where it is known, and from neighbours elsewhere.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadCurve {
    loads: Vec<f64>,
    penetration: Monotone,
    area: Monotone,
}

/// A shear of the contact under the largest load of a [`LoadCurve`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction {
    /// Coulomb's coefficient μ.
    pub coefficient: f64,
    /// Ratio of tangential to normal compliance, 1 for ν = 0.
    pub compliance_ratio: f64,
}

/// A contact under a shear τ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShearPoint {
    /// Shear force per nominal area τ.
    pub shear: f64,
    /// Tangential displacement d.
    pub displacement: f64,
    /// Stiffness dτ/dd.
    pub stiffness: f64,
    /// Area that slips, relative to the nominal area.
    pub slip_area: f64,
    /// Area that sticks, relative to the nominal area.
    pub stick_area: f64,
    /// Energy per nominal area that a cycle between ±τ dissipates, 4 τ d - 8 ∫₀^τ d dτ'.
    pub loss: f64,
}

impl LoadCurve {
    /// The curve through these points.
    ///
    /// # Errors
    /// [`LoadCurveError`] for less than [`FEWEST_LOADS`] points, for loads that do not increase and for penetrations that
    /// decrease. Values that are not numbers do neither.
    pub fn new(points: &[LoadPoint]) -> Result<Self, LoadCurveError> {
        if points.len() < FEWEST_LOADS {
            return Err(LoadCurveError::TooFew { n: points.len() });
        }
        let mut before = LoadPoint { load: 0.0, penetration: f64::NEG_INFINITY, stiffness: None, area: 0.0 };
        for &point in points {
            if !(point.load > before.load && point.load.is_finite()) {
                return Err(LoadCurveError::Loads { before: before.load, after: point.load });
            }
            if !(point.penetration >= before.penetration && point.penetration.is_finite()) {
                return Err(LoadCurveError::Penetrations { before: before.penetration, after: point.penetration });
            }
            before = point;
        }
        Ok(Self::of(points))
    }

    /// The curve through at least two points, which have been checked.
    fn of(points: &[LoadPoint]) -> Self {
        let loads: Vec<f64> = points.iter().map(|point| point.load).collect();
        let x: Vec<f64> = loads.iter().map(|load| load.ln()).collect();
        // dΔ/d(ln σ0) = σ0/(dσ0/dΔ).
        let slopes = points.iter().map(|point| point.stiffness.filter(|k| *k > 0.0).map(|k| point.load / k)).collect();
        let of = |value: fn(&LoadPoint) -> f64| points.iter().map(value).collect();
        Self {
            loads,
            penetration: Monotone::new(x.clone(), of(|point| point.penetration), slopes),
            area: Monotone::new(x, of(|point| point.area), vec![None; points.len()]),
        }
    }

    /// The largest load σ0.
    #[must_use]
    pub fn largest_load(&self) -> f64 {
        self.loads[self.loads.len() - 1]
    }

    /// The largest shear that the curve reaches, μ (σ0 - the smallest load). Sliding begins at μσ0.
    #[must_use]
    pub fn largest_shear(&self, friction: Friction) -> f64 {
        friction.coefficient * (self.largest_load() - self.loads[0])
    }

    /// The contact under the shear τ, up to [`LoadCurve::largest_shear`].
    #[must_use]
    pub fn sheared(&self, friction: Friction, shear: f64) -> ShearPoint {
        let Friction { coefficient, compliance_ratio } = friction;
        let load = self.largest_load();
        let left = (load - shear / coefficient).clamp(self.loads[0], load);
        let [deep, shallow] = [load, left].map(|load| self.penetration.at(load.ln()));
        let factor = coefficient * compliance_ratio;
        let displacement = factor * (deep[0] - shallow[0]);
        let area = self.area.at(load.ln())[0];
        let stick_area = self.area.at(left.ln())[0];
        ShearPoint {
            shear,
            displacement,
            stiffness: left / (shallow[1] * compliance_ratio),
            slip_area: area - stick_area,
            stick_area,
            // 8 (½ τ d - ∫₀^τ d dτ').
            loss: if left < load { 8.0 * factor * coefficient * self.curved(left) } else { 0.0 },
        }
    }

    /// The difference of the displacement under the shear τ to that of the curve through every second load.
    ///
    /// The largest load and the smallest stay. It tells how much the spacing of the loads matters: the error of the
    /// curve itself is smaller, by the square of the ratio of spacings or more.
    #[must_use]
    pub fn spacing_error(&self, friction: Friction, shears: &[f64]) -> Vec<f64> {
        let n = self.loads.len();
        let kept: Vec<usize> = (0..n).filter(|&i| i == 0 || (n - 1 - i).is_multiple_of(2)).collect();
        let pick = |values: &[f64]| -> Vec<f64> { kept.iter().map(|&i| values[i]).collect() };
        let coarser = |curve: &Monotone| {
            let slopes = kept.iter().map(|&i| curve.given[i]).collect();
            Monotone::new(pick(&curve.x), pick(&curve.y), slopes)
        };
        let coarse =
            Self { loads: pick(&self.loads), penetration: coarser(&self.penetration), area: coarser(&self.area) };
        let difference = |&shear: &f64| {
            let [fine, coarse] = [self, &coarse].map(|curve| curve.sheared(friction, shear).displacement);
            (fine - coarse).abs()
        };
        shears.iter().map(difference).collect()
    }

    /// ∫ ((Δ0 - Δ') (σ0 - σ)/(σ0 - σ') - Δ0 + Δ(σ)) dσ from σ' = `left` to the largest load σ0.
    ///
    /// It is the area between the shear curve and its chord, which small shears do not lose to rounding.
    fn curved(&self, left: f64) -> f64 {
        let load = self.largest_load();
        let [deep, shallow] = [load, left].map(|load| self.penetration.at(load.ln())[0]);
        let slope = (deep - shallow) / (load - left);
        let ends: Vec<f64> =
            std::iter::once(left).chain(self.loads.iter().copied().filter(|end| *end > left)).collect();
        let of_part = |from: f64, width: f64| {
            let value = |(point, weight): (f64, f64)| {
                let x = from + 0.5 * width * (1.0 + point);
                let bent = slope * (load - x.exp()) - (deep - self.penetration.at(x)[0]);
                0.5 * width * weight * bent * x.exp()
            };
            GAUSS.into_iter().map(value).sum::<f64>()
        };
        let of_interval = |ends: &[f64]| {
            let (from, width) = (ends[0].ln(), (ends[1] / ends[0]).ln() / PARTS as f64);
            (0..PARTS).map(|i| of_part(from + i as f64 * width, width)).sum::<f64>()
        };
        ends.windows(2).map(of_interval).sum()
    }
}

/// The points of a loop between ±τ, by Masing's rule: first down, then up.
///
/// `shear_curve` has τ and d of the first shear, from 0 on. Its last point is the amplitude. From it on, d decreases by
/// twice the displacement of half the change of τ.
#[must_use]
pub fn masing_loop(shear_curve: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let Some(&[tau, d]) = shear_curve.last() else { return Vec::new() };
    let down = shear_curve.iter().map(|point| [tau - 2.0 * point[0], d - 2.0 * point[1]]);
    let up = shear_curve.iter().map(|point| [2.0 * point[0] - tau, 2.0 * point[1] - d]);
    down.chain(up).collect()
}

/// A monotone cubic interpolation.
#[derive(Clone, Debug, PartialEq)]
struct Monotone {
    x: Vec<f64>,
    y: Vec<f64>,
    slopes: Vec<f64>,
    /// Slopes as they were given.
    given: Vec<Option<f64>>,
}

impl Monotone {
    /// At least two points with increasing `x`. Slopes that are not given follow from neighbours.
    fn new(x: Vec<f64>, y: Vec<f64>, given: Vec<Option<f64>>) -> Self {
        let secants: Vec<f64> = (1..x.len()).map(|i| (y[i] - y[i - 1]) / (x[i] - x[i - 1])).collect();
        let of_neighbours = |i: usize| match (i.checked_sub(1).map(|i| secants[i]), secants.get(i)) {
            (Some(before), Some(&after)) if before * after > 0.0 => {
                let [h, k] = [x[i] - x[i - 1], x[i + 1] - x[i]];
                let [a, b] = [h + 2.0 * k, 2.0 * h + k];
                (a + b) / (a / before + b / after)
            }
            (Some(_), Some(_)) | (None, None) => 0.0,
            (None, Some(&first)) => end_slope(
                [x[1] - x[0], x.get(2).map_or(0.0, |far| far - x[1])],
                [first, *secants.get(1).unwrap_or(&first)],
            ),
            (Some(last), None) => {
                let before = i.checked_sub(2);
                let far = before.map_or(0.0, |j| x[i - 1] - x[j]);
                end_slope([x[i] - x[i - 1], far], [last, before.map_or(last, |j| secants[j])])
            }
        };
        let mut slopes: Vec<f64> =
            given.iter().enumerate().map(|(i, slope)| slope.unwrap_or_else(|| of_neighbours(i))).collect();
        for (i, secant) in secants.iter().enumerate() {
            // A cubic is monotone if its end slopes, over the secant, lie in a circle of radius 3.
            let length = slopes[i].hypot(slopes[i + 1]);
            if length > 3.0 * secant.abs() {
                let factor = if length > 0.0 { 3.0 * secant.abs() / length } else { 0.0 };
                slopes[i] *= factor;
                slopes[i + 1] *= factor;
            }
        }
        Self { x, y, slopes, given }
    }

    /// Value and slope at `x`, which is between the first and the last point.
    fn at(&self, x: f64) -> [f64; 2] {
        let i = self.x.partition_point(|&other| other <= x).clamp(1, self.x.len() - 1);
        let width = self.x[i] - self.x[i - 1];
        let t = ((x - self.x[i - 1]) / width).clamp(0.0, 1.0);
        let [a, b] = [self.y[i - 1], self.y[i]];
        let [s, e] = [self.slopes[i - 1] * width, self.slopes[i] * width];
        let rise = b - a;
        let value = a + t * (s + t * (3.0 * rise - 2.0 * s - e + t * (s + e - 2.0 * rise)));
        let slope = s + t * (2.0 * (3.0 * rise - 2.0 * s - e) + 3.0 * t * (s + e - 2.0 * rise));
        [value, slope / width]
    }
}

/// The slope at an end, of the parabola through three points, from the secants of its nearer and its farther interval.
fn end_slope([near, far]: [f64; 2], [secant, other]: [f64; 2]) -> f64 {
    let slope = ((2.0 * near + far) * secant - near * other) / (near + far);
    if slope * secant > 0.0 { slope } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RUBBER: Friction = Friction { coefficient: 0.4, compliance_ratio: 1.0 };

    /// `n` loads over `decades` decades up to 1, with this penetration and stiffness.
    fn curve(n: usize, decades: f64, of: impl Fn(f64) -> LoadPoint) -> LoadCurve {
        let load = |i: usize| 10_f64.powf(decades * (i as f64 / (n - 1) as f64 - 1.0));
        LoadCurve::new(&(0..n).map(|i| of(load(i))).collect::<Vec<_>>()).expect("a load curve")
    }

    fn exponential(load: f64) -> LoadPoint {
        // σ0 ∝ exp(Δ/u0) with u0 = 2 and Δ = 20 at the load 1.
        LoadPoint { load, penetration: 20.0 + 2.0 * load.ln(), stiffness: Some(load / 2.0), area: load }
    }

    fn hertz(load: f64) -> LoadPoint {
        let penetration = load.powf(2.0 / 3.0);
        LoadPoint { load, penetration, stiffness: Some(1.5 * load / penetration), area: 0.1 * penetration }
    }

    #[test]
    fn an_exponential_load_curve_has_its_closed_form() {
        let curve = curve(4, 3.0, exponential);
        for part in [0.01, 0.3, 0.9, 0.99] {
            let tau = part * RUBBER.coefficient;
            let found = curve.sheared(RUBBER, tau);
            let expected = -RUBBER.coefficient * 2.0 * (-part).ln_1p();
            assert!((found.displacement / expected - 1.0).abs() < 1e-12, "{part}: {found:?}");
            let stiffness = (1.0 - part) / 2.0;
            assert!((found.stiffness / stiffness - 1.0).abs() < 1e-12, "{part}: {found:?}");
            // ∫ -ln(1 - s) ds = (1 - s) ln(1 - s) + s.
            let integral = RUBBER.coefficient.powi(2) * 2.0 * ((1.0 - part) * (-part).ln_1p() + part);
            let loss = 4.0 * tau * expected - 8.0 * integral;
            assert!((found.loss - loss).abs() < 1e-9 * tau * expected, "{part}: {} for {loss}", found.loss);
        }
    }

    #[test]
    fn mindlins_sphere_from_few_loads() {
        let friction = Friction { coefficient: 0.3, compliance_ratio: 1.7 / 1.4 };
        let (few, many) = (curve(6, 2.0, hertz), curve(24, 2.0, hertz));
        for part in [0.1, 0.5, 0.9] {
            let tau = part * friction.coefficient;
            let expected = friction.coefficient * friction.compliance_ratio * (1.0 - (1.0 - part).powf(2.0 / 3.0));
            let errors = [&few, &many].map(|curve| {
                let found = curve.sheared(friction, tau);
                let error = (found.displacement - expected).abs();
                let stated = curve.spacing_error(friction, &[tau])[0];
                assert!(error <= stated, "{part}: {error:e} for {stated:e}");
                error / expected
            });
            // The interpolation is of fourth order in the spacing of ln σ0, which is 4.6 times finer.
            assert!(errors[0] < 2e-3 && errors[1] < 0.05 * errors[0] + 1e-12, "{part}: {errors:?}");
        }
    }

    /// Without stiffnesses, slopes come from neighbours.
    #[test]
    fn a_curve_without_stiffness_is_less_accurate_and_monotone() {
        let curve = curve(12, 2.0, |load| LoadPoint { stiffness: None, ..hertz(load) });
        let taus: Vec<f64> = (0..=100).map(|i| 0.0099 * RUBBER.coefficient * f64::from(i)).collect();
        let points: Vec<ShearPoint> = taus.iter().map(|&tau| curve.sheared(RUBBER, tau)).collect();
        assert!(points.windows(2).all(|pair| pair[1].displacement > pair[0].displacement));
        assert!(points.windows(2).all(|pair| pair[1].slip_area > pair[0].slip_area && pair[1].loss >= pair[0].loss));
        for (point, tau) in points.iter().zip(&taus).skip(1) {
            let expected = RUBBER.coefficient * (1.0 - (1.0 - tau / RUBBER.coefficient).powf(2.0 / 3.0));
            // The slope at the largest load has the error (2h/3)²/3 for the spacing h = 0.42 of ln σ0.
            assert!((point.displacement / expected - 1.0).abs() < 2.6e-2, "{tau}: {point:?}");
            assert!((point.slip_area + point.stick_area - 0.1).abs() < 1e-12);
        }
    }

    #[test]
    fn the_loss_is_the_area_of_masings_loop() {
        let curve = curve(8, 2.0, hertz);
        let tau = 0.8 * RUBBER.coefficient;
        let first: Vec<[f64; 2]> = (0..=4000)
            .map(|i| curve.sheared(RUBBER, tau * f64::from(i) / 4000.0))
            .map(|point| [point.shear, point.displacement])
            .collect();
        let closed = masing_loop(&first);
        // The loop is closed, and its area is the sum of trapezia.
        let area: f64 = closed.windows(2).map(|pair| 0.5 * (pair[0][0] + pair[1][0]) * (pair[1][1] - pair[0][1])).sum();
        let loss = curve.sheared(RUBBER, tau).loss;
        assert!((area.abs() / loss - 1.0).abs() < 1e-5, "{area} for {loss}");
        assert!((closed[0][1] - closed[closed.len() - 1][1]).abs() < 1e-12);
    }

    #[test]
    fn what_is_no_load_curve_is_refused() {
        let points: Vec<LoadPoint> = [0.1, 0.2, 0.5, 1.0].map(hertz).to_vec();
        assert_eq!(LoadCurve::new(&points[1..]), Err(LoadCurveError::TooFew { n: 3 }));
        let with = |i: usize, point: LoadPoint| {
            let mut points = points.clone();
            points[i] = point;
            LoadCurve::new(&points).expect_err("no load curve")
        };
        assert!(matches!(with(2, hertz(0.2)), LoadCurveError::Loads { .. }));
        assert!(matches!(with(0, hertz(0.0)), LoadCurveError::Loads { .. }));
        assert!(matches!(with(3, hertz(f64::NAN)), LoadCurveError::Loads { .. }));
        let sunk = LoadPoint { penetration: 0.0, ..points[2] };
        assert!(matches!(with(2, sunk), LoadCurveError::Penetrations { .. }));
    }
}
