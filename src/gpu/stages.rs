//! The passes of a plan, compiled, with what they bind.

use std::sync::Arc;

use super::buffers::{Buffers, upload};
use super::curves::CurveBuffers;
use super::device::Gpu;
use super::page::PageBuffers;
use super::pass::Pass;
use super::scene::Scene;
use super::shaders;
use super::uniforms::BatchUniform;
use crate::error::{Error, Result};
use crate::plan::batches::PART_CHUNKS;
use crate::plan::passes::{Often, PlannedPass, passes};
use crate::plan::{Batch, Culling, Curves, Frame, Method, PassName, Plan, Visibility};

/// Bytes between entries of a uniform buffer that are bound one at a time.
const UNIFORM_STRIDE: u64 = 256;

/// A compiled pass with what it binds: once for a piece, or for each round of each batch.
pub struct BoundPass {
    /// Which.
    pub name: PassName,
    /// The pass.
    pub pass: Arc<Pass>,
    groups: Vec<wgpu::BindGroup>,
}

/// The stages of frames of one plan over so many batches, bound to the buffers that were there.
#[derive(Default)]
pub struct Stages {
    stages: Vec<BoundPass>,
    rounds: u32,
    batches: Option<wgpu::Buffer>,
    made_for: Option<MadeFor>,
}

/// On what stages depend.
#[derive(PartialEq)]
struct MadeFor {
    passes: Vec<PlannedPass>,
    method: Method,
    culling: Culling,
    curves: Curves,
    batches: usize,
    /// Of scene, page and curves.
    generations: [u64; 3],
}

impl Stages {
    /// Compiles what a frame may run, and binds it to these buffers, unless that is done.
    ///
    /// # Errors
    /// See [`Gpu::pass`] and [`Pass::bind`].
    pub fn fit(
        &mut self,
        gpu: &Gpu,
        frame: &Frame,
        scene: &Scene,
        page: &PageBuffers,
        curves: &CurveBuffers,
    ) -> Result<()> {
        let Plan { method, culling, curves: asked, .. } = frame.plan;
        let made_for = MadeFor {
            passes: passes(&frame.plan),
            method,
            culling,
            curves: asked,
            batches: frame.batches.len().max(1),
            generations: [scene.generation(), page.generation(), curves.generation()],
        };
        if self.made_for.as_ref() == Some(&made_for) {
            return Ok(());
        }
        *self = Self::default();
        let passes = compile(gpu, frame, &made_for.passes)?;
        let rounds = frame.visibility.rounds();
        // A frame without chunks has no batch, but passes that bind one.
        let none = [Batch { first_slot: 0, chunks: 0 }];
        let batches = if frame.batches.is_empty() { &none[..] } else { &frame.batches };
        let uniforms = upload_uniforms(gpu, &batch_uniforms(batches, rounds));
        gpu.check()?;
        let buffers = [scene.buffers(), page.buffers(), curves.buffers()];
        let bound = Bound { buffers, batches: &uniforms, rounds };
        let mut stages = Vec::new();
        for (planned, pass) in made_for.passes.iter().zip(passes) {
            let groups = match planned.often {
                Often::EachRound | Often::ForVertices | Often::EachBatch | Often::ForCurvesOfBatch => {
                    bound.of_batches(gpu, &pass, batches)?
                }
                Often::Once | Often::ForCurves | Often::OnReading => vec![bound.group(gpu, &pass, 0, 0, none[0])?],
            };
            stages.push(BoundPass { name: planned.name, pass, groups });
        }
        *self = Self { stages, rounds, batches: Some(uniforms), made_for: Some(made_for) };
        Ok(())
    }

    /// The stage of a pass.
    ///
    /// # Errors
    /// [`Error::Mistake`] when the plan has none.
    pub fn get(&self, name: PassName) -> Result<&BoundPass> {
        let none = || Error::mistake(format!("pass {} is not of the plan", name.name()));
        self.stages.iter().find(|stage| stage.name == name).ok_or_else(none)
    }

    /// Bytes on the device of what tells batches apart.
    pub fn bytes(&self) -> u64 {
        self.batches.as_ref().map_or(0, wgpu::Buffer::size)
    }

    /// What a stage binds in a round over a batch.
    ///
    /// # Errors
    /// [`Error::Mistake`] when there is no such batch or round.
    pub fn group<'a>(&self, stage: &'a BoundPass, batch: usize, round: u32) -> Result<&'a wgpu::BindGroup> {
        let none =
            || Error::mistake(format!("pass {} binds nothing for batch {batch} in round {round}", stage.pass.name));
        let group = stage.groups.get(batch * self.rounds as usize + round as usize);
        group.filter(|_| round < self.rounds).ok_or_else(none)
    }
}

