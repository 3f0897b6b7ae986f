//! `hachure draw`: a DEM as ink on a page.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use super::cache::CacheArguments;
use super::device::DeviceArguments;
use super::draw_report::{ChainsReport, DemReport, LayerReport, LeftOutReport, PageReport, Report};
use super::drawing::{DrawingArguments, Wanted};
use super::flat_earth::FlatEarth;
use super::folds::{FoldsInView, FoldsReport};
use super::outputs::OutputArguments;
use super::talk::Talk;
use super::terrain::TerrainArguments;
use super::values;
use super::view_report::ViewReport;
use super::viewpoint::{View, ViewArguments};
use super::words::told;
use super::{bare, blank, furniture, georeferenced, journey, plan, reference, scene};
use crate::cache::Cache;
use crate::error::{Error, Result, Setting};
use crate::files::Taken;
use crate::geo::Reading;
use crate::ink::{self, Drawing};
use crate::job::Content;
use crate::job::name::Naming;
use crate::line::Lines;
use crate::message;
use crate::plan::Frame;
use crate::plan::left_out::LeftOut;
use crate::render::{Illustration, Page, PassTime, Renderer};
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
  hachure draw N37W123.hgt N38W123.hgt -o bay.png --lonlat -122.47,37.786,+400 \\
      --crs EPSG:4326 --look-at -122.6,37.924

  The mask alone, to another program, and what was done, to a file:
  hachure draw dem/golden-gate.tif -o golden-gate.png --json golden-gate.json --mask - | wc -c";

/// Flags of `hachure draw`, as typed.
#[derive(Debug, Clone, clap::Args)]
#[command(after_help = EXAMPLES, after_long_help = reference::of(&[reference::DRAWN, EXAMPLES]))]
pub(crate) struct DrawArguments {
    #[command(flatten)]
    pub(super) terrain: TerrainArguments,
    #[command(flatten)]
    pub(super) outputs: OutputArguments,

    #[command(flatten)]
    view: ViewArguments,
    /// Draw the land from straight above instead, true to scale: its rims and lines on it; the page is the DEM, or its part, at that
    /// scale
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

    #[command(flatten)]
    pub(super) drawing: DrawingArguments,
    /// What a plan shows, metres of the world: west, south, east, north; all of the DEM where nobody says.
    #[arg(skip)]
    pub(super) area: Option<[f64; 4]>,

    /// Say at which levels parts of the DEM are drawn, what the frame did without, why, and what that saved
    #[arg(long)]
    explain: bool,
    #[command(flatten)]
    device: DeviceArguments,
    #[command(flatten)]
    pub(super) cache: CacheArguments,
}

/// A DEM on a device, and its page as seen from somewhere.
struct DrawnPage<'a> {
    renderer: &'a mut Renderer,
    view: &'a View,
    page: Page,
}

/// Its lines, and their drawing.
#[derive(Clone, Copy)]
struct Stroked<'a> {
    illustration: &'a Illustration,
    lines: &'a Lines,
    drawing: &'a Drawing,
}

