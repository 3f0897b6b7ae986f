//! Real terrain: the figures of an independent study of the seed scene (1280 x 720, no border lines, truth at level 32),
//! and what truth costs.

use std::process::Command;
use std::sync::Arc;
use std::time::Instant;

use glam::DVec3;
use hachure::door::measure::memory::peak;
use hachure::geo::{ReadOptions, read};
use hachure::plan::{Border, Method, SharedVertices};
use hachure::surface::Surface;
use hachure::truth::metrics::{Agreement, Judge};
use hachure::truth::{Mask, Terrain};
use hachure::view::Camera;

use crate::common::shared_dems;
use crate::frames::draw_mask;
use crate::scenes::level;
use crate::tolerances::{SELF_F, STUDY, STUDY_ADJACENCY, STUDY_LENGTH, TRUTH_BYTES, TRUTH_SECONDS};

const VIEW: Camera = Camera {
    eye: DVec3::new(325_249.0, 4_117_889.0, 2_000.0),
    azimuth: 310.0,
    altitude: 0.0,
    fov: 60.0,
    width: 1280,
    height: 720,
};

/// Pixels of true line in the study.
const LENGTH: f64 = 3785.0;

const EDGE: Method = Method::Adjacency { share: SharedVertices::Edge };
const CORNER: Method = Method::Adjacency { share: SharedVertices::Corner };
const TOWARD_AWAY: Method = Method::TowardAway { wide: false };

/// Method, level, precision and recall in the study, and how far ours may be from them.
const STUDIED: [(Method, u32, f64, f64, f64); 14] = [
    (TOWARD_AWAY, 2, 0.998, 0.942, STUDY),
    (TOWARD_AWAY, 4, 1.0, 0.935, STUDY),
    (TOWARD_AWAY, 8, 1.0, 0.938, STUDY),
    (Method::Walk, 2, 0.992, 0.992, STUDY),
    (Method::Walk, 4, 0.998, 0.999, STUDY),
    (Method::Walk, 8, 1.0, 1.0, STUDY),
    (EDGE, 1, 0.184, 0.986, STUDY_ADJACENCY),
    (EDGE, 2, 0.073, 1.0, STUDY_ADJACENCY),
    (EDGE, 4, 0.029, 1.0, STUDY_ADJACENCY),
    (EDGE, 8, 0.017, 1.0, STUDY_ADJACENCY),
    (CORNER, 1, 0.859, 0.985, STUDY_ADJACENCY),
    (CORNER, 2, 0.649, 1.0, STUDY_ADJACENCY),
    (CORNER, 4, 0.206, 1.0, STUDY_ADJACENCY),
    (CORNER, 8, 0.039, 1.0, STUDY_ADJACENCY),
];

