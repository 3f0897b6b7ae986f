//! Reports of comparisons: JSON, CSV, a plot, and a page to read with every picture in it.
//!
//! [`Results`] is what a [`Comparison`](crate::measure::Comparison) found; the writers turn that into text and know
//! nothing else.

mod chart;
pub(crate) mod csv;
pub(crate) mod folder;
pub(crate) mod growth;
pub(crate) mod html;
mod labels;
pub(crate) mod lines;
pub(crate) mod pictures;
pub(crate) mod plot;
pub(crate) mod results;
pub(crate) mod stress;
mod words;

pub use csv::write_csv;
pub use growth::growth_svg;
pub use html::report_html;
pub use pictures::Picture;
pub use plot::error_time_svg;
pub(crate) use results::Results;

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
