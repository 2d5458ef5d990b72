//! Fourier transforms of real fields on a grid.
//!
//! The crate has plans, row and column passes, and scratch. A two-dimensional transform is a pass over rows and a pass
//! over columns. Each pass is parallel over blocks that stay in cache. Only this crate contains such passes:
//!
//! | item | what it does |
//! |---|---|
//! | [`Convolution`] | field → inverse FFT( symbol · FFT(field) ), repeatedly on one grid, in `f32` or `f64` |
//! | [`LineConvolution`] | the same for a single row |
//! | [`SymbolTable`] | table of the symbol of a convolution |
//! | [`WaveTable`] | the same for a complex symbol |
//! | [`half_plane_values`] | forward transform of a real field, then a number for every wave of the half plane kx ≥ 0 |
//! | [`field_of_columns`] | inverse transform of waves in the columns kx = 0, 1, … to a real field |
//! | [`field_of_half_plane`] | inverse of a forward transform with [`half_plane_values`] |
//! | [`powers_of_lines`] | transforms of rows and of columns, one axis at a time, and weighted sums of their powers |
//! | [`TransformReal`] | one-dimensional transforms |
//! | [`has_small_factors`] | whether transforms of a length are fast |
//! | [`Instructions`] | the vector instructions in use, which the environment variable `RC_SIMD` can lower |
//!
//! Results are bitwise the same for any number of threads. Work is divided over rows and columns, never inside one
//! transform.
//!
//! `rustfft` is generic over the number type. Every crate that makes a plan compiles all of its algorithms, for each
//! instruction set and precision. This is a million lines of LLVM code. Here they are compiled once, and other crates
//! get a plan as a trait object.
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
mod factors;
mod half_plane;
mod instructions;
mod line_convolution;
mod lines;
mod plan;
mod real_by_complex;
mod rows;
mod symbol_table;
mod wave_table;

pub use convolution::{BLOCK_ROWS, Convolution};
pub use factors::has_small_factors;
pub use half_plane::{field_of_columns, field_of_half_plane, half_plane_values};
pub use instructions::Instructions;
pub use line_convolution::LineConvolution;
pub use lines::powers_of_lines;
pub use plan::TransformReal;
pub use realfft::{ComplexToReal, RealToComplex};
pub use rustfft::Fft;
pub use rustfft::num_complex::{Complex, Complex64};
pub use symbol_table::SymbolTable;
pub use wave_table::WaveTable;
