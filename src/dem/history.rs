//! What was done to a DEM on its way in, in words for people.

use std::path::Path;

use crate::error::{Message, shown};
use crate::message;

/// Clauses on how a DEM came about, in the order in which things were done.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct History {
    converted: Vec<Message>,
    assumed: Vec<Message>,
    usual: Vec<Message>,
    steps: Vec<f64>,
    credits: Vec<String>,
}

impl History {
    /// What was changed: units, projection, grid, voids.
    pub fn converted(&self) -> &[Message] {
        &self.converted
    }

    /// What the files do not say and was taken as given, each with the way to say otherwise.
    pub fn assumed(&self) -> &[Message] {
        &self.assumed
    }

    /// Metres of the step of which each file's heights are multiples, 0 where there is none, in the order of the files; empty
    /// where the heights are as the files have them.
    pub fn steps(&self) -> &[f64] {
        &self.steps
    }

    /// What the files say of what they are and who made them, each once, in the order of the files: one line each.
    pub fn credits(&self) -> &[String] {
        &self.credits
    }

    /// One thing more that a file says of itself; white space is one space, and what moves a line is left out.
    pub fn credit(&mut self, text: &str) {
        let words = text.split_whitespace().map(|word| word.replace(char::is_control, ""));
        let text = words.filter(|word| !word.is_empty()).collect::<Vec<_>>().join(" ");
        if !text.is_empty() && !self.credits.contains(&text) {
            self.credits.push(text);
        }
    }

    /// The heights are the smoothest within these steps.
    pub fn smooth(&mut self, steps: Vec<f64>) {
        self.steps = steps;
    }

    /// One more clause on what was changed.
    pub(crate) fn convert(&mut self, clause: impl Into<Message>) {
        self.converted.push(clause.into().plain());
    }

    /// One more clause on what was taken as given.
    pub(crate) fn assume(&mut self, clause: impl Into<Message>) {
        self.assumed.push(clause.into().plain());
    }

    /// One more on what few files say.
    pub(crate) fn assume_as_usual(&mut self, clause: impl Into<Message>) {
        self.usual.push(clause.into());
    }

    /// Takes over what holds for one of several files: `path` is named where it is not the first and says more.
    pub fn take(&mut self, of_file: Self, path: Option<&Path>) {
        let add = |list: &mut Vec<Message>, clauses: Vec<Message>| {
            let clauses: Vec<_> = clauses.into_iter().filter(|clause| !list.contains(clause)).collect();
            list.extend(clauses.into_iter().map(|clause| match path {
                Some(path) => message![format!("{}: ", shown(path)), clause],
                None => clause,
            }));
        };
        add(&mut self.converted, of_file.converted);
        add(&mut self.assumed, of_file.assumed);
        add(&mut self.usual, of_file.usual);
        of_file.credits.iter().for_each(|text| self.credit(text));
    }
}

/// What other stages and tests look into.
#[doc(hidden)]
impl History {
    /// What the files do not say but few files do, and was taken as given: nothing to warn of.
    pub fn usual(&self) -> &[Message] {
        &self.usual
    }
}
