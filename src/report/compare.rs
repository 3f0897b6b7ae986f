//! One view on one page: every method at every level against truth, and what each costs.
//!
//! Cost: truths of the level, of all coarser ones (how fast they close in) and of the next eye, unless kept; then a
//! renderer, the first frame and the warm frames of each run. Nothing is timed while anything else is computed.
//! Each warm frame moves the eye 1 m along the view axis, so that nothing of an earlier frame can be used again.

use std::cell::Cell;

use glam::DVec2;
use xxhash_rust::xxh3::xxh3_64;

use super::cache::{Cache, Kept};
use super::memory;
use super::pictures::{Picture, difference_picture, mask_picture, truth_picture};
use super::results::{AtDistance, Band, Convergence, LevelOffset, Place, Run, TruthReport};
use crate::error::{Error, Result};
use crate::gpu::Gpu;
use crate::ink::{InkRaster, trace};
use crate::plan::{Border, Method, Plan, Share};
use crate::render::{Frame, Renderer};
use crate::surface::{Level, Surface};
use crate::truth::metrics::{DISTANCES, FRAGMENT, Judge, Offsets};
use crate::truth::{Inked, Mask, Terrain, Truth};
use crate::view::Camera;

/// Truth is no coarser, however far the view.
pub const LEAST_TRUTH_LEVEL: Level = Level::EIGHT;
/// Share of a scene's work that is given to truth on a progress bar.
const TRUTH_SHARE: f64 = 0.5;
/// Names of the bands of depth.
const BANDS: [&str; 3] = ["near", "middle", "far"];
/// Coarser truths whose median offset is so many times that of half the level are far enough from truth's own error.
const ABOVE_OWN_ERROR: f64 = 3.0;

/// The methods by the names a comparison has for them.
pub const METHODS: [(&str, Method); 5] = [
    ("walk", Method::Walk),
    ("toward-away", Method::TowardAway { wide: false }),
    ("toward-away-wide", Method::TowardAway { wide: true }),
    ("adjacency", Method::Adjacency { share: Share::Edge }),
    ("adjacency-corner", Method::Adjacency { share: Share::Corner }),
];

/// What is compared in every scene.
#[derive(Debug, Clone)]
pub struct Comparison {
    /// Name and method.
    pub methods: Vec<(&'static str, Method)>,
    /// Each method is run at each.
    pub levels: Vec<Level>,
    /// Warm frames behind a median.
    pub repeat: usize,
    /// Whether border lines are drawn and judged.
    pub border: Border,
    /// Level of truth; `None` for the one at which no visible cell's edge is longer than a pixel.
    pub truth_level: Option<Level>,
    /// Where truths are kept.
    pub cache: Cache,
}

/// Who hears of the work.
pub struct Hearing<'a> {
    /// What is being done, and the share of the scene's work that is done, 0 to 1.
    pub stage: &'a dyn Fn(&str, f64),
    /// Something the user should know.
    pub warn: &'a dyn Fn(&str),
    /// A line on what was found.
    pub say: &'a dyn Fn(&str) -> Result<()>,
    /// A line for those who want to know more.
    pub detail: &'a dyn Fn(&str) -> Result<()>,
}

/// What was found of a scene.
pub struct Compared {
    /// Of its truth.
    pub truth: TruthReport,
    /// How coarser levels close in on it.
    pub convergence: Option<Convergence>,
    /// Methods times levels.
    pub runs: Vec<Run>,
    /// File name of truth drawn one pixel wide.
    pub picture: String,
    /// Every picture, by the names that the runs have for them.
    pub pictures: Vec<Picture>,
}

/// A scene's truths.
struct Truths {
    truth: Truth,
    report: TruthReport,
    convergence: Option<Convergence>,
    /// Share of truth, drawn one pixel wide, that pops when the eye moves on.
    pop: f64,
}

impl Comparison {
    /// File names of a scene's pictures.
    pub fn picture_names(&self, scene: &str) -> Vec<String> {
        let stems = self.levels.iter().flat_map(|level| self.methods.iter().map(|(name, _)| stem(scene, name, *level)));
        let of_runs = stems.flat_map(|stem| [mask_name(&stem), difference_name(&stem)]);
        of_runs.chain([truth_name(scene)]).collect()
    }

