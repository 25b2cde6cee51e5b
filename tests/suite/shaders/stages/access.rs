//! The table of resources and stages in `shaders/README.md`: each cell works, or is refused at its line.

use std::collections::BTreeSet;

use specula::frame::stages::all_stages;
use specula::interface::{Resource, StageRole};
use specula::render::Capture;
use specula::shader::{Change, Library, Source, TreePath, Update};

use crate::support::{Session, Tree, assert_differ, compiler, glb, line_of, lines, load, model, ready, settings};

const PROBE: &str = "probe.glsl";
/// An image of 0.25 that other stages read by its name.
const IMAGE: &str = "//@pass probe_image size=1x1 format=r32f\n#version 460\n#include \"pass.glsl\"\n\
    void main() { color = vec4(0.25); }\n";

/// A library with a function for each resource, `reads_RESOURCE`: 1 if the resource has the value that the test gives to it.
const LIBRARY: &str = "\
#ifndef PROBE_GLSL
#define PROBE_GLSL
#include \"interface.glsl\"
#include \"user/params.glsl\"
layout(constant_id = USER_CONSTANTS + 40) const float PROBED = 1.0; //@ui \"Probed\" 0..2
layout(set = SET_MATERIAL, binding = BINDING_BASE_COLOR_TEXTURE) uniform sampler2D probe_texture;
layout(set = SET_FRAME, binding = BINDING_ENVIRONMENT) uniform samplerCube probe_environment;
layout(set = SET_FRAME, binding = BINDING_DFG) uniform sampler2D probe_table;
layout(set = SET_FRAME, binding = BINDING_BVH, scalar) readonly buffer ProbeNodes { BvhNode probe_nodes[]; };
layout(set = SET_TASK, binding = BINDING_DEFORMATIONS, scalar) readonly buffer ProbeInstances { Deformation probe_instances[]; };
uniform sampler2D probe_image;
float reads_constant() { return PROBED == 2.0 ? 1.0 : 0.0; }
float reads_params() { return roughness_scale == 0.5 ? 1.0 : 0.0; }
float reads_frame() { return frame.viewport_px == vec2(96.0, 64.0) ? 1.0 : 0.0; }
float reads_lights() { return lights[0].intensity.x > 0.0 ? 1.0 : 0.0; }
float reads_material() { return material.roughness_factor == 0.375 && textureLod(probe_texture, vec2(0.5), 0.0).a == 1.0 ? 1.0 : 0.0; }
float reads_draw() { return draw.attributes != 0u ? 1.0 : 0.0; }
float reads_environment() { return abs(textureLod(probe_environment, vec3(0.0, 1.0, 0.0), 0.0).r - 1.0) < 0.01 ? 1.0 : 0.0; }
float reads_tables() { return textureLod(probe_table, vec2(0.5, 0.1), 0.0).b > 0.5 ? 1.0 : 0.0; }
float reads_scene() { return probe_nodes[0].max_ws.x > 0.1 ? 1.0 : 0.0; }
float reads_pass() { return textureLod(probe_image, vec2(0.5), 0.0).r == 0.25 ? 1.0 : 0.0; }
float reads_deformations() { return float(probe_instances[0].vertex_count) + 1.0; }
float reads_task() { return float(task.size.x) + 1.0; }
#endif
";

/// The function of the library that reads a resource.
fn function(resource: Resource) -> String {
    format!("reads_{}", format!("{resource:?}").to_lowercase())
}

/// The sum of what functions of the library return: of the constant, and of these resources.
fn sum(resources: impl IntoIterator<Item = Resource>) -> String {
    let calls: Vec<String> = resources.into_iter().map(|resource| format!(" + {}()", function(resource))).collect();
    format!("(reads_constant(){})", calls.concat())
}

/// A place in the tree where users write code.
struct Place {
    /// The file, its text before, and the text that the place replaces; for a new file, the latter two are empty.
    file: &'static str,
    from: &'static str,
    /// The replacement, in which `SUM` stands for a number.
    to: &'static str,
    /// What the stages that run the code are run for.
    roles: &'static [StageRole],
    /// The mode that shows the number.
    mode: &'static str,
}

