//! The order of the folders: each imports only what stands above it.

use std::fs;
use std::path::{Path, PathBuf};

/// Folders and files of `src` in the order in which the data flows; errors are everyone's.
const ORDER: [&str; 14] = [
    "error", "files", "cache", "dem", "surface", "view", "plan", "gpu", "ink", "truth", "render", "measure", "report",
    "cli",
];

/// What truth may know.
const TRUTH: [&str; 5] = ["error", "dem", "surface", "view", "truth"];

/// What report may know: what was found, and how to write it.
const REPORT: [&str; 6] = ["error", "files", "ink", "truth", "measure", "report"];

/// Modules of the crate that a source names, macros left out.
fn named(source: &str) -> Vec<&str> {
    let code = source.lines().filter(|line| !line.trim_start().starts_with("//"));
    let paths = code.flat_map(|line| line.split("crate::").skip(1));
    let end = |path: &str| path.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(path.len());
    paths
        .map(|path| path.split_at(end(path)))
        .filter(|(_, rest)| !rest.starts_with('!'))
        .map(|(name, _)| name)
        .collect()
}

/// Modules that a source of `folder` names against the order.
fn against<'a>(folder: &str, source: &'a str) -> Vec<&'a str> {
    let place = |name: &str| ORDER.iter().position(|known| *known == name);
    named(source).into_iter().filter(|name| place(name).is_none_or(|at| Some(at) > place(folder))).collect()
}

/// Every source below `src` but the roots, with the folder or file of `src` it belongs to.
fn sources() -> Vec<(String, PathBuf)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut found = Vec::new();
    let mut open = vec![root.clone()];
    while let Some(path) = open.pop() {
        if path.is_dir() {
            open.extend(fs::read_dir(&path).expect("a folder").map(|entry| entry.expect("an entry").path()));
            continue;
        }
        let below = path.strip_prefix(&root).expect("below src").to_path_buf();
        let folder = below.components().next().expect("a name").as_os_str().to_string_lossy().replace(".rs", "");
        if folder != "lib" && folder != "main" {
            found.push((folder, path));
        }
    }
    found
}

#[test]
fn folders_import_only_what_stands_above_them() {
    let sources = sources();
    assert!(sources.len() > 50, "only {} sources", sources.len());
    let unknown = sources.iter().find(|(folder, _)| !ORDER.contains(&folder.as_str()));
    assert!(unknown.is_none(), "{unknown:?} has no place in the order");
    for (folder, path) in &sources {
        let source = fs::read_to_string(path).expect("a source");
        let against = against(folder, &source);
        assert!(against.is_empty(), "{} names {against:?}, which stand below {folder}", path.display());
        let known = match folder.as_str() {
            "truth" => &TRUTH[..],
            "report" => &REPORT[..],
            _ => &ORDER[..],
        };
        let strange = named(&source).into_iter().find(|name| !known.contains(name));
        assert!(strange.is_none(), "{} names {strange:?}", path.display());
    }
}

#[test]
fn an_import_from_below_is_noticed() {
    assert_eq!(against("truth", "use crate::gpu::Gpu;\nuse crate::view::Camera;"), Vec::<&str>::new());
    assert_eq!(against("gpu", "use crate::plan::Plan;\nlet x = crate::truth::Truth::new();"), ["truth"]);
    assert_eq!(
        against("dem", "    use crate::{surface::Surface, view};"),
        [""],
        "a list is not looked into: write one line each"
    );
    assert_eq!(
        against("ink", "// crate::cli is below\n/// [`crate::cli`]\ncrate::shader!(\"ink\")"),
        Vec::<&str>::new()
    );
    assert_eq!(against("ink", "use crate::nowhere::Thing;"), ["nowhere"], "what has no place");
    assert!(named("use crate::gpu::Gpu;").iter().any(|name| !TRUTH.contains(name)), "truth may not know gpu");
    assert!(named("use crate::render::Renderer;").iter().any(|name| !REPORT.contains(name)), "report draws nothing");
}
