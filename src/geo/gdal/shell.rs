//! Names as a shell takes them for one word.
//!
//! Plain names stand as they are, others in quotes. What would not be printed as it is (control characters, bytes that
//! are no UTF-8) is written in ASCII as `$'gr\xfcn\n.tif'`, which bash, zsh and ksh read. Not handled: shells that do not.

use std::ffi::OsStr;

use crate::error::plain;

/// A name as a shell takes it for one word.
pub(super) fn quoted(name: &OsStr) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || "/._-+=:,@%".contains(c);
    match name.to_str() {
        Some(text) if !text.is_empty() && text.chars().all(is_plain) => text.to_owned(),
        Some(text) if plain(text.to_owned()) == text => format!("'{}'", text.replace('\'', r"'\''")),
        _ => escaped(name.as_encoded_bytes()),
    }
}

/// A file's name as a command takes it for none of its options.
pub(super) fn file(name: &OsStr) -> String {
    let dash = name.as_encoded_bytes().starts_with(b"-");
    if dash { format!("./{}", quoted(name)) } else { quoted(name) }
}

/// The name of a member of a zip archive as `unzip` takes it for that one: it takes `[x]`, `*` and `?` for patterns, a
/// dash for an option, and letters beyond ASCII for what its locale makes of them; those are left open,
/// and where the name is not `exact`, so are slashes, which GDAL reads in the place of backslashes.
pub(super) fn unzipped(name: &str, exact: bool) -> String {
    let mut pattern = String::new();
    for letter in name.chars() {
        match letter {
            '[' | ']' | '*' | '?' | '\\' => pattern.extend(['\\', letter]),
            '/' if !exact => pattern.push('?'),
            '-' if pattern.is_empty() => pattern.push_str(r"\-"),
            ' '..='~' => pattern.push(letter),
            _ if pattern.ends_with('*') && !pattern.ends_with(r"\*") => {}
            _ => pattern.push('*'),
        }
    }
    quoted(pattern.as_ref())
}

fn escaped(bytes: &[u8]) -> String {
    let mut word = "$'".to_owned();
    let mut number = false;
    for byte in bytes {
        // A digit behind a number would be taken for its third.
        let after = std::mem::take(&mut number) && byte.is_ascii_hexdigit();
        match byte {
            b'\'' | b'\\' => word.extend(['\\', char::from(*byte)]),
            b'\n' => word += r"\n",
            b'\t' => word += r"\t",
            b'\r' => word += r"\r",
            b' '..=b'~' if !after => word.push(char::from(*byte)),
            _ => {
                word += &format!("\\x{byte:02x}");
                number = true;
            }
        }
    }
    word + "'"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shell_takes_a_quoted_name_for_one_word() {
        let word = |name: &str| quoted(name.as_ref());
        assert_eq!(word("a/b.tif"), "a/b.tif");
        assert_eq!(word("it's a.tif"), r"'it'\''s a.tif'");
        assert_eq!(word("a\n'b\x1bcx"), r"$'a\n\'b\x1b\x63x'");
        assert_eq!(file("-a.tif".as_ref()), "./-a.tif");
        assert_eq!(unzipped("-a/[x]ö\u{f00fc} ?.hgt", true), r"'\-a/\[x\]* \?.hgt'");
    }
}
