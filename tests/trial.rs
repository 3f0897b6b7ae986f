//! A method that yields curves goes through a trial as those do that yield ink: truth of a coarser level takes its part.
//! And what setting up a run takes does not hang on the runs before it.

use std::cell::{Cell, RefCell};
use std::num::NonZeroU32;
use std::sync::Arc;
use std::time::Instant;

use glam::{DVec2, DVec3};
use hachure::cache::Cache;
use hachure::door::measure::compare::{CompareObserver, Comparison, Finding, LEAST_TRUTH_LEVEL, ShownPicture};
use hachure::door::measure::curves::MeasuredCurves;
use hachure::door::measure::figures::{DrawnLevel, PassFigures, Run};
use hachure::door::measure::trial::{Draws, Trial};
use hachure::door::report::pictures::of_shown;
use hachure::error::Result;
use hachure::gpu::{AdapterChoice, Gpu, Int64};
use hachure::line::{Chain, ChainPoint, Line};
use hachure::plan::{Border, Method, SharedVertices};
use hachure::surface::{Level, Surface};
use hachure::truth::metrics::Judge;
use hachure::truth::{Mask, Terrain, Truth, TruthPiece};
use hachure::view::{Camera, Perspective};

use crate::scenes::{level, look, rough};
use crate::tolerances::CUT_PX;

/// Metres to a near plane.
const NEAR: f64 = 1.0;

/// Draws the lines of a level as curves.
struct Levels<'a> {
    terrain: &'a Terrain<'a>,
    level: Level,
    last: Option<(Truth, Perspective)>,
}

impl Draws for Levels<'_> {
    type Yield = MeasuredCurves;

    fn time_of_frame(&mut self, camera: &Camera) -> Result<f64> {
        let start = Instant::now();
        self.last = Some((self.terrain.truth(camera, self.level), Perspective::new(camera, NEAR)));
        Ok(start.elapsed().as_secs_f64() * 1e3)
    }

    fn yielded(&mut self) -> Result<MeasuredCurves> {
        let (truth, perspective) = self.last.clone().expect("a frame");
        let chains = truth.on_page().map(|piece| chain(piece, &perspective)).collect();
        Ok(MeasuredCurves::new(chains, &perspective))
    }

    fn passes(&mut self, camera: &Camera) -> Result<Vec<PassFigures>> {
        Ok(vec![PassFigures { name: "truth", ms: self.time_of_frame(camera)?, bytes: 0, operations: 0 }])
    }

    fn facets(&self) -> u64 {
        self.last.as_ref().map_or(0, |(truth, _)| truth.facets)
    }

    fn buffers_bytes(&self) -> u64 {
        0
    }
}

/// A piece of truth as a chain without a name.
fn chain(piece: &TruthPiece, perspective: &Perspective) -> Chain {
    let depth = NEAR / piece.distance;
    let point = |place: DVec2| {
        let world = perspective.unproject(place, depth);
        ChainPoint {
            place,
            line: Line::Occluding,
            depth: depth as f32,
            behind: 0.0,
            world,
            crowd: 0,
            weight: 1.0,
            black: 1.0,
        }
    };
    Chain { id: None, points: piece.ends.map(point).to_vec(), closed: false }
}

/// From the south, on hills against hills and sky.
fn from_south(surface: &Surface) -> Camera {
    let [west, south, east, north] = surface.dem().extent();
    let middle = DVec3::new((west + east) / 2.0, (south + north) / 2.0, 0.0);
    look(middle + DVec3::new(0.0, -700.0, 160.0), middle, 60.0, [160, 96])
}

/// The camera so many metres on.
fn moved(camera: &Camera, metres: f64) -> Camera {
    Camera { eye: camera.eye + camera.axes()[2] * metres, ..*camera }
}

/// A run of the curves of a level against truth, and its mask as PNG.
fn try_level(terrain: &Terrain<'_>, camera: &Camera, of: Level, judge: &Judge<'_>) -> (Run, Vec<u8>) {
    let mask = RefCell::new(Vec::new());
    let trial = Trial {
        camera,
        scene: "rough",
        method: "curves",
        level: DrawnLevel::Of(of.subdivisions()),
        repeat: NonZeroU32::MIN.saturating_add(1),
        judge,
        truth_pop: 0.0,
        found: &|found| {
            if let Finding::Picture(name, shown @ ShownPicture::Mask(_)) = found {
                *mask.borrow_mut() = of_shown(name.to_owned(), shown)?.png;
            }
            Ok(())
        },
    };
    let run = trial.run(&mut Levels { terrain, level: of, last: None }, 0.0).expect("a run");
    (run, mask.take())
}

