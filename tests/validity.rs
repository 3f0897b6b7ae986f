//! Voids block by block: what is known of blocks is what samples say, exactly; rims are found from it alone; what is kept of a
//! DEM in its file spares every further look at its samples.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use glam::DVec2;
use hachure::dem::Dem;
use hachure::door::cli::words::line;
use hachure::door::dem::{BLOCK_SIDE, Validity};
use hachure::door::gpu::sizes::{LARGEST_BINDING, rim_fits, valid_fits};
use hachure::door::surface::rim::{RimEdge, rim, rim_length};
use hachure::geo::{ReadOptions, read, write};
use hachure::surface::Surface;
use tempfile::TempDir;

use crate::scenes::Random;

/// Ways in which voids lie; each says whether sample (c, r) of so many columns and rows is one.
pub type Voids = fn(usize, usize, [usize; 2]) -> bool;

/// Single samples, diagonal pairs, rows, blocks at the borders of blocks and tiles, at the DEM's border, most of it, none.
pub const SHAPES: [(&str, Voids); 10] = [
    ("none", |_, _, _| false),
    ("single", |c, r, _| (c * 7919 + r * 104_729).is_multiple_of(911)),
    ("diagonal pairs", |c, r, _| (c % 40 == 7 && r % 40 == 9) || (c % 40 == 8 && r % 40 == 10)),
    ("rows", |c, r, _| r % 70 == 63 && c > 20 || r % 70 == 64 && c < 90),
    ("at blocks", |c, r, _| {
        let near = |at: usize| at % BLOCK_SIDE < 2 || at % BLOCK_SIDE > BLOCK_SIDE - 3;
        near(c) && near(r) && (c / BLOCK_SIDE + r / BLOCK_SIDE).is_multiple_of(2)
    }),
    ("whole blocks", |c, r, _| (c / BLOCK_SIDE + 2 * (r / BLOCK_SIDE)) % 5 == 1),
    ("at the border", |c, r, [w, h]| c < 3 && r > 40 || r + 1 == h && c > w / 2 || c + 2 > w && r < 30 || c + r == 0),
    ("half", |c, _, [w, _]| c < w / 2),
    ("strip", |c, r, _| c.abs_diff(r + 20) > 45),
    ("all but few", |c, r, _| !(c % 90 < 3 && r % 80 < 2)),
];

/// Heights of waves, with voids of a shape.
fn sample(shape: Voids, c: usize, r: usize, size: [usize; 2]) -> f32 {
    let (x, y) = (c as f64, r as f64);
    let height = 120.0 * (x / 11.0).sin() * (y / 9.0).cos() + 15.0 * (x * 0.7 + y * 0.4).sin() + 200.0;
    if shape(c, r, size) { f32::NAN } else { height as f32 }
}

fn held(shape: Voids, size: [usize; 2]) -> Dem {
    let heights = (0..size[0] * size[1]).map(|i| sample(shape, i % size[0], i / size[0], size));
    Dem::from_heights(size[0], DVec2::splat(30.0), DVec2::ZERO, heights.collect())
}

/// A file of so many samples in a folder.
pub fn written(folder: &TempDir, shape: Voids, size: [usize; 2]) -> PathBuf {
    let path = folder.path().join("voids.tif");
    write(&path, size, 30.0, |r| (0..size[0]).map(|c| sample(shape, c, r, size)).collect(), &|_| ()).expect("a file");
    path
}

/// The DEM of a file, within so much memory.
pub fn dem(path: &Path, memory: u64) -> Dem {
    read(path, &ReadOptions { memory, ..Default::default() }).expect("a DEM")
}

/// Sizes of DEMs: parts of a block, just one, one more, several.
const SIZES: [[usize; 2]; 6] = [[2, 2], [64, 64], [65, 63], [64, 200], [129, 128], [300, 211]];