/// Draws.
///
/// # Errors
/// Whatever went wrong; nothing stands under a final name then.
pub(crate) fn run(arguments: &DrawArguments, talk: &Talk) -> Result<()> {
    if let Some(scale) = arguments.scale() {
        return plan::run(arguments, scale, talk);
    }
    let illustration = arguments.check()?;
    arguments.drawing.left_out_of_style()?.into_iter().for_each(|words| talk.warn(&words));
    let started = Instant::now();
    let cache = arguments.cache.cache();
    let (reading, beside) = (arguments.open(cache.clone())?, arguments.drawing.land.lines.files());
    let mut outputs =
        arguments.outputs.open(Taken::inputs(reading.files().chain(beside.iter().map(PathBuf::as_path))))?;
    let surface = Arc::new(scene::surface(&arguments.terrain, reading, &cache, talk)?);
    let map = outputs.map_format().map(|format| georeferenced::crs(format, surface.dem())).transpose()?;
    let gpu = scene::prepare_and_open(&surface, &cache, &arguments.device, talk)?;
    let view = arguments.look(&surface, &illustration, talk)?;
    let furniture = arguments.furniture(&illustration, &view, &surface)?;
    let land = scene::land(&arguments.drawing, &illustration.land, &arguments.terrain, &surface, &cache, talk)?;
    let gpu = Arc::new(gpu?);
    DeviceArguments::tell(&gpu, talk)?;
    talk.progress("drawing", 0.3);
    let mut renderer = Renderer::new(gpu, surface.clone())?;
    renderer.set_land(land.clone());
    let page = renderer.page(&illustration.plan, &view.camera, |share| talk.progress("drawing", 0.3 + 0.3 * share))?;
    cache.discard_damaged(surface.dem(), &|message| talk.warn(&told(message)));
    let mut drawn = DrawnPage { renderer: &mut renderer, view: &view, page };
    let (lines, mut drawing) = illustration.drawing(&drawn.page)?;
    let is_bare = drawing.layers.is_empty();
    furniture.onto(&mut drawing, &illustration.style);
    let stroked = Stroked { illustration: &illustration, lines: &lines, drawing: &drawing };
    let folds = FoldsInView::of(&surface, &drawn.page)?;
    let report = outputs.want_report().then(|| arguments.report(&mut drawn, stroked, folds, talk)).transpose()?;
    if arguments.explain || talk.is_verbose() {
        explain(talk, &drawn.page.frame, &surface, report.as_ref())?;
    }
    talk.progress("writing", 0.8);
    outputs.write(&drawing, illustration.px_per_mm, Some(&drawn.page), report.as_ref())?;
    if let Some(crs) = map {
        let exaggeration = arguments.drawing.exaggeration;
        let lines = georeferenced::lines(&lines, land.as_deref(), &surface, exaggeration, &crs)?;
        outputs.write_map(&crs, &lines)?;
    }
    surface.dem().check()?;
    talk.progress("writing", 1.0);
    outputs.publish()?;
    journey::tell(&drawing, &illustration.style.plot, talk)?;
    arguments.tell(&drawn, started, talk)?;
    let DrawnPage { page, .. } = drawn;
    if is_bare && page.marks.inked() > 0 {
        talk.warn("nothing is drawn: the style leaves no stroke of the lines; give it finer pens, or --min-gap 0 --min-jump 0");
    }
    arguments.warn_of_page(&mut renderer, &view, &page, folds, talk);
    Ok(())
}

impl DrawArguments {
    /// Whether one of the files is standard output.
    pub(crate) fn fill_stdout(&self) -> bool {
        self.outputs.fill_stdout()
    }

    /// The same of a sheet of a map, which is `called` so, with its `name` for the `mark` in texts: of the DEM in `crop`, in the file's coordinates, or all of it; a plan is of `area`,
    /// metres of the world; its files are `renamed`.
    ///
    /// # Errors
    /// Those of `renamed`; [`Error::Setting`] where there is a crop already.
    pub(crate) fn of_sheet(
        &self,
        called: &str,
        [mark, name]: [&str; 2],
        crop: Option<[f64; 4]>,
        area: [f64; 4],
        renamed: impl Fn(&Path) -> Result<PathBuf>,
    ) -> Result<Self> {
        let terrain = crop.map_or_else(|| Ok(self.terrain.clone()), |crop| self.terrain.cropped(crop))?;
        let outputs = self.outputs.renamed(renamed)?;
        let mut sheet = Self { terrain, outputs, area: Some(area), ..self.clone() };
        sheet.drawing.land.lines.on_sheet(called);
        sheet.drawing.furniture.on_sheet(mark, name);
        Ok(sheet)
    }

    /// The scale of a plan, where one is drawn.
    pub(crate) fn scale(&self) -> Option<f64> {
        self.scale.filter(|_| self.plan)
    }

    /// Opens the DEM.
    ///
    /// # Errors
    /// As [`TerrainArguments::open`].
    pub(crate) fn open(&self, cache: Cache) -> Result<Reading> {
        self.terrain.open(&self.terrain.dems, self.drawing.exaggeration, cache)
    }

    /// What the DEM is read of, and how: the same for drawings of one surface.
    pub(crate) fn scene(&self) -> String {
        format!("{:?} {} {}", self.terrain.dems, self.terrain.read_as(), self.drawing.exaggeration)
    }

    /// The names of all that the drawing and its mask are made of, of a DEM that holds this.
    ///
    /// # Errors
    /// As [`Self::check`] and [`plan::check`].
    pub(crate) fn names(&self, dem: &Content) -> Result<[u128; 2]> {
        let naming = Naming::new().with("dem", dem.hash()).with("read", self.terrain.read_as());
        if let Some(scale) = self.scale() {
            let of = format!("{scale} {:?} {:?} {:?}", self.area, self.drawing.page, plan::check(self)?);
            return Ok([naming.with("plan", of).with("furniture", self.furnished()).name(); 2]);
        }
        let illustration = self.check()?;
        let seen = naming.with("view", format!("{:?} {}", self.view, self.drawing.exaggeration));
        let of_mask = seen.clone().with("mask", illustration.of_mask());
        let of_drawing = seen.with("drawing", format!("{illustration:?}")).with("furniture", self.furnished());
        Ok([of_drawing.name(), of_mask.name()])
    }

