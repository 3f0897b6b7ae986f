//! A case is run: each view by each method, every promise measured.
//!
//! Cost: truth of each view and of the next eye; for each method five frames and, where every bit or nearly all ink is to stay, five
//! more of the land elsewhere; in flights two truths and two frames more, and two renderers.

use std::sync::Arc;
use std::time::Instant;

use super::accuracy::Accuracy;
use super::case::Case;
use super::conditioning::{Change, stepped};
use super::drawing::{Drawer, Drawing, plan};
use super::exceptions::exception;
use super::figures::{CaseFigures, Outcome, RunFigures, Seen};
use super::finite::Counted;
use super::flight;
use super::folded::unfolded;
use super::illustrated::{bits, illustrated, land_of, pixels};
use super::invariance::{Difference, Moved, alone, differing, mirrored, same_bits, turned};
use super::limits;
use super::promise::{Check, Promise, without_ink};
use super::sight::Sight;
use super::watertight::{RAY_PX, facets, pinholes};
use crate::error::{Error, Result};
use crate::gpu::Gpu;
use crate::line::Land;
use crate::measure::figures::DrawnLevel;
use crate::plan::{Method, Plan};
use crate::render::Renderer;
use crate::surface::{Level, Surface};
use crate::truth::{Mask, Terrain};
use crate::view::Camera;

/// Truth is no coarser, unless the case says so.
const LEAST_TRUTH: u32 = 8;
/// Whose promises are no method's own.
const ALL: &str = "all";

/// Land elsewhere, ready to draw.
struct Elsewhere {
    moved: Moved,
    drawer: Drawer,
}

/// A case that is being run.
struct Run<'a> {
    case: &'a Case,
    drawer: Drawer,
    land: Arc<Land>,
    elsewhere: Vec<Elsewhere>,
    turned: Vec<Elsewhere>,
    outcome: Outcome,
}

/// Runs a case; `stage` hears of what is done. What cannot be drawn is a broken promise.
///
/// # Errors
/// [`Error::DeviceLost`] and [`Error::Ended`]: what comes after would fail too.
pub(crate) fn run(gpu: &Arc<Gpu>, case: &Case, stage: &dyn Fn(&str)) -> Result<Outcome> {
    let start = Instant::now();
    let surface = Arc::new(case.surface(&case.dem)?);
    let elsewhere = |promise, moves: Vec<Moved>| {
        let moves = moves.into_iter().filter(|_| case.promises.contains(&promise));
        let ready = |moved: Moved| {
            let drawer = Drawer::new(gpu, &Arc::new(case.surface(&moved.dem)?))?;
            Ok(Elsewhere { moved, drawer })
        };
        moves.map(ready).collect::<Result<Vec<_>>>()
    };
    let mut run = Run {
        case,
        drawer: Drawer::new(gpu, &surface)?,
        land: Arc::new(land_of(&surface)?),
        elsewhere: elsewhere(Promise::SameBits, same_bits(&case.dem).into())?,
        turned: elsewhere(Promise::Turned, turned(&case.dem).into())?,
        outcome: Outcome::default(),
    };
    let terrain = Terrain::new(&surface);
    let mut views = Vec::new();
    for (k, view) in case.views.iter().enumerate() {
        stage(&format!("{}, {}: truth", case.name, view.name));
        let level = truth_level(case, &terrain, &view.camera);
        let begun = Instant::now();
        let truth = terrain.truth(&view.camera, level);
        let truth_ms = begun.elapsed().as_secs_f64() * 1e3;
        let metres = distance(case, &view.camera);
        let camera = stepped(&view.camera, metres);
        let next = terrain.truth(&camera, level);
        let truth_popped = Change::of(&Mask::of_truth(&truth), &Mask::of_truth(&next), &camera).popped;
        let of_flights = |promise: &Promise| matches!(promise, Promise::Alone | Promise::Steady);
        let flies = k == 0 && case.promises.iter().any(of_flights);
        let cameras = flies.then(|| flight::cameras(&view.camera, metres)).into_iter().flatten();
        let flight = cameras.map(|camera| (camera, Mask::of_truth(&terrain.truth(&camera, level)))).collect();
        let (worst, seen) = Default::default();
        let mut sight = Sight { view, truth, stepped: (camera, next), truth_popped, flight, worst, seen };
        run.see(&mut sight, stage)?;
        views.push(sight.figures(case, truth_ms));
    }
    let mut outcome = run.outcome;
    outcome.cases.push(CaseFigures {
        name: case.name,
        group: case.group.name(),
        about: case.about,
        columns: case.dem.columns(),
        rows: case.dem.rows(),
        cell_m: case.dem.cell().to_array(),
        promises: case.promises.clone(),
        views,
        seconds: start.elapsed().as_secs_f64(),
    });
    Ok(outcome)
}

