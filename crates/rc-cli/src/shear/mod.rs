//! `rc shear`: shear curves with partial slip, from the load curves of a sweep.
//!
//! [`curves`] reads load curves, [`record`] has the results and their files, and the mathematics is in
//! `rc_theory::partial_slip`. A shear of one contact, with its fields, is `rc solve --friction`.

pub(crate) mod args;
pub(crate) mod command;
pub(crate) mod curve;
pub(crate) mod means;
pub(crate) mod record;

mod curves;
