//! Directories of TIFF, as far as a tag of them is changed before the file is decoded, or is private.

use std::borrow::Cow;

use super::endian::Endian;

/// Tag of the meaning of levels, where 0 means that white is zero.
const PHOTOMETRIC: u16 = 262;

/// Type of values that are texts.
const TEXT: u16 = 2;

/// Maximum number of directories that are followed. They may refer to each other in a circle.
const MOST: usize = 256;

/// Places of values in the directories of a file.
struct Directories<'a> {
    bytes: &'a [u8],
    order: Endian,
    /// Whether places have 64 bits.
    is_big: bool,
}

/// The file, in which no white is zero.
///
/// Decoders invert levels of images whose white is zero. That is how a picture is shown, and has no meaning for
/// heights, which are the numbers of the file.
pub(super) fn as_stored(bytes: &[u8]) -> Cow<'_, [u8]> {
    let places = Directories::of(bytes).map(|directories| directories.inverted()).unwrap_or_default();
    if places.is_empty() {
        return Cow::Borrowed(bytes);
    }
    let mut changed = bytes.to_vec();
    for place in places {
        changed[place] = 1;
    }
    Cow::Owned(changed)
}

/// The stored bytes of a tag in the first directory of a file. They are fewer if the file is truncated.
pub(super) fn stored(bytes: &[u8], tag: u16) -> Option<&[u8]> {
    let directories = Directories::of(bytes)?;
    let (first, n) = directories.entries(directories.first());
    let entry = (0..n).map(|i| first + i * directories.entry()).find(|at| directories.u16(*at) == tag)?;
    let size = match directories.u16(entry + 2) {
        1 | TEXT | 6 | 7 => 1,
        3 | 8 => 2,
        5 | 10 | 12 | 16..=18 => 8,
        _ => 4,
    };
    let word = if directories.is_big { 8 } else { 4 };
    let value = entry + 4 + word;
    let length = directories.place(entry + 4).saturating_mul(size);
    let stored = bytes.get(if length <= word { value } else { directories.place(value) }..)?;
    Some(&stored[..length.min(stored.len())])
}

/// Whether all texts in the directories of a file fit into it.
pub(super) fn texts_fit(bytes: &[u8]) -> bool {
    Directories::of(bytes).is_none_or(|directories| {
        let fits = |at: usize| directories.u16(at + 2) != TEXT || directories.place(at + 4) < bytes.len();
        directories.all().into_iter().flatten().all(fits)
    })
}

impl<'a> Directories<'a> {
    fn of(bytes: &'a [u8]) -> Option<Self> {
        let order = match bytes.get(..2)? {
            b"II" => Endian::Little,
            b"MM" => Endian::Big,
            _ => return None,
        };
        Some(Self { bytes, order, is_big: order.i16_at(bytes, 2) == 43 })
    }

    /// Place of the first directory.
    fn first(&self) -> usize {
        self.place(if self.is_big { 8 } else { 4 })
    }

    /// Places of the entries of each directory.
    fn all(&self) -> Vec<Vec<usize>> {
        let (mut at, mut found) = (self.first(), Vec::new());
        while found.len() < MOST {
            let (first, n) = self.entries(at);
            if n == 0 {
                break;
            }
            found.push((0..n).map(|i| first + i * self.entry()).collect());
            at = self.place(first + n * self.entry());
        }
        found
    }

    /// The lower byte of the meaning of levels, in each directory whose white is zero.
    fn inverted(&self) -> Vec<usize> {
        let in_directory = |entries: &Vec<usize>| {
            let entry = |tag| entries.iter().find(|at| self.u16(**at) == tag);
            let value = |tag| entry(tag).map(|at| at + if self.is_big { 12 } else { 8 });
            let meaning = value(PHOTOMETRIC)?;
            (self.u16(meaning) == 0).then_some(meaning + usize::from(self.order == Endian::Big))
        };
        self.all().iter().filter_map(in_directory).collect()
    }

    /// Place of the first entry of the directory at `at`, and the number of entries. It is 0 where there is none.
    fn entries(&self, at: usize) -> (usize, usize) {
        let (first, n) =
            if self.is_big { (at.saturating_add(8), self.place(at)) } else { (at + 2, self.u16(at).into()) };
        let is_there = at > 0 && n < 1 << 16 && first + n * self.entry() <= self.bytes.len();
        (first, if is_there { n } else { 0 })
    }

    /// Bytes of an entry.
    fn entry(&self) -> usize {
        if self.is_big { 20 } else { 12 }
    }

    /// The place that is stored at `at`, which is 0 beyond the end.
    fn place(&self, at: usize) -> usize {
        let stored = if self.is_big {
            self.order.i64_at(self.bytes, at).cast_unsigned()
        } else {
            self.order.u32_at(self.bytes, at).into()
        };
        usize::try_from(stored).unwrap_or(0).min(self.bytes.len())
    }

    fn u16(&self, at: usize) -> u16 {
        self.order.i16_at(self.bytes, at).cast_unsigned()
    }
}
