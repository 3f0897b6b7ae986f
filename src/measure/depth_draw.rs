//! The hardware draw of a frame's facets: depth and facet ID by fixed function, beside which the time of a frame stands.
//!
//! One indexed draw of the vertices that the pass `project` left, into Depth32Float and R32Uint, both
//! sides, nearer wins: the least that any hidden-surface method on the device must do once vertices are there. u32
//! indices name the facets chunk by chunk, those that are rasterized alone. Vertices are not found again: their time is
//! that of `tessellate`, `seam` and `project`.
//!
//! Does not handle: several vertex batches, which share one buffer; facets across the near plane or the guard band, of
//! which vertices have no place: they are left out, which costs nothing.

use crate::error::{Error, Result};
use crate::gpu::pass::reflect;
use crate::gpu::{Gpu, OnDevice};
use crate::surface::Lattice;
use crate::surface::lattice::{CHUNK_FACETS, CHUNK_SIDE, CHUNK_VERTICES, Chunk};

/// What the ID of a facet comes from; without it a vertex's index stands in.
pub const FEATURE: wgpu::Features = wgpu::Features::PRIMITIVE_INDEX;
/// The composed shader where primitives are numbered.
pub const BY_PRIMITIVE: &str =
    concat!("enable primitive_index;\n", crate::shader!("scene", "depth_draw", "show_primitive"));
/// The composed shader elsewhere.
pub const BY_VERTEX: &str = crate::shader!("scene", "depth_draw", "show_vertex");
/// The entry point for vertices, and the label.
const NAME: &str = "depth_draw";

/// One draw of the facets of a lattice.
pub struct DepthDraw {
    pipeline: wgpu::RenderPipeline,
    bindings: Vec<(u32, String)>,
    ids: wgpu::TextureView,
    depths: wgpu::TextureView,
    facets: Option<Facets>,
}

/// The indices, and the slots and chunks they were made for.
struct Facets {
    drawn: Vec<(u32, Chunk)>,
    indices: wgpu::Buffer,
    count: u32,
}

/// Whether pixels show IDs of facets.
pub fn shows_facets(gpu: &Gpu) -> bool {
    gpu.device.features().contains(FEATURE)
}

