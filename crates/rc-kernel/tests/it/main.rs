//! The kernels against tables, slow sums and closed forms, one test binary.

mod periodic;
mod reference;
