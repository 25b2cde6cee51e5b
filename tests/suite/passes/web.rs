//! Toys written for a browser, with what WebGL allows and Vulkan's GLSL does not: `specula FILE.glsl`.

use std::fs;
use std::path::Path;

use specula::headless::Headless;
use specula::settings::Settings;
use specula::shader::Source;

use crate::support::process::{Finished, Running, run, specula};
use crate::support::{compiler, gpu};

/// Writes the files and renders the first of them, 32 x 16 pixels.
fn render(folder: &Path, files: &[(&str, &str)], options: &[&str]) -> Finished {
    for (name, text) in files {
        fs::create_dir_all(folder.join(name).parent().unwrap()).unwrap();
        fs::write(folder.join(name), text).unwrap();
    }
    let common = ["render", files[0].0, "--size", "32x16", "--validate", "--out", "shot.png"];
    run(folder, &[&common, options].concat())
}

fn pixel(folder: &Path, x: u32, y: u32) -> [u8; 4] {
    image::open(folder.join("shot.png")).unwrap().to_rgba8().get_pixel(x, y).0
}

const GREEN: [u8; 4] = [0, 255, 0, 255];

/// Fails unless the first file draws green.
#[track_caller]
fn is_green(files: &[(&str, &str)]) {
    let folder = tempfile::tempdir().unwrap();
    render(folder.path(), files, &[]).expect(0, &[]);
    assert_eq!(pixel(folder.path(), 9, 9), GREEN, "{files:#?}");
}

/// Fails unless the file draws this color.
#[track_caller]
fn is_drawn(text: &str, options: &[&str], color: [u8; 4]) {
    let folder = tempfile::tempdir().unwrap();
    render(folder.path(), &[("toy.frag", text)], options).expect(0, &[]);
    assert_eq!(pixel(folder.path(), 9, 9), color, "{text}");
}

#[test]
fn names_and_macros_of_webgl_work() {
    is_green(&[(
        "toy.glsl",
        "#version 300 es\n#extension GL_OES_standard_derivatives : enable\n#ifdef GL_ES\nprecision highp float;\n#define ONE(x) 1.0 x\n\
         #else\n#error not WebGL\n#endif\nstruct S { float sample; };\nfloat fma(float a, float b, float c) { return a * b + c; }\n\
         float min3(float a, float b, float c) { return min(a, min(b, c)); }\n\
         lowp float buffer(mediump float filter) { return filter; }\n\
         void mainImage(out highp vec4 c, in mediump vec2 p) {\n    S s = S(fma(1.0, 0.5, 0.5));\n    \
         c = vec4(iGlobalTime, min3(s.sample, ONE(), buffer(2.0)), 0.0, 1.0) + 0.0 * texture2D(iChannel0, p);\n}\n",
    )]);
    is_green(&[
        (
            "a.frag",
            "#include \"lib/a.glsl\"\n#include \"lib/a.glsl\"\nvoid main() { gl_FragColor = vec4(0.0, one(), 0.0, 1.0); }\n",
        ),
        ("lib/a.glsl", "#pragma once\nfloat one() { return 1.0; }\n"),
    ]);
    // Names of the stage, words of later GLSL, and macros for what the stage replaces.
    is_green(&[(
        "toy.frag",
        "precision mediump float;\n#define U uniform\n#define MAIN void main()\nU vec2 u_resolution;\nstruct Pass { float a; };\nvec3 toy;\n\
         float toy_begin(float uint) { return uint; }\nvec4 texture(vec2 p) { return vec4(0.0, p.y, 0.0, 1.0); }\n\
         MAIN {\n    float case = 0.5, layout = 0.5; Pass own = Pass(case);\n    toy = vec3(0.0, toy_begin(own.a) + layout, 0.0);\n    \
         gl_FragColor = texture(vec2(u_resolution.x / u_resolution.x, toy.y));\n}\n",
    )]);
    // Functions of GLSL ES 1.00 are types in Vulkan. A file may define them, here or in the file that all share, or overload them.
    is_green(&[
        (
            "toy.glsl",
            "vec4 textureCube(in vec3 d) { return vec4(0.0, d.y, 0.0, 1.0); }\n#define READ texture2D\n\
             void mainImage(out vec4 c, in vec2 p) { c = READ(iChannel0, p) + textureCube(vec3(0.5)); }\n",
        ),
        (
            "common.glsl",
            "vec4 texture2D(sampler2D s, vec2 p) { return vec4(0.0, 0.5, 0.0, 0.0) + 0.0 * texture(s, p); }\n",
        ),
    ]);
    is_green(&[(
        "toy.frag",
        "uniform sampler2D u_tex0;\nvec4 texture2D(sampler2D s, vec2 p, vec2 size) { return texture2D(s, p / size) * 0.0; }\n\
         void main() { gl_FragColor = vec4(0, 1, 0, 1) + texture2D(u_tex0, gl_FragCoord.xy, vec2(2.0)); }\n",
    )]);
    // A channel without a file may be read as a cube map.
    is_green(&[(
        "toy.glsl",
        "void mainImage(out vec4 c, in vec2 p) { c = vec4(0, 1, 0, 1) + 0.0 * texture(iChannel1, vec3(p, 1.0)); }\n",
    )]);
}

