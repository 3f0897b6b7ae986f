//! `hachure fly`: the frames of a flight.

use std::io::{stdin, stdout};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, OnceLock};

use super::cache::CacheArguments;
use super::cells;
use super::device::DeviceArguments;
use super::drawing::{DrawingArguments, Wanted};
use super::film;
use super::flight::{FlightArguments, FlightPlan};
use super::folds::FoldsInView;
use super::frames::{FrameArguments, FrameFiles};
use super::jobs::{JobArguments, JobShare};
use super::listing;
use super::outputs::Format;
use super::progress::Progress;
use super::reference;
use super::scene;
use super::serve;
use super::talk::Talk;
use super::terrain::{TerrainArguments, warn_of_survey};
use super::values::Size;
use super::words::told;
use super::work::JobWork;
use super::{bare, blank};
use crate::cache::Cache;
use crate::error::{Error, Result, Setting, shown};
use crate::files::{Output, Taken};
use crate::geo::Reading;
use crate::ink::Preview;
use crate::job::manifest::SequenceKey;
use crate::job::name::Naming;
use crate::job::{Content, Inks, Job, Manifest};
use crate::plan::frame::KeptLattice;
use crate::render::{Estimate, Illustration, PageFindings, Renderer};
use crate::surface::Surface;
use crate::view::Flight;

/// The end of `hachure fly --help`.
const EXAMPLES: &str = "\
Examples:
  250 frames along a line of a GeoPackage, 400 m above the ground:
  hachure fly dem/golden-gate.tif --path route.gpkg --height +400 --count 250 -o frames/%05d.png

  Ten seconds around a place, as a motion picture:
  hachure fly dem/golden-gate.tif --orbit 545000,4186000 --radius 4000 --height +800 --duration 10 \\
      -o frames/%05d.png --video around.mp4

  The way from above, before anything is drawn:
  hachure fly dem/golden-gate.tif --path route.gpkg --height +400 --preview route.svg

  The first of four shares, on as many machines, and whether all are there:
  hachure fly dem/golden-gate.tif --path route.toml --count 1000 -o /shared/frames/%05d.png --shard 0/4
  hachure merge /shared/frames

  Frames as they are asked for, on the second of a machine's GPUs:
  echo '{\"id\": 7, \"frames\": \"3, 5-10\"}' | \\
      hachure fly dem/golden-gate.tif --path route.toml --count 1000 -o frames/%05d.png --serve --adapter 1";

/// Flags of `hachure fly`, as typed.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES, after_long_help = reference::of(&[reference::FLOWN, reference::JOBS, EXAMPLES]))]
pub(crate) struct FlyArguments {
    #[command(flatten)]
    terrain: TerrainArguments,
    #[command(flatten)]
    frames: FrameArguments,
    /// Draw the way from above instead, with the cones of some views over a hillshade: is it the flight that is meant?
    #[arg(long, value_name = "OUT.png|.svg", conflicts_with_all = ["output", "mask", "video", "list", "serve"])]
    preview: Option<PathBuf>,
    #[command(flatten)]
    flight: FlightArguments,
    #[command(flatten)]
    drawing: DrawingArguments,
    /// Also a motion picture of the frames: .mp4, .mov, .mkv or .webm by ffmpeg, where it is installed; .gif; .png, which is
    /// animated
    #[arg(long, value_name = "OUT.mp4|.gif|.png", requires = "output", conflicts_with_all = ["frames", "shard", "shard_from_env", "serve"])]
    video: Option<PathBuf>,
    #[command(flatten)]
    jobs: JobArguments,
    #[command(flatten)]
    device: DeviceArguments,
    #[command(flatten)]
    cache: CacheArguments,
}

/// All that a flight's frames have in common, known without the DEM.
struct Asked {
    files: FrameFiles,
    illustration: Illustration,
    plan: FlightPlan,
    share: JobShare,
    dem: Content,
    sequence: SequenceKey,
}

/// A DEM on a device, and the way over it.
struct Aloft {
    renderer: Renderer,
    flight: Flight,
    adapter: String,
}

