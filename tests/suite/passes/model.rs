//! Passes that draw the model, and passes whose images the model reads: shadows, ambient occlusion, the ground.

use crate::support::{
    SIZE, Session, assert_differ, assert_same, assert_validated, failed, glb, lines, load, passes_check, ready,
    settings, stages,
};
use specula::headless::Sequence;
use specula::render::Capture;

/// A pass that draws the model with `body`; `fragment` is the point of the surface.
fn model_pass(annotation: &str, body: &str) -> String {
    format!(
        "//@pass {annotation} draw=model\n#version 460\n#include \"interface.glsl\"\n#include \"common/fragment.glsl\"\n\
         layout(location = 0) in Fragment fragment;\nlayout(location = 0) out vec4 color;\n\
         void main() {{\n    {body}\n}}\n"
    )
}

/// A pass that shows an image instead of the picture.
fn show(image: &str) -> String {
    format!(
        "//@pass show to=picture\n#version 460\n#include \"pass.glsl\"\nuniform sampler2D {image};\n\
         void main() {{ color = vec4(texture({image}, uv).rgb, 1.0); }}\n"
    )
}

/// A vertex stage that draws instance i of three shifted by i - 1 widths of the model.
const SHIFTED: &str = "#version 460\n#include \"interface.glsl\"\n#include \"common/fragment.glsl\"\n\
    layout(location = 0) out Fragment fragment;\n\
    void main() {\n    Vertex vertex = draw.vertices.at[gl_VertexIndex];\n    \
    fragment.position_ws = draw.world_from_object * vec4(vertex.position, 1.0);\n    \
    fragment.normal_ws = vec3(0.0, 0.0, float(gl_InstanceIndex));\n    \
    vec4 clip = frame.clip_from_world * vec4(0.2 * fragment.position_ws, 1.0);\n    \
    gl_Position = clip + vec4(0.6 * (float(gl_InstanceIndex) - 1.0) * clip.w, 0.0, 0.0, 0.0);\n}\n";

/// A gray sphere, one sample a pixel, on nothing.
fn sphere() -> Session {
    let plain = ["view.msaa=1", "view.background=none", "environment.name=none"];
    Session::new(load(&glb::model(&glb::sphere(16, 32), &glb::gray())), settings(&plain))
}

fn at(capture: &Capture, x: f32) -> [f32; 4] {
    capture.raw_at((SIZE.0 as f32 * x) as u32, SIZE.1 / 2).unwrap()
}

#[test]
fn the_surface_is_read_by_name() {
    let mut session = sphere();
    for (image, mode) in
        [("normal", "shading-normal"), ("base_color", "base-color"), ("roughness_metallic", "roughness")]
    {
        let expected = at(&session.mode(mode), 0.4);
        session.headless.settings_mut().mode = "final".to_owned();
        ready(&session.save("passes/show.frag", &show(image)));
        let found = at(&session.render(), 0.4);
        let channels = if mode == "roughness" { 1 } else { 3 };
        for channel in 0..channels {
            assert!((found[channel] - expected[channel]).abs() < 2e-3, "{image}: {found:?}, not {expected:?}");
        }
    }
    // Nothing moves.
    ready(&session.save("passes/show.frag", &show("velocity")));
    assert_eq!(at(&session.render(), 0.4)[..2], [0.0, 0.0]);
    // The camera turns to the left around the model, so what faces it moves to the right.
    session.headless.settings_mut().camera.azimuth -= 2.0;
    let moved = at(&session.headless.render_next().unwrap(), 0.4);
    assert!(moved[0] > 2e-3 && moved[1].abs() < moved[0], "{moved:?}");
    let is_drawn = |session: &Session| session.headless.pass_times().iter().any(|pass| pass.name == "normal");
    assert!(is_drawn(&session));
    // Without a reader the pass is not drawn.
    std::fs::remove_file(session.tree.path("passes/show.frag")).unwrap();
    ready(&session.changed(&["passes/show.frag"]));
    session.render();
    assert!(!is_drawn(&session), "an image that nobody reads is drawn");
    passes_check(&session);
}

#[test]
fn a_pass_draws_the_model() {
    let mut session = sphere();
    let before = session.render();
    let normals = model_pass("normals format=rgba32f", "color = vec4(normalize(fragment.normal_ws), 1.0);");
    ready(&session.save("passes/normals.frag", &normals));
    let reload = session.save("passes/show.frag", &show("normals"));
    ready(&reload);
    assert_eq!(stages(&reload), ["passes/show.frag"]);
    let shown = session.render();
    let found = at(&shown, 0.5);
    let expected = at(&session.mode("geometric-normal"), 0.5);
    session.headless.settings_mut().mode = "final".to_owned();
    for axis in 0..3 {
        assert!((found[axis] - expected[axis]).abs() < 0.01, "{found:?} is not {expected:?}");
    }
    assert_eq!(at(&shown, 0.02)[..3], [0.0; 3], "beside the model there is nothing");
    passes_check(&session);
    let image = session.mode("pass:normals");
    assert!((at(&image, 0.5)[2] - found[2]).abs() < 1e-2, "the image is a debug mode");
    std::fs::remove_file(session.tree.path("passes/show.frag")).unwrap();
    ready(&session.changed(&["passes/show.frag"]));
    session.headless.settings_mut().mode = "final".to_owned();
    assert_same(&before, &session.render(), "nobody reads it");
    assert_validated();
}

