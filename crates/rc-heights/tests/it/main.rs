//! Tests of readers and treatments.
//!
//! Readers are tested with files of other programs, with files built byte by byte, and with damaged files. Treatments
//! are compared with closed forms.

mod arrays;
mod bombs;
mod build;
mod build_instruments;
mod build_microscopes;
mod built;
mod doubts;
mod files;
mod instruments;
mod kinds;
mod masks;
mod microscopes;
mod orders;
mod parts;
mod preparation;
mod programs;
mod robustness;
mod text_marks;
mod text_tables;
mod texts;
mod treatments;
