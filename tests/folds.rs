//! Patches that fold, against the derivatives of the surface itself; tangents limited, after which nothing folds, of a DEM held and
//! of one in its file; and what users are told of both.

use std::collections::HashSet;

use glam::DVec2;
use hachure::cache::Cache;
use hachure::dem::Dem;
use hachure::door::surface::lattice::CELL_STEPS;
use hachure::door::surface::patch::Patch;
use hachure::door::surface::{Lattice, PatchAt};
use hachure::geo::{ReadOptions, read, write};
use hachure::surface::Surface;
use serde_json::Value;

use crate::cli::{Place, stderr};
use crate::scenes::{level, noise, noisy, surface};

const CELL: f64 = 30.0;
const SAMPLES: [usize; 2] = [41, 29];
/// Subdivisions at whose vertices derivatives are looked at.
const LOOKED: u32 = 48;

/// The least ground about the vertices of a patch, of a flat one 1, by its derivatives.
fn least_ground(surface: &Surface, PatchAt { cell: [r, c], half }: PatchAt) -> f64 {
    let (r, c) = (r as usize, c as usize);
    let corner = |c: usize, r: usize| {
        let position = surface.dem().position(c, r) - surface.dem().position(0, 0);
        (position, (-surface.gradient(c, r)).extend(1.0).normalize())
    };
    let corners = [corner(c, r), corner(c, r + 1), corner(c + 1, r + 1), corner(c + 1, r)];
    let patch = Patch::of_cell(corners, half);
    let vertices = (0..=LOOKED).flat_map(|j| (0..=LOOKED - j).map(move |k| [LOOKED - j - k, j, k]));
    let ground = vertices.map(|weights| {
        let [a, b, c] = patch.derivatives(weights.map(|weight| f64::from(weight) / f64::from(LOOKED)));
        (b - a).truncate().perp_dot((c - a).truncate()) / (CELL * CELL)
    });
    ground.fold(f64::INFINITY, f64::min)
}

fn patches() -> impl Iterator<Item = PatchAt> {
    let cells = (0..SAMPLES[1] as u32 - 1).flat_map(|r| (0..SAMPLES[0] as u32 - 1).map(move |c| [r, c]));
    cells.flat_map(|cell| [0, 1].map(|half| PatchAt { cell, half }))
}

fn lattices(surface: &Surface) -> impl Iterator<Item = Lattice> {
    [2, 4, 8, 16, 32, 64].into_iter().map(|n| Lattice::uniform(surface.dem(), level(n)).expect("a lattice"))
}

#[test]
fn patches_fold_where_their_derivatives_turn_back() {
    let (mut folding, mut flat, mut near) = (0, 0, 0);
    for (seed, relief) in (1..).zip([10.0, 40.0, 60.0, 100.0, 200.0, 1000.0]) {
        let surface = noisy(seed, SAMPLES, CELL, relief);
        let folds = surface.folds().expect("folds");
        let found: HashSet<_> = folds.iter().map(|fold| (fold.at.cell, fold.at.half)).collect();
        assert!(found.len() == folds.len() && folds.is_sorted_by_key(|fold| fold.at), "each once, in order");
        for at in patches() {
            let ground = least_ground(&surface, at);
            let folds = found.contains(&(at.cell, at.half));
            assert!(folds || ground > 0.0, "{at:?} at relief {relief}: ground {ground}, not found");
            // Between the vertices that are looked at here it may be a little less.
            assert!(!folds || ground < 0.02, "{at:?} at relief {relief}: ground {ground}, found to fold");
            near += usize::from(ground.abs() < 0.02);
            if folds { folding += 1 } else { flat += 1 }
        }
        for fold in folds {
            assert!(fold.ground >= least_ground(&surface, fold.at) - 0.05, "{fold:?}");
            let place = surface.dem().grid_place(fold.place);
            assert!((place - DVec2::new(fold.at.cell[1].into(), fold.at.cell[0].into())).abs().max_element() < 1e3);
        }
    }
    assert!(folding > 3000 && flat > 3000 && near > 30, "{folding} fold, {flat} do not, {near} nearly");
}

#[test]
fn facets_fold_where_their_corners_stand_clockwise() {
    for relief in [20.0, 300.0] {
        let surface = noisy(3, SAMPLES, CELL, relief);
        for lattice in lattices(&surface).take(4) {
            let step = lattice.chunks()[0].step;
            let mut expected = 0;
            let end = |samples: usize| (samples as u32 - 1) * CELL_STEPS;
            for y in (0..end(SAMPLES[1])).step_by(step as usize) {
                for x in (0..end(SAMPLES[0])).step_by(step as usize) {
                    let at = |dx, dy| {
                        let at = hachure::door::surface::LatticePoint { x: x + dx * step, y: y + dy * step };
                        surface.position(at).expect("a vertex").truncate()
                    };
                    for [a, b, c] in [[at(0, 0), at(0, 1), at(1, 1)], [at(0, 0), at(1, 1), at(1, 0)]] {
                        expected += u64::from((b - a).perp_dot(c - a) <= 0.0);
                    }
                }
            }
            assert_eq!(surface.folding_facets(&lattice).expect("facets"), expected, "step {step}, relief {relief}");
            assert_eq!(expected > 0, relief > 100.0, "step {step}, relief {relief}");
        }
    }
}

