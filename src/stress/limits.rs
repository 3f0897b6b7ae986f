//! The limits of promises, in one place. An exception alone has another.

/// Least F within 1 px of the walk and of the contour.
pub(crate) const F: f64 = 0.98;
/// From how much line on the page on F is promised, px: of 200 px, 4 are 2 %.
pub(crate) const LEAST_TRUTH_PX: f64 = 200.0;
/// Most ink astray, as a share of the page: of 320 x 240 px, 76.
pub(crate) const ASTRAY: f64 = 1e-3;
/// Most ink that pops for an eye a millionth of its distance on, less that of truth: of 1 000 px one.
pub(crate) const POPPED: f64 = 1e-3;
/// Most ink that pops from a frame of a flight to the next, less that of truth: of 1 000 px five.
pub(crate) const UNSTEADY: f64 = 5e-3;
/// Most pixels that differ on land that is turned, as a share of the ink: of 2 000 px one.
pub(crate) const TURNED: f64 = 5e-4;

/// So many whole pixels a share of the ink is, rounded up: a pixel is the least that can differ.
pub(crate) fn whole(share: f64, inked: usize) -> f64 {
    (share * inked as f64).ceil()
}
