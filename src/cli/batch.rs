//! `hachure batch`: many drawings, as a file lists them.

pub(crate) mod entry;
mod sheets;

use std::fs;
use std::io::{stdin, stdout};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::cache::CacheArguments;
use super::device::DeviceArguments;
use super::draw::DrawArguments;
use super::folds::FoldsInView;
use super::jobs::JobArguments;
use super::listing;
use super::plan::{self, Planned};
use super::progress::Progress;
use super::reference;
use super::scene;
use super::serve;
use super::talk::Talk;
use super::words::told;
use super::work::JobWork;
use crate::cache::Cache;
use crate::error::{Error, Result, shown};
use crate::files::{Taken, relative};
use crate::gpu::Gpu;
use crate::ink::Seal;
use crate::ink::furniture::Set;
use crate::job::manifest::SequenceKey;
use crate::job::name::Naming;
use crate::job::{Job, JobFile, Manifest};
use crate::line::Land;
use crate::plan::frame::KeptLattice;
use crate::relief::LandWanted;
use crate::render::{Estimate, Illustration, Page, Renderer};
use crate::surface::Surface;
use entry::{BatchEntry, Contents};
use sheets::SheetArguments;

/// The end of `hachure batch --help`.
const EXAMPLES: &str = "\
Examples:
  hachure batch drawings.toml

  Each drawing once for every sheet of 10 km, its outputs named as sheets/{sheet}.svg:
  hachure batch drawings.toml --grid EPSG:32610 --sheet 10km --halo 2km

  The first of four shares, told in lines of JSON:
  hachure batch drawings.toml --shard 0/4 --progress json

  Drawings as they are asked for, on the second of a machine's GPUs:
  echo '{\"id\": \"a\", \"frames\": \"0-3\"}' | hachure batch drawings.toml --serve --adapter 1";

/// Flags of `hachure batch`, as typed.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES, after_long_help = reference::of(&[reference::LIST, reference::JOBS, EXAMPLES]))]
pub(crate) struct BatchArguments {
    /// The list of drawings
    #[arg(value_name = "FILE.toml")]
    file: PathBuf,
    #[command(flatten)]
    sheets: SheetArguments,
    #[command(flatten)]
    jobs: JobArguments,
    #[command(flatten)]
    device: DeviceArguments,
    #[command(flatten)]
    cache: CacheArguments,
}

/// A DEM on a device, for all drawings of it that follow one another.
struct BatchScene {
    /// What it was read of and how.
    of: String,
    /// The files that it was read of: no drawing may replace one.
    files: Vec<PathBuf>,
    surface: Arc<Surface>,
    /// None where only plans were drawn of it so far.
    renderer: Option<Renderer>,
    /// The lines of its land that the last drawing wanted.
    land: Option<(LandWanted, Option<Arc<Land>>)>,
}

/// A drawing on its way to its files.
struct BatchDrawing<'a> {
    entry: &'a BatchEntry,
    inputs: Vec<PathBuf>,
    what: What,
}

/// What it is made of.
enum What {
    /// What an eye sees, what stands around it, and by which adapter.
    View(Box<Page>, Illustration, Set, String),
    /// A plan, which is drawn.
    Plan(Planned),
}

