//! Command lines nobody meant.

use super::{Yard, each, pick, typed, words, write_hill};
use crate::scenes::Random;

const RUNS: u64 = 45;

/// Numbers at the ends of what flags take, and beyond.
const NUMBERS: [&str; 24] = [
    "0", "-0", "1", "-1", "0.5", "2", "3", "1e-3", "1e-9", "1e9", "-1e9", "1e300", "nan", "inf", "-inf", "", "x", "+5",
    "89.9999", "90", "-90", "180", "360", "4194304",
];
/// Places inside the hill, at its border, far off.
const EAST: [&str; 6] = ["499700", "500000", "500240", "499280", "0", "10000000"];
const NORTH: [&str; 6] = ["5539800", "5540000", "5540240", "5539280", "0", "-10000000"];
const HEIGHTS: [&str; 7] = ["+0", "+2", "+300", "450", "0", "-9000", "1e7"];

/// A flag and its value.
fn flag(random: &mut Random) -> String {
    let number = |random: &mut Random| pick(random, &NUMBERS);
    let place = |random: &mut Random| format!("{},{}", pick(random, &EAST), pick(random, &NORTH));
    match random.below(28) {
        0..3 => format!("--eye {},{}", place(random), pick(random, &HEIGHTS)),
        3 => format!("--eye {},{},{}", number(random), number(random), number(random)),
        4 => format!("--eye {},+20 --look-at {}", place(random), place(random)),
        5 => format!("--lonlat 9.{},50.01,{}", random.below(9), pick(random, &HEIGHTS)),
        6 => format!("--lonlat {},{},{}", number(random), number(random), number(random)),
        7 => format!("--azimuth {}", number(random)),
        8 => format!("--altitude {}", number(random)),
        9 => format!("--fov {}", number(random)),
        10 => format!("--crs EPSG:{}", pick(random, &["4326", "32632", "3857", "0", "5773", "99999999", "2056"])),
        11 => format!("--exaggeration {}", number(random)),
        12 => format!("--level {}", pick(random, &["1", "2", "4", "16", "auto", "3", "0", "128"])),
        13 => format!("--error-px {}", pick(random, &["0.05", "1", "100", "0", "nan"])),
        14 => format!("--crop {},{}", place(random), place(random)),
        15 => format!("--crop {},{},{},{}", number(random), number(random), number(random), number(random)),
        16 => format!("--band {}", pick(random, &["1", "2", "0", "65535", "70000"])),
        17 => format!("--cell {}", number(random)),
        18 => format!("--resample {}", pick(random, &["10", "100", "5000", "1e6", "0.001", "0"])),
        19 => "--fill-voids".into(),
        20 => format!("--elevation-unit {}", pick(random, &["m", "ft", "us-ft", "furlong", ""])),
        21 => format!("--memory {}", pick(random, &["1B", "1KiB", "1MiB", "1TiB", "0B", "9e9TiB", "-1B"])),
        22 => format!("--method {}", pick(random, &["walk", "toward-away --wide", "adjacency --share corner", "none"])),
        23 => format!("--border {}", pick(random, &["on", "off", "maybe"])),
        24 => format!("--min-jump {}", number(random)),
        25 => format!("--min-gap {}{}", number(random), pick(random, &["", "px", "mm", " px"])),
        26 => format!(
            "--size {}",
            pick(random, &["1x1", "1x300", "300x1", "65536x1", "64x48", "0x0", "-1x5", "65537x65537"])
        ),
        _ => pick(random, &["--explain", "--mask out-mask.png", "--json out.json", "-v", "-q", "--no-int64", "--wide"])
            .into(),
    }
}

#[test]
fn flags_nobody_meant_are_done_or_refused() {
    let yard = Yard::new();
    write_hill(&yard.path("hill.tif"), 48);
    each(2, RUNS, |seed, random| {
        let name = format!("out-{seed:x}.png");
        let mut line = format!("draw hill.tif -o {name}");
        let flags: Vec<_> = (0..1 + random.below(4)).map(|_| flag(random)).collect();
        if !flags.iter().any(|flag| flag.starts_with("--size")) {
            line += " --size 48x32";
        }
        // Files of other runs stand beside: each its own.
        let flags = flags
            .join(" ")
            .replace("out-mask", &format!("out-mask-{seed:x}"))
            .replace("out.json", &format!("{seed:x}.json"));
        let run = words(&format!("{line} {flags}"));
        let what = format!("seed {seed:#x}, {}", typed(&run));
        let ended = yard.run(&run);
        ended.check(&what);
        assert_eq!(yard.path(&name).exists(), ended.code == Some(0), "{what}: {}", ended.said);
    });
    yard.check_files("some run");
}
