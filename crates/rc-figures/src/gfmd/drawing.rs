//! The panels of the comparison with the published reference.

use plotters::style::BLACK;

use super::{Distribution, Gfmd, Point};
use crate::chart::{GREEN, GREY, Key, Mark, Panel, Pen, STYLES, Style};

/// Style of located areas and of all other results of ours. The style of counted areas follows.
const LOCATED: Style = STYLES[0];
const COUNTED: Style = STYLES[1];
/// Shift of the published sets to the right, in decades. It keeps bars from hiding each other.
const ASIDE: f64 = 0.035;
const LOAD: &str = "log10 (σ0 / E*)";

impl Gfmd {
    /// Range of the decimal logarithm of the loads.
    fn decades(&self) -> (f64, f64) {
        let first = self.points.first().map_or(-4.0, |point| point.load.log10());
        let last = self.points.last().map_or(0.0, |point| point.load.log10());
        (first - 0.2, last + 0.2)
    }

    pub(super) fn kappa_panel(&self) -> Panel {
        let (x, top) = (self.decades(), 2.8);
        let mut panel = Panel::new((LOAD, x), ("κ = (A / A0) g E* / σ0", (0.8, top))).ticks(6, 8);
        let kappa = |load: f64, area: f64| (load.log10(), area * self.rms_slope / load);
        let [theory, first, second] = [Pen::new(GREY, 2), Pen::new(BLACK, 2), Pen::new(GREEN, 4)];
        let loads = (0..=200).map(|i| 10_f64.powf(x.0 + (x.1 - x.0) * f64::from(i) / 200.0));
        panel.line(loads.map(|load| kappa(load, self.theory(load))), theory);
        let points = || self.points.iter();
        let at = |point: &Point| kappa(point.load, point.area.fraction);
        panel.bars(points().map(|point| (at(point), kappa(point.load, point.area.error).1)), LOCATED.colour);
        panel.marks(points().map(at), LOCATED.mark);
        panel.marks(points().map(|point| kappa(point.load, point.area.cells)), COUNTED.mark);
        let aside = |(x, y): (f64, f64)| (x + ASIDE, y);
        let published = || points().filter_map(|point| point.published);
        let bar = published().map(|one| (aside(kappa(one.load, one.first)), kappa(one.load, one.deviation).1));
        panel.bars(bar, BLACK);
        for (x, y) in published().filter_map(|one| Some(aside(kappa(one.load, one.second?)))) {
            panel.line([(x - 0.05, y), (x + 0.05, y)], second);
        }
        let keys = [
            (Key::Mark(LOCATED.mark), "located, with error bar"),
            (Key::Mark(COUNTED.mark), "counted"),
            (Key::Line(first), "published, first set (bar: s.d.)"),
            (Key::Line(second), "published, second set"),
            (Key::Line(theory), "Persson's theory"),
        ];
        panel.note((x.0, 0.97 * top), "(a)");
        panel.legend((x.0 + 0.1, 1.35), 0.11, keys);
        panel
    }

    pub(super) fn difference_panel(&self) -> Panel {
        let (x, top) = (self.decades(), 6.0);
        let mut panel = Panel::new((LOAD, x), ("ours over published − 1 (%)", (-top, top))).ticks(6, 9);
        for (level, width) in [(-1.0, 1), (0.0, 2), (1.0, 1)] {
            panel.line([(x.0, level), (x.1, level)], Pen::new(GREY, width));
        }
        let pairs = self.points.iter().filter_map(|point| Some((point, point.published?)));
        let located = pairs.clone().filter_map(|(point, published)| {
            let second = published.second?;
            let error = point.area.error.hypot(published.deviation) / second;
            Some(((point.load.log10(), 100.0 * (point.area.fraction / second - 1.0)), 100.0 * error))
        });
        let counted = pairs.map(|(point, published)| {
            let at = (point.load.log10() + ASIDE, 100.0 * (point.area.cells / published.first - 1.0));
            (at, 100.0 * published.deviation / published.first)
        });
        for (bars, style) in [(located.collect::<Vec<_>>(), LOCATED), (counted.collect(), COUNTED)] {
            panel.marks(bars.iter().map(|bar| bar.0).filter(|at| at.1.abs() < top), style.mark);
            panel.bars(bars.into_iter().filter(|(at, half)| at.1.abs() + half < top), style.colour);
        }
        let keys = [
            (Key::Mark(LOCATED.mark), "located, against the second set"),
            (Key::Mark(COUNTED.mark), "counted, against the first set"),
        ];
        panel.note((x.0, 0.92 * top), "(b)");
        panel.legend((x.0 + 0.9, 0.92 * top), 0.12 * top, keys);
        panel
    }

    pub(super) fn stress_panel(&self) -> Panel {
        let (low, high) = (-4.0, 1.0);
        let end = self.distributions.iter().filter_map(|one| one.stress.edges.last()).fold(0.0_f64, |a, b| a.max(*b));
        let mut panel = Panel::new(("σ / E*", (0.0, end)), ("log10 P(σ / E*)", (low, high))).ticks(6, 6);
        let mut keys = Vec::new();
        let log = |(stress, density): (f64, f64)| (stress, density.log10());
        let of_loads = [(LOCATED.mark, LOCATED.colour), (COUNTED.mark, COUNTED.colour), (Mark::dot(GREEN, 8), GREEN)];
        for (one, (mark, colour)) in self.distributions.iter().zip(of_loads) {
            panel.marks(one.bins().map(log).filter(|at| at.1 > low), mark.sized(5));
            let theory = (1..=300).map(|i| end * f64::from(i) / 300.0);
            let theory = theory.map(|stress| log((stress, one.theory.density(stress))));
            panel.line(theory.filter(|at| at.1 > low), Pen::new(colour, 2));
            keys.push((Key::Mark(mark), format!("σ0 = {} E*", one.load)));
        }
        keys.push((Key::Line(Pen::new(GREY, 2)), "Persson's theory, without a fit".to_owned()));
        panel.note((0.0, 0.94 * high), "(c)");
        panel.legend((0.45 * end, 0.85 * high), 0.32, keys);
        panel
    }

    pub(super) fn gap_and_energy_panel(&self) -> Panel {
        let (x, low) = (self.decades(), -3.5);
        let mut panel = Panel::new((LOAD, x), ("log10 (gap / h_rms), log10 (U / U_full)", (low, 1.0))).ticks(6, 9);
        let mut draw = |of: fn(&Point) -> f64, style: Style| {
            let points = self.points.iter().map(|point| (point.load.log10(), of(point).log10()));
            let points: Vec<_> = points.filter(|at| at.1 > low).collect();
            panel.line(points.iter().copied(), style.pen);
            panel.marks(points, style.mark);
        };
        draw(|point| point.mean_gap.0, LOCATED);
        draw(|point| point.energy, COUNTED);
        let keys = [
            (Key::Mark(LOCATED.mark), "mean gap over rms height"),
            (Key::Mark(COUNTED.mark), "energy over that of full contact"),
        ];
        panel.note((x.0, 0.85), "(d)");
        panel.legend((x.0 + 1.0, low + 0.75), 0.3, keys);
        panel
    }
}

impl Distribution {
    /// Middle stress and density of each bin.
    pub(super) fn bins(&self) -> impl Iterator<Item = (f64, f64)> {
        let middles = self.stress.edges.windows(2).map(|edge| 0.5 * (edge[0] + edge[1]));
        middles.zip(self.stress.density.iter().copied())
    }
}
