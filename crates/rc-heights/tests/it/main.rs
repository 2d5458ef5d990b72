//! Readers on files of other programs, on files built byte by byte, and on damaged ones; treatments against closed
//! forms.

mod build;
mod build_instruments;
mod built;
mod files;
mod instruments;
mod parts;
mod programs;
mod robustness;
mod texts;
mod treatments;
