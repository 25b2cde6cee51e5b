//! Passes that the tree declares: one new file is a working effect, errors have their line, and what is off costs nothing.

mod memory;
mod random;

use crate::support::{
    SIZE, Session, assert_differ, assert_same, failed, glb, lines, load, passes_check, ready, settings, srgb, stages,
};
use specula::headless::Sequence;
use specula::render::Capture;
use specula::shader::Diagnostic;

/// A gray sphere, one sample a pixel, on nothing.
fn sphere(more: &[&str]) -> Session {
    let plain = ["view.msaa=1", "view.background=none", "environment.name=none"];
    let model = load(&glb::model(&glb::sphere(16, 32), &glb::gray()));
    Session::new(model, settings(&[&plain[..], more].concat()))
}

/// A pass over the whole image: its annotation, its uniforms, and the body of its `main`.
fn pass(annotation: &str, uniforms: &str, body: &str) -> String {
    format!("//@pass {annotation}\n#version 460\n#include \"pass.glsl\"\n{uniforms}\nvoid main() {{\n{body}\n}}\n")
}

fn center(capture: &Capture) -> [f32; 4] {
    capture.raw_at(SIZE.0 / 2, SIZE.1 / 2).unwrap()
}

fn remove(session: &mut Session, file: &str) {
    std::fs::remove_file(session.tree.path(file)).unwrap();
    ready(&session.changed(&[file]));
}

fn sequence(session: &mut Session, frames: u32) -> Capture {
    session.headless.set_sequence(Sequence { frames, start_s: 1.0, fps: 10.0, ..Sequence::default() });
    session.render()
}

/// The text in one of the READMEs that begins like this.
fn in_readme(begin: &str) -> String {
    let readmes = crate::support::readmes();
    let (_, rest) = readmes.split_once(&format!("```glsl\n{begin}")).expect("a README shows it");
    format!("{begin}{}", rest.split_once("```").unwrap().0)
}

/// The compute pass and the slider of the README.
#[test]
fn the_readmes_ripples_spread_what_the_frame_before_had() {
    let mut session = sphere(&[]);
    ready(&session.save("passes/ripples.comp", &in_readme("//@pass ripples")));
    let slider = in_readme("uniform Vignette");
    let uniforms = format!("uniform sampler2D ripples;\n{slider}");
    let body = "color = vec4(strength * texelFetch(ripples, ivec2(128), 0).r, 0.0, 0.0, 1.0);";
    ready(&session.save("passes/show.frag", &pass("show to=picture", &uniforms, body)));
    session.set("strength=2");
    // The sequence begins at 1 s, with 10 frames a second.
    let expected = 2.0 * (0.99 * 1.0_f32.sin() + 1.1_f32.sin());
    let found = center(&sequence(&mut session, 2))[0];
    assert!((found - expected).abs() < 1e-3, "{found} is not {expected}");
}

#[test]
fn one_file_of_ten_lines_is_an_effect() {
    let text = in_readme("//@pass vignette");
    assert!(text.lines().count() <= 10, "{text}");
    let mut session = sphere(&["view.background=#808080"]);
    let before = session.render();
    let reload = session.save("passes/vignette.frag", &text);
    ready(&reload);
    assert_eq!(stages(&reload), ["passes/vignette.frag"], "saving a pass compiles that pass alone");
    let with = session.render();
    let pixel = |capture: &Capture, x: u32, y: u32| capture.rgba8[((y * SIZE.0 + x) * 4) as usize];
    assert_eq!(pixel(&with, SIZE.0 / 2, SIZE.1 / 2), pixel(&before, SIZE.0 / 2, SIZE.1 / 2), "the center stays");
    let (corner, plain) = (f32::from(pixel(&with, 0, 0)), f32::from(pixel(&before, 0, 0)));
    assert!((corner / plain - 0.5).abs() < 0.02, "the corner has half of {plain}, not {corner}");
    passes_check(&session);
    session.set("passes.vignette=false");
    assert_same(&before, &session.render(), "switched off");
    session.set("passes.vignette=true");
    assert_same(&with, &session.render(), "switched on");
    remove(&mut session, "passes/vignette.frag");
    session.headless.settings_mut().passes.clear();
    assert_same(&before, &session.render(), "without the file");
}

