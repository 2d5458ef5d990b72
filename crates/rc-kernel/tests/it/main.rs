//! Tests of the kernels with tables, slow sums and closed forms, in one test binary.

mod periodic;
mod reference;