#[test]
fn a_pass_has_a_vertex_stage_of_its_own_and_instances() {
    let mut session = sphere();
    let (copies, body) = ("copies format=rgba32f instances=3", "color = vec4(1.0, fragment.normal_ws.z, 0.0, 1.0);");
    ready(&session.save("passes/copies.frag", &model_pass(copies, body)));
    ready(&session.save("passes/show.frag", &show("copies")));
    let whole = session.render();
    ready(&session.save("passes/copies.vert", SHIFTED));
    let shifted = session.render();
    assert_differ(&whole, &shifted, "the vertex stage");
    for (x, instance) in [(0.2, 0.0), (0.5, 1.0), (0.8, 2.0)] {
        assert_eq!(at(&shifted, x)[..2], [1.0, instance], "at {x}");
    }
    passes_check(&session);
    // A broken vertex stage costs nothing, and names its line.
    let broken = SHIFTED.replace("vec4 clip", "vec4 clap");
    let told = lines(failed(&session.save("passes/copies.vert", &broken))).join("\n");
    assert!(told.contains("copies.vert:"), "{told}");
    assert_same(&shifted, &session.render(), "broken");
    session.save("passes/copies.vert", SHIFTED);
    // It must write what the fragment stage reads.
    let extra = "layout(location = 9) in vec4 extra;\nlayout(location = 0) out";
    let reads_more = model_pass(copies, "color = extra;").replace("layout(location = 0) out", extra);
    let told = lines(failed(&session.save("passes/copies.frag", &reads_more))).join("\n");
    assert!(told.contains("extra"), "{told}");
    session.save("passes/copies.frag", &model_pass(copies, body));
    std::fs::remove_file(session.tree.path("passes/copies.vert")).unwrap();
    ready(&session.changed(&["passes/copies.vert"]));
    assert_same(&whole, &session.render(), "without the vertex stage");
    assert_validated();
}

#[test]
fn the_model_reads_passes_textures_and_buffers_by_name() {
    let mut session = sphere();
    let before = session.render();
    let glow = "//@pass glow size=4x4 format=rgba32f when=GLOWS\n#version 460\n#include \"pass.glsl\"\n\
        void main() { color = vec4(0.0, 7.0, 0.0, 1.0); }\n";
    let told = lines(failed(&session.save("passes/glow.frag", glow))).join("\n");
    assert!(told.contains("glow.frag:1:43: error: no constant with //@ui is named `GLOWS`"), "{told}");
    let user = session.tree.read("user.glsl");
    let lit = user.replace(
        "// A light before it shines",
        "//@ui \"Glows\"\nlayout(constant_id = USER_CONSTANTS + 20) const bool GLOWS = true;\nuniform sampler2D glow;\n// A light",
    );
    let lit = lit.replace(
        "    return radiance;",
        "    if (GLOWS) radiance += texture(glow, vec2(0.5)).rgb;\n    return radiance;",
    );
    ready(&session.save("user.glsl", &lit));
    let shown = session.render();
    let (plain, found) = (at(&before, 0.5), at(&shown, 0.5));
    assert!((found[1] - plain[1] - 7.0).abs() < 0.01 && (found[0] - plain[0]).abs() < 1e-3, "{plain:?} {found:?}");
    passes_check(&session);
    // An edit of the pass reaches the model, and compiles the pass alone.
    let reload = session.save("passes/glow.frag", &glow.replace("7.0", "3.0"));
    ready(&reload);
    assert_eq!(stages(&reload), ["passes/glow.frag"]);
    assert!((at(&session.render(), 0.5)[1] - plain[1] - 3.0).abs() < 0.01);
    // Off by its constant, or by its switch.
    session.set("GLOWS=false");
    assert_same(&before, &session.render(), "off by the constant");
    session.set("GLOWS=true");
    session.set("passes.glow=false");
    assert_same(&before, &session.render(), "an image of a pass that is off reads as 0");
    session.headless.settings_mut().passes.clear();
    // A pass that the model reads cannot read the picture, which comes later.
    let told = lines(failed(&session.save(
        "passes/glow.frag",
        &glow.replace("void main", "uniform sampler2D picture;\nvoid main").replace("7.0", "texture(picture, uv).g"),
    )));
    let expected = "glow.frag:1:9: error: pbr.frag needs the image of the pass `glow`, but the model is drawn after it";
    assert!(told.iter().any(|line| line.contains(expected)), "{told:#?}");
    let told =
        lines(failed(&session.save(
            "user.glsl",
            &lit.replace("sampler2D glow", "sampler2D glwo").replace("texture(glow", "texture(glwo"),
        )));
    assert!(
        told.iter().any(|line| line.contains("error: no pass or texture is named `glwo`. Did you mean `glow`?")),
        "{told:#?}"
    );
    // A texture of one's own in the material.
    session.save("user.glsl", &lit);
    ready(&session.save("passes/glow.frag", glow));
    let paint = image::RgbImage::from_pixel(2, 2, image::Rgb([0, 0, 255]));
    paint.save(session.tree.path("paint.png")).unwrap();
    let painted = lit.replace("uniform sampler2D glow;", "//@texture paint \"paint.png\"\nuniform sampler2D paint;");
    ready(&session.save("user.glsl", &painted.replace("texture(glow, vec2(0.5))", "9.0 * texture(paint, vec2(0.5))")));
    let found = at(&session.render(), 0.5);
    assert!((found[2] - plain[2] - 9.0).abs() < 0.02, "{plain:?} {found:?}");
    assert_validated();
}

