//! Reports of comparisons: JSON, CSV, a plot, and a page to read with every picture in it.
//!
//! [`Comparison`] compares, [`Results`] is what it found; the writers turn that into text and know nothing else.
//! [`Growth`] is time against size, judged by what was promised, with its plot.

mod chart;
pub mod compare;
pub mod csv;
mod floors;
pub mod folder;
pub mod growth;
pub mod html;
mod labels;
pub mod memory;
pub mod pictures;
pub mod plot;
mod prepared;
mod rendered;
pub mod results;
pub mod trial;
pub mod truths;
mod words;

pub use compare::Comparison;
pub use csv::write_csv;
pub use growth::{Growth, Promise};
pub use html::report_html;
pub use pictures::Picture;
pub use plot::error_time_svg;
pub use results::Results;

/// Every name once, a new one behind the one it follows: lists that share an order become one in that order.
fn merge<'a, T: PartialEq + ?Sized>(lists: impl Iterator<Item = Vec<&'a T>>) -> Vec<&'a T> {
    let mut names: Vec<&T> = Vec::new();
    for list in lists {
        let mut next = 0;
        for name in list {
            let known = names.iter().position(|other| *other == name);
            if known.is_none() {
                names.insert(next, name);
            }
            next = known.unwrap_or(next) + 1;
        }
    }
    names
}
