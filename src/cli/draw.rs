//! `hachure draw`: a DEM as ink on a page.

use std::path::PathBuf;
use std::time::Instant;

use clap::ValueEnum;
use glam::{DVec2, DVec3};
use serde::Serialize;

use super::outputs::OutputArguments;
use super::talk::Talk;
use super::values::{self, Eye, EyeHeight, Size};
use crate::dem::{self, ReadOptions};
use crate::error::{Error, Result};
use crate::gpu::sizes::page_fits;
use crate::gpu::{AdapterChoice, Gpu, Int64};
use crate::ink::{self, Style};
use crate::plan::{Border, Method, Plan, Share};
use crate::render::{Frame, PassTime, Renderer};
use crate::surface::bounds::spheres;
use crate::surface::{Level, Surface};
use crate::view::{Camera, Fixed, choose};

/// Warm frames behind the median of `--json`.
const WARM_FRAMES: usize = 9;

/// The end of `hachure draw --help`.
const EXAMPLES: &str = "\
Examples:
  A view that shows the relief is chosen, and printed as flags that repeat it:
  hachure draw dem/golden-gate.tif -o golden-gate.png

  From 300 m above the ground, heights doubled, looking north-west:
  hachure draw dem/golden-gate.tif -o golden-gate.png --exaggeration 2 \\
      --eye 547500,4183300,+300 --azimuth 318 --altitude -6 --fov 50 --size 1600x700

  The mask alone, to another program, and what was done, to a file:
  hachure draw dem/golden-gate.tif -o golden-gate.png --json golden-gate.json --mask - | wc -c";

/// Flags of `hachure draw`, as typed.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct DrawArguments {
    /// The DEM: any raster in projected metres, north up
    dem: PathBuf,
    #[command(flatten)]
    outputs: OutputArguments,

    /// Eye: easting, northing in metres in the CRS of the DEM; exaggerated height in metres, or +H above the ground
    #[arg(long, value_name = "E,N,Z|E,N,+H", value_parser = values::eye, allow_hyphen_values = true, help_heading = "View")]
    eye: Option<Eye>,
    /// Direction of view, degrees clockwise from grid north [default: towards the middle of the DEM]
    #[arg(long, value_name = "DEG", value_parser = values::azimuth, allow_hyphen_values = true, help_heading = "View")]
    azimuth: Option<f64>,
    /// Direction of view, degrees above the horizon, -90 to 90 [default: 0 from a given eye]
    #[arg(long, value_name = "DEG", value_parser = values::altitude, allow_hyphen_values = true, help_heading = "View")]
    altitude: Option<f64>,
    /// Horizontal field of view, degrees
    #[arg(long, value_name = "DEG", value_parser = values::fov, allow_hyphen_values = true, default_value = "60", help_heading = "View")]
    fov: f64,
    /// Pixels across and down
    #[arg(long, value_name = "WxH", value_parser = values::size, default_value = "1920x1080", help_heading = "View")]
    size: Size,

    /// Draw a part only: west, south, east, north in metres in the CRS of the DEM
    #[arg(long, value_name = "E0,N0,E1,N1", value_parser = values::crop, allow_hyphen_values = true, help_heading = "Surface")]
    crop: Option<[f64; 4]>,
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
    dem: String,
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

