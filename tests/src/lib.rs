//! What crosses crates: see `it/` and `examples/`. The library itself is empty but for the README, whose program is a
//! test.

#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
struct Readme;
