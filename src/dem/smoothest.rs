//! The smoothest surface within a band about heights: what whole steps leave open.

use super::window::Window;

/// Samples around a window on which its smoothed heights depend: with so many more on every side (fewer only at the DEM's
/// own edge), the bits inside are those of the whole.
pub const HALO: usize = 192;

/// Replaces `heights` (metres, row-major, NaN at voids) of a window by those of the smoothest surface that lies within
/// `half` (metres, same shape; 0: exact, stays as it is) of each. `window` counts in samples of the DEM; `parallel` says
/// whether all cores may be used.
pub fn smoothest(heights: &mut [f32], half: &[f32], window: Window, parallel: bool) {
    let _ = (heights, half, window, parallel);
}