#[test]
fn the_order_follows_from_who_reads_what() {
    let mut session = sphere(&[]);
    let before = center(&session.render());
    let reads = "uniform sampler2D picture;";
    let uniforms = format!("{reads}\nuniform sampler2D z;");
    let adds =
        |annotation| pass(annotation, &uniforms, "color = texture(picture, uv) + vec4(texture(z, uv).rgb, 0.0);");
    // In the order of names a would come before z, which it reads. A pass may be anywhere in the tree.
    failed(&session.save("a.frag", &adds("a to=picture")));
    let text = pass("z format=rgba32f", reads, "color = 2.0 * texture(picture, uv) + 1.0;");
    ready(&session.save("passes/z.frag", &text));
    let sum = center(&session.render());
    for c in 0..3 {
        let expected = before[c] + 2.0 * before[c] + 1.0;
        assert!((sum[c] / expected - 1.0).abs() < 2e-3, "channel {c}: {sum:?}, before {before:?}");
    }
    // Of two that change the picture, names decide, and `after=` decides before names.
    ready(&session.save("b.frag", &pass("b to=picture", reads, "color = 2.0 * texture(picture, uv);")));
    let doubled = center(&session.render());
    assert!((doubled[0] / (2.0 * sum[0]) - 1.0).abs() < 1e-3);
    ready(&session.save("a.frag", &adds("a to=picture after=b")));
    let after = center(&session.render());
    let expected = 2.0 * before[0] + (2.0 * 2.0 * before[0] + 1.0);
    assert!((after[0] / expected - 1.0).abs() < 2e-3, "{after:?} is not {expected}");
}

#[test]
fn an_image_has_the_size_and_format_of_its_pass() {
    let mut session = sphere(&[]);
    for (annotation, size) in
        [("size=1/4", [SIZE.0.div_ceil(4), SIZE.1.div_ceil(4)]), ("size=7x5", [7, 5]), ("size=6", [6, 6])]
    {
        let text = pass(&format!("small {annotation} format=rg32f"), "", "color = vec4(pass.size_px, 3.0, 4.0);");
        ready(&session.save("passes/small.frag", &text));
        let read = "color = vec4(texture(small, uv).rgb, 1.0) + 0.0 * float(textureSize(small, 0).x);";
        ready(&session.save("passes/show.frag", &pass("show to=picture", "uniform sampler2D small;", read)));
        let [width, height] = size.map(|side| side as f32);
        assert_eq!(center(&session.render())[..3], [width, height, 0.0], "{annotation}");
        assert_eq!(center(&session.mode("pass:small"))[..2], [width, height], "its own mode, {annotation}");
        session.mode("final");
        remove(&mut session, "passes/show.frag");
    }
    // The last of the mip levels is the mean.
    let ramp = pass("small size=8x8 format=r32f mips", "", "color = vec4(floor(uv.x * 8.0));");
    ready(&session.save("passes/small.frag", &ramp));
    let read = "color = vec4(vec3(textureLod(small, uv, 3.0).r), 1.0);";
    ready(&session.save("passes/show.frag", &pass("show to=picture", "uniform sampler2D small;", read)));
    assert_eq!(center(&session.render())[0], 3.5);
}

#[test]
fn an_image_of_the_frame_before_makes_feedback() {
    let mut session = sphere(&[]);
    let body = "color = texture(before_count, uv) + vec4(1.0, frame.frame_index, frame.time_s, 0.0);";
    let text = pass("count size=2x2 format=rgba32f keep", "uniform sampler2D before_count;", body);
    ready(&session.save("passes/count.frag", &text));
    let show = pass("show to=picture", "uniform sampler2D count;", "color = vec4(texture(count, uv).rgb, 1.0);");
    ready(&session.save("passes/show.frag", &show));
    let of = |capture: &Capture| center(capture);
    assert_eq!(of(&sequence(&mut session, 1))[..3], [1.0, 0.0, 1.0]);
    let five = sequence(&mut session, 5);
    let [frames, indices, times, _] = of(&five);
    assert_eq!([frames, indices], [5.0, 10.0]);
    assert!((times - (1.0 + 1.1 + 1.2 + 1.3 + 1.4)).abs() < 1e-5, "{times}");
    assert_same(&five, &sequence(&mut session, 5), "each picture begins again");
}

