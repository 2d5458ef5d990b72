//! Time to count, build and transfer the paper's meshes.
//!
//! The mask has 4096² cells, of which two thirds are in contact. Run `cargo bench -p rc-quadtree`.

use std::{f64::consts::TAU, sync::LazyLock};

use divan::{Bencher, black_box, counter::ItemsCount};
use rc_core::{DVec2, Grid};
use rc_quadtree::paper::{Mask, Mesh, MeshKind, MeshParams, count, transfer};

/// Two thirds of the periodic cell, in patches with borders on several scales.
static MASK: LazyLock<Mask> = LazyLock::new(|| {
    let rough = |DVec2 { x, y }: DVec2| {
        let wave = |k: f64, phase: f64| (TAU * k * x + phase).cos() * (TAU * k * y + 2.0 * phase).sin() / k.sqrt();
        wave(3.0, 0.1) + wave(7.0, 0.7) + wave(17.0, 1.9) + wave(41.0, 2.3) + wave(97.0, 0.4)
    };
    let grid = Grid::square(4096).expect("4096 is a side");
    let centres = (0..grid.len()).map(|i| grid.centre(i % 4096, i / 4096));
    Mask::new(4096, centres.map(|at| rough(at) > -0.15).collect()).expect("a value for each cell")
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
fn transfer_to_the_uniform_mesh(bencher: Bencher<'_, '_>) {
    let (from, to) = (mesh(MeshKind::Adaptive), mesh(MeshKind::AdaptiveUniform));
    let pressure: Vec<f64> = from.elements().map(|element| 1.0 + (TAU * element.centre.x).sin()).collect();
    bencher
        .counter(ItemsCount::new(to.len()))
        .bench_local(|| transfer(&from, &to, &pressure).expect("one value an element"));
}
