//! Errors about declarations that this device cannot have, each with its line.

use crate::gpu::{Gpu, MeshLimits, OptionalStages};
use crate::shader::annotation::pass::PassSize;
use crate::shader::contract::Texts;
use crate::shader::graph::stage_beside;
use crate::shader::source::snapshot::Snapshot;
use crate::shader::{Diagnostic, ShaderSet, Source, Stage, StageKind};

/// Errors about passes whose images are too large for the device, stages that it lacks, and buffers that a stage cannot write.
/// `source` is the tree of the shaders.
pub fn beyond_limits(gpu: &Gpu, shaders: &ShaderSet, source: &Source) -> Vec<Diagnostic> {
    let graph = &shaders.graph;
    let most = gpu.max_image_size();
    let too_large = |(width, height): (u32, u32)| {
        let message = format!("has {width} x {height} pixels; this device has at most {most} a side");
        (width > most || height > most).then_some(message)
    };
    let mut out = unwritable_buffers(gpu.graphics_stores(), shaders, source);
    out.extend(missing_stages(gpu.optional_stages(), shaders, source));
    for pass in &graph.passes {
        if let PassSize::Pixels(width, height) = pass.desc.size {
            let message = too_large((width, height));
            out.extend(
                message
                    .map(|message| pass.desc.place.error_at("size=", format!("the pass `{}` {message}", pass.name()))),
            );
        }
    }
    out
}

/// Errors about buffers without `readonly` on a device that lets only compute shaders write. `stores`: whether vertex stages and
/// fragment stages can write.
fn unwritable_buffers(stores: (bool, bool), shaders: &ShaderSet, source: &Source) -> Vec<Diagnostic> {
    let mut out = Vec::new();
    let snapshot = Snapshot::new(source);
    for stage in shaders.stages.values() {
        let name = match stage.kind {
            StageKind::Fragment if !stores.1 => stage.kind.name(),
            kind if kind.is_pre_rasterization() && !kind.is_of_mesh_pipeline() && !stores.0 => kind.name(),
            _ => continue,
        };
        let texts = Texts { snapshot: &snapshot, stage: &stage.path, dependencies: &stage.dependencies };
        for buffer in stage.reflection.descriptors.iter().filter(|descriptor| descriptor.is_written) {
            let message = format!("this device cannot write the buffer `{}` in a {name} stage", buffer.name);
            let error = texts.error(&[buffer.name.as_str(), "buffer"], message);
            out.push(error.with_help("declare it `readonly buffer`; a compute pass can write it"));
        }
    }
    out
}

/// Errors about stages that the device lacks, and about `gl_PointSize` where it is not allowed.
fn missing_stages(has: OptionalStages, shaders: &ShaderSet, source: &Source) -> Vec<Diagnostic> {
    const TESSELLATION_POINT_SIZE: u32 = 23;
    const GEOMETRY_POINT_SIZE: u32 = 24;
    const SAMPLE_SHADING: u32 = 35;
    const MESH_SHADING: u32 = 5283;
    let mut out = Vec::new();
    let snapshot = Snapshot::new(source);
    for stage in shaders.stages.values() {
        let texts = Texts { snapshot: &snapshot, stage: &stage.path, dependencies: &stage.dependencies };
        let is_tessellation = matches!(stage.kind, StageKind::TessellationControl | StageKind::TessellationEvaluation);
        let mut capabilities = stage.reflection.capabilities.iter();
        if is_tessellation && !has.tessellation {
            let message = "this device has no tessellation stages (tessellationShader)".to_owned();
            out.push(texts.error(&["main", "void"], message).with_help("delete the .tesc and the .tese file"));
        } else if stage.reflection.capabilities.contains(&MESH_SHADING) {
            out.extend(beyond_mesh(has.mesh, stage, texts));
        } else if !has.sample_shading && stage.reflection.capabilities.contains(&SAMPLE_SHADING) {
            let message = "this device runs no fragment stage for each sample (sampleRateShading)".to_owned();
            out.push(texts.error(&["gl_SampleID", "gl_SamplePosition", "sample"], message));
        } else if !has.point_size
            && capabilities.any(|number| matches!(*number, TESSELLATION_POINT_SIZE | GEOMETRY_POINT_SIZE))
        {
            let name = stage.kind.name();
            let message =
                format!("this device has no gl_PointSize in a {name} stage (shaderTessellationAndGeometryPointSize)");
            out.push(texts.error(&["gl_PointSize"], message));
        }
    }
    out
}

