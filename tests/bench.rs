//! Benchmark of frames against one hardware draw of the same facets: `cargo bench --bench frame [-- FILTER…]`.
//!
//! A frame is [`Renderer::frame`]: camera upload to mask, waited for. The baseline frame is the least that any
//! hidden-surface method on the device must do: our own pass `project`, then one indexed draw of every facet with
//! depth test, which leaves depth and facet ID; no silhouettes, no readback (see [`depth_draw`]). Both by the wall clock
//! around submit and wait, alternately, so that what else the machine does hits both alike; each repetition moves the
//! camera 1 m along its view direction. The ratio is the median of the ratios of neighbours: below 1 a finished mask
//! takes less time than the bare draw. Rows run whose name contains every FILTER, for example `level4 walk`.

mod repeat;

use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;
use std::time::Instant;

use glam::DVec3;
use hachure::door::measure::{DepthDraw, depth_draw};
use hachure::error::{Error, Result};
use hachure::geo::read;
use hachure::gpu::{AdapterChoice, Gpu, Int64};
use hachure::plan::{Border, Method, Plan, SharedVertices};
use hachure::render::Renderer;
use hachure::surface::{Level, Surface};
use hachure::view::Camera;
use repeat::{median, moved};

/// Frames timed of each kind.
const REPETITIONS: usize = 9;
/// Frames before, of each kind.
const WARM_UP: usize = 2;
/// The page of every row, px.
const PAGE: [u32; 2] = [1280, 720];

/// Names the folder of shared terrain.
const TERRAIN: &str = "HACHURE_DEMS";

/// A row of the table.
struct Row {
    name: &'static str,
    method: Method,
    int64: Int64,
    /// Ratios promised at levels 4 and 8.
    targets: [Option<f64>; 2],
}

const ROWS: [Row; 5] = [
    row("toward-away", Method::TowardAway { wide: false }, Int64::IfPresent, [Some(1.0), Some(0.6)]),
    row("walk", Method::Walk, Int64::IfPresent, [Some(1.4), Some(0.9)]),
    row("adjacency-edge", Method::Adjacency { share: SharedVertices::Edge }, Int64::IfPresent, [None; 2]),
    row("adjacency-corner", Method::Adjacency { share: SharedVertices::Corner }, Int64::IfPresent, [None; 2]),
    row("walk-u32", Method::Walk, Int64::Never, [None; 2]),
];

const fn row(name: &'static str, method: Method, int64: Int64, targets: [Option<f64>; 2]) -> Row {
    Row { name, method, int64, targets }
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if !arguments.iter().any(|a| a == "--bench") {
        println!("nothing is timed but by `cargo bench --bench frame`");
        return ExitCode::SUCCESS;
    }
    let filters: Vec<_> = arguments.into_iter().filter(|a| !a.starts_with("--")).collect();
    match run(&filters) {
        Ok(0) => {
            eprintln!("no row is named {filters:?}");
            ExitCode::FAILURE
        }
        Ok(_) => ExitCode::SUCCESS,
        Err(e) => {
            eprintln!("{e}");
            ExitCode::from(hachure::door::cli::words::exit_code(&e))
        }
    }
}

fn run(filters: &[String]) -> Result<usize> {
    let (path, camera) = scene();
    let surface = Arc::new(Surface::new(read(&path, &Default::default())?));
    let gpu = Arc::new(Gpu::open_with(&AdapterChoice::Best, Int64::IfPresent, depth_draw::FEATURE)?);
    let without_int64 = Arc::new(Gpu::open(&AdapterChoice::Best, Int64::Never)?);
    println!("{} on {}", path.display(), gpu.info.name);
    println!("{camera:?}");
    println!("pass by pass: {}", gpu.clock.describe());
    let id = if depth_draw::shows_facets(&gpu) { "primitive_index" } else { "a vertex (no primitive_index here)" };
    println!("baseline: project and one indexed draw, facet ID from {id}");
    let mut rows = 0;
    for (n, column) in [(4, 0), (8, 1)] {
        let level = Level::new(n).expect("a level");
        let wanted = |row: &&Row| filters.iter().all(|f| format!("level{n} {}", row.name).contains(f.as_str()));
        let wanted: Vec<_> = ROWS.iter().filter(wanted).collect();
        if wanted.is_empty() {
            continue;
        }
        let mut vertices = Renderer::new(gpu.clone(), surface.clone())?;
        let plan = Plan::new(level, Method::Walk, Border::Off);
        let mut draw = DepthDraw::new(&gpu, PAGE)?;
        let frame = vertices.frame(&plan, &camera)?;
        draw.load(&gpu, &frame.lattice, 0..frame.seen)?;
        let pixels: Vec<[u32; 2]> =
            gpu.read(vertices.on_device().buffer("pixels")?, PAGE[0] as usize * PAGE[1] as usize)?;
        let mut baseline = Baseline { vertices, plan, draw };
        baseline.frame(&camera)?;
        let differ = baseline.compare(&pixels)?;
        println!("level {n}: {:.3} % of the baseline's pixels show another facet than ours", differ * 100.0);
        for row in wanted {
            let gpu = if row.int64 == Int64::Never { &without_int64 } else { &gpu };
            let mut ours = Renderer::new(gpu.clone(), surface.clone())?;
            let plan = Plan::new(level, row.method, Border::On);
            ours.prepare(&plan, &camera)?;
            let target = row.targets[column].filter(|_| std::env::var_os(TERRAIN).is_some());
            measure(&format!("level{n} {}", row.name), target, (&mut ours, &plan), &mut baseline, &camera)?;
            rows += 1;
        }
    }
    Ok(rows)
}

