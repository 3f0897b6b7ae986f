//! Relief that nobody surveyed: as much of it as a test of large terrain asks for.
//!
//! Octaves of value noise (one random height a node, smooth steps between them), folded so that the middle heights
//! become ridges; each octave is half as wide and 0.54 times as high. Whole numbers are hashed and f64 are added and
//! multiplied, nothing else: the same bits on every machine. Cost: 9 octaves a sample.

/// Samples between the nodes of the widest octave.
const WIDEST: usize = 1024;
/// Octaves, down to nodes 4 samples apart.
const OCTAVES: u32 = 9;
/// Metres between samples.
pub const CELL: f64 = 30.0;
/// Height of the widest octave, metres.
const HIGHEST: f64 = 1500.0;
/// Height of an octave as a share of that of the one before.
const SHARE: f64 = 0.54;
/// Heights are whole multiples of one metre over this, so that they compress.
const STEPS: f64 = 16.0;

/// Heights of row `r`, metres, `columns` of them.
pub fn row(columns: usize, r: usize) -> Vec<f32> {
    let mut heights = vec![0.0; columns];
    let mut high = HIGHEST;
    for octave in 0..OCTAVES {
        let width = WIDEST >> octave;
        let (node_row, down) = (r / width, smooth(r % width, width));
        let node = |i: usize| mix(random(octave, i, node_row), random(octave, i, node_row + 1), down);
        for (i, heights) in heights.chunks_mut(width).enumerate() {
            let [west, east] = [node(i), node(i + 1)];
            for (c, height) in heights.iter_mut().enumerate() {
                let noise = mix(west, east, smooth(c, width));
                *height += high * (1.0 - (2.0 * noise - 1.0).abs());
            }
        }
        high *= SHARE;
    }
    heights.into_iter().map(|height| ((height * STEPS).round() / STEPS) as f32).collect()
}

fn mix(a: f64, b: f64, share: f64) -> f64 {
    a + (b - a) * share
}

/// A step from 0 to 1 with level ends.
fn smooth(at: usize, width: usize) -> f64 {
    let t = at as f64 / width as f64;
    t * t * (3.0 - 2.0 * t)
}

/// A number from 0 to 1 for each node: SplitMix64 (Steele, Lea, Flood 2014) of its place.
fn random(octave: u32, i: usize, j: usize) -> f64 {
    let place = u64::from(octave) << 56 ^ (i as u64) << 28 ^ j as u64;
    let mut bits = place.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ bits >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ bits >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    (bits ^ bits >> 31) as f64 / u64::MAX as f64
}
