//! `hachure draw`: a DEM as ink on a page.

use std::panic::resume_unwind;
use std::sync::Arc;
use std::thread;
use std::time::Instant;

use super::cache::CacheArguments;
use super::device::DeviceArguments;
use super::draw_report::{ChainsReport, DemReport, LayerReport, LeftOutReport, PageReport, Report};
use super::flat_earth::FlatEarth;
use super::outputs::OutputArguments;
use super::page::{Layout, PageArguments};
use super::style::StyleArguments;
use super::talk::Talk;
use super::terrain::{TerrainArguments, warn_of_survey};
use super::values::{self, LevelChoice, Size};
use super::view_report::ViewReport;
use super::viewpoint::{SIZE, View, ViewArguments};
use super::words::told;
use super::{blank, cells, choices, journey, plan};
use crate::cache::Cache;
use crate::error::{Error, Result, Setting};
use crate::files::Taken;
use crate::geo::Reading;
use crate::gpu::Gpu;
use crate::ink::{self, Drawing, Style};
use crate::line::Lines;
use crate::plan::detail::ERROR_PX;
use crate::plan::left_out::LeftOut;
use crate::plan::{Border, Curves, Detail, Frame, Method, Plan, Share};
use crate::render::{Page, PassTime, Renderer};
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
    pub(super) terrain: TerrainArguments,
    #[command(flatten)]
    pub(super) outputs: OutputArguments,

    #[command(flatten)]
    view: ViewArguments,
    /// Draw the land from straight above instead, true to scale: the page is the DEM, or its part, at that scale
    #[arg(
        long, requires = "scale", help_heading = "View",
        conflicts_with_all = [
            "standpoint", "look_at", "crs", "north", "azimuth", "altitude", "fov", "size", "exaggeration", "level", "error_px",
            "method", "wide", "share", "border", "page", "landscape", "hidden", "split", "min_jump", "min_gap", "explain", "adapter",
        ]
    )]
    plan: bool,
    /// With --plan: so many millimetres of land for one of the page
    #[arg(long, value_name = "1:N", value_parser = values::scale, requires = "plan", help_heading = "View")]
    scale: Option<f64>,

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
    #[arg(long, value_parser = choices::family(), default_value = Method::default().entry().family, help_heading = "Method")]
    method: Method,
    /// toward-away only: away surface counts wherever it touches the pixel or the neighbour it is compared with
    #[arg(long, help_heading = "Method")]
    wide: bool,
    #[arg(
        long, value_parser = choices::share(), help_heading = "Method",
        help = format!("adjacency only: what neighbouring facets share [default: {}]", choices::default_share())
    )]
    share: Option<Share>,
    /// Whether to draw the visible border of the DEM and of its voids
    #[arg(long, value_parser = choices::border(), default_value = choices::default_border(), help_heading = "Method")]
    border: Border,

    #[command(flatten)]
    pub(super) page: PageArguments,
    #[command(flatten)]
    pub(super) style: StyleArguments,

    /// Say at which levels parts of the DEM are drawn, what the frame did without, why, and what that saved
    #[arg(long)]
    explain: bool,
    #[command(flatten)]
    device: DeviceArguments,
    #[command(flatten)]
    pub(super) cache: CacheArguments,
}

/// A DEM on a device, and its page as seen from somewhere.
struct Drawn<'a> {
    renderer: &'a mut Renderer,
    view: &'a View,
    page: Page,
}

/// Its lines, and their drawing on a sheet.
struct Stroked {
    style: Style,
    lines: Lines,
    drawing: Drawing,
    layout: Layout,
}

/// Draws.
///
/// # Errors
/// Whatever went wrong; nothing stands under a final name then.
pub fn run(arguments: &DrawArguments, talk: &Talk) -> Result<()> {
    if let Some(scale) = arguments.scale {
        return plan::run(arguments, scale, talk);
    }
    let plan = arguments.check()?;
    let (style, layout) = (arguments.style.style()?, arguments.layout()?);
    let started = Instant::now();
    let cache = arguments.cache.cache();
    let reading = arguments.terrain.open(&arguments.terrain.dems, arguments.exaggeration, cache.clone())?;
    let mut outputs = arguments.outputs.open(Taken::inputs(reading.files()))?;
    let surface = Arc::new(arguments.surface(reading, talk)?);
    let gpu = arguments.prepare(&surface, &cache, talk)?;
    let view = arguments.look(&surface, layout.frame, talk)?;
    let gpu = Arc::new(gpu?);
    DeviceArguments::tell(&gpu, talk)?;
    talk.progress("drawing", 0.3);
    let mut renderer = Renderer::new(gpu, surface.clone())?;
    let page = renderer.page(&plan, &view.camera, |share| talk.progress("drawing", 0.3 + 0.3 * share))?;
    cache.discard_damaged(surface.dem(), &|message| talk.warn(&told(message)));
    let mut drawn = Drawn { renderer: &mut renderer, view: &view, page };
    let stroked = arguments.stroked(&drawn, style, layout)?;
    let report = outputs.want_report().then(|| arguments.report(&mut drawn, &stroked, talk)).transpose()?;
    if arguments.explain || talk.is_verbose() {
        explain(talk, &drawn.page.frame, &surface, report.as_ref())?;
    }
    talk.progress("writing", 0.8);
    outputs.write(&stroked.drawing, layout.px_per_mm, Some(&drawn.page), report.as_ref())?;
    surface.dem().check()?;
    talk.progress("writing", 1.0);
    outputs.publish()?;
    journey::tell(&stroked.drawing, &stroked.style.plot, talk)?;
    arguments.tell(&drawn, started, talk)?;
    let Drawn { page, .. } = drawn;
    if stroked.drawing.layers.is_empty() && page.marks.inked() > 0 {
        talk.warn("nothing is drawn: the style leaves no stroke of the lines; give it finer pens, or --min-gap 0 --min-jump 0");
    }
    blank::warn(&mut renderer, &view, arguments.level, &page, talk);
    Ok(())
}