#[test]
fn compute_passes_write_images_and_buffers() {
    let mut session = sphere(&[]);
    let compute = "//@pass cells size=9x7 format=r32f keep\n#version 460\n#include \"interface.glsl\"\n\
        layout(local_size_x = 8, local_size_y = 8) in;\n\
        layout(r32f) uniform writeonly image2D cells;\nuniform sampler2D before_cells;\n\
        buffer Counter { uint groups; } counter;\n\
        void main() {\n    ivec2 at = ivec2(gl_GlobalInvocationID.xy);\n\
        if (gl_LocalInvocationIndex == 0u) atomicAdd(counter.groups, 1u);\n\
        if (at.x < 9 && at.y < 7) imageStore(cells, at, texelFetch(before_cells, at, 0) + float(at.x));\n}\n";
    ready(&session.save("passes/cells.comp", compute));
    let uniforms = "uniform sampler2D cells;\nreadonly buffer Counter { uint groups; } counter;";
    let body = "color = vec4(texelFetch(cells, ivec2(8, 6), 0).r, counter.groups, 0.0, 1.0);";
    ready(&session.save("passes/show.frag", &pass("show to=picture", uniforms, body)));
    // 9 x 7 texels take 2 x 1 groups a frame.
    assert_eq!(center(&sequence(&mut session, 3))[..2], [24.0, 6.0]);
    passes_check(&session);
}

#[test]
fn a_pass_reads_the_depth_of_the_model() {
    for msaa in ["view.msaa=1", "view.msaa=4"] {
        let mut session = sphere(&[]);
        session.set(msaa);
        let body = "color = vec4(vec3(texture(depth, uv).r), 1.0);";
        ready(&session.save("passes/show.frag", &pass("show to=picture", "uniform sampler2D depth;", body)));
        let capture = session.render();
        let state = session.headless.frame_state().unwrap();
        // Reversed and infinite: near / distance along the view.
        let distance = (state.camera.eye.length() - 1.0).max(0.1);
        let expected = state.camera.near / distance;
        let found = center(&capture)[0];
        assert!((found / expected - 1.0).abs() < 0.2, "{msaa}: {found} is not about {expected}");
        assert_eq!(capture.raw_at(0, 0).unwrap()[0], 0.0, "nothing is at infinity, {msaa}");
    }
}

#[test]
fn own_parameters_are_sliders_that_compile_nothing() {
    let mut session = sphere(&[]);
    let uniforms =
        "uniform sampler2D picture;\nuniform Tint { float amount; vec3 tint; };   //@ui \"Amount\" 0..1 = 0.5";
    // Two blocks: the pass's own, and that of pass.glsl.
    let body = "color = vec4(amount, pass.size_px, 1.0) + 0.0 * tint.x + 0.0 * texture(picture, uv);";
    ready(&session.save("passes/tint.frag", &pass("tint to=picture", uniforms, body)));
    assert_eq!(center(&session.render())[..3], [0.5, SIZE.0 as f32, SIZE.1 as f32]);
    session.set("amount=0.25");
    assert_eq!(center(&session.render())[0], 0.25);
    let wrong = session.headless.settings_mut().assign("amount=7");
    assert!(wrong.is_ok() && session.headless.render().is_err(), "0.25 is in 0..1, 7 is not");
}

#[test]
fn textures_of_the_tree_are_read_by_name_and_reloaded() {
    let mut session = sphere(&[]);
    let paint = |session: &Session, value: u8| {
        let image = image::RgbaImage::from_pixel(4, 4, image::Rgba([value, 128, 0, 255]));
        image.save(session.tree.path("passes/paint.png")).unwrap();
    };
    std::fs::create_dir_all(session.tree.path("passes")).unwrap();
    let uniforms = "//@texture paint \"paint.png\" linear clamp\nuniform sampler2D paint;";
    let text = pass("show to=picture", uniforms, "color = vec4(texture(paint, uv).rgb, 1.0);");
    let reload = session.save("passes/show.frag", &text);
    let missing = lines(failed(&reload));
    assert!(missing[0].contains("show.frag:4:19: error: \"paint.png\" not found; looked for"), "{missing:#?}");
    paint(&session, 51);
    ready(&session.changed(&["passes/paint.png"]));
    let shown = center(&session.render());
    assert!((shown[0] - 0.2).abs() < 1e-6 && (shown[1] - 128.0 / 255.0).abs() < 1e-6, "{shown:?}");
    paint(&session, 255);
    let reload = session.changed(&["passes/paint.png"]);
    ready(&reload);
    assert!(stages(&reload).is_empty(), "a texture compiles nothing");
    assert_eq!(center(&session.render())[0], 1.0);
    // A broken file costs nothing.
    let before = session.render();
    std::fs::write(session.tree.path("passes/paint.png"), "no image").unwrap();
    let broken = session.changed(&["passes/paint.png"]);
    let told = lines(failed(&broken));
    assert!(told[0].contains("paint.png cannot be read") && told[0].contains(".frag:"), "{told:#?}");
    assert_same(&before, &session.render(), "the last good texture stays");
}

