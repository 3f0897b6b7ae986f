//! What a DEM may be called: local files, archives, grids in containers; where they are allowed files on a network too.
//!
//! GDAL takes many strings for something else than a file: addresses, pipes, memory, connections, one inside another.
//! Every name is taken apart here, as [`lossless`] text, and what is not understood to its end is refused; nothing is
//! opened. Not handled: archives in archives, and a file swapped for another between check and use.

use std::path::{Path, PathBuf};

use super::lossless;

/// Ways into an archive. The rest of the name is the archive and perhaps a file in it.
const ARCHIVES: [&str; 3] = ["/vsizip/", "/vsigzip/", "/vsitar/"];

/// Ways to files on a network that GDAL reads piece by piece.
const REMOTE: [&str; 9] =
    ["/vsicurl/", "/vsis3/", "/vsigs/", "/vsiaz/", "/vsiadls/", "/vsioss/", "/vsiswift/", "/vsihdfs/", "/vsiwebhdfs/"];

/// Addresses as people write them, and what GDAL writes before the rest.
const SCHEMES: [(&str, &str); 6] = [
    ("http://", "/vsicurl/http://"),
    ("https://", "/vsicurl/https://"),
    ("ftp://", "/vsicurl/ftp://"),
    ("s3://", "/vsis3/"),
    ("gs://", "/vsigs/"),
    ("az://", "/vsiaz/"),
];

/// Names of one grid of a container: the prefix, how many fields follow it, which of them is the file. With another
/// count of fields GDAL might see the file elsewhere: `NETCDF:http://host/file:grid` has three.
const CONTAINERS: [(&str, usize, usize); 8] = [
    ("NETCDF", 2, 0),
    ("HDF5", 2, 0),
    ("BAG", 2, 0),
    ("GPKG", 2, 0),
    ("GTIFF_DIR", 2, 1),
    ("GTIFF_DIR", 3, 2),
    ("HDF4_SDS", 3, 1),
    ("HDF4_EOS", 4, 1),
];

/// A name taken apart.
#[derive(Debug)]
pub(super) enum Name {
    /// A local file.
    Local(Local),
    /// A file on a network, as GDAL calls it.
    Remote(PathBuf),
    /// A pipe, memory, a database, a web service, another construction of GDAL's.
    Other,
}

/// Where a raster lies.
#[derive(Debug, Clone)]
pub(super) enum RasterPlace {
    /// In this file on the disk.
    File(PathBuf),
    /// In a file in this archive on the disk.
    Archive(PathBuf),
    /// On a network.
    Remote,
}

/// A local file, or one grid or file in it: GDAL calls it `before`, `file`, `after`.
#[derive(Debug)]
pub(super) struct Local {
    before: String,
    /// The file, container or archive on the disk.
    pub file: PathBuf,
    after: String,
    /// Whether `file` is read through as an archive.
    pub archive: bool,
}

impl Local {
    /// A file by the ending of its name: `.gz`, `.zip` and `.tar`, packed or not, are read through.
    pub(super) fn by_ending(file: &Path) -> Self {
        let ending = file.file_name().map(lossless::text).unwrap_or_default().to_ascii_lowercase();
        let before = match ending.rsplit('.').next() {
            _ if ending.ends_with(".tar.gz") => "/vsitar/",
            Some("tar" | "tgz") => "/vsitar/",
            Some("gz") => "/vsigzip/",
            Some("zip") => "/vsizip/",
            _ => "",
        };
        Self { before: before.into(), file: file.into(), after: String::new(), archive: !before.is_empty() }
    }

    /// What GDAL is asked to open.
    pub(super) fn connection(&self) -> PathBuf {
        let mut name = lossless::name(&self.before);
        name.push(&self.file);
        name.push(lossless::name(&self.after));
        name.into()
    }

    /// The way into the archive that holds it, as GDAL calls it; empty where it is read as it stands.
    pub(super) fn way(&self) -> &str {
        if self.archive { &self.before } else { "" }
    }

    /// Where it lies.
    pub(super) fn place(&self) -> RasterPlace {
        if self.archive { RasterPlace::Archive(self.file.clone()) } else { RasterPlace::File(self.file.clone()) }
    }

    /// What a plain name in a file of that name on a network stands for.
    pub(super) fn beside(&self, remote: &Path) -> Option<PathBuf> {
        let plain = self.before.is_empty() && self.after.is_empty() && !self.file.is_absolute();
        let (folder, _) = remote.to_str()?.rsplit_once('/')?;
        plain.then(|| format!("{folder}/{}", self.file.to_string_lossy()).into())
    }

