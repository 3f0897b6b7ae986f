//! `hachure draw`: a DEM as ink on a page.

use std::panic::resume_unwind;
use std::path::PathBuf;
use std::sync::Arc;
use std::thread;
use std::time::Instant;

use clap::ValueEnum;
use serde::Serialize;

use super::cache::CacheArguments;
use super::device::DeviceArguments;
use super::flat_earth::FlatEarth;
use super::outputs::OutputArguments;
use super::talk::Talk;
use super::terrain::{TerrainArguments, warn_of_survey};
use super::values::{self, LevelChoice};
use super::viewpoint::{View, ViewArguments, ViewReport};
use super::{blank, cells};
use crate::dem::Dem;
use crate::error::{Error, Result, shown};
use crate::files::Taken;
use crate::ink::{self, Style};
use crate::plan::detail::ERROR_PX;
use crate::plan::left_out::LeftOut;
use crate::plan::{Border, Detail, Frame, Method, Plan, Share};
use crate::render::{Page, PassTime, Renderer};
use crate::report::results::DrawnLevel;
use crate::surface::Surface;

/// Warm frames behind the median of `--json`; a page in pieces, which may take minutes, has one.
const WARM_FRAMES: usize = 9;

/// The end of `hachure draw --help`.
const EXAMPLES: &str = "\
Examples:
  A view that shows the relief is chosen, and printed as flags that repeat it:
  hachure draw dem/golden-gate.tif -o golden-gate.png

  From 300 m above the ground, heights doubled, looking north-west:
  hachure draw dem/golden-gate.tif -o golden-gate.png --exaggeration 2 \\
      --eye 547500,4183300,+300 --azimuth 318 --altitude -6 --fov 50 --size 1600x700

  Several tiles in degrees, from 400 m above a place on the globe, looking at another:
  hachure draw N37W123.hgt N38W123.hgt -o bay.png --lonlat -122.47,37.786,+400 --crs EPSG:4326 --look-at -122.6,37.924

  The mask alone, to another program, and what was done, to a file:
  hachure draw dem/golden-gate.tif -o golden-gate.png --json golden-gate.json --mask - | wc -c";

/// Flags of `hachure draw`, as typed.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct DrawArguments {
    #[command(flatten)]
    terrain: TerrainArguments,
    #[command(flatten)]
    outputs: OutputArguments,

    #[command(flatten)]
    view: ViewArguments,

    /// Factor on every elevation
    #[arg(long, value_name = "X", value_parser = values::exaggeration, allow_hyphen_values = true, default_value = "1", help_heading = "Surface")]
    exaggeration: f64,
    /// Subdivisions of a cell's edge: 1, 2, 4, 8, 16, 32 or 64; auto: each part of the DEM as fine as the page shows
    #[arg(long, value_name = "N|auto", value_parser = values::level_choice, default_value = "auto", help_heading = "Surface")]
    level: LevelChoice,
    #[arg(
        long, value_name = "PX", value_parser = values::error_px, help_heading = "Surface",
        help = format!("--level auto only: how far facets may deviate from the surface on the page, in pixels [default: {ERROR_PX}]")
    )]
    error_px: Option<f64>,

    /// How silhouettes are found
    #[arg(long, default_value = "walk", help_heading = "Method")]
    method: MethodName,
    /// toward-away only: away surface counts wherever it touches the pixel or the neighbour it is compared with
    #[arg(long, help_heading = "Method")]
    wide: bool,
    #[arg(
        long, help_heading = "Method",
        help = format!("adjacency only: what neighbouring facets share [default: {}]", name(Share::default()))
    )]
    share: Option<Share>,
    /// Whether to draw the visible border of the DEM and of its voids
    #[arg(long, default_value = "on", help_heading = "Method")]
    border: Border,

    /// Say at which levels parts of the DEM are drawn, what the frame did without, why, and what that saved
    #[arg(long)]
    explain: bool,
    #[command(flatten)]
    device: DeviceArguments,
    #[command(flatten)]
    cache: CacheArguments,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum MethodName {
    /// Walk the lattice between neighbouring pixels: complete
    Walk,
    /// Compare toward and away depths: never a false line, but gaps
    TowardAway,
    /// Compare the facets of neighbouring pixels: floods small facets
    Adjacency,
}

/// What is typed for a choice.
fn name(choice: impl ValueEnum) -> String {
    choice.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned())
}

