//! Conversion of the bytes of a text to characters.

use std::borrow::Cow;

/// Decodes a text.
///
/// It is UTF-8 with or without a byte-order mark, or UTF-16 of either byte order with a mark. Other bytes are read as
/// Latin-1, in which old programs write µ.
pub(crate) fn decoded(bytes: &[u8]) -> Cow<'_, str> {
    match bytes {
        [0xff, 0xfe, rest @ ..] => Cow::Owned(utf_16(rest, u16::from_le_bytes)),
        [0xfe, 0xff, rest @ ..] => Cow::Owned(utf_16(rest, u16::from_be_bytes)),
        [0xef, 0xbb, 0xbf, rest @ ..] => String::from_utf8_lossy(rest),
        _ => match std::str::from_utf8(bytes) {
            Ok(text) => Cow::Borrowed(text),
            // The first lines of a file may end inside a character.
            Err(error) if error.error_len().is_none() => String::from_utf8_lossy(&bytes[..error.valid_up_to()]),
            Err(_) => Cow::Owned(bytes.iter().map(|byte| char::from(*byte)).collect()),
        },
    }
}

fn utf_16(bytes: &[u8], unit: impl Fn([u8; 2]) -> u16) -> String {
    let (units, _) = bytes.as_chunks::<2>();
    char::decode_utf16(units.iter().map(|bytes| unit(*bytes)))
        .map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER))
        .collect()
}

/// Whether bytes can be a text.
///
/// Binary files contain zeros. Texts do not, except in UTF-16.
pub(crate) fn is_text(start: &[u8]) -> bool {
    start.starts_with(&[0xff, 0xfe]) || start.starts_with(&[0xfe, 0xff]) || !start.contains(&0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_encoding_is_the_same_text() {
        let text = "# Breite: 10 µm\n1 2\n";
        let utf_16 = |mark: [u8; 2], bytes: fn(u16) -> [u8; 2]| {
            [mark.to_vec(), text.encode_utf16().flat_map(bytes).collect()].concat()
        };
        let latin_1 = text.chars().map(|c| u8::try_from(u32::from(c)).expect("a Latin-1 character")).collect();
        let files = [
            text.as_bytes().to_vec(),
            [b"\xef\xbb\xbf", text.as_bytes()].concat(),
            utf_16([0xff, 0xfe], u16::to_le_bytes),
            utf_16([0xfe, 0xff], u16::to_be_bytes),
            latin_1,
        ];
        for bytes in files {
            assert_eq!(decoded(&bytes), text, "{bytes:?}");
            assert!(is_text(&bytes));
        }
        assert_eq!(decoded("1 µ".as_bytes().split_at(3).0), "1 ");
        assert!(!is_text(b"\x01\x00\x00\x00"));
    }
}
