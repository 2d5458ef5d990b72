//! Fig. 7: logarithm of the mean pressure against Δ/h_max for both surfaces.
//!
//! It has exponential fits in the range where they apply, and Persson's decay length. h_max has a standard deviation of
//! 10 % between realisations, so averages need a rule. Here the load is given. Δ/h_max is averaged over realisations at
//! each load, with the h_max of its own realisation. The decay length u0 is defined by σ0 ∝ exp(-ū/u0) with the mean
//! gap ū = h_max - Δ. It is fitted to each realisation and then averaged.

use anyhow::Result;
use plotters::prelude::{DrawingBackend, RGBColor};
use rc_plot::{Area, Picture, PictureError};
use rc_theory::persson_gap::SelfAffineBand;

use crate::chart::{GREY, Key, Panel, Pen, STYLES, Style};
use crate::fit::{Line, Sample};
use crate::sweep::{self, State, Sweep};
use crate::table::{Quantity, Rows, quantity, sampled, summary};
use crate::{Figure, Preset, Rule, Table, paper};

/// Range of Δ/h_max in which log σ0 is linear.
///
/// Below it the highest asperities are few. Above it contact is nearly full.
const WINDOW: (f64, f64) = (0.28, 0.9);
/// Values of Persson's γ that the literature fits to simulations.
const GAMMAS: [f64; 2] = [0.40, 0.45];
const BETWEEN_SURFACES: &str = "greatest difference of penetration/h_max between surfaces";
/// Colour of the window. The colour of single realisations follows.
const SHADE: RGBColor = RGBColor(240, 240, 240);
const PALE: f64 = 0.25;

/// Parameters of Fig. 7.
#[derive(Clone, Debug)]
pub struct Params {
    sweep: sweep::Params,
    hurst: f64,
    /// Rms height times the smallest wavenumber, q0 h_rms.
    rms_height: f64,
}

/// Loads against penetrations of both surfaces with their fits.
#[derive(Clone, Debug)]
pub struct Fig7 {
    sweep: Sweep,
    curves: Vec<Curve>,
}

/// One surface.
#[derive(Clone, Debug)]
struct Curve {
    waves: usize,
    style: Style,
    points: Vec<Point>,
    /// Fit of log10 σ0 to Δ/h_max for each realisation. The fit of the averages follows.
    fits: Vec<Fit>,
    average: Line,
    /// Persson's u0/(γ h_rms). His β follows.
    decay_length: f64,
    prefactor: f64,
}

/// Averages over realisations at one load.
#[derive(Clone, Copy, Debug)]
struct Point {
    load: f64,
    penetration: Sample,
    mean_gap: Sample,
}

/// The fit of one realisation.
#[derive(Clone, Copy, Debug)]
struct Fit {
    seed: u64,
    /// Ratio h_max/h_rms of the realisation.
    h_max: f64,
    line: Line,
}

impl Fit {
    /// The decay length u0/h_rms: ln σ0 grows by h_max/u0 when Δ/h_max grows by 1.
    fn decay_length(&self) -> f64 {
        self.h_max / (self.line.slope * std::f64::consts::LN_10)
    }
}

impl Figure for Fig7 {
    const NAME: &'static str = "fig7";
    type Params = Params;

    /// The parameters of `sweep::Params::of`.
    fn params(preset: Preset) -> Result<Params> {
        let rms_height = paper::value("q0")? * paper::value("rms_height")?;
        Ok(Params { sweep: sweep::Params::of(preset)?, hurst: paper::value("hurst")?, rms_height })
    }

    fn compute(params: &Params) -> Result<Self> {
        Ok(Self::of(params, Sweep::solve(&params.sweep)?))
    }

    fn tables(&self) -> Vec<Table> {
        vec![self.summary(), self.curves_table(), self.fits_table()]
    }
}

impl Picture for Fig7 {
    fn size(&self) -> (u32, u32) {
        (1300, 1000)
    }

    fn draw<B: DrawingBackend>(&self, area: &Area<B>) -> Result<(), PictureError> {
        self.panel().draw(area)
    }
}

/// The line through log10 σ0 against Δ/h_max inside the window.
fn fit(points: impl Iterator<Item = (f64, f64)>) -> Line {
    let inside = points.filter(|at| (WINDOW.0..=WINDOW.1).contains(&at.0));
    Line::fit(&inside.collect::<Vec<_>>())
}

