//! Single files of other playgrounds: `specula FILE.glsl`.

use std::fs;
use std::path::Path;

use crate::support::process::{Finished, Running, run, specula};

/// Writes the files and renders the first of them, 64 x 32 pixels.
fn render(folder: &Path, files: &[(&str, &str)], options: &[&str]) -> Finished {
    for (name, text) in files {
        fs::write(folder.join(name), text).unwrap();
    }
    let common = ["render", files[0].0, "--size", "64x32", "--validate", "--out", "shot.png"];
    run(folder, &[&common, options].concat())
}

/// The pixel of the picture in `folder`, from its upper left corner.
fn pixel(folder: &Path, x: u32, y: u32) -> [u8; 4] {
    image::open(folder.join("shot.png")).unwrap().to_rgba8().get_pixel(x, y).0
}

/// Names that Specula's own shaders have, too, and a picture that is red below and green on the right.
const IMAGE: &str = "struct Light { vec3 c; };\nstruct Material { Light l; };\nconst float PI = 3.0;\nMaterial material;\n\
    vec3 color(vec2 uv) { return vec3(uv.y < 0.5 ? 1.0 : 0.0, uv.x < 0.5 ? 0.0 : 1.0, iTime); }\n\
    void mainImage( out vec4 fragColor, in vec2 fragCoord )\n{\n    \
    material.l = Light(color(fragCoord / iResolution.xy));\n    fragColor = vec4(material.l.c, 0.0);\n}\n";

/// A slider is declared elsewhere, but its mistake is the author's.
#[test]
fn a_mistake_in_a_slider_is_told_at_its_line() {
    let folder = tempfile::tempdir().unwrap();
    let text = "// A toy.\nuniform float a; uniform float speed;   //@ui 0..4 \"Speed\" = 1\n\
                void mainImage(out vec4 c, in vec2 p) { c = vec4(speed * a); }\n";
    render(folder.path(), &[("toy.glsl", text)], &[]).expect(
        1,
        &[
            "toy.glsl:2:52: error: expected the label before all else, found `\"Speed\"` here",
            "2 | uniform float a; uniform float speed;   //@ui 0..4 \"Speed\" = 1",
            "help: the label comes first and the default last: `//@ui \"Speed\" 0..4 = 1`",
        ],
    );
    let text = "void mainImage(out vec4 c, in vec2 p) { c = texture(iChannel4, p); }\n";
    render(folder.path(), &[("toy.glsl", text)], &[])
        .expect(1, &["'iChannel4'", "help: there are iChannel0 to iChannel3"]);
}

#[test]
fn a_shadertoy_runs_as_it_is() {
    let folder = tempfile::tempdir().unwrap();
    render(folder.path(), &[("toy.glsl", IMAGE)], &[]).expect(0, &[]);
    assert_eq!(pixel(folder.path(), 0, 31), [255, 0, 0, 255]);
    assert_eq!(pixel(folder.path(), 63, 0), [0, 255, 0, 255]);
    render(folder.path(), &[("toy.glsl", IMAGE)], &["--time", "1"]).expect(0, &[]);
    assert_eq!(pixel(folder.path(), 63, 0), [0, 255, 255, 255]);
    run(folder.path(), &["check", "--shaders", "toy.glsl"]).expect(0, &[]);
}

#[test]
fn a_shader_of_glsl_viewer_runs_as_it_is() {
    let old = "#ifdef GL_ES\nprecision mediump float;\n#endif\nuniform vec2 u_resolution;\nuniform float u_time;\n\
        varying vec2 v_texcoord;\nvoid main() {\n    vec2 st = gl_FragCoord.xy / u_resolution;\n    \
        gl_FragColor = vec4(step(0.5, st.y), step(0.5, v_texcoord.x), u_time, 1.0);\n}\n";
    let new = "#version 330\nuniform vec2 u_resolution;\nuniform float u_time;\nin vec2 v_texcoord;\nout vec4 shown;\n\
        void main() { shown = vec4(step(0.5, gl_FragCoord.y / u_resolution.y), step(0.5, v_texcoord.x), u_time, 1.0); }\n";
    for text in [old, new] {
        let folder = tempfile::tempdir().unwrap();
        render(folder.path(), &[("a.frag", text)], &["--time", "1"]).expect(0, &[]);
        assert_eq!(pixel(folder.path(), 0, 31), [0, 0, 255, 255]);
        assert_eq!(pixel(folder.path(), 63, 0), [255, 255, 255, 255]);
    }
}