#[test]
fn the_model_reads_buffers_that_passes_write() {
    let mut session = sphere();
    let plain = at(&session.render(), 0.5);
    let fill = "//@pass fill size=1x1 format=r32f\n#version 460\n#include \"interface.glsl\"\n\
        layout(local_size_x = 1) in;\nlayout(r32f) uniform writeonly image2D fill;\n\
        buffer Counts { float counts[4]; };\n\
        void main() { counts[1] = 5.0; imageStore(fill, ivec2(0), vec4(1.0)); }\n";
    ready(&session.save("passes/fill.comp", fill));
    session.render();
    let user = session.tree.read("user.glsl").replace(
        "// A light before it shines",
        "uniform sampler2D fill;\nreadonly buffer Counts { float counts[4]; };\n// A light",
    );
    let adds = "    radiance.b += counts[1] * texture(fill, vec2(0.5)).r;\n    return radiance;";
    let user = user.replace("    return radiance;", adds);
    ready(&session.save("user.glsl", &user));
    let found = at(&session.render(), 0.5);
    assert!((found[2] - plain[2] - 5.0).abs() < 0.02, "{plain:?} {found:?}");
    let told = lines(failed(&session.save("passes/fill.comp", &fill.replace("counts[4]", "counts[8]")))).join("\n");
    assert!(
        told.contains("fill.comp:1:1: error: the buffer `Counts` has 32 bytes here and 16 in the pass `debug`"),
        "{told}"
    );
    assert_validated();
}

/// What a compute pass writes is drawn in the same frame, without after=, one quad for each element of its buffer.
#[test]
fn quads_are_drawn_where_a_compute_pass_puts_them() {
    let mut session = sphere();
    session.set("passes.model=false");
    let place = "//@pass zplace size=1x1 dispatch=1\n#version 460\n#include \"interface.glsl\"\n\
        layout(local_size_x = 4) in;\nbuffer Places { vec4 places[4]; };\n\
        void main() { places[gl_GlobalInvocationID.x] = vec4(float(gl_GlobalInvocationID.x) * 0.5 - 0.75, 0.0, 0.1, \
        10.0 * float(frame.frame_index)); }\n";
    let vertex = "#version 460\n#include \"interface.glsl\"\nreadonly buffer Places { vec4 places[4]; };\n\
        layout(location = 0) out flat float index;\n\
        const vec2 CORNERS[6] = vec2[](vec2(-1, -1), vec2(1, -1), vec2(1, 1), vec2(-1, -1), vec2(1, 1), vec2(-1, 1));\n\
        void main() {\n    vec4 place = places[gl_InstanceIndex];\n    index = float(gl_InstanceIndex) + place.w;\n    \
        gl_Position = vec4(place.xy + place.z * CORNERS[gl_VertexIndex], 0.5, 1.0);\n}\n";
    let squares = "//@pass squares draw=quads instances=4 to=picture\n#version 460\n\
        layout(location = 0) in flat float index;\nlayout(location = 0) out vec4 color;\n\
        void main() { color = vec4(index + 1.0, 0.0, 0.0, 1.0); }\n";
    session.save("passes/place.comp", place);
    session.save("passes/squares.vert", vertex);
    ready(&session.save("passes/squares.frag", squares));
    let picture = session.render();
    for index in 0..4 {
        assert_eq!(at(&picture, 0.125 + 0.25 * index as f32), [index as f32 + 1.0, 0.0, 0.0, 1.0], "square {index}");
        assert_eq!(at(&picture, 0.25 * index as f32)[3], 0.0, "beside square {index}");
    }
    passes_check(&session);
    // To an image of its own, with its own depth.
    ready(&session.save("passes/squares.frag", &squares.replace(" to=picture", " format=r32f")));
    ready(&session.save("passes/show.frag", &show("squares")));
    session.headless.set_sequence(Sequence { frames: 3, ..Sequence::default() });
    assert_eq!(at(&session.render(), 0.375)[0], 22.0, "the places of this frame");
    // The compute pass that writes what another one reads comes first, before the model as well.
    let [one, two] = ["writeonly buffer Steps { float step_index; };", "readonly buffer Steps { float step_index; };"];
    let compute = |name: &str, buffer: &str, body: &str| {
        format!(
            "//@pass {name} size=1x1 dispatch=1\n#version 460\n#include \"interface.glsl\"\nlayout(local_size_x = 1) in;\n\
             {buffer}\nvoid main() {{ {body} }}\n"
        )
    };
    session.save("passes/zsteps.comp", &compute("zsteps", one, "step_index = float(frame.frame_index);"));
    let reads = place.replace("10.0 * float(frame.frame_index)", "10.0 * step_index");
    ready(&session.save("passes/place.comp", &reads.replace("buffer Places", &format!("{two}\nbuffer Places"))));
    assert_eq!(at(&session.render(), 0.375)[0], 22.0, "the steps of this frame");
    passes_check(&session);
    session.headless.set_sequence(Sequence::default());

    let mut refuse = |path: &str, text: &str, expected: &str| {
        let good = session.tree.read(path);
        let told = lines(failed(&session.save(path, text))).join("\n");
        assert!(told.contains(expected), "{told}");
        session.save(path, &good);
    };
    // Of an included file only what is called counts.
    let own = squares.replace(" to=picture", " format=r32f");
    let included = own.replace("#version 460", "#version 460\n#include \"material/material.glsl\"");
    let material = included.replace("void main() {", "void main() { if (material.id == 7u) discard;");
    let expected = "passes/squares.frag reads `material` here: a pass that draws quads has no material";
    refuse("passes/squares.frag", &material, expected);
    let reads_model = vertex.replace("index = float", "index = draw.vertices.at[0].uv0.x + float");
    let expected = "squares.vert:8:13: error: passes/squares.vert reads `draw` here: a pass that draws quads has no draw constants";
    refuse("passes/squares.vert", &reads_model, expected);
}

