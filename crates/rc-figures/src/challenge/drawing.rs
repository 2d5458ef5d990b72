//! The panels of the Challenge's surface.

use rc_core::quantity::digits;
use rc_theory::persson::Persson;

use super::{CELL_UM, Challenge, E_STAR_MPA, Point, REFERENCE_LOAD};
use crate::chart::{BLUE, GREEN, GREY, Key, Panel, Pen, RED, STYLES, Style};

const OURS: Style = STYLES[0];
const LOAD: &str = "log10 (σ0 / MPa)";

impl Point {
    /// Decimal logarithm of the mean pressure (MPa).
    fn decade(&self) -> f64 {
        (self.load * E_STAR_MPA).log10()
    }

    /// Mean gap (µm). Its error bar follows.
    fn gap(&self) -> (f64, f64) {
        let observables = &self.solved.observables;
        (observables.mean_gap * CELL_UM, observables.mean_gap_error * CELL_UM)
    }
}

impl Challenge {
    /// Range of the decimal logarithm of the mean pressures (MPa).
    fn decades(&self) -> (f64, f64) {
        let log = |point: Option<&Point>| point.map_or(0.0, Point::decade);
        (log(self.points.first()) - 0.2, log(self.points.last()) + 0.2)
    }

    /// Adds the line and marks of these values against the load.
    fn draw_curve(&self, panel: &mut Panel, at: impl Fn(&Point) -> (f64, f64)) {
        panel.line(self.points.iter().map(&at), OURS.pen);
        panel.marks(self.points.iter().map(&at), OURS.mark);
    }

    pub(super) fn area_panel(&self) -> Panel {
        let end = 1.1 * self.points.last().map_or(1.0, |point| point.load);
        let top = 120.0 * self.points.last().map_or(1.0, |point| point.solved.area.fraction);
        let mut panel = Panel::new(("σ0 (MPa)", (0.0, end * E_STAR_MPA)), ("A / A0 (%)", (0.0, top))).ticks(6, 7);
        let area = |load: f64, area: f64| (load * E_STAR_MPA, 100.0 * area);
        let loads = (0..=100).map(|i| end * f64::from(i) / 100.0);
        let theory = Pen::new(GREY, 2);
        panel.line(loads.map(|load| area(load, Persson::from_rms_slope(load, self.rms_slope).area_fraction())), theory);
        let at = |point: &Point| area(point.load, point.solved.area.fraction);
        panel.bars(self.points.iter().map(|point| (at(point), 100.0 * point.solved.area.error)), OURS.colour);
        self.draw_curve(&mut panel, at);
        let keys = [(Key::Mark(OURS.mark), "located, with error bar"), (Key::Line(theory), "Persson's theory")];
        panel.note((0.0, 0.95 * top), "(a)");
        panel.legend((0.1 * end * E_STAR_MPA, 0.95 * top), 0.07 * top, keys);
        panel
    }

    pub(super) fn gap_panel(&self) -> Panel {
        let x = self.decades();
        let top = 1.15 * self.points.iter().map(|point| point.gap().0).fold(0.0, f64::max);
        let mut panel = Panel::new((LOAD, x), ("mean gap (µm)", (0.0, top))).ticks(6, 7);
        let at = |point: &Point| (point.decade(), point.gap().0);
        panel.bars(self.points.iter().map(|point| (at(point), point.gap().1)), OURS.colour);
        self.draw_curve(&mut panel, at);
        panel.note((x.0, 0.95 * top), "(b)");
        panel
    }

    pub(super) fn stiffness_panel(&self) -> Panel {
        let x = self.decades();
        let at = |point: &Point| (point.decade(), (point.solved.stiffness * E_STAR_MPA / CELL_UM).log10());
        let heights = || self.points.iter().map(|point| at(point).1);
        let y = (heights().fold(f64::INFINITY, f64::min) - 0.2, heights().fold(f64::NEG_INFINITY, f64::max) + 0.2);
        let mut panel = Panel::new((LOAD, x), ("log10 (stiffness / (MPa/µm))", y)).ticks(6, 7);
        self.draw_curve(&mut panel, at);
        panel.note((x.0, y.1 - 0.05 * (y.1 - y.0)), "(c)");
        panel
    }

    /// The number of patches above an area for the lightest load, the reference's and the heaviest.
    pub(super) fn patches_panel(&self) -> Panel {
        let reference = self.points.iter().find(|point| point.load.total_cmp(&REFERENCE_LOAD).is_eq());
        let curves = [self.points.first(), reference, self.points.last()];
        let log_area = |area: f64| (area * CELL_UM * CELL_UM).log10();
        let most = self.points.iter().map(|point| point.patches.len()).max().unwrap_or(1);
        let largest = self.points.iter().filter_map(|point| point.patches.first()).fold(0.0_f64, |a, b| a.max(*b));
        let (x, top) = ((-4.5, log_area(largest) + 0.3), (most as f64).log10() + 0.8);
        let y = ("log10 (number of patches larger than a)", (0.0, top));
        let mut panel = Panel::new(("log10 (a / µm²)", x), y).ticks(6, 7);
        let mut keys = Vec::new();
        for (point, colour) in curves.into_iter().zip([GREEN, RED, BLUE]) {
            let Some(Point { load, patches, .. }) = point else { continue };
            let ranked = patches.iter().enumerate().map(|(rank, area)| (log_area(*area), ((rank + 1) as f64).log10()));
            // A few hundred points are enough to draw the line.
            let stride = (patches.len() / 500).max(1);
            let few = ranked.enumerate().filter(|(i, at)| (i % stride == 0 || *i < 100) && at.0 > x.0);
            panel.line(few.map(|one| one.1), Pen::new(colour, 3));
            keys.push((Key::Line(Pen::new(colour, 3)), format!("σ0 = {} MPa", digits(load * E_STAR_MPA, 3))));
        }
        panel.note((x.0, 0.95 * top), "(d)");
        panel.legend((x.0 + 0.55 * (x.1 - x.0), 0.95 * top), 0.07 * top, keys);
        panel
    }
}