/// Draws the frames.
///
/// # Errors
/// As [`JobWork::run`] and [`serve::run`]; whatever keeps all frames from being drawn.
pub(crate) fn run(arguments: &FlyArguments, talk: &Talk) -> Result<()> {
    if arguments.jobs.serve {
        serve::end_unread();
    }
    arguments.drawing.furniture.refuse_for_frames()?;
    let cache = arguments.cache.cache();
    if let Some(path) = &arguments.preview {
        return arguments.preview(path, &cache, talk);
    }
    let (asked, jobs) = arguments.asked(&cache, talk)?;
    if asked.files.wanted() == Wanted::Drawing {
        arguments.drawing.left_out_of_style()?.into_iter().for_each(|words| talk.warn(&words));
    }
    if arguments.jobs.list {
        return arguments.list(&asked, &jobs, &cache, talk);
    }
    let beside = arguments.beside();
    let named = || Taken::inputs(arguments.terrain.dems.iter().chain(&beside).map(PathBuf::as_path));
    let pictures = arguments.pictures(&asked.files, &jobs)?;
    let film =
        arguments.video.as_deref().map(|path| film::of(path, asked.plan.fps(), named(), &pictures)).transpose()?;
    let folder = asked.files.folder();
    Manifest::refuse_others(&folder, &asked.sequence)?;
    let (sequence, share, dems) = (asked.sequence.clone(), asked.share.clone(), vec![asked.dem.clone()]);
    let work = JobWork { sequence, share, called: "frames", jobs, folder, dems };
    if arguments.jobs.serve {
        let mut aloft = Some(arguments.rise(&asked, &work.jobs, &cache, talk)?);
        let make = |work: &JobWork, progress: &Progress, talk: &Talk| fly(&mut aloft, &asked, work, progress, talk);
        return serve::run(&work, talk, stdin().lock(), stdout(), make);
    }
    let progress = Progress::start(talk, arguments.jobs.progress, work.jobs.len());
    let flown = || {
        let is_left = work.jobs.iter().any(|job| !job.is_done());
        let mut aloft = is_left.then(|| arguments.rise(&asked, &work.jobs, &cache, talk)).transpose()?;
        work.prepare()?;
        fly(&mut aloft, &asked, &work, &progress, talk)?;
        let inks = Inks::of(&asked.illustration.style);
        film.as_ref().map_or(Ok(()), |film| film::make(film, &pictures, &inks, &progress, talk))
    };
    let flown = flown();
    progress.end(flown.as_ref().err());
    flown
}

/// Draws frames; with nothing where all are there.
fn fly(aloft: &mut Option<Aloft>, asked: &Asked, work: &JobWork, progress: &Progress, talk: &Talk) -> Result<()> {
    let Asked { files, illustration, .. } = asked;
    let adapter = aloft.as_ref().map(|aloft| aloft.adapter.clone()).unwrap_or_default();
    progress.on(&adapter);
    let surface = aloft.as_ref().map(|aloft| aloft.renderer.surface().clone());
    let draw = |job: &Job| {
        let Some(Aloft { renderer, flight, .. }) = aloft else {
            return Err(Error::mistake("a frame went missing as it was looked at"));
        };
        // Light stands still while the eye turns.
        let plan = illustration.plan.lit_for(flight.camera(0).azimuth);
        renderer.find(&plan, &flight.camera(job.number), |_| ())
    };
    let [blank, bare] = [0, 0].map(AtomicUsize::new);
    // A look at every facet: at those of one frame, which stands for the rest.
    let folds = OnceLock::new();
    let finish = |job: &Job, found: PageFindings| {
        let page = found.page();
        blank.fetch_add(usize::from(page.marks.inked() == 0), Ordering::Relaxed);
        bare.fetch_add(usize::from(page.bare.is_some()), Ordering::Relaxed);
        if let Some(surface) = &surface {
            folds.get_or_init(|| FoldsInView::of(surface, &page));
        }
        files.write(job, &page, illustration, &adapter)
    };
    work.run(talk, progress, draw, finish)?;
    match blank.into_inner() {
        0 => {}
        count => talk.warn(&format!("{count} of the frames drawn hold no line; see where they look with --preview")),
    }
    match bare.into_inner() {
        0 => {}
        count => talk.warn(&bare::of_frames(count)),
    }
    if let Some(folds) = folds.into_inner().transpose()? {
        folds
            .warning()
            .into_iter()
            .for_each(|words| talk.warn(&format!("of the one frame that was looked at: {words}")));
    }
    Ok(())
}

