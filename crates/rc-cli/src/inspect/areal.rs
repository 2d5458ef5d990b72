//! Areal parameters of ISO 25178-2 from the material ratio curve and the autocorrelation.

use rc_core::Field;
use rc_core::quantity::{digits, engineering};
use rc_fractal::Texture;
use rc_heights::MaterialRatio;
use serde::Serialize;

/// Number of points of the stored material ratio curve.
const POINTS: usize = 101;

/// Material ratios between peaks, core and valleys of the volume parameters.
const LIMITS: [f64; 2] = [0.1, 0.8];

/// Parameters and curve, with the names of the standard. Lengths and volumes per area are in m, material ratios from 0
/// to 1.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[serde(rename_all = "PascalCase")]
pub(crate) struct ArealRow {
    /// Height of the core.
    pub(crate) sk: f64,
    /// Reduced height of the peaks.
    pub(crate) spk: f64,
    /// Reduced depth of the valleys.
    pub(crate) svk: f64,
    /// Material ratio between peaks and core.
    pub(crate) smr1: f64,
    /// Material ratio between core and valleys.
    pub(crate) smr2: f64,
    /// Material volume above the material ratio 10 %, also called Vmp.
    pub(crate) vm: f64,
    /// Material volume of the core, between 10 % and 80 %.
    pub(crate) vmc: f64,
    /// Void volume of the core, between 10 % and 80 %.
    pub(crate) vvc: f64,
    /// Void volume of the valleys, below 80 %.
    pub(crate) vvv: f64,
    /// Autocorrelation length; `None` if points are missing, for one row or column, or if nothing decays on half of the map.
    pub(crate) sal: Option<f64>,
    /// Texture aspect ratio; `None` if it is not known, or only known to be below `str_below`.
    pub(crate) str: Option<f64>,
    /// A bound of the texture aspect ratio, for a lay that is longer than half of the map.
    #[serde(rename = "Str_below", skip_serializing_if = "Option::is_none")]
    pub(crate) str_below: Option<f64>,
    /// Direction (degrees from x towards y) of the largest amplitudes, at a right angle to a lay.
    pub(crate) std: Option<f64>,
    #[serde(skip)]
    has_lay: bool,
    /// Height (m) about the mean of the equivalent line at the material ratio 0.
    #[serde(skip)]
    top: f64,
    /// Material ratio curve: ratio, and height (m) about the mean.
    #[serde(rename = "material_ratio")]
    pub(crate) curve: Vec<(f64, f64)>,
}

impl ArealRow {
    /// The parameters of the measured points of `heights` (in λ) about `mean` (m), in a cell of side `side` (m).
    pub(crate) fn of(heights: &Field, side: f64, mean: f64) -> Self {
        let Some(curve) = MaterialRatio::of(heights) else { return Self::default() };
        let core = curve.core();
        let material = LIMITS.map(|ratio| curve.material_volume(ratio) * side);
        let void = LIMITS.map(|ratio| curve.void_volume(ratio) * side);
        let ratios = (0..POINTS).map(|i| i as f64 / (POINTS - 1) as f64);
        Self {
            top: core.top * side - mean,
            sk: core.sk * side,
            spk: core.spk * side,
            svk: core.svk * side,
            smr1: core.smr1,
            smr2: core.smr2,
            vm: material[0],
            vmc: material[1] - material[0],
            vvc: void[0] - void[1],
            vvv: void[1],
            curve: ratios.map(|ratio| (ratio, curve.height(ratio) * side - mean)).collect(),
            ..Self::default()
        }
    }

    /// The same with the texture of all `heights`, of which `windowed` are those under a window.
    pub(crate) fn with_texture(self, heights: &Field, windowed: &Field, side: f64) -> Self {
        let texture = Texture::of(heights, windowed);
        let Texture { length, aspect, direction, .. } = texture;
        let ratio = |is_bound| aspect.filter(|aspect| aspect.is_bound == is_bound).map(|aspect| aspect.ratio);
        Self {
            sal: length.map(|length| length * side),
            str: ratio(false),
            str_below: ratio(true),
            std: Some(direction),
            has_lay: texture.has_lay(),
            ..self
        }
    }

    /// The ends of the equivalent line of the core: material ratio, and height (m) about the mean.
    pub(crate) fn equivalent_line(&self) -> [(f64, f64); 2] {
        [(0.0, self.top), (1.0, self.top - self.sk)]
    }

    /// Names and values.
    pub(crate) fn lines(&self) -> Vec<(&'static str, String)> {
        let length = |value: f64| engineering(value, "m");
        let percent = |ratio: f64| digits(100.0 * ratio, 3);
        let aspect = match (self.str, self.str_below) {
            (Some(ratio), _) => digits(ratio, 3),
            (None, Some(bound)) => format!("below {}, decays beyond half of the map", digits(bound, 2)),
            (None, None) => "unknown".to_owned(),
        };
        let mut lines = vec![
            ("Sk, Spk, Svk", format!("{}, {}, {}", length(self.sk), length(self.spk), length(self.svk))),
            ("Smr1, Smr2", format!("{} %, {} %", percent(self.smr1), percent(self.smr2))),
            ("Vm(10 %), Vmc", [self.vm, self.vmc].map(length).join(", ")),
            ("Vvc, Vvv", [self.vvc, self.vvv].map(length).join(", ")),
        ];
        if let Some(direction) = self.std {
            lines.push(("Sal, Str", format!("{}, {aspect}", self.sal.map_or_else(|| "unknown".to_owned(), length))));
            let lay = if self.has_lay { "" } else { " (no lay)" };
            lines.push(("Std", format!("{} degrees from x{lay}", digits(direction, 4))));
        }
        lines
    }
}
