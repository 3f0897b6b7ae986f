//! `hachure compare`: methods at levels, their errors against truth and their times, as a report.

use std::cell::{Cell, RefCell};
use std::collections::HashSet;
use std::num::NonZeroU32;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::cache::CacheArguments;
use super::device::DeviceArguments;
use super::flight::{FlightArguments, FlightPlan};
use super::machine::{command, machine};
use super::talk::Talk;
use super::terrain::TerrainArguments;
use super::values::{self, GivenHeight, LevelChoice, Size};
use super::viewpoint::{View, ViewArguments};
use super::views::{self, NamedView};
use super::words::{flag, told};
use super::{blank, cells, choices, reference};
use crate::cache::Cache;
use crate::error::{Error, Result, Setting, shown};
use crate::files::Taken;
use crate::geo::Reading;
use crate::gpu::Gpu;
use crate::gpu::sizes::page_fits;
use crate::measure::compare::{CompareObserver, Compared, Comparison, Finding};
use crate::measure::depth_draw;
use crate::measure::figures::{Run, SequenceRun};
use crate::measure::sequence::Sequence;
use crate::plan::detail::ERROR_PX;
use crate::plan::{Border, Method};
use crate::report::folder::{Contents, Folder};
use crate::report::lines::lines;
use crate::report::pictures::{self, Picture};
use crate::report::results::{ComparedScene, Results, SCHEMA, TruthSummary};
use crate::report::{error_time_svg, report_html, write_csv};
use crate::surface::{Level, Surface};
use crate::truth::Terrain;
use crate::view::{Camera, Flight};

/// The end of `hachure compare --help`, below the names of the methods.
const EXAMPLES: &str = "\
Examples:
  hachure compare dem/golden-gate.tif -o report --size 1280x720

  Two methods at three levels, without border lines:
  hachure compare dem/golden-gate.tif -o report --methods walk,toward-away --levels 2,4,8 --border off

  What pops from frame to frame along a path, 200 m above the ground:
  hachure compare dem/golden-gate.tif -o report --path route.gpx --height +200 --levels auto

  Every view of two DEMs that a file holds, on pages of two sizes:
  hachure compare west-temple.tif st-helens.tif -o report --views views.json --sizes 640x360,1280x720";

/// Flags of `hachure compare`, as typed.
#[derive(Debug, clap::Args)]
#[command(after_help = reference::of(&[&methods(), EXAMPLES]), after_long_help = reference::of(&[&methods(), reference::COMPARED, EXAMPLES]))]
pub(crate) struct CompareArguments {
    #[command(flatten)]
    terrain: TerrainArguments,

    /// The folder for the report: report.html, results.json, results.csv, error-time.svg, and every picture
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,

    #[command(flatten)]
    view: ViewArguments,
    /// Pages, pixels across and down [default: --size]
    #[arg(long, value_name = "WxH,...", value_parser = values::size, value_delimiter = ',', conflicts_with = "size", help_heading = "View")]
    sizes: Vec<Size>,
    /// A file of views, drawn instead of the one that flags give
    #[arg(long, value_name = "FILE", help_heading = "View")]
    views: Option<PathBuf>,

    /// Follow a path instead, as hachure fly does: what of masks and strokes pops from frame to frame, over 20 frames from its
    /// middle, 1 m and 10 m apart, 640x360 unless --size says otherwise
    #[arg(long, value_name = "FILE", conflicts_with_all = ["views", "sizes", "standpoint", "azimuth", "altitude", "look_at", "crs", "north", "floor"], help_heading = "View")]
    path: Option<PathBuf>,
    /// With --path: +H, metres above the ground, instead of the path's own heights
    #[arg(long, value_name = "+H|Z", value_parser = values::height, allow_hyphen_values = true, requires = "path", help_heading = "View")]
    height: Option<GivenHeight>,

    /// Factor on every elevation
    #[arg(long, value_name = "X", value_parser = values::exaggeration, allow_hyphen_values = true, default_value = "1", help_heading = "Surface")]
    exaggeration: f64,
    /// Subdivisions of a cell's edge: 1, 2, 4, 8, 16, 32 or 64
    #[arg(long, value_name = "N|auto,...", value_parser = values::level_choice, value_delimiter = ',', default_value = "1,2,4,8,auto", help_heading = "Surface")]
    levels: Vec<LevelChoice>,
    /// Of level auto: how far facets may deviate from the surface on the page where a line may run, in pixels; elsewhere four
    /// times as far
    #[arg(long, value_name = "PX", value_parser = values::error_px, default_value_t = ERROR_PX, help_heading = "Surface")]
    error_px: f64,

