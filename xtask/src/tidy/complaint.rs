//! What a check finds.

/// A rule that a file breaks, with what fixes it.
pub(super) type Complaint = String;
