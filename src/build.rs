//! The build script: a hash of all sources, by which pictures know whether the same program would draw them again.

use std::fs;
use std::path::{Path, PathBuf};

use xxhash_rust::xxh3::Xxh3;

/// What the program is made of; what cargo is to look at for changes.
const SOURCES: [&str; 3] = ["src", "shaders", "Cargo.lock"];

fn main() {
    let mut hash = Xxh3::new();
    for source in SOURCES {
        println!("cargo:rerun-if-changed={source}");
        let mut files = files(Path::new(source));
        files.sort();
        for file in files {
            let bytes = fs::read(&file).unwrap_or_default();
            hash.update(file.to_string_lossy().replace('\\', "/").as_bytes());
            hash.update(&(bytes.len() as u64).to_le_bytes());
            hash.update(&bytes);
        }
    }
    println!("cargo:rustc-env=HACHURE_SOURCES={:016x}", hash.digest());
}

/// The file, or all in the folder and its folders.
fn files(path: &Path) -> Vec<PathBuf> {
    match fs::read_dir(path) {
        Ok(entries) => entries.flatten().flat_map(|entry| files(&entry.path())).collect(),
        Err(_) => vec![path.to_owned()],
    }
}
