//! Benchmark of how time grows: `cargo bench --bench scaling [-- samples | pixels]`.
//!
//! *samples*: fractal terrain of 2^8 samples a side, resampled to up to 2^13 over the same ground, seen by one camera on one
//! page; time is promised to grow less than 1.6 times. *pixels*: one of these terrains on pages of 0.3 to 33 megapixels, the
//! largest drawn in pieces; time is promised to grow no more than the page. The walk over facets as fine as the page
//! asks, without border lines. A frame is [`Renderer::frame`], camera to mask, by the wall clock, so that what the CPU does
//! for it counts; each one moves the camera 1 m on. Beside the table each has its plot, in `target/scaling`. A promise that is
//! broken is named, and the exit code is 1.

mod repeat;
mod resample;

use std::path::Path;
use std::process::ExitCode;
use std::sync::Arc;
use std::time::Instant;

use glam::{DVec2, DVec3};
use hachure::dem::{Dem, fractal};
use hachure::door::files::{Output, output};
use hachure::door::measure::{Growth, Promise};
use hachure::door::report::growth_svg;
use hachure::error::{Error, Result};
use hachure::gpu::{AdapterChoice, Gpu, Int64};
use hachure::plan::{Border, Detail, Method, Plan};
use hachure::render::{Page, Renderer};
use hachure::surface::{Level, Surface};
use hachure::view::Camera;
use repeat::{median, moved};
use resample::resampled;

/// Samples along a side of the terrain as it is generated, and of what is resampled from it, as powers of two.
const POWERS: std::ops::RangeInclusive<u32> = 8..=13;
/// The same of the terrain on pages of all sizes.
const PAGES_POWER: u32 = 10;
/// The page of the terrain of all sizes, px.
const PAGE: [u32; 2] = [1024, 768];
/// Pages of one shape, px.
const PAGES: [[u32; 2]; 5] = [[640, 480], [1280, 960], [2560, 1920], [5120, 3840], [6656, 4992]];
/// Frames before those that are timed.
const WARM_UP: usize = 2;
/// Frames timed of each terrain, of each page.
const REPETITIONS: [usize; 2] = [9, 3];
/// Easting and northing of the north-western sample.
const ORIGIN: DVec2 = DVec2::new(500_000.0, 5_540_000.0);
/// From there to the eye, and its height above the ground, metres.
const EYE: DVec3 = DVec3::new(1500.0, -6000.0, 250.0);

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if !arguments.iter().any(|a| a == "--bench") {
        println!("nothing is timed but by `cargo bench --bench scaling`");
        return ExitCode::SUCCESS;
    }
    let asked: Vec<_> = arguments.iter().filter(|a| !a.starts_with("--")).map(String::as_str).collect();
    if let Some(unknown) = asked.iter().find(|asked| !["samples", "pixels"].contains(asked)) {
        eprintln!("`{unknown}` is neither `samples` nor `pixels`");
        return ExitCode::from(2);
    }
    match run(|name| asked.is_empty() || asked.contains(&name)) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(e) => {
            eprintln!("{e}");
            ExitCode::from(hachure::door::cli::words::exit_code(&e))
        }
    }
}

/// Whether every promise is kept.
fn run(asked: impl Fn(&str) -> bool) -> Result<bool> {
    let gpu = Arc::new(Gpu::open(&AdapterChoice::Best, Int64::IfPresent)?);
    let ground = Arc::new(Surface::new(terrain(*POWERS.start())));
    let camera = camera(&ground);
    println!("fractal terrain, {} m a side, on {}\n{camera:?}", ground.dem().extent()[2] - ORIGIN.x, gpu.info.name);
    let mut kept = true;
    if asked("samples") {
        kept &= judge("samples", &samples(&gpu, &camera)?)?;
    }
    if asked("pixels") {
        kept &= judge("pixels", &pixels(&gpu, &camera)?)?;
    }
    Ok(kept)
}

/// Each terrain on one page.
fn samples(gpu: &Arc<Gpu>, camera: &Camera) -> Result<Growth> {
    println!("\nsamples a side     facets   chunks   frame, ms   ink, px   normals, ms   pyramid, ms");
    let mut points = Vec::new();
    for power in POWERS {
        let dem = terrain(power);
        let start = Instant::now();
        let surface = Arc::new(Surface::new(dem));
        let normals = start.elapsed();
        surface.pyramid()?;
        let pyramid = start.elapsed() - normals;
        let row = measure(gpu, &surface, camera, REPETITIONS[0])?;
        println!(
            "{:14} {:10} {:8} {:11.1} {:9} {:13.0} {:13.0}",
            1 << power,
            row.facets,
            row.chunks,
            row.ms,
            row.inked,
            normals.as_secs_f64() * 1e3,
            pyramid.as_secs_f64() * 1e3
        );
        points.push([f64::from(1 << power), row.ms]);
    }
    Ok(Growth {
        title: "The same terrain in more samples".into(),
        caption: format!("One view, {} × {} px, walk, level auto", PAGE[0], PAGE[1]),
        note: note(gpu, REPETITIONS[0]),
        across: "samples along a side of the DEM".into(),
        points,
        promise: Promise::Below(1.6),
    })
}