    /// Compares in one scene, whose `name` begins the names of its files.
    ///
    /// # Errors
    /// [`Error::Scene`] where there is nothing to compare; those of [`Renderer`].
    pub fn scene(
        &self,
        gpu: &Gpu,
        name: &str,
        terrain: &Terrain<'_>,
        camera: &Camera,
        to: &Hearing<'_>,
    ) -> Result<Compared> {
        let Truths { truth, report, convergence, pop } = self.truths(name, terrain, camera, to)?;
        (to.say)(&truth_line(name, &report))?;
        if let Some(Convergence { slope: Some(slope), fitted_levels, .. }) = &convergence {
            (to.say)(&format!("{name} flip edges close in on truth: slope {slope:.2} over levels {fitted_levels:?}"))?;
        }
        let Some(judge) = Judge::new(&truth) else { return Err(no_line(name)) };
        let picture = truth_name(name);
        let mut pictures = vec![truth_picture(picture.clone(), &Mask::of_truth(&truth))?];
        let mut runs = Vec::new();
        for &level in &self.levels {
            for &(method_name, method) in &self.methods {
                let done = runs.len() as f64 / (self.levels.len() * self.methods.len()) as f64;
                let words = format!("{name}: {method_name} at level {}", level.subdivisions());
                (to.stage)(&words, TRUTH_SHARE + (1.0 - TRUTH_SHARE) * done);
                let stem = stem(name, method_name, level);
                let trial =
                    Trial { gpu, surface: terrain.surface, plan: Plan::new(level, method, self.border), camera };
                let (run, drawn) = trial.run(name, method_name, &stem, self.repeat, &judge, pop)?;
                (to.say)(&line(&run))?;
                (to.detail)(&format!("  masks of the warm frames: {}", run.mask_hashes.join(" ")))?;
                runs.push(run);
                pictures.extend(drawn);
            }
        }
        mark_front(&mut runs);
        Ok(Compared { truth: report, convergence, runs, picture, pictures })
    }

    fn truths(&self, name: &str, terrain: &Terrain<'_>, camera: &Camera, to: &Hearing<'_>) -> Result<Truths> {
        let level = match self.truth_level {
            Some(level) => level,
            None => terrain.level_for(camera).ok_or_else(|| nothing_in_view(name))?.max(LEAST_TRUTH_LEVEL),
        };
        // Truth, those of all coarser levels, and that of the next eye.
        let truths = f64::from(level.subdivisions().ilog2() + 2);
        let done = Cell::new(0.0);
        let truth_at = |camera: &Camera, level: Level| {
            (to.stage)(&format!("{name}: truth at level {}", level.subdivisions()), TRUTH_SHARE * done.get() / truths);
            done.set(done.get() + 1.0);
            let Kept { truth, ms } = self.cache.truth(terrain, camera, level, to.warn);
            Kept { truth: if self.border == Border::On { truth } else { truth.without_border() }, ms }
        };
        let Kept { truth, ms } = truth_at(camera, level);
        let Some(judge) = Judge::new(&truth) else { return Err(no_line(name)) };
        let coarser: Vec<Truth> = (0..level.subdivisions().ilog2())
            .filter_map(|k| Level::new(1 << k))
            .map(|level| truth_at(camera, level).truth)
            .collect();
        // Half the level; level 1 has none below it and stands for itself.
        let half = coarser.last().unwrap_or(&truth);
        let own = Mask::of_truth(half);
        let agreement = judge.measure(&own).scores().agreement();
        let own_offsets = judge.offsets_of(half);
        let mask = Mask::of_truth(&truth);
        let next = Mask::of_truth(&truth_at(&moved(camera, 1), level).truth);
        let report = TruthReport {
            level: level.subdivisions(),
            length_px: truth.length(),
            border_px: truth.length() - truth.clone().without_border().length(),
            fragments: mask.fragments(FRAGMENT),
            facets: truth.facets,
            rays: truth.rays,
            truth_ms: ms,
            self_precision: agreement.precision,
            self_recall: agreement.recall,
            self_f: agreement.f(),
            self_offset_px: own_offsets.map(|offsets| offsets.median),
        };
        let convergence = convergence(&judge, &coarser, own_offsets);
        Ok(Truths { report, convergence, pop: mask.pop(&next), truth })
    }
}

/// A method at a level, seen by a camera.
struct Trial<'a> {
    gpu: &'a Gpu,
    surface: &'a Surface,
    plan: Plan,
    camera: &'a Camera,
}