impl FlyArguments {
    /// Which jobs, and how they are told of.
    pub(crate) fn jobs(&self) -> &JobArguments {
        &self.jobs
    }

    /// Whether the flags go together, all that is known without the DEM, and the frames to draw.
    fn asked(&self, cache: &Cache, talk: &Talk) -> Result<(Asked, Vec<Job>)> {
        let files = self.frames.files()?;
        self.flight.check()?;
        let size = self.flight.typed_size();
        let illustration =
            self.drawing.illustration(size, files.wanted(), files.want_picture(), self.terrain.allows_remote())?;
        let [width, height] = illustration.frame;
        let plan = self.flight.sized(Size { width, height }).plan(self.terrain.allows_remote())?;
        let share = self.jobs.share(plan.count(), "frames")?;
        let dem = self.content(&files.folder(), cache, talk)?;
        let of_sequence = Naming::bare().with("flight", plan.hashed());
        let seen = Naming::new()
            .with("dem", dem.hash())
            .with("read", self.terrain.read_as())
            .with("exaggeration", self.drawing.exaggeration.to_le_bytes())
            .with("sequence", of_sequence.name().to_le_bytes());
        let of_mask = seen.clone().with("mask", illustration.of_mask());
        let of_job = seen.with("drawing", format!("{illustration:?}"));
        let sequence = SequenceKey {
            of: format!("a flight of {} frames {}", plan.count(), plan.described()),
            sequence: of_sequence.name(),
            job: of_job.name(),
            count: plan.count(),
            fps: Some(plan.fps()),
            inks: Some(Inks::of(&illustration.style)),
        };
        let name = |naming: &Naming, n: &u32| naming.clone().with("frame", n.to_le_bytes()).name();
        let job = |n: &u32| files.job(*n, [name(&of_job, n), name(&of_mask, n)]);
        let jobs = share.frames.numbers().iter().map(job).collect();
        Ok((Asked { files, illustration, plan, share, dem, sequence }, jobs))
    }

    /// The pictures of a film, where one is wanted.
    fn pictures(&self, files: &FrameFiles, jobs: &[Job]) -> Result<Vec<PathBuf>> {
        if self.video.is_none() {
            return Ok(Vec::new());
        }
        let Some(pattern) = files.pictures() else {
            let what = "it is made of the pictures of the frames, which stay";
            return Err(Error::setting(Setting::Video, what, "add --output with a .png: DIR/%05d.png"));
        };
        Ok(jobs.iter().map(|job| pattern.path(job.number)).collect())
    }

    /// What the DEM's files hold: as a manifest of the folder knows, else as the cache does, else found.
    fn content(&self, folder: &Path, cache: &Cache, talk: &Talk) -> Result<Content> {
        let known = Manifest::all(folder)?.into_iter().flat_map(|manifest| manifest.dems);
        match known.into_iter().find(|content| content.holds(self.terrain.asked())) {
            Some(known) => Ok(known),
            None => self.terrain.content(self.drawing.exaggeration, cache, talk),
        }
    }

    /// Draws the way from above.
    fn preview(&self, path: &Path, cache: &Cache, talk: &Talk) -> Result<()> {
        let format = Format::of(path).filter(|format| matches!(format, Format::Png | Format::Svg));
        let Some(format) = format.filter(|_| path.as_os_str() != "-") else {
            let what = format!("{} does not end in .png or .svg", shown(path));
            return Err(Error::setting(Setting::Preview, what, "name it so"));
        };
        let (plan, beside) = (self.flight.plan(self.terrain.allows_remote())?, self.flight.files());
        let reading = self.open(cache)?;
        Taken::inputs(reading.files().chain(beside.iter().map(PathBuf::as_path))).take(Setting::Preview, path)?;
        let mut output = Output::create(path)?;
        let surface = scene::surface(&self.terrain, reading, cache, talk)?;
        scene::prepare(&surface, cache, talk)?;
        let preview = Preview::of(surface.dem(), &self.flight(&plan, &surface, talk)?)?;
        output.write(|out| match format {
            Format::Svg => preview.write_svg(out),
            Format::Png | Format::Pdf => preview.write_png(out),
        })?;
        surface.dem().check()?;
        output.publish()
    }