/// A displacement map in the model's vertex stage, and what a pass with a vertex stage of its own reads there.
#[test]
fn vertex_stages_read_by_name() {
    let mut session = sphere();
    let before = session.render();
    let covered = |capture: &Capture| capture.raw.iter().filter(|pixel| pixel[3] > 0.0).count() as f64;
    image::GrayImage::from_pixel(2, 2, image::Luma([128])).save(session.tree.path("height.png")).unwrap();
    let hook = "void user_vertex(inout Vertex vertex) {";
    let moved = "vertex.position *= texture(height, vertex.uv0).r;";
    let declared = "//@texture height \"height.png\" linear\nuniform sampler2D height;\n";
    let text = session.tree.read("user/vertex.glsl");
    ready(&session.save("user/vertex.glsl", &text.replace(hook, &format!("{declared}{hook}\n    {moved}"))));
    let displaced = session.render();
    let part = covered(&displaced) / covered(&before);
    assert!((0.18..0.27).contains(&part), "half the radius covers {part}");
    passes_check(&session);
    // A new image file reaches the vertices.
    image::GrayImage::from_pixel(2, 2, image::Luma([255])).save(session.tree.path("height.png")).unwrap();
    ready(&session.changed(&["height.png"]));
    assert_same(&before, &session.render(), "a height of 1");
    // The image of a pass, which is drawn before the model.
    let height = "//@pass height size=2x2 format=r32f\n#version 460\n#include \"pass.glsl\"\n\
        uniform Height { float height_m; };   //@ui \"Height\" 0..1 = 0.50196\nvoid main() { color = vec4(height_m); }\n";
    session.save("passes/height.frag", height);
    let by_pass = text.replace(hook, &format!("uniform sampler2D height;\n{hook}\n    {moved}"));
    ready(&session.save("user/vertex.glsl", &by_pass));
    assert_eq!(covered(&session.render()) / covered(&before), part, "half the radius, by a pass");
    session.set("height_m=1");
    assert_same(&before, &session.render(), "a height of 1, by a pass");
    // Without an own vertex stage, a pass that draws the model has that of the picture.
    ready(&session.save("passes/normals.frag", &model_pass("normals format=rgba32f", "color = vec4(1.0);")));
    ready(&session.save("passes/show.frag", &show("normals")));
    session.set("height_m=0.50196");
    let white = |capture: &Capture| capture.raw.iter().filter(|pixel| pixel[0] > 0.5).count() as f64;
    assert_eq!(white(&session.render()) / covered(&before), part, "the pass is displaced, too");
    // A vertex stage of its own, whose names are not those of its fragment stage.
    let own = SHIFTED.replace("void main", "uniform sampler2D height;\nvoid main");
    let own = own.replace("0.2 * fragment", "0.4 * texture(height, vec2(0.5)).r * fragment");
    let shifted = |scale: f32| {
        let body = format!("color = texture(paint, vec2({scale}));");
        model_pass("normals format=rgba32f instances=3", &body)
            .replace("void main", "//@texture paint \"height.png\" linear\nuniform sampler2D paint;\nvoid main")
    };
    session.save("passes/normals.frag", &shifted(0.5));
    ready(&session.save("passes/normals.vert", &own));
    let halves = session.render();
    assert!((at(&halves, 0.2)[0] - 1.0).abs() < 1e-3 && (at(&halves, 0.8)[0] - 1.0).abs() < 1e-3);
    session.set("height_m=1");
    assert!(white(&session.render()) > 2.0 * white(&halves), "twice the size");
    // An unknown name has its line.
    let told = lines(failed(&session.save("passes/normals.vert", &own.replace("height", "heigth")))).join("\n");
    assert!(told.contains("normals.vert:") && told.contains("Did you mean `height`?"), "{told}");
    assert_validated();
}

/// Two stages with the same kinds of inputs have sets of their own.
#[test]
fn the_sky_reads_its_own_image_in_an_accumulating_mode() {
    let sky = ["view.msaa=1", "view.background=env", "environment.name=furnace", "view.frames=2"];
    let mut session = Session::new(load(&glb::model(&glb::sphere(8, 16), &glb::gray())), settings(&sky));
    let blue = "//@pass blue size=1x1 format=rgba32f\n#version 460\n#include \"pass.glsl\"\n\
        void main() { color = vec4(0.0, 0.0, 3.0, 1.0); }\n";
    ready(&session.save("passes/blue.frag", blue));
    let text = session.tree.read("user/background.glsl");
    let hook = text.find("vec3 user_background").unwrap();
    let text = format!(
        "{}uniform sampler2D blue;\nvec3 user_background(vec3 direction, vec3 radiance) {{ return texture(blue, vec2(0.5)).rgb; }}\n#endif\n",
        &text[..hook]
    );
    ready(&session.save("user/background.glsl", &text));
    for mode in ["final", "monte-carlo"] {
        assert_eq!(at(&session.mode(mode), 0.02)[..3], [0.0, 0.0, 3.0], "{mode}");
    }
    assert_validated();
}