#[test]
fn parts_of_a_file_are_the_buffers_of_glsl_viewer() {
    // The first part counts frames in red, the second reads the first of this frame.
    is_drawn(
        "uniform sampler2D u_doubleBuffer0, u_buffer1;\nuniform vec2 u_resolution;\nvoid main() {\n    \
         vec2 st = gl_FragCoord.xy / u_resolution;\n#if defined(DOUBLE_BUFFER_0)\n    \
         gl_FragData[0] = texture2D(u_doubleBuffer0, st) + vec4(0.2, 0.0, 0.0, 0.0);\n#elif defined(BUFFER_1)\n    \
         gl_FragColor = vec4(texture2D(u_doubleBuffer0, st).r, st.y, 0.0, 1.0);\n#else\n    \
         gl_FragColor = texture2D(u_buffer1, st);\n#endif\n}\n",
        &["--frames", "3"],
        // 3 * 0.2, and the middle of row 9 of 16 from above.
        [153, 104, 0, 255],
    );
}

#[test]
fn a_file_that_is_no_picture_is_told_so() {
    for (text, expected) in [
        ("vec2 mainSound(int samp, float time) { return vec2(0.0); }\n", "Specula plays no sound"),
        (
            "void mainCubemap(out vec4 c, in vec2 p, in vec3 o, in vec3 d) { c = vec4(d, 1.0); }\n",
            "Specula draws no cube maps",
        ),
        ("void main() { gl_Position = vec4(0.0); }\n", "this is a vertex shader"),
        (
            "vec4 f(samplerCube c) { return texture(c, vec3(1.0)); }\nvoid mainImage(out vec4 c, in vec2 p) { c = f(iChannel1); }\n",
            "`#iChannel1::Type \"CubeMap\"`",
        ),
    ] {
        let folder = tempfile::tempdir().unwrap();
        render(folder.path(), &[("toy.frag", text)], &[]).expect(1, &["error: ", expected]);
    }
}

#[test]
fn declared_uniforms_have_their_values() {
    is_green(&[(
        "toy.glsl",
        "uniform vec3 iResolution;\nuniform float iTime, time;\nuniform vec2 mouse, resolution;\nuniform sampler2D iChannel0;\n\
         out vec4 fragColor;\nvoid mainImage(out vec4 c, in vec2 p) {\n    \
         c = vec4(time, resolution == iResolution.xy && mouse == vec2(0.0), iTime, 1.0); }\n\
         void main() { mainImage(fragColor, gl_FragCoord.xy); }\n",
    )]);
    is_green(&[(
        "toy.frag",
        "uniform sampler2D u_tex0;\nuniform vec2 u_tex0Resolution;\nvarying vec2 vUv;\nuniform mat4 camera;\n\
         void main() { vec4 noise = texture2D(u_tex0, vUv);\n    \
         gl_FragColor = vec4(camera[0][0], u_tex0Resolution == vec2(256.0) && noise != vec4(0.0), 0.0, 1.0); }\n",
    )]);
    let folder = tempfile::tempdir().unwrap();
    let image =
        "void mainImage(out vec4 c, in vec2 p) { c = texelFetch(iChannel0, ivec2(p), 0) + vec4(0, gain, 0, 0); }\n";
    let files = [
        ("toy.glsl", image),
        ("common.glsl", "uniform float gain;\nuniform vec3 tint; //@ui \"Tint\" color = 0 0 1\n"),
        ("buffer_a.glsl", "void mainImage(out vec4 c, in vec2 p) { c = vec4(tint, 1.0) * step(gain, 0.5); }\n"),
    ];
    render(folder.path(), &files, &[]).expect(0, &[]);
    assert_eq!(pixel(folder.path(), 3, 3), [0, 0, 255, 255]);
    render(folder.path(), &files, &["--set", "gain=1"]).expect(0, &[]);
    assert_eq!(pixel(folder.path(), 3, 3), GREEN);
}

