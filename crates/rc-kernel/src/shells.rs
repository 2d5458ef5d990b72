//! Maximum number of shells of images in a sum.

/// Maximum number of shells of images: 4 million images, one second for a coefficient.
pub const MAX_SHELLS: usize = 1024;