/// `--json`.
#[derive(Serialize)]
struct Report {
    version: &'static str,
    dem: DemReport,
    method: &'static str,
    level: DrawnLevel,
    facets: u64,
    inked: usize,
    covered: u64,
    longest_walk: u32,
    pieces: usize,
    warm_frames: usize,
    frame_ms: f64,
    timing: &'static str,
    passes: Vec<PassTime>,
    adapter: String,
    int64: bool,
    view: ViewReport,
    flat_earth: Option<FlatEarth>,
    left_out: Vec<LeftOut>,
}

/// What was drawn, and what became of the files on the way.
#[derive(Serialize)]
struct DemReport {
    files: Vec<String>,
    columns: usize,
    rows: usize,
    cell_m: [f64; 2],
    extent_m: [f64; 4],
    voids: usize,
    converted: Vec<String>,
    assumed: Vec<String>,
}

/// Draws.
///
/// # Errors
/// Whatever went wrong; nothing stands under a final name then.
pub fn run(arguments: &DrawArguments, talk: &Talk) -> Result<()> {
    let method = arguments.method()?;
    arguments.detail()?;
    arguments.view.check()?;
    arguments.outputs.check()?;
    let started = Instant::now();
    let reading = arguments.terrain.open(&arguments.terrain.dems, arguments.exaggeration)?;
    let mut outputs = arguments.outputs.open(Taken::inputs(reading.files()))?;
    let dem = arguments.terrain.read(reading, talk)?;
    // The renderer holds all samples on the device.
    talk.progress("computing normals", 0.1);
    if !dem.is_filed() {
        dem.check_patches()?;
    }
    let surface = Arc::new(Surface::new(dem));
    let cache = arguments.cache.cache();
    let prepare = || {
        cache.prepare(&surface, &|words| talk.warn(words), &|done| {
            talk.progress("looking at every sample, once for this file", 0.1 + 0.1 * done);
        })
    };
    // Drivers take their time to start. Samples stay on this thread, where HDF5 keeps silent.
    let (prepared, gpu) = thread::scope(|scope| {
        let open = || arguments.device.open_silently(wgpu::Features::empty());
        match thread::Builder::new().spawn_scoped(scope, open) {
            Ok(gpu) => (prepare(), gpu.join().unwrap_or_else(|panic| resume_unwind(panic))),
            // The system has no thread left.
            Err(_) => (prepare(), open()),
        }
    });
    prepared?;
    surface.dem().check_patches()?;
    cells::warn(surface.dem(), arguments.exaggeration, talk);
    warn_of_survey(surface.dem(), talk)?;
    let view = arguments.view.view(&surface, arguments.level.near())?;
    view.warn_below_ground(&surface, arguments.level.near(), talk);
    talk.say(&format!("view: {}", view.flags()))?;
    view.lonlat_flag().map_or(Ok(()), |flag| talk.say(&format!("or with: {flag}")))?;
    let gpu = Arc::new(gpu?);
    DeviceArguments::tell(&gpu, talk)?;
    talk.progress("drawing", 0.3);
    let mut renderer = Renderer::new(gpu, surface.clone())?;
    let plan = Plan::new(arguments.detail()?, method, arguments.border);
    let page = renderer.page(&plan, &view.camera, |share| talk.progress("drawing", 0.3 + 0.3 * share))?;
    cache.discard_damaged(surface.dem(), &|words| talk.warn(words));
    let drawing = ink::draw(&page.marks, &Style::for_page(view.camera.width));
    let report = || {
        talk.progress("timing more frames", 0.6);
        arguments.report(&mut renderer, &view, &page)
    };
    let report = outputs.want_report().then(report).transpose()?;
    if arguments.explain || talk.is_verbose() {
        explain(talk, &page.frame, &page.frame.left_out(&surface)?, report.as_ref())?;
    }
    talk.progress("writing", 0.8);
    outputs.write(&drawing, &page, report.as_ref())?;
    surface.dem().check()?;
    talk.progress("writing", 1.0);
    outputs.publish()?;
    let flat_earth = arguments.flat_earth(&renderer, &view, &page);
    flat_earth.map_or(Ok(()), |flat_earth| talk.say(&flat_earth.words()))?;
    talk.say(&format!(
        "{}: {} facets, {} of {} pixels inked, {:.2} s",
        shown(arguments.outputs.drawing()),
        page.frame.facets(&surface),
        page.marks.inked(),
        u64::from(view.camera.width) * u64::from(view.camera.height),
        started.elapsed().as_secs_f64()
    ))?;
    blank::warn(&mut renderer, &view, arguments.level, &page, talk);
    Ok(())
}

