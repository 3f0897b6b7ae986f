//! A frame as data: everything that is decided of it before the GPU hears of it.

use std::sync::Arc;

use super::left_out::Omission;
use super::passes::{Often, Over, PassName, PlannedPass, passes};
use super::{Batch, Border, Culling, Detail, Pieces, Plan, Visibility, batches, detail};
use crate::error::{Error, Result, Setting};
use crate::surface::{Lattice, Level, Surface};
use crate::view::Camera;

/// What a camera sees of a surface, and how it is drawn.
#[derive(Debug, Clone)]
pub struct Frame {
    /// What is drawn.
    pub plan: Plan,
    /// From where.
    pub camera: Camera,
    /// How its page is cut.
    pub pieces: Pieces,
    /// The chunks whose facets are drawn.
    pub lattice: Arc<Lattice>,
    /// How many of them, in the first slots, may appear. Hidden away facets count where depths of both sides are compared.
    pub seen: u32,
    /// The chunks in batches that share one vertex buffer.
    pub batches: Vec<Batch>,
    /// What the raster keeps of a pixel.
    pub visibility: Visibility,
    /// The passes that run, in their order.
    pub passes: Vec<PlannedPass>,
    /// Whether passes look whether samples are void.
    pub tests_voids: bool,
    /// What it does without, in the order of telling.
    pub(super) omissions: Vec<Omission>,
}

/// What planning keeps from frame to frame: the lattice of the last uniform level.
#[derive(Debug, Default)]
pub struct KeptLattice(Option<(Level, Arc<Lattice>)>);

impl KeptLattice {
    /// The lattice of a level, as it was or made.
    ///
    /// # Errors
    /// As [`Lattice::uniform`].
    fn uniform(&mut self, surface: &Surface, level: Level) -> Result<Arc<Lattice>> {
        match &self.0 {
            Some((of, lattice)) if *of == level => Ok(lattice.clone()),
            _ => {
                let lattice = Arc::new(Lattice::uniform(surface.dem(), level)?);
                self.0 = Some((level, lattice.clone()));
                Ok(lattice)
            }
        }
    }
}

impl Frame {
    /// Plans what `camera` sees, for a device with or without 64-bit atomics.
    ///
    /// # Errors
    /// [`Error::Limit`] when the scene or the page is too large, [`Error::Setting`] when the page has no pixels; as
    /// [`Surface::pyramid`].
    pub fn new(plan: &Plan, surface: &Surface, camera: &Camera, int64: bool, kept: &mut KeptLattice) -> Result<Self> {
        check(surface, camera)?;
        let (lattice, omissions) = match plan.detail {
            Detail::Uniform(level) => (kept.uniform(surface, level)?, Vec::new()),
            Detail::Adaptive { error_px } => {
                let (lattice, omissions) = detail::adaptive(surface, camera, error_px, plan.culling, plan.curves)?;
                (Arc::new(lattice), omissions)
            }
        };
        Ok(Self::over(lattice, plan, surface, camera, int64).leave_out(omissions))
    }

