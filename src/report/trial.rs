//! One method at one level: drawn, timed over frames whose eye moves on, measured against truth.
//!
//! Each warm frame moves the eye 1 m along the view axis, so that nothing of an earlier frame can be used again. The first
//! frame, of the eye that was asked for, is the one that is judged.

use std::sync::Arc;
use std::time::Instant;

use glam::DVec2;
use xxhash_rust::xxh3::xxh3_64;

use super::floors::{self, Floors};
use super::memory;
use super::pictures::{Picture, difference_picture, mask_picture};
use super::results::{AtDistance, Band, DrawnLevel, PassFigures, Place, Run};
use crate::error::Result;
use crate::gpu::Gpu;
use crate::ink::{InkRaster, Kind, Marks, Pixel, trace};
use crate::plan::cost::PassCost;
use crate::plan::{Method, Plan};
use crate::render::{Drawn, Floor, PassTime, Renderer};
use crate::surface::Surface;
use crate::truth::metrics::{BandScore, DISTANCES, FRAGMENT, Judge, Scores};
use crate::truth::{Inked, Mask};
use crate::view::Camera;

/// Names of the bands of depth.
const BANDS: [&str; 3] = ["near", "middle", "far"];

/// A method at a level, seen by a camera.
pub(super) struct Trial<'a> {
    pub gpu: &'a Arc<Gpu>,
    pub surface: &'a Arc<Surface>,
    pub camera: &'a Camera,
    pub plan: Plan,
    /// Name of the scene.
    pub scene: &'a str,
    /// Name of the method.
    pub method: &'static str,
    /// Warm frames.
    pub repeat: u32,
    /// Whether a bare copy and a depth draw are timed in turn with them.
    pub floor: bool,
    pub judge: &'a Judge<'a>,
    /// Share of truth, drawn one pixel wide, that pops when the eye moves on.
    pub truth_pop: f64,
}

/// Frames and what they took.
struct Timed {
    /// The one that is judged.
    first: Drawn,
    /// The mask of the next eye.
    next: Mask,
    setup_ms: f64,
    first_frame_ms: f64,
    /// Of the warm frames, sorted.
    times: Vec<f64>,
    mask_hashes: Vec<String>,
    passes: Vec<PassFigures>,
    floors: Option<Floors>,
    peak_mib: Option<f64>,
    facets: u64,
    buffers_bytes: u64,
    /// Metres to the near plane.
    near: f64,
}

impl Trial<'_> {
    /// Draws, times and measures.
    pub fn run(&self) -> Result<(Run, [Picture; 2])> {
        let timed = self.time()?;
        let mask = mask_of(&timed.first.raster, timed.near);
        let measured = self.judge.measure(&mask);
        let names = picture_names(self.scene, self.method, self.plan.detail.into());
        let [mask_name, difference_name] = names.clone();
        let pictures =
            [mask_picture(mask_name, &timed.first.raster)?, difference_picture(difference_name, &mask, &measured)?];
        Ok((self.result(timed, &mask, &measured.scores(), names), pictures))
    }

    fn time(&self) -> Result<Timed> {
        memory::reset_peak();
        let start = Instant::now();
        let mut renderer = Renderer::new(self.gpu.clone(), self.surface.clone())?;
        renderer.prepare(&self.plan, self.camera)?;
        let setup_ms = start.elapsed().as_secs_f64() * 1e3;
        let first_frame_ms = renderer.time_of_frame(&self.plan, self.camera)?;
        let first = renderer.read()?;
        let one_more = moved(self.camera, self.repeat + 1);
        let passes = renderer.timed_frame(&self.plan, &one_more)?.passes;
        let costs = renderer.costs(&renderer.read()?)?;
        let bytes = costs.iter().map(|pass| pass.bytes).sum();
        let page = [self.camera.width, self.camera.height];
        let mut floor = self.floor.then(|| Floor::new(self.gpu.clone(), page, bytes)).transpose()?;
        let mut floors = self.floor.then(|| Floors::new(bytes));
        let (mut times, mut mask_hashes, mut next) = (Vec::new(), Vec::new(), None);
        for step in 1..=self.repeat {
            let camera = moved(self.camera, step);
            times.push(renderer.time_of_frame(&self.plan, &camera)?);
            let raster = renderer.read()?.raster;
            mask_hashes.push(hash(&raster));
            next.get_or_insert_with(|| mask_of(&raster, renderer.near()));
            if let (Some(floors), Some(floor)) = (&mut floors, &mut floor) {
                floors.add(floor, &renderer)?;
            }
        }
        times.sort_by(f64::total_cmp);
        Ok(Timed {
            next: next.unwrap_or_else(|| mask_of(&first.raster, renderer.near())),
            first,
            setup_ms,
            first_frame_ms,
            times,
            mask_hashes,
            passes: passes.into_iter().map(|pass| figures(pass, &costs)).collect(),
            floors,
            peak_mib: memory::peak().map(|bytes| bytes as f64 / f64::from(1 << 20)),
            facets: renderer.last().map_or(0, |frame| frame.facets(self.surface)),
            buffers_bytes: renderer.on_device().bytes(),
            near: renderer.near(),
        })
    }

    fn result(&self, timed: Timed, mask: &Mask, scores: &Scores, [mask_name, difference]: [String; 2]) -> Run {
        let agreement = scores.agreement();
        let chains = trace(&Marks::from(&timed.first.raster));
        let short = chains.iter().filter(|chain| chain.points.len() < FRAGMENT).count();
        let walks = self.plan.method == Method::Walk;
        let frame_ms = median(&timed.times);
        Run {
            scene: self.scene.to_owned(),
            method: self.method,
            level: self.plan.detail.into(),
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
            chains: chains.len(),
            short_chains: short as f64 / chains.len().max(1) as f64,
            excess_pop: mask.pop(&timed.next) - self.truth_pop,
            at: at_distances(scores),
            bands: bands(scores),
            place: if walks { place(self.judge, &timed.first.raster) } else { None },
            facets: timed.facets,
            inked: mask.inked.len(),
            frame_ms,
            frame_range_ms: [timed.times[0], timed.times[timed.times.len() - 1]],
            first_frame_ms: timed.first_frame_ms,
            setup_ms: timed.setup_ms,
            passes: timed.passes,
            floor: timed.floors.map(|floors| floors.beside(frame_ms)),
            peak_mib: timed.peak_mib,
            buffers_bytes: timed.buffers_bytes,
            pareto: false,
            mask_hashes: timed.mask_hashes,
            mask: mask_name,
            difference,
        }
    }
}

