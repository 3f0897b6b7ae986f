//! What was done to a DEM on its way in, in words for people.

use std::path::Path;

use glam::DVec2;

use super::Crs;
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
    samples: Option<FileSamples>,
}

/// Samples as files have them, before any crop and warp: what is true of each of the files.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct FileSamples {
    /// Columns and rows.
    pub size: Option<[usize; 2]>,
    /// Between columns and between rows, in units of that system.
    pub cell: Option<DVec2>,
    /// What they are placed in.
    pub crs: Option<Crs>,
}

/// Cells whose sides differ by a smaller share are as large: files round them.
const ALIKE: f64 = 1e-6;

impl FileSamples {
    /// What is true of other files too.
    fn and(self, others: &Self) -> Self {
        let crs = self.crs.filter(|crs| others.crs.as_ref() == Some(crs));
        let is_alike = |a: DVec2, b: DVec2| (a - b).abs().cmple(ALIKE * a).all();
        let cell = self.cell.filter(|cell| crs.is_some() && others.cell.is_some_and(|other| is_alike(*cell, other)));
        Self { size: self.size.filter(|size| others.size == Some(*size)), cell, crs }
    }
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

    /// The files' samples; `None` where there are no files.
    pub(crate) fn samples(&self) -> Option<&FileSamples> {
        self.samples.as_ref()
    }

    /// A file has these samples.
    pub(crate) fn sample(&mut self, of_file: FileSamples) {
        self.samples = Some(match self.samples.take() {
            Some(samples) => samples.and(&of_file),
            None => of_file,
        });
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
        of_file.samples.into_iter().for_each(|samples| self.sample(samples));
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