    /// What is known of the frames of a plan before there is an eye, on pages as large as the camera's: where each frame
    /// has its own lattice, one of no chunks.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn before_any(
        plan: &Plan,
        surface: &Surface,
        camera: &Camera,
        int64: bool,
        kept: &mut KeptLattice,
    ) -> Result<Self> {
        check(surface, camera)?;
        let lattice = match plan.detail {
            Detail::Uniform(level) => kept.uniform(surface, level)?,
            Detail::Adaptive { .. } => Arc::new(Lattice::empty(surface.dem(), surface.pyramid()?.coarsest_step())?),
        };
        Ok(Self::over(lattice, plan, surface, camera, int64).leave_out(Vec::new()))
    }

    fn over(lattice: Arc<Lattice>, plan: &Plan, surface: &Surface, camera: &Camera, int64: bool) -> Self {
        let visibility = plan.method.visibility(int64);
        let chunks = lattice.chunks().len() as u32;
        let all_seen = plan.culling == Culling::Off || visibility == Visibility::TwoDepths;
        Self {
            plan: *plan,
            camera: *camera,
            pieces: Pieces::from([camera.width, camera.height]),
            seen: if all_seen { chunks } else { lattice.seen() },
            batches: batches(chunks),
            visibility,
            passes: passes(plan),
            tests_voids: surface.dem().voids() > 0,
            omissions: Vec::new(),
            lattice,
        }
    }

    /// Leaves out the passes that would find nothing to do, and notes what else is not done, beside what its lattice does
    /// without.
    fn leave_out(mut self, of_lattice: Vec<Omission>) -> Self {
        self.passes.retain(|pass| pass.name != PassName::Seam || self.lattice.has_seams());
        let lacks = |name| self.passes.iter().all(|pass| pass.name != name);
        // Chunks beside the page are among those that a lattice of several levels keeps from being rasterized.
        let passes_over = self.plan.culling == Culling::On && matches!(self.plan.detail, Detail::Uniform(_));
        let left_out = [
            (Omission::Rasterizing, (self.seen as usize) < self.lattice.chunks().len()),
            (Omission::Chunks, passes_over),
            (Omission::SeamPass, lacks(PassName::Seam)),
            (Omission::BorderPass, self.plan.border == Border::Off),
            (Omission::VoidTests, !self.tests_voids),
        ];
        self.omissions = of_lattice;
        self.omissions.extend(left_out.into_iter().filter(|(_, is_left_out)| *is_left_out).map(|(what, _)| what));
        self.omissions.sort();
        self
    }

    /// The same frame on a page that is cut in another way.
    ///
    /// # Errors
    /// As [`Pieces::check`]; [`Error::Setting`] when they are those of another page than the camera's.
    pub fn cut(self, pieces: Pieces) -> Result<Self> {
        pieces.check()?;
        let (page, [width, height]) = ([self.camera.width, self.camera.height], pieces.page());
        if pieces.page() != page {
            let what =
                format!("these are pieces of a page of {width}x{height}, the frame's is {}x{}", page[0], page[1]);
            return Err(Error::setting(Setting::Size, what, "cut the page of the frame's camera"));
        }
        Ok(Self { pieces, ..self })
    }

    /// A pass, if it runs in a round over the batches.
    pub fn pass(&self, name: PassName, round: u32) -> Option<&PlannedPass> {
        let runs = |often| match often {
            Often::EachRound => true,
            Often::ForVertices => round == 0 || !self.keeps_vertices(),
            Often::EachBatch | Often::Once | Often::ForCurves | Often::ForCurvesOfBatch | Often::OnReading => {
                round == 0
            }
        };
        self.passes.iter().find(|pass| pass.name == name && runs(pass.often))
    }

    /// The passes that run over each batch.
    pub fn of_batch(&self) -> impl Iterator<Item = PassName> {
        let of_batch = |often| matches!(often, Often::EachRound | Often::ForVertices | Often::EachBatch);
        self.passes.iter().filter(move |pass| of_batch(pass.often)).map(|pass| pass.name)
    }

    /// The passes that run once for a piece: those of the method, and the border.
    pub fn of_piece(&self) -> impl Iterator<Item = PassName> {
        self.passes.iter().filter(|pass| pass.often == Often::Once).map(|pass| pass.name)
    }

    /// The passes that find curves, in their order, each with its batch. Where batches share one vertex buffer, the values of
    /// all sides come first: what meets there may lie in several batches.
    pub fn of_curves(&self) -> Vec<(PassName, u32)> {
        let all = |often| self.passes.iter().filter(move |pass| pass.often == often).map(|pass| pass.name);
        let (before, behind): (Vec<_>, Vec<_>) =
            all(Often::ForCurves).partition(|name| !matches!(name, PassName::Lay | PassName::Sight));
        let mut sweeps = vec![all(Often::ForCurvesOfBatch).collect::<Vec<_>>()];
        if !self.keeps_vertices() {
            let vertices: Vec<_> = all(Often::ForVertices).filter(|name| *name != PassName::Project).collect();
            sweeps[0].splice(..0, vertices.iter().copied());
            sweeps.insert(0, [&vertices[..], &[PassName::Turn]].concat());
        }
        let batches = 0..self.batches.len() as u32;
        let over_batches = sweeps
            .iter()
            .flat_map(|sweep| batches.clone().flat_map(move |batch| sweep.iter().map(move |name| (*name, batch))));
        let once = |names: Vec<PassName>| names.into_iter().map(|name| (name, 0));
        once(before).chain(over_batches).chain(once(behind)).collect()
    }

    /// The lists of pixels that these fill and go over.
    pub fn lists(&self) -> impl Iterator<Item = &'static str> {
        let of_piece = self.passes.iter().filter(|pass| pass.often == Often::Once);
        of_piece.filter_map(|pass| if let Over::List(name) = pass.over { Some(name) } else { None })
    }

    /// Whether the vertices of all chunks fit in one batch, and so stay from round to round and from frame to frame.
    pub fn keeps_vertices(&self) -> bool {
        self.batches.len() <= 1
    }

    /// Of each chunk, slot by slot, whether passes look at it: not at those beside the page's map projection, unless nothing is
    /// left out.
    ///
    /// # Errors
    /// As [`Surface::pyramid`].
    pub fn across(&self, surface: &Surface) -> Result<impl Iterator<Item = bool>> {
        let all = self.plan.culling == Culling::Off;
        Ok(detail::across(surface, &self.lattice, &self.camera)?.map(move |across| across || all))
    }

    /// How many facets exist. Cost: see [`Lattice::facets`]; nothing for a uniform lattice.
    pub fn facets(&self, surface: &Surface) -> u64 {
        match self.plan.detail {
            Detail::Uniform(level) => surface.patches() * u64::from(level.subdivisions()).pow(2),
            Detail::Adaptive { .. } => self.lattice.facets(surface.dem()),
        }
    }
}

/// Whether there is something to draw, on a page that can be.
fn check(surface: &Surface, camera: &Camera) -> Result<()> {
    let Camera { width, height, .. } = *camera;
    if width == 0 || height == 0 {
        let what = format!("a page of {width}x{height} has no pixels");
        return Err(Error::setting(Setting::Size, what, "give at least one pixel across and one down"));
    }
    Pieces::from([width, height]).check()?;
    surface.dem().check_patches()
}