/// Vertices and the hardware draw of their facets.
struct Baseline {
    vertices: Renderer,
    plan: Plan,
    draw: DepthDraw,
}

impl Baseline {
    /// Draws a frame and waits for it.
    fn frame(&mut self, camera: &Camera) -> Result<()> {
        let gpu = self.vertices.gpu().clone();
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        self.vertices.record_vertices(&self.plan, camera, &mut encoder)?;
        self.draw.record(self.vertices.on_device(), &mut encoder)?;
        gpu.queue.submit([encoder.finish()]);
        gpu.wait()
    }

    /// Share of the covered pixels that show another facet than `pixels` (ID + 1, depth bits) of the same camera; where
    /// it is 1 % or more, the baseline would not draw what we draw.
    fn compare(&self, pixels: &[[u32; 2]]) -> Result<f64> {
        let covered = pixels.iter().filter(|pixel| pixel[1] != 0).count();
        let differ =
            self.draw.ids(self.vertices.gpu())?.iter().zip(pixels).filter(|(id, pixel)| **id != pixel[0]).count();
        let share = differ as f64 / covered as f64;
        if depth_draw::shows_facets(self.vertices.gpu()) && (covered == 0 || share >= 0.01) {
            return Err(Error::Gpu {
                what: format!("{differ} of {covered} pixels of the baseline show another facet"),
            });
        }
        Ok(share)
    }
}

/// West-temple where the shared terrain is, the sample of every checkout elsewhere.
fn scene() -> (PathBuf, Camera) {
    let [width, height] = PAGE;
    let camera = |eye, azimuth, altitude| Camera { eye, azimuth, altitude, fov: 60.0, width, height };
    match std::env::var_os(TERRAIN) {
        Some(folder) => {
            let eye = DVec3::new(325_249.0, 4_117_889.0, 2000.0);
            (Path::new(&folder).join("west_temple_50m.tif"), camera(eye, 310.0, 0.0))
        }
        None => {
            println!("{TERRAIN} is not set: the sample instead of west-temple, for which there are no targets");
            let eye = DVec3::new(545_500.0, 4_182_500.0, 420.0);
            (Path::new(env!("CARGO_MANIFEST_DIR")).join("dem/golden-gate.tif"), camera(eye, 330.0, -3.0))
        }
    }
}

fn measure(
    name: &str,
    target: Option<f64>,
    (ours, plan): (&mut Renderer, &Plan),
    baseline: &mut Baseline,
    camera: &Camera,
) -> Result<()> {
    let at = |k| moved(camera, k);
    let (mut times, mut baselines, mut ratios) = (Vec::new(), Vec::new(), Vec::new());
    let (mut masks, mut inked) = (Vec::new(), 0);
    for k in 0..WARM_UP + REPETITIONS {
        let start = Instant::now();
        baseline.frame(&at(k))?;
        let theirs = start.elapsed().as_secs_f64() * 1e3;
        let start = Instant::now();
        ours.frame(plan, &at(k))?;
        let mine = start.elapsed().as_secs_f64() * 1e3;
        let frame = ours.read()?;
        if k >= WARM_UP {
            times.push(mine);
            baselines.push(theirs);
            ratios.push(mine / theirs);
            masks.push(fnv(frame.raster.pixels.iter().map(|p| u8::from(p.is_ink()))));
            inked = frame.inked();
        }
    }
    let passes = (0..REPETITIONS).map(|k| Ok(ours.timed_frame(plan, &at(k))?.passes)).collect::<Result<Vec<_>>>()?;
    let hash = fnv(masks.iter().flat_map(|m| m.to_le_bytes()));
    let distinct = masks.iter().collect::<HashSet<_>>().len();
    let promise = target.map_or(String::new(), |t| format!(" (target {t:.2})"));
    println!(
        "\n{name}: {} facets, {} pixels, {inked} inked, masks {hash:016x} ({distinct} of {REPETITIONS} differ)",
        ours.last().map_or(0, |frame| frame.facets(ours.surface())),
        PAGE[0] * PAGE[1]
    );
    println!(
        "  ours {:.2} ms, baseline {:.2} ms, ratio {:.2}{promise}; lowest {:.2} and {:.2} ms",
        median(times.clone()),
        median(baselines.clone()),
        median(ratios),
        lowest(&times),
        lowest(&baselines)
    );
    let names = passes[0].iter().map(|p| p.name);
    let of = |i: usize| median(passes.iter().map(|p| p[i].ms).collect());
    let passes: Vec<_> = names.enumerate().map(|(i, name)| format!("{name} {:.2}", of(i))).collect();
    println!("  pass by pass, ms: {}", passes.join(", "));
    Ok(())
}

fn lowest(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::INFINITY, f64::min)
}

/// FNV-1a (Fowler, Noll, Vo), 64 bits.
fn fnv(bytes: impl Iterator<Item = u8>) -> u64 {
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}
