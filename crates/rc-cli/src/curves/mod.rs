//! The rows of a sweep as curves: its table, means over seeds, the theory beside them, pictures and text.
//!
//! [`folder`] tells what a folder is. [`columns`] knows the columns of results. [`table`] reads `sweep.csv` and [`sealing`] `sealing.json`, [`means`] averages over seeds, [`theory`] has
//! Persson's line. [`pictures`] is `rc plot` of a sweep, and [`text`] is `rc inspect`. The page is in `report`.

pub(crate) mod columns;
pub(crate) mod folder;
pub(crate) mod means;
pub(crate) mod pictures;
pub(crate) mod sealing;
pub(crate) mod table;
pub(crate) mod text;
pub(crate) mod theory;

mod axis;
