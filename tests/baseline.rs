//! The baseline of the benchmark: every facet in one indexed hardware draw.
//!
//! The vertex buffer is the one our pass `tessellate` writes in the same submission, u32 indices name the facets in the
//! order of their IDs, the targets are Depth32Float and R32Uint. Clipped vertices have no place there: the few facets
//! across the near plane or the guard band are drawn wrong, which costs nothing and is counted: pixels that show
//! another facet than ours must be fewer than 1 %.

use hachure::error::{Error, Result};
use hachure::gpu::Gpu;
use hachure::render::Renderer;
use hachure::surface::lattice::{CHUNK_FACETS, CHUNK_SIDE, CHUNK_VERTICES};
use hachure::view::Camera;
use wgpu::util::{BufferInitDescriptor, DeviceExt};

/// What the facet ID comes from; without it a vertex's index stands in, as much work and no use.
pub const FEATURE: wgpu::Features = wgpu::Features::PRIMITIVE_INDEX;

const VERTEX: &str = "
    @group(0) @binding(0) var<storage, read> screens: array<vec4<i32>>;
    @group(0) @binding(1) var<uniform> half_page: vec4<i32>;

    struct Corner {
        @builtin(position) place: vec4<f32>,
        @location(0) @interpolate(flat, either) index: u32,
    }

    @vertex
    fn place(@builtin(vertex_index) i: u32) -> Corner {
        let v = screens[i];
        let ndc = vec2<f32>(v.xy - half_page.xy) / vec2<f32>(half_page.xy);
        // Clipped and missing vertices lie before the near plane.
        let seen = (v.w & 112) == 0;
        return Corner(select(vec4<f32>(0.0, 0.0, -1.0, 1.0), vec4<f32>(ndc.x, -ndc.y, bitcast<f32>(v.z), 1.0), seen), i);
    }
";
const BY_PRIMITIVE: &str = "
    @fragment
    fn show(@builtin(primitive_index) id: u32) -> @location(0) u32 {
        return id + 1u;
    }
";
const BY_VERTEX: &str = "
    @fragment
    fn show(corner: Corner) -> @location(0) u32 {
        return corner.index + 1u;
    }
";

fn has_feature(gpu: &Gpu) -> bool {
    gpu.device.features().contains(FEATURE)
}

/// What the ID of a facet comes from, in words.
pub fn id_source(gpu: &Gpu) -> &'static str {
    if has_feature(gpu) { "primitive_index" } else { "a flat vertex index (no primitive_index here)" }
}

/// One draw of a scene's facets.
pub struct Baseline<'a> {
    gpu: &'a Gpu,
    vertices: &'a Renderer<'a>,
    indices: wgpu::Buffer,
    count: u32,
    pipeline: wgpu::RenderPipeline,
    group: wgpu::BindGroup,
    views: [wgpu::TextureView; 2],
}

impl<'a> Baseline<'a> {
    /// Uploads the indices and compiles the draw.
    pub fn new(gpu: &'a Gpu, vertices: &'a Renderer<'a>, size: [u32; 2]) -> Result<Self> {
        let device = &gpu.device;
        let indices = indices(vertices);
        let buffer =
            |contents: &[u8], usage| device.create_buffer_init(&BufferInitDescriptor { label: None, contents, usage });
        let half = size.map(|n| n as i32 * 128);
        let half_page = buffer(bytemuck::cast_slice(&[half[0], half[1], 0, 0]), wgpu::BufferUsages::UNIFORM);
        let pipeline = pipeline(gpu);
        let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
        let buffers = vertices.buffers();
        let screens = buffers.get("screens")?.as_entire_binding();
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("baseline"),
            layout: &pipeline.get_bind_group_layout(0),
            entries: &[entry(0, screens), entry(1, half_page.as_entire_binding())],
        });
        let [width, height] = size;
        let views = [wgpu::TextureFormat::R32Uint, wgpu::TextureFormat::Depth32Float].map(|format| {
            let texture = device.create_texture(&wgpu::TextureDescriptor {
                label: Some("baseline"),
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
        let count = indices.len() as u32;
        let indices = buffer(bytemuck::cast_slice(&indices), wgpu::BufferUsages::INDEX);
        Ok(Self { gpu, vertices, indices, count, pipeline, group, views })
    }

    /// Draws a frame and waits for it.
    pub fn frame(&self, camera: &Camera) -> Result<()> {
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        self.vertices.record_vertices(camera, &mut encoder)?;
        let store = wgpu::StoreOp::Store;
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("baseline"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &self.views[0],
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT), store },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.views[1],
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.group, &[]);
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(0..self.count, 0, 0..1);
        drop(pass);
        self.gpu.queue.submit([encoder.finish()]);
        self.gpu.wait()
    }

    /// Share of the covered pixels that show another facet than `pixels` (ID + 1, depth bits) of the same camera.
    ///
    /// # Errors
    /// [`Error::Gpu`] when they are 1 % or more: the baseline would not draw what we draw.
    pub fn compare(&self, pixels: &[[u32; 2]]) -> Result<f64> {
        let texture = self.views[0].texture();
        let size = u64::from(texture.width()) * u64::from(texture.height()) * 4;
        let buffer = self.gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size,
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        let layout =
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(texture.width() * 4), rows_per_image: None };
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        let target = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
        encoder.copy_texture_to_buffer(texture.as_image_copy(), target, texture.size());
        self.gpu.queue.submit([encoder.finish()]);
        let ids: Vec<u32> = bytemuck::pod_collect_to_vec(&self.gpu.read(&buffer, size)?);
        let covered = pixels.iter().filter(|p| p[1] != 0).count();
        let differ = ids.iter().zip(pixels).filter(|(id, pixel)| **id != pixel[0]).count();
        let share = differ as f64 / covered as f64;
        if has_feature(self.gpu) && (covered == 0 || share >= 0.01) {
            return Err(Error::Gpu {
                what: format!("{differ} of {covered} pixels of the baseline show another facet"),
            });
        }
        Ok(share)
    }
}

/// Three indices into the vertex buffer a facet, in the order of the IDs.
fn indices(vertices: &Renderer<'_>) -> Vec<u32> {
    let lattice = vertices.lattice();
    let facets = 0..lattice.chunks().len() as u32 * CHUNK_FACETS;
    let corners = facets.flat_map(|id| {
        let slot = id / CHUNK_FACETS;
        let chunk = lattice.chunks()[slot as usize];
        lattice.facet(id).map(|at| {
            let [x, y] = [at.x - chunk.origin[0], at.y - chunk.origin[1]].map(|d| d / chunk.step);
            slot * CHUNK_VERTICES + y * CHUNK_SIDE + x
        })
    });
    corners.collect()
}

fn pipeline(gpu: &Gpu) -> wgpu::RenderPipeline {
    let source = if has_feature(gpu) {
        format!("enable primitive_index;\n{VERTEX}{BY_PRIMITIVE}")
    } else {
        format!("{VERTEX}{BY_VERTEX}")
    };
    let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("baseline"),
        source: wgpu::ShaderSource::Wgsl(source.into()),
    });
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("baseline"),
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("place"),
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
