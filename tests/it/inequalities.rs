//! What is certain of the numbers of every solution.

use rayon::prelude::*;
use rc_core::testing::quasi_random;
use rc_core::{Grid, HeightField as _, Kernel, Silent};
use rc_fractal::{Normalisation, SpectrumParams, Surface};
use rc_kernel::{FreeLove, Layer, Love, LoveLayer, Spectral, SpectralLayer};
use rc_solver::{ContactProblem, Control, Method, Solution, SolveError, SolveParams, Status};

/// Number of scenes.
const SCENES: usize = 2000;

/// A body, a surface, a load and a hardness, from the numbers of a sequence.
struct Scene {
    kernel: Box<dyn Kernel + Sync>,
    surface: Surface,
    grid: Grid,
    control: Control,
    hardness: f64,
}

impl Scene {
    fn new(index: usize) -> Self {
        let random = |i: usize| quasi_random(7919 * index + i);
        let between = |i: usize, low: f64, high: f64| low * (high / low).powf(random(i));
        let waves = [2, 3, 4][index % 3];
        let hurst = 0.3 + 0.6 * random(1);
        let normalisation = Normalisation::RmsHeight(0.01);
        let params = SpectrumParams { hurst, normalisation, ..SpectrumParams::paper(waves, index as u64) };
        let surface = Surface::new(&params).expect("a surface");
        let layer = Layer::on_rigid_base(between(2, 0.05, 0.5), 0.3);
        let kernel: Box<dyn Kernel + Sync> = match index % 5 {
            0 => Box::new(Love),
            1 => Box::new(Spectral),
            2 => Box::new(FreeLove),
            3 => Box::new(LoveLayer(layer)),
            _ => Box::new(SpectralLayer(layer)),
        };
        let mean = between(3, 1e-5, 0.3);
        let hardness = if random(4) < 0.5 { f64::INFINITY } else { mean * (1.0 + between(5, 1e-2, 1e2)) };
        let control =
            if random(6) < 0.7 { Control::MeanPressure(mean) } else { Control::Penetration(0.02 * random(7) + 1e-4) };
        Self { kernel, surface, grid: Grid::square(32).expect("a grid"), control, hardness }
    }

    fn solve(&self, method: Method) -> Result<Solution<'_>, SolveError> {
        let problem = ContactProblem::new(self.surface.on(self.grid), self.control)
            .with_kernel(&*self.kernel)
            .with_hardness(self.hardness);
        problem.solve(&SolveParams::certified().by(method), &Silent)
    }
}

/// The inequalities that one solution violates.
fn violated(solution: &Solution<'_>) -> Vec<&'static str> {
    let (found, hardness) = (solution.observables(), solution.hardness());
    let (area, mean) = (found.area.fraction, solution.info().mean_pressure);
    let plastic = found.plastic.map_or(0.0, |plastic| plastic.fraction);
    let close = |a: f64, b: f64| (a - b).abs() <= 1e-9 * b.abs() + 1e-15;
    let is_full = solution.status() == Status::FullContact;
    let laws = [
        ("the area is above zero", area > 0.0 && area <= 1.0),
        ("the area carries the load", area >= mean / hardness * (1.0 - 1e-12)),
        ("the plastic area is in the contact area", (0.0..=area).contains(&plastic)),
        ("gaps are not negative", solution.gap().min() >= 0.0 && found.mean_gap >= 0.0),
        (
            "pressures are between zero and the hardness",
            solution.pressure().min() >= 0.0 && found.max_pressure <= hardness,
        ),
        ("the mean of p is the load", close(solution.pressure().mean(), mean)),
        ("the rms pressure is at least the mean", found.rms_pressure >= mean * (1.0 - 1e-12)),
        ("full contact has the area 1", !is_full || (area - 1.0).abs() < 1e-12),
        (
            "bars are not negative",
            found.area.error >= 0.0 && found.mean_gap_error >= 0.0 && solution.penetration_error() >= 0.0,
        ),
    ];
    laws.into_iter().filter(|(_, holds)| !holds).map(|(law, _)| law).collect()
}

#[test]
fn numbers_stay_inside_what_is_certain() {
    let faults: Vec<String> = (0..SCENES)
        .into_par_iter()
        .flat_map_iter(|index| {
            let scene = Scene::new(index);
            let by = |method: Method| match scene.solve(method) {
                Ok(solution) => Some((violated(&solution), solution.status())),
                // Penetrations beyond full contact are refused, and the adaptive method has one kernel.
                Err(SolveError::NotConverged { solution, .. }) => Some((violated(&solution), Status::NotConverged)),
                Err(_) => None,
            };
            let (uniform, adaptive) = (by(Method::Uniform), by(Method::Adaptive));
            let differ = match (&uniform, &adaptive) {
                (Some((_, a)), Some((_, b))) => a != b && *a != Status::NotConverged && *b != Status::NotConverged,
                _ => false,
            };
            let laws = [uniform, adaptive].into_iter().flatten().flat_map(|(laws, _)| laws);
            let laws = laws.chain(differ.then_some("both methods have one status"));
            laws.map(|law| format!("scene {index}: {law}")).collect::<Vec<_>>()
        })
        .collect();
    assert!(faults.is_empty(), "{} faults: {:?}", faults.len(), &faults[..faults.len().min(12)]);
}
