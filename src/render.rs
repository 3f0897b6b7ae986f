//! The whole algorithm on one screen: plan, passes, readback.

use std::time::Instant;

use crate::error::{Error, Result};
use crate::gpu::clock::Timer;
use crate::gpu::uniforms::{Counts, near_plane};
use crate::gpu::work::{Stage, Work};
use crate::gpu::{Buffers, CameraUniform, Clock, Extent, Gpu, Pass};
use crate::gpu::{border, compose, facing, rasterize, rasterize_large, silhouette, tessellate};
use crate::ink::{InkRaster, Marks, marks};
use crate::plan::{Batch, Border, Method, Piece, Pieces, Plan, Thrift, batches};
use crate::surface::rim::rim;
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
    /// Nodes the longest walk visited; 0 for other methods.
    pub longest_walk: u32,
}

/// A scene on a device, ready to be seen from any eye.
pub struct Renderer<'a> {
    gpu: &'a Gpu,
    surface: &'a Surface,
    plan: Plan,
    lattice: Lattice,
    batches: Vec<Batch>,
    rounds: u32,
    pieces: Pieces,
    rim_edges: usize,
    buffers: Buffers,
    per_batch: [Stage; 4],
    silhouettes: Vec<(Stage, Extent)>,
    border: Option<Stage>,
    compose: Stage,
}

impl<'a> Renderer<'a> {
    /// Uploads the scene and compiles what the method needs, for a page of so many pixels across and down, or for one
    /// that is cut in a way of its own.
    ///
    /// # Errors
    /// [`Error::Limit`] when the scene or the page is too large, [`Error::Gpu`] when the driver refuses.
    pub fn new(gpu: &'a Gpu, surface: &'a Surface, plan: Plan, page: impl Into<Pieces>) -> Result<Self> {
        let pieces = page.into();
        pieces.check()?;
        let size = pieces.largest();
        let dem = surface.dem();
        let lattice = Lattice::uniform(dem, plan.level)?;
        let rim = if plan.border == Border::On { rim(dem) } else { Vec::new() };
        let visibility = plan.method.visibility(gpu.int64);
        let batches = batches(lattice.chunks().len() as u32);
        let buffers = Buffers::new(gpu, surface, &lattice, &rim, &batches, visibility, size)?;
        let flag = |on: bool| f64::from(u8::from(on));
        let constants = [
            ("has_voids", flag(dem.voids() > 0)),
            ("facing_parts", f64::from(batches.last().map_or(1, |b| b.part() + 1))),
            ("two_depths", flag(matches!(plan.method, Method::TowardAway { .. }))),
            ("thrifty", flag(plan.thrift == Thrift::LeaveOut)),
            ("conservative", flag(plan.method == Method::TowardAway { wide: true })),
        ];
        let group = |pass: &Pass, i, round, batch| pass.bind(gpu, |name| buffers.resource(name, i, round, batch));
        let of_batches = |pass: Pass| {
            let rounds = 0..visibility.rounds();
            let each = batches.iter().enumerate().flat_map(|(i, b)| rounds.clone().map(move |round| (i, round, *b)));
            let groups = each.map(|(i, round, b)| group(&pass, i, round, b)).collect::<Result<_>>()?;
            Ok::<_, Error>(Stage { groups, pass })
        };
        let of_page = |pass: Pass| {
            let groups = vec![group(&pass, 0, 0, Batch { first_slot: 0, chunks: 0 })?];
            Ok::<_, Error>(Stage { groups, pass })
        };
        let per_batch = [
            of_batches(tessellate::pass(gpu, &constants)?)?,
            of_batches(facing::pass(gpu, &constants)?)?,
            of_batches(rasterize::pass(gpu, visibility, &constants)?)?,
            of_batches(rasterize_large::pass(gpu, visibility, &constants)?)?,
        ];
        let silhouettes = silhouette::passes(gpu, plan.method, size, &constants)?.into_iter();
        let silhouettes = silhouettes.map(|(pass, extent)| Ok((of_page(pass)?, extent))).collect::<Result<_>>()?;
        let border = if rim.is_empty() { None } else { Some(of_page(border::pass(gpu, &constants)?)?) };
        let compose = of_page(compose::pass(gpu, &constants)?)?;
        Ok(Self {
            gpu,
            surface,
            plan,
            lattice,
            rounds: visibility.rounds(),
            pieces,
            rim_edges: rim.len(),
            batches,
            buffers,
            per_batch,
            silhouettes,
            border,
            compose,
        })
    }