/// A run in a line: every figure beside its time and what was computed.
pub(super) fn line(run: &Run) -> String {
    let Run { scene, method, level, precision, recall, f, gaps, spurious, .. } = run;
    let Run { frame_ms, first_frame_ms, facets, inked, floor, .. } = run;
    let floor = floor.as_ref().map_or(String::new(), |floor| format!("; {}", floors::words(floor, *frame_ms)));
    format!(
        "{scene} {method} level {level}: P {precision:.4} R {recall:.4} F {f:.4}, {gaps} gaps, {spurious} spurious; \
         {frame_ms:.1} ms (first frame {first_frame_ms:.1}), {facets} facets, {inked} px of ink{floor}"
    )
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

/// A pass's time beside what it cost.
fn figures(PassTime { name, ms }: PassTime, costs: &[PassCost]) -> PassFigures {
    let cost = costs.iter().find(|cost| cost.name == name);
    let (bytes, operations) = cost.map_or((0, 0), |cost| (cost.bytes, cost.operations));
    PassFigures { name, ms, bytes, operations }
}

fn at_distances(scores: &Scores) -> Vec<AtDistance> {
    let figures = DISTANCES.into_iter().zip(scores.at);
    figures.map(|(px, at)| AtDistance { px, precision: at.precision, recall: at.recall, f: at.f() }).collect()
}

fn bands(scores: &Scores) -> Vec<Band> {
    let band = |(name, band): (&'static str, BandScore)| Band {
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

/// The ink of a frame.
fn mask_of(raster: &InkRaster, near: f64) -> Mask {
    let inked = |([column, row], pixel): ([u32; 2], &Pixel)| Inked { column, row, distance: pixel.distance(near) };
    let inked = pixels(raster).filter(|(_, pixel)| pixel.is_ink()).map(inked).collect();
    Mask { size: [raster.width, raster.height], inked }
}

/// Distances from truth of the places where the walk saw facing flip; border lines have none.
fn place(judge: &Judge<'_>, raster: &InkRaster) -> Option<Place> {
    let silhouette = pixels(raster).filter(|(_, pixel)| pixel.kind() == Kind::Silhouette);
    let place = |([column, row], pixel): ([u32; 2], &Pixel)| {
        DVec2::new(f64::from(column), f64::from(row)) + 0.5 + pixel.place()
    };
    let places: Vec<DVec2> = silhouette.map(place).collect();
    judge.offsets(&places).map(|offsets| Place { mean_px: offsets.mean, p95_px: offsets.p95 })
}

/// Pixels with their column and row.
fn pixels(raster: &InkRaster) -> impl Iterator<Item = ([u32; 2], &Pixel)> {
    (0..).zip(&raster.pixels).map(|(i, pixel): (u32, _)| ([i % raster.width, i / raster.width], pixel))
}

/// Of the mask alone: which pixels are ink.
fn hash(raster: &InkRaster) -> String {
    let ink: Vec<u8> = raster.pixels.iter().map(|pixel| u8::from(pixel.is_ink())).collect();
    format!("{:016x}", xxh3_64(&ink))
}

/// Of sorted times.
pub(super) fn median(times: &[f64]) -> f64 {
    (times[(times.len() - 1) / 2] + times[times.len() / 2]) / 2.0
}