/// Each of the texts is a name of a playground that the file has for itself.
#[test]
fn names_of_playgrounds_may_be_a_files_own() {
    for head in [
        "uniform float time;\n#define iTime time\n#define iGlobalTime time\n#define VALUE iTime * iGlobalTime\n",
        "uniform float time;\nfloat iTime = 0.5;\nconst vec4 iMouse = vec4(0.5);\n#define VALUE time * (iTime + iMouse.x)\n",
        "uniform vec2 resolution;\nvec3 iResolution = vec3(0.0);\n#define VALUE step(3.0, resolution.x) + iResolution.y\n",
        "uniform vec2 mouse, resolution;\n#define iMouse (mouse * resolution)\n#define iResolution resolution\n\
         #define VALUE 1.0 + iMouse.x + 0.0 / iResolution.x\n",
        "uniform float u_time;\nuniform vec2 u_resolution;\nstruct S { vec2 u_mouse; };\n\
         float f(float u_time) { vec2 u_resolution = vec2(u_time); return S(u_resolution).u_mouse.y; }\n\
         #define VALUE f(1.0) * step(3.0, u_resolution.x) * u_time\n",
        "float u_time() { return 1.0; }\n#define u_resolution iResolution.xy\n#define v_texcoord 1.0\n\
         #define VALUE u_time() * v_texcoord * step(3.0, u_resolution.x)\n",
        "uniform vec3 u_mouse, u_resolution;\n#define VALUE u_mouse.z + u_resolution.z\n",
        "#define texture2D(a, b) texture(a, b)\n#define lowp mediump\nlowp float a;\n#define VALUE 1.0 + a\n",
        "#if __VERSION__ != 100 || !defined HW_PERFORMANCE\n#error\n#endif\n#if 0\n3d 0x 5\"\n#endif\n\
         #define VALUE gl_FrontFacing ? 1.0 : 0.0\n",
    ] {
        is_drawn(
            &format!("{head}void main() {{ gl_FragColor = vec4(0.0, VALUE, 0.0, 1.0); }}\n"),
            &["--time", "1"],
            GREEN,
        );
    }
}

#[test]
fn a_sampler_without_an_image_is_black() {
    let folder = tempfile::tempdir().unwrap();
    let text = "uniform sampler2D photo, unused;\nvoid main() { gl_FragColor = vec4(0, 1, 0, 0) + texture2D(photo, gl_FragCoord.xy); }\n";
    render(folder.path(), &[("toy.frag", text)], &[]).expect(
        0,
        &["toy.frag:1:19: warning: nothing gives the image `photo`", "`//@texture photo \"image.png\"`", "`unused`"],
    );
    assert_eq!(pixel(folder.path(), 9, 9), GREEN);
    // The name is the author's, although it is a function of later GLSL.
    let text = "uniform sampler2D texture;\nuniform samplerCube sky;\nuniform sampler3D fog;\nvoid main() {\n    gl_FragColor = vec4(0, 1, 0, 0) + \
                texture2D(texture, vec2(0.0)) + textureCube(sky, vec3(1.0)) + textureLod(fog, vec3(0.0), 0.0);\n}\n";
    let texts = [("toy.frag", text)];
    render(folder.path(), &texts, &[])
        .expect(0, &["1:19: warning: nothing gives the image `texture`", "`sky`", "`fog`"]);
    assert_eq!(pixel(folder.path(), 9, 9), GREEN);
    let text = "uniform sampler2D photos[3], other;\nvoid main() {\n    gl_FragColor = vec4(0, 1, 0, 1);\n    for (int i = 0; i < 3; i++) \
                gl_FragColor += texture2D(photos[i], vec2(0.0)) + texture2D(other, vec2(0.0));\n}\n";
    let told = ["1:19: warning: nothing gives the image `photos`", "`other`"];
    render(folder.path(), &[("toy.frag", text)], &[]).expect(0, &told);
    assert_eq!(pixel(folder.path(), 9, 9), GREEN);
}

