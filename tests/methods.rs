//! The registry of methods: every entry is complete, and no two are mistaken for each other.

use std::collections::HashSet;
use std::fmt::Debug;
use std::hash::Hash;

use hachure::door::plan::Yields;
use hachure::door::plan::registry::{Marker, PlotLook};
use hachure::plan::{Method, MethodEntry};

/// What is wrong with these entries.
fn faults(entries: &[MethodEntry]) -> Vec<String> {
    let mut faults = Vec::new();
    for entry in entries {
        let texts = [("name", entry.name), ("family", entry.family), ("brief", entry.brief), ("rule", entry.rule)];
        let empty = texts.iter().filter(|(_, text)| text.trim().is_empty());
        faults.extend(empty.map(|(what, _)| format!("{}: no {what}", entry.name)));
        if entry.passes.is_empty() && entry.yields == Yields::Ink {
            faults.push(format!("{}: no pass", entry.name));
        }
        if entries.iter().filter(|other| other.family == entry.family && other.name == entry.family).count() != 1 {
            faults.push(format!("{}: its family has not one plain method", entry.name));
        }
    }
    let looks = || entries.iter().map(|entry| entry.look);
    faults.extend(twice("name", entries.iter().map(|entry| entry.name)));
    faults.extend(twice("brief", entries.iter().map(|entry| entry.brief)));
    faults.extend(twice("rule", entries.iter().map(|entry| entry.rule)));
    faults.extend(twice("colour", looks().map(|look| look.colour)));
    faults.extend(twice("dash", looks().map(|look| look.dash)));
    faults.extend(twice("marker", looks().map(|look| look.marker)));
    faults
}

/// What two entries have in common.
fn twice<T: Copy + Debug + Eq + Hash>(what: &str, values: impl Iterator<Item = T>) -> Option<String> {
    let mut seen = HashSet::new();
    let mut values = values;
    values.find(|value| !seen.insert(*value)).map(|value| format!("two have the {what} {value:?}"))
}

fn registry() -> Vec<MethodEntry> {
    Method::ALL.map(|method| *method.entry()).to_vec()
}

#[test]
fn every_method_is_complete_and_unlike_the_others() {
    assert_eq!(faults(&registry()), Vec::<String>::new());
    for method in Method::ALL {
        assert_eq!(Method::named(method.entry().name), Some(method));
    }
    assert_eq!(Method::named("pen"), None);
    let default = Method::default().entry();
    assert_eq!(default.name, default.family, "a default without flags of its own");
}

/// Spoils an entry.
type Spoil = fn(&mut MethodEntry);

#[test]
fn an_entry_that_lacks_something_is_noticed() {
    let spoils: [(&str, Spoil); 8] = [
        ("no brief", |entry| entry.brief = " "),
        ("no rule", |entry| entry.rule = ""),
        ("no pass", |entry| entry.passes = &[]),
        ("not one plain method", |entry| entry.family = "flood"),
        ("the name \"toward-away\"", |entry| entry.name = "toward-away"),
        ("the colour [26, 26, 26]", |entry| entry.look = PlotLook { colour: [26, 26, 26], ..entry.look }),
        ("the dash None", |entry| entry.look = PlotLook { dash: None, ..entry.look }),
        ("the marker Disc", |entry| entry.look = PlotLook { marker: Marker::Disc, ..entry.look }),
    ];
    for (fault, spoil) in spoils {
        let mut entries = registry();
        spoil(entries.last_mut().expect("an entry"));
        let found = faults(&entries);
        assert!(found.iter().any(|found| found.contains(fault)), "{fault}: {found:?}");
    }
}
