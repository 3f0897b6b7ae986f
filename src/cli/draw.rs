//! `hachure draw`: a DEM as ink on a page.

use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::ValueEnum;
use glam::DVec2;
use serde::Serialize;

use super::say;
use super::terrain::TerrainArguments;
use super::values;
use super::viewpoint::{View, ViewArguments, ViewReport};
use crate::dem::{self, Dem};
use crate::error::{Error, Result};
use crate::gpu::sizes::page_fits;
use crate::gpu::{AdapterChoice, Gpu, Int64};
use crate::ink::{self, Output, Style};
use crate::plan::{Border, Method, Plan, Share};
use crate::render::{Frame, PassTime, Renderer};
use crate::surface::bounds::spheres;
use crate::surface::{Level, Surface};
use crate::view::Camera;

/// Warm frames behind the median of `--json`.
const WARM_FRAMES: usize = 9;

/// Flags of `hachure draw`, as typed.
#[derive(Debug, clap::Args)]
pub struct DrawArguments {
    #[command(flatten)]
    terrain: TerrainArguments,
    /// The drawing, a .png
    #[arg(short, long, value_name = "OUT.png")]
    output: PathBuf,
    /// Also the mask: 1 bit a pixel, 0 ink, 255 paper, exactly --size
    #[arg(long, value_name = "OUT.png")]
    mask: Option<PathBuf>,
    /// Also what was done, with times of ten further frames
    #[arg(long, value_name = "OUT.json")]
    json: Option<PathBuf>,

    #[command(flatten)]
    view: ViewArguments,

    /// Factor on every elevation
    #[arg(long, value_name = "X", value_parser = values::exaggeration, allow_hyphen_values = true, default_value = "1", help_heading = "Surface")]
    exaggeration: f64,
    /// Subdivisions of a cell's edge: 1, 2, 4, 8, 16, 32 or 64
    #[arg(long, value_name = "N", value_parser = values::level, default_value = "4", help_heading = "Surface")]
    level: Level,

    /// How silhouettes are found
    #[arg(long, default_value = "walk", help_heading = "Method")]
    method: MethodName,
    /// toward-away only: conservative away coverage, nearest away depth of the 3 x 3 block
    #[arg(long, help_heading = "Method")]
    wide: bool,
    /// adjacency only: what neighbouring facets share [default: edge]
    #[arg(long, help_heading = "Method")]
    share: Option<Share>,
    /// Whether to draw the visible border of the DEM and of its voids
    #[arg(long, default_value = "on", help_heading = "Method")]
    border: Border,

    /// Adapter: cpu, gpu, or words of its name [default: the best one]
    #[arg(long, value_name = "NAME|cpu|gpu", value_parser = values::adapter, help_heading = "Device")]
    adapter: Option<AdapterChoice>,
    /// Draw as on a device without 64-bit atomics
    #[arg(long, hide = true)]
    no_int64: bool,
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

/// `--json`.
#[derive(Serialize)]
struct Report {
    version: &'static str,
    dem: DemReport,
    method: &'static str,
    level: u32,
    facets: u64,
    inked: usize,
    longest_walk: u32,
    frame_ms: f64,
    timing: &'static str,
    passes: Vec<PassTime>,
    adapter: String,
    int64: bool,
    view: ViewReport,
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

#[derive(Serialize)]
struct LeftOut {
    what: &'static str,
    why: &'static str,
    saved: Option<String>,
}

/// Draws.
///
/// # Errors
/// Whatever went wrong; nothing stands under a final name then.
pub fn run(arguments: &DrawArguments) -> Result<()> {
    let method = arguments.method()?;
    let size = [arguments.view.size.width, arguments.view.size.height];
    page_fits(size)?;
    arguments.view.check()?;
    let outputs = Outputs::open(arguments)?;
    let started = Instant::now();
    let options = arguments.terrain.options(arguments.exaggeration);
    let surface = Surface::new(dem::read_all(&arguments.terrain.dems, &options, &|_, _| ())?);
    for clause in surface.dem().history().assumed() {
        eprintln!("warning: assumed that {clause}");
    }
    for clause in surface.dem().history().converted() {
        say(&format!("converted: {clause}\n"))?;
    }
    let view = arguments.view.view(&surface, arguments.level)?;
    warn_below_ground(&surface, &view.camera, arguments.level);
    say(&format!("view: {}\n", view.flags()))?;
    if let Some(flag) = view.lonlat_flag() {
        say(&format!("or with: {flag}\n"))?;
    }
    let int64 = if arguments.no_int64 { Int64::Never } else { Int64::IfPresent };
    let gpu = Gpu::open(&arguments.adapter.clone().unwrap_or_default(), int64)?;
    say(&format!("adapter: {}\n", gpu.info.name))?;
    let renderer = Renderer::new(&gpu, &surface, Plan::new(arguments.level, method, arguments.border), size)?;
    renderer.frame(&view.camera)?;
    let frame = renderer.read()?;
    let drawing = ink::draw(&frame.raster, &Style::for_page(view.camera.width));
    let report = outputs.json.is_some().then(|| arguments.report(&gpu, &surface, &renderer, &view, method, &frame));
    outputs.write(&drawing, &frame, report.transpose()?.as_ref())?;
    say(&format!(
        "{}: {} facets, {} of {} pixels inked, {:.2} s\n",
        arguments.output.display(),
        renderer.facets(),
        frame.inked(),
        frame.raster.pixels.len(),
        started.elapsed().as_secs_f64()
    ))
}

impl DrawArguments {
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