#[test]
fn west_temple_has_the_figures_of_the_study() {
    let Some(folder) = shared_dems() else { return };
    let surface =
        Arc::new(Surface::new(read(folder.join("west_temple_50m.tif"), &ReadOptions::default()).expect("west-temple")));
    let terrain = Terrain::new(&surface);
    let truth_at = |n| {
        let start = Instant::now();
        let truth = terrain.truth(&VIEW, level(n)).without_border();
        let (length, seconds) = (truth.length(), start.elapsed().as_secs_f64());
        println!("truth, level {n}: {length:.1} px, {} facets, {} rays, {seconds:.2} s", truth.facets, truth.rays);
        (truth, seconds)
    };
    let (truth, _) = truth_at(32);
    assert!((truth.length() / LENGTH - 1.0).abs() <= STUDY_LENGTH, "{:.1} px, {LENGTH} in the study", truth.length());
    let judge = Judge::new(&truth).expect("lines");
    let draw = |method, n| judge_of(&judge, &draw_mask(&surface, &VIEW, level(n), method, Border::Off));
    for (method, n, precision, recall, tolerance) in STUDIED {
        let (found, gaps, _) = draw(method, n);
        let study = Agreement { precision, recall };
        println!(
            "{method:?} level {n}: P {:.4} R {:.4} F {:.4}, {gaps} gaps",
            found.precision,
            found.recall,
            found.f()
        );
        assert!(within(found, study, tolerance), "{method:?} level {n}: {found:?}, {study:?} in the study");
    }
    // Negative control: toward-away in place of walk, and another level of adjacency.
    let row = |i: usize| Agreement { precision: STUDIED[i].2, recall: STUDIED[i].3 };
    assert!(!within(draw(TOWARD_AWAY, 8).0, row(5), STUDY), "toward-away passes for walk");
    assert!(!within(draw(CORNER, 2).0, row(10), STUDY_ADJACENCY), "level 2 passes for level 1");

    let (walk, gaps, spurious) = draw(Method::Walk, 8);
    assert!(walk.precision >= 0.998 && walk.recall >= 0.998, "walk at level 8: {walk:?}");
    assert!(gaps <= 1 && spurious == 0, "walk at level 8: {gaps} gaps, {spurious} spurious");
    let (wide, gaps, spurious) = draw(Method::TowardAway { wide: true }, 8);
    println!("toward-away wide level 8: {wide:?}, {gaps} gaps, {spurious} spurious");
    assert!(wide.recall >= 0.985 && wide.precision >= 0.995, "wide at level 8: {wide:?}");

    let (half, seconds) = truth_at(16);
    assert!(seconds <= TRUTH_SECONDS[0], "level 16 took {seconds:.1} s");
    let own = judge_of(&judge, &Mask::of_truth(&half)).0.f();
    println!("level 16 against level 32: F {own:.5}");
    assert!(own >= SELF_F, "level 16 against level 32: F {own:.5}");
}

/// Agreement, gaps, spurious ink.
fn judge_of(judge: &Judge<'_>, mask: &Mask) -> (Agreement, usize, usize) {
    let scores = judge.measure(mask).scores();
    (scores.agreement(), scores.gaps, scores.spurious)
}

fn within(found: Agreement, study: Agreement, tolerance: f64) -> bool {
    let apart = [found.precision - study.precision, found.recall - study.recall, found.f() - study.f()];
    apart.iter().all(|d| d.abs() <= tolerance)
}

#[test]
#[cfg(target_os = "linux")]
fn three_million_cells_take_little_time_and_memory() {
    if shared_dems().is_none() {
        return;
    }
    // Alone in a process, for the peak is the process's.
    let test = std::env::current_exe().unwrap();
    let child = "truth::west_temple::child_finds_the_truth_of_st_helens";
    let ran = Command::new(test).args(["--exact", child, "--ignored", "--nocapture"]).output().unwrap();
    let said = String::from_utf8_lossy(&ran.stdout).into_owned();
    assert!(ran.status.success(), "{said}{}", String::from_utf8_lossy(&ran.stderr));
    println!("{}", said.lines().find(|line| line.starts_with("st-helens")).unwrap_or_else(|| panic!("{said}")));
}

#[test]
#[ignore = "run by three_million_cells_take_little_time_and_memory in a process of its own"]
#[cfg(target_os = "linux")]
fn child_finds_the_truth_of_st_helens() {
    let dem = read(shared_dems().unwrap().join("sthelens_utm10n_10m.tif"), &ReadOptions::default()).unwrap();
    let surface = Arc::new(Surface::new(dem));
    let eye = DVec3::new(560_374.0, 5_124_979.0, 1_223.0);
    let camera = Camera { eye, azimuth: 170.0, altitude: -3.0, fov: 60.0, width: 1024, height: 768 };
    let start = Instant::now();
    let truth = Terrain::new(&surface).truth(&camera, level(8));
    let (seconds, bytes) = (start.elapsed().as_secs_f64(), peak().unwrap());
    println!(
        "st-helens, level 8: {:.0} px of line, {} facets, {} rays, {seconds:.1} s, {} MB at most",
        truth.length(),
        truth.facets,
        truth.rays,
        bytes >> 20
    );
    assert!(seconds <= TRUTH_SECONDS[1] && bytes <= TRUTH_BYTES, "{seconds:.1} s, {bytes} bytes");
}
