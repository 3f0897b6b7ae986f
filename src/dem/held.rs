//! How large a DEM may be, and what is said where its samples would have to be in memory.

use crate::error::{Error, Message, MessagePart, Setting};
use crate::message;

/// Most samples of a DEM held in memory: 128 MiB of heights, the largest buffer that every GPU binds.
pub const MAX_SAMPLES: usize = 1 << 25;
/// Most samples along a side of any DEM: walks count 64 x 256 steps a cell in 32 bits, and may end a cell beyond it.
pub const LARGEST_SIDE: usize = 131_000;

/// Bytes of so many samples with their normals: a height, a bit and two gradients each.
pub(crate) fn held_bytes(samples: u64) -> u64 {
    samples * (4 + 8) + samples / 8
}

/// The error of those who need samples in memory that stay in their files.
pub(crate) fn not_held([columns, rows]: [usize; 2]) -> Error {
    let samples = columns as u64 * rows as u64;
    let more = held_bytes(samples).div_ceil(1 << 20);
    let mut remedy = message!["use ", Setting::Crop, " to take a part"];
    if samples <= MAX_SAMPLES as u64 {
        remedy.push(message![", or give ", mebibytes(more)]);
    }
    Error::limit(
        format!("{columns} x {rows} = {samples} samples stay in their files, but here they must be in memory"),
        remedy,
    )
}

/// How the voids of a DEM of so many columns and rows are filled.
pub(super) fn to_fill([columns, rows]: [usize; 2], is_filed: bool) -> Message {
    let samples = columns as u64 * rows as u64;
    let needed = held_bytes(samples).div_ceil(1 << 20);
    match is_filed {
        false => message!["add ", Setting::FillVoids],
        true if samples <= MAX_SAMPLES as u64 => {
            let needed = mebibytes(needed);
            message!["give ", Setting::FillVoids, " ", needed, ", in the place of a smaller ", Setting::Memory]
        }
        true => "fill them first: `gdal_fillnodata.py IN OUT.tif`".into(),
    }
}

/// So much memory, as one sets it.
pub(crate) fn mebibytes(memory: u64) -> MessagePart {
    Setting::Memory.at(format!("{memory}MiB"))
}