#[test]
fn a_pass_adds_to_the_model_in_the_picture() {
    let mut session = Session::new(
        load(&glb::model(&glb::sphere(16, 32), &glb::gray())),
        settings(&["view.msaa=4", "view.background=none", "environment.name=none"]),
    );
    let plain = session.render();
    let is_empty = |capture: &Capture, x: u32| capture.raw_at(x, SIZE.1 / 2).unwrap()[3] == 0.0;
    let edge = (0..SIZE.0).find(|x| !is_empty(&plain, *x)).expect("the sphere is in the picture");
    assert!(edge > 4, "there is room beside the sphere");
    // Three copies: one to the left, the model's own place, one to the right.
    let red = |options: &str| model_pass(&format!("red to=picture {options}"), "color = vec4(4.0, 0.0, 0.0, 1.0);");
    ready(&session.save("passes/red.frag", &red("instances=3")));
    ready(&session.save("passes/red.vert", &SHIFTED.replace("0.6 *", "0.9 *")));
    let three = session.render();
    let of = |capture: &Capture, x: f32| capture.raw_at((SIZE.0 as f32 * x) as u32, SIZE.1 / 2).unwrap();
    assert_eq!(of(&three, 0.05)[..3], [4.0, 0.0, 0.0], "a copy beside the model");
    assert_eq!(of(&three, 0.5), of(&plain, 0.5), "the copy inside of the model is hidden by it");
    let pixels = || (0..SIZE.0).map(|x| three.raw_at(x, SIZE.1 / 2).unwrap());
    assert!(pixels().any(|pixel| pixel[0] > 0.5 && pixel[3] < 0.9 && pixel[3] > 0.1), "its edges are multisampled");
    // The inside of a sphere that surrounds the model.
    let hull = SHIFTED.replace("0.2 *", "1.3 *").replace("0.6 *", "0.0 *");
    ready(&session.save("passes/red.vert", &hull));
    ready(&session.save("passes/red.frag", &red("cull=front")));
    let outline = session.render();
    assert_eq!(of(&outline, 0.5), of(&plain, 0.5), "faces towards the camera are left out");
    assert_eq!(outline.raw_at(edge - 2, SIZE.1 / 2).unwrap()[..3], [4.0, 0.0, 0.0]);
    ready(&session.save("passes/red.frag", &red("cull=back")));
    assert_eq!(of(&session.render(), 0.5)[..3], [4.0, 0.0, 0.0]);
    // Blended with what is there.
    let half = red("cull=back blend").replace("vec4(4.0, 0.0, 0.0, 1.0)", "vec4(2.0, 0.0, 0.0, 0.5)");
    ready(&session.save("passes/red.frag", &half));
    let (blended, below) = (of(&session.render(), 0.5), of(&plain, 0.5));
    for axis in 0..3 {
        let expected = 0.5 * below[axis] + [2.0, 0.0, 0.0][axis];
        assert!((blended[axis] - expected).abs() < 0.01, "{blended:?} over {below:?}");
    }
    // A debug mode shows the model alone.
    let mode = session.mode("geometric-normal");
    session.headless.settings_mut().mode = "final".to_owned();
    // Even if a stage of that mode reads a buffer that the pass reads, too.
    let shares = half.replace("void main", "readonly buffer Shared { float shared_value; };\nvoid main");
    ready(&session.save("passes/red.frag", &shares.replace("0.5);", "0.5 + shared_value);")));
    let user = session.tree.read("user.glsl");
    let reads = "readonly buffer Shared { float shared_value; };\nvoid user_surface(inout Surface s, Fragment f, vec3 v) {\n    s.roughness += shared_value;";
    ready(&session.save("user.glsl", &user.replace("void user_surface(inout Surface s, Fragment f, vec3 v) {", reads)));
    assert_same(&mode, &session.mode("geometric-normal"), "the pass shares a buffer");
    session.headless.settings_mut().mode = "final".to_owned();
    ready(&session.save("user.glsl", &user));
    std::fs::remove_file(session.tree.path("passes/red.frag")).unwrap();
    ready(&session.changed(&["passes/red.frag"]));
    assert_same(&plain, &session.render(), "the pass is gone");
    assert_same(&mode, &session.mode("geometric-normal"), "a mode without the pass");
    assert_validated();
}