impl Trial<'_> {
    /// Draws, measures and times it.
    fn run(
        &self,
        scene: &str,
        method: &'static str,
        stem: &str,
        repeat: usize,
        judge: &Judge<'_>,
        truth_pop: f64,
    ) -> Result<(Run, [Picture; 2])> {
        let Self { gpu, surface, plan, camera } = *self;
        let size = [camera.width, camera.height];
        memory::reset_peak();
        let start = std::time::Instant::now();
        let renderer = Renderer::new(gpu, surface, plan, size)?;
        let setup_ms = start.elapsed().as_secs_f64() * 1e3;
        let first_frame_ms = renderer.time_of_frame(camera)?;
        let frame = renderer.read()?;
        let mut masks = Vec::new();
        let mut times = Vec::new();
        let mut hashes = Vec::new();
        for step in 1..=repeat as u32 {
            times.push(renderer.time_of_frame(&moved(camera, step))?);
            let raster = renderer.read()?.raster;
            hashes.push(hash(&raster));
            masks.extend((step == 1).then(|| mask_of(&raster, renderer.near())));
        }
        let passes = renderer.timed_frame(&moved(camera, repeat as u32 + 1))?.passes;
        let peak_mib = memory::peak().map(mebibytes);
        let mask = mask_of(&frame.raster, renderer.near());
        let measured = judge.measure(&mask);
        let scores = measured.scores();
        let chains = trace(&frame.raster);
        let short = chains.iter().filter(|chain| chain.points.len() < FRAGMENT).count();
        let pictures = [
            mask_picture(mask_name(stem), &frame.raster)?,
            difference_picture(difference_name(stem), &mask, &measured)?,
        ];
        times.sort_by(f64::total_cmp);
        let agreement = scores.agreement();
        let run = Run {
            scene: scene.to_owned(),
            method,
            level: plan.level.subdivisions(),
            width: camera.width,
            height: camera.height,
            precision: agreement.precision,
            recall: agreement.recall,
            f: agreement.f(),
            gaps: scores.gaps,
            spurious: scores.spurious,
            chamfer_px: scores.chamfer,
            h95_px: scores.h95,
            fragments: scores.fragments,
            chains: chains.len(),
            short_chains: short as f64 / chains.len().max(1) as f64,
            excess_pop: masks.first().map_or(0.0, |next| mask.pop(next) - truth_pop),
            at: DISTANCES
                .into_iter()
                .zip(scores.at)
                .map(|(px, at)| AtDistance { px, precision: at.precision, recall: at.recall, f: at.f() })
                .collect(),
            bands: BANDS
                .into_iter()
                .zip(scores.bands)
                .map(|(name, band)| Band {
                    name,
                    to_m: band.to.is_finite().then_some(band.to),
                    truth_px: band.length,
                    inked: band.inked,
                    precision: band.agreement.precision,
                    recall: band.agreement.recall,
                    f: band.agreement.f(),
                })
                .collect(),
            place: (plan.method == Method::Walk).then(|| place(judge, &frame)).flatten(),
            facets: renderer.facets(),
            inked: mask.inked.len(),
            frame_ms: median(&times),
            frame_range_ms: [times[0], times[times.len() - 1]],
            first_frame_ms,
            setup_ms,
            passes,
            peak_mib,
            buffers_bytes: renderer.buffers().bytes(),
            pareto: false,
            mask_hashes: hashes,
            mask: pictures[0].name.clone(),
            difference: pictures[1].name.clone(),
        };
        Ok((run, pictures))
    }
}

fn stem(scene: &str, method: &str, level: Level) -> String {
    format!("{scene}_{method}_{}", level.subdivisions())
}

fn mask_name(stem: &str) -> String {
    format!("{stem}_mask.png")
}

fn difference_name(stem: &str) -> String {
    format!("{stem}_difference.png")
}

fn truth_name(scene: &str) -> String {
    format!("{scene}_truth.png")
}

/// The eye so many metres on, along the view axis.
fn moved(camera: &Camera, metres: u32) -> Camera {
    let [_, _, forward] = camera.axes();
    Camera { eye: camera.eye + forward * f64::from(metres), ..*camera }
}

/// The ink of a frame.
fn mask_of(raster: &InkRaster, near: f64) -> Mask {
    let pixels = (0..).zip(&raster.pixels).filter(|(_, pixel)| pixel.is_ink());
    let inked = |(i, pixel): (u32, &crate::ink::Pixel)| Inked {
        column: i % raster.width,
        row: i / raster.width,
        distance: pixel.distance(near),
    };
    Mask { size: [raster.width, raster.height], inked: pixels.map(inked).collect() }
}