/// Buffer A adds 1/8 in each frame, in a file that all share; the image shows it in the lower half.
#[test]
fn buffers_keep_their_images() {
    let folder = tempfile::tempdir().unwrap();
    let files = [
        ("count.glsl", "void mainImage(out vec4 c, in vec2 p) { c = texture(iChannel0, p / iResolution.xy); }\n"),
        ("common.glsl", "const float STEP = 0.125;\n"),
        (
            "buffer_a.glsl",
            "void mainImage(out vec4 c, in vec2 p) { float old = texelFetch(iChannel0, ivec2(p), 0).r;\n\
             c = p.y < 16.0 ? vec4(old + STEP) : vec4(0.0); }\n",
        ),
    ];
    render(folder.path(), &files, &["--frames", "4"]).expect(0, &[]);
    assert_eq!(pixel(folder.path(), 5, 30), [128, 128, 128, 255]);
    assert_eq!(pixel(folder.path(), 5, 1), [0, 0, 0, 255]);
}

#[test]
fn channels_read_images_and_other_files() {
    let folder = tempfile::tempdir().unwrap();
    let mut spots = image::RgbImage::new(2, 2);
    spots.put_pixel(0, 1, image::Rgb([255, 0, 0]));
    spots.save(folder.path().join("spots.png")).unwrap();
    // The image's first row is at the bottom, as there.
    let files = [
        (
            "a.glsl",
            "#iChannel2 \"file://half.glsl\"\n#iChannel2::WrapMode \"Clamp\"\nvoid mainImage(out vec4 c, in vec2 p) {\n\
            c = texelFetch(iChannel2, ivec2(p), 0) + vec4(0.0, iChannelResolution[2].x / 64.0, 0.0, 0.0); }\n",
        ),
        (
            "half.glsl",
            "#iChannel0 \"spots.png\"\nvoid mainImage(out vec4 c, in vec2 p) {\n\
            c = textureLod(iChannel0, p / iResolution.xy, 0.0); }\n",
        ),
    ];
    render(folder.path(), &files, &[]).expect(0, &[]);
    let [low, high] = [24, 7].map(|y| pixel(folder.path(), 16, y));
    assert!(low[0] > 200 && high[0] < 50 && low[1] == 255 && high[1] == 255, "{low:?} {high:?}");
    // A channel without a file is noise.
    let noise = "void mainImage(out vec4 c, in vec2 p) { c = textureLod(iChannel3, p / 64.0, 0.0); }\n";
    render(folder.path(), &[("noise.glsl", noise)], &[]).expect(0, &[]);
    let found: std::collections::BTreeSet<_> = (0..20).map(|x| pixel(folder.path(), x, 3)).collect();
    assert!(found.len() > 15, "{found:?}");
}

/// Column x of the picture shows key x, in three bands: down, pressed in this frame, toggled.
const KEYBOARD: &str = "#iChannel1 \"keyboard\"\nvoid mainImage(out vec4 c, in vec2 p) {\n    \
    int row = int(p.y / 11.0);\n    float texel = texelFetch(iChannel1, ivec2(p.x + 32.0, row), 0).x;\n    \
    c = vec4(texel, texture(iChannel1, vec2((p.x + 32.0) / 256.0, (float(row) + 0.5) / 3.0)).x, \
    iChannelResolution[1].y / 255.0, 1.0);\n}\n";

