//! Economy on real land: far hills stay open, strong lines stay, the skyline stays whole.

use std::path::Path;
use std::sync::Arc;

use glam::{DVec2, DVec3};
use hachure::geo::{ReadOptions, read};
use hachure::ink::{Sheet, Style, draw, write_png};
use hachure::line::{Chain, ChainPoint, Economy, InkRaster, Kind, Lines};
use hachure::plan::{Border, Detail, Method, Plan};
use hachure::render::Renderer;
use hachure::surface::Surface;
use hachure::view::{Camera, Perspective};

use crate::common::{gpu, shared_dems};
use crate::tolerances::{BLOCK_DARKNESS, LINES_KEPT, SKYLINE_PX, VISIBLE_WEIGHT};

const PAGE: [u32; 2] = [1600, 900];
/// Side of the blocks whose darkness counts, px.
const BLOCK: usize = 12;

/// A view of a DEM: its chains before economy, and what each pixel shows.
struct Seen {
    chains: Vec<Chain>,
    raster: InkRaster,
    perspective: Perspective,
}

/// What can be said of a drawing.
#[derive(Debug)]
struct Figures {
    /// Darkest of the far blocks, a share of black.
    darkest: f64,
    /// Share of the length of lines of more than twice the least jump that is drawn.
    kept: f64,
    /// Columns of the skyline without a stroke.
    missing: usize,
}

impl Seen {
    /// Looks from `eye` in metres of the DEM, azimuth and altitude in degrees.
    fn new(dem: &Path, eye: [f64; 3], [azimuth, altitude]: [f64; 2]) -> Self {
        let surface = Arc::new(Surface::new(read(dem, &ReadOptions::default()).expect("a DEM")));
        let [width, height] = PAGE;
        let camera = Camera { eye: DVec3::from(eye), azimuth, altitude, fov: 60.0, width, height };
        let mut renderer = Renderer::new(gpu().clone(), surface).expect("a renderer");
        let drawn =
            renderer.draw(&Plan::new(Detail::default(), Method::Contour, Border::On), &camera).expect("a frame");
        let perspective = renderer.perspective(renderer.last().expect("a frame"));
        Self { chains: renderer.chains().expect("chains"), raster: drawn.raster, perspective }
    }

    fn drawn(&self, economy: &Economy) -> Figures {
        let lines = Lines::sparing(&self.chains, &[], &self.perspective, economy);
        Figures { darkest: self.darkest(&lines), kept: kept(&lines, economy), missing: self.missing(&lines) }
    }

    /// Darkness of the darkest block whose land lies mostly beyond the 67 % quantile of distance, anywhere on the page.
    fn darkest(&self, lines: &Lines) -> f64 {
        let (style, sheet) = (Style::default(), Sheet::for_frame(PAGE));
        let mut file = Vec::new();
        let drawing = draw(lines, &sheet, &style, &[]).expect("a drawing");
        write_png(&drawing, sheet.placement(PAGE).px_per_mm, &mut file).expect("a picture");
        let page = image::load_from_memory(&file).expect("a picture").to_rgb8();
        let [paper, ink] = [style.paper.0[0], style.pens.silhouette.colour.0[0]].map(f64::from);
        let depths = || self.raster.pixels.iter().map(|p| if p.kind() == Kind::Sky { 0.0 } else { p.depth() });
        let mut land: Vec<f32> = depths().filter(|depth| *depth > 0.0).collect();
        land.sort_unstable_by(f32::total_cmp);
        let far = land[land.len() * 33 / 100];
        let dark = page.pixels().map(|p| (paper - f64::from(p.0[0])) / (paper - ink)).collect::<Vec<_>>();
        // Far land counts for, near land against.
        let side = depths()
            .map(|depth| if depth == 0.0 { 0.0 } else { f64::from(depth < far) * 2.0 - 1.0 })
            .collect::<Vec<_>>();
        let [dark, side] = [dark, side].map(|values| sums(&values));
        let blocks = dark.iter().zip(&side).filter(|(_, side)| **side > 0.0);
        blocks.map(|(dark, _)| dark / (BLOCK * BLOCK) as f64).fold(0.0, f64::max)
    }

    /// How many columns whose topmost land has sky above it have no stroke there.
    fn missing(&self, lines: &Lines) -> usize {
        let [width, height] = PAGE;
        let is_sky = |column: u32, row: u32| self.raster.pixels[(row * width + column) as usize].kind() == Kind::Sky;
        let mut strokes: Vec<Vec<[DVec2; 2]>> = vec![Vec::new(); width as usize];
        for pair in lines.chains.iter().flat_map(|chain| chain.points.windows(2)) {
            if pair.iter().any(|point| point.weight >= VISIBLE_WEIGHT) {
                let ends = [pair[0].place, pair[1].place];
                let [low, high] = [ends[0].x.min(ends[1].x), ends[0].x.max(ends[1].x)];
                let near = (low - 2.0).max(0.0) as usize..((high + 3.0) as usize).min(width as usize);
                strokes[near].iter_mut().for_each(|strokes| strokes.push(ends));
            }
        }
        let is_missing = |&(column, row): &(u32, u32)| {
            let place = DVec2::new(f64::from(column) + 0.5, f64::from(row));
            strokes[column as usize].iter().all(|ends| distance(place, *ends) > SKYLINE_PX)
        };
        let topmost = |column: u32| (1..height).find(|&row| !is_sky(column, row)).map(|row| (column, row));
        let skyline = (0..width).filter(|&column| is_sky(column, 0)).filter_map(topmost);
        skyline.filter(is_missing).count()
    }
}