    /// The lattice whose facets are drawn.
    pub fn lattice(&self) -> &Lattice {
        &self.lattice
    }

    /// How the page is cut.
    pub fn pieces(&self) -> Pieces {
        self.pieces
    }

    /// How many facets the scene has.
    pub fn facets(&self) -> u64 {
        self.surface.patches() * u64::from(self.lattice.level().subdivisions()).pow(2)
    }

    /// The buffers, for reading what passes left.
    pub fn buffers(&self) -> &Buffers {
        &self.buffers
    }

    /// Metres to the near plane: depths of a frame are this over the distance along the view axis.
    pub fn near(&self) -> f64 {
        near_plane(self.surface.dem())
    }

    /// Draws a frame to its mask, piece by piece, and waits for it. Nothing but the camera is uploaded.
    ///
    /// # Errors
    /// Whatever the driver reports; [`Error::Flag`] for an eye out of reach or a camera of another page size.
    pub fn frame(&self, camera: &Camera) -> Result<()> {
        self.pieces.iter().try_for_each(|piece| self.run(camera, piece, None))
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
        let (mut list, mut longest_walk) = (Vec::new(), 0);
        let count = self.pieces.iter().len() as f64;
        for (done, piece) in (1..).zip(self.pieces.iter()) {
            let frame = self.draw_piece(camera, piece)?;
            list.append(&mut marks::of_piece(&frame.raster, piece));
            longest_walk = longest_walk.max(frame.longest_walk);
            progress(f64::from(done) / count);
        }
        Ok(Page { marks: Marks::new(self.pieces.page(), list), longest_walk })
    }

    /// Draws a piece of a frame and brings it back, halo and all: `piece.drawn` of the page.
    ///
    /// # Errors
    /// As [`Self::frame`] and [`Self::read`].
    pub fn draw_piece(&self, camera: &Camera, piece: Piece) -> Result<Frame> {
        self.run(camera, piece, None)?;
        self.read_piece(piece)
    }

    /// Draws a frame and says how long each pass took, over all pieces, by the [`Clock`] of the device. By the wall clock
    /// the whole is more than an undisturbed frame takes: see [`Self::time_of_frame`].
    ///
    /// # Errors
    /// As [`Self::frame`]; [`Error::Gpu`] when the driver's timestamps make no sense.
    pub fn timed_frame(&self, camera: &Camera) -> Result<FrameTime> {
        self.pieces.iter().try_fold(FrameTime::default(), |time, piece| {
            let mut timer = Timer::new(self.gpu);
            self.run(camera, piece, Some(&mut timer))?;
            Ok(time.and(&timer.read(self.gpu)?))
        })
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

    /// Uploads the camera and records the vertices of the scene's only batch, for callers that draw them by other
    /// means. Chunks that cannot appear keep what they had, zeros at first.
    ///
    /// # Errors
    /// [`Error::Limit`] when the scene has several batches, which share one vertex buffer; [`Error::Flag`] for an eye
    /// out of reach.
    pub fn record_vertices(&self, camera: &Camera, encoder: &mut wgpu::CommandEncoder) -> Result<()> {
        let ([batch], [stage, ..]) = (self.batches.as_slice(), &self.per_batch) else {
            return Err(Error::Limit {
                what: format!("the vertices take {} batches, one can be drawn", self.batches.len()),
                remedy: "use a lower --level or a --crop".into(),
            });
        };
        self.buffers.write_camera(self.gpu, &CameraUniform::new(self.surface.dem(), camera)?)?;
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        stage.pass.record(&mut pass, &stage.groups[0], tessellate::invocations(batch));
        Ok(())
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
            (_, more) => Err(Error::Limit {
                what: format!("the page takes {} pieces, one can be read", more + 1),
                remedy: "draw it piece by piece, or use a smaller --size".into(),
            }),
        }
    }

