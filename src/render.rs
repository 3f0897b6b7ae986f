//! The whole algorithm on one screen: plan, upload, passes, readback.

mod curves;
mod estimate;
mod illustration;
mod page;
mod time;
mod vertices;

use std::sync::Arc;

use crate::error::{Error, Result, Setting};
use crate::gpu::clock::Timer;
use crate::gpu::uniforms::{Counts, near_plane};
use crate::gpu::work::FrameWork;
use crate::gpu::{CurveBuffers, Gpu, OnDevice, PageBuffers, Scene, Stages};
use crate::line::{InkRaster, Land};
use crate::message;
use crate::plan::PassName::Compose;
use crate::plan::frame::KeptLattice;
use crate::plan::{Frame, PagePiece, Plan};
use crate::surface::Surface;
use crate::view::{Camera, Perspective};

pub use crate::gpu::clock::{FrameTime, PassTime};
pub(crate) use estimate::Estimate;
pub(crate) use illustration::Illustration;
pub use page::{Page, PageFindings};

/// A surface on a device, ready to be seen from any eye by any plan on a page of any size.
///
/// Passes belong to the device, samples and vertices to the scene, what is kept of pixels to the page's size:
/// whatever a frame has in common with earlier ones is neither compiled nor uploaded again. The buffers of a page are made
/// anew where its size changes; of uniform levels the last one's lattice is kept.
pub struct Renderer {
    gpu: Arc<Gpu>,
    surface: Arc<Surface>,
    land: Option<Arc<Land>>,
    kept: KeptLattice,
    scene: Scene,
    page: PageBuffers,
    curves: CurveBuffers,
    stages: Stages,
    /// What lies on the device: `None` while a frame is on its way, and after one that failed there.
    last: Option<(Frame, PagePiece)>,
}

/// What a frame leaves to read, and what was counted on the way.
#[derive(Debug, Clone)]
pub struct Drawn {
    /// Ink, kind, sub-pixel place and depth of each pixel.
    pub raster: InkRaster,
    /// Nodes the longest walk visited, or facets of the longest cut; 0 for other methods.
    pub longest_walk: u32,
}

impl Drawn {
    /// How many pixels are ink.
    pub fn inked(&self) -> usize {
        self.raster.pixels.iter().filter(|p| p.is_ink()).count()
    }
}

impl Renderer {
    /// A renderer that has drawn nothing yet.
    ///
    /// # Errors
    /// [`Error::Scene`] for a surface without patches, [`Error::Gpu`] when the driver refuses.
    pub fn new(gpu: Arc<Gpu>, surface: Arc<Surface>) -> Result<Self> {
        surface.dem().check_patches()?;
        let scene = Scene::new(&gpu)?;
        let (kept, page, curves, stages) = Default::default();
        Ok(Self { gpu, surface, land: None, kept, scene, page, curves, stages, last: None })
    }

    /// Gives it lines on the land, for plans that ask for them.
    pub fn set_land(&mut self, land: Option<Arc<Land>>) {
        self.land = land;
    }

    /// Decides what a frame needs, without a word to the device.
    ///
    /// # Errors
    /// As [`Frame::new`].
    pub fn plan(&mut self, plan: &Plan, camera: &Camera) -> Result<Frame> {
        Frame::new(plan, &self.surface, camera, self.gpu.int64, &mut self.kept)
    }

    /// Draws a frame to its mask, piece by piece, and waits for it.
    ///
    /// # Errors
    /// As [`Self::plan`]; whatever the driver reports; [`Error::Setting`] for an eye out of reach; [`Error::Input`] where
    /// samples cannot be read, or their files have changed: see [`Dem::check`](crate::dem::Dem::check).
    pub fn frame(&mut self, plan: &Plan, camera: &Camera) -> Result<Frame> {
        let frame = self.plan(plan, camera)?;
        self.upload(&frame)?;
        frame.pieces.iter().try_for_each(|piece| self.passes(&frame, piece, None))?;
        Ok(frame)
    }

    /// Draws a frame and brings it back: [`Self::frame`], then [`Self::read`].
    ///
    /// # Errors
    /// As theirs.
    pub fn draw(&mut self, plan: &Plan, camera: &Camera) -> Result<Drawn> {
        self.frame(plan, camera)?;
        self.read()
    }

    /// Brings to the device what a frame needs and what is not there yet: samples, lattice, room for its pixels, passes.
    fn upload(&mut self, frame: &Frame) -> Result<()> {
        let Self { gpu, surface, scene, page, curves, stages, .. } = self;
        self.last = None;
        scene.load(gpu, surface, frame)?;
        page.fit(gpu, frame.pieces.largest())?;
        curves.fit(gpu, frame)?;
        stages.fit(gpu, frame, scene, page, curves)
    }