impl Place {
    fn binds(&self, resource: Resource) -> bool {
        self.roles.iter().all(|role| role.binds(resource))
    }

    /// Writes the code with this number. Returns the files that have changed.
    fn write(&self, tree: &Tree, before: &str, number: &str) {
        let text = match self.from {
            "" => self.to.replace("SUM", number),
            from => {
                assert!(before.contains(from), "{} has no `{from}`:\n{before}", self.file);
                before.replace(from, &self.to.replace("SUM", number))
            }
        };
        let include = format!("#include \"{PROBE}\"\n");
        // Behind the head of the file.
        let at = ["#include \"pass.glsl\"\n", "#include \"interface.glsl\"\n"].iter().find_map(|head| text.find(head));
        let text = match at {
            Some(at) => {
                let end = at + text[at..].find('\n').unwrap() + 1;
                [&text[..end], &include, &text[end..]].concat()
            }
            None => {
                let end = text.find("#define").map_or(0, |at| at + text[at..].find('\n').unwrap() + 1);
                [&text[..end], &include, &text[end..]].concat()
            }
        };
        tree.write(self.file, &text);
    }
}

use StageRole::{Bake, Compute, Deform, Measure, Model, Paths, Quads, Screen};

/// The columns of the table, and more: every hook, a function of the BRDF, every kind of pass and bake.
const PLACES: &[Place] = &[
    Place {
        file: "user/vertex.glsl",
        from: "void user_vertex(inout Vertex vertex) {\n",
        to: "void user_vertex(inout Vertex vertex) {\n    vertex.uv0 = vec2(SUM);\n",
        roles: &[Model, Paths],
        mode: "uv0",
    },
    Place {
        file: "user.glsl",
        from: "    s.roughness = saturate(s.roughness * roughness_scale);\n",
        to: "    s.emissive = vec3(SUM);\n",
        roles: &[Model, Paths],
        mode: "emissive",
    },
    Place {
        file: "brdf/diffuse.glsl",
        from: "return albedo / PI; }",
        to: "return albedo * (SUM) / PI; }",
        roles: &[Model, Paths, Bake, Measure],
        mode: "",
    },
    Place {
        file: "brdf/ndf.glsl",
        from: "    return a2 / (PI",
        to: "    return SUM * a2 / (PI",
        roles: &[Model, Paths, Bake, Measure],
        mode: "",
    },
    Place {
        file: "ibl/irradiance.comp",
        from: "void main() {\n",
        to: "float code() { return SUM; }\nvoid main() {\n    if (code() < 0.0) return;\n",
        roles: &[Bake],
        mode: "",
    },
    Place {
        file: "ibl/dfg.comp",
        from: "void main() {\n",
        to: "float code() { return SUM; }\nvoid main() {\n    if (code() < 0.0) return;\n",
        roles: &[Bake],
        mode: "",
    },
    Place {
        file: "deform.comp",
        from: "void main() {\n",
        to: "float code() { return SUM; }\nvoid main() {\n    if (code() < 0.0) return;\n",
        roles: &[Deform],
        mode: "",
    },
    Place {
        file: "measure/furnace.comp",
        from: "void main() {\n",
        to: "float code() { return SUM; }\nvoid main() {\n    if (code() < 0.0) return;\n",
        roles: &[Measure],
        mode: "",
    },
    Place {
        file: "user/background.glsl",
        from: "    return radiance;\n",
        to: "    return vec3(SUM);\n",
        roles: &[Screen],
        mode: "final",
    },
    Place {
        file: "user/display.glsl",
        from: "    return light;\n",
        to: "    return vec3(SUM);\n",
        roles: &[Screen],
        mode: "",
    },
    Place {
        file: "passes/screen.frag",
        from: "",
        to: "//@pass screen format=r32f\n#version 460\n#include \"pass.glsl\"\nvoid main() { color = vec4(SUM); }\n",
        roles: &[Screen],
        mode: "pass:screen",
    },
    Place {
        file: "passes/computed.comp",
        from: "",
        to: "//@pass computed format=r32f\n#version 460\n#include \"interface.glsl\"\n\
             layout(local_size_x = 8, local_size_y = 8) in;\nlayout(r32f) uniform writeonly image2D computed;\n\
             void main() { imageStore(computed, ivec2(gl_GlobalInvocationID.xy), vec4(SUM)); }\n",
        roles: &[Compute],
        mode: "pass:computed",
    },
    Place {
        file: "passes/drawn.frag",
        from: "",
        to: "//@pass drawn draw=model format=r32f\n#version 460\n#include \"interface.glsl\"\n\
             #include \"common/fragment.glsl\"\nlayout(location = 0) in Fragment fragment;\n\
             layout(location = 0) out vec4 color;\nvoid main() { color = vec4(SUM); }\n",
        roles: &[Model],
        mode: "pass:drawn",
    },
    Place {
        file: "passes/quads.frag",
        from: "",
        to: "//@pass quads draw=quads instances=1 format=r32f\n#version 460\n#include \"interface.glsl\"\n\
             layout(location = 0) out vec4 color;\nvoid main() { color = vec4(SUM); }\n",
        roles: &[Quads],
        mode: "pass:quads",
    },
    Place {
        file: "paths.frag",
        from: "    out_color = hdr_pixel(pixel.value, coverage, no_data);\n",
        to: "    pixel.value = vec3(SUM);\n    out_color = hdr_pixel(pixel.value, coverage, no_data);\n",
        roles: &[Paths],
        mode: "path-traced",
    },
    Place {
        file: "average.frag",
        from: "texelFetch(picture, ivec2(gl_FragCoord.xy), 0)",
        to: "vec4(vec3(SUM), texelFetch(picture, ivec2(gl_FragCoord.xy), 0).a)",
        roles: &[Screen],
        mode: "path-traced",
    },
];

