//! The page of shear curves: shear, loop, slip area and loss, and a table of the curves.

use rc_core::quantity::{count, digits, engineering};
use serde::Serialize;

use super::page::{Command, Page, Tile, made};
use crate::shear::curve::{CurvePoint, ShearCurve};
use crate::shear::means::{MeanCurve, MeanPoint};
use crate::shear::record::ShearRecord;

/// The data of a page of shear curves, without those of all pages.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Body {
    curves: Vec<Curve>,
    heads: [&'static str; 7],
    rows: Vec<[String; 7]>,
    note: &'static str,
}

/// A shear curve.
#[derive(Clone, Debug, Serialize)]
struct Curve {
    name: String,
    /// d (m), τ (Pa), error of d (m).
    shear: Vec<[f64; 3]>,
    /// d (m) and τ (Pa) along the loop.
    hysteresis: Vec<[f64; 2]>,
    /// τ over that of sliding, and slip area over contact area.
    slip: Vec<[f64; 2]>,
    /// τ over that of sliding, and loss factor.
    loss: Vec<[f64; 2]>,
    /// τ over that of sliding, and loss of a cycle (J/m²).
    energy: Vec<[f64; 2]>,
}

/// The page of `record`.
pub(super) fn page(record: &ShearRecord) -> Page<Body> {
    let largest = record.curves.iter().max_by(|a, b| a.mean_pressure.total_cmp(&b.mean_pressure));
    Page {
        title: format!("Shear with the friction coefficient {}", record.friction),
        subtitle: format!("{} from load curves of normal contacts", count(record.curves.len(), "shear curve")),
        status: "partial slip".to_owned(),
        good: true,
        warnings: record.notes.clone(),
        tiles: largest.map(tiles).unwrap_or_default(),
        commands: vec![Command { note: "In the same folder:".to_owned(), text: record.command.clone() }],
        files: Vec::new(),
        made: made(),
        kind: "shear",
        body: Body {
            curves: record.curves.iter().map(curve).chain(record.means.iter().map(mean)).collect(),
            heads: [
                "surface and load",
                "sliding begins at",
                "stiffness before slip",
                "largest shear",
                "displacement there",
                "slip part there",
                "error of spacing",
            ],
            rows: record.curves.iter().map(row).collect(),
            note: "A curve ends where its load curve does, at its smallest load. The error is the difference to the curve from \
                   every second load, which is larger than the error of the curve; of a mean over surfaces, the bar is their spread. The loop is Masing's, between ±0.9 of the \
                   largest shear. The loss factor is the loss of a cycle over 2π times τ d/2.",
        },
    }
}

fn tiles(curve: &ShearCurve) -> Vec<Tile> {
    let tile = |name, value| Tile { name, value };
    vec![
        tile("mean pressure", engineering(curve.mean_pressure, "Pa")),
        tile("sliding begins at", engineering(curve.sliding_pressure, "Pa")),
        tile("tangential stiffness", stiffness(curve)),
        tile("displacement at the end", engineering(curve.end().shear_displacement, "m")),
    ]
}

fn stiffness(curve: &ShearCurve) -> String {
    curve.tangential_stiffness.map_or_else(|| "infinite".to_owned(), |value| engineering(value, "Pa/m"))
}

fn slip_part(point: &CurvePoint) -> f64 {
    point.slip_area_fraction / (point.slip_area_fraction + point.stick_area_fraction)
}

fn curve(curve: &ShearCurve) -> Curve {
    let part = |point: &CurvePoint| point.shear_pressure / curve.sliding_pressure;
    let against = |value: fn(&CurvePoint) -> Option<f64>| -> Vec<[f64; 2]> {
        curve.points.iter().filter_map(|point| Some([part(point), value(point)?])).collect()
    };
    Curve {
        name: curve.name(),
        shear: curve
            .points
            .iter()
            .map(|point| [point.shear_displacement, point.shear_pressure, point.shear_displacement_error])
            .collect(),
        hysteresis: curve.hysteresis.clone(),
        slip: against(|point| Some(slip_part(point))),
        loss: against(|point| point.loss_factor),
        energy: against(|point| Some(point.loss_per_cycle).filter(|loss| *loss > 0.0)),
    }
}

/// The mean over surfaces, whose bars are the spread.
fn mean(mean: &MeanCurve) -> Curve {
    let part = |point: &MeanPoint| point.shear_pressure / mean.sliding_pressure;
    let against = |value: fn(&MeanPoint) -> Option<f64>| -> Vec<[f64; 2]> {
        mean.points.iter().filter_map(|point| Some([part(point), value(point)?])).collect()
    };
    let shear = |point: &MeanPoint| [point.shear_displacement, point.shear_pressure, point.shear_displacement_spread];
    Curve {
        name: mean.name(),
        shear: mean.points.iter().map(shear).collect(),
        hysteresis: Vec::new(),
        slip: against(|point| Some(point.slip_area_fraction / (point.slip_area_fraction + point.stick_area_fraction))),
        loss: against(|point| point.loss_factor),
        energy: against(|point| Some(point.loss_per_cycle).filter(|loss| *loss > 0.0)),
    }
}

fn row(curve: &ShearCurve) -> [String; 7] {
    let end = curve.end();
    [
        curve.name(),
        engineering(curve.sliding_pressure, "Pa"),
        stiffness(curve),
        engineering(end.shear_pressure, "Pa"),
        engineering(end.shear_displacement, "m"),
        format!("{} %", digits(100.0 * slip_part(end), 3)),
        format!("{} %", digits(100.0 * curve.spacing_error(), 2)),
    ]
}
