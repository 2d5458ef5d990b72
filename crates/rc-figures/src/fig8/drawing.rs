//! The panels of Fig. 8.

use plotters::prelude::{DrawingBackend, Rectangle};
use plotters::style::{Color, WHITE};
use rc_plot::{Area, PictureError};

use super::{Bin, Curve, Fig8};
use crate::chart::{GREY, Key, Panel, Pen};

/// Upper end of the drawn stresses, in hundredths of E*.
const GREATEST_STRESS: f64 = 5.0;
/// Upper end of the stresses in the inset, in hundredths of E*.
const END_OF_TAIL: f64 = 6.0;
const HUNDREDTH: f64 = 1e2;
/// Lower end of log P in the panel where P goes to zero.
const LOWEST: f64 = -2.5;
/// Half-size of small marks, in pixels. The half-size of large marks follows.
const SMALL_MARK: i32 = 5;
const TINY_MARK: i32 = 3;

impl Fig8 {
    pub(super) fn draw_panels<B: DrawingBackend>(&self, area: &Area<B>) -> Result<(), PictureError> {
        let (left, right) = area.split_horizontally(1080);
        self.distribution().draw(&left)?;
        // The inset is over the empty upper right of the first panel.
        let ((x, y), (width, height)) = ((600, 40), (450, 440));
        let frame = [(x + 40, y), (x + width, y + height)];
        left.draw(&Rectangle::new(frame, WHITE.filled())).map_err(PictureError::new)?;
        self.tail().draw(&left.clone().shrink((x, y), (width as u32, height as u32)))?;
        self.start().draw(&right)
    }

    /// Maximum of the density P.
    fn peak(&self) -> f64 {
        self.curves.iter().map(|curve| curve.peak().1).fold(0.0, f64::max)
    }

    /// Upper end of the logarithmic axes.
    fn top_decade(&self) -> f64 {
        self.peak().log10() + 0.25
    }

    fn distribution(&self) -> Panel {
        let top = 1.75 * self.peak();
        let x = ("σ / E* (10⁻²)", (0.0, GREATEST_STRESS));
        let mut panel = Panel::new(x, ("P(σ / E*)", (0.0, top))).ticks(6, 7);
        let mut keys = Vec::new();
        for curve in &self.curves {
            let bins = || curve.drawn_bins().filter(|bin| HUNDREDTH * bin.stress < GREATEST_STRESS);
            let at = |bin: &Bin| (HUNDREDTH * bin.stress, bin.density.mean);
            panel.bars(bins().map(|bin| (at(bin), bin.density.deviation)), curve.style.colour);
            panel.marks(bins().map(at), curve.style.mark.sized(SMALL_MARK));
            panel.line(curve.fitted(GREATEST_STRESS / HUNDREDTH), curve.style.pen);
            keys.push((Key::Mark(curve.style.mark), format!("N = {}", curve.waves)));
            keys.push((Key::Line(curve.style.pen), format!("Eq. 7, Λ = {:.2}·10⁻⁵", curve.fit.lambda * 1e5)));
        }
        panel.note((0.02 * GREATEST_STRESS, 0.965 * top), "(a)");
        panel.legend((0.08 * GREATEST_STRESS, 0.965 * top), 0.055 * top, keys);
        panel
    }

    /// The tail with a logarithmic axis for P.
    fn tail(&self) -> Panel {
        let (low, high) = (-3.0, self.top_decade());
        let x = ("σ / E* (10⁻²)", (0.0, END_OF_TAIL));
        let mut panel = Panel::new(x, ("log10 P", (low, high))).ticks(4, 5);
        for curve in &self.curves {
            let inside = |at: &(f64, f64)| at.1 > low && at.0 < END_OF_TAIL;
            let points = curve.drawn_bins().map(|bin| (HUNDREDTH * bin.stress, bin.density.mean.log10()));
            panel.marks(points.filter(inside), curve.style.mark.sized(TINY_MARK));
            let line = curve.fitted(END_OF_TAIL / HUNDREDTH).map(|(stress, density)| (stress, density.log10()));
            panel.line(line.filter(inside), Pen::new(curve.style.colour, 2));
        }
        panel
    }

    /// The approach to zero with two logarithmic axes.
    fn start(&self) -> Panel {
        let y = ("log10 P(σ / E*)", (LOWEST, self.top_decade()));
        let mut panel = Panel::new(("log10 (σ / E*)", (-5.0, -1.9)), y).ticks(7, 8);
        let mut keys = Vec::new();
        for curve in &self.curves {
            let line = |of: fn(&Bin) -> f64| {
                let points = curve.small.iter().map(move |bin| (bin.stress.log10(), of(bin).log10()));
                points.filter(|at| at.1 > LOWEST)
            };
            let thin = Pen::new(curve.style.colour, 2);
            panel.marks(line(|bin| bin.density.mean), curve.style.mark);
            panel.line(line(|bin| bin.of_elements), thin);
            keys.push((Key::Mark(curve.style.mark), format!("N = {}, p² linear at edges", curve.waves)));
            keys.push((Key::Line(thin), format!("N = {}, elements counted", curve.waves)));
        }
        if let Some(curve) = self.curves.first() {
            // The line is slightly above the marks.
            let first = curve.small.first().map_or(0.0, |bin| (bin.density.mean / bin.stress).log10());
            let guide = Pen::new(GREY, 3).dashed(4, 6);
            panel.line([-4.9, -2.9].map(|x| (x, x + first + 0.15)), guide);
            keys.push((Key::Line(guide), "slope 1".to_owned()));
        }
        panel.note((-5.0, self.top_decade() - 0.12), "(b)");
        panel.legend((-3.45, -1.45), 0.2, keys);
        panel
    }
}

impl Curve {
    /// The bins that are drawn. More marks would hide each other.
    fn drawn_bins(&self) -> impl Iterator<Item = &Bin> {
        self.bins.iter().step_by((self.bins.len() / 80).max(1))
    }

    /// Points of Eq. 7 up to the stress `end`, in the units of the axes.
    fn fitted(&self, end: f64) -> impl Iterator<Item = (f64, f64)> {
        let stresses = (1..=300).map(move |i| end * f64::from(i) / 300.0);
        stresses.map(|stress| (HUNDREDTH * stress, self.fit.density(stress)))
    }
}