/// Model, background, mean and tone map are passes of the tree like all others.
#[test]
fn the_picture_is_declared_in_the_tree() {
    let mut session = Session::new(
        load(&glb::model(&glb::sphere(16, 32), &glb::gray())),
        settings(&["view.msaa=1", "view.background=env", "environment.name=furnace"]),
    );
    let plain = session.render();
    session.set("passes.model=false");
    let empty = session.render();
    assert_eq!(at(&empty, 0.5), at(&plain, 0.02), "the background alone");
    session.set("passes.background=false");
    assert_eq!(at(&session.render(), 0.5)[3], 0.0, "nothing at all");
    session.set("passes.model=true");
    session.set("passes.background=true");
    assert_same(&plain, &session.render(), "all on again");
    // A stage of one's own for a mode.
    let mine = model_pass("mine to=picture instead=model", "color = vec4(float(MODE), 0.0, 7.0, 1.0);");
    ready(&session.save("mine.frag", &mine));
    let modes = session.tree.read("debug/modes.glsl");
    let declared = |stage: &str| {
        let note = format!("//@mode mine \"Mine\" encode=data stage={stage}\nconst uint MODE_MINE = 1000u;\n");
        modes.replace("// Your modes:", &format!("{note}\n// Your modes:"))
    };
    ready(&session.save("debug/modes.glsl", &declared("mine")));
    assert_same(&plain, &session.render(), "a stage for a mode leaves the picture alone");
    assert_eq!(at(&session.mode("mine"), 0.5)[..3], [1000.0, 0.0, 7.0]);
    session.headless.settings_mut().mode = "final".to_owned();
    passes_check(&session);
    let told = lines(failed(&session.save("debug/modes.glsl", &declared("mein")))).join("\n");
    assert!(
        told.contains("no pass draws the model with mein.frag for the mode `mine`. Did you mean `mine`?"),
        "{told}"
    );
    session.save("debug/modes.glsl", &declared("mine"));
    // Words for people build nothing.
    let text = session.tree.read("pbr.frag");
    let reload = session.save("pbr.frag", &text.replace("\"Model\"", "\"The model\""));
    ready(&reload);
    assert_eq!((stages(&reload).len(), reload.pipelines), (0, 0), "a label");
    ready(&session.save("pbr.frag", &text));
    // Without one of the steps there is no picture, so the last one stays.
    std::fs::rename(session.tree.path("pbr.vert"), session.tree.path("away.vert")).unwrap();
    let told = lines(failed(&session.changed(&["pbr.vert"]))).join("\n");
    assert!(told.contains("pbr.frag:1:1: error: the pass `model` needs the vertex stage pbr.vert"), "{told}");
    assert_same(&plain, &session.render(), "pbr.vert");
    std::fs::rename(session.tree.path("away.vert"), session.tree.path("pbr.vert")).unwrap();
    session.changed(&["pbr.vert"]);
    for (file, expected) in [
        ("tonemap.frag", "no stage of the tree declares the pass `tonemap`"),
        ("pbr.frag", "no stage of the tree declares the pass `model`"),
        ("average.frag", "accumulates, but no stage declares a pass with to=mean"),
        ("debug.frag", "no pass draws the model with debug.frag for the mode"),
    ] {
        let text = session.tree.read(file);
        let unsaid = text.replace("//@pass", "// pass");
        let told = lines(failed(&session.save(file, &unsaid))).join("\n");
        assert!(told.contains(expected), "{told}");
        assert_same(&plain, &session.render(), file);
        session.save(file, &text);
        std::fs::remove_file(session.tree.path(file)).unwrap();
        failed(&session.changed(&[file]));
        assert_same(&plain, &session.render(), file);
        session.save(file, &text);
    }
    assert_same(&plain, &session.render(), "repaired");
    assert_validated();
}

#[test]
fn contradictions_have_their_line() {
    let mut session = sphere();
    let before = session.render();
    let text = model_pass("mine", "color = vec4(1.0);");
    for (file, text, expected) in [
        (
            "passes/mine.frag",
            text.replace("draw=model", "draw=teapot"),
            "mine.frag:1:19: error: expected draw=model, draw=quads or draw=background, found `teapot`",
        ),
        ("passes/mine.frag", text.replace("draw=model", "instances=0"), "expected instances=lights, or instances=1 to"),
        (
            "passes/mine.frag",
            text.replace("mine draw", "mine to=picture size=1/2 draw"),
            "the picture has its own size and format",
        ),
        ("passes/mine.frag", text.replace("draw=model", "cull=front"), "only a pass that draws the model has cull="),
        (
            "passes/mine.frag",
            text.replace("draw=model", "draw=model blend"),
            "only a pass that draws the model or the background to the picture has blend",
        ),
        (
            "passes/mine.frag",
            text.replace("draw=model", "draw=model to=display"),
            "only the pass `tonemap` has to=display",
        ),
        ("passes/mine.frag", text.replace("draw=model", "draw=model to=mean"), "there is another pass with to=mean"),
        (
            "passes/mine.frag",
            text.replace("draw=model", "draw=model to=picture instead=sky"),
            "expected instead=model, found `sky`",
        ),
        ("passes/mine.frag", text.replace("draw=model", "instead=model"), "draws the model as well"),
        ("passes/mine.frag", text.replace("draw=model", "draw=background"), "draw=background to=picture"),
        ("passes/model.frag", text.replace("mine", "model"), "pass or texture `model` is given twice"),
        (
            "passes/mine.frag",
            text.replace("draw=model", "draw=model draw=background to=picture"),
            "draws the model or the background, not both",
        ),
        (
            "passes/mine.frag",
            text.replace("draw=model", "draw=model to=picture after=tonemap"),
            "`mine` is drawn with the model, so it cannot come after `tonemap`",
        ),
        (
            "passes/mine.frag",
            text.replace("draw=model", "draw=model to=picture instead=model off"),
            "is a step of every picture, so off and when= do not go with it",
        ),
        (
            "passes/mine.frag",
            text.replace("draw=model", "draw=model to=picture").replace(
                "void main() {\n    color =",
                "uniform sampler2D depth;\nvoid main() {\n    color = texture(depth, vec2(0.5)) +",
            ),
            "`depth` is not there yet: `mine` is drawn together with the model",
        ),
        ("passes/behind.frag", text.replace("mine", "behind"), "`behind` names what Specula draws"),
        (
            "passes/mine.comp",
            "//@pass mine draw=model\n#version 460\nlayout(local_size_x = 1) in;\nvoid main() {}\n".into(),
            "a compute pass cannot draw the model",
        ),
    ] {
        let told = lines(failed(&session.save(file, &text))).join("\n");
        assert!(told.contains(expected), "{told}\nis not\n{expected}");
        assert_same(&before, &session.render(), expected);
        std::fs::remove_file(session.tree.path(file)).unwrap();
        session.changed(&[file]);
    }
    // The steps that cover the picture.
    for (file, changes, expected) in [
        (
            "resolve.frag",
            [("to=resolve", "to=resolve draw=model"), ("", "")],
            "the pass `resolve` covers the picture, so draw= and instances= do not go with it",
        ),
        (
            "tonemap.frag",
            [("to=display", "to=display draw=model instances=3"), ("", "")],
            "`tonemap` covers the picture",
        ),
        ("average.frag", [("to=mean", "to=mean draw=quads"), ("", "")], "the pass `mean` covers the picture"),
        ("resolve.frag", [("DMS samples", "DMS wrong"), ("(samples", "(wrong")], "the pass `resolve` has no `wrong`"),
    ] {
        let text = session.tree.read(file);
        let changed = changes.iter().fold(text.clone(), |text, (from, to)| text.replacen(from, to, 1));
        let told = lines(failed(&session.save(file, &changed))).join("\n");
        assert!(told.contains(expected), "{told}\nis not\n{expected}");
        session.save(file, &text);
        assert_same(&before, &session.render(), expected);
    }
    assert_validated();
}

