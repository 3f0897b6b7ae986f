//! PROJ's register of coordinate systems (proj.db): which one it takes, and what to do where that cannot be used.
//!
//! PROJ looks in the folders of `PROJ_DATA`, else of `PROJ_LIB`, and in no others where one of them is set; else in the
//! user's own folder, then in its own. Nothing is opened here: PROJ has failed, and this says on which file.

use std::env;
use std::path::PathBuf;

use crate::error::{Error, shown};

/// Variables that say where it lies, the first before the second.
const VARIABLES: [&str; 2] = ["PROJ_DATA", "PROJ_LIB"];
const FILE: &str = "proj.db";

/// The error of PROJ without a register, with GDAL's `words`.
pub(super) fn error(words: Option<String>) -> Error {
    let words = words.unwrap_or_default();
    let set: Vec<_> = VARIABLES.into_iter().filter(|name| env::var_os(name).is_some_and(|v| !v.is_empty())).collect();
    let folders = set.first().and_then(env::var_os);
    let named: Vec<_> = folders.iter().flat_map(env::split_paths).map(|folder| folder.join(FILE)).collect();
    let own = dirs::data_local_dir().map(|folder| folder.join("proj").join(FILE));
    let found = if set.is_empty() { own.filter(|file| file.is_file()) } else { None };
    let found = named.iter().find(|file| file.is_file()).cloned().or(found);
    let what = match (&found, named.first()) {
        (Some(file), _) => format!(
            "PROJ's register of coordinate systems {} cannot be used: {}",
            shown(file),
            if words.contains("another PROJ") { "it is of another version of PROJ" } else { "it is none, or damaged" }
        ),
        (None, Some(file)) => {
            format!(
                "PROJ cannot find its register of coordinate systems where {} points: {} is not there",
                set[0],
                shown(file)
            )
        }
        (None, None) => format!("PROJ cannot find its register of coordinate systems ({FILE})"),
    };
    Error::limit(what, remedy(&set, found))
}

fn remedy(set: &[&str], found: Option<PathBuf>) -> String {
    match found {
        _ if !set.is_empty() => format!(
            "let PROJ find its own: `unset {}`, or set {} to the folder of a sound proj.db",
            set.join(" "),
            set.join(" and ")
        ),
        Some(file) => format!("move it away: `mv -n {0} {0}.old`", super::shell::quoted(file.as_os_str())),
        None => {
            "install PROJ's data (Debian: `apt-get install proj-data`), or set PROJ_DATA and PROJ_LIB to the folder \
                 of a proj.db"
                .into()
        }
    }
}