impl DrawArguments {
    /// Whether one of the files is standard output.
    pub fn fill_stdout(&self) -> bool {
        self.outputs.fill_stdout()
    }

    /// What is to be drawn, if the flags go together.
    fn check(&self) -> Result<Plan> {
        let (method, detail) = (self.method()?, self.detail()?);
        self.view.check()?;
        self.outputs.check()?;
        // Strokes of the walk's mask are contours.
        let curves = match (self.style.draws_hidden(), method) {
            (true, Method::Walk | Method::Contour) => Curves::All,
            (_, Method::Walk) => Curves::On,
            _ => Curves::Off,
        };
        let plan = Plan { curves, ..Plan::new(detail, method, self.border) };
        if !plan.has_curves() {
            self.style.refuse_for_traced()?;
        }
        Ok(plan)
    }

    /// Reads the DEM and finds its normals.
    fn surface(&self, reading: Reading, talk: &Talk) -> Result<Surface> {
        let dem = self.terrain.read(reading, talk)?;
        // The renderer holds all samples on the device.
        talk.progress("computing normals", 0.1);
        if !dem.is_filed() {
            dem.check_patches()?;
        }
        Ok(Surface::new(dem))
    }

    /// Looks at the samples of a DEM that stays in its file, while the device opens: drivers take their time to start. What
    /// opening comes to is told after all that is said of the DEM and its view.
    fn prepare(&self, surface: &Surface, cache: &Cache, talk: &Talk) -> Result<Result<Gpu>> {
        let prepare = || {
            cache.prepare(surface, &|message| talk.warn(&told(message)), &|done| {
                talk.progress("looking at every sample, once for this file", 0.1 + 0.1 * done);
            })
        };
        // Samples stay on this thread, where HDF5 keeps silent.
        let (prepared, gpu) = thread::scope(|scope| {
            let open = || self.device.open_silently(wgpu::Features::empty());
            match thread::Builder::new().spawn_scoped(scope, open) {
                Ok(gpu) => (prepare(), gpu.join().unwrap_or_else(|panic| resume_unwind(panic))),
                // The system has no thread left.
                Err(_) => (prepare(), open()),
            }
        });
        prepared?;
        surface.dem().check_patches()?;
        Ok(gpu)
    }

    /// The view, told as flags that repeat it, and what is to be said of it and of the DEM.
    fn look(&self, surface: &Surface, frame: Size, talk: &Talk) -> Result<View> {
        cells::warn(surface.dem(), self.exaggeration, talk);
        warn_of_survey(surface.dem(), talk)?;
        let view = self.view.sized(frame).view(surface, self.level.near())?;
        view.warn_below_ground(surface, self.level.near(), talk);
        let page = self.page.flags();
        talk.say(&format!("view: {}{page}", view.flags()))?;
        view.lonlat_flags().map_or(Ok(()), |flags| talk.say(&format!("or with: {flags}{page}")))?;
        view.norths.words().map_or(Ok(()), |words| talk.say(&words))?;
        Ok(view)
    }

    /// How the page is laid out.
    fn layout(&self) -> Result<Layout> {
        let layout = self.page.layout(self.view.typed_size(), SIZE)?;
        if self.outputs.want_picture() {
            layout.check_picture()?;
        }
        Ok(layout)
    }

    fn detail(&self) -> Result<Detail> {
        if self.error_px.is_some() && self.level != LevelChoice::Auto {
            return Err(Error::setting(Setting::ErrorPx, "goes with --level auto only", "leave one of them out"));
        }
        Ok(self.level.detail(self.error_px.unwrap_or(ERROR_PX)))
    }

