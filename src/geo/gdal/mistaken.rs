//! What a file is that is no raster: a web page in its place, a pointer to it, an archive under another name.
//!
//! Told by the first bytes alone, after GDAL has refused the file. Not handled: anything without such a mark; it is in
//! no format that hachure reads, and that is said elsewhere.

/// What a file is, and what to do.
pub(super) type Told = (String, String);

/// What helps against a damage.
const AGAIN: &str = "copy or download it again";

/// Marks at the start of files that are no raster of elevations: the mark, what it stands for, what to do.
const MARKS: [(&[u8], &str, &str); 18] = [
    (b"%PDF", "is a PDF, pages to read", "download the raster itself from where the PDF came"),
    (
        b"\xff\xd8\xff",
        "is a picture (JPEG), not elevations",
        "download the DEM itself, as GeoTIFF if there is a choice",
    ),
    (b"GIF8", "is a picture (GIF), not elevations", "download the DEM itself, as GeoTIFF if there is a choice"),
    (b"LASF", "is a cloud of points (LAS), not a raster", "download or make a raster of its ground points"),
    (b"PK\x03\x04", "is a zip archive by another name", "unpack it: `unzip IN`"),
    (b"PK\x05\x06", "is an empty zip archive", "download it again"),
    (b"\x1f\x8b", "is packed with gzip under another name", "unpack it: `gunzip -c IN > OUT.tif`"),
    (b"7z\xbc\xaf\x27\x1c", "is a 7z archive, which GDAL does not read", "unpack it: `7z x IN`"),
    (b"Rar!", "is a RAR archive, which GDAL does not read", "unpack it: `unrar x IN`"),
    (b"BZh", "is packed with bzip2, which GDAL does not read", "unpack it: `bunzip2 -c IN > OUT.tif`"),
    (b"\xfd7zXZ", "is packed with xz, which GDAL does not read", "unpack it: `xz -dc IN > OUT.tif`"),
    (b"\x28\xb5\x2f\xfd", "is packed with Zstandard, which GDAL does not read", "unpack it: `zstd -dc IN > OUT.tif`"),
    (b"\x89HDF\r\n\x1a\n", "begins as HDF5 and netCDF 4 do and is damaged or cut short", AGAIN),
    (b"CDF\x01", "begins as netCDF does and is damaged or cut short", AGAIN),
    (b"CDF\x02", "begins as netCDF does and is damaged or cut short", AGAIN),
    (b"CDF\x05", "begins as netCDF does and is damaged or cut short", AGAIN),
    (b"\x0e\x03\x13\x01", "begins as HDF4 does and is damaged or cut short", AGAIN),
    (b"version https://git-lfs", "is a pointer of git-LFS, not the raster itself", "fetch that: `git lfs pull`"),
];

/// Where a tar archive says that it is one.
const TAR: (usize, &[u8]) = (257, b"ustar");
/// Bytes of the longest answer.
const ANSWER: usize = 400;
/// Letters of a page or message that are quoted.
const QUOTED: usize = 60;

/// Whether a file that begins so is a tar archive.
pub(super) fn is_tar(head: &[u8]) -> bool {
    head.get(TAR.0..).is_some_and(|rest| rest.starts_with(TAR.1))
}

/// What a file is that begins with `head` and is no raster; `name` is its last name, in small letters.
pub(super) fn what(head: &[u8], name: &str) -> Option<Told> {
    if let Some((mark, what, remedy)) = MARKS.iter().find(|(mark, ..)| head.starts_with(mark)) {
        // The archive inside may be one, too.
        let tar = name.contains(".tar") && !mark.starts_with(b"PK");
        return Some(((*what).to_owned(), if tar { "unpack it: `tar -xkf IN`".into() } else { (*remedy).to_owned() }));
    }
    if is_tar(head) {
        return Some(("is a tar archive by another name".into(), "unpack it: `tar -xkf IN`".into()));
    }
    if head.len() >= 16 && head.iter().all(|byte| *byte == 0) {
        let what = "begins with zeros alone, as a download does that was cut off";
        return Some((what.into(), "copy or download it again".into()));
    }
    text(&String::from_utf8_lossy(head))
}

/// What a file is that begins with `head` and is one line of words, as servers answer in a file's place. A raster's own
/// text has more than that.
pub(super) fn answer(head: &[u8]) -> Option<Told> {
    let line = str::from_utf8(head).ok()?.trim();
    let is_line = line.starts_with(char::is_alphanumeric) && line.len() <= ANSWER && !line.contains(char::is_control);
    let has_words = line.split(|c: char| !c.is_alphabetic()).any(|word| word.len() >= 3);
    let what = || format!("is one line of text, not a raster{}", quoted(Some(line)));
    let remedy = "download it again, after mending the request if that is the answer of a server";
    (is_line && has_words).then(|| (what(), remedy.into()))
}

/// What a text is.
fn text(head: &str) -> Option<Told> {
    let head = head.trim_start_matches('\u{feff}').trim_start();
    let small = head.to_ascii_lowercase();
    if head.starts_with('<') && ["<!doctype html", "<html", "<head", "<body"].iter().any(|tag| small.contains(tag)) {
        let what = format!("is a web page{}, not a raster", quoted(inner(head, &small, "title")));
        let remedy = "open its address in a browser and download the file itself, logged in where that is needed";
        return Some((what, remedy.into()));
    }
    if head.starts_with("/annex/objects/") || head.starts_with("../.git/annex/") {
        return Some((
            "is a pointer of git-annex, not the raster itself".into(),
            "fetch that: `git annex get IN`".into(),
        ));
    }
    let answer = "download it again, after mending the request if it holds an error of the server";
    let opened =
        |open: char, next: &[char]| head.strip_prefix(open).is_some_and(|rest| rest.trim_start().starts_with(next));
    if opened('{', &['"', '}']) || opened('[', &['{', '"', ']']) {
        return Some((format!("is JSON, not a raster{}", quoted(Some(head))), answer.into()));
    }
    // GDAL's own services and VRTs are XML, too, and are spoken of elsewhere.
    if head.starts_with('<') && !small.contains("<gdal_") && !small.contains("<vrtdataset") {
        let message = ["message", "ows:exceptiontext", "exceptiontext", "serviceexception", "title", "code"];
        let message = message.iter().find_map(|tag| inner(head, &small, tag));
        return Some((format!("is XML, not a raster{}", quoted(message.or(Some(head)))), answer.into()));
    }
    None
}

/// The text of the first element of that name; `small` is `head` in small letters.
fn inner<'a>(head: &'a str, small: &str, tag: &str) -> Option<&'a str> {
    let open = small.find(&format!("<{tag}")).map(|at| at + 1 + tag.len())?;
    let start = open + small[open..].find('>')? + 1;
    let end = start + small[start..].find('<')?;
    Some(head[start..end].trim()).filter(|text| !text.is_empty())
}

/// The beginning of a text, in brackets.
fn quoted(text: Option<&str>) -> String {
    let Some(text) = text else { return String::new() };
    let words: String = text.split_whitespace().collect::<Vec<_>>().join(" ").chars().take(QUOTED).collect();
    format!(" ({words:?})")
}
