//! Measurements and hard tests of rc: time against error, accuracy of usual meshes, truncation error of the kernels,
//! stress.

pub mod bench;
pub mod stress;

mod accuracy;
mod kernel_error;

pub use accuracy::Accuracy;
pub use kernel_error::KernelErrors;
