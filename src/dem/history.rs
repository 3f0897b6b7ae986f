//! What was done to a DEM on its way in, in words for people.

use std::path::Path;

use crate::error::{plain, shown};

/// Clauses on how a DEM came about, in the order in which things were done.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct History {
    converted: Vec<String>,
    assumed: Vec<String>,
    usual: Vec<String>,
}

impl History {
    /// What was changed: units, projection, grid, voids.
    pub fn converted(&self) -> &[String] {
        &self.converted
    }

    /// What the files do not say and was taken as given, each with the way to say otherwise.
    pub fn assumed(&self) -> &[String] {
        &self.assumed
    }

    /// What the files do not say but few files do, and was taken as given: nothing to warn of.
    pub fn usual(&self) -> &[String] {
        &self.usual
    }

    /// One more clause on what was changed.
    pub fn convert(&mut self, clause: String) {
        self.converted.push(plain(clause));
    }

    /// One more clause on what was taken as given.
    pub fn assume(&mut self, clause: String) {
        self.assumed.push(plain(clause));
    }

    /// One more on what few files say.
    pub fn assume_as_usual(&mut self, clause: String) {
        self.usual.push(clause);
    }

    /// Takes over what holds for one of several files: `path` is named where it is not the first and says more.
    pub fn take(&mut self, of_file: Self, path: Option<&Path>) {
        let add = |list: &mut Vec<String>, clauses: Vec<String>| {
            let clauses: Vec<_> = clauses.into_iter().filter(|clause| !list.contains(clause)).collect();
            list.extend(clauses.into_iter().map(|clause| match path {
                Some(path) => format!("{}: {clause}", shown(path)),
                None => clause,
            }));
        };
        add(&mut self.converted, of_file.converted);
        add(&mut self.assumed, of_file.assumed);
        add(&mut self.usual, of_file.usual);
    }
}
