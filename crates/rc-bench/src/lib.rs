//! Benchmarks and stress tests of rc.
//!
//! They measure time against error, the accuracy of usual meshes, the truncation error of the kernels, and hard scenes.

pub mod bench;
pub mod stress;

mod accuracy;
mod kernel_error;

pub use accuracy::Accuracy;
pub use kernel_error::KernelErrors;
