//! What did not converge, and what to do about it.

use std::fmt;

/// Message about a solution or a flow that did not converge.
///
/// Its text is what did not converge, and then what to do.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Failure {
    /// What did not converge, and how far it is.
    pub what: String,
    /// What to do about it, or nothing.
    pub remedy: &'static str,
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}", self.what, self.remedy)
    }
}
