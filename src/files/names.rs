//! Paths as texts, whatever stands there.

use std::path::{Component, Path, PathBuf, absolute};

/// A path without `.` and `..`. Not handled: links to folders that are left by `..`.
pub(crate) fn straight(path: &Path) -> PathBuf {
    path.components().fold(PathBuf::new(), |mut path, part| {
        match part {
            Component::ParentDir => drop(path.pop()),
            Component::CurDir => {}
            part => path.push(part),
        }
        path
    })
}

/// The way from a folder to a file; the absolute path where there is none.
pub(crate) fn relative(folder: &Path, file: &Path) -> PathBuf {
    let plain = |path: &Path| straight(&absolute(path).unwrap_or_else(|_| path.to_owned()));
    let (folder, file) = (plain(folder), plain(file));
    let shared = folder.components().zip(file.components()).take_while(|(a, b)| a == b).count();
    if shared == 0 {
        return file;
    }
    let up = folder.components().skip(shared).map(|_| Component::ParentDir);
    up.chain(file.components().skip(shared)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ways_between_folders_lead_there() {
        for (folder, file, way) in [
            ("/a/b", "/a/b/c.png", "c.png"),
            ("/a/b", "/a/d/c.png", "../d/c.png"),
            ("/a/b/../e", "/a/./e/c.png", "c.png"),
            ("/a/b/c", "/d.png", "../../../d.png"),
            (".", "c.png", "c.png"),
            ("x", "y/c.png", "../y/c.png"),
        ] {
            assert_eq!(relative(Path::new(folder), Path::new(file)), Path::new(way), "{folder} {file}");
        }
    }
}