    fn report(
        &self,
        gpu: &Gpu,
        surface: &Surface,
        renderer: &Renderer<'_>,
        view: &View,
        method: Method,
        frame: &Frame,
    ) -> Result<Report> {
        let camera = &view.camera;
        let mut times = (0..WARM_FRAMES)
            .map(|_| {
                let start = Instant::now();
                renderer.frame(camera)?;
                Ok(start.elapsed().as_secs_f64() * 1e3)
            })
            .collect::<Result<Vec<_>>>()?;
        times.sort_by(f64::total_cmp);
        let mut left_out = Vec::new();
        let mut leave = |out: bool, what, why, saved| left_out.extend(out.then_some(LeftOut { what, why, saved }));
        let (beside, chunks) = chunks_beside(surface, renderer, camera);
        leave(beside > 0, "chunks", "beside the page", Some(format!("{beside} of {chunks} chunks")));
        leave(self.border == Border::Off, "border pass", "--border off", None);
        leave(surface.dem().voids() == 0, "void tests", "the DEM has no voids", None);
        Ok(Report {
            version: env!("CARGO_PKG_VERSION"),
            dem: DemReport::of(&self.terrain.dems, surface.dem()),
            method: method.name(),
            level: self.level.subdivisions(),
            facets: renderer.facets(),
            inked: frame.inked(),
            longest_walk: frame.longest_walk,
            frame_ms: times[WARM_FRAMES / 2],
            timing: "wall clock around submit and wait, camera to mask, without compose and readback; passes one by one",
            passes: renderer.timed_frame(camera)?,
            adapter: format!("{} ({})", gpu.info.name, gpu.info.driver_info),
            int64: gpu.int64,
            view: view.report(surface.dem().georeference(), self.exaggeration),
            left_out,
        })
    }
}

/// How many chunks lie beside the page's map projection, where nothing of them is computed, and how many there are.
fn chunks_beside(surface: &Surface, renderer: &Renderer<'_>, camera: &Camera) -> (usize, usize) {
    let spheres = spheres(surface, renderer.lattice());
    let eye = camera.eye.truncate() - surface.dem().position(0, 0).truncate();
    let beside = |[x, y, _, radius]: [f64; 4]| {
        let sides = camera.wedge().into_iter().flatten();
        sides.map(|inward| inward.dot(DVec2::new(x, y) - eye)).any(|distance| distance < -radius)
    };
    (spheres.iter().filter(|s| beside(s.map(f64::from))).count(), spheres.len())
}

impl DemReport {
    fn of(files: &[PathBuf], dem: &Dem) -> Self {
        Self {
            files: files.iter().map(|file| file.display().to_string()).collect(),
            columns: dem.columns(),
            rows: dem.rows(),
            cell_m: dem.cell().to_array(),
            extent_m: dem.extent(),
            voids: dem.voids(),
            converted: dem.history().converted().to_vec(),
            assumed: [dem.history().assumed(), dem.history().usual()].concat(),
        }
    }
}

fn warn_below_ground(surface: &Surface, camera: &Camera, level: Level) {
    if let Some(ground) = surface.height_below(camera.eye.truncate(), level)
        && camera.eye.z < ground
    {
        let depth = ground - camera.eye.z;
        eprintln!("warning: the eye is {depth:.1} m below the ground; give --eye E,N,+H to stand above it");
    }
}

/// The files to write, opened before the work starts.
struct Outputs {
    drawing: Output,
    mask: Option<Output>,
    json: Option<Output>,
}

impl Outputs {
    fn open(arguments: &DrawArguments) -> Result<Self> {
        wants_ending("--output", &arguments.output, "png")?;
        if let Some(mask) = &arguments.mask {
            wants_ending("--mask", mask, "png")?;
        }
        let dems = arguments.terrain.dems.iter().map(std::fs::canonicalize);
        let mut taken: Vec<PathBuf> = dems.filter_map(|dem| dem.ok()).collect();
        let mut open = |flag, path: &Path| {
            let output = Output::create(path)?;
            let target = std::path::absolute(output.target()).unwrap_or_else(|_| output.target().to_owned());
            if taken.contains(&target) {
                let what = format!("{} is the DEM or another output", path.display());
                return Err(Error::flag(flag, what, "give each file a name of its own"));
            }
            taken.push(target);
            Ok(output)
        };
        Ok(Self {
            drawing: open("--output", &arguments.output)?,
            mask: arguments.mask.as_deref().map(|path| open("--mask", path)).transpose()?,
            json: arguments.json.as_deref().map(|path| open("--json", path)).transpose()?,
        })
    }

    /// Writes the drawing and, where asked, the mask and the report; names them when all are whole.
    fn write(mut self, drawing: &ink::Drawing, frame: &Frame, report: Option<&Report>) -> Result<()> {
        self.drawing.write(|out| ink::write_png(drawing, out))?;
        if let Some(mask) = &mut self.mask {
            mask.write(|out| ink::write_mask(&frame.raster, out))?;
        }
        if let (Some(json), Some(report)) = (&mut self.json, report) {
            json.write(|out| serde_json::to_writer_pretty(out, report).map_err(std::io::Error::from))?;
        }
        [Some(self.drawing), self.mask, self.json].into_iter().flatten().try_for_each(Output::publish)
    }
}

fn wants_ending(flag: &'static str, path: &Path, ending: &str) -> Result<()> {
    if path.extension().is_some_and(|e| e.eq_ignore_ascii_case(ending)) {
        return Ok(());
    }
    Err(Error::flag(flag, format!("{} does not end in .{ending}", path.display()), format!("name it .{ending}")))
}