    /// The variant of the method that further flags ask for.
    fn method(&self) -> Result<Method> {
        if self.wide && !matches!(self.method, Method::TowardAway { .. }) {
            return Err(Error::setting(Setting::Wide, "goes with toward-away only", "add --method toward-away"));
        }
        if self.share.is_some() && !matches!(self.method, Method::Adjacency { .. }) {
            return Err(Error::setting(Setting::Share, "goes with adjacency only", "add --method adjacency"));
        }
        Ok(match self.method {
            Method::TowardAway { .. } => Method::TowardAway { wide: self.wide },
            Method::Adjacency { .. } => Method::Adjacency { share: self.share.unwrap_or_default() },
            plain => plain,
        })
    }

    /// The drawing of the page: of contours as sparingly as is asked, or traced from the mask.
    fn stroked(&self, drawn: &Drawn, style: Style, layout: Layout) -> Result<Stroked> {
        let marks = &drawn.page.marks;
        let px_per_mm = layout.sheet.placement([marks.width, marks.height]).px_per_mm;
        let (tolerance, page) = (style.tolerance * px_per_mm, &drawn.page);
        let lines = match page.frame.plan.has_curves() {
            true => drawn.renderer.lines(page, &self.style.economy(&style, px_per_mm), tolerance),
            false => Lines::of(marks, &drawn.renderer.perspective(&page.frame), tolerance),
        };
        let drawing = ink::draw(&lines, &layout.sheet, &style, self.style.split())?;
        Ok(Stroked { style, lines, drawing, layout })
    }

    /// Times more frames and says what was done.
    fn report(&self, drawn: &mut Drawn, stroked: &Stroked, talk: &Talk) -> Result<Report> {
        talk.progress("timing more frames", 0.6);
        let flat_earth = drawn.flat_earth();
        let Drawn { renderer, view, page } = drawn;
        let Frame { plan, camera, pieces, .. } = &page.frame;
        let (gpu, surface) = (renderer.gpu().clone(), renderer.surface().clone());
        let pieces = pieces.iter().len();
        let warm_frames = if pieces == 1 { WARM_FRAMES } else { 1 };
        let mut times = (0..warm_frames).map(|_| renderer.time_of_frame(plan, camera)).collect::<Result<Vec<_>>>()?;
        times.sort_by(f64::total_cmp);
        Ok(Report {
            version: env!("CARGO_PKG_VERSION"),
            dem: DemReport::of(&self.terrain.dems, surface.dem()),
            method: plan.method.entry().family,
            level: self.detail()?.into(),
            facets: page.frame.facets(&surface),
            inked: page.marks.inked(),
            chains: plan.has_curves().then(|| ChainsReport::of(page)),
            without_stroke: ink::unstroked(&page.marks, &stroked.lines, &stroked.drawing),
            page: PageReport::of(&stroked.layout),
            layers: LayerReport::all(&stroked.drawing, &stroked.style.plot),
            covered: page.covered,
            longest_walk: page.longest_walk,
            pieces,
            warm_frames,
            frame_ms: times[warm_frames / 2],
            timing: gpu.clock.describe(),
            passes: renderer.timed_frame(plan, camera)?.passes,
            adapter: format!("{} ({})", gpu.info.name, gpu.info.driver_info),
            int64: gpu.int64,
            view: ViewReport::of(view, surface.dem().georeference(), self.exaggeration),
            flat_earth,
            left_out: page.frame.left_out(&surface)?.into_iter().map(LeftOutReport::of).collect(),
        })
    }

    /// The last line: what was drawn, and how long it took.
    fn tell(&self, drawn: &Drawn, started: Instant, talk: &Talk) -> Result<()> {
        let Drawn { renderer, view, page, .. } = drawn;
        drawn.flat_earth().map_or(Ok(()), |flat_earth| talk.say(&flat_earth.words()))?;
        talk.say(&format!(
            "{}: {} facets, {} of {} pixels inked, {:.2} s",
            self.outputs.drawing(),
            page.frame.facets(renderer.surface()),
            page.marks.inked(),
            u64::from(view.camera.width) * u64::from(view.camera.height),
            started.elapsed().as_secs_f64()
        ))
    }
}

impl Drawn<'_> {
    /// Where the DEM lies on Earth.
    fn flat_earth(&self) -> Option<FlatEarth> {
        let Self { renderer, view, page, .. } = self;
        view.is_on_earth().then(|| FlatEarth::of(&page.marks, &view.camera, renderer.near()))?
    }
}

/// Says at which levels chunks are, what was left out and, where they were taken, the times.
fn explain(talk: &Talk, frame: &Frame, surface: &Surface, report: Option<&Report>) -> Result<()> {
    talk.say(&format!("chunks: {}", frame.levels()))?;
    for LeftOut { what, why, saved } in frame.left_out(surface)? {
        let saved = saved.as_ref().map_or(String::new(), |saved| format!(" ({saved})"));
        talk.say(&format!("left out: {what}, {}{saved}", told(&why)))?;
    }
    for PassTime { name, ms } in report.iter().flat_map(|report| &report.passes) {
        talk.say(&format!("pass {name}: {ms:.2} ms"))?;
    }
    report.map_or(Ok(()), |report| talk.say(&format!("median frame: {:.2} ms", report.frame_ms)))
}