/// Makes the drawings.
///
/// # Errors
/// As [`JobWork::run`] and [`serve::run`]; [`Error::Input`] for a file that is no list of drawings.
pub(crate) fn run(arguments: &BatchArguments, talk: &Talk) -> Result<()> {
    if arguments.jobs.serve {
        serve::end_unread();
    }
    let cache = arguments.cache.cache();
    let entries = arguments.sheets.sheets(entry::read(&arguments.file)?, &cache, talk)?;
    entry::each_output_once(&arguments.file, &entries)?;
    warn_of_creases(&entries, talk);
    let share = arguments.jobs.share(entries.len() as u32, "drawings")?;
    let folder = entries.first().and_then(|entry| entry.draw.outputs.files().0.first().map(|path| folder_of(path)));
    let folder = folder.unwrap_or_default();
    let known = Manifest::all(&folder)?.into_iter().flat_map(|manifest| manifest.dems);
    let mut contents = Contents { known: known.collect(), cache: &cache, talk };
    let names: Vec<[u128; 2]> = entries.iter().map(|entry| entry.names(&mut contents)).collect();
    let dems = contents.known;
    let all: Vec<Job> = (0..).zip(&entries).zip(&names).map(|((n, entry), names)| entry.job(n, *names)).collect();
    let jobs: Vec<Job> = share.frames.numbers().iter().map(|n| all[*n as usize].clone()).collect();
    let together = names.iter().fold(Naming::new(), |naming, names| naming.with("drawing", names[0].to_le_bytes()));
    // Another list beside it makes other drawings; seen from the folder, all machines agree on its name.
    let list = relative(&folder, &arguments.file);
    let sequence = SequenceKey {
        of: format!("the {} drawings of {}", entries.len(), shown(&arguments.file)),
        sequence: Naming::bare().with("batch", list.as_os_str().as_encoded_bytes()).name(),
        job: together.name(),
        count: entries.len() as u32,
        fps: None,
        inks: None,
    };
    let mut studio = Studio { arguments, cache: cache.clone(), gpu: None, scene: None, talk: talk.hushed() };
    if arguments.jobs.list {
        return studio.list(&entries, &jobs, talk);
    }
    let work = JobWork { sequence, share, called: "drawings", jobs, folder, dems };
    if arguments.jobs.serve && entries.iter().any(|entry| entry.draw.scale().is_none()) {
        // Before any job: that there is none fails them all.
        studio.gpu()?;
    }
    let mut make = |work: &JobWork, progress: &Progress, talk: &Talk| {
        let draw = |job: &Job| studio.draw(&entries[job.number as usize], progress);
        work.run(talk, progress, draw, |job, drawn: BatchDrawing| drawn.write(job))
    };
    if arguments.jobs.serve {
        return serve::run(&work, talk, stdin().lock(), stdout(), make);
    }
    let progress = Progress::start(talk, arguments.jobs.progress, work.jobs.len());
    let made = work.prepare().and_then(|()| make(&work, &progress, talk));
    progress.end(made.as_ref().err());
    made
}

impl BatchArguments {
    /// Which jobs, and how they are told of.
    pub(crate) fn jobs(&self) -> &JobArguments {
        &self.jobs
    }
}

/// Where drawings are made, with what stays between them.
struct Studio<'a> {
    arguments: &'a BatchArguments,
    cache: Cache,
    gpu: Option<Arc<Gpu>>,
    scene: Option<BatchScene>,
    /// Tells more of each drawing than is wanted of many.
    talk: Talk,
}

impl Studio<'_> {
    /// Lists jobs with what they may take.
    fn list(&mut self, entries: &[BatchEntry], jobs: &[Job], talk: &Talk) -> Result<()> {
        let mut kept = KeptLattice::default();
        for job in jobs {
            let BatchEntry { draw, .. } = &entries[job.number as usize];
            let estimate = match job.is_done() {
                true => Ok(Estimate::NOTHING),
                false => self.estimate(draw, &mut kept),
            };
            listing::tell(job, estimate, talk)?;
        }
        Ok(())
    }

    /// What a drawing may take.
    fn estimate(&mut self, draw: &DrawArguments, kept: &mut KeptLattice) -> Result<Estimate> {
        if draw.scale().is_some() {
            let (_, land) = plan::check(draw)?;
            return Ok(Estimate::of_plan(self.scene(draw)?.surface.dem(), &land));
        }
        let (illustration, surface) = (draw.check()?, self.scene(draw)?.surface.clone());
        let view = draw.look(&surface, &illustration, &self.talk)?;
        listing::estimate(&illustration.plan, &surface, &view.camera, kept)
    }

    /// Draws what a view of an entry shows.
    fn draw<'e>(&mut self, entry: &'e BatchEntry, progress: &Progress) -> Result<BatchDrawing<'e>> {
        self.talk.say(&format!("{}:", entry.called))?;
        if let Some(scale) = entry.draw.scale() {
            let scene = self.scene(&entry.draw)?;
            let inputs = inputs(scene, &entry.draw);
            let surface = scene.surface.clone();
            let land = self.land(&entry.draw, &plan::check(&entry.draw)?.1)?;
            let planned = plan::draw(&entry.draw, scale, surface.dem(), land.as_deref(), &self.talk)?;
            return Ok(BatchDrawing { entry, inputs, what: What::Plan(planned) });
        }
        let illustration = entry.draw.check()?;
        let gpu = self.gpu()?;
        let adapter = gpu.adapter_and_driver();
        progress.on(&adapter);
        let surface = self.scene(&entry.draw)?.surface.clone();
        let land = self.land(&entry.draw, &illustration.land)?;
        let Self { scene: Some(scene), talk, .. } = self else {
            return Err(Error::mistake("a DEM was read and is not there"));
        };
        let view = entry.draw.look(&surface, &illustration, talk)?;
        let furniture = entry.draw.furniture(&illustration, &view, &surface)?;
        let renderer = match &mut scene.renderer {
            Some(renderer) => renderer,
            none => none.insert(Renderer::new(gpu, surface.clone())?),
        };
        renderer.set_land(land);
        let page = renderer.page(&illustration.plan, &view.camera, |_| ())?;
        let folds = FoldsInView::of(&surface, &page)?;
        entry.draw.warn_of_page(renderer, &view, &page, folds, talk);
        let inputs = inputs(scene, &entry.draw);
        Ok(BatchDrawing { entry, inputs, what: What::View(Box::new(page), illustration, furniture, adapter) })
    }

    /// The device: open, or opened.
    fn gpu(&mut self) -> Result<Arc<Gpu>> {
        match &self.gpu {
            Some(gpu) => Ok(gpu.clone()),
            None => {
                let gpu = Arc::new(self.arguments.device.open_with(wgpu::Features::empty(), &self.talk)?);
                Ok(self.gpu.insert(gpu).clone())
            }
        }
    }

    /// The lines of the land that a drawing wants: the last one's, or found.
    fn land(&mut self, draw: &DrawArguments, wanted: &LandWanted) -> Result<Option<Arc<Land>>> {
        let (cache, talk) = (self.cache.clone(), self.talk.hushed());
        let scene = self.scene(draw)?;
        match &scene.land {
            Some((of, land)) if of == wanted => Ok(land.clone()),
            _ => {
                let land = scene::land(&draw.drawing, wanted, &draw.terrain, &scene.surface, &cache, &talk)?;
                Ok(scene.land.insert((wanted.clone(), land)).1.clone())
            }
        }
    }

    /// The DEM of a drawing: the last one's, or read.
    fn scene(&mut self, draw: &DrawArguments) -> Result<&mut BatchScene> {
        let talk = &self.talk;
        let of = draw.scene();
        if self.scene.as_ref().is_none_or(|scene| scene.of != of) {
            // Both together may be more than there is room for.
            self.scene = None;
            let reading = draw.open(self.cache.clone())?;
            let files = reading.files().map(Path::to_owned).collect();
            let surface = Arc::new(scene::surface(&draw.terrain, reading, &self.cache, talk)?);
            scene::prepare(&surface, &self.cache, talk)?;
            self.cache.discard_damaged(surface.dem(), &|message| talk.warn(&told(message)));
            self.scene = Some(BatchScene { of, files, surface, renderer: None, land: None });
        }
        self.scene.as_mut().ok_or_else(|| Error::mistake("a DEM was read and is not there"))
    }
}

