//! The mask methods on trial: a renderer draws, its ink is judged.

use std::sync::Arc;
use std::time::Instant;

use glam::DVec2;

use super::cost::PassCost;
use super::curves::{MeasuredCurves, mask_of};
use super::figures::{FloorFigures, PassFigures, Run};
use super::floors::Floors;
use super::trial::{Draws, Trial, Yield};
use super::{Floor, costs, memory};
use crate::error::Result;
use crate::gpu::Gpu;
use crate::line::{Chain, Kind, Mark, Marks, trace};
use crate::plan::{Method, Plan, Yields};
use crate::render::{PassTime, Renderer};
use crate::surface::Surface;
use crate::truth::Mask;
use crate::view::{Camera, Perspective};

/// A renderer that draws by a method.
struct Rendered {
    renderer: Renderer,
    plan: Plan,
    /// Of the last frame.
    perspective: Perspective,
    /// Whether a bare copy and a depth draw are timed in turn with the warm frames.
    wants_floor: bool,
    floor: Option<(Floor, Floors)>,
}

/// What a frame yields.
enum Yielded {
    Ink(Ink),
    Curves(MeasuredCurves),
}

/// The ink of a frame.
struct Ink {
    marks: Marks,
    perspective: Perspective,
    method: Method,
}

/// Tries a plan on a device: its renderer is made, timed and judged; with `floor`, a bare copy and a depth draw are timed
/// in turn with the warm frames.
pub(super) fn try_plan(
    trial: &Trial<'_>,
    gpu: &Arc<Gpu>,
    surface: &Arc<Surface>,
    plan: Plan,
    floor: bool,
) -> Result<Run> {
    memory::reset_peak();
    // Each run compiles its passes, whichever ran before it.
    gpu.forget_passes();
    let start = Instant::now();
    let mut renderer = Renderer::new(gpu.clone(), surface.clone())?;
    renderer.prepare(&plan, trial.camera)?;
    let setup_ms = start.elapsed().as_secs_f64() * 1e3;
    let mut rendered = Rendered {
        perspective: Perspective::new(trial.camera, renderer.near()),
        renderer,
        plan,
        wants_floor: floor,
        floor: None,
    };
    trial.run(&mut rendered, setup_ms)
}

impl Draws for Rendered {
    type Yield = Yielded;

    fn time_of_frame(&mut self, camera: &Camera) -> Result<f64> {
        self.perspective = Perspective::new(camera, self.renderer.near());
        self.renderer.time_of_frame(&self.plan, camera)
    }

    fn yielded(&mut self) -> Result<Yielded> {
        let Self { perspective, plan, renderer, .. } = self;
        if plan.method.entry().yields == Yields::Curves {
            return Ok(Yielded::Curves(MeasuredCurves::new(renderer.chains()?, perspective)));
        }
        let marks = Marks::from(&renderer.read()?.raster);
        Ok(Yielded::Ink(Ink { marks, perspective: *perspective, method: plan.method }))
    }

    fn passes(&mut self, camera: &Camera) -> Result<Vec<PassFigures>> {
        let passes = self.renderer.timed_frame(&self.plan, camera)?.passes;
        let drawn = self.renderer.read()?;
        let costs = costs(&self.renderer, &drawn)?;
        if self.wants_floor {
            let page = [camera.width, camera.height];
            let bytes = costs.iter().map(PassCost::bytes).sum();
            self.floor = Some((Floor::new(self.renderer.gpu().clone(), page, bytes)?, Floors::new(bytes)));
        }
        Ok(passes.into_iter().map(|pass| figures(pass, &costs)).collect())
    }

    fn time_floor(&mut self, _: &Camera) -> Result<()> {
        self.floor.as_mut().map_or(Ok(()), |(floor, floors)| floors.add(floor, &self.renderer))
    }

    fn floor(&mut self, frame_ms: f64) -> Option<FloorFigures> {
        self.floor.take().map(|(_, floors)| floors.beside(frame_ms))
    }

    fn facets(&self) -> u64 {
        self.renderer.last().map_or(0, |frame| frame.facets(self.renderer.surface()))
    }

    fn buffers_bytes(&self) -> u64 {
        self.renderer.on_device().bytes()
    }
}

impl Yield for Yielded {
    fn mask(&self) -> Mask {
        match self {
            Self::Ink(ink) => ink.mask(),
            Self::Curves(curves) => curves.mask(),
        }
    }

    fn chains(&self) -> Vec<Chain> {
        match self {
            Self::Ink(ink) => ink.chains(),
            Self::Curves(curves) => curves.chains(),
        }
    }

    fn places(&self) -> Vec<DVec2> {
        match self {
            Self::Ink(ink) => ink.places(),
            Self::Curves(curves) => curves.places(),
        }
    }
}

impl Yield for Ink {
    fn mask(&self) -> Mask {
        mask_of(&self.marks, self.perspective.near())
    }

    fn chains(&self) -> Vec<Chain> {
        trace(&self.marks, &self.perspective)
    }

    /// Border lines have none.
    fn places(&self) -> Vec<DVec2> {
        if !self.method.entry().sub_pixel {
            return Vec::new();
        }
        let silhouette = self.marks.ink().filter(|mark| mark.pixel.kind() == Kind::Silhouette);
        let place = |mark: &Mark| DVec2::new(f64::from(mark.column), f64::from(mark.row)) + 0.5 + mark.pixel.place();
        silhouette.map(place).collect()
    }
}

/// A pass's time beside what it cost.
fn figures(PassTime { name, ms }: PassTime, costs: &[PassCost]) -> PassFigures {
    let cost = costs.iter().find(|cost| cost.name == name);
    let (bytes, operations) = cost.map_or((0, 0), |cost| (cost.bytes(), cost.operations));
    PassFigures { name, ms, bytes, operations }
}