    /// Methods to compare [default: all]
    #[arg(long, value_name = "NAME,...", value_parser = values::method, value_delimiter = ',', help_heading = "Method")]
    methods: Vec<Method>,
    /// Whether the visible border of the DEM and of its voids is drawn and judged
    #[arg(long, value_parser = choices::border(), default_value = choices::default_border(), help_heading = "Method")]
    border: Border,

    /// Subdivisions of a cell's edge for truth: 8, 16, 32 or 64 [default: no visible cell's edge longer than a pixel]
    #[arg(long, value_name = "N", value_parser = values::truth_level, help_heading = "Measure")]
    truth_level: Option<Level>,
    /// Warm frames behind each time, 9 to 100
    #[arg(long, value_name = "N", value_parser = values::repeat, default_value = "9", help_heading = "Measure")]
    repeat: NonZeroU32,
    /// Beside each frame, time a bare copy of the bytes its passes move and a hardware depth draw of its facets
    #[arg(long, help_heading = "Measure")]
    floor: bool,
    /// Find truth anew and keep it nowhere
    #[arg(long, conflicts_with_all = ["cache", "cache_size"], help_heading = "Measure")]
    no_cache: bool,

    #[command(flatten)]
    device: DeviceArguments,
    #[command(flatten)]
    cache: CacheArguments,
}

/// The names of the methods, for help.
fn methods() -> String {
    format!("Methods: {}.", choices::methods())
}

/// Metres between frames that follow a path.
const STEPS_M: [f64; 2] = [1.0, 10.0];
/// Pixels of frames that follow a path unless told otherwise.
const PATH_SIZE: Size = Size { width: 640, height: 360 };
/// How many frames follow it.
const FRAMES: u32 = 20;

/// Views of one DEM.
struct Job {
    files: Vec<PathBuf>,
    views: Vec<NamedView>,
}

/// Compares.
///
/// # Errors
/// Whatever went wrong; no page stands in the folder then.
pub(crate) fn run(arguments: &CompareArguments, talk: &Talk) -> Result<()> {
    let sizes = arguments.sizes();
    arguments.check(&sizes)?;
    let jobs = arguments.jobs(talk)?;
    let plan = arguments.path.as_deref().map(|path| arguments.flight(path)).transpose()?;
    let comparison = arguments.comparison();
    let views = || jobs.iter().flat_map(|job| &job.views);
    let names = views().flat_map(|view| sizes.iter().map(|size| scene_name(&view.name, *size, &sizes)));
    // Before anything is written: a report may replace none of the files that it is made of.
    let open = |job: &Job| arguments.terrain.open(&job.files, arguments.exaggeration, Cache::none());
    let readings = jobs.iter().map(open).collect::<Result<Vec<_>>>()?;
    // Truth looks at every sample again and again.
    readings.iter().try_for_each(Reading::check_held)?;
    let inputs =
        readings.iter().flat_map(Reading::files).chain(arguments.views.as_deref()).chain(arguments.path.as_deref());
    let pictures = names.flat_map(|name| comparison.picture_names(&name));
    let folder = Folder::open(&arguments.output, pictures, Taken::inputs(inputs))?;
    let asked = if plan.is_some() { STEPS_M.len() } else { views().count() * sizes.len() } as f64;
    let extra = if arguments.floor { depth_draw::FEATURE } else { wgpu::Features::empty() };
    let (done, gpu) = (Cell::new(0.0), Arc::new(arguments.device.open_with(extra, talk)?));
    let drawn = RefCell::new(Vec::new());
    let hearing = CompareObserver {
        stage: &|stage, share| talk.progress(stage, (done.get() + share) / asked),
        warn: &|message| talk.warn(&told(message)),
        found: &|found| {
            let [said, detail] = lines(&found);
            said.iter().try_for_each(|line| talk.say(line))?;
            detail.iter().try_for_each(|line| talk.detail(line))?;
            if let Finding::Picture(name, shown) = found {
                drawn.borrow_mut().push(pictures::of_shown(name.to_owned(), shown)?);
            }
            Ok(())
        },
    };
    let (mut scenes, mut runs, mut sequences) = (Vec::new(), Vec::new(), Vec::new());
    for (job, reading) in jobs.iter().zip(readings) {
        let surface = Arc::new(arguments.surface(reading, talk)?);
        let terrain = Terrain::new(&surface);
        if let Some(plan) = &plan {
            let flight = plan.flight(&surface, LevelChoice::Auto.near(), arguments.exaggeration)?;
            for step_m in STEPS_M {
                let cameras = middle(&flight, step_m)?;
                let name = format!("{}, {step_m} m", plan.described());
                let sequence = Sequence { name: &name, step_m, cameras: &cameras };
                sequences.extend(comparison.sequence(&gpu, &surface, &terrain, sequence, &hearing)?);
                done.set(done.get() + 1.0);
            }
            continue;
        }
        for (named, size) in job.views.iter().flat_map(|view| sizes.iter().map(move |size| (view, *size))) {
            let (name, view) = (scene_name(&named.name, size, &sizes), view_of(named, size, &surface, talk)?);
            let found = comparison.scene(&gpu, &surface, &name, &terrain, &view.camera, &hearing);
            let found = found.map_err(|error| blank::with_place(error, &surface, &view))?;
            let (scene, of_scene) = arguments.scene(name, &job.files, &surface, &view, found);
            scenes.push(scene);
            done.set(scenes.len() as f64);
            runs.extend(of_scene);
        }
    }
    talk.progress("writing", 1.0);
    let (page, pictures) = (folder.page(), drawn.into_inner());
    folder.publish(&contents(&results(&gpu, scenes, runs, sequences), &pictures)?, &pictures)?;
    talk.say(&format!("report: {}", shown(&page)))
}