#[test]
fn variables_that_are_not_set_start_at_0() {
    is_green(&[(
        "toy.glsl",
        "float unset;\nvoid add(out float a, inout float b) { a += 0.5; b += a; }\nvoid mainImage(out vec4 O, vec2 U) {\n    \
         float i, d, sum; vec3 p; vec2 q[3];\n    for (O *= i; i++ < 4.0; sum += d) { float own; own += 0.125; d = own; \
         for (float j; j++ < 2.0;) O.b += 0.0; }\n    float a; add(a, sum); add(a, unset);\n    \
         O.r += p.x + q[int(U.x) % 3].y; O.g += sum == 1.0 && unset == 0.5 ? 1.0 : 0.0; O.a = 1.0;\n}\n",
    )]);
}

#[test]
fn options_of_channels_act() {
    let folder = tempfile::tempdir().unwrap();
    let mut image = image::RgbImage::new(2, 1);
    image.put_pixel(1, 0, image::Rgb([255; 3]));
    image.save(folder.path().join("q.png")).unwrap();
    let shown = |options: &str| {
        let text = format!(
            "#iChannel0 \"q.png\"\n{options}void mainImage(out vec4 c, in vec2 p) {{ c = texture(iChannel0, vec2(p.x / 16.0, 0.5)); }}\n"
        );
        render(folder.path(), &[("toy.glsl", &text)], &[]).expect(0, &[]);
        [6, 9, 22, 30].map(|x| pixel(folder.path(), x, 3)[0])
    };
    let blended = shown("");
    assert!(blended[0] > 20 && blended[0] < 235, "{blended:?}");
    let nearest = "#iChannel0::MinFilter \"Nearest\"\n#iChannel0::MagFilter \"Nearest\"\n";
    assert_eq!(shown(nearest), [0, 255, 0, 255]);
    assert_eq!(shown(&format!("{nearest}#iChannel0::WrapMode \"Clamp\"\n")), [0, 255, 255, 255]);
    assert_eq!(shown(&format!("{nearest}#iChannel0::WrapMode \"Mirror\"\n")), [0, 255, 255, 0]);
}

/// The file adds an eighth in each frame, and the picture has the first row of GLSL below.
#[test]
fn a_file_reads_its_own_image() {
    let body = "void mainImage(out vec4 c, in vec2 p) { vec4 old = texelFetch(SELF, ivec2(p), 0);\n\
        c = p.y < 8.0 ? vec4(old.r + 0.125) : vec4(0.0); }\n";
    let folder = tempfile::tempdir().unwrap();
    for head in
        ["#iChannel0 \"self\"\n#define SELF iChannel0\n", "uniform sampler2D backbuffer;\n#define SELF backbuffer\n"]
    {
        render(folder.path(), &[("toy.glsl", &format!("{head}{body}"))], &["--frames", "4"]).expect(0, &[]);
        assert_eq!([pixel(folder.path(), 5, 14), pixel(folder.path(), 5, 1)], [[128, 128, 128, 255], [0, 0, 0, 255]]);
    }
}

#[test]
fn a_probe_of_a_toy_gives_its_colors() {
    let folder = tempfile::tempdir().unwrap();
    let image = "void mainImage(out vec4 c, in vec2 p) { c = 0.5 * texelFetch(iChannel0, ivec2(p), 0); }\n";
    let buffer = "void mainImage(out vec4 c, in vec2 p) { c = vec4(2.0, p.y, -1.0, 1.0); }\n";
    render(folder.path(), &[("toy.glsl", image), ("buffer_a.glsl", buffer)], &[]).expect(0, &[]);
    let probe = ["probe", "--shaders", "toy.glsl", "--size", "32x16", "--at", "3,14", "--json"];
    let found = run(folder.path(), &probe);
    let found = found.expect(0, &[]).json();
    assert_eq!(found["hit"], false, "{found}");
    // The view of a buffer has its rows in the order of the picture: the pixel is the second of 16 from below.
    assert_eq!(found["modes"]["pass:buffer_a"].as_array().unwrap()[..3], [2.0, 1.5, -1.0], "{found}");
    // What is displayed has eight bits.
    let shown = found["modes"]["pass:image"].as_array().unwrap();
    let is_near = |at: usize, value: f64| (shown[at].as_f64().unwrap() - value).abs() < 0.005;
    assert!(is_near(0, 1.0) && is_near(1, 0.75), "{found}");
    let text = run(folder.path(), &probe[..7]);
    assert!(text.stdout.contains("pass:image") && !text.stdout.contains("does not cover"), "{text:#?}");
}

