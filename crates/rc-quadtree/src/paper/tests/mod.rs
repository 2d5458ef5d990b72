//! Tests of the paper's meshes.
#![expect(
    clippy::float_cmp,
    reason = "areas and lengths are sums of powers of two and nothing lost is exactly zero, so equality is meant"
)]

mod common;
mod meshes;
mod properties;
mod transfers;