/// The vertex stage of the pass that draws quads: one quad that covers the image.
const QUAD: (&str, &str) = (
    "passes/quads.vert",
    "#version 460\nvoid main() {\n    vec2 at = vec2(ivec2(0x34 >> gl_VertexIndex, 0x26 >> gl_VertexIndex) & 1);\n    \
     gl_Position = vec4(2.0 * at - 1.0, 0.5, 1.0);\n}\n",
);

fn change(files: &[&str]) -> Change {
    Change::Paths(files.iter().map(|file| TreePath::from(*file)).collect())
}

#[test]
fn what_a_stage_does_not_have_is_refused_at_its_line() {
    let tree = Tree::new();
    tree.write(PROBE, LIBRARY);
    tree.write("passes/probe_image.frag", IMAGE);
    let mut library = Library::new(Source::disk(tree.root()), compiler().clone(), &all_stages());
    assert!(matches!(library.update(&Change::All), Update::Ready(..)));
    for place in PLACES {
        let before = if place.from.is_empty() { String::new() } else { tree.read(place.file) };
        place.write(&tree, &before, &sum(Resource::ALL));
        let quad = (place.roles == [Quads]).then(|| tree.write(QUAD.0, QUAD.1)).map(|()| QUAD.0);
        let files: Vec<&str> = std::iter::once(place.file).chain(quad).collect();
        let Update::Failed(diagnostics, _) = library.update(&change(&files)) else {
            panic!("{}: nothing is refused", place.file)
        };
        let told: BTreeSet<(String, Option<u32>)> = diagnostics.iter().map(|d| (d.file.clone(), d.line)).collect();
        let refused = Resource::ALL.into_iter().filter(|resource| !place.binds(*resource));
        let at = |resource| (tree.path(PROBE).display().to_string(), Some(line_of(LIBRARY, &function(resource))));
        let expected: BTreeSet<(String, Option<u32>)> = refused.map(at).collect();
        assert_eq!(told, expected, "{}:\n{}", place.file, lines(&diagnostics).join("\n"));
        for resource in Resource::ALL.into_iter().filter(|resource| !place.binds(*resource)) {
            let name = resource.name();
            assert!(lines(&diagnostics).iter().any(|line| line.ends_with(&format!(" has no {name}"))), "{name}");
        }
        if place.from.is_empty() {
            files.iter().for_each(|file| std::fs::remove_file(tree.path(file)).unwrap());
        } else {
            tree.write(place.file, &before);
        }
        assert!(!matches!(library.update(&change(&files)), Update::Failed(..)), "{}: taken back", place.file);
    }
}

