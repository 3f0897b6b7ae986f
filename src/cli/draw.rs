//! `hachure draw`: a DEM as ink on a page.

use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::ValueEnum;
use glam::{DVec2, DVec3};
use serde::Serialize;

use super::say;
use super::values::{self, Eye, EyeHeight, Size};
use crate::dem::{self, ReadOptions};
use crate::error::{Error, Result};
use crate::gpu::sizes::page_fits;
use crate::gpu::{AdapterChoice, Gpu, Int64};
use crate::ink::{self, Output, Style};
use crate::plan::{Border, Method, Plan, Share};
use crate::render::{Frame, PassTime, Renderer};
use crate::surface::bounds::spheres;
use crate::surface::{Level, Surface};
use crate::view::{Camera, Fixed, choose};

/// Warm frames behind the median of `--json`.
const WARM_FRAMES: usize = 9;

/// Flags of `hachure draw`, as typed.
#[derive(Debug, clap::Args)]
pub struct DrawArguments {
    /// The DEM: any raster in projected metres, north up
    dem: PathBuf,
    /// The drawing, a .png
    #[arg(short, long, value_name = "OUT.png")]
    output: PathBuf,
    /// Also the mask: 1 bit a pixel, 0 ink, 255 paper, exactly --size
    #[arg(long, value_name = "OUT.png")]
    mask: Option<PathBuf>,
    /// Also what was done, with times of ten further frames
    #[arg(long, value_name = "OUT.json")]
    json: Option<PathBuf>,

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
pub fn run(arguments: &DrawArguments) -> Result<()> {
    let method = arguments.method()?;
    let size = [arguments.size.width, arguments.size.height];
    page_fits(size)?;
    let outputs = Outputs::open(arguments)?;
    let started = Instant::now();
    let read = ReadOptions { crop: arguments.crop, exaggeration: arguments.exaggeration, ..Default::default() };
    let surface = Surface::new(dem::read(&arguments.dem, &read)?);
    let camera = arguments.camera(&surface)?;
    say(&format!("view: {}\n", view_flags(&camera)))?;
    let int64 = if arguments.no_int64 { Int64::Never } else { Int64::IfPresent };
    let gpu = Gpu::open(&arguments.adapter.clone().unwrap_or_default(), int64)?;
    say(&format!("adapter: {}\n", gpu.info.name))?;
    let renderer = Renderer::new(&gpu, &surface, Plan::new(arguments.level, method, arguments.border), size)?;
    renderer.frame(&camera)?;
    let frame = renderer.read()?;
    let drawing = ink::draw(&frame.raster, &Style::for_page(camera.width));
    let report = outputs.json.is_some().then(|| arguments.report(&gpu, &surface, &renderer, &camera, method, &frame));
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

    /// The camera as asked, or as chosen. Warns of an eye below the ground.
    fn camera(&self, surface: &Surface) -> Result<Camera> {
        let eye = self.eye.map(|eye| self.world_eye(surface, eye)).transpose()?;
        let fixed = Fixed { eye, azimuth: self.azimuth, altitude: self.altitude };
        let camera = choose(surface.dem(), fixed, self.fov, self.size.width, self.size.height);
        if let Some(ground) = surface.height_below(camera.eye.truncate(), self.level)
            && camera.eye.z < ground
        {
            let depth = ground - camera.eye.z;
            eprintln!("warning: the eye is {depth:.1} m below the ground; give --eye E,N,+H to stand above it");
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
        let mut left_out = Vec::new();
        let mut leave = |out: bool, what, why, saved| left_out.extend(out.then_some(LeftOut { what, why, saved }));
        let (beside, chunks) = chunks_beside(surface, renderer, camera);
        leave(beside > 0, "chunks", "beside the page", Some(format!("{beside} of {chunks} chunks")));
        leave(self.border == Border::Off, "border pass", "--border off", None);
        leave(surface.dem().voids() == 0, "void tests", "the DEM has no voids", None);
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

/// The flags that repeat a view.
fn view_flags(camera: &Camera) -> String {
    let DVec3 { x, y, z } = camera.eye;
    let Camera { azimuth, altitude, fov, width, height, .. } = camera;
    format!("--eye {x},{y},{z} --azimuth {azimuth} --altitude {altitude} --fov {fov} --size {width}x{height}")
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
        let dem = std::fs::canonicalize(&arguments.dem).ok();
        let mut taken: Vec<PathBuf> = dem.into_iter().collect();
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