impl DepthDraw {
    /// Compiles the draw for pages of so many pixels across and down.
    ///
    /// # Errors
    /// [`Error::Gpu`] when the shader or the driver refuses.
    pub fn new(gpu: &Gpu, [width, height]: [u32; 2]) -> Result<Self> {
        let source = if shows_facets(gpu) { BY_PRIMITIVE } else { BY_VERTEX };
        let pipeline = pipeline(gpu, source);
        let [ids, depths] = [wgpu::TextureFormat::R32Uint, wgpu::TextureFormat::Depth32Float].map(|format| {
            let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: Some(NAME),
                size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
                view_formats: &[],
            });
            texture.create_view(&Default::default())
        });
        gpu.check()?;
        Ok(Self { pipeline, bindings: reflect(NAME, source)?.bindings, ids, depths, facets: None })
    }

    /// Takes the facets of the chunks in these slots of a lattice. Indices are made anew where those are others than
    /// before.
    ///
    /// # Errors
    /// [`Error::Gpu`] when the driver refuses.
    pub fn load(&mut self, gpu: &Gpu, lattice: &Lattice, slots: impl IntoIterator<Item = u32>) -> Result<()> {
        let chunk = |slot: u32| Some((slot, *lattice.chunks().get(slot as usize)?));
        let drawn: Vec<(u32, Chunk)> = slots.into_iter().filter_map(chunk).collect();
        if self.facets.as_ref().is_some_and(|facets| facets.drawn == drawn) {
            return Ok(());
        }
        let ids = drawn.iter().flat_map(|(slot, _)| slot * CHUNK_FACETS..(slot + 1) * CHUNK_FACETS);
        let corners: Vec<u32> = ids.flat_map(|id| corners(lattice, id)).collect();
        let indices = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(NAME),
            size: (corners.len() as u64 * 4).max(wgpu::COPY_BUFFER_ALIGNMENT),
            usage: wgpu::BufferUsages::INDEX | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        gpu.queue.write_buffer(&indices, 0, bytemuck::cast_slice(&corners));
        self.facets = Some(Facets { drawn, indices, count: corners.len() as u32 });
        // Sent at once, so that the draw does not wait for it.
        gpu.queue.submit([]);
        gpu.wait()
    }

    /// Records the draw of the vertices that lie on the device.
    ///
    /// # Errors
    /// [`Error::Mistake`] when no facets were loaded; [`Error::Gpu`] when the driver refuses.
    pub fn record(&self, on_device: OnDevice<'_>, encoder: &mut wgpu::CommandEncoder) -> Result<()> {
        let gpu = on_device.gpu;
        let facets = self.facets.as_ref().ok_or_else(|| Error::mistake("there are no facets to draw"))?;
        let entry = |(binding, name): &(u32, String)| {
            Ok(wgpu::BindGroupEntry { binding: *binding, resource: on_device.buffer(name)?.as_entire_binding() })
        };
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(NAME),
            layout: &self.pipeline.get_bind_group_layout(0),
            entries: &self.bindings.iter().map(entry).collect::<Result<Vec<_>>>()?,
        });
        let store = wgpu::StoreOp::Store;
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(NAME),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &self.ids,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT), store },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.depths,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.set_index_buffer(facets.indices.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(0..facets.count, 0, 0..1);
        drop(pass);
        gpu.check()
    }

    /// ID + 1 of the facet that each pixel of the last draw shows, row by row; 0 is sky. See [`shows_facets`].
    ///
    /// # Errors
    /// Whatever the driver reports.
    pub fn ids(&self, gpu: &Gpu) -> Result<Vec<u32>> {
        let texture = self.ids.texture();
        let row = (texture.width() * 4).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let size = u64::from(row) * u64::from(texture.height());
        let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(NAME),
            size,
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None };
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let target = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
        encoder.copy_texture_to_buffer(texture.as_image_copy(), target, texture.size());
        gpu.queue.submit([encoder.finish()]);
        let bytes: Vec<u8> = gpu.read(&buffer, size as usize)?;
        let rows = bytes.chunks_exact(row as usize).map(|row| &row[..texture.width() as usize * 4]);
        Ok(rows.flat_map(bytemuck::pod_collect_to_vec::<u8, u32>).map(|primitive| self.id(primitive)).collect())
    }

    /// ID + 1 of a facet from its number + 1 in the draw.
    fn id(&self, primitive: u32) -> u32 {
        let chunk = primitive.saturating_sub(1) / CHUNK_FACETS;
        let slot = self.facets.as_ref().and_then(|facets| facets.drawn.get(chunk as usize)).map(|(slot, _)| *slot);
        slot.filter(|_| primitive > 0).map_or(0, |slot| primitive + (slot - chunk) * CHUNK_FACETS)
    }
}

/// Where the vertices of a facet lie in the buffers of its batch.
fn corners(lattice: &Lattice, id: u32) -> [u32; 3] {
    let slot = id / CHUNK_FACETS;
    let Chunk { origin, step, .. } = lattice.chunks()[slot as usize];
    lattice.facet(id).map(|at| {
        let [x, y] = [at.x - origin[0], at.y - origin[1]].map(|d| d / step);
        slot * CHUNK_VERTICES + y * CHUNK_SIDE + x
    })
}

fn pipeline(gpu: &Gpu, source: &'static str) -> wgpu::RenderPipeline {
    let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(NAME),
        source: wgpu::ShaderSource::Wgsl(source.into()),
    });
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(NAME),
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some(NAME),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: wgpu::TextureFormat::Depth32Float,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Greater),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("show"),
            compilation_options: Default::default(),
            targets: &[Some(wgpu::TextureFormat::R32Uint.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}
