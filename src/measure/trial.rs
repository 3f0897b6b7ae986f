//! One method at one level: drawn, timed over frames whose eye moves on, measured against truth.
//!
//! A method yields pixels of ink or curves: what is asked of either is [`Yield`]. Each warm frame moves the eye 1 m along
//! the view axis, so that nothing of an earlier frame can be used again. The first frame, of the eye that was asked for,
//! is the one that is judged.

use std::num::NonZeroU32;

use glam::DVec2;
use xxhash_rust::xxh3::xxh3_64;

use super::compare::{Finding, ShownPicture};
use super::figures::{AtDistance, ChainFigures, DepthBand, DrawnLevel, FloorFigures, PassFigures, PlaceOffsets, Run};
use super::kept::{SeenChains, ids_kept};
use super::{chains, memory};
use crate::error::Result;
use crate::ink::{Sheet, Style};
use crate::line::Chain;
use crate::truth::Mask;
use crate::truth::metrics::{BandScore, DISTANCES, Judge, Scores};
use crate::view::Camera;

/// Names of the bands of depth.
const BANDS: [&str; 3] = ["near", "middle", "far"];

/// A method that draws frames of cameras.
pub trait Draws {
    /// What a frame yields.
    type Yield: Yield;

    /// Draws a frame and says how long it took, ms.
    ///
    /// # Errors
    /// Whatever keeps it from drawing.
    fn time_of_frame(&mut self, camera: &Camera) -> Result<f64>;

    /// What the last frame yielded.
    ///
    /// # Errors
    /// Whatever keeps it from reading.
    fn yielded(&mut self) -> Result<Self::Yield>;

    /// Draws a frame and says how long each of its passes took, and what it moved and computed.
    ///
    /// # Errors
    /// As [`Self::time_of_frame`].
    fn passes(&mut self, camera: &Camera) -> Result<Vec<PassFigures>>;

    /// After a warm frame of a camera, times the limits beside which it stands; by itself there are none.
    ///
    /// # Errors
    /// As [`Self::time_of_frame`].
    fn time_floor(&mut self, _camera: &Camera) -> Result<()> {
        Ok(())
    }

    /// The limits timed so far, beside a median frame.
    fn floor(&mut self, _frame_ms: f64) -> Option<FloorFigures> {
        None
    }

    /// Facets of the last frame.
    fn facets(&self) -> u64;

    /// Bytes of its buffers on the device.
    fn buffers_bytes(&self) -> u64;
}

/// What a method yields of a frame, pixels of ink or curves, as a trial judges it.
pub trait Yield {
    /// The pixels of ink; of curves, those that they pass through.
    fn mask(&self) -> Mask;

    /// The curves; of ink, those that it is traced to.
    fn chains(&self) -> Vec<Chain>;

    /// Where on the page silhouettes run, px, as far as the method knows better than to a pixel.
    fn places(&self) -> Vec<DVec2>;
}

/// A method at a level, seen by a camera.
pub struct Trial<'a> {
    /// What is seen.
    pub camera: &'a Camera,
    /// Name of the scene.
    pub scene: &'a str,
    /// Name of the method.
    pub method: &'static str,
    /// The level of its facets.
    pub level: DrawnLevel,
    /// Warm frames.
    pub repeat: NonZeroU32,
    /// By what it is measured.
    pub judge: &'a Judge<'a>,
    /// Share of truth, drawn one pixel wide, that pops when the eye moves on.
    pub truth_pop: f64,
    /// Who hears of what its pictures show.
    pub found: &'a dyn Fn(Finding<'_>) -> Result<()>,
}

/// Frames and what they took.
struct Timed<Y> {
    /// The one that is judged.
    first: Y,
    /// That of the next eye, where there is a warm frame.
    next: Option<Y>,
    setup_ms: f64,
    first_frame_ms: f64,
    /// Of the warm frames, sorted.
    times: Vec<f64>,
    mask_hashes: Vec<String>,
    passes: Vec<PassFigures>,
    floor: Option<FloorFigures>,
    peak_mib: Option<f64>,
    facets: u64,
    buffers_bytes: u64,
}

