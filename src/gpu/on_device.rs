//! All that a frame works with on a device, and what a pass of it dispatches there.

use super::buffers::Buffers;
use super::curves::CurveBuffers;
use super::device::Gpu;
use super::pace::Work;
use super::page::PageBuffers;
use super::pass::Pass;
use super::scene::Scene;
use super::shaders::{self, Amounts};
use super::stages::Stages;
use crate::error::Result;
use crate::plan::passes::{Over, PlannedPass};
use crate::plan::{Batch, Frame, PagePiece};
use crate::surface::lattice::CHUNK_FACETS;

/// Scene, page and passes on a device.
#[derive(Clone, Copy)]
pub struct OnDevice<'a> {
    /// The device.
    pub gpu: &'a Gpu,
    /// Buffers of the scene.
    pub scene: &'a Scene,
    /// Buffers of the page.
    pub page: &'a PageBuffers,
    /// Buffers of curves.
    pub curves: &'a CurveBuffers,
    /// The passes, bound to all of them.
    pub stages: &'a Stages,
}

/// A pass with what it binds, and how far it reaches.
pub struct Dispatch<'a> {
    pass: &'a Pass,
    group: &'a wgpu::BindGroup,
    extent: Extent<'a>,
    work: Work,
}

/// How far a pass reaches.
enum Extent<'a> {
    /// At least so many invocations along x and y.
    Invocations([u32; 2]),
    /// As many workgroups as the first three words of a list say.
    List(&'a wgpu::Buffer),
}

impl Dispatch<'_> {
    /// What it takes, as far as that is known before.
    pub(super) fn work(&self) -> Work {
        self.work
    }

    /// Records it.
    pub fn record(&self, pass: &mut wgpu::ComputePass<'_>) {
        match self.extent {
            Extent::Invocations(wanted) => self.pass.record(pass, self.group, wanted),
            Extent::List(list) => self.pass.record_over(pass, self.group, list),
        }
    }
}

impl<'a> OnDevice<'a> {
    /// A buffer by the name the shaders give it.
    ///
    /// # Errors
    /// [`Error::Mistake`] when there is none.
    pub fn buffer(self, name: &str) -> Result<&'a wgpu::Buffer> {
        let found = self.scene.buffers().find(name).or_else(|| self.curves.buffers().find(name));
        found.map_or_else(|| self.page.buffers().get(name), Ok)
    }

    /// Bytes of all buffers.
    pub fn bytes(self) -> u64 {
        let buffers = [self.scene.buffers(), self.page.buffers(), self.curves.buffers()];
        buffers.map(Buffers::bytes).iter().sum::<u64>() + self.stages.bytes()
    }

    /// What a pass dispatches for a piece of a frame, in a round over a batch; `None` where all vertices that it would make
    /// are there.
    ///
    /// # Errors
    /// [`Error::Mistake`] when the frame has no such pass, batch or round.
    pub fn dispatch(
        self,
        frame: &Frame,
        piece: PagePiece,
        planned: &PlannedPass,
        [batch, round]: [u32; 2],
    ) -> Result<Option<Dispatch<'a>>> {
        let stage = self.stages.get(planned.name)?;
        let group = self.stages.group(stage, batch as usize, round)?;
        let none = Batch { first_slot: 0, chunks: 0 };
        let batch = frame.batches.get(batch as usize).copied().unwrap_or(none);
        let chunks = match planned.over {
            Over::FreshChunks => self.scene.fresh().min(batch.chunks),
            Over::SeenChunks => batch.seen(frame.seen),
            Over::AllChunks => frame.lattice.chunks().len() as u32,
            Over::Chunks | Over::List(_) | Over::Pixels | Over::RimEdges | Over::Found => batch.chunks,
        };
        if planned.over == Over::FreshChunks && chunks == 0 {
            return Ok(None);
        }
        let amounts = Amounts {
            chunks,
            size: piece.drawn.size,
            rim_edges: self.scene.rim_edges() as u64,
            laid: self.curves.laid().into(),
            crossed: self.curves.capacity().crossed.into(),
            segments: self.curves.capacity().segments.into(),
        };
        let extent = match planned.over {
            Over::List(list) => Extent::List(self.buffer(list)?),
            _ => Extent::Invocations(shaders::invocations(planned.name, &stage.pass, amounts)?),
        };
        let pixels = u64::from(amounts.size[0]) * u64::from(amounts.size[1]);
        let work = match planned.over {
            Over::FreshChunks | Over::SeenChunks | Over::AllChunks | Over::Chunks => {
                Work::facets(u64::from(chunks) * u64::from(CHUNK_FACETS))
            }
            // The device alone knows how long a list is: of pixels, or of facets that are large on the page.
            Over::Pixels | Over::List(_) => Work::items(pixels),
            Over::RimEdges => Work::items(amounts.rim_edges),
            Over::Found => Work::items(amounts.laid + amounts.crossed + amounts.segments),
        };
        Ok(Some(Dispatch { pass: &stage.pass, group, extent, work }))
    }
}
