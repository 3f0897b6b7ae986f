//! Straight lines cut by a rectangle of the page, and in steps.

use glam::DVec2;

/// The part of the line from `a` to `b` that lies within a rectangle of the page, px, as shares of the way; `None` where it
/// only touches it (Liang, Barsky 1984).
pub(crate) fn share_within([low, high]: [DVec2; 2], a: DVec2, b: DVec2) -> Option<[f64; 2]> {
    let (mut from, mut to) = (0.0_f64, 1.0_f64);
    let way = b - a;
    for (start, step, low, high) in [(a.x, way.x, low.x, high.x), (a.y, way.y, low.y, high.y)] {
        let (low, high) = (low - start, high - start);
        if step == 0.0 {
            if low > 0.0 || high < 0.0 {
                return None;
            }
            continue;
        }
        from = from.max((low / step).min(high / step));
        to = to.min((low / step).max(high / step));
    }
    (from < to || (from == to && a == b)).then_some([from, to])
}

/// Longest step, px: lines are looked at in such steps.
const STEP: f64 = 0.25;

/// A step of a line on the page.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Step {
    /// Where its middle lies, as a share of the line's way.
    pub middle: f64,
    /// Its length, px.
    pub length: f64,
}

/// The part of the line from `a` to `b` on a page of this size, in equal steps of at most a quarter pixel; one of no length
/// where the line has none, none where it lies beside the page.
pub(crate) fn steps(size: [u32; 2], a: DVec2, b: DVec2) -> impl Iterator<Item = Step> {
    let page = [DVec2::ZERO, DVec2::new(f64::from(size[0]), f64::from(size[1]))];
    share_within(page, a, b).into_iter().flat_map(move |[from, to]| {
        let length = ((b - a) * (to - from)).length();
        let count = (length / STEP).ceil().max(1.0);
        let middle = move |k: u32| from + (to - from) * (f64::from(k) + 0.5) / count;
        (0..count as u32).map(move |k| Step { middle: middle(k), length: length / count })
    })
}