impl Trial<'_> {
    /// Draws, times and measures; to make ready took `setup_ms`.
    ///
    /// # Errors
    /// Those of the method, and of who hears of the pictures.
    pub fn run<D: Draws>(&self, method: &mut D, setup_ms: f64) -> Result<Run> {
        let timed = self.time(method, setup_ms)?;
        let mask = timed.first.mask();
        let measured = self.judge.measure(&mask);
        let names = picture_names(self.scene, self.method, self.level);
        (self.found)(Finding::Picture(&names[0], ShownPicture::Mask(&mask)))?;
        (self.found)(Finding::Picture(&names[1], ShownPicture::Difference(&mask, &measured)))?;
        Ok(self.result(timed, &mask, &measured.scores(), names))
    }

    fn time<D: Draws>(&self, method: &mut D, setup_ms: f64) -> Result<Timed<D::Yield>> {
        let first_frame_ms = method.time_of_frame(self.camera)?;
        let first = method.yielded()?;
        let passes = method.passes(&moved(self.camera, self.repeat.get() + 1))?;
        let (mut times, mut mask_hashes, mut next) = (Vec::new(), Vec::new(), None);
        for step in 1..=self.repeat.get() {
            let camera = moved(self.camera, step);
            times.push(method.time_of_frame(&camera)?);
            let yielded = method.yielded()?;
            mask_hashes.push(hash(&yielded.mask()));
            next.get_or_insert(yielded);
            method.time_floor(&camera)?;
        }
        times.sort_by(f64::total_cmp);
        Ok(Timed {
            next,
            first,
            setup_ms,
            first_frame_ms,
            floor: method.floor(median(&times)),
            times,
            mask_hashes,
            passes,
            peak_mib: memory::peak().map(|bytes| bytes as f64 / f64::from(1 << 20)),
            facets: method.facets(),
            buffers_bytes: method.buffers_bytes(),
        })
    }

    fn result(
        &self,
        timed: Timed<impl Yield>,
        mask: &Mask,
        scores: &Scores,
        [mask_name, difference]: [String; 2],
    ) -> Run {
        let agreement = scores.agreement();
        let next = timed.next.as_ref().unwrap_or(&timed.first);
        let offsets = self.judge.offsets(&timed.first.places());
        Run {
            scene: self.scene.to_owned(),
            method: self.method,
            level: self.level,
            width: self.camera.width,
            height: self.camera.height,
            precision: agreement.precision,
            recall: agreement.recall,
            f: agreement.f(),
            gaps: scores.gaps,
            spurious: scores.spurious,
            chamfer_px: scores.chamfer,
            h95_px: scores.h95,
            fragments: scores.fragments,
            pixel_recall: scores.pixel_recall,
            of_chains: self.chains(&timed.first, next),
            excess_pop: mask.pop(&next.mask()) - self.truth_pop,
            at: at_distances(scores),
            bands: bands(scores),
            place: offsets.map(|offsets| PlaceOffsets { mean_px: offsets.mean, p95_px: offsets.p95 }),
            facets: timed.facets,
            inked: mask.inked.len(),
            frame_ms: median(&timed.times),
            frame_range_ms: [timed.times[0], timed.times[timed.times.len() - 1]],
            first_frame_ms: timed.first_frame_ms,
            setup_ms: timed.setup_ms,
            passes: timed.passes,
            floor: timed.floor,
            peak_mib: timed.peak_mib,
            buffers_bytes: timed.buffers_bytes,
            pareto: false,
            mask_hashes: timed.mask_hashes,
            mask: mask_name,
            difference,
        }
    }

    /// The figures of the chains of the first frame.
    fn chains(&self, first: &impl Yield, next: &impl Yield) -> ChainFigures {
        let chains = first.chains();
        // To trace the next frame's ink would take long, and tell nothing: what is traced has no ids.
        let named = chains.iter().any(|chain| chain.id.is_some());
        let next = if named { next.chains() } else { Vec::new() };
        let camera = moved(self.camera, 1);
        let kept = ids_kept(
            SeenChains { camera: self.camera, chains: &chains },
            SeenChains { camera: &camera, chains: &next },
        );
        let frame = [self.camera.width, self.camera.height];
        let px_per_mm = Sheet::for_frame(frame).placement(frame).px_per_mm;
        let economy = named.then(|| Style::default().economy(px_per_mm));
        chains::figures(self.judge, &chains, kept, economy.as_ref())
    }
}

/// File names of a run's mask and of its difference from truth.
pub(super) fn picture_names(scene: &str, method: &str, level: DrawnLevel) -> [String; 2] {
    ["mask", "difference"].map(|kind| format!("{scene}_{method}_{level}_{kind}.png"))
}

/// The eye so many metres on, along the view axis.
pub(super) fn moved(camera: &Camera, metres: u32) -> Camera {
    let [_, _, forward] = camera.axes();
    Camera { eye: camera.eye + forward * f64::from(metres), ..*camera }
}

fn at_distances(scores: &Scores) -> Vec<AtDistance> {
    let figures = DISTANCES.into_iter().zip(scores.at);
    figures.map(|(px, at)| AtDistance { px, precision: at.precision, recall: at.recall, f: at.f() }).collect()
}

fn bands(scores: &Scores) -> Vec<DepthBand> {
    let band = |(name, band): (&'static str, BandScore)| DepthBand {
        name,
        to_m: band.to.is_finite().then_some(band.to),
        truth_px: band.length,
        inked: band.inked,
        precision: band.agreement.precision,
        recall: band.agreement.recall,
        f: band.agreement.f(),
    };
    BANDS.into_iter().zip(scores.bands).map(band).collect()
}

/// Of which pixels are ink.
fn hash(mask: &Mask) -> String {
    let ink: Vec<u8> = mask.pixels().into_iter().map(u8::from).collect();
    format!("{:016x}", xxh3_64(&ink))
}

/// Of sorted times.
pub(super) fn median(times: &[f64]) -> f64 {
    (times[(times.len() - 1) / 2] + times[times.len() / 2]) / 2.0
}