#[test]
fn a_loop_of_too_many_rounds_is_a_warning_and_a_picture() {
    let folder = tempfile::tempdir().unwrap();
    let text = "void mainImage(out vec4 c, in vec2 p) {\n    float a = 0.0;\n    if (int(p.x) == 31)\n        \
        for (int y = 0; y < 5000; y++)\n            for (int x = 0; x < 200; x++) a += 1.0;\n    c = vec4(0.0, 1.0, 0.0 * a, 1.0);\n}\n";
    let said = render(folder.path(), &[("toy.glsl", text)], &[]);
    said.expect(0, &["toy.glsl:4", "warning: this loop takes more than ", "iterations"]);
    assert!(!said.stderr.contains("did not end"), "{said:#?}");
    assert_eq!(pixel(folder.path(), 3, 3), GREEN);
}

#[test]
fn a_buffer_that_appears_is_drawn_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let save = |name: &str, text: &str| {
        fs::write(path("new"), text).unwrap();
        fs::rename(path("new"), path(name)).unwrap();
    };
    let image = "void mainImage(out vec4 c, in vec2 p) { c = vec4(texelFetch(iChannel0, ivec2(0), 0).rgb, 1.0); }\n";
    save("toy.glsl", image);
    let options = ["render", "toy.glsl", "--size", "32x16", "--watch", "--events", "json", "--out", "shot.png"];
    let mut running = Running::start(specula(folder.path()).args(options));
    running.event("completed");
    save("buffer_a.glsl", "void mainImage(out vec4 c, in vec2 p) { c = vec4(0, 1, 0, 1); }\n");
    running.reload(true);
    assert_eq!(pixel(folder.path(), 3, 3), GREEN);
    fs::write(path("blur.glsl"), "void mainImage(out vec4 c, in vec2 p) { c = vec4(1, 0, 0, 1); }\n").unwrap();
    save("toy.glsl", &format!("#iChannel0 \"blur.glsl\"\n{image}"));
    running.reload(true);
    assert_eq!(pixel(folder.path(), 3, 3), [255, 0, 0, 255]);
    let stderr = running.stderr();
    assert!(stderr.contains("buffer_a.glsl") && !stderr.contains("removed"), "{stderr}");
}

/// The buffer draws in the first two frames only. What a larger picture adds is 0.
#[test]
fn buffers_survive_a_resize() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write("toy.glsl", "void mainImage(out vec4 c, in vec2 p) { c = texelFetch(iChannel0, ivec2(p), 0); }\n");
    write(
        "buffer_a.glsl",
        "#iChannel0 \"self\"\nvoid mainImage(out vec4 c, in vec2 p) {\n    \
         c = iFrame < 2 ? vec4(0, p.y < 1.0, 1.0, 1.0) : texelFetch(iChannel0, ivec2(p), 0); }\n",
    );
    let source = Source::find(&folder.path().join("toy.glsl")).unwrap();
    let model = crate::support::model("shader-ball");
    let settings = Settings::default();
    let (mut headless, _) = Headless::new(gpu(), compiler(), source, model, settings, (16, 8)).unwrap();
    headless.render().unwrap();
    for _ in 0..3 {
        headless.render_next().unwrap();
    }
    for (size, filled) in [((24, 12), (16, 8)), ((8, 4), (8, 4)), ((16, 6), (8, 4))] {
        headless.set_size(size).unwrap();
        let capture = headless.render_next().unwrap();
        // The first row of the buffer is the lowest of the picture.
        let color = |x: u32, up: u32| {
            let at = ((size.1 - 1 - up) * size.0 + x) as usize * 4;
            [capture.rgba8[at], capture.rgba8[at + 1], capture.rgba8[at + 2]]
        };
        assert_eq!([color(0, 0), color(filled.0 - 1, filled.1 - 1)], [[0, 255, 255], [0, 0, 255]], "{size:?}");
        assert_eq!(color(size.0 - 1, size.1 - 1) == [0, 0, 0], size != filled, "{size:?}");
    }
    crate::support::assert_validated();
}
