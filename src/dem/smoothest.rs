//! The smoothest surface within a band about heights: what a file of whole metres leaves open.
//!
//! A height that was rounded says that the land lies within half a step of it. Of all surfaces within that band the one of
//! least bending energy (thin plate: the squares of all second differences; Duchon 1977) has no stairs, and its tops
//! and hollows bulge as land does. The band's edges are constraints, not penalties: no height leaves it.
//!
//! Method: `contours` guesses by lines between the places where heights change, which lie half a step from both; the
//! guess is averaged over blocks of 4 x 4 samples and bent by projected gradient steps with momentum (Nesterov
//! 1983; Beck, Teboulle 2009), then blocks of 2 x 2, then the samples themselves, each from the surface before. The mean of
//! a block lies within the mean band, so that constraints hold on every level. Blocks are counted from the DEM's first sample
//! and the number of sweeps is fixed: a window with its [`HALO`] has the bits of the whole, on any number of threads.
//!
//! Cost: some 100 ns of one core a sample; 12 bytes of memory a sample beside heights and bands. Voids and what lies
//! outside have no part in it: where a second difference would need them it is left out (free edges).
//!
//! Not handled: the energy is that of square cells; terraces wider than twice the contours' reach keep a slight wave; what is
//! lower than a step and shows in no contour is lost.

mod contours;
mod levels;
mod relax;

use super::window::Window;
use levels::Level;

/// Samples around a window on which its smoothed heights depend: with so many more on every side (fewer only at the DEM's
/// own edge), the bits inside are those of the whole.
pub const HALO: usize = 192;

/// Sweeps on the samples, on blocks of 2 x 2, on blocks of 4 x 4.
const SWEEPS: [usize; 3] = [20, 14, 6];

const _: () = assert!(reach() <= HALO);

/// Samples that a smoothed height depends on to each side: a sweep reaches two blocks of its level, and where a level starts
/// from blocks of 2 x 2 of its own, those about one of them reach three.
const fn reach() -> usize {
    let (mut samples, mut level) = (contours::REACH + 1, 0);
    while level < SWEEPS.len() {
        let start = if level + 1 < SWEEPS.len() { 3 } else { 0 };
        samples += (2 * SWEEPS[level] + start) << level;
        level += 1;
    }
    samples
}

/// Replaces `heights` (metres, row-major, NaN at voids) of a window by those of the smoothest surface that lies within
/// `half` (metres, same shape; 0: exact, stays as it is) of each. `window` counts in samples of the DEM; `parallel` says
/// whether all cores may be used.
///
/// # Panics
/// When the three are not of one shape.
pub fn smoothest(heights: &mut [f32], half: &[f32], window: Window, parallel: bool) {
    assert!(heights.len() == half.len() && heights.len() as u64 == window.samples());
    if half.iter().all(|half| *half == 0.0) {
        return;
    }
    let surface = surface(heights, half, window, parallel);
    for ((height, half), smooth) in heights.iter_mut().zip(half).zip(surface) {
        *height = inside(smooth, *height, *half);
    }
}

/// The smoothest surface but for rounding, from the coarsest level to the finest.
fn surface(heights: &[f32], half: &[f32], window: Window, parallel: bool) -> Vec<f32> {
    let mut surface = contours::between(heights, half, window.size[0], parallel);
    let mut levels = vec![Level::finest(heights, half, window)];
    while let Some(finer) = levels.last().filter(|_| levels.len() < SWEEPS.len()) {
        surface = finer.halved(&surface);
        levels.push(finer.coarser());
    }
    let mut coarser: Option<Level> = None;
    while let Some(level) = levels.pop() {
        if let Some(coarser) = coarser {
            surface = level.within(coarser.refined(&surface, level.window));
        }
        surface = relax::relaxed(&level, surface, SWEEPS[levels.len()], parallel);
        coarser = Some(level);
    }
    surface
}

/// The number nearest to `height` that lies within `half` of `middle` exactly, and not only as rounded.
fn inside(height: f32, middle: f32, half: f32) -> f32 {
    let off = f64::from(height) - f64::from(middle);
    if off.abs() <= f64::from(half) {
        return height;
    }
    let end = middle + half.copysign(off as f32);
    let beyond = (f64::from(end) - f64::from(middle)).abs() > f64::from(half);
    match (beyond, off > 0.0) {
        (false, _) => end,
        (true, true) => end.next_down(),
        (true, false) => end.next_up(),
    }
}