/// The image of one frame ago is kept because a pass reads it, also if its own pass does not say `keep`.
#[test]
fn an_image_that_is_read_one_frame_later_is_kept() {
    let mut session = sphere(&[]);
    ready(&session.save("passes/count.frag", &pass("count", "", "color = vec4(float(frame.frame_index) + 1.0);")));
    let shows =
        pass("show to=picture", "uniform sampler2D before_count;", "color = vec4(texture(before_count, uv).rgb, 1.0);");
    ready(&session.save("passes/show.frag", &shows));
    session.headless.set_sequence(Sequence { frames: 3, ..Sequence::default() });
    assert_eq!(session.render().raw_at(0, 0).unwrap(), [2.0, 2.0, 2.0, 1.0]);
    session.headless.set_sequence(Sequence::default());
    assert_eq!(session.render().raw_at(0, 0).unwrap(), [0.0, 0.0, 0.0, 1.0], "nothing before the first frame");
    passes_check(&session);
}

/// What the picture and the depth were one frame ago, without a pass of the user's that copies them.
#[test]
fn the_last_picture_and_its_depth_are_there() {
    let mut session = sphere(&[]);
    let good = session.render();
    let middle = |capture: &Capture| capture.raw_at(SIZE.0 / 2, SIZE.1 / 2).unwrap();
    let shows = |image: &str| {
        pass(
            "show to=picture",
            &format!("uniform sampler2D before_{image};"),
            &format!("color = texture(before_{image}, uv);"),
        )
    };
    let [first, second] = [1, 2].map(|frames| Sequence { frames, ..Sequence::default() });
    for image in ["picture", "depth"] {
        ready(&session.save("passes/show.frag", &shows(image)));
        session.headless.set_sequence(first);
        assert_eq!(middle(&session.render())[0], 0.0, "{image}: nothing before the first frame");
        session.headless.set_sequence(second);
        let found = middle(&session.render())[0];
        match image {
            // The picture of the frame before is that of this pass too, which began with nothing.
            "picture" => assert_eq!(found, 0.0),
            _ => assert!(found > 0.0 && found < 1.0, "{found}"),
        }
        passes_check(&session);
    }
    // A mix of both frames converges to the picture.
    let mix = "color = mix(texture(picture, uv), texture(before_picture, uv), 0.5);";
    let mixes = pass("show to=picture", "uniform sampler2D picture; uniform sampler2D before_picture;", mix);
    ready(&session.save("passes/show.frag", &mixes));
    session.headless.set_sequence(Sequence { frames: 12, ..Sequence::default() });
    let found = middle(&session.render());
    assert!((found[0] / middle(&good)[0] - 1.0).abs() < 0.01, "{found:?}");
    session.headless.set_sequence(Sequence::default());
}

/// A pass after the tone map is read as it is displayed.
#[test]
fn a_pixel_of_a_displayed_pass_is_that_of_the_display() {
    let mut session = sphere(&[]);
    let shows = pass("show to=picture after=tonemap", "", "color = vec4(0.2, 0.4, 0.8, 1.0);");
    ready(&session.save("passes/show.frag", &shows));
    let shaders = session.headless.shaders();
    let modes: Vec<_> = shaders.modes.iter().filter(|mode| mode.slug == "pass:show").cloned().collect();
    let pixel = session.headless.pixel((SIZE.0 / 2, SIZE.1 / 2), &modes).unwrap()[0];
    assert_eq!(pixel.value, [0.2, 0.4, 0.8, 1.0]);
    assert!(pixel.text(&modes[0]).contains("displayed"), "{}", pixel.text(&modes[0]));
}