/// An error about a stage that uses VK_EXT_mesh_shader, on a device that lacks it or has smaller limits.
fn beyond_mesh(limits: Option<MeshLimits>, stage: &Stage, texts: Texts<'_>) -> Option<Diagnostic> {
    let (name, path) = (stage.kind.name(), stage.path.as_str());
    let Some(limits) = limits else {
        let message = format!("this device lacks VK_EXT_mesh_shader, which this {name} stage needs");
        return Some(match stage.kind.is_of_mesh_pipeline() {
            true => {
                let vertex = stage_beside(path, StageKind::Vertex);
                let help = format!("delete this file: the pass works with {vertex}, or with the model's vertex stage");
                texts.error(&["main", "void"], message).with_help(help)
            }
            false => texts.error(&["GL_EXT_mesh_shader"], message),
        });
    };
    let invocations = stage.reflection.local_size.iter().product();
    let [vertices, primitives] = stage.reflection.mesh_outputs;
    let rows: &[(u32, u32, &str, &str)] = match stage.kind {
        StageKind::Task => &[(invocations, limits.task_invocations, "invocations", "local_size_x")],
        StageKind::Mesh => &[
            (invocations, limits.mesh_invocations, "invocations", "local_size_x"),
            (vertices, limits.vertices, "vertices", "max_vertices"),
            (primitives, limits.primitives, "primitives", "max_primitives"),
        ],
        _ => &[],
    };
    let (found, most, of, word) = rows.iter().find(|(found, most, ..)| found > most)?;
    let message = format!("a workgroup has {found} {of}; this device has at most {most} in a {name} stage");
    Some(texts.error(&[word], message))
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::shader::{Change, Compiler, Library, Update};

    #[test]
    fn buffers_that_a_stage_cannot_write_have_their_line() {
        let buffer = |name: &str, readonly: &str| {
            format!("layout(set = 0, binding = 14, std430)\n{readonly} buffer {name} {{ uint a; uint b; }};\n")
        };
        let vertex =
            format!("#version 460\n{}void main() {{ b = a; gl_Position = vec4(0.0); }}\n", buffer("OfVertices", ""));
        let fragment = |readonly: &str, body: &str| {
            let color = "layout(location = 0) out vec4 color;";
            format!("#version 460\n{color}\n{}void main() {{ {body} }}\n", buffer("OfPixels", readonly))
        };
        let (writes, reads) = (fragment("", "b = a; color = vec4(1.0);"), fragment("readonly", "color = vec4(a + b);"));
        let source =
            Source::memory([("v.vert", vertex.as_str()), ("w.frag", writes.as_str()), ("r.frag", reads.as_str())]);
        let compiler = Arc::new(Compiler::new().unwrap());
        let mut library = Library::new(source.clone(), compiler, &["v.vert", "w.frag", "r.frag"]);
        let update = library.update(&Change::All);
        let Update::Ready(shaders, _) = &update else { panic!("{update:?}") };
        let found = |stores: (bool, bool)| -> Vec<String> {
            unwritable_buffers(stores, shaders, &source).iter().map(Diagnostic::one_line).collect()
        };
        assert_eq!(found((true, true)), [""; 0]);
        let of_vertices = "v.vert:3:9: error: this device cannot write the buffer `OfVertices` in a vertex stage";
        let of_pixels = "w.frag:4:9: error: this device cannot write the buffer `OfPixels` in a fragment stage";
        assert_eq!(found((false, true)), [of_vertices]);
        assert_eq!(found((false, false)), [of_vertices, of_pixels]);
    }

    #[test]
    fn stages_that_a_device_lacks_have_their_line() {
        let control = "#version 460\nlayout(vertices = 3) out;\nvoid main() { gl_TessLevelInner[0] = 1.0; }\n";
        let geometry = "#version 460\nlayout(triangles) in;\nlayout(points, max_vertices = 1) out;\n\
            void main() {\n    gl_Position = gl_in[0].gl_Position;\n    gl_PointSize = 2.0;\n    EmitVertex();\n}\n";
        let source = Source::memory([("c.tesc", control), ("g.geom", geometry)]);
        let mut library = Library::new(source.clone(), Arc::new(Compiler::new().unwrap()), &["c.tesc", "g.geom"]);
        let update = library.update(&Change::All);
        let Update::Ready(shaders, _) = &update else { panic!("{update:?}") };
        let found = |tessellation: bool, point_size: bool| -> Vec<String> {
            let has = OptionalStages { tessellation, point_size, sample_shading: true, mesh: None };
            missing_stages(has, shaders, &source).iter().map(Diagnostic::one_line).collect()
        };
        assert_eq!(found(true, true), [""; 0]);
        assert_eq!(
            found(false, true),
            ["c.tesc:3:6: error: this device has no tessellation stages (tessellationShader)"]
        );
        assert_eq!(
            found(true, false),
            [
                "g.geom:6:5: error: this device has no gl_PointSize in a geometry stage (shaderTessellationAndGeometryPointSize)"
            ]
        );
    }

    #[test]
    fn mesh_stages_beyond_the_device_have_their_line() {
        let mesh = "#version 460\n#extension GL_EXT_mesh_shader : require\nlayout(local_size_x = 64) in;\n\
            layout(triangles, max_vertices = 90, max_primitives = 30) out;\nvoid main() { SetMeshOutputsEXT(0, 0); }\n";
        let source = Source::memory([("m.mesh", mesh)]);
        let mut library = Library::new(source.clone(), Arc::new(Compiler::new().unwrap()), &["m.mesh"]);
        let update = library.update(&Change::All);
        let Update::Ready(shaders, _) = &update else { panic!("{update:?}") };
        let found = |mesh: Option<MeshLimits>| -> Vec<String> {
            let has = OptionalStages { tessellation: true, point_size: true, sample_shading: true, mesh };
            missing_stages(has, shaders, &source).iter().map(Diagnostic::one_line).collect()
        };
        let limits = MeshLimits { task_invocations: 1, mesh_invocations: 64, vertices: 90, primitives: 30 };
        assert_eq!(found(Some(limits)), [""; 0]);
        let too_few = [
            (None, "5:6: error: this device lacks VK_EXT_mesh_shader, which this mesh stage needs"),
            (
                Some(MeshLimits { mesh_invocations: 32, ..limits }),
                "3:8: error: a workgroup has 64 invocations; this device has at most 32 in a mesh stage",
            ),
            (
                Some(MeshLimits { vertices: 89, ..limits }),
                "4:19: error: a workgroup has 90 vertices; this device has at most 89 in a mesh stage",
            ),
            (
                Some(MeshLimits { primitives: 3, ..limits }),
                "4:38: error: a workgroup has 30 primitives; this device has at most 3 in a mesh stage",
            ),
        ];
        for (limits, expected) in too_few {
            assert_eq!(found(limits), [format!("m.mesh:{expected}")]);
        }
    }
}
