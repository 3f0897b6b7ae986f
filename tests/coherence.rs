//! Figures of coherence: `cargo bench --bench coherence [-- KEY=VALUE…]`.
//!
//! Straight flights of 640 x 360 px from known views: of each method at a level what of ink and of strokes pops from frame to frame
//! ([`Sequence`]). Keys: `view` (a name, or all that the shared terrain has; the sample is `golden-gate`), `step` (metres, 1),
//! `frames` (20), `methods` (all), `levels` (auto), `way` (`on` along the view axis, `aside` to its right), `truth` (a level).
//! Truths are kept in the user's folder for caches. Nothing is checked.

use std::path::Path;
use std::process::ExitCode;
use std::sync::Arc;

use glam::DVec3;
use hachure::cache::Cache;
use hachure::door::measure::compare::CompareObserver;
use hachure::door::measure::{Comparison, Sequence};
use hachure::door::report::lines::lines;
use hachure::error::Result;
use hachure::geo::read;
use hachure::gpu::{AdapterChoice, Gpu, Int64};
use hachure::plan::{Border, Detail, Method};
use hachure::surface::{Level, Surface};
use hachure::truth::Terrain;
use hachure::view::{Camera, Fixed, choose};

/// The page, px.
const PAGE: [u32; 2] = [640, 360];
/// Names the folder of shared terrain.
const TERRAIN: &str = "HACHURE_DEMS";

/// Views of shared terrain: eye in metres, azimuth and altitude in degrees.
const VIEWS: [(&str, &str, [f64; 3], [f64; 2]); 4] = [
    ("west-temple", "west_temple_50m.tif", [325_249.0, 4_117_889.0, 2000.0], [310.0, 0.0]),
    ("half-dome", "yosemite_utm11n_30m.tif", [273_209.0, 4_179_010.0, 2225.0], [66.0, -4.0]),
    ("st-helens", "sthelens_utm10n_10m.tif", [560_374.0, 5_124_979.0, 1223.0], [170.0, -3.0]),
    ("hakuba", "N36E137.hgt", [733_912.0, 4_003_718.0, 2800.0], [3.5, -4.0]),
];

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if !arguments.iter().any(|a| a == "--bench") {
        println!("nothing is measured but by `cargo bench --bench coherence`");
        return ExitCode::SUCCESS;
    }
    match run(&|key| arguments.iter().find_map(|a| Some(a.strip_prefix(key)?.strip_prefix('=')?.to_owned()))) {
        Ok(()) => ExitCode::SUCCESS,
        Err(e) => {
            eprintln!("{e}");
            ExitCode::from(hachure::door::cli::words::exit_code(&e))
        }
    }
}

fn run(value: &dyn Fn(&str) -> Option<String>) -> Result<()> {
    let number = |key: &str, usual: f64| value(key).and_then(|text| text.parse().ok()).unwrap_or(usual);
    let list = |key: &str| value(key).map(|text| text.split(',').map(str::to_owned).collect::<Vec<_>>());
    let detail = |text: &String| text.parse().ok().and_then(Level::new).map_or(Detail::default(), Detail::from);
    let comparison = Comparison {
        methods: list("methods")
            .map_or(Method::ALL.to_vec(), |names| names.iter().filter_map(|n| Method::named(n)).collect()),
        levels: list("levels").map_or(vec![Detail::default()], |levels| levels.iter().map(detail).collect()),
        repeat: std::num::NonZeroU32::MIN,
        floor: false,
        border: Border::On,
        truth_level: value("truth").and_then(|text| text.parse().ok()).and_then(Level::new),
        cache: Cache::of_user(),
    };
    let gpu = Arc::new(Gpu::open(&AdapterChoice::Best, Int64::IfPresent)?);
    let (step, frames) = (number("step", 1.0), number("frames", 20.0) as u32);
    let hearing = CompareObserver {
        stage: &|_, _| (),
        warn: &|_| (),
        found: &|found| {
            lines(&found).concat().iter().for_each(|line| println!("{line}"));
            Ok(())
        },
    };
    let wanted = |name: &str| value("view").is_none_or(|view| view == name);
    let follow = |name: &str, surface: Arc<Surface>, camera: Camera| {
        let [right, _, forward] = camera.axes();
        let way = if value("way").as_deref() == Some("aside") { right } else { forward };
        let at = |k: u32| Camera { eye: camera.eye + way * f64::from(k) * step, ..camera };
        let cameras: Vec<Camera> = (0..frames).map(at).collect();
        let sequence = Sequence { name, step_m: step, cameras: &cameras };
        comparison.sequence(&gpu, &surface, &Terrain::new(&surface), sequence, &hearing).map(drop)
    };
    let [width, height] = PAGE;
    if wanted("golden-gate") {
        let sample = Path::new(env!("CARGO_MANIFEST_DIR")).join("dem/golden-gate.tif");
        let surface = Arc::new(Surface::new(read(&sample, &Default::default())?));
        let camera = choose(surface.dem(), Fixed::default(), 60.0, width, height)?;
        follow("golden-gate", surface, camera)?;
    }
    let Some(folder) = std::env::var_os(TERRAIN) else { return Ok(()) };
    for (name, file, eye, [azimuth, altitude]) in VIEWS.into_iter().filter(|view| wanted(view.0)) {
        let surface = Arc::new(Surface::new(read(Path::new(&folder).join(file), &Default::default())?));
        let camera = Camera { eye: DVec3::from(eye), azimuth, altitude, fov: 60.0, width, height };
        follow(name, surface, camera)?;
    }
    Ok(())
}