#[test]
fn the_keyboard_is_a_channel() {
    for name in ["keyboard", "file://keyboard"] {
        let folder = tempfile::tempdir().unwrap();
        let files = [("keys.glsl", KEYBOARD.replace("keyboard", name))];
        let files = files.each_ref().map(|(name, text)| (*name, text.as_str()));
        let down = |options: &[&str]| {
            render(folder.path(), &files, options).expect(0, &[]);
            // Space (32), the left arrow (37) and A (65), from the lowest band up.
            [0, 5, 33].map(|x| [28, 16, 4].map(|y| pixel(folder.path(), x, y)))
        };
        let (on, off) = ([255, 255, 3, 255], [0, 0, 3, 255]);
        assert_eq!(down(&[]), [[off; 3]; 3]);
        assert_eq!(down(&["--keys", "A, Space"]), [[on; 3], [off; 3], [on; 3]]);
        assert_eq!(down(&["--keys", "Left", "--frames", "2"]), [[off; 3], [on, off, on], [off; 3]]);
    }
}

#[test]
fn keys_are_read_by_functions() {
    let folder = tempfile::tempdir().unwrap();
    let text = "void mainImage(out vec4 c, in vec2 p) {\n    c = vec4(isKeyDown(Key_A), isKeyPressed(Key_A), \
        isKeyToggled(Key_LeftArrow), 1.0);\n}\n";
    let toy = format!("#iKeyboard\n{text}");
    render(folder.path(), &[("t.glsl", &toy)], &["--keys", "a,left", "--frames", "2"]).expect(0, &[]);
    assert_eq!(pixel(folder.path(), 3, 3), [255, 0, 255, 255]);
    render(folder.path(), &[("t.glsl", &toy)], &["--keys", "A"]).expect(0, &[]);
    assert_eq!(pixel(folder.path(), 3, 3), [255, 255, 0, 255]);
    // The line may stand in the file that all share, and errors keep their lines.
    let common = ("common.glsl", "#iKeyboard\nconst float ONE = 1.0;\n");
    let wrong = text.replacen("Key_A)", "Key_Ae)", 1);
    render(folder.path(), &[("t.glsl", text), common], &["--keys", "A"]).expect(0, &[]);
    render(folder.path(), &[("t.glsl", &wrong), common], &[]).expect(1, &["t.glsl:2:", "'Key_Ae'"]);
    render(folder.path(), &[("t.glsl", text), ("common.glsl", "")], &[]).expect(1, &["t.glsl:2:"]);
    run(folder.path(), &["render", "t.glsl", "--keys", "A,Spcae"]).expect(2, &["`Spcae`. Did you mean `Space`?"]);
}

#[test]
fn the_date_is_that_of_the_command_line() {
    let folder = tempfile::tempdir().unwrap();
    let text = "void mainImage(out vec4 c, in vec2 p) {\n    \
        c = vec4(iDate.x - 2000.0, 10.0 * iDate.y + iDate.z, iDate.w / 3600.0, 255.0) / 255.0;\n}\n";
    let shown = |options: &[&str]| {
        render(folder.path(), &[("t.glsl", text)], options).expect(0, &[]);
        pixel(folder.path(), 0, 0)
    };
    assert_eq!(shown(&[]), [0, 1, 0, 255]);
    assert_eq!(shown(&["--time", "7200"]), [0, 1, 2, 255]);
    assert_eq!(shown(&["--date", "2026-11-23T16:00:00"]), [26, 123, 16, 255]);
    assert_eq!(shown(&["--date", "2026-12-31T23:00", "--time", "7200"]), [27, 1, 1, 255]);
    run(folder.path(), &["render", "t.glsl", "--date", "2026-02-29"]).expect(2, &["--date", "2026-11-23T16:00:00"]);
}

