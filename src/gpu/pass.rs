//! A compute pass: composed WGSL, its pipeline, and its bindings by name.
//!
//! Nothing a shader says is typed again here: binding numbers and workgroup sizes are read from the shader. A global
//! is bound to the buffer of its name; `out_` before it says that the pass writes it.

use std::borrow::Cow;

use wgpu::naga;

use super::device::Gpu;
use crate::error::{Error, Result};

/// The WGSL of a pass: the named files of `shaders/`, each standing on those before it.
#[macro_export]
macro_rules! shader {
    ($($name:literal),+ $(,)?) => {
        concat!($(include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/shaders/", $name, ".wgsl")), "\n"),+)
    };
}

/// How far a pass reaches.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Extent {
    /// At least so many invocations along x and y.
    Invocations([u32; 2]),
    /// As many workgroups as the first three words of the list of this name say.
    List(&'static str),
}

impl From<[u32; 2]> for Extent {
    fn from(invocations: [u32; 2]) -> Self {
        Self::Invocations(invocations)
    }
}

/// A compiled pass.
pub struct Pass {
    /// Name of the shader file, the entry point, the label and the timer.
    pub name: &'static str,
    /// Invocations of a workgroup along x, y, z.
    pub workgroup: [u32; 3],
    pipeline: wgpu::ComputePipeline,
    bindings: Vec<(u32, String)>,
}

/// What a composed shader says of one entry point: workgroup size, and the bindings it uses with their buffer names.
pub struct Reflection {
    /// Invocations along x, y, z.
    pub workgroup: [u32; 3],
    /// Binding number and buffer name.
    pub bindings: Vec<(u32, String)>,
    /// The parsed module, for comparing structs.
    pub module: naga::Module,
}

/// Reads a composed shader.
///
/// # Errors
/// [`Error::Gpu`] when it is no valid WGSL or lacks the entry point.
pub fn reflect(name: &str, source: &str) -> Result<Reflection> {
    let fail = |what: String| Error::Gpu { what: format!("shader {name}: {what}") };
    let module = naga::front::wgsl::parse_str(source).map_err(|e| fail(e.emit_to_string(source)))?;
    let mut validator = naga::valid::Validator::new(Default::default(), naga::valid::Capabilities::all());
    let info = validator.validate(&module).map_err(|e| fail(e.emit_to_string(source)))?;
    let index = module.entry_points.iter().position(|e| e.name == name).ok_or_else(|| fail("no entry point".into()))?;
    let used = info.get_entry_point(index);
    let bindings = module
        .global_variables
        .iter()
        .filter(|(handle, _)| !used[*handle].is_empty())
        .filter_map(|(_, global)| {
            let label = global.name.as_deref()?;
            Some((global.binding.as_ref()?.binding, label.strip_prefix("out_").unwrap_or(label).to_owned()))
        })
        .collect();
    Ok(Reflection { workgroup: module.entry_points[index].workgroup_size, bindings, module })
}

impl Pass {
    /// Compiles the entry point `name` of a composed shader with these pipeline constants.
    ///
    /// # Errors
    /// [`Error::Gpu`] when the shader or the driver refuses.
    pub fn new(gpu: &Gpu, name: &'static str, source: &str, constants: &[(&str, f64)]) -> Result<Self> {
        let reflection = reflect(name, source)?;
        let known =
            |constant: &str| reflection.module.overrides.iter().any(|(_, o)| o.name.as_deref() == Some(constant));
        let constants: Vec<_> = constants.iter().copied().filter(|(constant, _)| known(constant)).collect();
        let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(name),
            source: wgpu::ShaderSource::Wgsl(Cow::Borrowed(source)),
        });
        let pipeline = gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(name),
            layout: None,
            module: &module,
            entry_point: Some(name),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants: &constants,
                // Passes read of it only what they wrote.
                zero_initialize_workgroup_memory: false,
            },
            cache: None,
        });
        gpu.check()?;
        Ok(Self { name, workgroup: reflection.workgroup, pipeline, bindings: reflection.bindings })
    }

    /// Binds every global of the pass to the resource of its name.
    ///
    /// # Errors
    /// [`Error::Gpu`] when a name is unknown or the driver refuses.
    pub fn bind<'a>(
        &self,
        gpu: &Gpu,
        resource: impl Fn(&str) -> Option<wgpu::BindingResource<'a>>,
    ) -> Result<wgpu::BindGroup> {
        let entries = self.bindings.iter().map(|(binding, label)| {
            let resource = resource(label)
                .ok_or_else(|| Error::Gpu { what: format!("pass {}: no buffer is named {label}", self.name) })?;
            Ok(wgpu::BindGroupEntry { binding: *binding, resource })
        });
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(self.name),
            layout: &self.pipeline.get_bind_group_layout(0),
            entries: &entries.collect::<Result<Vec<_>>>()?,
        });
        gpu.check()?;
        Ok(group)
    }

    /// Records the pass over at least `invocations` along x and y.
    pub fn record(&self, pass: &mut wgpu::ComputePass<'_>, group: &wgpu::BindGroup, invocations: [u32; 2]) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, group, &[]);
        let [x, y] = [0, 1].map(|axis| invocations[axis].div_ceil(self.workgroup[axis]));
        pass.dispatch_workgroups(x, y, 1);
    }

    /// Records the pass over as many workgroups as the first three words of `list` say.
    pub fn record_over(&self, pass: &mut wgpu::ComputePass<'_>, group: &wgpu::BindGroup, list: &wgpu::Buffer) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, group, &[]);
        pass.dispatch_workgroups_indirect(list, 0);
    }
}