#[test]
fn limits_leave_no_fold_at_any_level_and_all_else_as_it_is() {
    for (seed, relief) in (1..).zip([60.0, 100.0, 300.0, 3000.0, 1e6]) {
        let before = noisy(seed, SAMPLES, CELL, relief);
        let folds = before.folds().expect("folds");
        assert!(!folds.is_empty(), "relief {relief}: nothing to limit");
        let limited = (*before).clone().limited().expect("limits");
        assert_eq!(limited.folds().expect("folds"), [], "relief {relief}");
        for lattice in lattices(&limited) {
            assert_eq!(limited.folding_facets(&lattice).expect("facets"), 0, "relief {relief}");
        }
        let [old, new] = [&before, &limited].map(|surface| surface.gradients().expect("held").concat());
        let samples = SAMPLES[0] * SAMPLES[1];
        let changed: HashSet<usize> = (0..old.len()).filter(|i| old[*i] != new[*i]).map(|i| i % samples).collect();
        let moved = limited.moved().expect("moved").expect("limits");
        assert!(changed.len() <= moved.samples && changed.len() * 10 > moved.samples * 9, "{moved:?}");
        assert!(0.0 < moved.mean && moved.mean < moved.most && moved.most < relief, "relief {relief}: {moved:?}");
        // Where few patches fold most samples keep their normals.
        assert!(relief > 60.0 || changed.len() < samples / 2, "{} of {samples} samples", changed.len());
        // A normal that leans as before folds its patches again.
        let heights: Vec<f32> =
            (0..samples).map(|i| limited.dem().height(i % SAMPLES[0], i / SAMPLES[0]).expect("a height")).collect();
        let again = surface(SAMPLES[0], CELL, heights);
        assert_eq!(again.folds().expect("folds").len(), folds.len());
    }
}

#[test]
fn what_does_not_fold_is_not_limited() {
    let surface = noisy(1, SAMPLES, CELL, 10.0);
    let limited = (*surface).clone().limited().expect("limits");
    assert_eq!(limited.gradients().expect("held"), surface.gradients().expect("held"));
    assert_eq!(limited.moved().expect("moved"), None);
}

/// Noise of 600 x 400 samples that folds here and there.
fn filed(folder: &std::path::Path, memory: u64) -> Dem {
    let path = folder.join("noise.tif");
    if !path.exists() {
        let heights = noise(9, [600, 400], CELL, 60.0);
        let row = |r: usize| heights[r * 600..(r + 1) * 600].to_vec();
        write(&path, [600, 400], CELL, row, &|_| ()).expect("a file");
    }
    read(&path, &ReadOptions { memory, ..Default::default() }).expect("a DEM")
}

#[test]
fn a_dem_in_its_file_is_limited_as_a_held_one() {
    let folder = tempfile::tempdir().expect("a folder");
    let cache = Cache::in_folder(folder.path().join("cache"));
    let held = Surface::new(filed(folder.path(), 1 << 30)).limited().expect("limits");
    let moved = held.moved().expect("moved").expect("some limits");
    assert!(moved.samples > 1000 && moved.samples < 120_000, "{moved:?}");
    // Twice: what is kept of the surface without limits is not what is kept of the limited one.
    for _ in 0..2 {
        let surface = Surface::new(filed(folder.path(), 1 << 18));
        assert!(surface.dem().is_filed());
        let silent = |message: &hachure::error::Message| panic!("{message}");
        cache.prepare(&surface, &silent, &|_| ()).expect("prepared");
        let limited = surface.limited().expect("limits");
        cache.prepare(&limited, &silent, &|_| ()).expect("prepared");
        let bytes = |surface: &Surface| surface.pyramid().expect("a pyramid").bytes().collect::<Vec<_>>().concat();
        assert!(bytes(&limited) == bytes(&held), "bounds differ");
        assert_eq!(limited.moved().expect("moved"), Some(moved));
        assert_eq!(limited.folds().expect("folds"), []);
        let ([c, r], size) = ([130, 60], [40, 30]);
        let part = limited.part([c, r], size).expect("a part");
        for (c, r) in (r..r + size[1]).flat_map(|r| (c..c + size[0]).map(move |c| (c, r))) {
            assert_eq!(part.gradient(c, r), held.gradient(c, r), "{c}, {r}");
        }
        assert_eq!(limited.gradient(133, 71), held.gradient(133, 71));
        for band in limited.bands(0) {
            let band = band.expect("a band");
            let row = band.rows.start;
            assert!((0..600).all(|c| band.surface.gradient(c, row) == held.gradient(c, row)), "row {row}");
        }
    }
}