/// Cameras around the middle of a flight, so many metres apart.
fn middle(flight: &Flight, step_m: f64) -> Result<Vec<Camera>> {
    let way = step_m * f64::from(FRAMES - 1);
    if flight.length() < way {
        let what = format!("{:.1} m long, {way} m of it are followed", flight.length());
        return Err(Error::setting(Setting::Path, what, "give a longer one"));
    }
    let start = (flight.length() - way) / 2.0;
    Ok((0..FRAMES).map(|i| flight.camera_at(start + step_m * f64::from(i))).collect())
}

/// The view of a file, or of flags, on a page of this size.
fn view_of(named: &NamedView, size: Size, surface: &Surface, talk: &Talk) -> Result<View> {
    // Heights above ground are above the level of `hachure draw`.
    let mut view = named.view.view(surface, LevelChoice::Auto.near())?;
    (view.camera.width, view.camera.height) = (size.width, size.height);
    view.warn_below_ground(surface, LevelChoice::Auto.near(), talk);
    Ok(view)
}

fn results(gpu: &Gpu, scenes: Vec<ComparedScene>, runs: Vec<Run>, sequences: Vec<SequenceRun>) -> Results {
    Results {
        version: SCHEMA,
        hachure: env!("CARGO_PKG_VERSION"),
        command: command(),
        machine: machine(gpu),
        truth: least_sure(&scenes),
        scenes,
        runs,
        sequences,
    }
}

impl CompareArguments {
    /// Whether files can be named after what is compared, pages drawn, and the view seen.
    fn check(&self, sizes: &[Size]) -> Result<()> {
        each_once(Setting::Sizes, sizes.iter().map(|size| format!("{}x{}", size.width, size.height)))?;
        each_once(Setting::Levels, self.levels.iter().map(LevelChoice::to_string))?;
        each_once(Setting::Methods, self.methods.iter().map(|method| method.entry().name.to_owned()))?;
        sizes.iter().try_for_each(|size| page_fits([size.width, size.height]))?;
        self.view.check()
    }

    fn surface(&self, reading: Reading, talk: &Talk) -> Result<Surface> {
        let dem = self.terrain.read(reading, talk)?;
        dem.check_patches()?;
        cells::warn(&dem, self.exaggeration, talk);
        self.terrain.surface(dem, &Cache::none(), talk)
    }

    /// The flight along a path, whose pages are small unless their size is given.
    fn flight(&self, path: &Path) -> Result<FlightPlan> {
        let size = self.view.typed_size().unwrap_or(PATH_SIZE);
        FlightArguments::along(path, self.height, self.view.fov(), size).plan(self.terrain.allows_remote())
    }

    fn sizes(&self) -> Vec<Size> {
        if self.sizes.is_empty() { vec![self.view.size()] } else { self.sizes.clone() }
    }

    fn comparison(&self) -> Comparison {
        Comparison {
            methods: if self.methods.is_empty() { Method::ALL.to_vec() } else { self.methods.clone() },
            levels: self.levels.iter().map(|level| level.detail(self.error_px)).collect(),
            repeat: self.repeat,
            floor: self.floor,
            border: self.border,
            truth_level: self.truth_level,
            cache: if self.no_cache { Cache::none() } else { self.cache.cache() },
        }
    }

