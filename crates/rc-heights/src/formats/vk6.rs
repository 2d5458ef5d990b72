//! Newer Keyence files.
//!
//! After a picture, they have a zip archive with a file of version 4.

use std::io::{Cursor, Read as _};
use std::rc::Rc;

use zip::ZipArchive;

use super::archive::ZIP;
use super::channel::{Channel, Channels};
use super::fields::shown_as_line;
use super::instrument::Places;
use super::{limit, vk4};
use crate::{Format, FormatError};

/// The first bytes. The length of the picture follows.
pub(super) const MARKS: [&[u8]; 2] = [b"VK6", b"VK7"];

/// Bytes before the picture.
const HEADER: usize = 7;

/// The member of the archive with the file of version 4.
const MEMBER: &str = "Vk4File";

/// Bytes of memory for a byte of the member: itself, and the height of one byte.
const MEMORY: u64 = 9;

/// Whether a Keyence file has its heights in an archive.
pub(super) fn is_archive(bytes: &[u8]) -> bool {
    bytes.starts_with(ZIP) || MARKS.iter().any(|mark| bytes.starts_with(mark))
}

pub(super) fn channels(bytes: &[u8], max_bytes: u64) -> Channels<'_> {
    let content = Rc::new(member(bytes, max_bytes)?);
    let images = vk4::images(&content)?;
    let channel = |image: vk4::Image| {
        let content = Rc::clone(&content);
        Channel { name: image.name(), is_height: true, read: Box::new(move || image.read(&content)) }
    };
    Ok(images.into_iter().map(channel).collect())
}

/// The file of version 4.
fn member(bytes: &[u8], max_bytes: u64) -> Result<Vec<u8>, FormatError> {
    let picture = Places::new(bytes, Format::Vk4).size(3)?;
    let after = bytes.get(HEADER.saturating_add(picture)..).filter(|rest| rest.starts_with(ZIP));
    // The archive may also be found by its end.
    let archive = after.unwrap_or(bytes);
    let mut archive = ZipArchive::new(Cursor::new(archive)).map_err(|cause| container(&cause))?;
    let file = archive.by_name(MEMBER).map_err(|cause| container(&format_args!("{MEMBER}: {cause}")))?;
    let size = file.size();
    limit::check(size.saturating_mul(MEMORY).saturating_add(bytes.len() as u64), max_bytes)?;
    let mut content = Vec::new();
    let read = file.take(size).read_to_end(&mut content);
    read.map_err(|cause| container(&format_args!("{MEMBER}: {cause}")))?;
    Ok(content)
}

fn container(reason: &impl ToString) -> FormatError {
    FormatError::Container { format: Format::Vk4, reason: shown_as_line(&reason.to_string()) }
}