/// Sums over all blocks of a page, by their top left pixel.
fn sums(values: &[f64]) -> Vec<f64> {
    let [width, height] = PAGE.map(|side| side as usize);
    let mut corner = vec![0.0; (width + 1) * (height + 1)];
    let at = |column: usize, row: usize| row * (width + 1) + column;
    for row in 0..height {
        let mut sum = 0.0;
        for column in 0..width {
            sum += values[row * width + column];
            corner[at(column + 1, row + 1)] = corner[at(column + 1, row)] + sum;
        }
    }
    let block = |i: usize| {
        let [left, top] = [i % (width - BLOCK), i / (width - BLOCK)];
        let [right, bottom] = [left + BLOCK, top + BLOCK];
        corner[at(right, bottom)] - corner[at(left, bottom)] - corner[at(right, top)] + corner[at(left, top)]
    };
    (0..(width - BLOCK) * (height - BLOCK)).map(block).collect()
}

/// Distance of a place from a segment, px.
fn distance(place: DVec2, [a, b]: [DVec2; 2]) -> f64 {
    let t = ((place - a).dot(b - a) / (b - a).length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    place.distance(a.lerp(b, t))
}

/// Of the lines of more than twice the least jump, the share whose weight can be seen.
fn kept(lines: &Lines, economy: &Economy) -> f64 {
    let strong = lines.chains.iter().flat_map(|chain| chain.points.windows(2));
    let strong = strong.filter(|pair| pair[0].jump() > 2.0 * economy.min_jump);
    let (mut all, mut kept) = (0.0, 0.0);
    for pair in strong {
        let length = pair[0].place.distance(pair[1].place);
        all += length;
        kept += if pair[0].weight + pair[1].weight >= 2.0 * VISIBLE_WEIGHT { length } else { 0.0 };
    }
    kept / all
}

/// The economy of such a page unless told otherwise.
fn economy() -> Economy {
    Style::default().economy(Sheet::for_frame(PAGE).placement(PAGE).px_per_mm)
}

fn check(name: &str, seen: &Seen) -> Figures {
    let economy = economy();
    let sparing = seen.drawn(&economy);
    let all = seen.drawn(&Economy { min_jump: 0.0, min_gap: 0.0 });
    println!("{name}: {sparing:?}, of all lines {all:?}");
    assert!(sparing.darkest <= BLOCK_DARKNESS, "{name}: {sparing:?}");
    assert!(sparing.kept >= LINES_KEPT, "{name}: {sparing:?}");
    assert!(sparing.missing <= all.missing, "{name}: economy breaks the skyline: {sparing:?}, {all:?}");
    all
}

#[test]
fn the_sample_stays_open_and_keeps_its_lines() {
    let dem = Path::new(env!("CARGO_MANIFEST_DIR")).join("dem/golden-gate.tif");
    let seen = Seen::new(&dem, [547_500.0, 4_183_300.0, 300.0], [318.0, -4.0]);
    let all = check("the sample", &seen);
    assert_eq!(all.missing, 0, "columns of the skyline have no line");
    // Negative controls: half of the skyline gone, a gap that leaves little.
    let mut broken = Lines::sparing(&seen.chains, &[], &seen.perspective, &economy());
    let left = |point: &&mut ChainPoint| point.place.x < 800.0;
    broken.chains.iter_mut().flat_map(|c| &mut c.points).filter(left).for_each(|point| point.weight = 0.0);
    assert!(seen.missing(&broken) > 400, "a broken skyline is not noticed");
    let wide = Economy { min_gap: 60.0, ..economy() };
    assert!(
        kept(&Lines::sparing(&seen.chains, &[], &seen.perspective, &wide), &wide) < LINES_KEPT,
        "lost lines are not noticed"
    );
}

#[test]
fn mountains_stay_open_and_keep_their_lines() {
    let Some(dems) = shared_dems() else { return };
    // 10 m and 3" grids.
    let views = [
        ("sthelens_utm10n_10m.tif", [560_374.0, 5_124_979.0, 1223.0], [170.0, -3.0]),
        ("N36E137.hgt", [733_912.0, 4_003_718.0, 2800.0], [3.5, -4.0]),
    ];
    for (dem, eye, direction) in views {
        let all = check(dem, &Seen::new(&dems.join(dem), eye, direction));
        assert!(all.darkest > BLOCK_DARKNESS || dem.ends_with("hgt"), "without economy far hills clot: {all:?}");
    }
}
