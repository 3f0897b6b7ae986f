//! What hydrology takes: time and memory.

use std::hint::black_box;
use std::time::Instant;

use glam::DVec2;
use hachure::dem::{Dem, fractal};
use hachure::relief::{ChannelArea, Relief};

use crate::tolerances::RELIEF_SECONDS;

/// A million samples of fractal land, in valleys of all sizes.
fn land(side: usize) -> Dem {
    let heights = (0..side).flat_map(|r| fractal::row(side, r)).collect();
    Dem::from_heights(side, DVec2::splat(fractal::CELL), DVec2::ZERO, heights)
}

#[test]
fn a_million_samples_take_no_time() {
    let land = land(1024);
    let start = Instant::now();
    let relief = black_box(Relief::of(&land, 1.0).expect("a relief"));
    let flow = start.elapsed().as_secs_f64();
    let drainage = relief.drainage(ChannelArea::SquareMetres(25.0 * fractal::CELL.powi(2)));
    let lines = start.elapsed().as_secs_f64() - flow;
    println!("flow and areas {flow:.3} s, {} lines {lines:.3} s", drainage.len());
    assert!(flow <= RELIEF_SECONDS, "{flow} s");
}

#[cfg(target_os = "linux")]
mod memory {
    use std::process::Command;

    use hachure::door::measure::memory::{peak, reset_peak};

    use super::*;
    use crate::tolerances::RELIEF_BYTES;

    #[test]
    fn a_sample_takes_few_bytes() {
        // Alone in a process, for the peak is the process's.
        let test = std::env::current_exe().unwrap();
        let child = "relief::costs::memory::child_finds_flow";
        let ran = Command::new(test).args(["--exact", child, "--ignored", "--nocapture"]).output().unwrap();
        let said = String::from_utf8_lossy(&ran.stdout).into_owned();
        assert!(ran.status.success() && said.contains("bytes a sample"), "{said}");
        println!("{said}");
    }

    #[test]
    #[ignore = "run by a_sample_takes_few_bytes in a process of its own"]
    fn child_finds_flow() {
        let side = 2048;
        let land = land(side);
        reset_peak();
        let before = peak().unwrap();
        let relief = black_box(Relief::of(&land, 1.0).expect("a relief"));
        // Heights as they are and smoothed are the grid.
        let taken = (peak().unwrap() - before) as f64 / (side * side) as f64 - 8.0;
        drop(relief);
        println!("{taken:.1} bytes a sample");
        assert!(taken <= RELIEF_BYTES, "{taken} bytes a sample");
    }
}
