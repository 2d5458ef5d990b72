//! Tests that cross crates, in `it/` and `examples/`.
//!
//! The library has only the README, whose program is a test.

#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
struct Readme;
