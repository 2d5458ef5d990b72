//! The kernel of a problem and of its solution, with any owner.

use std::sync::Arc;

use rc_core::Kernel;

/// The kernel that a problem is solved with.
#[derive(Clone)]
pub(crate) enum OwnedKernel<'a> {
    /// A kernel that the caller owns.
    Borrowed(&'a dyn Kernel),
    /// A kernel with several owners.
    Shared(Arc<dyn Kernel + Send + Sync>),
}

impl OwnedKernel<'_> {
    /// The kernel.
    pub(crate) fn get(&self) -> &dyn Kernel {
        match self {
            Self::Borrowed(kernel) => *kernel,
            Self::Shared(kernel) => &**kernel,
        }
    }

    /// A kernel that outlives the borrow. `None` if the caller's kernel makes no copy of itself.
    pub(crate) fn to_shared(&self) -> Option<Arc<dyn Kernel + Send + Sync>> {
        match self {
            Self::Borrowed(kernel) => kernel.to_shared(),
            Self::Shared(kernel) => Some(Arc::clone(kernel)),
        }
    }
}