/// Of the mask alone: which pixels are ink.
fn hash(raster: &InkRaster) -> String {
    let ink: Vec<u8> = raster.pixels.iter().map(|pixel| u8::from(pixel.is_ink())).collect();
    format!("{:016x}", xxh3_64(&ink))
}

/// Distances from truth of the places where the walk saw facing flip; border lines have none.
fn place(judge: &Judge<'_>, frame: &Frame) -> Option<Place> {
    let raster = &frame.raster;
    let pixels = (0..).zip(&raster.pixels).filter(|(_, pixel)| pixel.kind() == crate::ink::Kind::Silhouette);
    let place = |(i, pixel): (u32, &crate::ink::Pixel)| {
        DVec2::new(f64::from(i % raster.width), f64::from(i / raster.width)) + 0.5 + pixel.place()
    };
    let places: Vec<DVec2> = pixels.map(place).collect();
    judge.offsets(&places).map(|offsets| Place { mean_px: offsets.mean, p95_px: offsets.p95 })
}

/// Distances of coarser truths, and the straight line through their medians in the logarithms of both.
fn convergence(judge: &Judge<'_>, coarser: &[Truth], own: Option<Offsets>) -> Option<Convergence> {
    let own = own?.median;
    let offset = |truth: &Truth| {
        let Offsets { mean, median, p95 } = judge.offsets_of(truth)?;
        Some(LevelOffset { level: truth.level.subdivisions(), median_px: median, mean_px: mean, p95_px: p95 })
    };
    let levels: Vec<LevelOffset> = coarser.iter().filter_map(offset).collect();
    let fitted: Vec<&LevelOffset> = levels.iter().filter(|l| l.median_px > ABOVE_OWN_ERROR * own).collect();
    let points: Vec<DVec2> = fitted.iter().map(|l| DVec2::new(f64::from(l.level).log2(), l.median_px.log2())).collect();
    Some(Convergence { fitted_levels: fitted.iter().map(|l| l.level).collect(), slope: slope(&points), levels })
}

/// Of sorted times.
fn median(times: &[f64]) -> f64 {
    (times[(times.len() - 1) / 2] + times[times.len() / 2]) / 2.0
}

/// Least squares; `None` with fewer than two points.
fn slope(points: &[DVec2]) -> Option<f64> {
    let middle = points.iter().sum::<DVec2>() / points.len() as f64;
    let sums = points.iter().map(|p| *p - middle).map(|d| DVec2::new(d.x * d.y, d.x * d.x)).sum::<DVec2>();
    (points.len() >= 2).then(|| sums.x / sums.y)
}

/// Marks the runs that no other of the scene beats in both time and F.
fn mark_front(runs: &mut [Run]) {
    let points: Vec<[f64; 2]> = runs.iter().map(|run| [run.frame_ms, 1.0 - run.f]).collect();
    for (run, p) in runs.iter_mut().zip(&points) {
        run.pareto = !points.iter().any(|q| q[0] <= p[0] && q[1] <= p[1] && q != p);
    }
}

/// A run in a line: every figure beside its time and what was computed.
fn line(run: &Run) -> String {
    let Run { scene, method, level, precision, recall, f, gaps, spurious, .. } = run;
    let Run { frame_ms, first_frame_ms, facets, inked, .. } = run;
    format!(
        "{scene} {method} level {level}: P {precision:.4} R {recall:.4} F {f:.4}, {gaps} gaps, {spurious} spurious; \
         {frame_ms:.1} ms (first frame {first_frame_ms:.1}), {facets} facets, {inked} px of ink"
    )
}

fn truth_line(name: &str, truth: &TruthReport) -> String {
    let TruthReport { level, length_px, border_px, self_f, facets, rays, truth_ms, .. } = truth;
    format!(
        "{name} truth at level {level}: {length_px:.0} px of line ({border_px:.0} of border), F of half the level \
         {self_f:.4}; {facets} facets, {rays} rays, {:.2} s",
        truth_ms / 1e3
    )
}

fn mebibytes(bytes: u64) -> f64 {
    bytes as f64 / f64::from(1 << 20)
}

fn nothing_in_view(name: &str) -> Error {
    Error::Scene {
        what: format!("{name}: nothing of the DEM is in view"),
        remedy: "turn the view towards it with --look-at, or --azimuth and --altitude".into(),
    }
}

fn no_line(name: &str) -> Error {
    Error::Scene {
        what: format!("{name}: no silhouette is in view, so there is nothing to compare"),
        remedy: "choose a view of hills against hills or sky".into(),
    }
}
