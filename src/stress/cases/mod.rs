//! The registry: every case, one small function each, in the order of lists and reports.

mod data;
mod ordinary;
mod scales;
mod sizes;
mod stiff;
mod views;

use super::lands::{grid, hashed, rolling, sixteenths};
use super::{Case, Group};
use crate::dem::Dem;
use crate::error::{Error, Result, Setting};
use crate::files::typed;
use crate::surface::Level;

/// Makes a case.
type Make = fn() -> Case;

/// Every case.
const CASES: &[&[Make]] = &[ordinary::CASES, stiff::CASES, views::CASES, scales::CASES, sizes::CASES, data::CASES];

/// Metres between samples of most lands: a power of two, so that heights have few binary digits.
const CELL: f64 = 32.0;

/// Every case, in order.
pub fn all() -> Vec<Case> {
    CASES.iter().copied().flatten().map(|make| make()).collect()
}

/// Those that are run where time is short.
pub fn short() -> Vec<Case> {
    all().into_iter().filter(|case| case.short).collect()
}

/// The case that must break: noise in facets of level 1, held to truth of a fine level. It shows that broken promises are noticed, is
/// found by its name alone, and stands on no list.
fn control() -> Case {
    let noise = grid([9, 9], CELL, |c, r| sixteenths(2.0 * CELL * hashed(17, c, r)));
    Case::new(Group::Ordinary, "control", "a case that must break", noise)
        .seen("across", [4.0, 11.0, 40.0], [4.0, 3.0, 0.0])
        .drawn(Level::new(1).unwrap_or_default())
}

/// The case of a name.
///
/// # Errors
/// [`Error::Setting`], which names the nearest, where none is called so.
pub fn named(name: &str) -> Result<Case> {
    let mut cases = all();
    if name == "control" {
        return Ok(control());
    }
    match cases.iter().position(|case| case.name == name) {
        Some(at) => Ok(cases.swap_remove(at)),
        None => {
            let known: Vec<_> = cases.iter().map(|case| case.name).collect();
            let remedy = format!("use {}", typed::meant(name, &known));
            Err(Error::setting(Setting::Only, format!("no case is called {name}"), remedy))
        }
    }
}

/// Rolling hills on so many samples a side, heights times a factor.
fn hills(side: usize, seed: u64, times: f64) -> Dem {
    grid([side, side], CELL, |c, r| CELL * times * rolling(seed, c, r))
}
