//! Benchmarks and stress tests of rc.
//!
//! They measure time against stated error, how often error bars hold, and hard scenes.

pub mod accuracy;
pub mod bench;
pub mod stress;
