//! Extensions and features that Specula uses where the device has them. It works without any of them.

use std::ffi::{CStr, c_char};

use ash::{ext, khr, vk};

use crate::gpu::fault;

/// The optional extensions that a device has.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::gpu) struct Optional {
    /// The driver reports pipeline statistics.
    pub(in crate::gpu) executables: bool,
    /// The driver reports a memory budget.
    pub(in crate::gpu) memory_budget: bool,
    /// Task and mesh stages.
    pub(in crate::gpu) mesh: Option<MeshLimits>,
    /// Draws that stages can tell apart.
    pub(in crate::gpu) draws: DrawFeatures,
    /// Fragment stages can ask which invocations of their quad run along.
    pub(in crate::gpu) quad_ballots: bool,
}

/// How a device tells stages which draw they run for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DrawFeatures {
    /// Stages can read `gl_BaseInstance`, also in draws whose arguments are in a buffer.
    pub by_index: bool,
    /// The most draws of one command; 1 without `multiDrawIndirect`.
    pub at_once: u32,
}

impl DrawFeatures {
    fn of(instance: &ash::Instance, physical: vk::PhysicalDevice) -> Self {
        let mut v11 = vk::PhysicalDeviceVulkan11Features::default();
        let mut features = vk::PhysicalDeviceFeatures2::default().push_next(&mut v11);
        // SAFETY: `physical` comes from this live instance; the chain is valid for the call.
        unsafe { instance.get_physical_device_features2(physical, &mut features) };
        let core = features.features;
        // SAFETY: as above.
        let limits = unsafe { instance.get_physical_device_properties(physical) }.limits;
        let has_several = core.multi_draw_indirect == vk::TRUE && fault::value("single-draws").is_none();
        Self {
            by_index: v11.shader_draw_parameters == vk::TRUE && core.draw_indirect_first_instance == vk::TRUE,
            at_once: if has_several { limits.max_draw_indirect_count.max(1) } else { 1 },
        }
    }
}

/// The limits of task and mesh stages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MeshLimits {
    /// Invocations of a workgroup of a task stage.
    pub task_invocations: u32,
    /// Invocations of a workgroup of a mesh stage.
    pub mesh_invocations: u32,
    /// Vertices that a workgroup of a mesh stage may output.
    pub vertices: u32,
    /// Primitives that a workgroup of a mesh stage may output.
    pub primitives: u32,
}

/// The limits of task and mesh stages, if the device has both. It must have the extension.
fn mesh_limits(instance: &ash::Instance, physical: vk::PhysicalDevice) -> Option<MeshLimits> {
    let mut mesh = vk::PhysicalDeviceMeshShaderFeaturesEXT::default();
    let mut features = vk::PhysicalDeviceFeatures2::default().push_next(&mut mesh);
    // SAFETY: `physical` comes from this live instance; the chain is valid for the call.
    unsafe { instance.get_physical_device_features2(physical, &mut features) };
    if mesh.task_shader == vk::FALSE || mesh.mesh_shader == vk::FALSE {
        return None;
    }
    let mut limits = vk::PhysicalDeviceMeshShaderPropertiesEXT::default();
    let mut properties = vk::PhysicalDeviceProperties2::default().push_next(&mut limits);
    // SAFETY: as above.
    unsafe { instance.get_physical_device_properties2(physical, &mut properties) };
    Some(MeshLimits {
        task_invocations: limits.max_task_work_group_invocations,
        mesh_invocations: limits.max_mesh_work_group_invocations,
        vertices: limits.max_mesh_output_vertices,
        primitives: limits.max_mesh_output_primitives,
    })
}

/// Whether four neighboring invocations of a subgroup are a quad, and their fragment stage has ballots.
fn quad_ballots(instance: &ash::Instance, physical: vk::PhysicalDevice) -> bool {
    use vk::SubgroupFeatureFlags as Feature;
    let mut subgroups = vk::PhysicalDeviceSubgroupProperties::default();
    let mut properties = vk::PhysicalDeviceProperties2::default().push_next(&mut subgroups);
    // SAFETY: `physical` comes from this live instance; the chain is valid for the call.
    unsafe { instance.get_physical_device_properties2(physical, &mut properties) };
    // Mesa's software device has quads in this order without saying so.
    let is_cpu = properties.properties.device_type == vk::PhysicalDeviceType::CPU;
    let operations = subgroups.supported_operations;
    subgroups.supported_stages.contains(vk::ShaderStageFlags::FRAGMENT)
        && operations.contains(Feature::BASIC | Feature::BALLOT)
        && (operations.contains(Feature::QUAD) || is_cpu)
        && fault::value("no-quad-ballots").is_none()
}

impl Optional {
    pub(in crate::gpu) fn of(instance: &ash::Instance, physical: vk::PhysicalDevice) -> Self {
        // SAFETY: `physical` comes from this live instance.
        let extensions = unsafe { instance.enumerate_device_extension_properties(physical) }.unwrap_or_default();
        let has = |name: &CStr| extensions.iter().any(|e| e.extension_name_as_c_str() == Ok(name));
        let mut executables = vk::PhysicalDevicePipelineExecutablePropertiesFeaturesKHR::default();
        if has(khr::pipeline_executable_properties::NAME) {
            let mut features = vk::PhysicalDeviceFeatures2::default().push_next(&mut executables);
            // SAFETY: as above; the chain is valid for the call.
            unsafe { instance.get_physical_device_features2(physical, &mut features) };
        }
        Self {
            executables: executables.pipeline_executable_info == vk::TRUE,
            memory_budget: has(ext::memory_budget::NAME),
            draws: DrawFeatures::of(instance, physical),
            quad_ballots: quad_ballots(instance, physical),
            mesh: has(ext::mesh_shader::NAME).then(|| mesh_limits(instance, physical)).flatten(),
        }
    }

    /// The names of the extensions to enable.
    pub(in crate::gpu) fn names(self) -> impl Iterator<Item = *const c_char> {
        let all = [
            (self.executables, khr::pipeline_executable_properties::NAME),
            (self.memory_budget, ext::memory_budget::NAME),
            (self.mesh.is_some(), ext::mesh_shader::NAME),
        ];
        all.into_iter().filter(|(has, _)| *has).map(|(_, name)| name.as_ptr())
    }
}