#[test]
fn channels_read_cube_maps_and_volumes() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("maps")).unwrap();
    // +X has a red row on top, which is where y is up.
    for face in ["nx", "py", "ny", "pz", "nz", "px"] {
        let color = |y: u32| if face == "px" && y == 0 { [255, 0, 0] } else { [0, 0, 255] };
        let image = image::RgbImage::from_fn(2, 2, |_, y| image::Rgb(color(y)));
        image.save(folder.path().join(format!("maps/sky_{face}.png"))).unwrap();
    }
    let slices = image::RgbImage::from_fn(2, 4, |_, y| image::Rgb([0, (y / 2 * 255) as u8, 0]));
    slices.save(folder.path().join("slices.png")).unwrap();
    let text = "#iChannel0 \"file://maps/sky_{}.png\" // six files\n#iChannel0::Type \"CubeMap\"\n\
        #iChannel1 \"slices.png\"\n#iChannel1::Type \"Volume\"\n\
        vec4 look(samplerCube sky, vec3 d) { return textureLod(sky, d, 0.0); }\n\
        void mainImage(out vec4 c, in vec2 p) {\n    \
        if (p.x < 16.0) c = look(iChannel0, vec3(1.0, p.y < 16.0 ? -0.5 : 0.5, 0.5));\n    \
        else if (p.x < 32.0) c = textureLod(iChannel1, vec3(0.5, 0.5, p.y < 16.0 ? 0.25 : 0.75), 0.0);\n    \
        else c = vec4(iChannelResolution[0].x / 2.0, iChannelResolution[1].z / 2.0, 0.0, 1.0);\n}\n";
    render(folder.path(), &[("toy.glsl", text)], &[]).expect(0, &[]);
    let found = [(8, 8), (8, 24), (24, 8), (24, 24), (48, 8)].map(|(x, y)| pixel(folder.path(), x, y));
    let expected = [[255, 0, 0, 255], [0, 0, 255, 255], [0, 255, 0, 255], [0, 0, 0, 255], [255, 255, 0, 255]];
    assert_eq!(found, expected);
    run(folder.path(), &["check", "--shaders", "toy.glsl"]).expect(0, &[]);
    // What is wrong has the author's line.
    fs::remove_file(folder.path().join("maps/sky_ny.png")).unwrap();
    render(folder.path(), &[("toy.glsl", text)], &[]).expect(
        1,
        &["toy.glsl:1:13: error: \"maps/sky_{}.png\" has no sky_ny.png", "#iChannel0 \"file://maps/sky_{}.png\""],
    );
    let wrong = text.replace("\"CubeMap\"", "\"Cube\"");
    render(folder.path(), &[("toy.glsl", &wrong)], &[])
        .expect(1, &["toy.glsl:2:19: error: expected \"Texture2D\", \"CubeMap\" or \"Volume\", found \"Cube\""]);
}

/// A face of a cube map, a new slice of a volume and the text are all watched.
#[test]
fn saving_a_file_of_a_toy_draws_it_again() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let paint = |name: String, value: u8| {
        let image = image::RgbImage::from_pixel(2, 2, image::Rgb([value; 3]));
        image.save(path(&format!("new-{name}"))).unwrap();
        // In one step, as editors do.
        fs::rename(path(&format!("new-{name}")), path(&name)).unwrap();
    };
    ["px", "nx", "py", "ny", "pz", "nz"].iter().for_each(|face| paint(format!("sky_{face}.png"), 0));
    paint("slice_1.png".into(), 0);
    let text = "#iChannel0 \"sky_{}.png\"\n#iChannel0::Type \"CubeMap\"\n\
        #iChannel1 \"slice_{}.png\"\n#iChannel1::Type \"Volume\"\nvoid mainImage(out vec4 c, in vec2 p) {\n    \
        c = textureLod(iChannel0, vec3(1.0, 0.0, 0.0), 0.0);\n    c.g = iChannelResolution[1].z / 2.0;\n}\n";
    fs::write(path("toy.glsl"), text).unwrap();
    let options = ["render", "toy.glsl", "--size", "64x32", "--watch", "--events", "json", "--out", "shot.png"];
    let mut running = Running::start(specula(folder.path()).args(options));
    running.event("completed");
    assert_eq!(pixel(folder.path(), 8, 8), [0, 128, 0, 255]);
    paint("sky_px.png".into(), 255);
    running.reload(true);
    assert_eq!(pixel(folder.path(), 8, 8), [255, 128, 255, 255]);
    fs::write(path("toy.glsl"), text.replace("c.g", "c.b")).unwrap();
    running.reload(true);
    running.until_stderr("toy.glsl -> toy.glsl  compile");
    assert_eq!(pixel(folder.path(), 8, 8), [255, 255, 128, 255]);
    paint("slice_2.png".into(), 0);
    fs::write(path("toy.glsl"), text.replace("c.g", "c.r")).unwrap();
    running.reload(true);
    assert_eq!(pixel(folder.path(), 8, 8), [255, 255, 255, 255]);
}

