//! What is new in a shader is declared: every constant, every struct that is bound and every pipeline constant is either
//! compared with Rust or said to be the shaders' own, with the reason.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use hachure::door::gpu::shaders::OWN_CONSTANTS as OF_ONE_PASS;
use hachure::door::gpu::sizes::LIST_HEADER;
use hachure::door::plan::PassName;
use wgpu::naga;

use super::{all_modules, bound, constants, layouts, shader_of, shared_constants, shared_structs};

/// Constants that are the shaders' own, and why Rust need not know them.
const OWN_CONSTANTS: [(&str, &str); 40] = [
    ("HOLDS_TOWARD", "bit of a word of a chunk: set by turning and wanted, read by the passes behind them"),
    ("HOLDS_AWAY", "as HOLDS_TOWARD"),
    ("BOTH", "as HOLDS_TOWARD"),
    ("WANTED", "as HOLDS_TOWARD"),
    ("DRAWN", "as HOLDS_TOWARD"),
    ("MOST_PIXELS", "how many pixels wanted looks at before a chunk counts as seen"),
    ("SIDES_AT", "which word around a chunk wanted writes, and turn and meet read"),
    ("MOST_PARTS", "into how many parts list_line cuts a line"),
    ("NEARER", "room for rounding and slopes where wanted and list_line leave out what is hidden"),
    ("CONCAVE", "where list_line leaves out what hides itself"),
    ("NUDGE", "how far off the surface sight looks"),
    ("MOST_NUDGE", "as NUDGE"),
    ("BESIDE_LINE", "how near to a line sight looks over facets that face away"),
    ("OUTWARD", "how far outwards sight looks for what lies behind"),
    ("LEFT", "flag of a vertex: set by project, read by rasterize"),
    ("RIGHT", "as LEFT"),
    ("ABOVE", "as LEFT"),
    ("BELOW", "as LEFT"),
    ("BEHIND", "as LEFT"),
    ("BEYOND_GUARD", "as LEFT"),
    ("NO_HEIGHT", "height of a missing vertex: set by tessellate, read by facing and project"),
    ("NO_PLACE", "place of a clipped vertex: set by project, read by rasterize"),
    ("GUARD", "where project and rasterize_large clip"),
    ("SILHOUETTE", "bit of a word of ink: set by the methods, told by compose as a kind"),
    ("SLACK", "room for rounding in f32"),
    ("LARGEST_BOX", "up to where edge functions fit 32 bits"),
    ("SHARE_TILES", "how rasterize cuts a facet for rasterize_large"),
    ("TILE", "as SHARE_TILES"),
    ("EDGE_LIMIT", "up to where edge functions fit 32 bits"),
    ("CUT", "corner of a clipped polygon, within one invocation"),
    ("OVERSHOOT", "share by which walk_rest aims beyond the centre of a pixel"),
    ("BESIDE_PAIR", "from where on walk leaves what it met to walk_rest"),
    ("FINER", "how fine walk looks at the surface under a facet"),
    ("ISLAND", "share of away facets about one, up to which walk doubts it"),
    ("LEAST_HIDDEN", "what walk_rest passes by"),
    ("MOST_STRETCHES", "how often it does"),
    ("SEEN_TOWARD", "nodes through which it looks for where an away stretch ends"),
    ("NO_FACET", "no facet, within one invocation"),
    ("LONGEST_SECTION", "facets that walk_rest follows a cut over"),
    ("NONE", "no depth, within one invocation"),
];

/// Structs that are bound and have no size: words of [`LIST_HEADER`] and items without end.
const LISTS: [&str; 3] = ["List", "ListRead", "Queue"];

/// Pipeline constants that keep the default of their shader: the pass, the constant, why.
const LEFT_AT_DEFAULT: [(&str, &str, &str); 3] = [
    ("walk", "defers", "what is rare is left to walk_rest, which sets it for itself"),
    ("segments", "defers", "it stands on walk, and walks nowhere"),
    ("rim_segments", "defers", "as segments"),
];

/// Whether a constant of a shader is compared, or the shaders' own.
fn is_declared(name: &str) -> bool {
    shared_constants().iter().any(|(shared, _)| *shared == name) || OWN_CONSTANTS.iter().any(|(own, _)| *own == name)
}

/// Names of the structs in what a module binds.
fn bound_structs(module: &naga::Module) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    let mut open: Vec<_> =
        module.global_variables.iter().filter(|(_, g)| g.binding.is_some()).map(|(_, g)| g.ty).collect();
    while let Some(ty) = open.pop() {
        match &module.types[ty].inner {
            naga::TypeInner::Array { base, .. } => open.push(*base),
            naga::TypeInner::Struct { members, .. } => {
                found.extend(module.types[ty].name.clone());
                open.extend(members.iter().map(|member| member.ty));
            }
            _ => {}
        }
    }
    found
}

/// The lines of all sources in folders of `src`, with the name of their file.
fn sources(folders: &[&str]) -> Vec<(String, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut open: Vec<PathBuf> = folders.iter().map(|folder| root.join(folder)).collect();
    let mut found = Vec::new();
    while let Some(path) = open.pop() {
        if path.is_dir() {
            open.extend(fs::read_dir(&path).expect("a folder").map(|entry| entry.expect("an entry").path()));
        } else {
            let stem = path.file_stem().expect("a name").to_string_lossy().into_owned();
            found.push((stem, fs::read_to_string(&path).expect("a source")));
        }
    }
    assert!(found.len() > folders.len(), "{folders:?} hold {} sources", found.len());
    found
}

