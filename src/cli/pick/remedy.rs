//! Flags under which economy draws a line that it left out: tried before they are told.

use super::cause::Rule;
use super::found::PickedPage;
use crate::cli::words::short;
use crate::error::Result;
use crate::line::{Chain, Economy, Near, economised, near};

/// A line that has these shares of its weight is drawn, and drawn whole.
pub(super) const DRAWN: f32 = 0.1;
const WHOLE: f32 = 0.99;
/// How far a line may lie from where it was seen, px: it has more points or fewer.
pub(super) const SAME: f64 = 1.0;

/// The flags, by the rule that left a line of those that compete out or faded it: the least change first, none of the two rules last.
///
/// # Errors
/// As [`PickedPage::draws`].
pub(super) fn flags(rule: &Rule, page: &PickedPage, chains: &[Chain], line: &Near) -> Result<Option<String>> {
    let economy = &page.illustration.economy;
    let (rule, enough) = match rule {
        Rule::Drawn { faded: Some(rule), .. } => (&**rule, WHOLE),
        rule => (rule, DRAWN),
    };
    let of_gap = |px: f64| Economy { min_gap: px, ..*economy };
    let tries = match rule {
        Rule::MinJump { jump, .. } => {
            vec![Economy { min_jump: down(jump / 2.0), ..*economy }, Economy { min_jump: 0.0, ..*economy }]
        }
        Rule::Length { length, .. } => vec![of_gap(down(length / 4.0)), of_gap(0.0)],
        Rule::MinGap { apart, .. } => vec![of_gap(down(apart / 2.5)), of_gap(0.0)],
        _ => return Ok(None),
    };
    let both = Economy { min_jump: 0.0, min_gap: 0.0 };
    let (number, place) = (line.chain, line.point.place);
    let leaves_enough = |economy: &Economy| {
        let weighed = economised(chains, economy);
        let there = near(&weighed[number..=number], place, SAME);
        there.iter().any(|near| near.point.weight >= enough)
    };
    for new in tries.into_iter().chain([both]).filter(leaves_enough) {
        // Pens may be too broad all the same.
        if page.draws(new, chains[number].id, place)? {
            return Ok(Some(typed(&new, economy)));
        }
    }
    Ok(None)
}

/// What of one economy is to be typed to come from another.
fn typed(new: &Economy, old: &Economy) -> String {
    let jump = (new.min_jump != old.min_jump).then(|| format!("--min-jump {}", short(new.min_jump)));
    let gap = (new.min_gap != old.min_gap).then(|| match new.min_gap {
        0.0 => "--min-gap 0".to_owned(),
        px => format!("--min-gap {}px", short(px)),
    });
    [jump, gap].into_iter().flatten().collect::<Vec<_>>().join(" ")
}

/// A number rounded down to two digits: as it is typed.
pub(super) fn down(number: f64) -> f64 {
    let scale = 10_f64.powf(1.0 - number.max(f64::MIN_POSITIVE).log10().floor());
    let rounded = (number * scale).floor() / scale;
    if rounded.is_finite() { rounded } else { 0.0 }
}
