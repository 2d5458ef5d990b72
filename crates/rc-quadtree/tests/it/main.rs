//! What the mesh promises, from outside, in one test binary.
#![expect(
    clippy::float_cmp,
    reason = "areas and lengths are sums of powers of two and nothing lost is exactly zero, so equality is meant"
)]

mod common;
mod mesh;
mod properties;
mod transfer;