    /// The view that flags give, of all files as one DEM; or the views of a file, of each DEM by itself.
    fn jobs(&self, talk: &Talk) -> Result<Vec<Job>> {
        let dems = &self.terrain.dems;
        if self.path.is_some() {
            return Ok(vec![Job { files: dems.clone(), views: Vec::new() }]);
        }
        let Some(path) = &self.views else {
            let name = dems.first().and_then(|dem| dem.file_stem()).unwrap_or_default();
            let name = views::file_name(&name.to_string_lossy());
            let view = NamedView { name, dem: PathBuf::new(), view: self.view.clone() };
            return Ok(vec![Job { files: dems.clone(), views: vec![view] }]);
        };
        if let Some(given) = self.view.given() {
            return Err(Error::setting(
                Setting::Views,
                format!("the file gives the views, so does {}", flag(given)),
                "leave out one of the two",
            ));
        }
        each_once(Setting::Dem, dems.iter().filter_map(|dem| Some(dem.file_name()?.to_string_lossy().into_owned())))?;
        let mut views = views::read(path, self.view.fov(), self.view.size())?;
        let mut jobs = Vec::new();
        for dem in dems {
            let (of_dem, others) = views.into_iter().partition(|view| Some(view.dem.as_os_str()) == dem.file_name());
            views = others;
            jobs.push(Job { files: vec![dem.clone()], views: of_dem });
        }
        views.iter().try_for_each(|view| {
            talk.say(&format!("view {} passed over: {} is not among the DEMs given", view.name, shown(&view.dem)))
        })?;
        jobs.retain(|job| !job.views.is_empty());
        if jobs.is_empty() {
            return Err(Error::input(path, "none of its views is of a DEM given", "give the DEMs its views name"));
        }
        Ok(jobs)
    }

    fn scene(
        &self,
        name: String,
        files: &[PathBuf],
        surface: &Surface,
        view: &View,
        found: Compared,
    ) -> (ComparedScene, Vec<Run>) {
        let (dem, camera) = (surface.dem(), &view.camera);
        let names: Vec<_> = files.iter().map(|file| file.to_string_lossy().into_owned()).collect();
        let scene = ComparedScene {
            name,
            command: draw_command(&names, &view.flags()),
            dem: names,
            columns: dem.columns(),
            rows: dem.rows(),
            cell_m: dem.cell().to_array(),
            patches: surface.patches(),
            eye_m: camera.eye.to_array(),
            north: view.norths.north.to_string(),
            azimuth: view.azimuth,
            altitude: camera.altitude,
            fov: camera.fov,
            flags: view.flags(),
            width: camera.width,
            height: camera.height,
            border: self.border == Border::On,
            truth: found.truth,
            convergence: found.convergence,
            picture: found.picture,
        };
        (scene, found.runs)
    }
}

/// Files are named after what is compared.
fn each_once(setting: Setting, names: impl Iterator<Item = String>) -> Result<()> {
    let mut seen = HashSet::new();
    for name in names {
        if !seen.insert(name.clone()) {
            return Err(Error::setting(setting, format!("{name} is there twice"), "name each once"));
        }
    }
    Ok(())
}

fn scene_name(view: &str, size: Size, sizes: &[Size]) -> String {
    if sizes.len() > 1 { format!("{view}_{}x{}", size.width, size.height) } else { view.to_owned() }
}

/// What draws a view of these files, as a shell takes it.
fn draw_command(files: &[String], flags: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "._-/:+=@,".contains(c);
    let quoted = |name: &String| match !name.is_empty() && name.chars().all(plain) {
        true => name.clone(),
        false => format!("'{}'", name.replace('\'', r"'\''")),
    };
    let files: Vec<_> = files.iter().map(quoted).collect();
    format!("hachure draw {} -o drawing.png {flags}", files.join(" "))
}

fn contents(results: &Results, pictures: &[Picture]) -> Result<Contents> {
    let plot = error_time_svg(results)?;
    let failed = |e: std::io::Error| Error::no_report(e);
    let mut csv = Vec::new();
    write_csv(results, &mut csv).map_err(failed)?;
    let mut json = serde_json::to_vec_pretty(results).map_err(|e| failed(e.into()))?;
    json.push(b'\n');
    Ok(Contents { page: report_html(results, &plot, pictures)?, json, csv, plot })
}

fn least_sure(scenes: &[ComparedScene]) -> TruthSummary {
    let least = scenes.iter().map(|scene| &scene.truth).min_by(|a, b| a.self_f.total_cmp(&b.self_f));
    let (level, self_f) = least.map_or((0, 0.0), |truth| (truth.level, truth.self_f));
    TruthSummary { level, self_f }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_of_a_command_are_quoted_where_a_shell_would_read_more() {
        let command =
            |files: &[&str]| draw_command(&files.iter().map(ToString::to_string).collect::<Vec<_>>(), "--fov 60");
        assert_eq!(command(&["dem/a.tif", "b.tif"]), "hachure draw dem/a.tif b.tif -o drawing.png --fov 60");
        assert_eq!(command(&["a b & \"d's\".tif"]), r#"hachure draw 'a b & "d'\''s".tif' -o drawing.png --fov 60"#);
        assert_eq!(command(&[""]), "hachure draw '' -o drawing.png --fov 60");
    }
}
