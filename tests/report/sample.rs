//! Results of a comparison that never was: two scenes, every method, and all that is awkward to write down.

use hachure::door::measure::figures::{
    AtDistance, ChainFigures, Convergence, DepthBand, DrawnLevel, FloorFigures, LevelOffset, PassFigures, PlaceOffsets,
    Run, SequenceRun, TruthReport,
};
use hachure::door::report::results::{ComparedScene, Machine, Results, SCHEMA, TruthSummary};

/// A name that HTML, CSV, SVG and the shell each have to quote.
pub const AWKWARD: &str = "a<b & c, \"d's\"";

/// Flags of a view.
const FLAGS: &str = "--eye 325249,4117889,2000 --azimuth 310 --altitude 0 --fov 60 --size 1280x720 --border off";

/// Level, precision and recall (1 px), milliseconds of a frame.
type Figures = (u32, f64, f64, f64);

/// Figures of each method, level by level: about those of West Temple.
const FIGURES: [(&str, [Figures; 4]); 6] = [
    ("walk", [(1, 0.897, 0.965, 38.4), (2, 0.992, 0.992, 44.1), (4, 0.998, 0.999, 56.2), (8, 1.0, 1.0, 114.0)]),
    ("contour", [(1, 0.912, 0.951, 46.2), (2, 0.991, 0.984, 51.9), (4, 0.998, 0.991, 63.0), (8, 0.999, 1.0, 131.0)]),
    ("toward-away", [(1, 0.916, 0.930, 29.8), (2, 0.998, 0.942, 34.6), (4, 1.0, 0.935, 46.3), (8, 1.0, 0.938, 101.0)]),
    (
        "toward-away-wide",
        [(1, 0.91, 0.958, 33.2), (2, 0.996, 0.979, 39.0), (4, 0.999, 0.988, 52.7), (8, 1.0, 0.991, 118.0)],
    ),
    ("adjacency", [(1, 0.184, 0.986, 71.0), (2, 0.073, 1.0, 102.0), (4, 0.029, 1.0, 187.0), (8, 0.017, 1.0, 183.0)]),
    (
        "adjacency-corner",
        [(1, 0.859, 0.985, 64.0), (2, 0.649, 1.0, 92.0), (4, 0.206, 1.0, 171.0), (8, 0.039, 1.0, 177.0)],
    ),
];

/// The whole of it; pages of `width` x `height` px.
pub fn results(width: u32, height: u32) -> Results {
    let scenes = vec![scene("west-temple", width, height), scene(AWKWARD, width, height)];
    let mut runs: Vec<Run> = scenes.iter().flat_map(runs_of).collect();
    // Nothing was drawn: no distances, no shares.
    let blank = runs.iter_mut().rfind(|run| run.method == "adjacency").expect("a run");
    (blank.precision, blank.recall, blank.f, blank.inked) = (0.0, 0.0, 0.0, 0);
    (blank.chamfer_px, blank.h95_px, blank.peak_mib) = (None, None, None);
    mark_fronts(&mut runs);
    Results {
        version: SCHEMA,
        hachure: "0.1.0",
        command: format!("hachure compare {AWKWARD:?} -o out --levels 1,2,4,8"),
        machine: Machine {
            system: "linux x86_64".into(),
            cores: 2,
            adapter: "llvmpipe (LLVM 15.0.6, 256 bits)".into(),
            adapter_kind: "cpu".into(),
            driver: "llvmpipe Mesa 22.3.6 (LLVM 15.0.6)".into(),
            int64: true,
            timing: "wall clock from submitting to done, median of 9 warm frames, the eye 1 m on each time".into(),
        },
        truth: TruthSummary { level: 32, self_f: 0.9991 },
        scenes,
        runs,
        sequences: Vec::new(),
    }
}

/// The same with two sequences, of which one has no ids.
pub fn with_sequences(width: u32, height: u32) -> Results {
    let run = |method, ids_kept| SequenceRun {
        scene: AWKWARD.into(),
        method,
        level: DrawnLevel::Auto,
        width,
        height,
        step_m: 10.0,
        frames: 20,
        truth_level: 16,
        pop: 0.01234,
        truth_pop: 0.012,
        excess_pop: 0.00034,
        recall: 0.9967,
        least_recall: 0.9951,
        strokes_lost: 0.0213,
        strokes_excess_pop: 0.00078,
        ids_kept,
        inked: 5465,
        frame_ms: 105.25,
        truth_ms: 20_500.0,
    };
    let sequences = vec![run("walk", Some(0.972)), run("adjacency", None)];
    Results { sequences, ..results(width, height) }
}

/// The same with what `--floor` adds; the first run lacks a depth draw.
pub fn with_floors(width: u32, height: u32) -> Results {
    let mut results = results(width, height);
    for (i, run) in results.runs.iter_mut().enumerate() {
        let draw_ms = (i > 0).then_some(run.frame_ms / 1.6);
        run.floor = Some(FloorFigures {
            bytes: 40_000_000,
            copy_ms: Some(run.frame_ms / 3.2),
            draw_ms,
            lacking: draw_ms.is_none().then_some("several vertex batches"),
            frame_per_copy: Some(3.2),
            frame_per_draw: draw_ms.map(|_| 1.6),
        });
    }
    results
}

