//! Snapped triangles drawn by the device's own rasterizer: another implementation of the same coverage rules.
//!
//! The vertex shader turns 1/256 px into clip coordinates with w = 1. That is exact only where the page's sides are
//! powers of two: x - 128 * width is an integer below 2^24, dividing it by a power of two loses nothing, nor does the
//! viewport's way back. The driver snaps to 1/256 px as well (Vulkan guarantees 4 bits, the software driver has 8).
//! Facets that leave the page by more than half of it are cut to a guard band before they are drawn, with other
//! roundings: such scenes are no use here. Equal depths: the later triangle wins, as the higher ID does in ours.

use hachure::gpu::Gpu;
use wgpu::util::{BufferInitDescriptor, DeviceExt};

/// A vertex: x and y in 1/256 px, depth bits, and the ID its triangle is drawn with.
pub type Vertex = [i32; 4];

const SHADER: &str = "
    @group(0) @binding(0) var<storage, read> vertices: array<vec4<i32>>;
    @group(0) @binding(1) var<uniform> half_page: vec4<i32>;

    struct Corner {
        @builtin(position) place: vec4<f32>,
        @location(0) @interpolate(flat, either) id: u32,
    }

    @vertex
    fn place(@builtin(vertex_index) i: u32) -> Corner {
        let v = vertices[i];
        let ndc = vec2<f32>(v.xy - half_page.xy) / vec2<f32>(half_page.xy);
        return Corner(vec4<f32>(ndc.x, -ndc.y, bitcast<f32>(v.z), 1.0), u32(v.w));
    }

    struct Pixel {
        @location(0) id: u32,
        @location(1) depth: u32,
    }

    @fragment
    fn show(corner: Corner) -> Pixel {
        return Pixel(corner.id + 1u, bitcast<u32>(corner.place.z));
    }
";

/// Draws triangles on a page whose sides are powers of two; ID + 1 and depth bits of each pixel, row by row.
pub fn draw(gpu: &Gpu, triangles: &[[Vertex; 3]], size: [u32; 2]) -> Vec<[u32; 2]> {
    assert!(size.iter().all(|n| n.is_power_of_two() && *n >= 64), "{size:?} is no exact page");
    let device = &gpu.device;
    let half = size.map(|n| n as i32 * 128);
    let buffer =
        |contents: &[u8], usage| device.create_buffer_init(&BufferInitDescriptor { label: None, contents, usage });
    let vertices = buffer(bytemuck::cast_slice(triangles), wgpu::BufferUsages::STORAGE);
    let half_page = buffer(bytemuck::cast_slice(&[half[0], half[1], 0, 0]), wgpu::BufferUsages::UNIFORM);
    let pipeline = pipeline(device);
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[
            wgpu::BindGroupEntry { binding: 0, resource: vertices.as_entire_binding() },
            wgpu::BindGroupEntry { binding: 1, resource: half_page.as_entire_binding() },
        ],
    });
    let textures = [wgpu::TextureFormat::R32Uint, wgpu::TextureFormat::R32Uint, wgpu::TextureFormat::Depth32Float]
        .map(|format| texture(device, format, size));
    let views = textures.each_ref().map(|t| t.create_view(&Default::default()));
    let clear = wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT), store: wgpu::StoreOp::Store };
    let colour =
        |view| Some(wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops: clear });
    let mut encoder = device.create_command_encoder(&Default::default());
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[colour(&views[0]), colour(&views[1])],
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: &views[2],
            depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store }),
            stencil_ops: None,
        }),
        ..Default::default()
    });
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &group, &[]);
    pass.draw(0..3 * triangles.len() as u32, 0..1);
    drop(pass);
    gpu.queue.submit([encoder.finish()]);
    gpu.check().expect("the draw is accepted");
    let [ids, depths] = [&textures[0], &textures[1]].map(|t| read(gpu, t, size));
    ids.into_iter().zip(depths).map(|(id, depth)| [id, depth]).collect()
}

fn pipeline(device: &wgpu::Device) -> wgpu::RenderPipeline {
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("hardware"),
        source: wgpu::ShaderSource::Wgsl(SHADER.into()),
    });
    let target = Some(wgpu::ColorTargetState::from(wgpu::TextureFormat::R32Uint));
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("hardware"),
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
            depth_compare: Some(wgpu::CompareFunction::GreaterEqual),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("show"),
            compilation_options: Default::default(),
            targets: &[target.clone(), target],
        }),
        multiview_mask: None,
        cache: None,
    })
}

fn texture(device: &wgpu::Device, format: wgpu::TextureFormat, [width, height]: [u32; 2]) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    })
}

fn read(gpu: &Gpu, texture: &wgpu::Texture, [width, height]: [u32; 2]) -> Vec<u32> {
    let size = u64::from(width) * u64::from(height) * 4;
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size,
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC,
        mapped_at_creation: false,
    });
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(width * 4), rows_per_image: None };
    let target = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
    encoder.copy_texture_to_buffer(texture.as_image_copy(), target, texture.size());
    gpu.queue.submit([encoder.finish()]);
    gpu.read(&buffer, (width * height) as usize).expect("a copy of the texture")
}
