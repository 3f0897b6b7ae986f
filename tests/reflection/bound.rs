//! What an entry point does to the buffers it binds, as its shader says.

use std::collections::BTreeMap;

use hachure::door::gpu::pass::parse;
use wgpu::naga;

/// How a pass binds a storage buffer.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Bound {
    /// Whether the shader reads it, by an atomic too.
    pub is_read: bool,
    /// Whether its name begins with `out_`: it is written.
    pub is_out: bool,
    /// Bytes before its items.
    pub header: u64,
    /// Bytes from item to item.
    pub item: u64,
}

/// The storage buffers that an entry point uses, by their names; both parts of the facing bits are one.
///
/// # Panics
/// Where one is written and not called `out_`, or the other way round.
pub fn bound(name: &str, source: &str) -> BTreeMap<String, Bound> {
    let (module, info) = parse(name, source).expect("valid WGSL");
    let entry = module.entry_points.iter().position(|e| e.name == name).expect("this entry point");
    let used = module.global_variables.iter().map(|(handle, global)| (global, info.get_entry_point(entry)[handle]));
    let storage = used.filter(|(global, used)| {
        matches!(global.space, naga::AddressSpace::Storage { .. }) && global.binding.is_some() && !used.is_empty()
    });
    let each = storage.map(|(global, used)| {
        let label = global.name.as_deref().expect("a name");
        let is_out = label.starts_with("out_");
        assert_eq!(used.contains(naga::valid::GlobalUse::WRITE), is_out, "{name}: {label} is {used:?}");
        let buffer = label.strip_prefix("out_").unwrap_or(label);
        let buffer = if buffer.starts_with("facing_") { "facing" } else { buffer };
        let (header, item) = layout_of_items(&module, global.ty);
        (buffer.to_owned(), Bound { is_read: used.contains(naga::valid::GlobalUse::READ), is_out, header, item })
    });
    each.collect()
}

/// Bytes before the items of a bound type, and from item to item: those of an array, alone or last in a struct, or the whole.
fn layout_of_items(module: &naga::Module, ty: naga::Handle<naga::Type>) -> (u64, u64) {
    match &module.types[ty].inner {
        naga::TypeInner::Array { stride, .. } => (0, u64::from(*stride)),
        naga::TypeInner::Struct { members, span } => {
            match members.last().map(|last| (last, &module.types[last.ty].inner)) {
                Some((last, naga::TypeInner::Array { stride, size: naga::ArraySize::Dynamic, .. })) => {
                    (u64::from(last.offset), u64::from(*stride))
                }
                _ => (0, u64::from(*span)),
            }
        }
        other => panic!("a buffer of {other:?}"),
    }
}