/// A folder with `noise.asc`: 40 x 40 samples, 10 m, heights up to 8 m at random, which folds where they are five times as high.
fn stiff_place() -> Place {
    let place = Place::new();
    let heights = noise(5, [40, 40], 10.0, 8.0);
    let heights: Vec<String> = heights.iter().map(|height| format!("{:.3}", height - 1490.0)).collect();
    let header = "ncols 40\nnrows 40\nxllcorner 500000\nyllcorner 4000000\ncellsize 10\n";
    std::fs::write(place.path("noise.asc"), format!("{header}{}\n", heights.join(" "))).expect("noise.asc");
    place
}

/// The report of a drawing, and what was warned of.
fn drawn(place: &Place, flags: &[&str]) -> (Value, String) {
    let fixed = ["draw", "noise.asc", "-o", "x.png", "--json", "x.json", "--mask", "mask.png", "--size", "320x200"];
    let output = place.run(&[&fixed[..], flags].concat());
    assert!(output.status.success(), "{}", stderr(&output));
    let text = std::fs::read_to_string(place.path("x.json")).expect("a report");
    (serde_json::from_str(&text).expect("JSON"), stderr(&output))
}

#[test]
fn a_drawing_tells_of_folds_and_limits_them() {
    let place = stiff_place();
    let mask = || std::fs::read(place.path("mask.png")).expect("a mask");
    let view = ["--eye", "500200,4000010,+300", "--azimuth", "0", "--altitude", "-20"];
    let stiff = [&view[..], &["--exaggeration", "5"]].concat();
    let (report, warned) = drawn(&place, &stiff);
    let folds = &report["folds"];
    assert!(folds["in_view"]["share"].as_f64() > Some(0.001) && folds["patches"].as_u64() > Some(20), "{folds}");
    assert!(folds["limited"].is_null() && warned.contains("--limit-folds"), "{folds}: {warned}");
    let stiff_mask = mask();
    let (report, warned) = drawn(&place, &[&stiff[..], &["--limit-folds"]].concat());
    let folds = &report["folds"];
    assert_eq!((&folds["in_view"]["facets"], &folds["patches"]), (&0.into(), &0.into()));
    assert!(
        folds["limited"]["most_m"].as_f64() > folds["limited"]["mean_m"].as_f64() && !warned.contains("fold"),
        "{folds}: {warned}"
    );
    assert!(mask() != stiff_mask, "limited tangents draw something else");
    // Land that does not fold is drawn as it was, bit for bit, and nothing is said.
    let (report, warned) = drawn(&place, &view);
    let gentle = mask();
    assert_eq!(report["folds"]["in_view"]["facets"], 0);
    let (report, limited) = drawn(&place, &[&view[..], &["--limit-folds"]].concat());
    assert!(mask() == gentle && report["folds"]["limited"].is_null());
    assert!(!warned.contains("fold") && !limited.contains("fold"), "{warned}{limited}");
}

#[test]
fn info_says_how_many_patches_fold_and_where() {
    let place = stiff_place();
    let told = |flags: &[&str]| {
        let output = place.run(&[&["info", "noise.asc"], flags].concat());
        assert!(output.status.success(), "{}", stderr(&output));
        let text = String::from_utf8(output.stdout).expect("text");
        let lines = text.lines().filter(|line| line.starts_with("folds ") || line.starts_with("limited "));
        lines.map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(told(&[]), Vec::<String>::new(), "it takes a look at the whole DEM, for which nobody asked");
    let gentle = told(&["--folds"]);
    assert!(gentle.len() == 1 && gentle[0].ends_with(": none"), "{gentle:?}");
    let stiff = told(&["--folds", "--exaggeration", "5", "--limit-folds"]);
    assert!(stiff.len() == 2 && stiff[0].contains("the worst in the cell at column"), "{stiff:?}");
    assert!(stiff[1].contains(" m at most") && stiff[1].ends_with("; 0 folds are left"), "{stiff:?}");
}

#[test]
fn limits_are_part_of_what_a_drawing_is_called() {
    let place = stiff_place();
    let batch = |flag: &str| {
        let text = format!(
            "[defaults]\ndem = \"noise.asc\"\nsize = \"200x120\"\nexaggeration = 5\n{flag}\n[[drawing]]\noutput = \"a.png\"\n"
        );
        std::fs::write(place.path("all.toml"), text).expect("a batch");
        let output = place.run(&["batch", "all.toml"]);
        assert!(output.status.success(), "{}", stderr(&output));
        std::fs::read(place.path("a.png")).expect("a drawing")
    };
    let without = batch("");
    assert!(batch("limit-folds = true") != without, "it is drawn anew");
    assert!(batch("") == without);
}