impl DrawArguments {
    /// Whether one of the files is standard output.
    pub fn fill_stdout(&self) -> bool {
        self.outputs.fill_stdout()
    }

    fn detail(&self) -> Result<Detail> {
        if self.error_px.is_some() && self.level != LevelChoice::Auto {
            return Err(Error::flag("--error-px", "goes with --level auto only", "leave one of them out"));
        }
        Ok(self.level.detail(self.error_px.unwrap_or(ERROR_PX)))
    }

    fn method(&self) -> Result<Method> {
        if self.wide && self.method != MethodName::TowardAway {
            return Err(Error::flag("--wide", "goes with toward-away only", "add --method toward-away"));
        }
        if self.share.is_some() && self.method != MethodName::Adjacency {
            return Err(Error::flag("--share", "goes with adjacency only", "add --method adjacency"));
        }
        Ok(match self.method {
            MethodName::Walk => Method::Walk,
            MethodName::TowardAway => Method::TowardAway { wide: self.wide },
            MethodName::Adjacency => Method::Adjacency { share: self.share.unwrap_or_default() },
        })
    }

    fn report(&self, renderer: &mut Renderer, view: &View, page: &Page) -> Result<Report> {
        let Page { frame: Frame { plan, camera, pieces, .. }, .. } = page;
        let (gpu, surface) = (renderer.gpu().clone(), renderer.surface().clone());
        let pieces = pieces.iter().len();
        let warm_frames = if pieces == 1 { WARM_FRAMES } else { 1 };
        let mut times = (0..warm_frames).map(|_| renderer.time_of_frame(plan, camera)).collect::<Result<Vec<_>>>()?;
        times.sort_by(f64::total_cmp);
        Ok(Report {
            version: env!("CARGO_PKG_VERSION"),
            dem: DemReport::of(&self.terrain.dems, surface.dem()),
            method: plan.method.name(),
            level: self.detail()?.into(),
            facets: page.frame.facets(&surface),
            inked: page.marks.inked(),
            covered: page.covered,
            longest_walk: page.longest_walk,
            pieces,
            warm_frames,
            frame_ms: times[warm_frames / 2],
            timing: gpu.clock.describe(),
            passes: renderer.timed_frame(plan, camera)?.passes,
            adapter: format!("{} ({})", gpu.info.name, gpu.info.driver_info),
            int64: gpu.int64,
            view: view.report(surface.dem().georeference(), self.exaggeration),
            flat_earth: self.flat_earth(renderer, view, page),
            left_out: page.frame.left_out(&surface)?,
        })
    }

    /// Where the DEM lies on Earth.
    fn flat_earth(&self, renderer: &Renderer, view: &View, page: &Page) -> Option<FlatEarth> {
        view.is_on_earth().then(|| FlatEarth::of(&page.marks, &view.camera, renderer.near()))?
    }
}

/// Says at which levels chunks are, what was left out and, where they were taken, the times.
fn explain(talk: &Talk, frame: &Frame, left_out: &[LeftOut], report: Option<&Report>) -> Result<()> {
    talk.say(&format!("chunks: {}", frame.levels()))?;
    for LeftOut { what, why, saved } in left_out {
        let saved = saved.as_ref().map_or(String::new(), |saved| format!(" ({saved})"));
        talk.say(&format!("left out: {what}, {why}{saved}"))?;
    }
    for PassTime { name, ms } in report.iter().flat_map(|report| &report.passes) {
        talk.say(&format!("pass {name}: {ms:.2} ms"))?;
    }
    report.map_or(Ok(()), |report| talk.say(&format!("median frame: {:.2} ms", report.frame_ms)))
}

impl DemReport {
    fn of(files: &[PathBuf], dem: &Dem) -> Self {
        // What cannot be read fails elsewhere, with its reason.
        let surveyed = dem.survey(&|_| ()).map(|survey| survey.assumed.clone()).unwrap_or_default();
        Self {
            files: files.iter().map(|file| file.to_string_lossy().into_owned()).collect(),
            columns: dem.columns(),
            rows: dem.rows(),
            cell_m: dem.cell().to_array(),
            extent_m: dem.extent(),
            voids: dem.voids(),
            converted: dem.history().converted().to_vec(),
            assumed: [dem.history().assumed(), &surveyed, dem.history().usual()].concat(),
        }
    }
}
