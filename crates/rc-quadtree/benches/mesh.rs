//! Time to count, build, check neighbours and transfer on a mask of 4096² cells in contact to two thirds.
//!
//! `cargo bench -p rc-quadtree`

use std::{f64::consts::TAU, sync::LazyLock};

use divan::{Bencher, black_box, counter::ItemsCount};
use rc_core::DVec2;
use rc_quadtree::{Edge, Mask, Mesh, MeshKind, MeshParams, Reconstruction, count, transfer};

/// Two thirds of the cell, in patches with borders on several scales.
static MASK: LazyLock<Mask> = LazyLock::new(|| {
    let rough = |DVec2 { x, y }: DVec2| {
        let wave = |k: f64, phase: f64| (TAU * k * x + phase).cos() * (TAU * k * y + 2.0 * phase).sin() / k.sqrt();
        wave(3.0, 0.1) + wave(7.0, 0.7) + wave(17.0, 1.9) + wave(41.0, 2.3) + wave(97.0, 0.4)
    };
    Mask::from_predicate(4096, |at| rough(at) > -0.15).expect("4096 is a side")
});

const KINDS: [MeshKind; 3] = [MeshKind::Uniform, MeshKind::AdaptiveUniform, MeshKind::Adaptive];

fn main() {
    LazyLock::force(&MASK);
    divan::main();
}

fn mesh(kind: MeshKind) -> Mesh {
    Mesh::from_mask(&MASK, kind, &MeshParams::default()).expect("4096 is a power of two")
}

#[divan::bench(args = KINDS, sample_count = 5)]
fn counting(kind: MeshKind) -> Vec<usize> {
    count(black_box(&MASK), kind, &MeshParams::default()).expect("4096 is a power of two")
}

#[divan::bench(args = KINDS, sample_count = 5)]
fn building(kind: MeshKind) -> Mesh {
    mesh(black_box(kind))
}

#[divan::bench(sample_count = 5)]
fn four_neighbours_of_every_element(bencher: Bencher<'_, '_>) {
    let mesh = mesh(MeshKind::Adaptive);
    bencher.counter(ItemsCount::new(mesh.len())).bench_local(|| {
        let neighbours = |i| Edge::ALL.iter().map(|&edge| mesh.neighbour(i, edge).indices().count()).sum::<usize>();
        (0..mesh.len()).map(neighbours).sum::<usize>()
    });
}

#[divan::bench(args = [Reconstruction::Constant, Reconstruction::Limited], sample_count = 5)]
fn transfer_to_the_uniform_mesh(bencher: Bencher<'_, '_>, reconstruction: Reconstruction) {
    let (from, to) = (mesh(MeshKind::Adaptive), mesh(MeshKind::AdaptiveUniform));
    let pressure: Vec<f64> = from.elements().map(|e| 1.0 + (TAU * e.x).sin()).collect();
    bencher
        .counter(ItemsCount::new(to.len()))
        .bench_local(|| transfer(&from, &to, &pressure, reconstruction).expect("one value an element"));
}