/// What passes bind.
struct Bound<'a> {
    /// Of scene, page and curves.
    buffers: [&'a Buffers; 3],
    batches: &'a wgpu::Buffer,
    rounds: u32,
}

impl Bound<'_> {
    /// Of each round of each batch what a pass binds.
    fn of_batches(&self, gpu: &Gpu, pass: &Pass, batches: &[Batch]) -> Result<Vec<wgpu::BindGroup>> {
        let each = batches.iter().enumerate().flat_map(|(i, batch)| (0..self.rounds).map(move |r| (i, r, *batch)));
        each.map(|(i, round, batch)| self.group(gpu, pass, i, round, batch)).collect()
    }

    /// What a pass over batch `index` in round `round` binds.
    fn group(&self, gpu: &Gpu, pass: &Pass, index: usize, round: u32, batch: Batch) -> Result<wgpu::BindGroup> {
        pass.bind(gpu, |name| match name {
            "batch" => Some(wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                buffer: self.batches,
                offset: (index as u64 * u64::from(self.rounds) + u64::from(round)) * UNIFORM_STRIDE,
                size: wgpu::BufferSize::new(size_of::<BatchUniform>() as u64),
            })),
            "facing" => self.whole(super::sizes::FACING[batch.part() as usize]),
            _ => self.whole(name),
        })
    }

    fn whole(&self, name: &str) -> Option<wgpu::BindingResource<'_>> {
        self.buffers.iter().find_map(|buffers| buffers.find(name)).map(wgpu::Buffer::as_entire_binding)
    }
}

/// Compiles passes of a frame: those of batches beside those of a piece.
fn compile(gpu: &Gpu, frame: &Frame, passes: &[PlannedPass]) -> Result<Vec<Arc<Pass>>> {
    let constants = constants(frame);
    let of_piece =
        passes.iter().position(|pass| matches!(pass.often, Often::Once | Often::ForCurves | Often::OnReading));
    let (of_batches, of_piece) = passes.split_at(of_piece.unwrap_or(passes.len()));
    let all = |passes: &[PlannedPass]| passes.iter().map(|p| pass(gpu, frame, p.name, &constants)).collect();
    let (of_batches, of_piece): (Result<Vec<_>>, Result<Vec<_>>) = rayon::join(|| all(of_batches), || all(of_piece));
    Ok([of_batches?, of_piece?].concat())
}

/// What all shaders may depend on.
fn constants(frame: &Frame) -> [(&'static str, f64); 6] {
    let flag = |on: bool| f64::from(u8::from(on));
    let Plan { method, culling, curves, .. } = frame.plan;
    [
        ("has_voids", flag(frame.tests_voids)),
        // In how many parts facing bits lie.
        ("facing_parts", f64::from(frame.batches.last().map_or(0, Batch::part) + 1)),
        ("two_depths", flag(frame.visibility == Visibility::TwoDepths)),
        ("culls", flag(culling == Culling::On)),
        ("all_curves", flag(curves == Curves::All)),
        ("conservative", flag(method.entry().conservative)),
    ]
}

/// Compiles a pass of a frame.
fn pass(gpu: &Gpu, frame: &Frame, name: PassName, constants: &[(&str, f64)]) -> Result<Arc<Pass>> {
    let source = shaders::source(name, frame.visibility, frame.keeps_vertices());
    let method = frame.plan.method.entry();
    let of_method = if method.passes.contains(&name) { method.constants } else { &[] };
    let own = shaders::OWN_CONSTANTS.iter().filter(|(of, _)| *of == name).map(|(_, constant)| *constant);
    let constants: Vec<_> = constants.iter().chain(of_method).copied().chain(own).collect();
    gpu.pass(name.name(), source, &constants)
}

fn batch_uniforms(batches: &[Batch], rounds: u32) -> Vec<BatchUniform> {
    let of = |b: &Batch, round| BatchUniform {
        first_slot: b.first_slot,
        part_slot: b.first_slot % PART_CHUNKS,
        round,
        passing: u32::from(batches.len() > 1),
    };
    batches.iter().flat_map(|b| (0..rounds).map(move |round| of(b, round))).collect()
}

fn upload_uniforms(gpu: &Gpu, entries: &[BatchUniform]) -> wgpu::Buffer {
    let mut bytes = vec![0; entries.len() * UNIFORM_STRIDE as usize];
    for (slot, entry) in bytes.chunks_exact_mut(UNIFORM_STRIDE as usize).zip(entries) {
        slot[..size_of::<BatchUniform>()].copy_from_slice(bytemuck::bytes_of(entry));
    }
    upload(gpu, "batches", &bytes, wgpu::BufferUsages::UNIFORM)
}
