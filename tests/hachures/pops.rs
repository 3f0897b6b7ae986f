//! Hachures from frame to frame: none of a width that is seen comes or goes at once.

use std::sync::Arc;

use glam::DVec2;
use hachure::geo::{ReadOptions, read};
use hachure::ink::{Sheet, Style};
use hachure::line::{Chain, ChainPoint, InkRaster, Land, Line};
use hachure::plan::{Curves, LandLines, Plan};
use hachure::relief::{ChannelArea, Relief, Slopes};
use hachure::render::Renderer;
use hachure::surface::Surface;
use hachure::view::{Camera, Fixed, Perspective, choose};
use rstar::RTree;
use rstar::primitives::GeomWithData;

use crate::scenes::gpu;
use crate::tolerances::{HACHURE_POPS, HACHURE_POPS_BROAD, HACHURE_POPS_TURN};

const FRAMES: u32 = 8;
const TURNS: u32 = 5;
const SIZE: [u32; 2] = [640, 360];
/// Strokes under this are not seen, mm.
const SEEN_MM: f64 = 0.1;
/// Within this a stroke is where it was, px.
const HERE: f64 = 1.5;
/// At the edge of the page nothing counts, px.
const MARGIN: f64 = 8.0;
/// A place is seen where the page shows no other depth, as a share.
const SAME_DEPTH: f64 = 0.003;

/// The hachures of a frame, and what its pixels show.
pub struct Frame {
    pub perspective: Perspective,
    pub raster: InkRaster,
    pub strokes: Vec<Chain>,
    /// All others.
    pub lines: Vec<Chain>,
    widths: RTree<GeomWithData<[f64; 2], f64>>,
}

/// A flight over land with hachures.
pub struct Flight {
    renderer: Renderer,
    pub plan: Plan,
    style: Style,
}

impl Flight {
    pub fn new(surface: &Arc<Surface>) -> Self {
        let (style, px_per_mm) = (Style::default(), Sheet::for_frame(SIZE).placement(SIZE).px_per_mm);
        let relief = Relief::of(surface.dem(), 1.0).expect("flow");
        let creases = [relief.drainage(ChannelArea::Auto), relief.ridges().expect("ridges")].concat();
        let rules = style.hachures.rules().expect("hachures");
        let slopes = Slopes::new(surface.clone(), 1.0, rules, &creases, None).expect("slope lines");
        let land = Land::new(surface.dem(), 1.0, Vec::new()).expect("land").with_slopes(Arc::new(slopes));
        let mut renderer = Renderer::new(gpu().clone(), surface.clone()).expect("a renderer");
        renderer.set_land(Some(Arc::new(land)));
        let hachures = style.hachures(px_per_mm);
        let plan = Plan { curves: Curves::On, land: LandLines::On, hachures, ..Plan::default() };
        Self { renderer, plan, style }
    }

    pub fn frame(&mut self, camera: &Camera) -> Frame {
        let page = self.renderer.page(&self.plan, camera, |_| ()).expect("a page");
        let raster = self.renderer.draw(&self.plan, camera).expect("a frame").raster;
        let px_per_mm = Sheet::for_frame(SIZE).placement(SIZE).px_per_mm;
        let lines = page.lines(&self.style.economy(px_per_mm), self.style.tolerance * px_per_mm);
        let (strokes, lines): (Vec<Chain>, _) =
            lines.chains.into_iter().partition(|chain| chain.line() == Line::Hachure);
        let pen = self.style.pens.hachure.width;
        let width = |point: ChainPoint| GeomWithData::new(point.place.to_array(), f64::from(point.weight) * pen);
        let widths = RTree::bulk_load(strokes.iter().flat_map(points).map(width).collect());
        Frame { perspective: page.perspective, raster, strokes, lines, widths }
    }