#[test]
fn errors_have_their_line_and_the_picture_stays() {
    let mut session = sphere(&[]);
    let good = pass("glow size=1/2", "uniform sampler2D picture;", "color = texture(picture, uv);");
    ready(&session.save("passes/glow.frag", &good));
    let before = session.render();
    let show = |uniforms: &str| pass("show to=picture", uniforms, "color = vec4(1.0);");
    let use_it = |name: &str| {
        let uniforms = format!("uniform sampler2D {name};");
        pass("show to=picture", &uniforms, &format!("color = texture({name}, uv);"))
    };
    for (text, expected) in [
        (use_it("glwo"), "show.frag:4:19: error: no pass or texture is named `glwo`. Did you mean `glow`?"),
        (use_it("film"), "show.frag:4:19: error: `film` gives what it draws to the picture"),
        (use_it("before_film"), "show.frag:4:19: error: `film` gives what it draws to the picture, which is not kept"),
        (use_it("show"), "show.frag:4:19: error: a pass cannot read the image that it draws, `show`"),
        (show("").replace("to=picture", "size=0"), "show.frag:1:19: error: expected size=1, size=1/2 to size=1/64"),
        (show("").replace("to=picture", "format=rgb8"), "show.frag:1:21: error: expected one of the formats rgba16f"),
        (
            show("").replace("to=picture", "to=glow"),
            "show.frag:1:17: error: expected to=picture, to=peel, to=resolve, to=mean or to=display, found `glow`",
        ),
        (show("").replace("to=picture", "after=nobody"), "show.frag:1:20: error: no pass is named `nobody`."),
        (show("").replace("show to", "picture to"), "show.frag:1:9: error: `picture` names what Specula draws"),
        (show("").replace("show to", "glow to"), "error: pass or texture `glow` is given twice"),
        (show("").replace("to=picture", "to=picture size=1/2"), "show.frag:1:30: error: the picture has its own size"),
        (
            show("").replace("to=picture", "dispatch=8"),
            "show.frag:1:23: error: only a compute pass (.comp) has dispatch=",
        ),
        (
            show("//@texture t \"../../x.png\"")
                .replace("vec4(1.0)", "texture(t, uv)")
                .replace("//@texture", "uniform sampler2D t; //@texture"),
            "leaves the shader tree",
        ),
        (
            show("buffer B { float x[]; };").replace("vec4(1.0)", "vec4(x[0])"),
            "show.frag:4:8: error: `x` in the buffer `B` has no length",
        ),
        (
            use_it("cube").replace("sampler2D", "samplerCube").replace("uv)", "vec3(uv, 1))"),
            "show.frag:4:21: error: no texture is named `cube`.",
        ),
    ] {
        let told = lines(failed(&session.save("passes/show.frag", &text)));
        assert!(told.iter().any(|line| line.contains(expected)), "{text}\nsays\n{}\nnot\n{expected}", told.join("\n"));
        assert_same(&before, &session.render(), expected);
    }
    let own_image = "layout(rgba16f) uniform writeonly image2D show;";
    let draws = "imageStore(show, ivec2(0), vec4(1.0)); color = vec4(1.0);";
    let told = lines(failed(&session.save("passes/show.frag", &pass("show", own_image, draws))));
    assert!(told.iter().any(|line| line.contains("only a compute shader can write the image")), "{}", told.join("\n"));
    let compute = format!(
        "//@pass cells format=r16f\n#version 460\nlayout(local_size_x = 8) in;\n{}\nvoid main() {{}}\n",
        own_image.replace("rgba16f", "r16f").replace("show", "cells")
    );
    let told = lines(failed(&session.save("passes/cells.comp", &compute)));
    let needs =
        |line: &String| line.contains("cells.comp:4:8: error: shader needs the device feature StorageImageExtended");
    assert!(told.iter().any(needs), "{}", told.join("\n"));
    std::fs::remove_file(session.tree.path("passes/cells.comp")).unwrap();
    session.changed(&["passes/cells.comp"]);
    // Bindings follow the names. One that is given may have the place of another.
    let told = (0..4).flat_map(|binding| {
        let given = format!("uniform sampler2D picture; layout(set = 2, binding = {binding}) uniform sampler2D glow;");
        let text = pass("show", &given, "color = texture(glow, uv) + texture(picture, uv);");
        match session.save("passes/show.frag", &text).outcome {
            specula::pipeline::Outcome::Failed(diagnostics) => lines(&diagnostics),
            _ => Vec::new(),
        }
    });
    let told: Vec<String> = told.collect();
    assert!(told.iter().any(|line| line.contains("error: `glow` has a binding of its own")), "{told:#?}");
    // Two passes that share a buffer agree on its size.
    let shares = |name: &str, count: u32| {
        pass(name, &format!("readonly buffer B {{ float b[{count}]; }};"), "color = vec4(b[1]);")
    };
    ready(&session.save("passes/show.frag", &shares("show", 4)));
    let told = lines(failed(&session.save("passes/other.frag", &shares("other", 8))));
    assert!(told[0].contains("the buffer `B` has 16 bytes here and 32 in the pass `other`"), "{told:#?}");
    std::fs::remove_file(session.tree.path("passes/other.frag")).unwrap();
    session.changed(&["passes/other.frag"]);
    // A file that cannot be read, or that is not written yet, is no pass that was removed.
    for bytes in [&b"//@pass show\n\xff"[..], b""] {
        std::fs::write(session.tree.path("passes/show.frag"), bytes).unwrap();
        failed(&session.changed(&["passes/show.frag"]));
        assert_same(&before, &session.render(), "an unreadable pass");
    }
    // A cycle names its passes.
    let reads = |name: &str, other: &str| {
        pass(name, &format!("uniform sampler2D {other};"), &format!("color = texture({other}, uv);"))
    };
    session.tree.write("passes/show.frag", &reads("show", "glow"));
    session.tree.write("passes/glow.frag", &reads("glow", "show"));
    let told: Vec<Diagnostic> = failed(&session.changed(&["passes/show.frag", "passes/glow.frag"])).to_vec();
    let text = lines(&told).join("\n");
    assert!(text.contains("each of these passes waits for the next: glow -> show -> glow"), "{text}");
    assert_same(&before, &session.render(), "a cycle");
}