/// One terrain on each page.
fn pixels(gpu: &Arc<Gpu>, camera: &Camera) -> Result<Growth> {
    println!("\n       page   pieces     facets   chunks   frame, ms   ink, px   ns a pixel");
    let surface = Arc::new(Surface::new(terrain(PAGES_POWER)));
    let mut points = Vec::new();
    for [width, height] in PAGES {
        let camera = Camera { width, height, ..*camera };
        let row = measure(gpu, &surface, &camera, REPETITIONS[1])?;
        let millions = f64::from(width) * f64::from(height) / 1e6;
        println!(
            "{:>11} {:8} {:10} {:8} {:11.1} {:9} {:12.1}",
            format!("{width}x{height}"),
            row.pieces,
            row.facets,
            row.chunks,
            row.ms,
            row.inked,
            row.ms / millions
        );
        points.push([millions, row.ms]);
    }
    let side = 1 << PAGES_POWER;
    Ok(Growth {
        title: "The same view in more pixels".into(),
        caption: format!("One view of {side} × {side} samples, walk, level auto"),
        note: note(gpu, REPETITIONS[1]),
        across: "pixels of the page, millions".into(),
        points,
        promise: Promise::Linear,
    })
}

/// What the plot cannot show.
fn note(gpu: &Arc<Gpu>, frames: usize) -> String {
    format!("Median of {frames} frames, each with the camera 1 m on; {}.", gpu.info.name)
}

/// What a frame worked through, and the median of its times.
struct Row {
    ms: f64,
    pieces: usize,
    facets: u64,
    chunks: usize,
    inked: usize,
}

fn measure(gpu: &Arc<Gpu>, surface: &Arc<Surface>, camera: &Camera, repetitions: usize) -> Result<Row> {
    let plan = Plan::new(Detail::default(), Method::Walk, Border::Off);
    let mut renderer = Renderer::new(gpu.clone(), surface.clone())?;
    renderer.prepare(&plan, camera)?;
    let mut times = Vec::new();
    for k in 0..WARM_UP + repetitions {
        let camera = moved(camera, k);
        let start = Instant::now();
        renderer.frame(&plan, &camera)?;
        times.push(start.elapsed().as_secs_f64() * 1e3);
    }
    let Page { marks, frame, .. } = renderer.page(&plan, &moved(camera, WARM_UP + repetitions), |_| ())?;
    Ok(Row {
        ms: median(times.split_off(WARM_UP)),
        pieces: frame.pieces.iter().len(),
        facets: frame.facets(surface),
        chunks: frame.lattice.chunks().len(),
        inked: marks.inked(),
    })
}

/// Writes the plot, says how far time has grown, and whether that was promised.
fn judge(name: &str, growth: &Growth) -> Result<bool> {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).with_file_name("scaling");
    let path = folder.join(format!("{name}.svg"));
    let failed = |why: std::io::Error| Error::output(&path, &why);
    if !folder.is_dir() {
        output::make_folder(&folder).map_err(failed)?;
    }
    let (svg, mut out) = (growth_svg(growth)?, Output::create(&path)?);
    out.write(|file| file.write_all(svg.as_bytes()))?;
    out.publish()?;
    for ([size, _], (times, broken)) in growth.points.iter().zip(growth.growth()) {
        let grown = size / growth.points[0][0];
        let broken = if broken { ": BROKEN" } else { "" };
        println!("{name} {grown:.1} times as many: time grows {times:.2} times{broken}");
    }
    println!("{}: promised {}, {}", path.display(), growth.promise, if growth.is_kept() { "kept" } else { "broken" });
    Ok(growth.is_kept())
}

/// The terrain with 2^`power` samples a side, over the same ground whatever the power.
fn terrain(power: u32) -> Dem {
    let [from, to] = [*POWERS.start(), power].map(|power| 1 << power);
    let heights: Vec<f32> = (0..from).flat_map(|r| fractal::row(from, r)).collect();
    let cell = fractal::CELL * (from - 1) as f64 / (to - 1) as f64;
    Dem::from_heights(to, DVec2::splat(cell), ORIGIN, resampled(&heights, from, to))
}

/// Above the south-west, looking north-east.
fn camera(ground: &Surface) -> Camera {
    let place = ORIGIN + EYE.truncate();
    let height = ground.height_below(place, Level::new(1).expect("a level")).expect("ground below the eye");
    let [width, height_px] = PAGE;
    Camera { eye: place.extend(height + EYE.z), azimuth: 45.0, altitude: -5.0, fov: 60.0, width, height: height_px }
}
