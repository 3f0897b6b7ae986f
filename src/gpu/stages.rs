//! The passes of a frame, compiled once, with what they bind.

use super::buffers::{Buffers, Room};
use super::work::Stage;
use super::{Extent, Gpu, Pass};
use super::{border, compose, facing, project, rasterize, rasterize_large, seam, silhouette, tessellate};
use crate::dem::Dem;
use crate::error::Result;
use crate::plan::{Batch, Plan, Thrift, Visibility, batches};

/// The passes of a plan.
pub struct Stages {
    /// `tessellate`, `seam`, `facing`, `project`, `rasterize`, `rasterize_large`: for each round of each batch.
    pub per_batch: [Stage; 6],
    /// Those of the method, and how far each reaches.
    pub silhouettes: Vec<(Stage, Extent)>,
    /// Where there is a rim to draw.
    pub border: Option<Stage>,
    /// For reading.
    pub compose: Stage,
}

impl Stages {
    /// Compiles what a plan needs, for buffers with so much room.
    ///
    /// # Errors
    /// See [`Pass::new`].
    pub fn new(gpu: &Gpu, dem: &Dem, plan: &Plan, has_rim: bool, room: Room, size: [u32; 2]) -> Result<Self> {
        let flag = |on: bool| f64::from(u8::from(on));
        let visibility = plan.method.visibility(gpu.int64);
        let of_frame = [
            ("has_voids", flag(dem.voids() > 0)),
            ("facing_parts", f64::from(facing_parts(room))),
            ("two_depths", flag(visibility == Visibility::TwoDepths)),
            ("thrifty", flag(plan.thrift == Thrift::LeaveOut)),
        ];
        let constants = [&of_frame, plan.method.entry().constants].concat();
        let stage = |pass: Pass| Stage { pass, groups: Vec::new() };
        let of_batch = || {
            Ok([
                stage(tessellate::pass(gpu, &constants)?),
                stage(seam::pass(gpu, &constants)?),
                stage(facing::pass(gpu, &constants)?),
                stage(project::pass(gpu, &constants)?),
                stage(rasterize::pass(gpu, visibility, &constants)?),
                stage(rasterize_large::pass(gpu, visibility, &constants)?),
            ])
        };
        let of_page = || {
            let silhouettes = silhouette::passes(gpu, plan.method, room, size, &constants)?.into_iter();
            let silhouettes = silhouettes.map(|(pass, extent)| (stage(pass), extent)).collect();
            let border = has_rim.then(|| border::pass(gpu, &constants)).transpose()?.map(stage);
            Ok((silhouettes, border, stage(compose::pass(gpu, &constants)?)))
        };
        let (of_batch, of_page): (Result<_>, Result<_>) = rayon::join(of_batch, of_page);
        let (per_batch, (silhouettes, border, compose)) = (of_batch?, of_page?);
        Ok(Self { per_batch, silhouettes, border, compose })
    }

    /// Whether passes compiled for so much room serve another.
    pub fn serve(room: Room, other: Room) -> bool {
        facing_parts(room) == facing_parts(other) && room.keeps_vertices() == other.keeps_vertices()
    }

    /// Binds all passes to these buffers, for frames of up to so many batches.
    ///
    /// # Errors
    /// See [`Pass::bind`].
    pub fn bind(&mut self, gpu: &Gpu, buffers: &Buffers, batches: &[Batch], rounds: u32) -> Result<()> {
        let group = |pass: &Pass, i, round, batch| pass.bind(gpu, |name| buffers.resource(name, i, round, batch));
        for Stage { pass, groups } in &mut self.per_batch {
            let each = batches.iter().enumerate().flat_map(|(i, b)| (0..rounds).map(move |round| (i, round, *b)));
            *groups = each.map(|(i, round, b)| group(pass, i, round, b)).collect::<Result<_>>()?;
        }
        let of_page = self.silhouettes.iter_mut().map(|(stage, _)| stage);
        for Stage { pass, groups } in of_page.chain(&mut self.border).chain([&mut self.compose]) {
            *groups = vec![group(pass, 0, 0, Batch { first_slot: 0, chunks: 0 })?];
        }
        Ok(())
    }
}

/// In how many parts facing bits lie.
fn facing_parts(room: Room) -> u32 {
    batches(room.chunks).last().map_or(1, |batch| batch.part() + 1)
}