    /// Lists jobs with what they may take.
    fn list(&self, asked: &Asked, jobs: &[Job], cache: &Cache, talk: &Talk) -> Result<()> {
        let surface = Arc::new(scene::surface(&self.terrain, self.open(cache)?, cache, &talk.hushed())?);
        scene::prepare(&surface, cache, talk)?;
        let (flight, mut kept) = (self.flight(&asked.plan, &surface, &talk.hushed())?, KeptLattice::default());
        for job in jobs {
            let camera = flight.camera(job.number);
            let estimate = match job.is_done() {
                true => Ok(Estimate::NOTHING),
                false => listing::estimate(&asked.illustration.plan, &surface, &camera, &mut kept),
            };
            listing::tell(job, estimate, talk)?;
        }
        Ok(())
    }

    /// Reads the DEM, opens the device, and lays the way over the land.
    fn rise(&self, asked: &Asked, jobs: &[Job], cache: &Cache, talk: &Talk) -> Result<Aloft> {
        let (plan, files, wanted) = (&asked.plan, &asked.files, &asked.illustration.land);
        let (reading, beside) = (self.open(cache)?, self.beside());
        let mut inputs = Taken::inputs(reading.files().chain(beside.iter().map(PathBuf::as_path)));
        self.video.as_deref().map_or(Ok(()), |video| inputs.take(Setting::Video, video))?;
        files.spare(inputs, jobs)?;
        let surface = Arc::new(scene::surface(&self.terrain, reading, cache, talk)?);
        let gpu = scene::prepare_and_open(&surface, cache, &self.device, talk)?;
        cells::warn(surface.dem(), self.drawing.exaggeration, talk);
        warn_of_survey(surface.dem(), talk)?;
        let flight = self.flight(plan, &surface, talk)?;
        let land = scene::land(&self.drawing, wanted, &self.terrain, &surface, cache, talk)?;
        let gpu = Arc::new(gpu?);
        DeviceArguments::tell(&gpu, talk)?;
        let adapter = gpu.adapter_and_driver();
        cache.discard_damaged(surface.dem(), &|message| talk.warn(&told(message)));
        let mut renderer = Renderer::new(gpu, surface)?;
        renderer.set_land(land);
        Ok(Aloft { renderer, flight, adapter })
    }

    /// The files that are read beside the DEM.
    fn beside(&self) -> Vec<PathBuf> {
        [self.flight.files(), self.drawing.land.lines.files()].concat()
    }

    fn open(&self, cache: &Cache) -> Result<Reading> {
        self.terrain.open(&self.terrain.dems, self.drawing.exaggeration, cache.clone())
    }

    /// The way over the land, and what is to be said of it.
    fn flight(&self, plan: &FlightPlan, surface: &Surface, talk: &Talk) -> Result<Flight> {
        let flight = plan.flight(surface, self.drawing.level.near(), self.drawing.exaggeration)?;
        plan.taken().map_or(Ok(()), |taken| talk.say(&format!("path: {taken}")))?;
        let round = if flight.is_closed() { ", round" } else { "" };
        let (length, frames, fps) = (blank::length(flight.length()), plan.count(), plan.fps());
        let seconds = f64::from(frames) / fps;
        talk.say(&format!("flight: {length}{round} in {frames} frames, {seconds:.1} s at {fps} a second"))?;
        if flight.lifted() > 0.0 {
            talk.say(&format!(
                "flight: the eye is lifted by up to {} to keep clear of the ground",
                blank::length(flight.lifted())
            ))?;
        }
        Ok(flight)
    }
}