/// Warns once of drawings whose style has lines that their method does not draw. What cannot be told fails as it is made.
fn warn_of_creases(entries: &[BatchEntry], talk: &Talk) {
    let views = entries.iter().filter(|entry| entry.draw.scale().is_none());
    let words = |entry: &BatchEntry| entry.draw.drawing.left_out_of_style().ok().flatten();
    let mut all = views.filter_map(|entry| Some((&entry.called, words(entry)?)));
    if let Some((called, words)) = all.next() {
        let more = match all.count() {
            0 => String::new(),
            count => format!(" and {count} more"),
        };
        talk.warn(&format!("{called}{more}: {words}"));
    }
}

/// The files that a drawing is made of.
fn inputs(scene: &BatchScene, draw: &DrawArguments) -> Vec<PathBuf> {
    [scene.files.clone(), draw.drawing.land.lines.files()].concat()
}

impl BatchDrawing<'_> {
    fn write(self, job: &Job) -> Result<()> {
        let Self { entry, inputs, what } = self;
        // Another process may have made it meanwhile.
        if job.is_done() {
            return Ok(());
        }
        let (page, mut drawing, px_per_mm, adapter) = match what {
            What::View(page, illustration, furniture, adapter) => {
                let (_, mut drawing) = illustration.drawing(&page)?;
                furniture.onto(&mut drawing, &illustration.style);
                (Some(page), drawing, illustration.px_per_mm, adapter)
            }
            What::Plan(planned) => (None, planned.drawing, planned.px_per_mm, "none".to_owned()),
        };
        let seal = |made: &JobFile| Seal { job: made.name, adapter: adapter.clone() };
        drawing.seal = job.files.first().map(seal);
        for made in &job.files {
            let folder = folder_of(&made.path);
            fs::create_dir_all(&folder).map_err(|error| Error::output(&folder, &error))?;
        }
        let outputs = entry.draw.outputs.open(Taken::inputs(inputs.iter().map(PathBuf::as_path)))?;
        let mut outputs = match job.files.last() {
            Some(last) => outputs.with_mask_of(seal(last)),
            None => outputs,
        };
        outputs.write(&drawing, px_per_mm, page.as_deref(), None::<&()>)?;
        outputs.publish()
    }
}

/// The folder in which a file stands.
fn folder_of(path: &Path) -> PathBuf {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    folder.unwrap_or(Path::new(".")).to_owned()
}