/// A sphere over a slab, matte, so that nothing but what is tested decides their light.
fn stage(more: &[&str]) -> Session {
    let matte = serde_json::json!({"pbrMetallicRoughness": {
        "baseColorFactor": [0.3, 0.3, 0.3, 1.0], "metallicFactor": 0.0, "roughnessFactor": 1.0}});
    let slab = glb::cuboid([-2.0, -1.4, -2.0], [2.0, -1.1, 2.0], true);
    let model = load(&glb::scene(&[(glb::sphere(24, 48), matte.clone()), (slab, matte)]));
    let plain = ["view.msaa=1", "view.background=none", "view.frames=48", "lights.ambient_strength=0"];
    Session::new(model, settings(&[&plain[..], more].concat()))
}

/// Root of the mean square of the differences over the pixels that the model covers.
fn error(a: &Capture, b: &Capture) -> f64 {
    let mut sum = (0.0, 0.0);
    for y in 0..SIZE.1 {
        for x in 0..SIZE.0 {
            let (a, b) = (a.raw_at(x, y).unwrap(), b.raw_at(x, y).unwrap());
            if a[3] > 0.0 {
                sum = (sum.0 + f64::from(a[1] - b[1]).powi(2), sum.1 + 1.0);
            }
        }
    }
    (sum.0 / f64::max(sum.1, 1.0)).sqrt()
}

#[test]
fn shadows_are_those_of_random_paths() {
    let mut session = stage(&["environment.name=none", "view.bounces=0"]);
    let truth = session.mode("path-traced");
    let open = session.mode("final");
    session.set("SHADOWS=Hard");
    let hard = session.mode("final");
    session.set("SHADOWS=Soft");
    session.set("shadow_softness=0.001");
    let soft = session.mode("final");
    let (open, hard, soft) = (error(&truth, &open), error(&truth, &hard), error(&truth, &soft));
    println!("without shadows {open:.4}, hard {hard:.4}, soft {soft:.4}");
    assert!(hard < 0.35 * open, "{hard} of {open}");
    assert!(soft < 0.35 * open, "{soft} of {open}");
    assert_validated();
}

#[test]
fn ambient_occlusion_is_nearer_to_random_paths() {
    let mut session = stage(&["environment.name=furnace", "lights.source=none", "view.bounces=4"]);
    let truth = session.mode("path-traced");
    let open = session.mode("final");
    session.set("AMBIENT_OCCLUSION=true");
    session.set("occlusion_radius=1");
    let occluded = session.mode("final");
    let (without, with) = (error(&truth, &open), error(&truth, &occluded));
    println!("without occlusion {without:.4}, with {with:.4}");
    assert!(with < 0.5 * without, "{with} of {without}");
    // The upper half of the sphere sees the whole sky.
    let top = |capture: &Capture| capture.raw_at(SIZE.0 / 2, SIZE.1 * 3 / 10).unwrap()[1];
    assert!((top(&occluded) / top(&open) - 1.0).abs() < 0.03, "{} of {}", top(&occluded), top(&open));
    assert_validated();
}

#[test]
fn the_ground_is_dark_under_the_model_alone() {
    let mut session = stage(&["environment.name=studio", "lights.source=none", "view.background=#ffffff"]);
    let plain = session.render();
    session.set("passes.ground=true");
    let ground = session.render();
    let dark = |x: u32, y: u32| {
        let pixel = |capture: &Capture| f32::from(capture.rgba8[((y * SIZE.0 + x) * 4) as usize]);
        pixel(&ground) / pixel(&plain).max(1.0)
    };
    // Above the horizon nothing changes, and shadow only takes light away.
    assert_eq!(dark(SIZE.0 / 2, 1), 1.0);
    let all: Vec<f32> = (0..SIZE.1).flat_map(|y| (0..SIZE.0).map(move |x| (x, y))).map(|(x, y)| dark(x, y)).collect();
    assert!(all.iter().all(|part| *part <= 1.01), "{:?}", all.iter().copied().fold(0.0, f32::max));
    assert!(all.iter().any(|part| *part < 0.8), "{:?}", all.iter().copied().fold(1.0, f32::min));
    session.set("lights.source=orbit");
    let lit = session.render();
    session.set("SHADOWS=Hard");
    assert_differ(&lit, &session.render(), "the lights' shadows");
    assert_validated();
}

