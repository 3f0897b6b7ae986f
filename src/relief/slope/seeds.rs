//! Where lines of a block are tried, in which order.

use glam::DVec2;
use xxhash_rust::xxh3::xxh3_64_with_seed;

use super::level::{self, BlockAt, Blocks};
use super::tile::{PLACES, SIDE, order};

/// The seeds of a block, the first to be tried first, each with its number: one somewhere in each of some of 32 x 32 squares. The tile is
/// turned, mirrored and shifted anew in each block, so that blocks and levels do not look alike.
pub(super) fn seeds(blocks: &Blocks, at: BlockAt) -> impl Iterator<Item = (usize, DVec2)> {
    let [low, high] = blocks.square(at);
    let square = (high - low) / SIDE as f64;
    let seed = at.id();
    let [turn, right, down] = fields(xxh3_64_with_seed(&[], seed));
    let place = move |place: usize| {
        let [x, y] = [place + right as usize, place / SIDE + down as usize].map(|at| at % SIDE);
        let [x, y] = if turn & 1 == 0 { [x, y] } else { [y, x] };
        let mirrored = |at: usize, bit: u32| if turn & bit == 0 { at } else { SIDE - 1 - at };
        [mirrored(x, 2), mirrored(y, 4)]
    };
    order()[..TRIED].iter().enumerate().map(move |(number, tried)| {
        let [x, y] = place(usize::from(*tried) % PLACES);
        let [_, right, down] = fields(xxh3_64_with_seed(&tried.to_le_bytes(), seed));
        let aside = DVec2::new(f64::from(right), f64::from(down)) / f64::from(FIELD);
        (number, low + (DVec2::new(x as f64, y as f64) + aside) * square)
    })
}

/// Seeds that are tried: two on a square of the spacing. More find hardly any room.
const TRIED: usize = (2.0 * level::SIDE * level::SIDE) as usize;
/// One more than the largest number in a field.
const FIELD: u32 = 1 << 24;

/// Three numbers of a hash: of 16 and twice 24 bits.
fn fields(hash: u64) -> [u32; 3] {
    [(hash >> 48) as u32, (hash >> 24) as u32 % FIELD, hash as u32 % FIELD]
}
