//! A method draws a page: its ink, every bit of it, and how long that took.

use std::sync::Arc;

use crate::error::Result;
use crate::gpu::Gpu;
use crate::line::{Chain, Marks, one_pixel_wide};
use crate::measure::curves::mask_of;
use crate::plan::{Border, Detail, Method, Plan, Yields};
use crate::render::Renderer;
use crate::surface::Surface;
use crate::truth::Mask;
use crate::view::Camera;

/// Warm frames behind a time.
const FRAMES: usize = 3;

/// A method at a level over land, ready to draw.
pub struct Drawer {
    renderer: Renderer,
}

/// What it drew.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawing {
    /// Its ink.
    pub mask: Mask,
    /// All that is known of each pixel, or of each point of a curve, bit for bit.
    pub words: Vec<u64>,
}

/// The plan of a method at a level.
pub fn plan(detail: Detail, method: Method) -> Plan {
    Plan::new(detail, method, Border::On)
}

impl Drawer {
    /// Over land that nothing was drawn of yet.
    ///
    /// # Errors
    /// As [`Renderer::new`].
    pub fn new(gpu: &Arc<Gpu>, surface: &Arc<Surface>) -> Result<Self> {
        Ok(Self { renderer: Renderer::new(gpu.clone(), surface.clone())? })
    }

    /// Draws a page.
    ///
    /// # Errors
    /// As [`Renderer::draw`] and [`Renderer::chains`].
    pub fn draw(&mut self, plan: &Plan, camera: &Camera) -> Result<Drawing> {
        self.renderer.frame(plan, camera)?;
        let near = self.renderer.near();
        match plan.method.entry().yields {
            Yields::Ink => {
                let raster = self.renderer.read()?.raster;
                let words = bytemuck::cast_slice::<_, [u32; 2]>(&raster.pixels);
                let words = words.iter().map(|[a, b]| u64::from(*a) << 32 | u64::from(*b)).collect();
                Ok(Drawing { mask: mask_of(&Marks::from(&raster), near), words })
            }
            Yields::Curves => {
                let chains = self.renderer.chains()?;
                let marks = one_pixel_wide(&chains, [camera.width, camera.height]);
                Ok(Drawing { mask: mask_of(&marks, near), words: words(&chains) })
            }
        }
    }

    /// The median of some warm frames, ms.
    ///
    /// # Errors
    /// As [`Renderer::time_of_frame`].
    pub fn time(&mut self, plan: &Plan, camera: &Camera) -> Result<f64> {
        let times = (0..FRAMES).map(|_| self.renderer.time_of_frame(plan, camera));
        let mut times = times.collect::<Result<Vec<_>>>()?;
        times.sort_by(f64::total_cmp);
        Ok(times[FRAMES / 2])
    }

    /// Facets of the last frame.
    pub fn facets(&self) -> u64 {
        self.renderer.last().map_or(0, |frame| frame.facets(self.renderer.surface()))
    }

    /// What draws it.
    pub fn renderer(&mut self) -> &mut Renderer {
        &mut self.renderer
    }
}

/// Places and depths of curves, in an order of their own.
pub(super) fn words(chains: &[Chain]) -> Vec<u64> {
    let of_chain = |chain: &Chain| {
        let depths = |a: f32, b: f32| u64::from(a.to_bits()) << 32 | u64::from(b.to_bits());
        let of_point = chain.points.iter().flat_map(move |point| {
            [point.place.x.to_bits(), point.place.y.to_bits(), depths(point.depth, point.behind)]
        });
        of_point.chain([u64::from(chain.closed)]).collect::<Vec<_>>()
    };
    chains.iter().flat_map(of_chain).collect()
}
