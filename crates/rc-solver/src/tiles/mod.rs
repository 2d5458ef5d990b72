//! The adaptive mesh: tiles of elements, L on them, their heights, and the proof that contact is impossible elsewhere.

pub(crate) mod bands;
pub(crate) mod base;
pub(crate) mod contact_area;
pub(crate) mod data;
pub(crate) mod deal;
pub(crate) mod element_blocks;
pub(crate) mod element_heights;
pub(crate) mod exclusion;
pub(crate) mod friction;
pub(crate) mod gap_operator;
pub(crate) mod heights;
pub(crate) mod kernels;
pub(crate) mod ladder;
pub(crate) mod memory;
pub(crate) mod mesh;
pub(crate) mod multilevel;
pub(crate) mod operator;
pub(crate) mod part;
pub(crate) mod patch;
pub(crate) mod prolongation;
pub(crate) mod roughness;
pub(crate) mod scaled_operator;
pub(crate) mod solid;
pub(crate) mod solution;
pub(crate) mod split;
