//! Fourier transforms of real fields on a grid: plans, row and column passes, scratch.
//!
//! A transform of two dimensions is a pass over rows and a pass over columns, each parallel over blocks that stay in
//! cache. This crate is the only place that such passes are written:
//!
//! | item | what |
//! |---|---|
//! | [`Convolution`] | field → inverse FFT( symbol · FFT(field) ), again and again on one grid, in `f32` or `f64` |
//! | [`SymbolTable`] | the symbol of a convolution, tabulated |
//! | [`half_plane_values`] | one forward transform of a real field, every wave of the half plane kx ≥ 0 mapped to a number |
//! | [`field_of_columns`] | one inverse transform of columns kx = 0, 1, … of waves, as many as there are, to a real field |
//! | [`powers_of_lines`] | transforms of rows and of columns, one axis at a time, and weighted sums of their powers |
//! | [`TransformReal`] | transforms of one dimension |
//! | [`Instructions`] | the vector instructions that are used, which `RC_SIMD` in the environment can lower |
//!
//! Results are bitwise the same for any number of threads: work is divided over rows and columns, never inside one
//! transform.
//!
//! `rustfft` is generic over the number type, so every crate that makes a plan compiles all of its algorithms, for each
//! instruction set and precision: a million lines of LLVM code. Here they are compiled once; other crates get a plan as
//! a trait object.
//!
//! ```
//! use rc_fft::{Complex, TransformReal};
//!
//! let plan = f64::complex_forward(4);
//! let mut values = [1.0, 0.0, -1.0, 0.0].map(|re| Complex::new(re, 0.0));
//! plan.process(&mut values);
//! assert_eq!(values[1], Complex::new(2.0, 0.0));
//! ```

mod convolution;
mod half_plane;
mod instructions;
mod lines;
mod plan;
mod real_by_complex;
mod symbol_table;

pub use convolution::{BLOCK_ROWS, Convolution};
pub use half_plane::{field_of_columns, half_plane_values};
pub use instructions::Instructions;
pub use lines::powers_of_lines;
pub use plan::TransformReal;
pub use realfft::{ComplexToReal, RealToComplex};
pub use rustfft::Fft;
pub use rustfft::num_complex::{Complex, Complex64};
pub use symbol_table::SymbolTable;