#[test]
fn a_file_in_passes_that_declares_none_is_told() {
    let mut session = sphere(&[]);
    let text = pass("forgotten to=picture", "", "color = vec4(1.0);");
    let (_, without) = text.split_once('\n').unwrap();
    ready(&session.save("passes/forgotten.frag", without));
    let warnings = lines(&session.headless.shaders().warnings);
    let expected = "forgotten.frag: warning: nothing draws this file, since no line of it says //@pass";
    assert!(warnings.iter().any(|line| line.contains(expected)), "{warnings:#?}");
    ready(&session.save("passes/forgotten.frag", &text));
    assert_eq!(lines(&session.headless.shaders().warnings), [""; 0]);
    assert_eq!(center(&session.render()), [1.0; 4]);
    ready(&session.save("passes/forgotten.frag", without));
    remove(&mut session, "passes/forgotten.frag");
    assert_eq!(lines(&session.headless.shaders().warnings), [""; 0]);
}

/// The mode of a pass shows what it draws: an image as it is, whatever it has in alpha, and a picture as a picture.
#[test]
fn the_mode_of_a_pass_shows_what_it_draws() {
    let mut session = sphere(&["view.background=#000000"]);
    let sees = |annotation: &str| pass(annotation, "uniform sampler2D picture;", "color = vec4(0.25, 0.5, 1.0, 0.0);");
    let pixel =
        |capture: &Capture| [0, 1, 2].map(|c| capture.rgba8[((SIZE.1 / 2 * SIZE.0 + SIZE.0 / 2) * 4 + c) as usize]);
    let encoded = [0.25, 0.5, 1.0].map(|value| (srgb(value) * 255.0).round() as u8);
    ready(&session.save("passes/sees.frag", &sees("sees size=1/2")));
    assert_eq!(pixel(&session.mode("pass:sees")), encoded);
    // After the tone map, a pass draws what the display shows.
    ready(&session.save("passes/sees.frag", &sees("sees after=tonemap")));
    assert_eq!(pixel(&session.mode("pass:sees")), [64, 128, 255]);
    ready(&session.save("passes/sees.frag", &sees("sees to=picture after=tonemap")));
    assert_eq!(pixel(&session.mode("pass:sees")), [64, 128, 255]);
    let final_picture = session.mode("final");
    ready(&session.save("passes/later.frag", &pass("later to=picture after=sees", "", "color = vec4(0.0);")));
    assert_same(&final_picture, &session.mode("pass:sees"), "the picture before later passes");
    assert_eq!(pixel(&session.mode("final")), [0, 0, 0]);
}

