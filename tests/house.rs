//! The order of the folders: each imports only what stands above it.

use std::fs;
use std::path::{Path, PathBuf};

use clap::CommandFactory;
use hachure::door::cli::Arguments;

/// Folders and files of `src` in the order in which the data flows; errors are everyone's.
const ORDER: [&str; 20] = [
    "error", "files", "cache", "dem", "geo", "surface", "relief", "view", "plan", "gpu", "line", "ink", "truth",
    "render", "measure", "job", "stress", "report", "cli", "door",
];

/// What truth may know.
const TRUTH: [&str; 5] = ["error", "dem", "surface", "view", "truth"];

/// Macros of the crate that are imported as modules are.
const MACROS: [&str; 2] = ["message", "shader"];

/// What report may know: what was found, by which methods, and how to write it.
const REPORT: [&str; 8] = ["error", "files", "plan", "ink", "truth", "measure", "stress", "report"];

/// Modules of the crate that a source names, macros left out.
fn named(source: &str) -> Vec<&str> {
    let code = source.lines().filter(|line| !line.trim_start().starts_with("//"));
    let paths = code.flat_map(|line| line.split("crate::").skip(1));
    let end = |path: &str| path.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(path.len());
    paths
        .map(|path| path.split_at(end(path)))
        .filter(|(name, rest)| !rest.starts_with('!') && !MACROS.contains(name))
        .map(|(name, _)| name)
        .collect()
}

/// Modules that a source of `folder` names against the order.
fn against<'a>(folder: &str, source: &'a str) -> Vec<&'a str> {
    let place = |name: &str| ORDER.iter().position(|known| *known == name);
    named(source).into_iter().filter(|name| place(name).is_none_or(|at| Some(at) > place(folder))).collect()
}

/// Whether a source names one of the crates of GDAL by a path; tools in messages and a module of ours are none.
fn names_gdal(source: &str) -> bool {
    let code = source.lines().filter(|line| !line.trim_start().starts_with("//"));
    let mut paths = code.flat_map(|line| line.split(|c: char| !c.is_alphanumeric() && c != '_' && c != ':'));
    paths.any(|path| {
        let path = path.trim_start_matches("::");
        path.starts_with("gdal::") || path.starts_with("gdal_sys::")
    })
}

/// Every text in a folder of the repository and in its folders: a font is none.
fn files(folder: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut open = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join(folder)];
    while let Some(path) = open.pop() {
        match path.is_dir() {
            true => open.extend(fs::read_dir(&path).expect("a folder").map(|entry| entry.expect("an entry").path())),
            false => found.push(path),
        }
    }
    found.retain(|path| path.extension().is_none_or(|ending| ending != "ttf"));
    found
}

/// Every source below `src` but the roots, with the folder or file of `src` it belongs to.
fn sources() -> Vec<(String, PathBuf)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut found = Vec::new();
    for path in files("src") {
        let below = path.strip_prefix(&root).expect("below src").to_path_buf();
        let folder = below.components().next().expect("a name").as_os_str().to_string_lossy().replace(".rs", "");
        if !["lib", "main", "build"].contains(&folder.as_str()) {
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
fn gdal_is_known_in_its_room_alone() {
    let room = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/geo/gdal");
    let (inside, outside): (Vec<_>, Vec<_>) =
        sources().into_iter().map(|(_, path)| path).partition(|path| path.starts_with(&room));
    let names = |path: &PathBuf| names_gdal(&fs::read_to_string(path).expect("a source"));
    let strange: Vec<_> = outside.iter().filter(|path| names(path)).collect();
    assert!(strange.is_empty(), "{strange:?} name GDAL");
    assert!(inside.iter().filter(|path| names(path)).count() > 10, "the check must see GDAL where it is");
    for source in ["use gdal::Dataset;", "    unsafe { ::gdal_sys::GDALOpen() }", "x(gdal::raster::Band::new)"] {
        assert!(names_gdal(source), "{source}");
    }
    for source in ["use self::gdal::Reading;", "mod gdal;", "\"`gdal_translate IN OUT.tif`\"", "// gdal::Dataset"] {
        assert!(!names_gdal(source), "{source}");
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
    assert_eq!(named("use crate::message;\nuse crate::messages::Thing;"), ["messages"], "a macro is no module");
    assert!(named("use crate::gpu::Gpu;").iter().any(|name| !TRUTH.contains(name)), "truth may not know gpu");
    assert!(named("use crate::render::Renderer;").iter().any(|name| !REPORT.contains(name)), "report draws nothing");
}

/// Long flags of a command and of all below it, with their dashes.
fn flags(command: &clap::Command) -> Vec<String> {
    let own = command.get_arguments().filter_map(|flag| flag.get_long()).map(|flag| format!("--{flag}"));
    own.chain(command.get_subcommands().flat_map(flags)).collect()
}

/// Which of `flags` a text speaks of, in code, words or comments, long, as the short `-o`, or by way of the subcommand that
/// takes them; flags of other programs are words like any others.
fn spoken<'a>(text: &'a str, flags: &[String]) -> Vec<&'a str> {
    let end = |rest: &str| rest.find(|c: char| !c.is_ascii_alphanumeric() && c != '-').unwrap_or(rest.len());
    let dashed = text.match_indices("--").map(|(at, _)| &text[at..at + end(&text[at..])]);
    let typed = [" -o", "hachure draw"].into_iter().filter(|typed| {
        let mut ends = text.match_indices(typed).map(|(at, _)| &text[at + typed.len()..]);
        ends.any(|rest| !rest.starts_with(|c: char| c.is_ascii_alphanumeric() || c == '-'))
    });
    dashed.filter(|word| flags.iter().any(|flag| flag == word)).chain(typed).collect()
}

#[test]
fn only_the_command_line_speaks_of_flags() {
    let flags = flags(&Arguments::command());
    assert!(flags.len() > 40, "only {flags:?}");
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let core: Vec<_> = [files("src"), files("shaders")].concat();
    let core: Vec<_> =
        core.into_iter().filter(|path| !path.starts_with(root.join("cli")) && *path != root.join("main.rs")).collect();
    assert!(core.len() > 100 && core.contains(&root.join("lib.rs")), "only {} sources", core.len());
    for path in core {
        let source = fs::read_to_string(&path).expect("a source");
        let spoken = spoken(&source, &flags);
        assert!(spoken.is_empty(), "{} speaks of {spoken:?}: a setting has a name, see error::Setting", path.display());
    }
}

#[test]
fn a_flag_in_the_core_is_noticed() {
    let flags = flags(&Arguments::command());
    let of = |text| spoken(text, &flags);
    assert_eq!(of("remedy: \"use --crop, or a smaller --size\".into()"), ["--crop", "--size"]);
    assert_eq!(of("format!(\"`--crop {west}`, --resample={metres}\")"), ["--crop", "--resample"]);
    assert_eq!(of("/// For `--fill-voids`.\n// -q and --quiet"), ["--fill-voids", "--quiet"]);
    assert_eq!(of("`hachure draw a.tif -o b.png`"), [" -o", "hachure draw"]);
    assert_eq!(of("a hachure drawn by hand, -of and -outsize of GDAL"), [""; 0]);
    assert_eq!(of("`gdal_translate --config GDAL_VRT_ENABLE_PYTHON YES IN OUT.tif`, `ulimit -v`"), [""; 0]);
    assert_eq!(of("color: var(--ink); --paper: #fff; NW----NE  o--o--o  --cropped, --no-crop"), [""; 0]);
    let cli = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("src/cli/words.rs")).expect("a source");
    assert!(of(&cli).len() > 30, "the command line speaks of them");
}
