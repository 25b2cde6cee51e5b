//! Passes keep between frames: images that would be the same again, and means over time.

use crate::support::process::run;
use crate::support::{
    SIZE, Session, Tree, assert_differ, assert_same, assert_validated, compiler, glb, gpu, load, ready, settings,
};
use specula::headless::{Headless, Sequence};
use specula::render::Capture;
use specula::shader::Source;

/// A matte sphere over a slab.
fn model() -> specula::scene::Model {
    let matte = serde_json::json!({"pbrMetallicRoughness": {
        "baseColorFactor": [0.3, 0.3, 0.3, 1.0], "metallicFactor": 0.0, "roughnessFactor": 1.0}});
    let slab = glb::cuboid([-2.0, -1.4, -2.0], [2.0, -1.1, 2.0], true);
    load(&glb::scene(&[(glb::sphere(24, 48), matte.clone()), (slab, matte)]))
}

/// The picture by a renderer that has drawn nothing before.
fn fresh(session: &mut Session) -> Capture {
    let (source, settings) = (Source::disk(session.tree.root()), session.headless.settings_mut().clone());
    let headless = Headless::new(gpu(), compiler(), source, model(), settings, SIZE);
    headless.map(|(mut headless, _)| headless.render().unwrap()).unwrap_or_else(|error| panic!("{error}"))
}

/// Whether the last frame has kept the image of a pass; `None` if it had no such pass.
fn kept(session: &Session, name: &str) -> Option<bool> {
    session.headless.pass_times().iter().find(|pass| pass.name == name).map(|pass| pass.kept)
}

/// Root of the mean square of the differences.
fn error(a: &Capture, b: &Capture) -> f64 {
    let differences = a.rgba8.iter().zip(&b.rgba8).map(|(a, b)| (f64::from(*a) - f64::from(*b)).powi(2));
    (differences.sum::<f64>() / a.rgba8.len() as f64).sqrt()
}

#[test]
fn kept_images_are_those_of_a_fresh_renderer() {
    let on = ["SHADOWS=Hard", "AMBIENT_OCCLUSION=true", "BLOOM=true", "passes.ground=true", "view.msaa=1"];
    let mut session = Session::new(model(), settings(&on));
    session.render();
    assert_eq!(kept(&session, "shadow_map"), Some(false), "the first");
    let mut before = session.render();
    let maps =
        |session: &Session| ["shadow_map", "ground_blockers", "geometry"].map(|name| kept(session, name).unwrap());
    assert_eq!(maps(&session), [true; 3], "nothing has changed");
    for (change, expected) in [
        ("camera.azimuth=50", [true, true, false]),
        ("view.ev=1", [true; 3]),
        ("bloom_strength=0.4", [true; 3]),
        ("lights.orbit.0.azimuth=70", [false, true, true]),
        ("lights.source=none", [false, true, true]),
        ("lights.source=orbit", [false, true, true]),
        ("environment.rotation=40", [true; 3]),
        ("environment.name=sky", [true; 3]),
        ("occlusion_radius=1", [true; 3]),
        ("TOON_BANDS=3", [true; 3]),
    ] {
        session.set(change);
        let picture = session.render();
        let drawn = maps(&session);
        assert_differ(&before, &picture, change);
        assert_same(&fresh(&mut session), &picture, change);
        assert!(
            drawn.iter().zip(expected).all(|(kept, may)| !kept || may),
            "{change}: {drawn:?}, expected {expected:?}"
        );
        before = picture;
    }
    session.set("camera.azimuth=20");
    session.render();
    assert_eq!(maps(&session), [true, true, false], "while only the camera moves, the maps stay");
    let hook = "void user_vertex(inout Vertex vertex) {";
    for (file, from, to) in [
        ("passes/shadows/shadow_map.frag", "color = vec4(gl_FragCoord.z", "color = vec4(0.0 * gl_FragCoord.z"),
        ("passes/ground/ground_sky.frag", "void main() {", "void main() {\n    color = vec4(0.5);\n    return;"),
        ("user/vertex.glsl", hook, &format!("{hook}\n    vertex.position *= 0.8;")),
    ] {
        before = session.render();
        ready(&session.edit(file, from, to));
        let picture = session.render();
        assert_differ(&before, &picture, file);
        assert_same(&fresh(&mut session), &picture, file);
    }
    assert_validated();
}

