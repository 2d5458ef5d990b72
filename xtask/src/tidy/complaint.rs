//! The result of a check.

/// A sentence that says which rule a file breaks, and how to correct it.
pub(super) type Complaint = String;
