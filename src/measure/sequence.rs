//! Methods at levels over a run of frames: what of their ink and of their strokes pops from each frame to the next.
//!
//! A frame is drawn by its camera alone, as a still picture in the default style; nothing is kept from one to the next.
//! Masks pop by pixels ([`Mask::pop`], less the same of truth drawn one pixel wide), strokes by darkness ([`popped`](super::popped)),
//! chains by their ids ([`ids_kept`]). Recall stands beside: a blank page never pops.
//!
//! Cost: a truth a frame, all of one level, unless kept: 20 of 640 x 360 px .1 s each of a DEM of 33 000 patches, 2 s of 1.4
//! million; then a frame with its strokes for each method, level and camera, and about as
//! long to judge it.

use std::sync::Arc;
use std::time::Instant;

use super::compare::{CompareObserver, Comparison, Finding, LEAST_TRUTH_LEVEL, no_line, nothing_in_view};
use super::curves::mask_of;
use super::figures::{DrawnLevel, SequenceRun};
use super::kept::{SeenChains, ids_kept};
use super::popped::{Looked, Popped};
use crate::error::Result;
use crate::gpu::Gpu;
use crate::ink::{self, Sheet, Style};
use crate::line::Chain;
use crate::plan::{Border, Curves, Method, Plan};
use crate::render::Renderer;
use crate::surface::{Level, Surface};
use crate::truth::metrics::Judge;
use crate::truth::{Mask, Terrain, Truth};
use crate::view::Camera;

/// Share of the work that is given to truth on a progress bar.
const TRUTH_SHARE: f64 = 0.5;

/// Longest edge of a visible cell of truth, px.
const EDGE_PX: u32 = 4;

/// Cameras one after the other.
#[derive(Debug, Clone, Copy)]
pub struct Sequence<'a> {
    /// What they are called together.
    pub name: &'a str,
    /// Metres from each to the next.
    pub step_m: f64,
    /// At least two.
    pub cameras: &'a [Camera],
}

/// What is known of a sequence whoever draws it.
struct Truths {
    frames: Vec<True>,
    /// Of each frame but the last, what its truth loses towards the next one, and of that what it loses towards this one.
    lost: Vec<[Vec<Option<f64>>; 2]>,
    /// Share of truth, drawn one pixel wide, that pops, mean over the frames.
    pop: f64,
    ms: f64,
}

/// What is known of a frame whoever draws it.
struct True {
    truth: Truth,
    mask: Mask,
    looked: Looked,
}

/// A frame that was drawn.
struct DrawnFrame {
    mask: Mask,
    chains: Vec<Chain>,
    strokes: Looked,
}

/// What is summed up over the frames of a run.
#[derive(Default)]
struct Sums {
    pops: Vec<f64>,
    recalls: Vec<f64>,
    ids_kept: Vec<f64>,
    strokes: Popped,
    inked: usize,
    ms: f64,
}

impl Comparison {
    /// Follows every method at every level over a sequence; `terrain` is of the same surface.
    ///
    /// # Errors
    /// As [`Self::scene`].
    pub fn sequence(
        &self,
        gpu: &Arc<Gpu>,
        surface: &Arc<Surface>,
        terrain: &Terrain<'_>,
        sequence: Sequence<'_>,
        to: &CompareObserver<'_>,
    ) -> Result<Vec<SequenceRun>> {
        let truths = self.truths_of(terrain, sequence, to)?;
        let mut renderer = Renderer::new(gpu.clone(), surface.clone())?;
        let mut runs = Vec::new();
        for &level in &self.levels {
            for &method in &self.methods {
                let share = runs.len() as f64 / (self.levels.len() * self.methods.len()) as f64;
                let words = format!("{}: {} at level {}", sequence.name, method.entry().name, DrawnLevel::from(level));
                (to.stage)(&words, TRUTH_SHARE + (1.0 - TRUTH_SHARE) * share);
                let plan = Plan::new(level, method, self.border);
                let run = sequence.figures(&plan, &truths, &sequence.followed(&mut renderer, &plan, &truths)?);
                (to.found)(Finding::Sequence(&run))?;
                runs.push(run);
            }
        }
        Ok(runs)
    }

    fn truths_of(&self, terrain: &Terrain<'_>, sequence: Sequence<'_>, to: &CompareObserver<'_>) -> Result<Truths> {
        let start = Instant::now();
        let level = match self.truth_level {
            Some(level) => level,
            None => level_of(terrain, sequence)?,
        };
        let count = sequence.cameras.len();
        let of_camera = |(i, camera): (usize, &Camera)| {
            let words = format!("{}: truth {} of {count} at level {}", sequence.name, i + 1, level.subdivisions());
            (to.stage)(&words, TRUTH_SHARE * i as f64 / count as f64);
            let truth = self.cache.truth(terrain, camera, level, to.warn).truth;
            let truth = if self.border == Border::On { truth } else { truth.without_border() };
            True { mask: Mask::of_truth(&truth), looked: Looked::of_truth(camera, &truth), truth }
        };
        let frames: Vec<True> = sequence.cameras.iter().enumerate().map(of_camera).collect();
        if frames.iter().all(|frame| frame.mask.inked.is_empty()) {
            return Err(no_line(sequence.name));
        }
        let lost = frames.windows(2).map(|p| [p[0].looked.lost(&p[1].looked), p[1].looked.lost(&p[0].looked)]);
        let pops: Vec<f64> = frames.windows(2).map(|p| p[0].mask.pop(&p[1].mask)).collect();
        let ms = start.elapsed().as_secs_f64() * 1e3;
        Ok(Truths { lost: lost.collect(), pop: mean(&pops), ms, frames })
    }
}

