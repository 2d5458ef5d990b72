//! The figures of the paper, one file each: numbers first, then a picture of them.
//!
//! A [`Figure`] computes itself from its parameters, and has tables and a drawing. [`run`] writes one figure, and
//! [`all::run`] writes every figure of the paper. [`Gfmd`] and [`Challenge`] are published references, which
//! [`run_one`] archives. [`blocks`] puts the numbers of archived figures into pages. `rc-bench` uses [`Table`],
//! [`comparison`], [`numeric`], [`snapshot`], [`blocks`] and [`repository`] too.

pub mod all;
pub mod archive;
pub mod blocks;
pub mod challenge;
pub mod comparison;
pub mod numeric;
pub mod repository;
pub mod snapshot;

mod chart;
mod fig1;
mod fig2;
mod fig3;
mod fig4;
mod fig5;
mod fig6;
mod fig7;
mod fig8;
mod figure;
mod fit;
mod gfmd;
mod paper;
mod shown;
mod statements;
mod sweep;
mod table;

pub use all::run_one;
pub use challenge::Challenge;
pub use comparison::Rule;
pub use fig1::Fig1;
pub use fig2::Fig2;
pub use fig3::Fig3;
pub use fig4::Fig4;
pub use fig5::Fig5;
pub use fig6::Fig6;
pub use fig7::Fig7;
pub use fig8::Fig8;
pub use figure::{Figure, Preset, run, write};
pub use gfmd::Gfmd;
pub use statements::Statements;
pub use table::{Table, number};