    /// The archive and the file in it in `inner`.
    fn in_archive(before: &str, inner: &str) -> Self {
        // The archive is the part of the way that is a file.
        let way = PathBuf::from(lossless::name(inner));
        let archive = way.ancestors().find(|way| way.is_file()).unwrap_or(&way);
        let after = inner[lossless::text(archive.as_os_str()).len()..].to_owned();
        Self { before: before.into(), file: archive.into(), after, archive: true }
    }

    /// One grid of a container.
    fn in_container(text: &str) -> Option<Self> {
        let (prefix, rest) = text.split_once(':')?;
        let fields = fields(rest);
        let (_, _, place) = CONTAINERS.iter().find(|c| c.0.eq_ignore_ascii_case(prefix) && c.1 == fields.len())?;
        let bare = fields[*place].trim_matches('"');
        let quote = if bare.len() < fields[*place].len() { "\"" } else { "" };
        let before = fields[..*place].iter().fold(format!("{prefix}:"), |text, field| text + field + ":") + quote;
        let after = fields[place + 1..].iter().fold(quote.to_owned(), |text, field| text + ":" + field);
        Some(Self { before, file: lossless::name(bare).into(), after, archive: false })
    }
}

impl Name {
    /// Takes `text` apart.
    pub(super) fn of(text: &str) -> Self {
        if let Some((scheme, prefix)) = SCHEMES.iter().find(|(scheme, _)| starts_with(text, scheme)) {
            return Self::Remote(format!("{prefix}{}", &text[scheme.len()..]).into());
        }
        if text.starts_with("/vsi") {
            return Self::of_virtual(text);
        }
        match Local::in_container(text) {
            Some(grid) if is_no_file(&lossless::text(grid.file.as_os_str())) => Self::Other,
            Some(grid) => Self::Local(grid),
            None if is_connection(text) => Self::Other,
            None => {
                let file = lossless::name(text).into();
                Self::Local(Local { before: String::new(), file, after: String::new(), archive: false })
            }
        }
    }

    fn of_virtual(text: &str) -> Self {
        let archive = ARCHIVES.iter().find_map(|before| Some((*before, text.strip_prefix(before)?)));
        let inner = archive.map_or(text, |(_, inner)| inner);
        match archive {
            _ if REMOTE.iter().any(|prefix| inner.starts_with(prefix)) => Self::Remote(lossless::name(text).into()),
            Some((before, inner)) if !inner.starts_with("/vsi") && !inner.starts_with('{') => {
                Self::Local(Local::in_archive(before, inner))
            }
            _ => Self::Other,
        }
    }
}

/// Whether what stands in the place of a container's file is none.
fn is_no_file(text: &str) -> bool {
    names_remote(text) || text.contains('"')
}

/// Whether `text` begins as the name of something that is not on the disk.
pub(super) fn names_remote(text: &str) -> bool {
    starts_with(text, "/vsi") || SCHEMES.iter().any(|(scheme, _)| starts_with(text, scheme))
}

/// `PG:…`, `WMS:…`, `MEM:::…`, `vrt://…`, XML in place of a name; not the drive of `C:\…`.
fn is_connection(text: &str) -> bool {
    let prefix = text.split(':').next().unwrap_or_default();
    let is_prefix = prefix.len() > 1 && prefix.len() < text.len();
    let shouts = prefix.bytes().all(|b| b.is_ascii_uppercase() || b.is_ascii_digit() || b == b'_');
    text.starts_with('<') || is_prefix && (shouts || text[prefix.len()..].starts_with("://"))
}

/// Splits at the colons outside quotes, and not behind the letter of a drive.
fn fields(text: &str) -> Vec<&str> {
    let (mut quoted, mut start) = (false, 0);
    let mut fields = Vec::new();
    for (place, letter) in text.char_indices() {
        quoted ^= letter == '"';
        let drive = cfg!(windows) && place == start + 1;
        if letter == ':' && !quoted && !drive {
            fields.push(&text[start..place]);
            start = place + 1;
        }
    }
    fields.push(&text[start..]);
    fields
}

/// Whether `text` begins with the ASCII `start`, in capitals or not.
fn starts_with(text: &str, start: &str) -> bool {
    text.get(..start.len()).is_some_and(|head| head.eq_ignore_ascii_case(start))
}