    /// Length of strokes that are seen in one of so many frames by these cameras and are not there in the next or the one before,
    /// and of those that are seen; then of full width that are gone. All in px.
    pub fn comes_and_goes(&mut self, frames: u32, camera: impl Fn(f64) -> Camera) -> [f64; 3] {
        let frames: Vec<Frame> = (0..frames).map(|k| self.frame(&camera(f64::from(k)))).collect();
        let pen = self.style.pens.hachure.width;
        let pairs = frames.windows(2).flat_map(|pair| [lost(&pair[0], &pair[1], pen), lost(&pair[1], &pair[0], pen)]);
        pairs.fold([0.0; 3], |a, b| [a[0] + b[0], a[1] + b[1], a[2] + b[2]])
    }
}

/// Points of a chain at most half a pixel apart.
fn points(chain: &Chain) -> impl Iterator<Item = ChainPoint> + use<'_> {
    chain.pairs().flat_map(|[a, b]| {
        let steps = (a.place.distance(b.place) * 2.0).ceil().max(1.0);
        (0..steps as u32).map(move |k| {
            let t = f64::from(k) / steps;
            let weight = a.weight + (b.weight - a.weight) * t as f32;
            ChainPoint { place: a.place.lerp(b.place, t), world: a.world.lerp(b.world, t), weight, ..*a }
        })
    })
}

/// What is seen in one frame and is not there in another whose pixels show the place: length, all that is seen, and of the first
/// what was as broad as a pen. Half pixels.
fn lost(from: &Frame, to: &Frame, pen: f64) -> [f64; 3] {
    let page = to.perspective.size();
    let mut sums = [0.0; 3];
    for point in from.strokes.iter().flat_map(points).filter(|point| f64::from(point.weight) * pen >= SEEN_MM) {
        let (there, depth) = to.perspective.project(point.world);
        let on_page = depth > 0.0 && there.cmpgt(DVec2::splat(MARGIN)).all() && there.cmplt(page - MARGIN).all();
        let is_shown = || {
            let shown = to.raster.at(there.x as i64, there.y as i64).map_or(0.0, |pixel| f64::from(pixel.depth()));
            (shown / depth - 1.0).abs() < SAME_DEPTH
        };
        if !on_page || !is_shown() {
            continue;
        }
        let near = to.widths.locate_within_distance(there.to_array(), HERE * HERE);
        let width = near.map(|near| near.data).fold(0.0, f64::max);
        let is_gone = f64::from(u8::from(width == 0.0));
        sums[0] += is_gone;
        sums[1] += 1.0;
        sums[2] += if f64::from(point.weight) > 0.9 { is_gone } else { 0.0 };
    }
    sums
}

#[test]
fn hachures_do_not_pop() {
    let surface = Arc::new(Surface::new(read("dem/golden-gate.tif", &ReadOptions::default()).expect("the sample")));
    let camera = choose(surface.dem(), Fixed::default(), 60.0, SIZE[0], SIZE[1]).expect("a view");
    let [.., forward] = camera.axes();
    let ahead = |metres: f64| Camera { eye: camera.eye + forward * metres, ..camera };
    let mut flight = Flight::new(&surface);
    for (step, most) in HACHURE_POPS {
        let [gone, seen, broad] = flight.comes_and_goes(FRAMES, |k| ahead(k * step));
        println!(
            "hachures: {:.3} % of what is seen comes or goes a step of {step} m, {broad} px of full width",
            100.0 * gone / seen
        );
        // At 10 m what comes from behind the edge of a hill is among what is of full width.
        assert!(
            seen > 0.0 && gone / seen <= most && (step > 1.0 || broad / seen <= HACHURE_POPS_BROAD),
            "{gone} of {seen} half pixels, {broad} of full width"
        );
    }
    let [gone, seen, _] =
        flight.comes_and_goes(TURNS, |k| Camera { azimuth: camera.azimuth + k * HACHURE_POPS_TURN.0, ..camera });
    println!(
        "hachures: {:.3} % of what is seen comes or goes a turn of {} degrees",
        100.0 * gone / seen,
        HACHURE_POPS_TURN.0
    );
    assert!(seen > 0.0 && gone / seen <= HACHURE_POPS_TURN.1, "{gone} of {seen} half pixels");
    // Negative control: frames far apart.
    let [gone, seen, _] = flight.comes_and_goes(2, |k| ahead(k * 400.0));
    assert!(gone / seen > HACHURE_POPS[0].1, "strokes that are others are not noticed: {gone} of {seen}");
}