fn scene(name: &str, width: u32, height: u32) -> ComparedScene {
    let convergence = (name != AWKWARD).then(|| Convergence {
        levels: [(1, 0.61), (2, 0.158), (4, 0.041), (8, 0.0112)]
            .map(|(level, px)| LevelOffset { level, median_px: px, mean_px: 1.5 * px, p95_px: 4.0 * px })
            .to_vec(),
        fitted_levels: vec![1, 2, 4],
        slope: Some(-1.947),
    });
    ComparedScene {
        name: name.into(),
        dem: vec![format!("{name}.tif")],
        columns: 120,
        rows: 140,
        cell_m: [50.0, 50.0],
        patches: 33_082,
        eye_m: [325_249.0, 4_117_889.0, 2000.0],
        north: "grid".into(),
        azimuth: 310.0,
        altitude: 0.0,
        fov: 60.0,
        flags: FLAGS.into(),
        command: format!("hachure draw '{}.tif' {FLAGS}", name.replace('\'', r"'\''")),
        width,
        height,
        border: name == AWKWARD,
        truth: TruthReport {
            level: 32,
            length_px: 3785.25,
            border_px: 0.0,
            fragments: 0.0312,
            short_chains: 0.0875,
            facets: 412_003,
            rays: 98_211,
            truth_ms: 2310.0,
            self_precision: 0.9995,
            self_recall: 0.9987,
            self_f: 0.9991,
            self_offset_px: (name != AWKWARD).then_some(0.0021),
        },
        convergence,
        picture: format!("{name}_truth.png"),
    }
}

fn runs_of(scene: &ComparedScene) -> Vec<Run> {
    let levels = if scene.name == AWKWARD { 2 } else { 4 };
    let slower = if scene.name == AWKWARD { 1.7 } else { 1.0 };
    let of =
        |method, &(level, precision, recall, ms): &Figures| run(scene, method, level, [precision, recall], ms * slower);
    FIGURES.iter().flat_map(|(method, figures)| figures[..levels].iter().map(move |f| of(method, f))).collect()
}

fn run(scene: &ComparedScene, method: &'static str, level: u32, [precision, recall]: [f64; 2], frame_ms: f64) -> Run {
    let f = 2.0 * precision * recall / (precision + recall);
    let inked = (3800.0 * recall / precision) as usize;
    let at = |px: f64| AtDistance {
        px,
        precision: precision.powf(1.0 / px),
        recall: recall.powf(1.0 / px),
        f: f.powf(1.0 / px),
    };
    let band = |name, to_m| DepthBand { name, to_m, truth_px: 1261.75, inked: inked / 3, precision, recall, f };
    let pass = |name, share: f64| {
        let moved = 4.0e7 * share;
        PassFigures { name, ms: frame_ms * share, bytes: moved as u64, operations: 3 * moved as u64 }
    };
    // Each method has passes of its own.
    let passes = match method {
        "contour" => vec![pass("tessellate", 0.4), pass("rasterize", 0.4), pass("segments", 0.2)],
        "walk" => vec![pass("tessellate", 0.4), pass("rasterize", 0.35), pass("walk", 0.2), pass("border", 0.05)],
        _ => vec![pass("tessellate", 0.4), pass("rasterize", 0.4), pass("silhouette", 0.2)],
    };
    Run {
        scene: scene.name.clone(),
        method,
        level: DrawnLevel::Of(level),
        width: scene.width,
        height: scene.height,
        precision,
        recall,
        f,
        gaps: ((1.0 - recall) * 330.0) as usize,
        spurious: ((1.0 - precision) * 40.0) as usize,
        chamfer_px: Some(0.31 + (1.0 - f)),
        h95_px: Some(0.9 + 30.0 * (1.0 - f)),
        fragments: 0.04 + 0.3 * (1.0 - f),
        pixel_recall: recall * recall,
        of_chains: chains(method, level, [precision, recall]),
        excess_pop: 0.002 * (1.0 - f),
        at: [0.5, 1.0, 2.0, 3.0].map(at).to_vec(),
        bands: vec![band("near", Some(2410.0)), band("middle", Some(5120.5)), band("far", None)],
        place: (method == "walk").then_some(PlaceOffsets { mean_px: 0.61 / f64::from(level * level), p95_px: 0.04 }),
        facets: 33_082 * u64::from(level * level),
        inked,
        frame_ms,
        frame_range_ms: [frame_ms * 0.96, frame_ms * 1.08],
        first_frame_ms: frame_ms * 1.6,
        setup_ms: 320.5,
        passes,
        floor: None,
        peak_mib: Some(412.25),
        buffers_bytes: 92_798_976,
        pareto: false,
        mask_hashes: vec!["9f86d081".into(), "60303ae2".into()],
        mask: format!("{}_{method}_{level}.png", scene.name),
        difference: format!("{}_{method}_{level}_difference.png", scene.name),
    }
}

/// Those of contours alone have names; adjacency found none at its coarsest.
fn chains(method: &str, level: u32, [precision, recall]: [f64; 2]) -> ChainFigures {
    let has_none = method == "adjacency" && level == 1;
    let of_some = |figure: f64| (!has_none).then_some(figure);
    ChainFigures {
        chains: if has_none { 0 } else { 214 },
        chains_px: if has_none { 0.0 } else { 3721.4 },
        short_chains: 0.1125,
        chain_mean_px: of_some(0.0572),
        chain_p95_px: of_some(0.1104),
        chain_precision: precision.powi(2),
        chain_recall: recall.powi(2),
        economy_removed: (method == "contour").then_some(0.064),
        ids_kept: (method == "contour").then_some(0.9375),
    }
}

/// Marks the runs of each scene that no other is both faster and better than.
fn mark_fronts(runs: &mut [Run]) {
    let marked: Vec<bool> =
        runs.iter().map(|a| !runs.iter().any(|b| b.scene == a.scene && b.frame_ms < a.frame_ms && b.f > a.f)).collect();
    runs.iter_mut().zip(marked).for_each(|(run, marked)| run.pareto = marked);
}
