//! Letters of single strokes: Hershey's Roman simplex, which knows corners alone; where they are flat, they are rounded.
//!
//! Method: a corner of less than 60 degrees becomes a quadratic curve that starts and ends half a side away from it, so that bowls
//! are round and stems stay straight. Cost: nothing to speak of.

use std::collections::HashMap;
use std::sync::OnceLock;

use glam::DVec2;

use super::along;

/// The letters, with what must be said of them.
const TEXT: &str = include_str!("single_stroke.txt");
/// Height of capitals, em.
pub(super) const CAP_HEIGHT: f64 = 0.662;
/// How far letters reach below the baseline, em.
pub(super) const DESCENT: f64 = 0.22;
/// Thousandths of an em.
const UNITS: f64 = 1000.0;
/// Cosine of the turn up to which a corner is rounded.
const FLAT: f64 = 0.5;
/// How far chords of curves may be off, mm.
const CHORD: f64 = 0.01;

/// A letter, in units of an em, y up.
struct Letter {
    advance: f64,
    strokes: Vec<Vec<DVec2>>,
}

fn letters() -> &'static HashMap<char, Letter> {
    static LETTERS: OnceLock<HashMap<char, Letter>> = OnceLock::new();
    LETTERS.get_or_init(|| TEXT.lines().filter_map(letter).collect())
}

/// A line of the file; a remark is none.
fn letter(line: &str) -> Option<(char, Letter)> {
    let (code, rest) = line.split_once(' ')?;
    let code = char::from_u32(u32::from_str_radix(code, 16).ok()?)?;
    let (advance, strokes) = rest.split_once(' ').unwrap_or((rest, ""));
    let place = |text: &str| {
        let (x, y) = text.split_once(',')?;
        Some(DVec2::new(x.parse().ok()?, y.parse().ok()?) / UNITS)
    };
    let stroke = |text: &str| text.split_whitespace().filter_map(place).collect::<Vec<_>>();
    let strokes = strokes.split(';').map(stroke).filter(|stroke| !stroke.is_empty()).collect();
    Some((code, Letter { advance: advance.parse::<f64>().ok()? / UNITS, strokes }))
}

/// The first letter of a text that is not among them.
pub(super) fn lacking(text: &str) -> Option<char> {
    text.chars().find(|letter| !letters().contains_key(letter))
}

/// The strokes of each letter of a text, `em` mm large, `spacing` em farther apart than usual.
pub(super) fn set(text: &str, em: f64, spacing: f64) -> Vec<Vec<Vec<DVec2>>> {
    let mut pen = 0.0;
    let mut set = Vec::new();
    for letter in text.chars().filter_map(|letter| letters().get(&letter)) {
        let placed = |place: &DVec2| DVec2::new(pen + place.x, -place.y) * em;
        let stroke = |stroke: &Vec<DVec2>| rounded(&stroke.iter().map(placed).collect::<Vec<_>>());
        set.push(letter.strokes.iter().map(stroke).collect::<Vec<_>>());
        pen += letter.advance + spacing;
    }
    set.retain(|strokes| !strokes.is_empty());
    set
}

/// A stroke whose flat corners are curves; one that ends where it begins is round there too.
fn rounded(stroke: &[DVec2]) -> Vec<DVec2> {
    let is_ring = stroke.len() > 3 && stroke.first() == stroke.last();
    let around = is_ring.then(|| [stroke[stroke.len() - 2], stroke[0], stroke[1]]);
    let corner = |[before, at, after]: [DVec2; 3]| {
        let [from, to] = [before, after].map(|end| at + (end - at).clamp_length_max(reach(before, at, after)));
        is_flat(before, at, after).then_some([from, at, to])
    };
    let end = around.and_then(corner);
    let mut round = vec![end.map_or(stroke[0], |[_, _, to]| to)];
    for three in stroke.windows(3) {
        match corner([three[0], three[1], three[2]]) {
            Some([from, at, to]) => {
                round.push(from);
                round.extend(along(from, at, to, CHORD));
            }
            None => round.push(three[1]),
        }
    }
    match end {
        Some([from, at, to]) => {
            round.push(from);
            round.extend(along(from, at, to, CHORD));
        }
        None => round.extend(stroke.last().filter(|_| stroke.len() > 1)),
    }
    round.dedup();
    round
}

/// How far from a corner its curve begins and ends: half the shorter side.
fn reach(before: DVec2, at: DVec2, after: DVec2) -> f64 {
    before.distance(at).min(after.distance(at)) / 2.0
}

fn is_flat(before: DVec2, at: DVec2, after: DVec2) -> bool {
    (at - before).normalize_or_zero().dot((after - at).normalize_or_zero()) > FLAT
}
