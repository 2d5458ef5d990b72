//! How a file is read.

use super::layout::Layout;
use super::limit::DEFAULT_MAX_BYTES;
use super::mask::Mask;

/// Choices for files that can be read in several ways.
#[derive(Clone, Debug, PartialEq)]
pub struct ReadParams {
    /// Name of a channel. `None` means the first channel with heights.
    pub channel: Option<String>,
    /// Layout of a text. `None` means the layout that its first lines suggest.
    pub layout: Option<Layout>,
    /// Whether an array of one row or one column is a map: both sides of its cell are known, so it is no profile.
    pub row_is_map: bool,
    /// Whether the file has a profile, which is read as a map of one row.
    pub is_profile: bool,
    /// Values that mark missing points, in the numbers of the file.
    pub missing: Vec<f64>,
    /// What a mask in the file means.
    pub mask: Mask,
    /// Maximum number of bytes of memory for what a packed file unpacks to, and for the map in it.
    pub max_bytes: u64,
    /// Maximum number of bytes of memory for a file that is not packed, whose length already bounds what it takes.
    pub max_plain_bytes: u64,
}

impl Default for ReadParams {
    fn default() -> Self {
        Self {
            channel: None,
            layout: None,
            row_is_map: false,
            is_profile: false,
            missing: Vec::new(),
            mask: Mask::default(),
            max_bytes: DEFAULT_MAX_BYTES,
            max_plain_bytes: u64::MAX,
        }
    }
}

impl ReadParams {
    /// The layout of an array of this shape.
    pub(super) fn layout_of(&self, shape: [u64; 2]) -> Option<Layout> {
        self.layout.or(((self.row_is_map || self.is_profile) && shape.contains(&1)).then_some(Layout::Matrix))
    }
}
