//! Random combinations of features against what physics demands of every contact.

use std::f64::consts::TAU;
use std::sync::Arc;

use rand::{Rng as _, RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;
use rc_core::{DVec2, Field, Grid, HeightField, HeightSource, Kernel, Operator as _, Silent};
use rc_kernel::{FreeLove, Layer, Love, LoveLayer, Relaxation, Spectral, Substrate, Viscoelastic};
use rc_solver::{
    ContactProblem, Control, Feature, GaussSeidelParams, Held, Method, Quantity, ShearParams, Solution, SolveError,
    SolveParams, Status, UniformOperator, refusal,
};

use crate::hardness::rough;

/// Number of scenes.
const SCENES: usize = 40;

/// Tolerance of all solves, relative to the height range.
const TOLERANCE: f64 = 1e-6;

/// Bound on the difference of lengths from two solves or two operators, relative to the height range.
///
/// Each solve leaves its tolerance, and a fast operator 1e-6 of a displacement, twice.
const LENGTH: f64 = 1e-5;

/// Waves up to 5 per cell, which may be mirrored in y. Heights and lengths in λ.
#[derive(Clone)]
struct Waves {
    /// Amplitude, wavenumbers and phase of each.
    parts: Vec<[f64; 4]>,
    factor: f64,
    /// The side of the cell along y, if mirrored.
    mirrored: Option<f64>,
}

impl HeightField for Waves {
    fn height(&self, DVec2 { x, y }: DVec2) -> f64 {
        let y = self.mirrored.map_or(y, |side| side - y);
        let waves = self.parts.iter().map(|[a, kx, ky, phase]| a * (TAU * (kx * x + ky * y + phase)).cos());
        self.factor * waves.sum::<f64>()
    }

    fn band_limit(&self) -> Option<usize> {
        Some(5)
    }
}

/// A problem with its method.
#[derive(Clone)]
struct Scene {
    features: Vec<Feature>,
    kernel: Arc<dyn Kernel>,
    grid: Grid,
    surface: Waves,
    control: Control,
    hardness: f64,
    method: Method,
}

/// A solved scene with its heights.
struct Solved {
    solution: Solution<'static>,
    heights: Field,
}

impl Scene {
    /// A scene at random, if the table allows it.
    fn draw(random: &mut ChaCha8Rng) -> Option<Self> {
        let mut pick = |n: u32| random.next_u32() % n;
        let (mut features, method) =
            (Vec::new(), [Method::Adaptive, Method::Uniform, Method::GaussSeidel][pick(3) as usize]);
        let layer = Layer::on_rigid_base(0.3, 0.3);
        let coating = Layer { substrate: Some(Substrate { modulus: 3.0, poisson: 0.2 }), ..layer };
        let rubber = Relaxation::single(5.0, 0.1).expect("a material");
        let kernel: Arc<dyn Kernel> = match pick(8) {
            0 => (features.push(Feature::OwnKernel), Arc::new(Spectral) as _).1,
            1 => (features.push(Feature::Layer), Arc::new(LoveLayer(layer)) as _).1,
            2 => (features.extend([Feature::Coating, Feature::OtherSolid]), Arc::new(LoveLayer(coating)) as _).1,
            3 => (features.push(Feature::FreeBorders), Arc::new(FreeLove) as _).1,
            4 => (features.push(Feature::Sliding), Arc::new(Viscoelastic::new(Love, &rubber, 0.1 * DVec2::X)) as _).1,
            _ => Arc::new(Love),
        };
        let is_slow = method == Method::GaussSeidel;
        let grid = match pick(6) {
            0 => (features.push(Feature::OblongGrid), Grid::in_cell(128, 64, 0.5)).1,
            1 => (features.extend([Feature::OblongGrid, Feature::OblongElements]), Grid::in_cell(64, 48, 0.9)).1,
            2 => (features.push(Feature::UnevenGrid), Grid::square(if is_slow { 48 } else { 90 })).1,
            3 => (features.extend([Feature::Line, Feature::OblongGrid, Feature::OblongElements]), Grid::new(96, 1)).1,
            _ => Grid::square(if is_slow { 32 } else { 64 }),
        };
        for feature in [Feature::HeightMap, Feature::Hardness, Feature::BorderLevel, Feature::Penetration] {
            if pick(3) == 0 {
                features.push(feature);
            }
        }
        let has = |feature| features.contains(&feature);
        // A surface has a square cell; a lag on a grid that is not halved has no adaptive form; a profile has no border.
        let is_cut = has(Feature::OblongGrid) && !has(Feature::HeightMap)
            || has(Feature::Sliding) && (has(Feature::UnevenGrid) || has(Feature::OblongGrid))
            || has(Feature::Line) && has(Feature::FreeBorders);
        if is_cut || refusal(&features, Some(method)).is_some() {
            return None;
        }
        let mut uniform = |low: f64, high: f64| random.random_range(low..high);
        let waves = (0..6).map(|i| {
            let [kx, ky] = [uniform(-5.0, 5.0), uniform(-5.0, 5.0)].map(f64::round);
            let [kx, ky] = if kx.hypot(ky) > 5.0 || i == 0 { [1.0, 0.0] } else { [kx, ky] };
            [1e-3 * uniform(0.5, 1.5) / (1.0 + kx * kx + ky * ky), kx, ky, uniform(0.0, 1.0)]
        });
        let surface = Waves { parts: waves.collect(), factor: 1.0, mirrored: None };
        let part = uniform(0.02, 0.3);
        let control = if features.contains(&Feature::Penetration) {
            Control::Penetration(1e-3 * part)
        } else {
            Control::MeanPressure(4e-3 * part)
        };
        let hardness = if features.contains(&Feature::Hardness) { uniform(3e-3, 1e-2) } else { f64::INFINITY };
        Some(Self { features, kernel, grid: grid.expect("a grid"), surface, control, hardness, method })
    }

    fn has(&self, feature: Feature) -> bool {
        self.features.contains(&feature)
    }

    fn name(&self) -> String {
        format!("{} {:?} on {}, {:?}", self.method, self.features, self.grid, self.control)
    }

    fn params(&self) -> SolveParams {
        SolveParams {
            border_level: usize::from(self.has(Feature::BorderLevel)),
            gauss_seidel: GaussSeidelParams { uniform_elements: true, ..GaussSeidelParams::paper() },
            ..SolveParams::to_tolerance(TOLERANCE).by(self.method)
        }
    }

    /// Calls `solve` with the problem.
    fn with<T>(&self, solve: impl FnOnce(ContactProblem<'_>) -> T) -> T {
        let map = self.heights();
        let heights: HeightSource<'_> =
            if self.has(Feature::HeightMap) { (&map).into() } else { self.surface.on(self.grid) };
        let problem = ContactProblem::new(heights, self.control).with_kernel(&*self.kernel);
        solve(problem.with_hardness(self.hardness))
    }

    fn heights(&self) -> Field {
        Field::from_fn(self.grid, |at| self.surface.height(at))
    }

    fn solve(&self) -> Solved {
        let solution = self.with(|problem| problem.solve(&self.params(), &Silent).map(Solution::into_owned));
        let solution = solution.unwrap_or_else(|error| panic!("{}: {error}", self.name()));
        Solved { solution, heights: self.heights() }
    }

    /// The scene with heights, load and hardness times a factor.
    fn scaled(&self, factor: f64) -> Self {
        let surface = Waves { factor: factor * self.surface.factor, ..self.surface.clone() };
        Self { surface, hardness: factor * self.hardness, ..self.loaded(factor) }
    }

    /// The scene under its load or penetration times a factor.
    fn loaded(&self, factor: f64) -> Self {
        let control = match self.control {
            Control::MeanPressure(load) => Control::MeanPressure(factor * load),
            Control::Penetration(depth) => Control::Penetration(factor * depth),
        };
        Self { control, ..self.clone() }
    }
}

/// Ratio of a and b, minus 1.
fn apart(a: f64, b: f64) -> f64 {
    (a / b - 1.0).abs()
}

/// The conditions of a contact, from the pressure, the gap and another operator than that of the solve.
fn obeys(scene: &Scene, Solved { solution, heights }: &Solved) {
    let (name, info, observables) = (scene.name(), solution.info(), solution.observables());
    assert!(solution.status() != Status::NotConverged, "{name}");
    let range = heights.max() - heights.min();
    let (p, gap) = (solution.pressure(), solution.gap());
    assert!(p.values().iter().all(|p| (0.0..=scene.hardness * (1.0 + 1e-12)).contains(p)), "{name}: a pressure");
    assert!(info.certificate.penetration <= TOLERANCE, "{name}: {:?}", info.certificate);
    match scene.control {
        Control::MeanPressure(load) => {
            assert!(apart(p.mean(), load) < 1e-9 && apart(info.mean_pressure, load) < 1e-9, "{name}: the load");
        }
        Control::Penetration(depth) => {
            assert!((info.penetration - depth).abs() < TOLERANCE * range, "{name}: the penetration");
        }
    }
    assert!(gap.min() > -LENGTH * range, "{name}: the surfaces overlap by {:e} of {range:e}", -gap.min());
    let area = observables.area;
    assert!(area.fraction > 0.0 && area.fraction <= 1.0 && area.error >= 0.0, "{name}: {area:?}");
    assert!(area.fraction >= info.mean_pressure / scene.hardness, "{name}: no area for the load at this hardness");
    assert!(observables.max_pressure <= scene.hardness * (1.0 + 1e-12), "{name}");
    assert!(solution.stiffness() > 0.0 && info.elastic_energy > 0.0, "{name}: stiffness, energy");
    // Fields have means of smaller elements.
    if scene.has(Feature::BorderLevel) {
        return;
    }
    let work: f64 = p.values().iter().zip(gap.values()).map(|(p, g)| p * g).sum();
    assert!(work.abs() < LENGTH * range * p.mean() * p.values().len() as f64, "{name}: pressure across a gap");
    if scene.has(Feature::Sliding) {
        return;
    }
    let mut v = vec![0.0; p.values().len()];
    UniformOperator::new(scene.grid, &*scene.kernel).apply(p.values(), &mut v, &mut []);
    let energy = 0.5 * p.values().iter().zip(&v).map(|(p, v)| p * v).sum::<f64>() / v.len() as f64;
    assert!(apart(info.elastic_energy, energy) < 1e-5, "{name}: energy {:e}, {energy:e}", info.elastic_energy);
    let top = heights.max() - info.penetration;
    for ((v, h), (p, g)) in v.iter().zip(heights.values()).zip(p.values().iter().zip(gap.values())) {
        let fresh = v - h + top;
        // Flow has removed the overlap of a plastic element.
        let expected = if *p >= scene.hardness { fresh.max(0.0) } else { fresh };
        assert!((g - expected).abs() < LENGTH * range, "{name}: gap {g:e}, {expected:e}");
    }
}

/// More load is more penetration and, on a half-space, more contact. A power of two as factor changes no digit.
fn follows(scene: &Scene, solved: &Solved) {
    let (name, info) = (scene.name(), solved.solution.info());
    let more = scene.loaded(1.25).solve();
    let [depth, load] =
        [more.solution.info().penetration - info.penetration, more.solution.info().mean_pressure - info.mean_pressure];
    assert!(depth > 0.0 && load > 0.0, "{name}: {depth:e} for {load:e}");
    if !scene.has(Feature::Layer) && !scene.has(Feature::Sliding) {
        let [less, area] = [solved, &more].map(|solved| solved.solution.area().cells);
        assert!(area >= less, "{name}: {area} of contact after {less}");
    }
    let factor = 2.0_f64.powi(-30);
    let scaled = scene.scaled(factor).solve().solution;
    let same = scaled.pressure().values().iter().zip(solved.solution.pressure().values());
    assert!(
        same.into_iter().all(|(a, b)| a.to_bits() == (factor * b).to_bits()),
        "{name}: other digits in other units"
    );
    let mirrored = Waves { mirrored: Some(scene.grid.cell_ratio()), ..scene.surface.clone() };
    let mirrored = Scene { surface: mirrored, ..scene.clone() }.solve().solution;
    assert!(apart(mirrored.info().penetration, info.penetration) < 1e-4, "{name}: mirrored");
    assert!(apart(mirrored.info().mean_pressure, info.mean_pressure) < 1e-3, "{name}: mirrored");
    assert!(apart(mirrored.area().fraction, solved.solution.area().fraction) < 1e-2, "{name}: mirrored");
    let methods = [Method::Adaptive, Method::Uniform, Method::GaussSeidel].into_iter();
    let mut others = methods.filter(|other| *other != scene.method);
    let Some(method) = others.find(|other| refusal(&scene.features, Some(*other)).is_none()) else { return };
    let other = Scene { method, ..scene.clone() }.solve().solution;
    assert!(apart(other.info().penetration, info.penetration) < 1e-4, "{name}: another method");
    assert!(apart(other.info().mean_pressure, info.mean_pressure) < 1e-3, "{name}: another method");
}

/// What comes after a solve, where the table allows it: gradients, friction, and a history of loads.
fn goes_on(scene: &Scene, Solved { solution, heights }: &Solved) -> [bool; 3] {
    let (name, info) = (scene.name(), solution.info());
    let allows = |feature| {
        refusal(&[&scene.features[..], &[feature]].concat(), Some(scene.method)).is_none()
            && solution.status() == Status::Converged
    };
    let done = [Feature::Gradient, Feature::Shear, Feature::History].map(|feature| match feature {
        Feature::History => allows(feature) && scene.hardness.is_finite(),
        _ => allows(feature),
    });
    if done[0] {
        // Euler: the penetration is of the first order in heights and load together.
        let gradient = solution.gradient(Quantity::Penetration, Some(Held::MeanPressure)).expect("a gradient");
        let by_heights: f64 = gradient.values().iter().zip(heights.values()).map(|(g, h)| g * h).sum();
        let by_load = info.mean_pressure / solution.stiffness();
        let sum = by_heights + by_load;
        assert!((sum - info.penetration).abs() < 2e-3 * by_load, "{name}: {sum:e} for {:e}", info.penetration);
    }
    if done[1] {
        let (friction, shear) = (0.3, 0.15 * info.mean_pressure);
        let sheared = scene.with(|problem| {
            let plan = problem.plan(&scene.params()).expect("a plan");
            plan.shear(solution, &ShearParams::new(friction, shear), &Silent)
        });
        let sheared = sheared.unwrap_or_else(|error| panic!("{name}: {error}"));
        assert!(apart(sheared.info.mean_shear, shear) < 1e-9, "{name}: {:?}", sheared.info);
        let tractions = sheared.traction[0].values().iter().zip(sheared.traction[1].values());
        for ((x, y), p) in tractions.zip(solution.pressure().values()) {
            assert!(x.hypot(*y) <= friction * p * (1.0 + 1e-9), "{name}: a traction above friction");
        }
        let area = sheared.info.slip_area + sheared.info.stick_area;
        assert!(
            apart(area, solution.area().fraction) < 1e-9 && sheared.info.slip_work >= 0.0,
            "{name}: {:?}",
            sheared.info
        );
    }
    if done[2] {
        let load = info.mean_pressure;
        let by = |loads: &[f64]| {
            let found = scene.with(|problem| {
                let found = problem.solve_history(loads, &scene.params(), &Silent)?;
                Ok::<_, SolveError>((found.solution.plastic_gap().mean(), found.residual))
            });
            found.unwrap_or_else(|error| panic!("{name} after {loads:?}: {error}"))
        };
        let ((flow, once), (again, twice)) = (by(&[load, 0.0]), by(&[load, 0.0, load]));
        assert!(again <= 1e-2 * flow + LENGTH * (heights.max() - heights.min()), "{name}: flows {flow:e}, {again:e}");
        for ((h, once), twice) in heights.values().iter().zip(once.values()).zip(twice.values()) {
            assert!(once <= h && twice <= once, "{name}: flow raises the surface");
        }
    }
    done
}

#[test]
fn random_combinations_of_features_obey_physics() {
    let mut random = ChaCha8Rng::seed_from_u64(34);
    let (mut counts, mut seen, mut solved) = ([0; 3], std::collections::HashSet::new(), 0);
    while solved < SCENES {
        let Some(scene) = Scene::draw(&mut random) else { continue };
        let found = scene.solve();
        obeys(&scene, &found);
        follows(&scene, &found);
        let done = goes_on(&scene, &found);
        counts.iter_mut().zip(done).for_each(|(count, done)| *count += usize::from(done));
        seen.extend(scene.features.iter().copied());
        solved += 1;
    }
    // Each feature and each of the three afterwards is part of some scene.
    assert!(seen.len() == 14 && counts.iter().all(|count| *count >= 3), "{seen:?}, {counts:?}");
}

/// Relative rms difference of two pressures.
fn distance(a: &Field, b: impl Iterator<Item = f64>) -> f64 {
    let [mut difference, mut size] = [0.0; 2];
    for (a, b) in a.values().iter().zip(b) {
        difference += (a - b) * (a - b);
        size += b * b;
    }
    (difference / size).sqrt()
}

fn solve(
    heights: &Field,
    (kernel, method): (&dyn Kernel, Method),
    control: Control,
    hardness: f64,
) -> Solution<'static> {
    let params = SolveParams::to_tolerance(if method == Method::Adaptive { 1e-8 } else { 1e-10 }).by(method);
    let problem = ContactProblem::new(heights, control).with_kernel(kernel).with_hardness(hardness);
    problem.solve(&params, &Silent).expect("a contact").into_owned()
}

#[test]
fn motions_of_the_heights_move_the_pressure() {
    /// From an element (x, y) to the one that moves there.
    type Motion = fn(usize, usize, usize) -> (usize, usize);
    let motions: [(&str, Motion); 6] = [
        ("moved by one element along x", |x, y, n| ((x + 1) % n, y)),
        ("moved by 17 and 5 elements", |x, y, n| ((x + 17) % n, (y + 5) % n)),
        ("transposed", |x, y, _| (y, x)),
        ("reflected in x", |x, y, n| (n - 1 - x, y)),
        ("reflected in y", |x, y, n| (x, n - 1 - y)),
        ("turned by a quarter", |x, y, n| (n - 1 - y, x)),
    ];
    let heights = rough(12, 64, 8);
    let load = Control::MeanPressure(1e-3);
    for by in [(&Love as &dyn Kernel, Method::Uniform), (&Spectral, Method::Uniform), (&Love, Method::Adaptive)] {
        let plain = solve(&heights, by, load, f64::INFINITY);
        for (name, from) in motions {
            let moved = |field: &Field| {
                let n = field.grid().nx();
                let values = (0..n * n).map(|i| from(i % n, i / n, n)).map(|(x, y)| field.at(x, y));
                Field::new(field.grid(), values.collect()).expect("a value for each element")
            };
            let other = solve(&moved(&heights), by, load, f64::INFINITY);
            let error = distance(other.pressure(), moved(plain.pressure()).values().iter().copied());
            assert!(error < 1e-6, "{} {name}: {error:e}", by.1);
            assert!(apart(other.info().penetration, plain.info().penetration) < 1e-7, "{} {name}", by.1);
        }
    }
}

/// A uniform pressure displaces nothing. So the pressure H - p, with the rest of the load, solves the problem of the
/// surface upside down, and gaps change their sign.
#[test]
fn a_contact_with_a_hardness_upside_down_has_the_rest_of_the_pressure() {
    let heights = rough(52, 64, 8);
    let upside_down = Field::new(heights.grid(), heights.values().iter().map(|h| -h).collect()).expect("a map");
    for kernel in [&Love as &dyn Kernel, &Spectral] {
        for (hardness, part) in [(1e-2, 0.1), (4e-3, 0.4), (4e-2, 0.5)] {
            let under = |heights, part: f64| {
                solve(heights, (kernel, Method::Uniform), Control::MeanPressure(part * hardness), hardness)
            };
            let (plain, turned) = (under(&heights, part), under(&upside_down, 1.0 - part));
            let name = format!("{} {hardness:.0e} {part}", kernel.name());
            // Pressures vary with the slope of the gap, so they differ much more than gaps.
            let error = distance(plain.pressure(), turned.pressure().values().iter().map(|q| hardness - q));
            assert!(error < 1e-5, "{name}: {error:e}");
            // Both are h_max - Δ, the gap of elements in contact.
            let [one, other] = [(&heights, &plain), (&upside_down, &turned)]
                .map(|(heights, solution)| heights.max() - solution.info().penetration);
            assert!((one + other).abs() < 1e-7 * heights.rms(), "{name}: gaps {one:e}, {other:e}");
            assert!(apart(plain.info().elastic_energy, turned.info().elastic_energy) < 1e-5, "{name}: energy");
            assert!(apart(plain.stiffness(), turned.stiffness()) < 5e-3, "{name}: stiffness");
        }
    }
}