#[test]
fn curves_are_judged_as_ink_is() {
    let surface = Surface::new(rough(40, 36, 1.0, 4.0, false));
    let camera = from_south(&surface);
    let terrain = Terrain::new(&surface);
    let truth = terrain.truth(&camera, level(8));
    let judge = Judge::new(&truth).expect("a line");
    let half = terrain.truth(&camera, level(4));
    let mask = Mask::of_truth(&half);
    let direct = judge.measure(&mask).scores();
    let (run, png) = try_level(&terrain, &camera, level(4), &judge);

    let agreement = direct.agreement();
    assert!(mask.inked.len() > 100 && agreement.f() > 0.5, "{} px, {agreement:?}", mask.inked.len());
    assert_eq!([run.precision, run.recall, run.f], [agreement.precision, agreement.recall, agreement.f()]);
    assert_eq!([run.gaps, run.spurious, run.inked], [direct.gaps, direct.spurious, mask.inked.len()]);
    assert_eq!([run.chamfer_px, run.h95_px], [direct.chamfer, direct.h95]);
    let chains = &run.of_chains;
    assert_eq!(
        (chains.chains, chains.ids_kept),
        (half.on_page().count(), None),
        "each piece is a chain without a name"
    );
    assert_eq!((chains.short_chains, run.pixel_recall), (1.0, direct.pixel_recall));
    let curves = judge.offsets_of(&half).expect("a line");
    let near = |found: Option<f64>, known: f64| {
        assert!((found.expect("a figure") - known).abs() < CUT_PX, "{found:?}, {known}")
    };
    near(chains.chain_mean_px, curves.mean);
    near(chains.chain_p95_px, curves.p95);
    let last = terrain.truth(&moved(&camera, 2.0), level(4));
    assert_eq!(run.facets, last.facets, "facets are those of the last frame");
    let place = run.place.as_ref().expect("curves have places");
    let middles: Vec<DVec2> = half.on_page().map(TruthPiece::middle).collect();
    near(Some(place.p95_px), judge.offsets(&middles).expect("places").p95);
    assert_eq!((run.mask_hashes.len(), run.passes.len()), (2, 1));
    let picture = image::load_from_memory(&png).expect("a PNG").to_luma8();
    assert!(picture.pixels().map(|pixel| pixel.0[0] == 0).eq(mask.pixels()), "the mask is that of the curves");

    // Negative control: the curves of another level.
    let (coarse, other) = try_level(&terrain, &camera, level(1), &judge);
    assert!(coarse.f < run.f && coarse.chamfer_px > run.chamfer_px && other != png, "level 1 passes for level 4");
    assert_ne!(coarse.mask_hashes, run.mask_hashes);
}

/// How many passes each run of a comparison of these methods compiles.
fn compiled(gpu: &Arc<Gpu>, methods: &[Method]) -> Vec<usize> {
    let surface = Arc::new(Surface::new(rough(40, 36, 1.0, 4.0, false)));
    let comparison = Comparison {
        methods: methods.to_vec(),
        levels: vec![level(1).into()],
        repeat: NonZeroU32::MIN,
        floor: false,
        border: Border::On,
        truth_level: Some(LEAST_TRUTH_LEVEL),
        cache: Cache::none(),
    };
    let (before, compiled) = (Cell::new(gpu.compiled()), RefCell::new(Vec::new()));
    let hearing = CompareObserver {
        stage: &|_, _| (),
        warn: &|_| (),
        found: &|found| {
            if let Finding::Run(_) = found {
                compiled.borrow_mut().push(gpu.compiled() - before.replace(gpu.compiled()));
            }
            Ok(())
        },
    };
    let camera = from_south(&surface);
    comparison.scene(gpu, &surface, "rough", &Terrain::new(&surface), &camera, &hearing).expect("runs");
    compiled.into_inner()
}

#[test]
fn every_run_compiles_its_passes_whichever_ran_before() {
    let gpu = Arc::new(Gpu::open(&AdapterChoice::Best, Int64::IfPresent).expect("an adapter"));
    let [walk, adjacency] = [Method::Walk, Method::Adjacency { share: SharedVertices::Edge }];
    let alone = [walk, adjacency].map(|method| compiled(&gpu, &[method])[0]);
    assert!(alone.iter().all(|passes| *passes > 5), "{alone:?}");
    assert_eq!(compiled(&gpu, &[walk, adjacency]), alone);
    assert_eq!(compiled(&gpu, &[walk, walk]), [alone[0]; 2], "the second of two runs of one method");
}
