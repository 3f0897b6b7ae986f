//! Lines on the land from frame to frame: what comes and goes of their ink is what land hides.

use std::sync::Arc;

use glam::DVec2;
use hachure::geo::{ReadOptions, read};
use hachure::ink::{Sheet, Style};
use hachure::line::{Chain, ChainPoint, Land};
use hachure::plan::{Curves, LandLines, Plan};
use hachure::relief::{ChannelArea, LineKind, Relief, SurfaceLine, SurfacePoint, append};
use hachure::render::Renderer;
use hachure::surface::Surface;
use hachure::view::{Camera, Fixed, Perspective, choose};
use rstar::RTree;
use rstar::primitives::GeomWithData;

use crate::scenes::gpu;
use crate::tolerances::LAND_POPS;

const FRAMES: u32 = 8;
/// Within this a line is where it was, px.
const HERE: f64 = 1.5;
/// At the edge of the page nothing counts, px.
const MARGIN: f64 = 3.0;

/// The lines on the land of a frame: where the eye may see them, were they all drawn, and how strongly they are.
struct Frame {
    perspective: Perspective,
    seen: RTree<[f64; 2]>,
    drawn: Vec<Chain>,
    weights: RTree<GeomWithData<[f64; 2], f32>>,
}

fn frame([drawn, all]: &mut [Renderer; 2], camera: &Camera) -> Frame {
    let plan = Plan { curves: Curves::On, land: LandLines::On, ..Plan::default() };
    let [page, all] = [drawn, all].map(|renderer| renderer.page(&plan, camera, |_| ()).expect("a page"));
    let (style, size) = (Style::default(), [camera.width, camera.height]);
    let px_per_mm = Sheet::for_frame(size).placement(size).px_per_mm;
    let lines = page.lines(&style.economy(px_per_mm), style.tolerance * px_per_mm);
    let drawn: Vec<Chain> = lines.chains.into_iter().filter(|chain| chain.line().is_of_land()).collect();
    let places = |point: &ChainPoint| point.place.to_array();
    // Points stand at most 4 px apart: between them there are more.
    let seen = all.land.iter().flat_map(points).map(|point| places(&point)).collect();
    let weights = drawn.iter().flat_map(points);
    let weights = weights.map(|point| GeomWithData::new(places(&point), point.weight)).collect();
    Frame { perspective: page.perspective, seen: RTree::bulk_load(seen), weights: RTree::bulk_load(weights), drawn }
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

/// What is drawn in one frame and not in another that may show it, where no land hides it there: length by weight, and all.
fn lost(from: &Frame, to: &Frame) -> [f64; 2] {
    let page = to.perspective.size();
    let mut sums = [0.0; 2];
    for point in from.drawn.iter().flat_map(points) {
        let (there, depth) = to.perspective.project(point.world);
        let on_page = depth > 0.0 && there.cmpgt(DVec2::splat(MARGIN)).all() && there.cmplt(page - MARGIN).all();
        let there = there.to_array();
        if !on_page || to.seen.locate_within_distance(there, HERE * HERE).next().is_none() {
            continue;
        }
        let near = to.weights.locate_within_distance(there, HERE * HERE);
        let weight = near.map(|near| near.data).fold(0.0, f32::max);
        sums[0] += f64::from((point.weight - weight).max(0.0));
        sums[1] += f64::from(point.weight);
    }
    sums
}

/// Drawn length that comes or goes from a frame to the next, and all, of a flight in steps of so many metres.
fn comes_and_goes(renderers: &mut [Renderer; 2], first: &Camera, step: f64) -> [f64; 2] {
    let [.., forward] = first.axes();
    let at = |k: u32| Camera { eye: first.eye + forward * f64::from(k) * step, ..*first };
    let frames: Vec<Frame> = (0..FRAMES).map(|k| frame(renderers, &at(k))).collect();
    let pairs = frames.windows(2).flat_map(|pair| [lost(&pair[0], &pair[1]), lost(&pair[1], &pair[0])]);
    pairs.fold([0.0; 2], |a, b| [a[0] + b[0], a[1] + b[1]])
}

/// The same lines as those that no relief need show.
fn all_shown(lines: &[SurfaceLine]) -> Vec<SurfaceLine> {
    let point = |point: &SurfacePoint| SurfacePoint { across: [f32::INFINITY; 3], ..*point };
    let line = |line: &SurfaceLine| SurfaceLine {
        kind: LineKind::Own(0),
        points: line.points.iter().map(point).collect(),
        ..line.clone()
    };
    lines.iter().map(line).collect()
}

#[test]
fn lines_on_the_land_do_not_pop() {
    let surface = Arc::new(Surface::new(read("dem/golden-gate.tif", &ReadOptions::default()).expect("the sample")));
    let camera = choose(surface.dem(), Fixed::default(), 60.0, 640, 360).expect("a view");
    let relief = Relief::of(surface.dem(), 1.0).expect("flow");
    let mut lines = relief.drainage(ChannelArea::Auto);
    append(&mut lines, relief.ridges().expect("ridges"));
    let renderer = |lines: Vec<SurfaceLine>| {
        let mut renderer = Renderer::new(gpu().clone(), surface.clone()).expect("a renderer");
        renderer.set_land(Some(Arc::new(Land::new(surface.dem(), 1.0, lines).expect("lines"))));
        renderer
    };
    let all = all_shown(&lines);
    let mut renderers = [renderer(lines.clone()), renderer(all.clone())];
    for (step, most) in LAND_POPS {
        let [lost, all] = comes_and_goes(&mut renderers, &camera, step);
        println!("land: {:.3} % of drawn length come or go a step of {step} m", 100.0 * lost / all);
        assert!(all > 0.0 && lost / all <= most, "{}", lost / all);
    }
    // Negative control: every fourth line of the first frame is not in the second.
    let first = frame(&mut renderers, &camera);
    let without = lines.iter().enumerate().map(|(i, line)| match i % 4 {
        0 => SurfaceLine { points: line.points[..2].to_vec(), joins: None, ..line.clone() },
        _ => SurfaceLine { joins: None, ..line.clone() },
    });
    let second = frame(&mut [renderer(without.collect()), renderer(all)], &camera);
    let [lost, all] = lost(&first, &second);
    assert!(lost / all > LAND_POPS[0].1, "lines that are gone are not noticed: {}", lost / all);
}
