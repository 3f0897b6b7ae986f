//! What an archive itself calls its first member: from the root, from the folder above, or from its own.
//!
//! GDAL lists no members that lie outside the archive's own folder, and leaves a leading `./` out, which the tools want.
//! Read are the first bytes alone. Not handled: archives of which only later members lie outside; those are not seen.

use std::path::{Path, PathBuf};

use super::name::RasterPlace;
use super::{lossless, mistaken, vsi};
use crate::error::{Error, shown};

/// Bytes of the name in a tar archive's header, and where what stands before it is (POSIX).
const TAR: (usize, std::ops::Range<usize>) = (100, 345..500);

/// The error for an archive whose first member lies outside its folder; `None` for others.
pub(super) fn error(path: &Path, place: &RasterPlace) -> Option<Error> {
    let (name, is_zip) = first(place)?;
    let outside = name.starts_with('/') || name.split(['/', '\\']).any(|part| part == "..");
    // Both tools leave out what leads outside, and write nothing there.
    let command = if is_zip { "python3 -m zipfile -e IN FOLDER" } else { "tar -xkf IN" };
    outside.then(|| {
        let member = shown(&PathBuf::from(lossless::name(&name)));
        let what = format!("holds members outside the archive's own folder ({member}), which are not read");
        Error::input(path, what, format!("unpack it, and name what comes out: `{command}`"))
    })
}

/// A member as the archive's own tools call it.
pub(super) fn called(member: &str, place: &RasterPlace) -> String {
    let dot = first(place).is_some_and(|(name, _)| name.starts_with("./"));
    if dot { format!("./{member}") } else { member.to_owned() }
}

/// The name of the first member of an archive on the disk, and whether that is a zip archive.
fn first(place: &RasterPlace) -> Option<(String, bool)> {
    let RasterPlace::Archive(archive) = place else { return None };
    let mut head = vsi::head(archive)?;
    if head.starts_with(b"PK\x03\x04") {
        let length = usize::from(u16::from_le_bytes([*head.get(26)?, *head.get(27)?]));
        return Some((lossless::text_of(head.get(30..30 + length)?), true));
    }
    if head.starts_with(b"\x1f\x8b") {
        let mut name = std::ffi::OsString::from("/vsigzip/");
        name.push(archive);
        head = vsi::head(&PathBuf::from(name))?;
    }
    let text = |bytes: &[u8]| lossless::text_of(bytes.split(|byte| *byte == 0).next().unwrap_or_default());
    if !mistaken::is_tar(&head) {
        return None;
    }
    let (name, before) = (text(head.get(..TAR.0)?), text(head.get(TAR.1)?));
    // The field before is GNU's own where the mark ends in a space.
    let posix = head.get(262) == Some(&0) && !before.is_empty();
    Some((if posix { format!("{before}/{name}") } else { name }, false))
}
