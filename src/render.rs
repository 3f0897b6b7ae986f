//! The whole algorithm on one screen: plan, passes, readback.

use std::cell::{Ref, RefCell};
use std::time::Instant;

use crate::dem::Dem;
use crate::error::{Error, Result, Setting};
use crate::gpu::buffers::Room;
use crate::gpu::clock::Timer;
use crate::gpu::sizes::rim_fits;
use crate::gpu::stages::Stages;
use crate::gpu::uniforms::{Counts, near_plane};
use crate::gpu::work::Work;
use crate::gpu::{Buffers, CameraUniform, Clock, Extent, Gpu};
use crate::gpu::{border, facing, project, rasterize, seam, tessellate};
use crate::line::{InkRaster, Marks, marks};
use crate::message;
use crate::plan::left_out::{LeftOut, left_out};
use crate::plan::{Batch, Border, Detail, Piece, Pieces, Plan, Thrift, Visibility, batches, detail};
use crate::surface::rim::{RimEdge, rim, rim_length};
use crate::surface::{Lattice, Surface};
use crate::view::Camera;

pub use crate::gpu::clock::{FrameTime, PassTime};

/// What a frame leaves to read, and what was counted on the way.
#[derive(Debug, Clone)]
pub struct Frame {
    /// Ink, kind, sub-pixel place and depth of each pixel.
    pub raster: InkRaster,
    /// Nodes the longest walk visited; 0 for other methods.
    pub longest_walk: u32,
}

impl Frame {
    /// How many pixels are ink.
    pub fn inked(&self) -> usize {
        self.raster.pixels.iter().filter(|p| p.is_ink()).count()
    }
}

/// The ink of a frame on a page of any size.
#[derive(Debug, Clone)]
pub struct Page {
    /// Ink, kind, sub-pixel place and depth.
    pub marks: Marks,
    /// How many pixels show land, inked or not.
    pub covered: u64,
    /// Nodes the longest walk visited; 0 for other methods.
    pub longest_walk: u32,
}

/// A scene on a device, ready to be seen from any eye.
pub struct Renderer<'a> {
    gpu: &'a Gpu,
    surface: &'a Surface,
    plan: Plan,
    visibility: Visibility,
    pieces: Pieces,
    rim: Vec<RimEdge>,
    loaded: RefCell<Loaded>,
}

/// A lattice on the device, and what draws it.
struct Loaded {
    lattice: Lattice,
    has_seams: bool,
    batches: Vec<Batch>,
    /// For what the passes are compiled.
    room: Room,
    buffers: Buffers,
    stages: Stages,
    /// Whether the passes are bound to these buffers; not after an error on the way to larger ones.
    is_bound: bool,
}

/// Chunks, nodes and tiles for which there is room before the first frame of an adaptive lattice.
const FIRST_ROOM: Room = Room { chunks: 512, nodes: 2048, tiles: 512, patched: 256 };

impl<'a> Renderer<'a> {
    /// Compiles what the plan needs, for a page of so many pixels across and down, or for one that is cut in a way of its
    /// own. The lattice of a uniform level is uploaded, other lattices belong to frames.
    ///
    /// # Errors
    /// [`Error::Limit`] when the scene or the page is too large, [`Error::Gpu`] when the driver refuses.
    pub fn new(gpu: &'a Gpu, surface: &'a Surface, plan: Plan, page: impl Into<Pieces>) -> Result<Self> {
        let pieces = page.into();
        pieces.check()?;
        let size = pieces.largest();
        let dem = surface.dem();
        dem.check_patches()?;
        let (lattice, room) = match plan.detail {
            Detail::Uniform(level) => {
                let lattice = Lattice::uniform(dem, level)?;
                let room = Room::of(&lattice);
                (lattice, room)
            }
            Detail::Adaptive { .. } => (Lattice::empty(dem, surface.pyramid()?.coarsest_step())?, FIRST_ROOM),
        };
        let rim = if plan.border == Border::On { bindable_rim(dem)? } else { Vec::new() };
        let visibility = plan.method.visibility(gpu.int64);
        let buffers = Buffers::new(gpu, surface, &lattice, room, &rim, visibility, size)?;
        let stages = Stages::new(gpu, dem, &plan, !rim.is_empty(), room, size)?;
        let mut loaded =
            Loaded { batches: Vec::new(), has_seams: false, room, lattice, buffers, stages, is_bound: false };
        loaded.bind(gpu, visibility)?;
        let renderer = Self { gpu, surface, plan, visibility, pieces, rim, loaded: RefCell::new(loaded) };
        renderer.load(&mut renderer.loaded.borrow_mut())?;
        dem.check()?;
        Ok(renderer)
    }

    /// The device that draws.
    pub fn gpu(&self) -> &Gpu {
        self.gpu
    }