/// The shadow of the sun lies on the side away from it.
#[test]
fn the_suns_shadow_on_the_ground_turns_with_the_environment() {
    let chosen = ["environment.name=sky", "lights.source=none", "view.background=#ffffff", "passes.ground=true"];
    let mut session = stage(&chosen);
    // Darkness left of the middle over that right of it, when the environment is turned by so many degrees.
    let mut ratio = |degrees: i32| {
        session.set(&format!("environment.rotation={degrees}"));
        let with = session.render();
        session.set("passes.ground=false");
        let without = session.render();
        session.set("passes.ground=true");
        let taken = |columns: std::ops::Range<u32>| -> f32 {
            let pixels = (0..SIZE.1).flat_map(|y| columns.clone().map(move |x| (y * SIZE.0 + x) as usize * 4));
            pixels.map(|at| f32::from(without.rgba8[at]) - f32::from(with.rgba8[at])).sum()
        };
        taken(0..SIZE.0 / 2) / taken(SIZE.0 / 2..SIZE.0).max(1.0)
    };
    let ratios = [0, 90, 180, -90].map(&mut ratio);
    let (least, most) = ratios.iter().fold((f32::MAX, 0.0_f32), |(least, most), r| (least.min(*r), most.max(*r)));
    assert!(least < 0.67 && most > 1.5, "{ratios:?}");
    assert_validated();
}

/// One pass draws several images, each with a name, a format and, with `mips` and `keep`, levels and the frame before.
#[test]
fn a_pass_draws_several_images() {
    let mut session = sphere();
    let plain = session.render();
    let text = model_pass(
        "normals also=places:rgba32f,numbers:rg16f",
        "color = vec4(normalize(fragment.normal_ws), 1.0);\n    places = vec4(fragment.position_ws, 1.0);\n    \
         numbers = vec4(3.0, 4.0, 5.0, 6.0);",
    );
    let outputs = "out vec4 color;\nlayout(location = 1) out vec4 places;\nlayout(location = 2) out vec4 numbers;";
    let text = text.replace("out vec4 color;", outputs);
    ready(&session.save("passes/normals.frag", &text));
    assert_same(&plain, &session.render(), "nobody reads them");
    let shown = |session: &mut Session, image: &str| {
        session.save("passes/show.frag", &show(image));
        at(&session.render(), 0.5)
    };
    let normal = shown(&mut session, "normals");
    let (place, numbers) = (shown(&mut session, "places"), shown(&mut session, "numbers"));
    for axis in 0..3 {
        assert!((normal[axis] - place[axis]).abs() < 0.01, "on a unit sphere: {normal:?} {place:?}");
    }
    assert_eq!(numbers[..3], [3.0, 4.0, 0.0], "two channels");
    let all = "(texture(normals, uv) + 10.0 * texture(numbers, uv) * texture(places, uv).a)";
    let together = show("normals")
        .replace("texture(normals, uv)", all)
        .replace("void main", "uniform sampler2D places, numbers;\nvoid main");
    ready(&session.save("passes/show.frag", &together));
    assert!((at(&session.render(), 0.5)[0] - normal[0] - 30.0).abs() < 0.05);
    // Each is a debug mode.
    assert!((at(&session.mode("pass:numbers"), 0.5)[1] - 4.0).abs() < 1e-3);
    assert!((at(&session.mode("pass:places"), 0.5)[2] - place[2]).abs() < 0.01);
    session.headless.settings_mut().mode = "final".to_owned();
    passes_check(&session);

    // Levels and frames, in a pass over the whole image.
    let counts = |more: &str| {
        format!(
            "//@pass counts size=4x4 format=r32f keep mips {more}\n#version 460\n#include \"pass.glsl\"\n\
             layout(location = 1) out vec4 twice;\nuniform sampler2D before_counts, before_twice;\n\
             void main() {{\n    color = texture(before_counts, uv) + 1.0;\n    \
             twice = texture(before_twice, uv) + (gl_FragCoord.x < 1.0 ? 8.0 : 0.0);\n}}\n"
        )
    };
    ready(&session.save("passes/counts.frag", &counts("also=twice:r32f")));
    let reader = show("counts")
        .replace("void main", "uniform sampler2D twice;\nvoid main")
        .replace("texture(counts, uv).rgb", "textureLod(counts, uv, 0.0).r, textureLod(twice, uv, 2.0).r, 0.0");
    ready(&session.save("passes/show.frag", &reader));
    session.headless.set_sequence(specula::headless::Sequence { frames: 3, ..Default::default() });
    assert_eq!(at(&session.render(), 0.5)[..2], [3.0, 6.0], "three frames; a quarter of the texels have 24");

    let mut told = |text: &str| lines(failed(&session.save("passes/counts.frag", text))).join("\n");
    for (text, expected) in [
        (
            counts("also=thrice"),
            "counts.frag:1:52: error: the pass draws the image `thrice`, but its stage has no output",
        ),
        (counts("also=twice,more"), "the pass draws the image `more`, but its stage has no output for it"),
        (counts(""), "shader writes `vec4 twice` at location 1"),
        (counts("also=a,b,c,d"), "a pass draws at most 4 images, this one 5"),
        (counts("also=twice:rgb8"), "expected one of the formats rgba16f"),
        (counts("also=normals"), "pass or texture `normals` is given twice"),
        (counts("also=picture"), "`picture` names what Specula draws; choose another name for the image"),
        (
            counts("also=twice").replace("out vec4 twice", "out vec3 twice").replace("twice =", "twice = vec3(1);//"),
            "the pass draws the image `twice`",
        ),
        (
            counts("also=twice").replace("size=4x4 format=r32f keep mips", "to=picture"),
            "the picture has its own size and format",
        ),
    ] {
        let told = told(&text);
        assert!(told.contains(expected), "{told}\nis not\n{expected}");
    }
    assert_eq!(at(&session.render(), 0.5)[..2], [3.0, 6.0], "the last good passes stay");
    assert_validated();
}
