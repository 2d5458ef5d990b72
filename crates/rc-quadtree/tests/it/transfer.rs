//! Claims about bringing a pressure from one mesh to another.

use crate::common::discs;
use rc_quadtree::{Mesh, MeshError, MeshKind, MeshParams, Reconstruction, transfer};

fn disc_mesh(radius: f64, kind: MeshKind) -> Mesh {
    let mask = discs(128, &[(0.9, 0.5, radius)], &[]);
    Mesh::from_mask(&mask, kind, &MeshParams::default()).expect("a power of two")
}

/// The pressure of Hertz for contact radius `radius` with peak 1, at the centres of a mesh of [`disc_mesh`].
fn hertz(mesh: &Mesh, radius: f64) -> Vec<f64> {
    let from_axis = |x: f64| (x - 0.4).rem_euclid(1.0) - 0.5;
    let pressure = |x: f64, y: f64| (1.0 - (from_axis(x).powi(2) + (y - 0.5).powi(2)) / radius.powi(2)).max(0.0).sqrt();
    mesh.elements().map(|e| pressure(e.x, e.y)).collect()
}

#[test]
fn growing_contact_keeps_the_load_and_new_elements_start_at_zero() {
    let (small, large) = (disc_mesh(0.2, MeshKind::Adaptive), disc_mesh(0.3, MeshKind::Adaptive));
    let old = hertz(&small, 0.2);
    for reconstruction in [Reconstruction::Constant, Reconstruction::Limited] {
        let moved = transfer(&small, &large, &old, reconstruction).expect("one value an element");
        assert_eq!(moved.lost, 0.0, "{reconstruction:?}: nothing of the old mesh is uncovered");
        let (new, reference) = (large.load(&moved.values), small.load(&old));
        let (new, reference) = (new.expect("one value an element"), reference.expect("one value an element"));
        let relative = new / reference - 1.0;
        assert!(relative.abs() < 1e-13, "{reconstruction:?}: load {new} of {reference}, relative {relative:.2e}");
        let new_elements = large.keys().iter().zip(&moved.values).filter(|&(&key, _)| {
            let overlaps = small.find(key).is_some() || !small.within(key).is_empty();
            !overlaps
        });
        assert!(new_elements.clone().count() > 100, "the case has new elements");
        for (key, &value) in new_elements {
            assert_eq!(value, 0.0, "new element {key:?}");
        }
        assert!(moved.values.iter().all(|&v| v >= 0.0), "{reconstruction:?}: tension after the transfer");
    }
}

#[test]
fn shrinking_contact_reports_the_load_that_is_lost() {
    let (large, small) = (disc_mesh(0.3, MeshKind::Adaptive), disc_mesh(0.2, MeshKind::Adaptive));
    let moved = transfer(&large, &small, &vec![2.0; large.len()], Reconstruction::Constant).expect("one value each");
    let reference = 2.0 * (large.area() - small.area());
    let relative = moved.lost / reference - 1.0;
    assert!(relative.abs() < 1e-13, "lost {} of {reference}, relative error {relative:.2e}", moved.lost);
    assert!(moved.values.iter().all(|&v| v == 2.0), "a constant stays what it is");
}

#[test]
fn splitting_a_linear_pressure_is_exact_inside() {
    let mesh = Mesh::uniform(1, 3).expect("small");
    let linear = |x: f64, y: f64| 1.0 + 2.0 * x - 0.7 * y;
    let old: Vec<f64> = mesh.elements().map(|e| linear(e.x, e.y)).collect();
    let all: Vec<usize> = (0..mesh.len()).collect();
    let finer = mesh.split(&all).expect("not deep");
    let moved = transfer(&mesh, &finer, &old, Reconstruction::Limited).expect("one value an element");
    for (value, e) in moved.values.iter().zip(finer.elements()) {
        // At the seam the periodic continuation of a linear function jumps, and the slope is limited.
        if (0.125..0.875).contains(&e.x) && (0.125..0.875).contains(&e.y) {
            let reference = linear(e.x, e.y);
            let relative = value / reference - 1.0;
            assert!(relative.abs() < 1e-14, "{value} for {reference} at {e:?}, relative error {relative:.2e}");
        }
    }
}

#[test]
fn linear_reconstruction_is_closer_to_hertz_than_copying() {
    let (coarse, fine) = (disc_mesh(0.35, MeshKind::Adaptive), disc_mesh(0.35, MeshKind::AdaptiveUniform));
    let (old, reference) = (hertz(&coarse, 0.35), hertz(&fine, 0.35));
    let error = |reconstruction| {
        let moved = transfer(&coarse, &fine, &old, reconstruction).expect("one value an element");
        moved.values.iter().zip(&reference).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
    };
    let (copied, linear) = (error(Reconstruction::Constant), error(Reconstruction::Limited));
    // Inside coarse elements the error is of second instead of first order; the limiter spends part of that.
    assert!(linear < 0.5 * copied, "L2 error {linear:.3e} linear, {copied:.3e} copied");
}

#[test]
fn values_come_back_from_a_finer_mesh() {
    let mesh = disc_mesh(0.3, MeshKind::Adaptive);
    let finer = disc_mesh(0.3, MeshKind::AdaptiveUniform);
    let old = hertz(&mesh, 0.3);
    for reconstruction in [Reconstruction::Constant, Reconstruction::Limited] {
        let there = transfer(&mesh, &finer, &old, reconstruction).expect("one value an element");
        let back = transfer(&finer, &mesh, &there.values, Reconstruction::Constant).expect("one value an element");
        for (value, reference) in back.values.iter().zip(&old) {
            let error = (value - reference).abs();
            assert!(error < 1e-14, "{reconstruction:?}: {value} for {reference}, error {error:.2e}");
        }
    }
}

#[test]
fn meshes_that_do_not_nest_are_an_error() {
    let (one, three) = (Mesh::uniform(1, 2).expect("small"), Mesh::uniform(3, 2).expect("small"));
    let result = transfer(&one, &three, &[0.0; 16], Reconstruction::Constant);
    assert_eq!(result, Err(MeshError::DifferentBase { from: 1, to: 3 }));
    let result = transfer(&one, &one, &[0.0; 15], Reconstruction::Constant);
    assert_eq!(result, Err(MeshError::Length { expected: 16, actual: 15 }));
}
