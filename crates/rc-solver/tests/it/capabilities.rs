//! The table of capabilities against plans of all combinations.

use std::sync::Arc;

use rc_comm::{Ranks, run_threads};
use rc_core::{DVec2, Field, Grid, HeightField, HeightSource, Kernel};
use rc_kernel::{FreeLove, Layer, Love, LoveLayer, Relaxation, Spectral, Viscoelastic};
use rc_solver::{Checkpoint, ContactProblem, Control, Feature, Method, SolveError, SolveParams, Subject, refusal};

use crate::bumps;

/// A surface of two waves.
struct Waves;

impl HeightField for Waves {
    fn height(&self, DVec2 { x, y }: DVec2) -> f64 {
        1e-3 * ((std::f64::consts::TAU * x).cos() + (std::f64::consts::TAU * 2.0 * y).cos())
    }

    fn band_limit(&self) -> Option<usize> {
        Some(2)
    }
}

#[derive(Debug)]
struct Nowhere;

impl Checkpoint for Nowhere {
    fn read(&self, _offset: u64, _len: usize) -> Option<Vec<u8>> {
        None
    }

    fn replace(&self, _pieces: &mut dyn Iterator<Item = Vec<u8>>) {}
}

/// All combinations of one choice for each property. A choice has its features.
fn product<T: Clone>(all: &[Vec<T>], choices: &[T]) -> Vec<Vec<T>> {
    all.iter().flat_map(|set| choices.iter().map(|choice| [&set[..], std::slice::from_ref(choice)].concat())).collect()
}

/// Whether the plan of a problem with these features is refused, and for which pair.
fn planned(asked: &[Option<Feature>], method: Option<Method>, ranks: Ranks) -> Option<(Subject, Feature)> {
    let has = |feature| asked.contains(&Some(feature));
    let grid = match () {
        () if has(Feature::Line) => Grid::new(64, 1),
        () if has(Feature::OblongElements) => Grid::in_cell(64, 64, 1.5),
        () if has(Feature::OblongGrid) => Grid::in_cell(128, 64, 0.5),
        () if has(Feature::UnevenGrid) => Grid::square(100),
        () => Grid::square(64),
    };
    let grid = grid.expect("a grid");
    let flat = if has(Feature::Flat) { 0.0 } else { 1.0 };
    let map = Field::new(grid, bumps(grid.nx(), grid.ny()).values().iter().map(|h| flat * h).collect()).expect("a map");
    let heights: HeightSource<'_> = if has(Feature::HeightMap) { (&map).into() } else { Waves.on(grid) };
    let layer = LoveLayer(Layer::on_rigid_base(0.3, 0.3));
    let rubber = Relaxation::single(10.0, 0.1).expect("a material");
    let along = if has(Feature::LagOnGrid) && !has(Feature::UnevenGrid) { DVec2::Y } else { DVec2::X };
    let viscoelastic = Viscoelastic::new(Love, &rubber, 0.1 * along);
    let kernel: &dyn Kernel = match () {
        () if has(Feature::Sliding) => &viscoelastic,
        () if has(Feature::Layer) => &layer,
        () if has(Feature::OwnKernel) => &Spectral,
        () if has(Feature::FreeBorders) => &FreeLove,
        () => &Love,
    };
    let control = if has(Feature::Penetration) { Control::Penetration(1e-5) } else { Control::MeanPressure(1e-6) };
    let hardness = if has(Feature::Hardness) { 1e-2 } else { f64::INFINITY };
    let problem = ContactProblem::new(heights, control).with_kernel(kernel).with_hardness(hardness).over(ranks);
    let problem = if has(Feature::Checkpoint) { problem.kept_in(Arc::new(Nowhere)) } else { problem };
    let border_level = usize::from(has(Feature::BorderLevel));
    match problem.plan(&SolveParams { border_level, method, ..SolveParams::default() }) {
        Ok(_) => None,
        Err(SolveError::Unsupported(refusal)) => Some((refusal.subject, refusal.object)),
        Err(other) => panic!("{asked:?} by {method:?}: {other}"),
    }
}

#[test]
fn plans_are_refused_exactly_as_the_table_says() {
    let choices: [&[&[Option<Feature>]]; 7] = [
        &[
            &[None],
            &[Some(Feature::OwnKernel)],
            &[Some(Feature::Layer)],
            &[Some(Feature::FreeBorders)],
            &[Some(Feature::Sliding)],
            &[Some(Feature::Sliding), Some(Feature::LagOnGrid)],
        ],
        &[&[None], &[Some(Feature::HeightMap)], &[Some(Feature::HeightMap), Some(Feature::Flat)]],
        &[
            &[None],
            &[Some(Feature::OblongGrid)],
            &[Some(Feature::OblongGrid), Some(Feature::OblongElements)],
            &[Some(Feature::UnevenGrid)],
            &[Some(Feature::Line), Some(Feature::OblongGrid), Some(Feature::OblongElements)],
        ],
        &[&[None], &[Some(Feature::Hardness)]],
        &[&[None], &[Some(Feature::BorderLevel)]],
        &[&[None], &[Some(Feature::Penetration)]],
        &[&[None], &[Some(Feature::Ranks)], &[Some(Feature::Ranks), Some(Feature::Checkpoint)]],
    ];
    let sets = choices.iter().fold(vec![vec![]], |sets, choices| product(&sets, choices));
    let mut refused = 0;
    for set in &sets {
        let asked = set.concat();
        let features: Vec<_> = asked.iter().copied().flatten().collect();
        // A flat surface has no penetration in a periodic cell.
        if features.contains(&Feature::Flat) && features.contains(&Feature::Penetration) {
            continue;
        }
        // A profile has no waves along y, and with free borders one row is a strip of a surface.
        let has = |feature| features.contains(&feature);
        if has(Feature::Line) && (!has(Feature::HeightMap) || has(Feature::FreeBorders)) {
            continue;
        }
        // On a grid that cannot be halved, any lag is one of whole grids.
        if has(Feature::Sliding) && has(Feature::UnevenGrid) && !has(Feature::LagOnGrid) {
            continue;
        }
        for method in [None, Some(Method::Adaptive), Some(Method::Uniform), Some(Method::GaussSeidel)] {
            let expected = refusal(&features, method).is_some();
            let size = if features.contains(&Feature::Ranks) { 2 } else { 1 };
            for found in run_threads(size, |ranks| planned(&asked, method, ranks)).expect("all ranks end") {
                assert_eq!(found.is_some(), expected, "{features:?} by {method:?}: {found:?}");
            }
            refused += usize::from(expected);
        }
    }
    assert!(sets.len() > 500 && refused > 500, "{refused} refusals of {} combinations", 4 * sets.len());
}
