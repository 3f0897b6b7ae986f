//! What scenes take on the device, and what a process takes on the machine.

use std::sync::Arc;

use hachure::door::gpu::Capacity;
use hachure::door::gpu::sizes::{of_page, of_scene};
use hachure::plan::{Border, Method, Plan};
use hachure::surface::Surface;

use crate::frames::Planned;
use crate::scenes::{gpu, level, look, rough};

/// Bytes of a scene's buffers on a page of this size.
fn bytes(surface: &Arc<Surface>, n: u32, size: [u32; 2]) -> u64 {
    let view = look(glam::DVec3::ZERO, glam::DVec3::Y, 60.0, size);
    let mut renderer = Planned::new(gpu(), surface, Plan::new(level(n), Method::Walk, Border::On));
    let plan = renderer.plan;
    renderer.prepare(&plan, &view).expect("room for a frame");
    renderer.on_device().bytes()
}

#[test]
fn bytes_on_the_device_grow_with_page_level_and_grid() {
    let surface = Arc::new(Surface::new(rough(17, 17, 1.0, 1.0, false)));
    let small = bytes(&surface, 1, [64, 64]);
    // Key, touched, ink, candidate, pair, pair left and page of a pixel: 8 + 4 + 4 + 4 + 4 + 4 + 8.
    assert_eq!(bytes(&surface, 1, [64, 65]) - small, 64 * 36);
    // All that frames write of one chunk, its samples among it, and little else.
    let capacity = Capacity { chunks: 1, nodes: 1, tiles: 1, patched: 0 };
    let sizes = [of_scene(capacity), of_page([64, 64]).expect("a page")].concat();
    let least: u64 = sizes.iter().map(|(_, bytes)| bytes).sum();
    let samples = 17 * 17 * 4;
    assert!(small > least && small < least + 3 * samples, "{small}, at least {least}");
    // Level 2 has four chunks instead of one: 289 vertices of 32 bytes and 512 facets queued and faced; and gradients.
    assert!(bytes(&surface, 2, [64, 64]) - small > 3 * (289 * 32 + 512 * 4) + 2 * samples);
    let wider = Arc::new(Surface::new(rough(18, 17, 1.0, 1.0, false)));
    // One more column of cells takes a second tile.
    assert!(bytes(&wider, 1, [64, 64]) > small + samples);
}

#[cfg(target_os = "linux")]
mod process {
    use std::hint::black_box;
    use std::process::Command;

    use hachure::door::measure::memory::{peak, reset_peak};

    use crate::tolerances::RESIDENT_BYTES;

    const MANY: u64 = 128 << 20;

    #[test]
    fn the_peak_rises_with_what_is_held_and_falls_when_reset() {
        // Alone in a process, for the peak is the process's.
        let test = std::env::current_exe().unwrap();
        let child = "memory::process::child_holds_and_drops";
        let ran = Command::new(test).args(["--exact", child, "--ignored", "--nocapture"]).output().unwrap();
        let said = String::from_utf8_lossy(&ran.stdout).into_owned();
        assert!(ran.status.success() && said.contains("peaks: "), "{said}");
    }

    #[test]
    #[ignore = "run by the_peak_rises_with_what_is_held_and_falls_when_reset in a process of its own"]
    fn child_holds_and_drops() {
        let before = peak().unwrap();
        drop(black_box(vec![1_u8; MANY as usize]));
        let held = peak().unwrap();
        reset_peak();
        let after = peak().unwrap();
        println!("peaks: {before}, {held}, {after} bytes");
        assert!(held >= before + MANY - RESIDENT_BYTES, "what is dropped again is still the peak");
        let refused = std::fs::OpenOptions::new().write(true).open("/proc/self/clear_refs").is_err();
        assert!(
            if refused { after == held } else { after <= held - MANY + RESIDENT_BYTES },
            "reset refused: {refused}"
        );
    }
}