#[test]
fn a_pass_is_drawn_again_when_one_that_it_reads_was() {
    let mut session = Session::new(model(), settings(&["view.msaa=1", "environment.name=none"]));
    let pass = |annotation: &str, uniforms: &str, body: &str| {
        format!("//@pass {annotation}\n#version 460\n#include \"pass.glsl\"\n{uniforms}\nvoid main() {{ {body} }}\n")
    };
    let slider = "uniform Block { float level; };   //@ui \"Level\" 0..1 = 0.25";
    ready(&session.save("passes/first.frag", &pass("first size=4x4", slider, "color = vec4(level);")));
    let reads = |image: &str| format!("uniform sampler2D {image};");
    let body = "color = 0.5 * texture(first, uv);";
    ready(&session.save("passes/second.frag", &pass("second size=2x2", &reads("first"), body)));
    let body = "color = vec4(texture(second, uv).rgb, 1.0);";
    ready(&session.save("passes/third.frag", &pass("third to=picture after=tonemap", &reads("second"), body)));
    let gray = |session: &mut Session| session.render().rgba8[0];
    let states = |session: &Session| ["first", "second"].map(|name| kept(session, name));
    assert_eq!(gray(&mut session), 32);
    assert_eq!(gray(&mut session), 32);
    assert_eq!(states(&session), [Some(true); 2]);
    session.set("level=0.75");
    assert_eq!(gray(&mut session), 96);
    assert_eq!(states(&session), [Some(false); 2]);
    session.set("passes.first=false");
    assert_eq!(gray(&mut session), 0);
    assert_eq!(states(&session), [None, Some(false)]);
    session.set("passes.first=true");
    assert_eq!(gray(&mut session), 96);
    // The time reaches a pass that reads it, and what reads that.
    let body = "color = vec4(frame.time_s);";
    ready(&session.save("passes/first.frag", &pass("first size=4x4", slider, body)));
    session.headless.set_sequence(Sequence { frames: 2, start_s: 0.4, fps: 10.0, ..Sequence::default() });
    assert_eq!(gray(&mut session), 64);
    assert_eq!(states(&session), [Some(false); 2]);
    assert_validated();
}

#[test]
fn temporal_antialiasing_smooths_edges_and_follows_the_camera() {
    let plain = ["view.msaa=4", "environment.name=furnace", "view.background=#000000", "camera.azimuth=30"];
    let mut session = Session::new(model(), settings(&plain));
    let smooth = session.render();
    session.set("camera.azimuth=34");
    let smooth_turned = session.render();
    session.set("view.msaa=1");
    let jagged_turned = session.render();
    session.set("camera.azimuth=30");
    let jagged = session.render();
    session.set("TEMPORAL_ANTIALIASING=true");
    session.headless.set_sequence(Sequence { frames: 48, start_s: 0.0, fps: 30.0, ..Sequence::default() });
    let turned = |session: &mut Session| {
        session.set("camera.azimuth=30");
        let still = session.render();
        for step in 1..=8 {
            session.set(&format!("camera.azimuth={}", 30.0 + 0.5 * f64::from(step)));
            let last = session.headless.render_next().unwrap();
            if step == 8 {
                return [still, last];
            }
        }
        unreachable!()
    };
    let [still, moved] = turned(&mut session);
    let (with, without) = (error(&still, &smooth), error(&jagged, &smooth));
    println!("at rest: {with:.2} of {without:.2} levels");
    assert!(with < 0.5 * without, "at rest: {with} of {without}");
    let (with, without) = (error(&moved, &smooth_turned), error(&jagged_turned, &smooth_turned));
    println!("while turning: {with:.2} of {without:.2} levels");
    assert!(with < 0.8 * without, "while turning: {with} of {without}");
    let [again, _] = turned(&mut session);
    assert_same(&still, &again, "two runs");
    // Without the motion, the mean lags behind.
    let motion = "vec2 before_px = gl_FragCoord.xy + motion_px;";
    ready(&session.edit("passes/temporal/temporal_mean.frag", motion, "vec2 before_px = gl_FragCoord.xy;"));
    let [_, lagging] = turned(&mut session);
    let lagging = error(&lagging, &smooth_turned);
    println!("without motion: {lagging:.2} levels");
    assert!(lagging > 1.3 * with, "{lagging} of {with}");
    assert_validated();
}

/// The model, whose sphere rests for 47 frames of a second of 30, and then rises by 0.04 m in each of 8.
fn rising() -> specula::scene::Model {
    let matte = serde_json::json!({"pbrMetallicRoughness": {
        "baseColorFactor": [0.3, 0.3, 0.3, 1.0], "metallicFactor": 0.0, "roughnessFactor": 1.0}});
    let slab = glb::cuboid([-2.0, -1.4, -2.0], [2.0, -1.1, 2.0], true);
    let (mut json, mut bin) = glb::parts(&glb::scene(&[(glb::sphere(24, 48), matte.clone()), (slab, matte)]));
    let times = [0.0, 47.0 / 30.0, 55.0 / 30.0, 3.0_f32];
    let numbers = times.into_iter().chain([0.0, 0.0, 0.32, 0.32].into_iter().flat_map(|y| [0.0, y, 0.0]));
    let (at, first) = (bin.len(), json["accessors"].as_array().unwrap().len());
    bin.extend(numbers.flat_map(f32::to_le_bytes));
    let view = json["bufferViews"].as_array().unwrap().len();
    for (offset, bytes) in [(0, 16), (16, 48)] {
        let view = serde_json::json!({"buffer": 0, "byteOffset": at + offset, "byteLength": bytes});
        json["bufferViews"].as_array_mut().unwrap().push(view);
    }
    for (number, kind) in ["SCALAR", "VEC3"].iter().enumerate() {
        let accessor =
            serde_json::json!({"bufferView": view + number, "componentType": 5126, "count": 4, "type": kind});
        json["accessors"].as_array_mut().unwrap().push(accessor);
    }
    json["animations"] = serde_json::json!([{
        "samplers": [{"input": first, "output": first + 1}],
        "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
    }]);
    json["buffers"][0]["byteLength"] = serde_json::json!(bin.len());
    load(&glb::container(&json, &bin))
}

