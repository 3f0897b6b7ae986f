//! One view on one page: every method at every level against truth, and what each costs.
//!
//! Cost: truths of the level, of all coarser ones (how fast they close in) and of the next eye, unless kept; then a
//! renderer, the first frame and the warm frames of each run. Nothing is timed while anything else is computed.
//! Each warm frame moves the eye 1 m along the view axis, so that nothing of an earlier frame can be used again.

use std::cell::Cell;
use std::num::NonZeroU32;
use std::sync::Arc;

use glam::DVec2;

use super::chains::short_of_drawing;
use super::figures::{Convergence, DrawnLevel, LevelOffset, Run, SequenceRun, TruthReport};
use super::rendered::try_plan;
use super::trial::{Trial, moved, picture_names};
use super::truths::KeptTruth;
use crate::cache::Cache;
use crate::error::{Error, Message, Result, Setting};
use crate::gpu::Gpu;
use crate::message;
use crate::plan::{Border, Detail, Method, Plan};
use crate::surface::{Level, Surface};
use crate::truth::metrics::{FRAGMENT, Judge, Measured, Offsets};
use crate::truth::{Mask, Terrain, Truth, TruthLine};
use crate::view::Camera;

/// Truth is no coarser, however far the view.
pub const LEAST_TRUTH_LEVEL: Level = Level::EIGHT;
/// Share of a scene's work that is given to truth on a progress bar.
const TRUTH_SHARE: f64 = 0.5;
/// Coarser truths whose median offset is so many times that of half the level are far enough from truth's own error.
const ABOVE_OWN_ERROR: f64 = 3.0;

/// What is compared in every scene.
#[derive(Debug, Clone)]
pub struct Comparison {
    /// What is compared.
    pub methods: Vec<Method>,
    /// Each method is run at each.
    pub levels: Vec<Detail>,
    /// Warm frames behind a median.
    pub repeat: NonZeroU32,
    /// Whether a bare copy and a hardware depth draw are timed in turn with the warm frames; pixels of the draw show facets
    /// where the device has [`FEATURE`](super::depth_draw::FEATURE).
    pub floor: bool,
    /// Whether border lines are drawn and judged.
    pub border: Border,
    /// Level of truth; `None` for the one at which no visible cell's edge is longer than a pixel.
    pub truth_level: Option<Level>,
    /// Where truths are kept.
    pub cache: Cache,
}

/// Who hears of the work.
pub struct CompareObserver<'a> {
    /// What is being done, and the share of the scene's work that is done, 0 to 1.
    pub stage: &'a dyn Fn(&str, f64),
    /// Something the user should know.
    pub warn: &'a dyn Fn(&Message),
    /// What was found, one thing after the other.
    pub found: &'a dyn Fn(Finding<'_>) -> Result<()>,
}

/// What a comparison finds, told as soon as it is known.
pub enum Finding<'a> {
    /// The truth of a scene of this name, and how coarser levels close in on it.
    Truth(&'a str, &'a TruthReport, Option<&'a Convergence>),
    /// What a method drew at a level, measured.
    Run(&'a Run),
    /// What a method drew at a level over a run of frames, measured.
    Sequence(&'a SequenceRun),
    /// What a picture of this file name shows.
    Picture(&'a str, ShownPicture<'a>),
}

/// What pictures show.
pub enum ShownPicture<'a> {
    /// Truth, drawn one pixel wide.
    Truth(&'a Mask),
    /// The ink of a frame.
    Mask(&'a Mask),
    /// How ink differs from truth.
    Difference(&'a Mask, &'a Measured<'a>),
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
        let runs =
            self.levels.iter().flat_map(|level| self.methods.iter().map(move |method| (method.entry().name, *level)));
        let of_runs = runs.flat_map(|(method, level)| picture_names(scene, method, level.into()));
        of_runs.chain([truth_name(scene)]).collect()
    }

    /// Compares in one scene, whose `name` begins the names of its files; `terrain` is of the same surface.
    ///
    /// # Errors
    /// [`Error::Scene`] where there is nothing to compare; those of [`Renderer`](crate::render::Renderer).
    pub fn scene(
        &self,
        gpu: &Arc<Gpu>,
        surface: &Arc<Surface>,
        name: &str,
        terrain: &Terrain<'_>,
        camera: &Camera,
        to: &CompareObserver<'_>,
    ) -> Result<Compared> {
        let Truths { truth, report, convergence, pop } = self.truths(name, terrain, camera, to)?;
        (to.found)(Finding::Truth(name, &report, convergence.as_ref()))?;
        let Some(judge) = Judge::new(&truth) else { return Err(no_line(name)) };
        let picture = truth_name(name);
        (to.found)(Finding::Picture(&picture, ShownPicture::Truth(&Mask::of_truth(&truth))))?;
        let mut runs = Vec::new();
        for &level in &self.levels {
            for &method in &self.methods {
                let method_name = method.entry().name;
                let done = runs.len() as f64 / (self.levels.len() * self.methods.len()) as f64;
                let words = format!("{name}: {method_name} at level {}", DrawnLevel::from(level));
                (to.stage)(&words, TRUTH_SHARE + (1.0 - TRUTH_SHARE) * done);
                let trial = Trial {
                    camera,
                    scene: name,
                    method: method_name,
                    level: level.into(),
                    repeat: self.repeat,
                    judge: &judge,
                    truth_pop: pop,
                    found: to.found,
                };
                let plan = Plan::new(level, method, self.border);
                let run = try_plan(&trial, gpu, surface, plan, self.floor)?;
                (to.found)(Finding::Run(&run))?;
                runs.push(run);
            }
        }
        mark_front(&mut runs);
        Ok(Compared { truth: report, convergence, runs, picture })
    }

    fn truths(&self, name: &str, terrain: &Terrain<'_>, camera: &Camera, to: &CompareObserver<'_>) -> Result<Truths> {
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
            let KeptTruth { truth, ms } = self.cache.truth(terrain, camera, level, to.warn);
            KeptTruth { truth: if self.border == Border::On { truth } else { truth.without_border() }, ms }
        };
        let KeptTruth { truth, ms } = truth_at(camera, level);
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
            border_px: truth.on_page().filter(|p| p.line == TruthLine::Border).fold(0.0, |sum, p| sum + p.length()),
            fragments: mask.fragments(FRAGMENT),
            short_chains: short_of_drawing(&judge, &mask, camera),
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

fn truth_name(scene: &str) -> String {
    format!("{scene}_truth.png")
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

pub(super) fn nothing_in_view(name: &str) -> Error {
    Error::Scene {
        what: format!("{name}: nothing of the DEM is in view").into(),
        remedy: message![
            "turn the view towards it with ",
            Setting::LookAt,
            ", or ",
            Setting::Azimuth,
            " and ",
            Setting::Altitude
        ],
    }
}

pub(super) fn no_line(name: &str) -> Error {
    Error::Scene {
        what: format!("{name}: no silhouette is in view, so there is nothing to compare").into(),
        remedy: "choose a view of hills against hills or sky".into(),
    }
}