/// That of no visible edge longer than a pixel, as far as the case allows.
fn truth_level(case: &Case, terrain: &Terrain<'_>, camera: &Camera) -> Level {
    let fine = terrain.level_for(camera).unwrap_or_default().subdivisions().max(LEAST_TRUTH);
    Level::new(fine.min(case.truth.subdivisions())).unwrap_or(case.truth)
}

/// Metres from the eye to the middle of the land.
fn distance(case: &Case, camera: &Camera) -> f64 {
    let middle = case.dem.position(case.dem.columns() / 2, case.dem.rows() / 2);
    middle.distance(camera.eye).max(case.dem.cell().min_element())
}

impl Run<'_> {
    /// All methods in a view. What cannot be drawn is a broken promise and ends the view.
    fn see(&mut self, sight: &mut Sight<'_>, stage: &dyn Fn(&str)) -> Result<()> {
        let found = self.frame(sight).and_then(|()| self.alone(sight)).and_then(|()| {
            Method::ALL.into_iter().try_for_each(|method| {
                stage(&format!("{}, {}: {}", self.case.name, sight.view.name, method.entry().name));
                self.method(sight, method)
            })
        });
        let (failed, of) = match found {
            Ok(()) => (0.0, "no frame failed".to_owned()),
            Err(error @ (Error::DeviceLost { .. } | Error::Ended { .. })) => return Err(error),
            Err(error) => (1.0, error.to_string()),
        };
        self.check(sight, ALL, Promise::Drawn, failed, of);
        Ok(())
    }

    /// What is promised of a frame whatever the method: finite numbers, in silhouettes, creases and hachures; no pinhole.
    fn frame(&mut self, sight: &mut Sight<'_>) -> Result<()> {
        let camera = &sight.view.camera;
        let renderer = self.drawer.renderer();
        let (page, drawing) = illustrated(renderer, &self.land, self.case.detail, camera)?;
        let mut counted = Counted::default();
        counted.buffers(renderer)?;
        counted.chains(&page.chains);
        counted.chains(&page.land);
        counted.strokes(&drawing);
        let depths: Vec<u32> = pixels(renderer, camera)?.into_iter().map(|[_, depth]| depth).collect();
        let mesh = facets(renderer.surface(), &page.frame.lattice);
        let (holes, tried) = pinholes(&mesh, camera, renderer.near(), &depths, RAY_PX);
        sight.seen.land = depths.iter().map(|depth| *depth != 0).collect();
        sight.mark(ALL, Promise::Watertight, &holes);
        self.check(sight, ALL, Promise::Finite, counted.bad as f64, counted.words());
        let of = format!("{} of {tried} uncovered pixels", holes.len());
        self.check(sight, ALL, Promise::Watertight, holes.len() as f64, of);
        let (folds, of) = unfolded(Surface::new(self.case.dem.clone()), &page.frame.lattice)?;
        self.check(sight, ALL, Promise::Unfolded, folds as f64, of);
        Ok(())
    }

    /// Frames of a flight, each as the next in a row and as the first of a new renderer, over land whose lines are found anew.
    fn alone(&mut self, sight: &Sight<'_>) -> Result<()> {
        let (renderer, detail) = (self.drawer.renderer(), self.case.detail);
        let (gpu, surface) = (renderer.gpu().clone(), renderer.surface().clone());
        let mut differ = Vec::new();
        for (camera, _) in &sight.flight {
            let flown = bits(renderer, &self.land, detail, camera)?;
            let mut alone = Renderer::new(gpu.clone(), surface.clone())?;
            let land = Arc::new(land_of(&surface)?);
            differ.push((differing(&flown, &bits(&mut alone, &land, detail, camera)?), flown.len()));
        }
        if let Some((most, of)) = differ.into_iter().max() {
            self.check(sight, ALL, Promise::Alone, most as f64, format!("words that differ of {of}"));
        }
        Ok(())
    }

    /// What pops of a method's ink in a flight whose first mask is `here`.
    fn steady(&mut self, sight: &mut Sight<'_>, name: &'static str, plan: &Plan, here: &Mask) -> Result<()> {
        if sight.flight.is_empty() || !Promise::Steady.is_of(name) {
            return Ok(());
        }
        let first = Mask::of_truth(&sight.truth);
        let (mut masks, mut truths) = (Vec::new(), vec![&first]);
        for (camera, truth) in &sight.flight {
            masks.push(self.drawer.draw(plan, camera)?.mask);
            truths.push(truth);
        }
        let masks: Vec<&Mask> = std::iter::once(here).chain(&masks).collect();
        let gone: Vec<_> = masks.windows(2).flat_map(|pair| alone(pair[0], pair[1])).collect();
        let [popped, truths] = [masks, truths].map(|masks| flight::popped(&masks));
        let of =
            format!("{:.3} % of {} pixels of ink, truth {:.3} %", 100.0 * popped, here.inked.len(), 100.0 * truths);
        sight.mark(name, Promise::Steady, &gone);
        self.check(sight, name, Promise::Steady, (popped - truths).max(0.0), of);
        Ok(())
    }

    fn method(&mut self, sight: &mut Sight<'_>, method: Method) -> Result<()> {
        let (name, plan, camera) = (method.entry().name, plan(self.case.detail, method), sight.view.camera);
        let first = self.outcome.checks.len();
        let drawing = self.drawer.draw(&plan, &camera)?;
        let frame_ms = self.drawer.time(&plan, &camera)?;
        let facets = self.drawer.facets();
        let accuracy = Accuracy::of(&drawing.mask, &sight.truth);
        self.accurate(sight, method, &accuracy, &drawing.mask);
        let after = self.drawer.draw(&plan, &sight.stepped.0)?;
        let change = Change::of(&drawing.mask, &after.mask, &camera);
        sight.mark(name, Promise::Conditioned, &change.places);
        let inked = drawing.mask.inked.len();
        let excess = ((change.popped - sight.truth_popped) * inked as f64).max(0.0);
        let of = format!(
            "pixels that pop of {inked}, amplification {:.1}, truth's {:.4} %",
            change.amplification,
            100.0 * sight.truth_popped
        );
        let limit = limits::whole(limits::POPPED, inked);
        self.check_within(sight, name, Promise::Conditioned, limit, excess, of);
        self.steady(sight, name, &plan, &drawing.mask)?;
        self.same_bits(sight, name, &plan, &drawing)?;
        let turned = self.turned(sight, name, &plan, &drawing.mask)?;
        if self.case.promises.contains(&Promise::Accurate) {
            without_ink(&mut self.outcome.checks[first..], drawing.mask.inked.len(), sight.truth.length());
        }
        let scores = accuracy.scores.as_ref();
        let agreement = scores.map(|scores| scores.agreement());
        self.outcome.runs.push(RunFigures {
            case: self.case.name,
            group: self.case.group.name(),
            view: sight.view.name,
            method: name,
            level: DrawnLevel::from(self.case.detail),
            truth_px: sight.truth.length(),
            precision: agreement.map(|agreement| agreement.precision),
            recall: agreement.map(|agreement| agreement.recall),
            f: accuracy.f(),
            gaps: scores.map(|scores| scores.gaps),
            spurious: scores.map(|scores| scores.spurious),
            inked: drawing.mask.inked.len(),
            facets,
            frame_ms,
            popped: change.popped,
            truth_popped: sight.truth_popped,
            amplification: change.amplification,
            turned,
        });
        if method == Method::Walk {
            let Accuracy { astray, missed, .. } = accuracy;
            sight.seen = Seen { land: std::mem::take(&mut sight.seen.land), ink: Some(drawing.mask), astray, missed };
        }
        Ok(())
    }

    fn accurate(&mut self, sight: &mut Sight<'_>, method: Method, accuracy: &Accuracy, mask: &Mask) {
        if !matches!(method, Method::Walk | Method::Contour) {
            return;
        }
        let (name, length) = (method.entry().name, sight.truth.length());
        sight.mark(name, Promise::Accurate, &[&accuracy.astray[..], &accuracy.missed].concat());
        let inked = mask.inked.len();
        if let Some(f) = accuracy.f().filter(|_| length >= limits::LEAST_TRUTH_PX) {
            let of = format!(
                "{inked} pixels of ink, {length:.0} px of truth, {} astray, {} missed",
                accuracy.astray.len(),
                accuracy.missed.len()
            );
            self.check(sight, name, Promise::Accurate, f, of);
        }
        let page = f64::from(sight.view.camera.width) * f64::from(sight.view.camera.height);
        let of = format!("{} of {inked} pixels of ink", accuracy.astray.len());
        self.check(sight, name, Promise::NoFlood, accuracy.astray.len() as f64 / page, of);
    }

    fn same_bits(&mut self, sight: &Sight<'_>, name: &'static str, plan: &Plan, here: &Drawing) -> Result<()> {
        let mut counts = Vec::new();
        for Elsewhere { moved, drawer } in &mut self.elsewhere {
            let there = drawer.draw(plan, &(moved.camera)(&self.case.dem, &sight.view.camera))?;
            counts.push((moved.how, differing(&here.words, &there.words)));
        }
        if let Some(most) = counts.iter().map(|(_, count)| *count).max() {
            let of = counts.iter().map(|(how, count)| format!("{how}: {count}")).collect::<Vec<_>>().join(", ");
            self.check(
                sight,
                name,
                Promise::SameBits,
                most as f64,
                format!("words that differ of {}; {of}", here.words.len()),
            );
        }
        Ok(())
    }

    fn turned(&mut self, sight: &mut Sight<'_>, name: &'static str, plan: &Plan, here: &Mask) -> Result<Option<f64>> {
        let mut found = Vec::new();
        for Elsewhere { moved, drawer } in &mut self.turned {
            let there = drawer.draw(plan, &(moved.camera)(&self.case.dem, &sight.view.camera))?.mask;
            let there = if moved.mirrors { mirrored(&there) } else { there };
            found.push((moved.how, Difference::of(here, &there)));
        }
        let far: Vec<[u32; 2]> = found.iter().flat_map(|(_, difference)| difference.far.clone()).collect();
        sight.mark(name, Promise::Turned, &far);
        let Some(most) = found.iter().map(|(_, difference)| difference.pixels).max() else { return Ok(None) };
        let words = |(how, d): &(&str, Difference)| {
            format!("{how}: {} of {} pixels, {} over 1 px", d.pixels, d.ink.round(), d.far.len())
        };
        let of = found.iter().map(words).collect::<Vec<_>>().join("; ");
        let limit = limits::whole(limits::TURNED, here.inked.len());
        self.check_within(sight, name, Promise::Turned, limit, most as f64, of.clone());
        let most = found.iter().map(|(_, difference)| difference.far.len()).max().unwrap_or(0);
        self.check(sight, name, Promise::TurnedFar, most as f64, of);
        Ok(found.iter().map(|(_, difference)| difference.share()).reduce(f64::max))
    }

    /// Notes a figure, where the case promises it.
    fn check(&mut self, sight: &Sight<'_>, method: &'static str, promise: Promise, measured: f64, of: String) {
        self.check_within(sight, method, promise, promise.limit().0, measured, of);
    }

    /// The same with a limit that follows from the ink.
    fn check_within(
        &mut self,
        sight: &Sight<'_>,
        method: &'static str,
        promise: Promise,
        limit: f64,
        measured: f64,
        of: String,
    ) {
        if !self.case.promises.contains(&promise) || !promise.is_of(method) {
            return;
        }
        let (case, view) = (self.case.name, sight.view.name);
        let exception = exception(case, view, method, promise);
        let (_, at_least) = promise.limit();
        let limit = exception.map_or(limit, |exception| exception.limit);
        let kept = Check::holds(measured, limit, at_least);
        let exception = exception.map_or("", |exception| exception.reason);
        self.outcome.checks.push(Check { case, view, method, promise, measured, limit, at_least, kept, of, exception });
    }
}