#[test]
fn temporal_antialiasing_follows_a_pose() {
    let plain = ["view.msaa=4", "environment.name=furnace", "view.background=#000000", "camera.eye=[0, 0.4, 4]"];
    let mut session = Session::new(rising(), settings(&[&plain[..], &["camera.target=[0, 0, 0]"]].concat()));
    let end = Sequence { frames: 1, start_s: 55.0 / 30.0, fps: 30.0, ..Sequence::default() };
    session.headless.set_sequence(end);
    let smooth = session.render();
    session.set("view.msaa=1");
    let jagged = session.render();
    session.headless.set_sequence(Sequence { start_s: 0.0, ..end });
    assert_differ(&jagged, &session.render(), "the sphere rises");
    session.set("TEMPORAL_ANTIALIASING=true");
    session.headless.set_sequence(Sequence { frames: 48, start_s: 0.0, fps: 30.0, ..Sequence::default() });
    let last = |session: &mut Session| {
        let mut last = session.render();
        for _ in 0..8 {
            last = session.headless.render_next().unwrap();
        }
        last
    };
    let (with, without) = (error(&last(&mut session), &smooth), error(&jagged, &smooth));
    println!("while rising: {with:.2} of {without:.2} levels");
    assert!(with < 0.8 * without, "while rising: {with} of {without}");
    // Without its motion, the mean of the sphere is looked for where it is now.
    ready(&session.edit("passes/temporal/temporal_mean.frag", "if (own.a == 1.0)", "if (false)"));
    let lagging = error(&last(&mut session), &smooth);
    println!("without its motion: {lagging:.2} levels");
    assert!(lagging > 1.2 * with, "{lagging} of {with}");
    assert_validated();
}

#[test]
fn a_mean_goes_on_while_only_what_follows_the_model_moves() {
    let mut session = Session::new(model(), settings(&["view.msaa=1", "environment.name=sky", "view.frames=256"]));
    session.headless.settings_mut().mode = "monte-carlo".to_owned();
    let truth = session.render();
    session.set("view.frames=1");
    session.headless.set_sequence(Sequence { frames: 1, start_s: 0.0, fps: 30.0, ..Sequence::default() });
    let pass = "//@pass flicker to=picture after=tonemap\n#version 460\n#include \"pass.glsl\"\n\
        uniform sampler2D picture;\nvoid main() { color = texture(picture, uv) * (frame.time_s < 0.0 ? 0.0 : 1.0); }\n";
    ready(&session.save("passes/flicker.frag", pass));
    assert!(session.headless.is_animated().unwrap());
    let after = |session: &mut Session| {
        let first = error(&session.render(), &truth);
        (1..48).for_each(|_| session.headless.draw_next().unwrap());
        (first, error(&session.headless.render_next().unwrap(), &truth))
    };
    let (first, last) = after(&mut session);
    println!("one frame: {first:.2} levels, 48 frames: {last:.2}");
    assert!(last < 0.4 * first, "{last} of {first}");
    // A model that moves begins a new mean with each frame.
    let hook = "void user_vertex(inout Vertex vertex) {";
    let moved = format!("{hook}\n    vertex.position *= frame.time_s < 0.0 ? 2.0 : 1.0;");
    ready(&session.edit("user/vertex.glsl", hook, &moved));
    let (first, last) = after(&mut session);
    assert!(last > 0.8 * first, "{last} of {first}");
    assert_validated();
}

/// A picture of one frame says that its passes go on, unless the number of frames was given.
#[test]
fn one_frame_of_what_continues_has_a_hint() {
    let tree = Tree::new();
    let render = |more: &[&str]| {
        let args = ["render", "--size", "32x32", "--events", "json"];
        let done = run(&tree.beside(""), &[&args[..], more].concat());
        done.expect(0, &[]);
        assert!(done.stdout.lines().all(|line| line.starts_with('{')), "{done:#?}");
        done.stderr
    };
    assert_eq!(render(&[]), "", "nothing continues");
    let hint = "specula: hint: the pass `temporal_mean` continues from frame to frame, and this is the first; \
        --frames 60 draws 60\n";
    assert_eq!(render(&["--set", "TEMPORAL_ANTIALIASING=true"]), hint);
    for frames in ["1", "2"] {
        assert_eq!(render(&["--set", "TEMPORAL_ANTIALIASING=true", "--frames", frames]), "");
    }
    let buffer = "buffer Counts { uint count; };";
    let text = format!(
        "//@pass counts to=picture\n#version 460\n#include \"pass.glsl\"\n{buffer}\n\
         void main() {{ count = 1u; color = vec4(count); }}\n"
    );
    tree.write("passes/counts.frag", &text);
    assert!(render(&[]).contains("`counts` continues"));
}