/// What of a DEM's validity is not what its samples say.
fn wrong(dem: &Dem, validity: &Validity) -> Option<String> {
    let [columns, rows] = [dem.columns(), dem.rows()];
    for (c, r) in (0..rows + 2).flat_map(|r| (0..columns + 2).map(move |c| (c, r))) {
        if validity.is_valid(c, r) != dem.height(c, r).is_some() {
            return Some(format!("sample {c}, {r}"));
        }
        for half in 0..2 {
            let third = [(c, r + 1), (c + 1, r)][half];
            let there = [(c, r), (c + 1, r + 1), third].iter().all(|(c, r)| dem.height(*c, *r).is_some());
            if validity.has_patch(c, r, half) != there {
                return Some(format!("patch {half} of {c}, {r}"));
            }
        }
    }
    let mut random = Random::new(31);
    for _ in 0..200 {
        let [first, size] = [[columns, rows], [140, 140]].map(|n| n.map(|n| random.below(n as u32) as usize));
        let [of_columns, of_rows] = [0, 1].map(|i| first[i]..first[i] + 1 + size[i] / [1, 20, 70][first[0] % 3]);
        let whole = of_rows.clone().all(|r| of_columns.clone().all(|c| dem.height(c, r).is_some()));
        if validity.is_whole(of_columns.clone(), of_rows.clone()) != whole {
            return Some(format!("{of_columns:?} by {of_rows:?}"));
        }
    }
    None
}

#[test]
fn blocks_say_what_samples_say() {
    let mut rectangles = 0;
    for ((name, shape), size) in SHAPES.iter().flat_map(|shape| SIZES.map(|size| (shape, size))) {
        let dem = held(*shape, size);
        let validity = dem.validity().expect("in memory");
        assert_eq!(wrong(&dem, validity), None, "{name}, {size:?}");
        assert_eq!(Validity::from_words(&dem, validity.words().to_vec()).as_ref(), Some(validity));
        rectangles += usize::from(validity.is_whole(0..size[0], 0..size[1]));
    }
    assert!(rectangles >= SIZES.len());
    // Negative control: another DEM's are noticed, and words that are none of this one.
    let [one, other] = [SHAPES[1].1, SHAPES[2].1].map(|shape| held(shape, [300, 211]));
    let words = other.validity().expect("in memory").words();
    assert!(wrong(&one, other.validity().expect("in memory")).is_some());
    for damaged in [&words[1..], &words[..words.len() - 1], &[], &[words, &[0]].concat()] {
        assert_eq!(Validity::from_words(&one, damaged.to_vec()), None);
    }
}

#[test]
fn blocks_of_random_voids_say_what_samples_say() {
    let mut random = Random::new(77);
    for round in 0..24 {
        let size = [2, 2].map(|least| least + random.below(260) as usize);
        let share = [1, 3, 50, 97][round % 4];
        let heights = (0..size[0] * size[1]).map(|_| if random.below(100) < share { f32::NAN } else { 7.0 });
        let dem = Dem::from_heights(size[0], DVec2::ONE, DVec2::ZERO, heights.collect());
        assert_eq!(wrong(&dem, dem.validity().expect("in memory")), None, "{share} % of {size:?}");
        assert_rim(&dem);
    }
}

/// The edges that just one patch has, row by row, by a look at the patches of every cell.
fn rim_of_samples(dem: &Dem) -> Vec<RimEdge> {
    let has = |c: i64, r: i64, half: usize| {
        let third = [(c, r + 1), (c + 1, r)][half];
        let there = |(c, r): &(i64, i64)| *c >= 0 && *r >= 0 && dem.height(*c as usize, *r as usize).is_some();
        [(c, r), (c + 1, r + 1), third].iter().all(there)
    };
    let mut edges = Vec::new();
    for (r, c) in (0..dem.rows() as i64).flat_map(|r| (0..dem.columns() as i64).map(move |c| (r, c))) {
        let sides = [[has(c, r - 1, 0), has(c, r, 1)], [has(c, r, 0), has(c - 1, r, 1)], [has(c, r, 0), has(c, r, 1)]];
        for (direction, [first, second]) in (0..).zip(sides).filter(|(_, [first, second])| first != second) {
            let half = u32::from(second && !first);
            edges.push(RimEdge { sample: [c as u32, r as u32], direction, half });
        }
    }
    edges
}