    fn read_piece(&self, piece: Piece) -> Result<Frame> {
        let [width, height] = piece.drawn.size;
        let mut work = Work::new(self.gpu, &self.buffers, None);
        work.record(&self.compose, 0, piece.drawn.size)?;
        work.finish()?;
        let bytes = self.gpu.read(self.buffers.get("page")?, u64::from(width) * u64::from(height) * 8)?;
        let counts = self.gpu.read(self.buffers.get("counts")?, size_of::<Counts>() as u64)?;
        let counts: Counts = bytemuck::pod_read_unaligned(&counts);
        if counts.orphans > 0 {
            return Err(Error::Gpu { what: format!("{} pixels have a depth and no facet", counts.orphans) });
        }
        if counts.cut_short > 0 {
            return Err(Error::Gpu { what: format!("the driver cut {} walks short", counts.cut_short) });
        }
        let raster = InkRaster { width, height, pixels: bytemuck::pod_collect_to_vec(&bytes) };
        Ok(Frame { raster, longest_walk: counts.longest_walk })
    }

    fn run(&self, camera: &Camera, piece: Piece, timer: Option<&mut Timer>) -> Result<()> {
        if [camera.width, camera.height] != self.pieces.page() {
            let [width, height] = self.pieces.page();
            let what =
                format!("the camera has {}x{} pixels, the renderer {width}x{height}", camera.width, camera.height);
            return Err(Error::flag("--size", what, "make a renderer for this size"));
        }
        let uniform = CameraUniform::new(self.surface.dem(), camera)?.cut_to(camera, piece.drawn);
        self.buffers.write_camera(self.gpu, &uniform)?;
        let mut work = Work::new(self.gpu, &self.buffers, timer);
        work.clear(&["pixels", "ink", "summaries", "counts"])?;
        if self.plan.method == (Method::TowardAway { wide: true }) {
            work.clear(&["touched"])?;
        }
        work.empty("candidates", "no_pixels")?;
        work.empty("pairs", "no_pixels")?;
        for round in 0..self.rounds {
            for (i, batch) in self.batches.iter().enumerate() {
                self.rasterize(&mut work, round, i, batch)?;
            }
        }
        for (stage, extent) in &self.silhouettes {
            work.record(stage, 0, *extent)?;
        }
        if let Some(stage) = &self.border {
            work.record(stage, 0, border::invocations(&stage.pass, self.rim_edges, self.lattice.level()))?;
        }
        work.finish()
    }

    /// One batch: its vertices, its facing, its pixels. A later round needs the vertices anew only where other batches
    /// have overwritten them.
    fn rasterize(&self, work: &mut Work<'_>, round: u32, i: usize, batch: &Batch) -> Result<()> {
        let group = i * self.rounds as usize + round as usize;
        let [tessellate_stage, facing_stage, small, large] = &self.per_batch;
        work.empty("queue", "empty_queue")?;
        if round == 0 || self.batches.len() > 1 {
            work.record(tessellate_stage, group, tessellate::invocations(batch))?;
        }
        if round == 0 {
            work.record(facing_stage, group, facing::invocations(batch))?;
        }
        work.record(small, group, rasterize::invocations(batch))?;
        work.record(large, group, Extent::List("queue"))?;
        if self.batches.len() > 1 {
            work.submit()?;
        }
        Ok(())
    }
}