    /// What is drawn.
    pub fn surface(&self) -> &Surface {
        self.surface
    }

    /// How it is drawn.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// How many chunks of the lattice, in the first slots, may appear.
    pub fn seen(&self) -> u32 {
        self.seen_of(&self.loaded.borrow())
    }

    /// Vertex batches of a frame.
    pub fn batches(&self) -> usize {
        self.loaded.borrow().batches.len()
    }

    /// Edges of the rim that is drawn.
    pub fn rim_edges(&self) -> usize {
        self.rim.len()
    }

    /// The lattice whose facets are drawn, of an adaptive one that of the last frame.
    pub fn lattice(&self) -> Ref<'_, Lattice> {
        Ref::map(self.loaded.borrow(), |loaded| &loaded.lattice)
    }

    /// How the page is cut.
    pub fn pieces(&self) -> Pieces {
        self.pieces
    }

    /// How many facets the scene has; with an adaptive lattice, those of the last frame's chunks.
    pub fn facets(&self) -> u64 {
        match self.plan.detail {
            Detail::Uniform(level) => self.surface.patches() * u64::from(level.subdivisions()).pow(2),
            Detail::Adaptive { .. } => self.lattice().facets(self.surface.dem()),
        }
    }

    /// What the frame of a camera does without; with an adaptive lattice, of the last camera drawn.
    ///
    /// # Errors
    /// As [`Surface::pyramid`].
    pub fn left_out(&self, camera: &Camera) -> Result<Vec<LeftOut>> {
        left_out(&self.plan, self.surface, &self.lattice(), camera)
    }

    /// The buffers, for reading what passes left.
    pub fn buffers(&self) -> Ref<'_, Buffers> {
        Ref::map(self.loaded.borrow(), |loaded| &loaded.buffers)
    }

    /// Metres to the near plane: depths of a frame are this over the distance along the view axis.
    pub fn near(&self) -> f64 {
        near_plane(self.surface.dem())
    }

    /// Draws a frame to its mask, piece by piece, and waits for it.
    ///
    /// # Errors
    /// Whatever the driver reports; [`Error::Setting`] for an eye out of reach or a camera of another page size;
    /// [`Error::Input`] where samples cannot be read, or their files have changed: see [`Dem::check`](crate::dem::Dem::check).
    pub fn frame(&self, camera: &Camera) -> Result<()> {
        self.look(camera)?;
        self.pieces.iter().try_for_each(|piece| self.run(camera, piece, None))?;
        // What could not be read has passed for a void.
        self.surface.dem().check()
    }

    /// Draws a frame and brings it back: [`Self::frame`], then [`Self::read`].
    ///
    /// # Errors
    /// As theirs.
    pub fn draw(&self, camera: &Camera) -> Result<Frame> {
        self.frame(camera)?;
        self.read()
    }

    /// Draws a frame and brings back its ink, piece by piece; tells `progress` what share is done.
    ///
    /// # Errors
    /// As [`Self::draw_piece`].
    pub fn page(&self, camera: &Camera, progress: impl Fn(f64)) -> Result<Page> {
        let (mut list, mut covered, mut longest_walk) = (Vec::new(), 0, 0);
        let count = self.pieces.iter().len() as f64;
        self.look(camera)?;
        for (done, piece) in (1..).zip(self.pieces.iter()) {
            self.run(camera, piece, None)?;
            let frame = self.read_piece(piece)?;
            list.append(&mut marks::of_piece(&frame.raster, piece));
            covered += marks::covered(&frame.raster, piece);
            longest_walk = longest_walk.max(frame.longest_walk);
            progress(f64::from(done) / count);
        }
        Ok(Page { marks: Marks::new(self.pieces.page(), list), covered, longest_walk })
    }

    /// Draws a piece of a frame and brings it back, halo and all: `piece.drawn` of the page.
    ///
    /// # Errors
    /// As [`Self::frame`] and [`Self::read`].
    pub fn draw_piece(&self, camera: &Camera, piece: Piece) -> Result<Frame> {
        self.look(camera)?;
        self.run(camera, piece, None)?;
        self.read_piece(piece)
    }

    /// Draws a frame and says how long each pass took, over all pieces, by the [`Clock`] of the device. By the wall clock
    /// the whole is more than an undisturbed frame takes: see [`Self::time_of_frame`].
    ///
    /// # Errors
    /// As [`Self::frame`]; [`Error::Gpu`] when the driver's timestamps make no sense.
    pub fn timed_frame(&self, camera: &Camera) -> Result<FrameTime> {
        self.look(camera)?;
        let time = self.pieces.iter().try_fold(FrameTime::default(), |time, piece| {
            let mut timer = Timer::new(self.gpu);
            self.run(camera, piece, Some(&mut timer))?;
            Ok(time.and(&timer.read(self.gpu)?))
        })?;
        self.surface.dem().check().map(|()| time)
    }

    /// Draws a frame and says how long it took, ms: by the wall clock around [`Self::frame`], or by the device's
    /// timestamps from its first command to its last pass.
    ///
    /// # Errors
    /// As [`Self::timed_frame`].
    pub fn time_of_frame(&self, camera: &Camera) -> Result<f64> {
        if self.gpu.clock == Clock::Timestamps {
            return Ok(self.timed_frame(camera)?.ms);
        }
        let start = Instant::now();
        self.frame(camera)?;
        Ok(start.elapsed().as_secs_f64() * 1e3)
    }

    /// Uploads the camera and records the vertices of the scene's only batch, for callers that submit them and draw them by
    /// other means. Chunks that cannot appear keep what they had, zeros at first.
    ///
    /// # Errors
    /// [`Error::Limit`] when the scene has several batches, which share one vertex buffer; [`Error::Setting`] for an eye
    /// out of reach.
    pub fn record_vertices(&self, camera: &Camera, encoder: &mut wgpu::CommandEncoder) -> Result<()> {
        self.look(camera)?;
        let loaded = self.loaded.borrow();
        let ([_], [vertices, seams, _, projection, ..]) = (loaded.batches.as_slice(), &loaded.stages.per_batch) else {
            let what = format!("the vertices take {} batches, one can be drawn", loaded.batches.len());
            return Err(Error::limit(what, message!["use a lower ", Setting::Level, " or a ", Setting::Crop]));
        };
        loaded.buffers.write_camera(self.gpu, &self.camera_uniform(&loaded, camera)?)?;
        let fresh = loaded.buffers.fresh();
        let made = [(vertices, tessellate::invocations(fresh)), (seams, seam::invocations(fresh))];
        let made = made.into_iter().filter(|_| fresh > 0);
        for (stage, extent) in made.chain([(projection, project::invocations(self.seen_of(&loaded)))]) {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            stage.pass.record(&mut pass, &stage.groups[0], extent);
        }
        self.surface.dem().check()
    }

    /// Composes the last frame and copies it to the CPU.
    ///
    /// # Errors
    /// Whatever the driver reports; [`Error::Gpu`] when a pixel has a depth and no ID or a walk was cut short;
    /// [`Error::Limit`] when the page takes several pieces, of which the device holds the last alone.
    pub fn read(&self) -> Result<Frame> {
        let mut pieces = self.pieces.iter();
        match (pieces.next(), pieces.len()) {
            (Some(piece), 0) => self.read_piece(piece),
            (_, more) => {
                let what = format!("the page takes {} pieces, one can be read", more + 1);
                Err(Error::limit(what, message!["draw it piece by piece, or use a smaller ", Setting::Size]))
            }
        }
    }

    fn read_piece(&self, piece: Piece) -> Result<Frame> {
        let [width, height] = piece.drawn.size;
        let Loaded { buffers, stages, .. } = &*self.loaded.borrow();
        let mut work = Work::new(self.gpu, buffers, None);
        work.record(&stages.compose, 0, piece.drawn.size)?;
        work.finish()?;
        let bytes = self.gpu.read(buffers.get("page")?, u64::from(width) * u64::from(height) * 8)?;
        let counts = self.gpu.read(buffers.get("counts")?, size_of::<Counts>() as u64)?;
        let counts: Counts = bytemuck::pod_read_unaligned(&counts);
        if counts.orphans > 0 {
            return Err(Error::mistake(format!("{} pixels have a depth and no facet", counts.orphans)));
        }
        if counts.cut_short > 0 {
            return Err(Error::Gpu { what: format!("the driver cut {} walks short", counts.cut_short) });
        }
        let raster = InkRaster { width, height, pixels: bytemuck::pod_collect_to_vec(&bytes) };
        self.surface.dem().check()?;
        Ok(Frame { raster, longest_walk: counts.longest_walk })
    }

    fn run(&self, camera: &Camera, piece: Piece, timer: Option<&mut Timer>) -> Result<()> {
        let loaded = self.loaded.borrow();
        let uniform = self.camera_uniform(&loaded, camera)?.cut_to(camera, piece.drawn);
        loaded.buffers.write_camera(self.gpu, &uniform)?;
        let mut work = Work::new(self.gpu, &loaded.buffers, timer);
        work.clear(&[&["pixels", "ink", "summaries", "counts"], self.plan.method.entry().words].concat())?;
        work.empty("candidates", "no_pixels")?;
        work.empty("pairs", "no_pixels")?;
        work.empty("rest", "no_pixels")?;
        for round in 0..self.visibility.rounds() {
            for (i, batch) in loaded.batches.iter().enumerate() {
                self.rasterize(&mut work, &loaded, round, i, batch)?;
            }
        }
        for (stage, extent) in &loaded.stages.silhouettes {
            work.record(stage, 0, *extent)?;
        }
        if let Some(stage) = &loaded.stages.border {
            work.record(stage, 0, border::invocations(&stage.pass, self.rim.len()))?;
        }
        work.finish()?;
        loaded.buffers.made_vertices();
        Ok(())
    }

    /// One batch: its vertices, its facing, its pixels. A later round needs the vertices anew only where other batches
    /// have overwritten them.
    fn rasterize(&self, work: &mut Work<'_>, loaded: &Loaded, round: u32, i: usize, batch: &Batch) -> Result<()> {
        let group = i * self.visibility.rounds() as usize + round as usize;
        let [tessellate_stage, seam_stage, facing_stage, project_stage, small, large] = &loaded.stages.per_batch;
        let several = loaded.batches.len() > 1;
        let (seen, fresh) = (batch.seen(self.seen_of(loaded)), loaded.buffers.fresh().min(batch.chunks));
        work.empty("queue", "empty_queue")?;
        if fresh > 0 && (round == 0 || several) {
            work.record(tessellate_stage, group, tessellate::invocations(fresh))?;
            if loaded.has_seams {
                work.record(seam_stage, group, seam::invocations(fresh))?;
            }
        }
        if round == 0 {
            work.record(facing_stage, group, facing::invocations(batch))?;
        }
        if round == 0 || several {
            work.record(project_stage, group, project::invocations(seen))?;
        }
        work.record(small, group, rasterize::invocations(seen))?;
        work.record(large, group, Extent::List("queue"))?;
        if several {
            work.submit()?;
        }
        Ok(())
    }

    fn camera_uniform(&self, loaded: &Loaded, camera: &Camera) -> Result<CameraUniform> {
        let uniform = CameraUniform::new(self.surface.dem(), camera)?;
        let (chunks, fresh) = (loaded.lattice.chunks().len() as u32, loaded.buffers.fresh());
        Ok(CameraUniform { chunks, seen: self.seen_of(loaded), fresh, ..uniform })
    }

    /// How many chunks, in the first slots, may appear. Hidden away facets count where depths of both sides are compared.
    fn seen_of(&self, loaded: &Loaded) -> u32 {
        if self.plan.thrift == Thrift::Nothing || self.visibility == Visibility::TwoDepths {
            return loaded.lattice.chunks().len() as u32;
        }
        loaded.lattice.seen()
    }

    /// Brings to the device what a camera asks for where each frame has its own lattice: one for all pieces.
    fn look(&self, camera: &Camera) -> Result<()> {
        if [camera.width, camera.height] != self.pieces.page() {
            let [width, height] = self.pieces.page();
            let what =
                format!("the camera has {}x{} pixels, the renderer {width}x{height}", camera.width, camera.height);
            return Err(Error::setting(Setting::Size, what, "make a renderer for this size"));
        }
        let mut loaded = self.loaded.borrow_mut();
        if let Detail::Adaptive { error_px } = self.plan.detail {
            loaded.lattice = detail::adaptive(self.surface, camera, error_px, self.plan.thrift)?;
            self.load(&mut loaded)?;
        }
        Ok(())
    }

    /// Brings the lattice to the device, into larger buffers where it needs them.
    fn load(&self, loaded: &mut Loaded) -> Result<()> {
        let Self { gpu, surface, visibility, .. } = self;
        loaded.batches = batches(loaded.lattice.chunks().len() as u32);
        loaded.has_seams = loaded.lattice.has_seams();
        let room = if loaded.is_bound {
            let Some(room) = loaded.buffers.load(gpu, surface, &loaded.lattice)? else { return Ok(()) };
            room
        } else {
            Room::of(&loaded.lattice)
        };
        loaded.is_bound = false;
        loaded.buffers =
            Buffers::new(gpu, surface, &loaded.lattice, room, &self.rim, *visibility, self.pieces.largest())?;
        if !Stages::serve(loaded.room, room) {
            let has_rim = !self.rim.is_empty();
            loaded.stages = Stages::new(gpu, surface.dem(), &self.plan, has_rim, room, self.pieces.largest())?;
        }
        loaded.room = room;
        loaded.bind(gpu, *visibility)?;
        loaded.buffers.load(gpu, surface, &loaded.lattice).map(drop)
    }
}

/// The rim, where a device can bind it: told before it is made.
fn bindable_rim(dem: &Dem) -> Result<Vec<RimEdge>> {
    rim_fits(rim_length(dem)?)?;
    rim(dem)
}

impl Loaded {
    /// Binds the passes to the buffers, for as many batches as these have room for.
    fn bind(&mut self, gpu: &Gpu, visibility: Visibility) -> Result<()> {
        self.stages.bind(gpu, &self.buffers, &batches(self.room.chunks), visibility.rounds())?;
        self.is_bound = true;
        Ok(())
    }
}
