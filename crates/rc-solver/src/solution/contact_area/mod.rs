//! The contact area, with edges located between the centres of elements (see `docs/accuracy.md`).
//!
//! A count of the elements in contact is only first-order accurate: 1 to 4 % too large on usual meshes. Here an edge is
//! located between every two neighbours of which one is in contact. Its position follows from the pressure of this
//! neighbour and the gap of the other. The remaining first-order error is the same for all contacts, and is subtracted.

pub(crate) mod area;
pub(crate) mod corner;
pub(crate) mod edge;
pub(crate) mod edge_sums;
pub(crate) mod kind;
pub(crate) mod plastic;
pub(crate) mod sliding_edges;
