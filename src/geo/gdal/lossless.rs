//! Names as text and back without loss: a name on the disk may be no UTF-8.
//!
//! A byte that is part of no letter becomes a letter of its own from a private range, and so does each byte of a letter
//! that stands in that range already: every name has one text, every text leads back to its name. Not handled: other
//! systems than Unix, whose names are text.

use std::ffi::{OsStr, OsString};

/// The letter that stands for byte 0; the bytes meant are 0x80 to 0xff.
#[cfg(unix)]
const MARK: u32 = 0xF_0000;

/// The text of a name.
#[cfg(unix)]
pub(super) fn text(name: &OsStr) -> String {
    use std::os::unix::ffi::OsStrExt;
    text_of(name.as_bytes())
}

/// The text of a name.
#[cfg(not(unix))]
pub(super) fn text(name: &OsStr) -> String {
    name.to_string_lossy().into_owned()
}

/// The text of a name's bytes.
#[cfg(unix)]
pub(super) fn text_of(name: &[u8]) -> String {
    let mut text = String::with_capacity(name.len());
    let mark = |byte: &u8| char::from_u32(MARK + u32::from(*byte)).unwrap_or(char::REPLACEMENT_CHARACTER);
    for chunk in name.utf8_chunks() {
        for letter in chunk.valid().chars() {
            match byte_of(letter) {
                Some(_) => text.extend(letter.encode_utf8(&mut [0; 4]).as_bytes().iter().map(mark)),
                None => text.push(letter),
            }
        }
        text.extend(chunk.invalid().iter().map(mark));
    }
    text
}

/// The text of a name's bytes.
#[cfg(not(unix))]
pub(super) fn text_of(name: &[u8]) -> String {
    String::from_utf8_lossy(name).into_owned()
}

/// The name that a text stands for.
#[cfg(unix)]
pub(super) fn name(text: &str) -> OsString {
    use std::os::unix::ffi::OsStringExt;
    let mut bytes = Vec::with_capacity(text.len());
    for letter in text.chars() {
        match byte_of(letter) {
            Some(byte) => bytes.push(byte),
            None => bytes.extend(letter.encode_utf8(&mut [0; 4]).as_bytes()),
        }
    }
    OsString::from_vec(bytes)
}

/// The name that a text stands for.
#[cfg(not(unix))]
pub(super) fn name(text: &str) -> OsString {
    text.into()
}

#[cfg(unix)]
fn byte_of(letter: char) -> Option<u8> {
    u32::from(letter).checked_sub(MARK).and_then(|byte| u8::try_from(byte).ok()).filter(|byte| *byte >= 0x80)
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn every_name_comes_back() {
        use std::os::unix::ffi::OsStrExt;
        let names: [&[u8]; 5] = [
            b"plain.tif",
            "höhe.tif".as_bytes(),
            b"h\xf6he.tif",
            "\u{f00e9}.tif".as_bytes(),
            b"\xf3\xb0\x83\xe9\xff/a",
        ];
        let texts = names.map(|bytes| text(OsStr::from_bytes(bytes)));
        for (bytes, text) in names.iter().zip(&texts) {
            assert_eq!(name(text).as_bytes(), *bytes, "{text:?}");
        }
        assert_eq!(&texts[1], "höhe.tif");
        assert!(texts[2] != texts[3] && texts[2].ends_with("he.tif"));
    }
}