/// The number in the middle of the picture, or in a corner of it for the background.
fn shown(capture: &Capture, place: &Place) -> f32 {
    let at = if place.file.contains("background") { 0 } else { (32 * 96 + 48) as usize };
    capture.raw[at][0]
}

#[test]
fn what_a_stage_has_has_its_value() {
    let fixed = [
        "environment.name=furnace",
        "view.background=env",
        "view.msaa=1",
        "view.frames=1",
        "material.enabled=true",
        "material.roughness=0.375",
        "roughness_scale=0.5",
    ];
    let mut session = Session::new(model("shader-ball"), settings(&fixed));
    session.tree.write(PROBE, LIBRARY);
    ready(&session.save("passes/probe_image.frag", IMAGE));
    for place in PLACES.iter().filter(|place| !place.mode.is_empty()) {
        let before = if place.from.is_empty() { String::new() } else { session.tree.read(place.file) };
        let bound: Vec<Resource> = Resource::ALL.into_iter().filter(|resource| place.binds(*resource)).collect();
        // The vertex stage of the picture draws other modes, too, in which nothing is traced.
        let bound: Vec<Resource> = bound.into_iter().filter(|resource| *resource != Resource::Task).collect();
        place.write(&session.tree, &before, &sum(bound.iter().copied()));
        let quad = (place.roles == [Quads]).then(|| session.tree.write(QUAD.0, QUAD.1)).map(|()| QUAD.0);
        let files: Vec<&str> = std::iter::once(place.file).chain(quad).collect();
        ready(&session.changed(&files));
        session.set("PROBED=2");
        let capture = session.mode(place.mode);
        // An interpolated value has the rounding error of its weights.
        let error = (shown(&capture, place) - (bound.len() as f32 + 1.0)).abs();
        assert!(error < 1e-4, "{}: {error} off, so not all of {bound:?}", place.file);
        session.headless.settings_mut().shader.remove("PROBED");
        if place.from.is_empty() {
            session.delete(&files);
        } else {
            session.save(place.file, &before);
        }
    }
}

#[test]
fn the_display_hook_has_its_values() {
    let model = load(&glb::model(&glb::sphere(16, 32), &glb::gray()));
    let mut session =
        Session::new(model, settings(&["view.msaa=1", "environment.name=furnace", "roughness_scale=0.5"]));
    session.tree.write(PROBE, LIBRARY);
    ready(&session.save("passes/probe_image.frag", IMAGE));
    let place = PLACES.iter().find(|place| place.file == "user/display.glsl").unwrap();
    let before = session.tree.read(place.file);
    let bound: Vec<Resource> = Resource::ALL.into_iter().filter(|resource| place.binds(*resource)).collect();
    let count = bound.len();
    place.write(&session.tree, &before, &format!("({} == {count}.0 ? 1.0 : 0.0)", sum(bound)));
    ready(&session.changed(&[place.file]));
    session.set("view.tonemap=none");
    let with = session.mode("final");
    let middle = (32 * 96 + 48) * 4;
    assert_eq!(with.rgba8[middle..middle + 3], [255; 3], "the constant is 1, so {count} resources");
    session.set("roughness_scale=1");
    assert_differ(&with, &session.mode("final"), "the slider is read");
}
