//! A case is run: each view by each method, every promise measured.
//!
//! Cost: truth of each view and of the next eye; for each method five frames and, where every bit or nearly all ink is to stay, five
//! more of the land elsewhere.

use std::sync::Arc;
use std::time::Instant;

use super::accuracy::{Accuracy, worst};
use super::case::{Case, View};
use super::conditioning::{Change, stepped};
use super::drawing::{Drawer, Drawing, plan};
use super::exceptions::exception;
use super::figures::{CaseFigures, Outcome, RunFigures, Seen, ViewFigures, Worst};
use super::finite::Counted;
use super::invariance::{Difference, Moved, differing, mirrored, same_bits, turned};
use super::limits;
use super::promise::{Check, Promise, without_ink};
use super::watertight::{RAY_PX, facets, pinholes};
use crate::error::{Error, Result};
use crate::gpu::Gpu;
use crate::ink::{self, Sheet, Style};
use crate::line::Land;
use crate::measure::figures::DrawnLevel;
use crate::plan::{Curves, LandLines, Method, Plan};
use crate::relief::{ChannelArea, Relief, Slopes, append};
use crate::surface::{Lattice, Level, Surface};
use crate::truth::{Mask, Terrain, Truth};
use crate::view::Camera;

/// Truth is no coarser, unless the case says so.
const LEAST_TRUTH: u32 = 8;
/// Side of the squares of the page by which places are told apart, px.
const SQUARE: u32 = 24;
/// Places that are marked for each method and promise.
const MARKED: usize = 3;
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

/// A view of it.
struct Sight<'a> {
    view: &'a View,
    truth: Truth,
    /// Camera and truth a step on.
    stepped: (Camera, Truth),
    /// Share of truth, drawn one pixel wide, that pops then.
    truth_popped: f64,
    worst: Vec<Worst>,
    seen: Seen,
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
    for view in &case.views {
        stage(&format!("{}, {}: truth", case.name, view.name));
        let level = truth_level(case, &terrain, &view.camera);
        let begun = Instant::now();
        let truth = terrain.truth(&view.camera, level);
        let truth_ms = begun.elapsed().as_secs_f64() * 1e3;
        let camera = stepped(&view.camera, distance(case, &view.camera));
        let next = terrain.truth(&camera, level);
        let truth_popped = Change::of(&Mask::of_truth(&truth), &Mask::of_truth(&next), &camera).popped;
        let (worst, seen) = Default::default();
        let mut sight = Sight { view, truth, stepped: (camera, next), truth_popped, worst, seen };
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

/// Drainage, ridges and slope lines, as the default style's hachures have them.
fn land_of(surface: &Arc<Surface>) -> Result<Land> {
    let relief = Relief::of(surface.dem(), 1.0)?;
    let mut lines = relief.drainage(ChannelArea::Auto);
    append(&mut lines, relief.ridges()?);
    let slopes = Style::default().hachures.rules().map(|rules| Slopes::new(surface.clone(), 1.0, rules, &lines, None));
    let land = Land::new(surface.dem(), 1.0, lines)?;
    Ok(match slopes.transpose()? {
        Some(slopes) => land.with_slopes(Arc::new(slopes)),
        None => land,
    })
}

/// What folds of a surface with tangents limited: patches, and facets of a lattice; in words what did before.
fn unfolded(surface: Surface, lattice: &Lattice) -> Result<(u64, String)> {
    let before = [surface.folds()?.len() as u64, surface.folding_facets(lattice)?];
    let limited = surface.limited()?;
    let left = [limited.folds()?.len() as u64, limited.folding_facets(lattice)?];
    let words = |[patches, facets]: [u64; 2]| format!("{patches} patches and {facets} facets");
    Ok((left[0] + left[1], format!("{}, without limits {}", words(left), words(before))))
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
        let found = self.frame(sight).and_then(|()| {
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
        let (style, sheet) = (Style::default(), Sheet::for_frame([camera.width, camera.height]));
        let px_per_mm = sheet.placement([camera.width, camera.height]).px_per_mm;
        let (land, hachures) = (LandLines::On, style.hachures(px_per_mm));
        let plan = Plan { curves: Curves::On, land, hachures, ..plan(self.case.detail, Method::Walk) };
        let renderer = self.drawer.renderer();
        renderer.set_land(Some(self.land.clone()));
        let page = renderer.page(&plan, camera, |_| ())?;
        renderer.set_land(None);
        let mut counted = Counted::default();
        counted.buffers(renderer)?;
        counted.chains(&page.chains);
        counted.chains(&page.land);
        let lines = page.lines(&style.economy(px_per_mm), style.tolerance * px_per_mm);
        counted.strokes(&ink::draw(&lines, &sheet, &style, &[])?);
        let pixels = u64::from(camera.width) * u64::from(camera.height);
        let depths: Vec<[u32; 2]> = renderer.gpu().read(renderer.on_device().buffer("pixels")?, pixels as usize)?;
        let depths: Vec<u32> = depths.into_iter().map(|[_, depth]| depth).collect();
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

impl Sight<'_> {
    fn mark(&mut self, method: &'static str, promise: Promise, places: &[[u32; 2]]) {
        if !promise.is_of(method) {
            return;
        }
        let found = worst(places, SQUARE, MARKED).into_iter();
        self.worst.extend(found.map(|place| Worst::new(method, promise, place)));
    }

    fn figures(self, case: &Case, truth_ms: f64) -> ViewFigures {
        let Camera { eye, azimuth, altitude, fov, width, height } = self.view.camera;
        ViewFigures {
            name: self.view.name,
            eye_m: eye.to_array(),
            azimuth,
            altitude,
            fov,
            width,
            height,
            truth_level: self.truth.level.subdivisions(),
            truth_px: self.truth.length(),
            truth_ms,
            picture: picture_name(case.name, self.view.name),
            worst: self.worst,
            seen: self.seen,
        }
    }
}

/// File name of the picture of a view.
pub(crate) fn picture_name(case: &str, view: &str) -> String {
    format!("{case}_{view}.png")
}