impl Sequence<'_> {
    /// Draws all frames by a plan and sums up what is found of them.
    fn followed(&self, renderer: &mut Renderer, plan: &Plan, truths: &Truths) -> Result<Sums> {
        let mut sums = Sums::default();
        let mut before: Option<(DrawnFrame, &Camera, &True)> = None;
        for (i, (camera, of)) in self.cameras.iter().zip(&truths.frames).enumerate() {
            let start = Instant::now();
            let drawn = drawn(renderer, plan, camera)?;
            sums.ms += start.elapsed().as_secs_f64() * 1e3;
            sums.inked += drawn.mask.inked.len();
            let recall = |judge: Judge<'_>| judge.measure(&drawn.mask).scores().agreement().recall;
            sums.recalls.extend(Judge::new(&of.truth).map(recall));
            if let Some((last, last_camera, last_of)) = before {
                let [there, back] = &truths.lost[i - 1];
                sums.pops.push(last.mask.pop(&drawn.mask));
                sums.strokes = sums.strokes.and(last.strokes.popped(&drawn.strokes, &last_of.looked, there));
                sums.strokes = sums.strokes.and(drawn.strokes.popped(&last.strokes, &of.looked, back));
                let [here, next] = [(last_camera, &last), (camera, &drawn)]
                    .map(|(camera, drawn)| SeenChains { camera, chains: &drawn.chains });
                sums.ids_kept.extend(ids_kept(here, next));
            }
            before = Some((drawn, camera, of));
        }
        Ok(sums)
    }

    fn figures(&self, plan: &Plan, truths: &Truths, sums: &Sums) -> SequenceRun {
        let frames = self.cameras.len();
        let Popped { darkness, lost, popped } = sums.strokes;
        let of_darkness = |part: f64| if darkness > 0.0 { part / darkness } else { 0.0 };
        let truth = &truths.frames[0].truth;
        SequenceRun {
            scene: self.name.to_owned(),
            method: plan.method.entry().name,
            level: plan.detail.into(),
            width: truth.size[0],
            height: truth.size[1],
            step_m: self.step_m,
            frames,
            truth_level: truth.level.subdivisions(),
            pop: mean(&sums.pops),
            truth_pop: truths.pop,
            excess_pop: mean(&sums.pops) - truths.pop,
            recall: mean(&sums.recalls),
            least_recall: sums.recalls.iter().copied().fold(1.0, f64::min),
            strokes_lost: of_darkness(lost),
            strokes_excess_pop: of_darkness(popped),
            ids_kept: (!sums.ids_kept.is_empty()).then(|| mean(&sums.ids_kept)),
            inked: sums.inked / frames.max(1),
            frame_ms: sums.ms / frames.max(1) as f64,
            truth_ms: truths.ms,
        }
    }
}

/// The least level at which no visible cell's edge is longer than 4 px, nor below that of any truth: a quarter of what a still
/// picture is judged by, in a fraction of its time. What pops is the same to a thousandth of a percent.
fn level_of(terrain: &Terrain<'_>, sequence: Sequence<'_>) -> Result<Level> {
    let finest = sequence.cameras.iter().find_map(|camera| terrain.level_for(camera));
    let finest = finest.ok_or_else(|| nothing_in_view(sequence.name))?;
    Ok(Level::new(finest.subdivisions() / EDGE_PX).unwrap_or(LEAST_TRUTH_LEVEL).max(LEAST_TRUTH_LEVEL))
}

/// Draws a frame as a still picture is drawn, in the default style.
fn drawn(renderer: &mut Renderer, plan: &Plan, camera: &Camera) -> Result<DrawnFrame> {
    let curves = if plan.method == Method::Walk { Curves::On } else { plan.curves };
    let page = renderer.page(&Plan { curves, ..*plan }, camera, |_| ())?;
    let size = [camera.width, camera.height];
    let (style, sheet) = (Style::default(), Sheet::for_frame(size));
    let px_per_mm = sheet.placement(size).px_per_mm;
    let tolerance = style.tolerance * px_per_mm;
    let lines = page.lines(&style.economy(px_per_mm), tolerance);
    let drawing = ink::draw(&lines, &sheet, &style, &[])?;
    let strokes = Looked::of_strokes(camera, &lines, &drawing);
    Ok(DrawnFrame { mask: mask_of(&page.marks, renderer.near()), chains: page.chains, strokes })
}

/// 0 of nothing.
fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}