    /// All passes over a piece of a frame, from clean buffers to its ink.
    fn passes(&mut self, frame: &Frame, piece: PagePiece, timer: Option<&mut Timer>) -> Result<()> {
        self.last = None;
        self.scene.write_camera(&self.gpu, &self.surface, frame, piece)?;
        let mut work = FrameWork::new(self.on_device(), frame, piece, timer);
        work.clear(&[&["pixels", "ink", "summaries", "counts"], frame.plan.method.entry().words].concat())?;
        for list in frame.lists() {
            work.empty(list, "no_pixels")?;
        }
        for round in 0..frame.visibility.rounds() {
            for batch in 0..frame.batches.len() as u32 {
                work.empty("queue", "empty_queue")?;
                for pass in frame.of_batch() {
                    work.run(pass, [batch, round])?;
                }
                if frame.batches.len() > 1 {
                    work.wait()?;
                }
            }
        }
        for pass in frame.of_piece() {
            work.run(pass, [0, 0])?;
        }
        work.wait()?;
        self.scene.made_vertices(frame);
        // What could not be read has passed for a void.
        self.surface.dem().check()?;
        self.last = Some((frame.clone(), piece));
        Ok(())
    }

    /// Composes the last frame and copies it to the CPU: after [`Self::draw_piece`] that piece.
    ///
    /// # Errors
    /// Whatever the driver reports; [`Error::Gpu`] when a walk was cut short; [`Error::Limit`] when the page takes several
    /// pieces, of which the device holds the last alone; [`Error::Mistake`] when there was no frame, or a pixel has a
    /// depth and no ID.
    pub fn read(&mut self) -> Result<Drawn> {
        let (frame, piece) = self.last_whole()?;
        self.read_piece(&frame, piece)
    }

    /// The frame that lies on the device, if it is a page in one piece.
    fn last_whole(&self) -> Result<(Frame, PagePiece)> {
        let (frame, piece) = self.last.clone().ok_or_else(|| Error::mistake("there is no frame to read"))?;
        match frame.pieces.iter().len() {
            1 => Ok((frame, piece)),
            pieces => {
                let what = format!("the page takes {pieces} pieces, one can be read");
                Err(Error::limit(what, message!["draw it piece by piece, or use a smaller ", Setting::Size]))
            }
        }
    }

    /// Composes a piece that was drawn; where that fails, there is no frame to read.
    fn read_piece(&mut self, frame: &Frame, piece: PagePiece) -> Result<Drawn> {
        self.last = None;
        let [width, height] = piece.drawn.size;
        let on_device = self.on_device();
        let mut work = FrameWork::new(on_device, frame, piece, None);
        work.run(Compose, [0, 0])?;
        work.wait()?;
        let pixels = self.gpu.read(on_device.buffer("page")?, width as usize * height as usize)?;
        let counts: Vec<Counts> = self.gpu.read(on_device.buffer("counts")?, 1)?;
        let longest_walk = checked(&counts)?;
        self.surface.dem().check()?;
        self.last = Some((frame.clone(), piece));
        Ok(Drawn { raster: InkRaster { width, height, pixels }, longest_walk })
    }

    /// Metres to the near plane: depths of a frame are this over the distance along the view axis.
    pub fn near(&self) -> f64 {
        near_plane(self.surface.dem())
    }

    /// The device.
    pub fn gpu(&self) -> &Arc<Gpu> {
        &self.gpu
    }

    /// What is drawn.
    pub fn surface(&self) -> &Arc<Surface> {
        &self.surface
    }

    /// The frame that lies on the device, of a page in pieces the last one drawn; `None` before the first frame, and after
    /// one that failed on its way there or back.
    pub fn last(&self) -> Option<&Frame> {
        self.last.as_ref().map(|(frame, _)| frame)
    }
}

/// What other stages and tests look into.
#[doc(hidden)]
impl Renderer {
    /// How a frame's camera sees, with the near plane of its depths.
    pub fn perspective(&self, frame: &Frame) -> Perspective {
        Perspective::new(&frame.camera, self.near())
    }

    /// What lies on the device, for reading what passes left.
    pub fn on_device(&self) -> OnDevice<'_> {
        OnDevice { gpu: &self.gpu, scene: &self.scene, page: &self.page, curves: &self.curves, stages: &self.stages }
    }
}

/// The nodes that the longest walk visited, or the facets of the longest cut, where all went well.
fn checked(counts: &[Counts]) -> Result<u32> {
    let orphans: u32 = counts.iter().map(|counts| counts.orphans).sum();
    if orphans > 0 {
        return Err(Error::mistake(format!("{orphans} pixels have a depth and no facet")));
    }
    let cut_short: u32 = counts.iter().map(|counts| counts.cut_short).sum();
    if cut_short > 0 {
        return Err(Error::Gpu { what: format!("the driver cut {cut_short} walks short") });
    }
    Ok(counts.iter().map(|counts| counts.longest_walk).max().unwrap_or(0))
}