#[test]
fn errors_have_the_lines_of_the_author() {
    let folder = tempfile::tempdir().unwrap();
    let wrong = IMAGE.replace("fragColor = vec4(material", "fragColor = vec4(materials");
    render(folder.path(), &[("toy.glsl", &wrong)], &[]).expect(1, &["toy.glsl:9:", "'materials'"]);
    render(folder.path(), &[("none.glsl", "float f() { return 1.0; }\n")], &[])
        .expect(1, &["none.glsl:1:1: error: expected `void mainImage"]);
    let missing = "#iChannel0 \"no.png\"\nvoid mainImage(out vec4 c, in vec2 p) { c = texture(iChannel0, p); }\n";
    render(folder.path(), &[("no.glsl", missing)], &[]).expect(1, &["no.glsl:1:13: error: \"no.png\" not found"]);
    run(folder.path(), &["render", "gone.glsl"]).expect(1, &["gone.glsl: there is no such file"]);
    // A file of a tree is opened with its tree.
    fs::write(folder.path().join("interface.glsl"), "").unwrap();
    run(folder.path(), &["render", "toy.glsl"]).expect(2, &["toy.glsl is a shader; use `--shaders .`"]);
}

/// Errors quote the author's line and words, never the text that is compiled, and name the author's file.
#[test]
fn errors_quote_the_author() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("bad.png"), "no image").unwrap();
    let image = |body: &str| format!("void mainImage(out vec4 c, in vec2 p) {{ {body} }}\n");
    let look = image("c = texture(iChannel0, p);");
    for (text, told) in [
        ("void main() { gl_FragColor = vec4(foo, gl_FragCoord.x); }\n".to_owned(), vec!["t.glsl:1:35: error: 'foo'"]),
        (
            "void main() { gl_FragColor = vec3(1.0); }\n".to_owned(),
            vec!["t.glsl:1:28: error: 'assign'", "void main() { gl_F"],
        ),
        ("void main() { gl_FragColor.foo = 1.0; }\n".to_owned(), vec!["t.glsl:1:", "void main() { gl_F"]),
        (
            format!("#iChannel0 \"bad.png\"\n{look}"),
            vec!["t.glsl:1:13: error: ", "bad.png cannot be read", "1 | #iChannel0"],
        ),
        (format!("#iChannel0 \"keybord\"\n{look}"), vec!["t.glsl:1:13: error: ", "Did you mean \"keyboard\"?"]),
        (format!("#iChannel0 \"gone.glsl\"\n{look}"), vec!["t.glsl:1:13: error: \"gone.glsl\" not found in "]),
        (
            "void mainImage(out vec4 c) { c = vec4(1.0); }\n".to_owned(),
            vec!["t.glsl:1:6: error: expected `void mainImage(out"],
        ),
        (
            image("c = vec4(isKeyDown(Key_A));"),
            vec!["t.glsl:1:", "help: write `#iKeyboard` on a line of its own", "Key_LeftArrow"],
        ),
    ] {
        let stderr = render(folder.path(), &[("t.glsl", &text)], &[]).expect(1, &told).stderr.clone();
        let foreign = ["embedded:", "opened/", "toyFrag", "Main()", "_channel", "#error"];
        assert!(!foreign.iter().any(|word| stderr.contains(word)), "{text}{stderr}");
        assert!(stderr.lines().any(|line| line.contains("| ") && line.contains('^')), "{text}{stderr}");
    }
    // A block of sliders, and a uniform of its own.
    let block = "uniform Sliders {\n    float speed;   //@ui \"Speed\" 0..1 = 0.5\n};\n";
    for declared in [block, "uniform float speed;\n"] {
        let slider = format!("{declared}{}", image("c = vec4(speed);"));
        render(folder.path(), &[("t.glsl", &slider)], &["--set", "speed=1"]).expect(0, &[]);
        assert_eq!(pixel(folder.path(), 3, 3), [255; 4]);
    }
}
