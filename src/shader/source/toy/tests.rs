use std::fs;
use std::path::Path;

use super::Toy;
use crate::shader::source::TreePath;

/// A toy in a folder with these files.
fn toy(folder: &Path, files: &[(&str, &str)]) -> Toy {
    for (name, text) in files {
        fs::write(folder.join(name), text).unwrap();
    }
    Toy::new(folder.join(files[0].0))
}

fn stage(toy: &Toy, pass: &str) -> String {
    toy.read(&TreePath::from(format!("passes/{pass}.frag").as_str())).unwrap()
}

const IMAGE: &str = "void mainImage(out vec4 c, in vec2 p) { c = texture(iChannel0, p) + texture(iChannel1, p); }\n";

#[test]
fn buffers_may_have_the_names_that_shadertoy_gives_them() {
    let folder = tempfile::tempdir().unwrap();
    let toy = toy(
        folder.path(),
        &[("t.glsl", IMAGE), ("Buffer A.glsl", IMAGE), ("Common.glsl", "float one() { return 1.0; }")],
    );
    assert!(stage(&toy, "image").contains("#define iChannel0 buffer_a\n"));
    assert!(stage(&toy, "buffer_a").contains("opened/Buffer A.glsl"));
}

#[test]
fn buffers_are_drawn_in_the_order_of_their_letters() {
    let folder = tempfile::tempdir().unwrap();
    let toy = toy(folder.path(), &[("t.glsl", IMAGE), ("buffer_a.glsl", IMAGE), ("t.buffer_b.glsl", IMAGE)]);
    // A reads itself and B as they were one frame ago, B reads A of this frame.
    let has = |pass: &str, lines: &[&str]| {
        let text = stage(&toy, pass);
        lines.iter().for_each(|line| assert!(text.lines().any(|found| found == *line), "{pass}: no {line} in {text}"));
    };
    has("buffer_a", &["#define iChannel0 before_buffer_a", "#define iChannel1 before_buffer_b", "#define TOY_BUFFER"]);
    has("buffer_b", &["#define iChannel0 buffer_a", "#define iChannel1 before_buffer_b"]);
    has("image", &["#define iChannel0 buffer_a", "#define iChannel1 buffer_b", "#include \"opened/t.glsl\""]);
    assert!(!stage(&toy, "image").contains("TOY_BUFFER"));
    let expected = ["passes/buffer_a.frag", "passes/buffer_b.frag", "passes/image.frag"];
    let listed = toy.list();
    assert!(expected.iter().all(|path| listed.contains(&TreePath::from(*path))));
}

#[test]
fn a_file_has_the_sliders_that_it_declares() {
    let folder = tempfile::tempdir().unwrap();
    let with = |name: &str| format!("uniform float {name};\n{IMAGE}");
    let toy =
        toy(folder.path(), &[("t.glsl", &with("speed")), ("buffer_a.glsl", IMAGE), ("buffer_b.glsl", &with("size"))]);
    let has_sliders = |pass: &str| stage(&toy, pass).contains("toy/sliders.glsl");
    assert!(has_sliders("image") && has_sliders("buffer_b") && !has_sliders("buffer_a"));
}

#[test]
fn named_files_are_drawn_before_those_that_read_them() {
    let folder = tempfile::tempdir().unwrap();
    let blur = "#iChannel0 \"self\"\n#iChannel1 \"spots.png\"\n".to_owned() + IMAGE;
    let image = "#iChannel0 \"file://blur.glsl\"\n".to_owned() + IMAGE;
    let toy = toy(folder.path(), &[("t.frag", &image), ("blur.glsl", &blur)]);
    let text = stage(&toy, "image");
    assert!(text.contains("#define iChannel0 buffer_blur\n"), "{text}");
    // Without a file, a channel is noise.
    assert!(text.contains("//@texture image_noise \"toy/noise.png\""), "{text}");
    let text = stage(&toy, "buffer_blur");
    assert!(text.contains("#define iChannel0 before_buffer_blur\n"), "{text}");
    assert!(text.contains("#define iChannel1 buffer_blur_channel1\n"), "{text}");
    assert!(toy.read_bytes(&TreePath::from("toy/noise.png")).unwrap().starts_with(b"\x89PNG"));
    let watched = toy.watched();
    ["t.frag", "blur.glsl", "spots.png", "common.glsl", "t.buffer_c.glsl"].iter().for_each(|name| {
        assert!(watched.contains(&folder.path().join(name)), "{name}");
    });
    // A change of a file changes the stages beside it.
    let changed = toy.changed(&folder.path().join("blur.glsl"));
    ["opened/blur.glsl", "passes/buffer_blur.frag", "passes/image.frag", "passes/buffer_d.frag"].iter().for_each(
        |path| {
            assert!(changed.contains(&TreePath::from(*path)), "{path}");
        },
    );
}

#[test]
fn all_files_of_a_cube_map_are_watched() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("maps")).unwrap();
    fs::write(folder.path().join("maps/a_7.png"), "").unwrap();
    let text = "#iChannel0 \"maps/a_{}.png\"\n#iChannel0::Type \"Volume\"\n".to_owned() + IMAGE;
    let toy = toy(folder.path(), &[("t.glsl", &text)]);
    // The faces may not exist yet; a slice does.
    let watched = toy.watched();
    ["maps/a_px.png", "maps/a_negz.png", "maps/a_7.png"].iter().for_each(|name| {
        assert!(watched.contains(&folder.path().join(name)), "{name}");
    });
    assert_eq!(toy.names_in("opened/maps"), ["a_7.png"]);
    assert!(stage(&toy, "image").contains("uniform sampler3D image_channel0;"));
    assert!(toy.changed(&folder.path().join("maps/a_px.png")).contains(&TreePath::from("opened/maps/a_px.png")));
}

#[test]
fn a_file_in_a_tree_is_no_toy() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("passes")).unwrap();
    assert!(Toy::is_toy(&folder.path().join("x.glsl")));
    assert!(!Toy::is_toy(&folder.path().join("x.png")));
    fs::write(folder.path().join("interface.glsl"), "").unwrap();
    assert!(!Toy::is_toy(&folder.path().join("x.glsl")));
    assert!(!Toy::is_toy(&folder.path().join("passes/x.frag")));
}