impl Curve {
    fn of(sweep: &Sweep, params: &Params, waves: usize, style: Style) -> Self {
        let points: Vec<Point> = params
            .sweep
            .loads
            .iter()
            .map(|&load| Point {
                load,
                penetration: sweep.sample(waves, load, |state| state.penetration),
                mean_gap: sweep.sample(waves, load, |state| state.mean_gap),
            })
            .collect();
        let of = |states: &[State]| Fit {
            seed: states[0].seed,
            h_max: states[0].h_max,
            line: fit(states.iter().map(|state| (state.penetration, state.load.log10()))),
        };
        let band = SelfAffineBand { hurst: params.hurst, waves: waves as f64 };
        Self {
            waves,
            style,
            fits: sweep.realisations(waves).map(of).collect(),
            average: fit(points.iter().map(|point| (point.penetration.mean, point.load.log10()))),
            points,
            decay_length: band.decay_length_over_gamma(),
            prefactor: params.rms_height * band.prefactor(),
        }
    }

    /// Decay lengths u0/h_rms of the realisations.
    fn decay_lengths(&self) -> Sample {
        Sample::of(&self.fits.iter().map(Fit::decay_length).collect::<Vec<_>>())
    }

    fn h_max(&self) -> Sample {
        Sample::of(&self.fits.iter().map(|fit| fit.h_max).collect::<Vec<_>>())
    }

    /// Persson's log10 σ0 at a given Δ/h_max, with the mean h_max.
    fn persson(&self, gamma: f64, penetration: f64) -> f64 {
        let mean_gap = self.h_max().mean * (1.0 - penetration);
        self.prefactor.log10() - mean_gap / (gamma * self.decay_length * std::f64::consts::LN_10)
    }

    fn quantities(&self) -> Vec<Quantity> {
        let slopes = Sample::of(&self.fits.iter().map(|fit| fit.line.slope).collect::<Vec<_>>());
        let lowest = self.fits.iter().map(|fit| fit.line.r_squared).fold(1.0, f64::min);
        let u0 = self.decay_lengths();
        let persson = GAMMAS.map(|gamma| {
            quantity(format!("Persson's u0 for gamma {gamma:.2}"), "rms height", gamma * self.decay_length)
        });
        let of_fits = [
            sampled("h_max", "rms height", self.h_max()),
            sampled("d log10(load) / d(penetration/h_max) of realisations", "1", slopes),
            quantity("d log10(load) / d(penetration/h_max) of averages", "1", self.average.slope),
            quantity("R squared of averages", "1", self.average.r_squared),
            quantity("lowest R squared of realisations", "1", lowest),
            sampled("u0", "rms height", u0),
        ];
        let gamma = quantity("gamma that u0 stands for", "1", u0.mean / self.decay_length);
        of_fits.into_iter().chain(persson).chain([gamma]).map(|one| one.waves(self.waves)).collect()
    }
}

impl Fig7 {
    /// The figure of a solved sweep.
    pub(crate) fn of(params: &Params, sweep: Sweep) -> Self {
        let curve = |(surface, style): (&sweep::SurfaceOf, Style)| Curve::of(&sweep, params, surface.waves, style);
        Self { curves: sweep.surfaces.iter().zip(STYLES).map(curve).collect(), sweep }
    }

    /// Largest difference of the mean Δ/h_max between the two surfaces at one load.
    fn difference(&self) -> f64 {
        let [first, second] = &self.curves[..] else { return 0.0 };
        let pairs = first.points.iter().zip(&second.points);
        pairs.map(|(a, b)| (a.penetration.mean - b.penetration.mean).abs()).fold(0.0, f64::max)
    }

    fn summary(&self) -> Table {
        let difference = quantity(BETWEEN_SURFACES, "1", self.difference());
        let quantities = self.curves.iter().flat_map(Curve::quantities).chain([difference]);
        summary(quantities, &["waves", "standard_error"])
            .column("value", Rule::relative(1e-4))
            .column("standard_error", Rule::of_value(1e-4))
            .row(BETWEEN_SURFACES, Rule::absolute(2e-5))
    }

