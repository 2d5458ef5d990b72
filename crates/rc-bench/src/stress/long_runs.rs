//! Many solves in one process.
//!
//! Memory must not grow. The last result must equal the first, and the result of a new process.

use std::process::Command;

use anyhow::{Context, Result, ensure};
use rc_figures::Preset;
use rc_solver::Control;
use rc_sweep::memory;

use super::heights::rough;
use super::row::{Row, Rows};
use super::solved::{Method, solve};

/// Number of solves that may allocate memory for good: plans, tables, stacks of threads.
const WARM_UP: usize = 50;

/// Allowed growth of the peak memory after the warm-up, in bytes.
///
/// It allows for fragments of the allocator. A scene has twenty fields a solve, of 8 kB to 131 kB each, and these must
/// not stay.
const GROWTH: f64 = 8e6;

/// Scenes that take turns.
const SCENES: [(Method, usize, f64); 5] = [
    (Method::Uniform, 32, 1e-3),
    (Method::Adaptive, 128, 1e-3),
    (Method::Uniform, 64, 1e-5),
    (Method::Spectral, 48, 1e-2),
    (Method::Uniform, 63, 10.0),
];

pub(crate) fn rows(preset: Preset) -> Result<Vec<Row>> {
    let mut rows = Rows::of("long runs");
    let n_solves = if preset == Preset::Full { 1000 } else { 100 };
    let first: Vec<u64> = (0..SCENES.len()).map(fingerprint).collect::<Result<_>>()?;
    let (mut n_different, mut warm) = (0, None);
    for i in 0..n_solves {
        if i == WARM_UP {
            warm = memory::peak();
        }
        n_different += usize::from(fingerprint(i % SCENES.len())? != first[i % SCENES.len()]);
    }
    let scene = format!("{n_solves} solves in one process");
    rows.at_most(&scene, "results with other digits than the first", n_different as f64, 0.0);
    if let (Some(warm), Some(now)) = (warm, memory::peak()) {
        rows.at_most(&scene, "growth of the peak memory (bytes)", now.saturating_sub(warm) as f64, GROWTH);
    }
    if preset == Preset::Full {
        for (i, first) in first.iter().enumerate() {
            let fresh = in_fresh_process(i)?;
            let (expected, obtained) = (format!("{first:016x}"), format!("{fresh:016x}"));
            rows.holds(
                &format!("scene {i} in a fresh process"),
                "digits",
                &expected,
                obtained.clone(),
                expected == obtained,
            );
        }
    }
    Ok(rows.finish())
}

/// A number that depends on every bit of the solution of scene `i`.
pub(crate) fn fingerprint(i: usize) -> Result<u64> {
    let &(method, side, load) = SCENES.get(i).with_context(|| format!("there is no scene {i}"))?;
    let solved = solve(&rough(4, 0.8, i as u64, side)?, method, Control::MeanPressure(load), 1e-6)?;
    let numbers = [solved.info.penetration, solved.info.elastic_energy, solved.stiffness];
    // FNV-1a. Each of its steps can be inverted, so a single different bit gives another number.
    let mix = |hash: u64, value: &f64| (hash ^ value.to_bits()).wrapping_mul(0x0100_0000_01b3);
    Ok(solved.pressure.values().iter().chain(&numbers).fold(0xcbf2_9ce4_8422_2325, mix))
}

/// The fingerprint of scene `i` from a new process of this program.
fn in_fresh_process(i: usize) -> Result<u64> {
    let program = std::env::current_exe().context("the path of this program")?;
    let output = Command::new(program).args(["stress", "--fingerprint", &i.to_string()]).output();
    let output = output.context("could not start this program again")?;
    ensure!(output.status.success(), "a fresh process failed: {}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8_lossy(&output.stdout);
    u64::from_str_radix(text.trim(), 16).with_context(|| format!("no fingerprint: {text}"))
}
