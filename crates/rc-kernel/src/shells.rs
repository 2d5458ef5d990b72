//! The number of shells of images that are summed at most.

/// Maximum number of shells of images: 4 million images, a second for one coefficient.
pub const MAX_SHELLS: usize = 1024;