fn assert_rim(dem: &Dem) {
    let edges = rim(dem).expect("a rim");
    assert!(edges == rim_of_samples(dem), "{} x {}", dem.columns(), dem.rows());
    assert_eq!(rim_length(dem).expect("a rim"), edges.len() as u64);
}

#[test]
fn the_rim_of_blocks_is_that_of_samples() {
    for ((_, shape), size) in SHAPES.iter().flat_map(|shape| SIZES.map(|size| (shape, size))) {
        assert_rim(&held(*shape, size));
    }
    let [one, other] = [SHAPES[1].1, SHAPES[2].1].map(|shape| held(shape, [300, 211]));
    assert!(rim(&one).expect("a rim") != rim_of_samples(&other));
}

#[test]
fn filed_voids_are_known_after_one_look() {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, shape) in SHAPES {
        let path = written(&folder, shape, [700, 300]);
        let [held, filed] = [1 << 30, 1 << 18].map(|memory| dem(&path, memory));
        assert!(filed.is_filed() && !held.is_filed());
        assert_eq!(held.validity().expect("samples"), filed.validity().expect("samples"), "{name}");
        let looked = filed.samples_read();
        assert!(looked >= 700 * 300, "{looked}");
        assert_eq!(rim(&held).expect("a rim"), rim(&filed).expect("a rim"), "{name}");
        let surface = Surface::new(filed);
        for n in [1, 2] {
            let lattice =
                hachure::door::surface::Lattice::uniform(surface.dem(), crate::scenes::level(n)).expect("chunks");
            assert_eq!(lattice.facets(surface.dem()), surface.patches() * u64::from(n * n), "{name}");
        }
        assert_eq!(surface.dem().samples_read(), looked, "{name}: samples are read again");
    }
}

#[test]
fn words_of_voids_are_few() {
    let size = [1280, 1280];
    let words = |shape: Voids| held(shape, size).validity().expect("in memory").words().len();
    assert_eq!(words(SHAPES[0].1), 20 * 20);
    assert_eq!(words(|c, r, _| c == 700 && r == 3), 20 * 20 + 128);
    assert_eq!(words(|c, _, _| c < 640), 20 * 20, "blocks without any sample have no bits");
    let kinds: BTreeSet<u32> =
        held(|c, _, _| c < 640, size).validity().expect("in memory").words().iter().copied().collect();
    assert_eq!(kinds, BTreeSet::from([0, u32::MAX]));
}

#[test]
fn what_no_device_binds_is_refused_with_what_helps() {
    let most = LARGEST_BINDING / 16;
    assert!(rim_fits(most).is_ok() && valid_fits(LARGEST_BINDING / 4).is_ok());
    let rim = line(&rim_fits(most + 1).expect_err("too long"));
    assert!(rim.contains("129 MiB of border lines") && rim.contains("--border off") && rim.contains("--crop"), "{rim}");
    let valid = line(&valid_fits(LARGEST_BINDING / 4 + 1).expect_err("too many"));
    assert!(valid.contains("129 MiB of void marks") && valid.contains("--crop"), "{valid}");
    assert!(!valid.contains("--level"), "no level needs fewer: {valid}");
}

#[test]
fn a_tile_beyond_the_budget_is_read_once() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = written(&folder, SHAPES[0].1, [700, 800]);
    // Half of the budget, which tiles share, is less than a tile.
    let dem = dem(&path, 1 << 20);
    let tile = 512 * 512;
    let mut sum = 0.0;
    for (r, c) in (0..300).flat_map(|r| (0..500).map(move |c| (r, c))) {
        sum += f64::from(dem.height(c, r).unwrap_or(0.0));
    }
    assert!(sum > 0.0 && dem.samples_read() <= tile, "{} samples read", dem.samples_read());
}
