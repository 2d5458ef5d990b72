//! Channels of a file, each with values on a grid, read one at a time.

use super::fields::shown;
use crate::{FormatError, HeightMap};

/// A channel of a file whose values are not read yet.
pub(crate) struct Channel<'a> {
    /// Name in the file. It is empty if the format has no names.
    pub(crate) name: String,
    /// Whether the values are lengths, as far as the file says. Only then they can be heights.
    pub(crate) is_height: bool,
    /// Reads the values.
    pub(crate) read: Box<dyn FnOnce() -> Result<HeightMap, FormatError> + 'a>,
}

/// The channels of a file, in the order of the file.
pub(crate) type Channels<'a> = Result<Vec<Channel<'a>>, FormatError>;

/// A channel of a file, as listed by [`crate::channels`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ChannelInfo {
    /// Name of the channel. It is empty for the only channel of a format without names.
    pub name: String,
    /// Whether the values are lengths, as far as the file says.
    ///
    /// Only then they can be heights. [`crate::read`] reads the first such channel.
    pub is_height: bool,
}

impl ChannelInfo {
    /// The name for a line: at most 40 characters, without control characters.
    #[must_use]
    pub fn shown_name(&self) -> String {
        shown(&self.name)
    }
}

impl From<&Channel<'_>> for ChannelInfo {
    fn from(channel: &Channel<'_>) -> Self {
        Self { name: channel.name.clone(), is_height: channel.is_height }
    }
}

/// The only channel of a file without names.
pub(super) fn only<'a>(read: impl FnOnce() -> Result<HeightMap, FormatError> + 'a) -> Vec<Channel<'a>> {
    vec![Channel { name: String::new(), is_height: true, read: Box::new(read) }]
}

/// The same channels, each with a unique name.
///
/// A channel without a name gets its number. A name that occurred before gets a number at its end.
pub(super) fn named(mut channels: Vec<Channel<'_>>) -> Vec<Channel<'_>> {
    if channels.len() < 2 {
        return channels;
    }
    let mut taken = std::collections::HashSet::new();
    for (i, channel) in channels.iter_mut().enumerate() {
        if channel.name.is_empty() {
            channel.name = (i + 1).to_string();
        }
        let name = channel.name.clone();
        let mut copy = 1;
        while !taken.insert(channel.name.clone()) {
            copy += 1;
            channel.name = format!("{name} ({copy})");
        }
    }
    channels
}

/// Whether microscopes give this name to heights.
///
/// Errors of the feedback loop have other names.
pub(super) fn is_topography(name: &str) -> bool {
    let name = name.to_lowercase();
    ["height", "zsensor", "z sensor", "topo"].iter().any(|word| name.contains(word))
}

/// Channels from headers that were read one by one, each with its name.
///
/// The error of a damaged channel is returned when it is read. A damaged channel counts as heights only if no other
/// channel does.
pub(super) fn each(found: Vec<(String, Result<Channel<'_>, FormatError>)>) -> Vec<Channel<'_>> {
    let is_height = !found.iter().any(|(_, channel)| channel.as_ref().is_ok_and(|channel| channel.is_height));
    let damaged = |name, error| Channel { name, is_height, read: Box::new(move || Err(error)) };
    found.into_iter().map(|(name, channel)| channel.unwrap_or_else(|error| damaged(name, error))).collect()
}

/// The channel called `name`, without regard to case, or the first channel with heights.
///
/// A single channel without a name is also called 1.
///
/// # Errors
/// Both list the names in the file:
///
/// - [`FormatError::NoChannel`] when no channel has this name.
/// - [`FormatError::NoHeights`] when no channel has heights.
pub(super) fn chosen<'a>(channels: Vec<Channel<'a>>, name: Option<&str>) -> Result<Channel<'a>, FormatError> {
    let names: Vec<String> = channels.iter().map(|channel| channel.name.clone()).collect();
    let exact = |name: &str| names.iter().position(|other| other == name);
    let any_case = |name: &str| names.iter().position(|other| other.to_lowercase() == name.to_lowercase());
    let at = match name {
        Some(name) => exact(name).or_else(|| any_case(name)).or_else(|| (name == "1" && names == [""]).then_some(0)),
        None => channels.iter().position(|channel| channel.is_height),
    };
    let shown_names = names.iter().map(|name| shown(name)).collect();
    let refused = match name {
        Some(name) => FormatError::NoChannel { name: shown(name), channels: shown_names },
        None => FormatError::NoHeights { channels: shown_names },
    };
    at.and_then(|at| channels.into_iter().nth(at)).ok_or(refused)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn channels<'a>(names: &[&str]) -> Vec<Channel<'a>> {
        let channel = |name: &&str| Channel {
            name: (*name).to_owned(),
            is_height: name.starts_with('h'),
            read: Box::new(|| Err(FormatError::Unknown)),
        };
        names.iter().map(channel).collect()
    }

    #[test]
    fn every_channel_of_several_has_a_name_of_its_own() {
        let names = |given: &[&str]| named(channels(given)).into_iter().map(|c| c.name).collect::<Vec<_>>();
        assert_eq!(names(&["h", "", "h", "h (2)", "h"]), ["h", "2", "h (2)", "h (2) (2)", "h (3)"]);
        assert_eq!(names(&[""]), [""]);
    }

    #[test]
    fn a_channel_is_chosen_by_its_name_and_heights_are_the_default() {
        let name = |wanted| chosen(channels(&["phase", "height", "h"]), wanted).map(|channel| channel.name);
        assert_eq!(name(None).as_deref(), Ok("height"));
        assert_eq!(name(Some("H")).as_deref(), Ok("h"));
        assert_eq!(name(Some("phase")).as_deref(), Ok("phase"));
        let error = name(Some("slope")).expect_err("no such channel").to_string();
        assert!(error.contains("'slope'") && error.contains("phase, height, h"), "{error}");
        let error = chosen(channels(&["phase"]), None).err().expect("no heights").to_string();
        assert!(error.contains("phase"), "{error}");
        let error = chosen(channels(&[""]), Some("x")).err().expect("no names").to_string();
        assert!(error.contains("omit channel"), "{error}");
    }

    #[test]
    fn a_channel_without_a_name_is_picked_by_its_number() {
        assert!(chosen(channels(&[""]), Some("1")).is_ok());
        for (names, expected) in [
            (&[][..], "no 2-D array"),
            (&[""], "channel = 1 and height_scale"),
            (&["phase", "V"], "phase, V; to read one, give channel"),
        ] {
            let error = chosen(channels(names), None).err().expect("no heights").to_string();
            assert!(error.contains(expected), "{error}");
        }
    }

    #[test]
    fn a_damaged_channel_is_refused_when_it_is_read() {
        let found = |good: &str| {
            let [good] = <[Channel<'_>; 1]>::try_from(channels(&[good])).ok().expect("one");
            each(vec![("bad".into(), Err(FormatError::Empty(7))), (good.name.clone(), Ok(good))])
        };
        assert_eq!(chosen(found("height"), None).map(|channel| channel.name).as_deref(), Ok("height"));
        let bad = chosen(found("phase"), None).expect("the damaged one");
        assert_eq!((bad.read)(), Err(FormatError::Empty(7)));
    }
}
