//! What a file holds: one or several channels of values on a grid, read one at a time.

use crate::{FormatError, HeightMap};

/// A channel of a file, whose values are not read yet.
pub(crate) struct Channel<'a> {
    /// Its name in the file, or an empty text where the format has none.
    pub(crate) name: String,
    /// Whether its values are lengths, so that it can be a map of heights.
    pub(crate) is_height: bool,
    /// Reads the values.
    pub(crate) read: Box<dyn FnOnce() -> Result<HeightMap, FormatError> + 'a>,
}

/// The channels of a file, in its order.
pub(crate) type Channels<'a> = Result<Vec<Channel<'a>>, FormatError>;
