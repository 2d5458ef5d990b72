//! Claims about the transfer of a pressure from one mesh to another.

use super::common::{discs, params_for};
use crate::paper::{Mesh, MeshError, MeshKind, MeshParams, transfer};

fn disc_mesh(radius: f64, kind: MeshKind) -> Mesh {
    let mask = discs(128, &[(0.9, 0.5, radius)], &[]);
    Mesh::from_mask(&mask, kind, &MeshParams::default()).expect("a power of two")
}

/// Hertz's pressure for contact radius `radius` with peak 1, at the centres of a mesh.
///
/// The mesh is that of [`disc_mesh`].
fn hertz(mesh: &Mesh, radius: f64) -> Vec<f64> {
    let from_axis = |x: f64| (x - 0.4).rem_euclid(1.0) - 0.5;
    let pressure = |x: f64, y: f64| (1.0 - (from_axis(x).powi(2) + (y - 0.5).powi(2)) / radius.powi(2)).max(0.0).sqrt();
    mesh.elements().map(|e| pressure(e.centre.x, e.centre.y)).collect()
}

#[test]
fn growing_contact_keeps_the_load_and_new_elements_start_at_zero() {
    let (small, large) = (disc_mesh(0.2, MeshKind::Adaptive), disc_mesh(0.3, MeshKind::Adaptive));
    let old = hertz(&small, 0.2);
    let moved = transfer(&small, &large, &old).expect("one value an element");
    assert_eq!(moved.lost, 0.0, "nothing of the old mesh is uncovered");
    let (new, reference) = (large.load(&moved.values), small.load(&old));
    let relative = new / reference - 1.0;
    assert!(relative.abs() < 1e-13, "load {new} of {reference}, relative {relative:.2e}");
    let new_elements = large.keys().iter().zip(&moved.values).filter(|&(key, _)| {
        let overlaps = small.keys().iter().any(|old| old.start() < key.end() && key.start() < old.end());
        !overlaps
    });
    assert!(new_elements.clone().count() > 100, "the case has new elements");
    for (key, &value) in new_elements {
        assert_eq!(value, 0.0, "new element {key:?}");
    }
    assert!(moved.values.iter().all(|&v| v >= 0.0), "tension after the transfer");
}

#[test]
fn shrinking_contact_reports_the_load_that_is_lost() {
    let (large, small) = (disc_mesh(0.3, MeshKind::Adaptive), disc_mesh(0.2, MeshKind::Adaptive));
    let moved = transfer(&large, &small, &vec![2.0; large.len()]).expect("one value each");
    let reference = 2.0 * (large.area() - small.area());
    let relative = moved.lost / reference - 1.0;
    assert!(relative.abs() < 1e-13, "lost {} of {reference}, relative error {relative:.2e}", moved.lost);
    assert!(moved.values.iter().all(|&v| v == 2.0), "a constant stays what it is");
}

#[test]
fn values_come_back_from_a_finer_mesh() {
    let mesh = disc_mesh(0.3, MeshKind::Adaptive);
    let finer = disc_mesh(0.3, MeshKind::AdaptiveUniform);
    let old = hertz(&mesh, 0.3);
    let there = transfer(&mesh, &finer, &old).expect("one value an element");
    let back = transfer(&finer, &mesh, &there.values).expect("one value an element");
    for (value, reference) in back.values.iter().zip(&old) {
        let error = (value - reference).abs();
        assert!(error < 1e-14, "{value} for {reference}, error {error:.2e}");
    }
}

#[test]
fn meshes_that_do_not_nest_are_an_error() {
    let uniform = |side: usize| {
        let mask = discs(side, &[(0.5, 0.5, 1.0)], &[]);
        Mesh::from_mask(&mask, MeshKind::Uniform, &params_for(side)).expect("params_for suits every side")
    };
    let (one, three) = (uniform(4), uniform(12));
    assert_eq!(transfer(&one, &three, &[0.0; 16]), Err(MeshError::DifferentBase { from: 1, to: 3 }));
    assert_eq!(transfer(&one, &one, &[0.0; 15]), Err(MeshError::Length { expected: 16, actual: 15 }));
}