/// Whether a source declares a number of this name: constants that are `Self` are none.
fn declares(source: &str, name: &str) -> bool {
    let wanted = format!("const {name}:");
    let code = source.lines().filter(|line| !line.trim_start().starts_with("//"));
    code.filter_map(|line| line.split_once(&wanted)).any(|(_, declared)| !declared.starts_with(" Self"))
}

/// Pipeline constants of a pass that nobody sets: neither the table of those of one pass nor a source beside it says their names.
fn unset<'a>(pass: &str, module: &'a naga::Module, sources: &[(String, String)]) -> Vec<&'a str> {
    let names = module.overrides.iter().filter_map(|(_, constant)| constant.name.as_deref());
    let speaks = |file: &str| file != "shaders";
    let own = |name: &str| OF_ONE_PASS.iter().any(|(of, (constant, _))| of.name() == pass && *constant == name);
    let is_set = |name: &&str| {
        sources.iter().any(|(file, source)| speaks(file) && source.contains(&format!("\"{name}\"")))
            || own(name)
            || LEFT_AT_DEFAULT.iter().any(|(of, constant, _)| of == &pass && constant == name)
    };
    names.filter(|name| !is_set(name)).collect()
}

#[test]
fn every_constant_of_a_shader_is_compared_or_its_own() {
    let mut seen = BTreeSet::new();
    for (name, module) in all_modules() {
        let constants = constants(&module);
        let strange: Vec<_> = constants.keys().filter(|constant| !is_declared(constant)).collect();
        assert!(strange.is_empty(), "{name} has {strange:?}: compare them, or say why they are its own");
        seen.extend(constants.into_keys());
    }
    // Nor may a name that shaders have for themselves mean something where Rust speaks to them.
    let sources = sources(&["surface", "plan", "gpu"]);
    for (own, why) in OWN_CONSTANTS {
        assert!(!why.is_empty() && seen.contains(own), "no shader has {own}");
        assert!(!shared_constants().iter().any(|(name, _)| *name == own), "{own} is compared");
        let other = sources.iter().find(|(_, source)| declares(source, own));
        assert!(other.is_none(), "{own} is declared in {:?} too: compare the two", other.map(|(file, _)| file));
    }
}

#[test]
fn every_struct_that_is_bound_is_compared() {
    for (name, module) in all_modules() {
        let structs = layouts(&module);
        for bound in bound_structs(&module) {
            if LISTS.contains(&bound.as_str()) {
                let (members, _) = &structs[&bound];
                let header: Vec<_> = members.iter().map(|(member, offset, _)| (member.as_str(), *offset)).collect();
                let words = [("groups_x", 0), ("groups_y", 4), ("groups_z", 8), ("count", 12)];
                assert_eq!(header[..4], words, "{name}: {bound}");
                assert_eq!((header.len(), header[4].1 as u64), (5, LIST_HEADER), "{name}: {bound}");
            } else {
                assert!(shared_structs().iter().any(|(shared, _)| *shared == bound), "{name} binds a {bound}");
            }
        }
    }
}

#[test]
fn every_pipeline_constant_is_set_or_left_on_purpose() {
    // The registry of methods sets those of their own passes.
    let sources = sources(&["gpu", "plan"]);
    let modules = all_modules();
    for (name, module) in modules.iter().filter(|(name, _)| *name != "depth_draw") {
        let unset = unset(name, module, &sources);
        assert!(unset.is_empty(), "nobody sets {unset:?} of {name}");
    }
    for (pass, constant, why) in LEFT_AT_DEFAULT {
        let has = |module: &naga::Module| module.overrides.iter().any(|(_, o)| o.name.as_deref() == Some(constant));
        assert!(
            !why.is_empty() && modules.iter().any(|(name, module)| *name == pass && has(module)),
            "{pass}: {constant}"
        );
    }
}

#[test]
fn what_is_new_in_a_shader_is_noticed() {
    let parse =
        |more: &str| naga::front::wgsl::parse_str(&format!("{}\n{more}", shader_of(PassName::Seam))).expect("WGSL");
    let strangers =
        |more: &str| constants(&parse(more)).into_keys().filter(|name| !is_declared(name)).collect::<Vec<_>>();
    assert_eq!(strangers(""), Vec::<String>::new());
    assert_eq!(strangers("const MOST_STEPS: u32 = 12u;"), ["MOST_STEPS"]);
    let tree = "struct Tree { root: u32 } @group(0) @binding(30) var<storage, read> trees: array<Tree>;";
    assert!(bound_structs(&parse(tree)).contains("Tree") && !bound_structs(&parse("")).contains("Tree"));
    let sources = sources(&["gpu"]);
    assert_eq!(unset("seam", &parse(""), &sources), Vec::<&str>::new());
    assert_eq!(unset("seam", &parse("override most_steps: u32 = 1u;"), &sources), ["most_steps"]);
    assert_eq!(unset("seam", &parse("override defers: bool = true;"), &sources), ["defers"], "of walk_rest alone");
    assert!(declares("    pub const LEFT: i32 = 1;", "LEFT") && !declares("const LEFT_OUT: i32 = 1;", "LEFT"));
    assert!(!declares("    pub const LEFT: Self = Self(1);", "LEFT") && !declares("// const LEFT: i32", "LEFT"));
    let reads = shader_of(PassName::Seam).replacen("out_places", "places_of_all", 99);
    assert!(std::panic::catch_unwind(|| bound("seam", &reads)).is_err(), "a buffer is written that is not called out_");
}