    fn curves_table(&self) -> Table {
        let points = self.curves.iter().flat_map(|curve| curve.points.iter().map(move |point| (curve, point)));
        let (length, deviation) = (Rule::of_scale(1e-5), Rule::of_scale(1e-4));
        Rows::of(points)
            .column("waves", |(curve, _)| curve.waves)
            .column("mean_pressure_over_e_star", |(_, point)| point.load)
            .within("penetration_over_h_max", length, |(_, point)| point.penetration.mean)
            .within("standard_deviation", deviation, |(_, point)| point.penetration.deviation)
            .within("mean_gap_over_rms_height", length, |(_, point)| point.mean_gap.mean)
            .within("gap_standard_deviation", deviation, |(_, point)| point.mean_gap.deviation)
            .within("log10_of_line", Rule::relative(1e-5), |(curve, point)| curve.average.at(point.penetration.mean))
            .table("curves")
    }

    fn fits_table(&self) -> Table {
        Rows::of(self.curves.iter().flat_map(|curve| curve.fits.iter().map(move |fit| (curve, fit))))
            .column("waves", |(curve, _)| curve.waves)
            .column("seed", |(_, fit)| fit.seed)
            .column("h_max_over_rms_height", |(_, fit)| fit.h_max)
            .column("slope", |(_, fit)| fit.line.slope)
            .column("r_squared", |(_, fit)| fit.line.r_squared)
            .column("u0_over_rms_height", |(_, fit)| fit.decay_length())
            .table("fits")
            .rest(Rule::relative(1e-4))
    }

    fn panel(&self) -> Panel {
        const Y: (f64, f64) = (-5.2, -1.8);
        let mut panel = Panel::new(("Δ / h_max", (0.0, 1.0)), ("log10 (σ0 / E*)", Y)).ticks(11, 8);
        panel.body([(WINDOW.0, Y.0), (WINDOW.1, Y.0), (WINDOW.1, Y.1), (WINDOW.0, Y.1)], SHADE);
        for (curve, style) in self.curves.iter().zip(STYLES) {
            for states in self.sweep.realisations(curve.waves) {
                let line = states.iter().map(|state| (state.penetration, state.load.log10()));
                panel.line(line, Pen::new(style.colour, 1).pale(PALE));
            }
        }
        let persson = Pen::new(GREY, 3).dashed(4, 6);
        if let Some(curve) = self.curves.first() {
            panel.line([0.15, 1.0].map(|x| (x, curve.persson(GAMMAS[1], x))), persson);
        }
        let mut keys = Vec::new();
        for curve in &self.curves {
            let Curve { style, .. } = *curve;
            panel.line([WINDOW.0 - 0.05, WINDOW.1 + 0.03].map(|x| (x, curve.average.at(x))), style.pen);
            let at = |point: &Point| (point.penetration.mean, point.load.log10());
            panel.bars_along_x(curve.points.iter().map(|point| (at(point), point.penetration.deviation)), style.colour);
            panel.marks(curve.points.iter().map(at), style.mark);
            let u0 = curve.decay_lengths();
            keys.push((Key::Mark(style.mark), format!("N = {}", curve.waves)));
            keys.push((Key::Line(style.pen), format!("u0 = ({:.3} ± {:.3}) h_rms", u0.mean, u0.error())));
        }
        if let Some(curve) = self.curves.first() {
            let text = format!("Persson, γ = {:.2}: u0 = {:.3} h_rms", GAMMAS[1], GAMMAS[1] * curve.decay_length);
            keys.push((Key::Line(persson), text));
        }
        panel.note((0.295, Y.0 + 0.12), "fitted");
        panel.legend((0.03, Y.1 - 0.15), 0.2, keys);
        panel
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figure::tests::{assert_reviewed, assert_written};

    #[test]
    fn quick_figure_7_is_as_reviewed_and_can_be_drawn() {
        let params = Fig7::params(Preset::Quick).expect("paper values");
        let figure = Fig7::compute(&params).expect("the quick figure is solved");
        for curve in &figure.curves {
            for pair in curve.points.windows(2) {
                assert!(pair[1].penetration.mean > pair[0].penetration.mean, "Δ falls with load: {pair:?}");
            }
            // The independent sweep of the paper's surface gives 0.35 to 0.58 over seven realisations.
            for fit in &curve.fits {
                assert!((0.25..0.75).contains(&fit.decay_length()), "u0 far from h_rms/2: {fit:?}");
            }
        }
        assert_reviewed(&figure, &params, &["fig7-summary", "fig7-curves", "fig7-fits"]);
        assert_written(&figure);
    }
}