#[derive(Serialize)]
struct ViewReport {
    eye: [f64; 3],
    azimuth: f64,
    altitude: f64,
    fov: f64,
    size: [u32; 2],
    projection: &'static str,
    crs: String,
    flags: String,
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
pub fn run(arguments: &DrawArguments, talk: &Talk) -> Result<()> {
    let method = arguments.method()?;
    let size = [arguments.size.width, arguments.size.height];
    page_fits(size)?;
    let mut outputs = arguments.outputs.open(std::slice::from_ref(&arguments.dem))?;
    let started = Instant::now();
    talk.progress("reading the DEM", 0.0);
    let read = ReadOptions { crop: arguments.crop, exaggeration: arguments.exaggeration };
    let surface = Surface::new(dem::read(&arguments.dem, &read)?);
    let camera = arguments.camera(&surface, talk)?;
    talk.say(&format!("view: {}", view_flags(&camera)))?;
    talk.progress("opening the adapter", 0.2);
    let int64 = if arguments.no_int64 { Int64::Never } else { Int64::IfPresent };
    let gpu = Gpu::open(&arguments.adapter.clone().unwrap_or_default(), int64)?;
    talk.say(&format!("adapter: {}", gpu.info.name))?;
    talk.detail(&format!("driver: {} {}", gpu.info.driver, gpu.info.driver_info))?;
    talk.progress("drawing", 0.4);
    let renderer = Renderer::new(&gpu, &surface, Plan::new(arguments.level, method, arguments.border), size)?;
    renderer.frame(&camera)?;
    let frame = renderer.read()?;
    let drawing = ink::draw(&frame.raster, &Style::for_page(camera.width));
    let report = || {
        talk.progress("timing ten more frames", 0.6);
        arguments.report(&gpu, &surface, &renderer, &camera, method, &frame)
    };
    let report = outputs.want_report().then(report).transpose()?;
    if talk.is_verbose() {
        explain(talk, &arguments.left_out(&surface, &renderer, &camera), report.as_ref())?;
    }
    talk.progress("writing", 0.8);
    outputs.write(&drawing, &frame, report.as_ref())?;
    talk.progress("writing", 1.0);
    outputs.publish()?;
    talk.say(&format!(
        "{}: {} facets, {} of {} pixels inked, {:.2} s",
        arguments.outputs.drawing().display(),
        renderer.facets(),
        frame.inked(),
        frame.raster.pixels.len(),
        started.elapsed().as_secs_f64()
    ))
}

impl DrawArguments {
    /// Whether one of the files is standard output.
    pub fn fill_stdout(&self) -> bool {
        self.outputs.fill_stdout()
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

    /// The camera as asked, or as chosen. Warns of an eye below the ground.
    fn camera(&self, surface: &Surface, talk: &Talk) -> Result<Camera> {
        let eye = self.eye.map(|eye| self.world_eye(surface, eye)).transpose()?;
        let fixed = Fixed { eye, azimuth: self.azimuth, altitude: self.altitude };
        let camera = choose(surface.dem(), fixed, self.fov, self.size.width, self.size.height);
        if let Some(ground) = surface.height_below(camera.eye.truncate(), self.level)
            && camera.eye.z < ground
        {
            let depth = ground - camera.eye.z;
            talk.warn(&format!("the eye is {depth:.1} m below the ground; give --eye E,N,+H to stand above it"));
        }
        Ok(camera)
    }

    fn world_eye(&self, surface: &Surface, eye: Eye) -> Result<DVec3> {
        match eye.height {
            EyeHeight::Absolute(z) => Ok(eye.place.extend(z)),
            EyeHeight::AboveGround(h) => {
                let ground = surface.height_below(eye.place, self.level).ok_or_else(|| {
                    let [west, south, east, north] = surface.dem().extent();
                    Error::flag(
                        "--eye",
                        format!("there is no ground at {},{}", eye.place.x, eye.place.y),
                        format!(
                            "give a height without +, or a place with data between {west},{south} and {east},{north}"
                        ),
                    )
                })?;
                Ok(eye.place.extend(ground + h))
            }
        }
    }

    fn report(
        &self,
        gpu: &Gpu,
        surface: &Surface,
        renderer: &Renderer<'_>,
        camera: &Camera,
        method: Method,
        frame: &Frame,
    ) -> Result<Report> {
        let mut times = (0..WARM_FRAMES)
            .map(|_| {
                let start = Instant::now();
                renderer.frame(camera)?;
                Ok(start.elapsed().as_secs_f64() * 1e3)
            })
            .collect::<Result<Vec<_>>>()?;
        times.sort_by(f64::total_cmp);
        Ok(Report {
            version: env!("CARGO_PKG_VERSION"),
            dem: self.dem.display().to_string(),
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
            view: ViewReport {
                eye: camera.eye.to_array(),
                azimuth: camera.azimuth,
                altitude: camera.altitude,
                fov: camera.fov,
                size: [camera.width, camera.height],
                projection: "central, square pixels, horizontal fov",
                crs: surface.dem().crs().to_owned(),
                flags: view_flags(camera),
            },
            left_out: self.left_out(surface, renderer, camera),
        })
    }

    /// What the frame did without.
    fn left_out(&self, surface: &Surface, renderer: &Renderer<'_>, camera: &Camera) -> Vec<LeftOut> {
        let mut left_out = Vec::new();
        let mut leave = |out: bool, what, why, saved| left_out.extend(out.then_some(LeftOut { what, why, saved }));
        let (beside, chunks) = chunks_beside(surface, renderer, camera);
        leave(beside > 0, "chunks", "beside the page", Some(format!("{beside} of {chunks} chunks")));
        leave(self.border == Border::Off, "border pass", "--border off", None);
        leave(surface.dem().voids() == 0, "void tests", "the DEM has no voids", None);
        left_out
    }
}

/// Says what was left out and, where they were taken, the times.
fn explain(talk: &Talk, left_out: &[LeftOut], report: Option<&Report>) -> Result<()> {
    for LeftOut { what, why, saved } in left_out {
        let saved = saved.as_ref().map_or(String::new(), |saved| format!(" ({saved})"));
        talk.detail(&format!("left out: {what}, {why}{saved}"))?;
    }
    for PassTime { name, ms } in report.iter().flat_map(|report| &report.passes) {
        talk.detail(&format!("pass {name}: {ms:.2} ms"))?;
    }
    report.map_or(Ok(()), |report| talk.detail(&format!("median frame: {:.2} ms", report.frame_ms)))
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

/// The flags that repeat a view.
fn view_flags(camera: &Camera) -> String {
    let DVec3 { x, y, z } = camera.eye;
    let Camera { azimuth, altitude, fov, width, height, .. } = camera;
    format!("--eye {x},{y},{z} --azimuth {azimuth} --altitude {altitude} --fov {fov} --size {width}x{height}")
}