    /// What stands around the picture, in words: with the names of the files, where these are told.
    fn furnished(&self) -> String {
        let furniture = self.drawing.furniture.furniture();
        let names = furniture.credits.is_some().then_some(&self.terrain.dems);
        format!("{furniture:?} {names:?}")
    }

    /// What stands around the picture of a view, set on its sheet.
    ///
    /// # Errors
    /// [`Error::Setting`] for a text that does not fit, or holds letters that no font has.
    pub(crate) fn furniture(
        &self,
        illustration: &Illustration,
        view: &View,
        surface: &Surface,
    ) -> Result<ink::furniture::Set> {
        let texts = furniture::of_view(view, self.drawing.exaggeration, &self.terrain.dems, surface.dem());
        self.drawing.furniture.furniture().set(&illustration.sheet, &illustration.style, &texts)
    }

    /// Warns where a page of it, or land that is to be hatched, is blank, and where much folds over.
    pub(crate) fn warn_of_page(
        &self,
        renderer: &mut Renderer,
        view: &View,
        page: &Page,
        folds: FoldsInView,
        talk: &Talk,
    ) {
        folds.warning().into_iter().for_each(|words| talk.warn(&words));
        page.bare.into_iter().for_each(|bare| talk.warn(&bare::of_view(bare)));
        blank::warn(renderer, view, self.drawing.level, page, talk);
    }

    /// How it is to be drawn, if the flags go together.
    ///
    /// # Errors
    /// [`Error::Setting`]; as [`styles::find`](crate::ink::styles::find).
    pub(crate) fn check(&self) -> Result<Illustration> {
        if self.scale.is_some() {
            return Err(Error::setting(Setting::Scale, "goes with a plan only", message!["add ", Setting::Plan]));
        }
        self.drawing.plan(Wanted::Drawing)?;
        self.view.check()?;
        self.outputs.check()?;
        let (size, remote) = (self.view.typed_size(), self.terrain.allows_remote());
        self.drawing.illustration(size, Wanted::Drawing, self.outputs.want_picture(), remote)
    }

    /// The view, told as flags that repeat it, and what is to be said of it and of the DEM.
    ///
    /// # Errors
    /// As [`ViewArguments::view`].
    pub(crate) fn look(&self, surface: &Surface, illustration: &Illustration, talk: &Talk) -> Result<View> {
        scene::look(&self.view, &self.drawing, surface, illustration.frame, talk)
    }

    /// Times more frames and says what was done.
    fn report(&self, drawn: &mut DrawnPage, stroked: Stroked, folds: FoldsInView, talk: &Talk) -> Result<Report> {
        talk.progress("timing more frames", 0.6);
        let Stroked { illustration, lines, drawing } = stroked;
        let flat_earth = drawn.flat_earth();
        let DrawnPage { renderer, view, page } = drawn;
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
            level: plan.detail.into(),
            facets: page.frame.facets(&surface),
            folds: FoldsReport::of(&surface, folds, self.drawing.exaggeration)?,
            inked: page.marks.inked(),
            chains: plan.has_curves().then(|| ChainsReport::of(page)),
            without_stroke: ink::unstroked(&page.marks, lines, drawing),
            page: PageReport::of(&illustration.sheet, illustration.frame),
            layers: LayerReport::all(drawing, &illustration.style.plot),
            covered: page.covered,
            longest_walk: page.longest_walk,
            pieces,
            warm_frames,
            frame_ms: times[warm_frames / 2],
            timing: gpu.clock.describe(),
            passes: renderer.timed_frame(plan, camera)?.passes,
            adapter: gpu.adapter_and_driver(),
            int64: gpu.int64,
            view: ViewReport::of(view, surface.dem().georeference(), self.drawing.exaggeration),
            flat_earth,
            left_out: page.frame.left_out(&surface)?.into_iter().map(LeftOutReport::of).collect(),
        })
    }

    /// The last line: what was drawn, and how long it took.
    fn tell(&self, drawn: &DrawnPage, started: Instant, talk: &Talk) -> Result<()> {
        let DrawnPage { renderer, view, page, .. } = drawn;
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

impl DrawnPage<'_> {
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
