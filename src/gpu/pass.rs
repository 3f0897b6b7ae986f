//! A compute pass: composed WGSL, its pipeline, and its bindings by name.
//!
//! Nothing a shader says is typed again here: binding numbers and workgroup sizes are read from the shader. A global
//! is bound to the buffer of its name; `out_` before it says that the pass writes it.

use wgpu::naga;

use super::compiled::Shader;
use super::device::{Gpu, one_line};
use crate::error::{Error, Result};

/// The WGSL of a pass: the named files of `shaders/`, each standing on those before it.
#[doc(hidden)]
#[macro_export]
macro_rules! shader {
    ($($name:literal),+ $(,)?) => {
        concat!($(include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/shaders/", $name, ".wgsl")), "\n"),+)
    };
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

/// What a composed shader says of one entry point: workgroup size, the bindings it uses with their buffer names, and its
/// pipeline constants.
pub struct Reflection {
    /// Invocations along x, y, z.
    pub workgroup: [u32; 3],
    /// Binding number and buffer name.
    pub bindings: Vec<(u32, String)>,
    /// The constants that the shader declares.
    pub overrides: Vec<Override>,
}

/// A pipeline constant of a shader.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Override {
    /// Its name.
    pub name: String,
    /// Whether the entry point depends on it.
    pub is_used: bool,
    /// Whether it has a value where none is given.
    pub has_default: bool,
}

/// Parses a composed shader of pass `name`, and says what its parts use.
///
/// # Errors
/// [`Error::Mistake`] when it is no valid WGSL.
pub fn parse(name: &str, source: &str) -> Result<(naga::Module, naga::valid::ModuleInfo)> {
    let fail = |what: String| mistake(name, one_line(&what));
    let module = naga::front::wgsl::parse_str(source).map_err(|e| fail(e.emit_to_string(source)))?;
    let mut validator = naga::valid::Validator::new(Default::default(), naga::valid::Capabilities::all());
    let info = validator.validate(&module).map_err(|e| fail(e.emit_to_string(source)))?;
    Ok((module, info))
}

/// Reads a composed shader.
///
/// # Errors
/// As [`parse`]; [`Error::Mistake`] when it lacks the entry point.
pub fn reflect(name: &str, source: &str) -> Result<Reflection> {
    let (module, info) = parse(name, source)?;
    let none = || mistake(name, "no entry point");
    let index = module.entry_points.iter().position(|e| e.name == name).ok_or_else(none)?;
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
    let workgroup = module.entry_points[index].workgroup_size;
    Ok(Reflection { workgroup, bindings, overrides: overrides(name, &module) })
}

/// The pipeline constants of a valid module.
fn overrides(name: &str, module: &naga::Module) -> Vec<Override> {
    let mut alone = module.clone();
    alone.entry_points.retain(|entry| entry.name == name);
    naga::compact::compact(&mut alone, naga::compact::KeepUnused::No);
    let is_used = |name: &str| alone.overrides.iter().any(|(_, used)| used.name.as_deref() == Some(name));
    let declared = module.overrides.iter().filter_map(|(_, declared)| Some((declared.name.as_ref()?, declared.init)));
    let of = |(name, init): (&String, Option<_>)| Override {
        name: name.clone(),
        is_used: is_used(name),
        has_default: init.is_some(),
    };
    declared.map(of).collect()
}

/// Of the constants given to a pass those on which it depends.
///
/// # Errors
/// [`Error::Mistake`] when the shader declares none of a name, or depends on one that has no value.
pub(crate) fn select<'a>(name: &str, overrides: &[Override], given: &[(&'a str, f64)]) -> Result<Vec<(&'a str, f64)>> {
    let is_declared = |constant: &str| overrides.iter().any(|declared| declared.name == constant);
    if let Some((unknown, _)) = given.iter().find(|(constant, _)| !is_declared(constant)) {
        return Err(mistake(name, format!("no constant is named {unknown}")));
    }
    let is_given = |constant: &str| given.iter().any(|(given, _)| *given == constant);
    if let Some(unset) = overrides.iter().find(|o| o.is_used && !o.has_default && !is_given(&o.name)) {
        return Err(mistake(name, format!("the constant {} has no value", unset.name)));
    }
    let is_used = |constant: &str| overrides.iter().any(|o| o.is_used && o.name == constant);
    Ok(given.iter().copied().filter(|(constant, _)| is_used(constant)).collect())
}

/// A mistake in a shader, or in what is given to it.
fn mistake(name: &str, what: impl std::fmt::Display) -> Error {
    Error::mistake(format!("pass {name}: {what}"))
}

impl Pass {
    /// Compiles the entry point of a composed shader, of which [`reflect`] says this, with these pipeline constants, see
    /// [`select`]. Passes of frames come from [`Gpu::pass`], which compiles each once.
    ///
    /// # Errors
    /// [`Error::Gpu`] when the driver refuses.
    pub(super) fn compile(
        gpu: &Gpu,
        (name, source): Shader,
        reflection: &Reflection,
        constants: &[(&str, f64)],
    ) -> Result<Self> {
        let pipeline = gpu.checked(|| {
            let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some(name),
                source: wgpu::ShaderSource::Wgsl(source),
            });
            gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(name),
                layout: None,
                module: &module,
                entry_point: Some(name),
                compilation_options: wgpu::PipelineCompilationOptions {
                    constants,
                    // Passes read of it only what they wrote.
                    zero_initialize_workgroup_memory: false,
                },
                cache: None,
            })
        })?;
        Ok(Self { name, workgroup: reflection.workgroup, pipeline, bindings: reflection.bindings.clone() })
    }

    /// Binds every global of the pass to the resource of its name.
    ///
    /// # Errors
    /// [`Error::Mistake`] when a name is unknown, [`Error::Gpu`] when the driver refuses.
    pub fn bind<'a>(
        &self,
        gpu: &Gpu,
        resource: impl Fn(&str) -> Option<wgpu::BindingResource<'a>>,
    ) -> Result<wgpu::BindGroup> {
        let entries = self.bindings.iter().map(|(binding, label)| {
            let resource = resource(label).ok_or_else(|| mistake(self.name, format!("no buffer is named {label}")))?;
            Ok(wgpu::BindGroupEntry { binding: *binding, resource })
        });
        let entries = entries.collect::<Result<Vec<_>>>()?;
        gpu.checked(|| {
            gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some(self.name),
                layout: &self.pipeline.get_bind_group_layout(0),
                entries: &entries,
            })
        })
    }

    /// So many invocations, folded into rows of 65 535 workgroups.
    pub fn folded(&self, invocations: u64) -> [u32; 2] {
        let row = 65_535 * u64::from(self.workgroup[0]);
        [invocations.min(row) as u32, invocations.div_ceil(row) as u32]
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