#[test]
fn a_pass_that_is_off_or_unread_costs_nothing() {
    let mut session = sphere(&[]);
    let plain = session.render();
    let names = |session: &Session| -> Vec<String> {
        session.headless.pass_times().iter().map(|pass| pass.name.clone()).collect()
    };
    let before = names(&session);
    let text = pass("unread size=1/2", "uniform sampler2D picture;", "color = texture(picture, uv);");
    ready(&session.save("passes/unread.frag", &text));
    let uniforms = "uniform sampler2D picture;\nuniform sampler2D unread;";
    let off = pass("reader to=picture off", uniforms, "color = texture(picture, uv) + texture(unread, uv);");
    ready(&session.save("passes/reader.frag", &off));
    assert_same(&plain, &session.render(), "off");
    assert_eq!(names(&session), before);
    session.set("passes.reader=true");
    assert_differ(&plain, &session.render(), "on");
    if !before.is_empty() {
        let now = names(&session);
        assert!(now.contains(&"unread".to_owned()) && now.contains(&"reader".to_owned()), "{now:?}");
    }
}

#[test]
fn a_member_that_nothing_sets_is_warned_about() {
    let mut session = sphere(&[]);
    let block = "uniform Fog {\n    float density; //@ui \"Density\" 0..1 = 0.5\n    vec3 haze;\n};\nuniform sampler2D picture;";
    ready(&session.save("passes/fog.frag", &pass("fog to=picture", block, "color = vec4(haze, density);")));
    let warnings = lines(&session.headless.shaders().warnings);
    assert_eq!(warnings.len(), 1, "{warnings:#?}");
    assert!(
        warnings[0].contains("fog.frag:6:10: warning: `haze` in a uniform block of the pass `fog` has no //@ui"),
        "{warnings:#?}"
    );
}

/// `render` and a window compile what is off later, so it must know what is off.
#[test]
fn a_pass_that_its_constant_switches_on_is_in_the_first_picture() {
    let folder = tempfile::tempdir().unwrap();
    let tree = folder.path().join("tree");
    let picture = |name: &str| {
        let args = ["render", "sphere-grid", "--shaders", "tree", "--env", "none", "--size", "64x48", "--out", name];
        crate::support::process::run(folder.path(), &args).expect(0, &[]);
        crate::support::open_image(&folder.path().join(name))
    };
    crate::support::process::run(folder.path(), &["new", "tree"]).expect(0, &[]);
    let plain = picture("plain.png");
    let tint = |default: &str| {
        let constant = format!(
            "const uint NONE = 0u;\nconst uint SOME = 1u;\n\
             layout(constant_id = USER_CONSTANTS + 40) const uint TINT = {default}; //@ui 0..1\n\
             uniform sampler2D picture;"
        );
        let text = pass("tint to=picture when=TINT", &constant, "color = texture(picture, uv) * vec4(1, 0, 0, 1);");
        std::fs::write(tree.join("passes/tint.frag"), text).unwrap();
    };
    for (default, is_on) in [("0u", false), ("1u", true), ("NONE", false), ("SOME", true)] {
        tint(default);
        assert_eq!(picture("out.png") != plain, is_on, "{default}");
    }
}

#[test]
fn what_ships_is_off_and_changes_what_it_says() {
    let mut session = Session::new(crate::support::model("shader-ball"), settings(&[]));
    let plain = session.render();
    let shipped: Vec<_> = session.headless.shaders().graph.passes.clone();
    for pass in shipped.iter().filter(|pass| pass.desc.to_picture() && !pass.desc.is_drawn_with_model()) {
        assert!(!pass.desc.on || pass.desc.when.is_some(), "{} is on", pass.name());
        let switch = pass.desc.when.clone().unwrap_or_else(|| format!("passes.{}", pass.name()));
        session.set(&format!("{switch}=true"));
        assert_differ(&plain, &session.render(), pass.name());
        session.set(&format!("{switch}=false"));
    }
    assert!(shipped.len() >= 4);
    assert_same(&plain, &session.render(), "all off again");
    passes_check(&session);
}
