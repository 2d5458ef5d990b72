//! The solution: fields, contact area, spots, stress, stiffness, and the error bars of all of them.

pub(crate) mod contact_area;
pub(crate) mod contact_spots;
pub(crate) mod elements;
pub(crate) mod fields;
pub(crate) mod gap_distribution;
pub(crate) mod gap_part;
pub(crate) mod gradient;
pub(crate) mod gradient_error;
pub(crate) mod observables;
pub(crate) mod pressure_statistics;
pub(crate) mod rows;
pub(crate) mod solved;
pub(crate) mod stress_distribution;
pub(crate) mod whole;
