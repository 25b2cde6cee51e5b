//! The commands as processes: exit codes, messages, files and JSON.

mod passes;
mod progress;
mod stages;
mod terminal;
mod usage;

use std::fs;
use std::path::Path;

use crate::support::process::{Finished, finish, run, specula};
use crate::support::{Tree, glb, line_of, open_image};
use serde_json::{Value, json};
use tempfile::TempDir;

const SMALL: [&str; 2] = ["--size", "48x32"];

fn directory() -> TempDir {
    tempfile::tempdir().unwrap()
}

/// Runs `render` on a model file in `directory`, with validation and direct light only.
fn render(directory: &Path, model: &str, more: &[&str]) -> Finished {
    let args = ["render", model, "--validate", "--env", "none", "--out", "out.png", SMALL[0], SMALL[1]];
    run(directory, &[&args[..], more].concat())
}

/// A valid model as JSON and binary data, for tests to damage.
fn document() -> (Value, Vec<u8>) {
    glb::document(&glb::quad(1.0), &glb::gray())
}

/// Fails unless `render` refuses this model with exit code 1 and a message with its name and all `parts`, and writes no picture.
#[track_caller]
fn refused(bytes: &[u8], parts: &[&str]) {
    let directory = directory();
    fs::write(directory.path().join("bad.glb"), bytes).unwrap();
    let mut expected = vec!["bad.glb"];
    expected.extend(parts);
    render(directory.path(), "bad.glb", &[]).expect(1, &expected);
    assert!(!directory.path().join("out.png").exists(), "a picture of a refused model");
}

fn spoiled(spoil: impl FnOnce(&mut Value)) -> Vec<u8> {
    let (mut json, bin) = document();
    spoil(&mut json);
    glb::container(&json, &bin)
}

#[test]
fn no_model() {
    let directory = directory();
    render(directory.path(), "nowhere.glb", &[]).expect(1, &["nowhere.glb", "no such file", "shader-ball"]);
}

#[test]
fn an_empty_file() {
    refused(b"", &["is empty"]);
}

#[test]
fn a_truncated_glb() {
    let whole = glb::model(&glb::quad(1.0), &glb::gray());
    for length in [4, 11, 20, whole.len() / 2, whole.len() - 1] {
        refused(&whole[..length], &["expected", "found"]);
    }
}

#[test]
fn an_index_out_of_range() {
    let (json, mut bin) = document();
    let last = bin.len() - 4;
    bin[last..].copy_from_slice(&9_u32.to_le_bytes());
    refused(&glb::container(&json, &bin), &["expected", "9"]);
    refused(&spoiled(|json| json["nodes"][0]["mesh"] = json!(7)), &["7"]);
}

#[test]
fn an_accessor_past_its_buffer() {
    refused(&spoiled(|json| json["accessors"][0]["count"] = json!(4000)), &["accessor", "expected", "found"]);
    refused(&spoiled(|json| json["bufferViews"][0]["byteLength"] = json!(100_000)), &["bufferView"]);
}

#[test]
fn a_cycle_of_nodes() {
    refused(
        &spoiled(|json| json["nodes"] = json!([{ "mesh": 0, "children": [1] }, { "children": [0] }])),
        &["node", "found"],
    );
}

#[test]
fn an_image_that_cannot_be_decoded_is_a_checkerboard() {
    let directory = directory();
    let bytes = spoiled(|json| {
        json["images"] = json!([{ "name": "a.dds", "uri": "data:image/vnd-ms.dds;base64,RERTIHwAAAA=" }]);
        json["textures"] = json!([{ "source": 0 }]);
        json["materials"][0]["name"] = json!("wall");
        json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = json!({ "index": 0 });
    });
    fs::write(directory.path().join("wall.glb"), bytes).unwrap();
    let warning = "material 'wall', base color texture: image 'a.dds' cannot be decoded (DDS is not supported)";
    render(directory.path(), "wall.glb", &[]).expect(0, &["warning: wall", warning, "a checkerboard is shown"]);
    let picture = open_image(&directory.path().join("out.png")).into_rgba8();
    assert!(picture.pixels().any(|pixel| pixel.0[3] == 255), "the rest of the model is drawn");
}

#[test]
fn an_extension_that_is_required_and_lacking() {
    let name = "EXT_something";
    refused(&spoiled(|json| json["extensionsRequired"] = json!([name])), &[name, "supported"]);
}

/// A `.gltf` file with its buffer at `uri`.
fn with_buffer_at(uri: &str) -> (String, Vec<u8>) {
    let (mut json, bin) = document();
    json["buffers"][0]["uri"] = json!(uri);
    (json.to_string(), bin)
}

#[test]
fn a_uri_with_a_scheme() {
    let directory = directory();
    fs::write(directory.path().join("bad.gltf"), with_buffer_at("https://example.com/buffer.bin").0).unwrap();
    render(directory.path(), "bad.gltf", &[]).expect(1, &["bad.gltf", "https:"]);
}

/// The mesh whose buffer is missing is left out with a warning, and the picture is that of the rest.
#[test]
fn a_missing_buffer_costs_its_meshes_alone() {
    let directory = directory();
    let (mut json, bin) = document();
    fs::write(directory.path().join("rest.glb"), glb::container(&json, &bin)).unwrap();
    let accessors = json["accessors"].as_array().unwrap().clone();
    let views = json["bufferViews"].as_array().unwrap().len();
    for (index, mut accessor) in accessors.iter().cloned().enumerate() {
        let mut view = json["bufferViews"][index].clone();
        (view["buffer"], accessor["bufferView"]) = (json!(1), json!(views + index));
        json["bufferViews"].as_array_mut().unwrap().push(view);
        json["accessors"].as_array_mut().unwrap().push(accessor);
    }
    let mut gone = json["meshes"][0].clone();
    gone["name"] = json!("gone");
    for accessor in gone["primitives"][0]["attributes"].as_object_mut().unwrap().values_mut() {
        *accessor = json!(accessor.as_u64().unwrap() as usize + accessors.len());
    }
    json["meshes"].as_array_mut().unwrap().push(gone);
    json["buffers"].as_array_mut().unwrap().push(json!({ "byteLength": bin.len(), "uri": "gone.bin" }));
    json["nodes"].as_array_mut().unwrap().push(json!({ "mesh": 1, "translation": [0.5, 0.0, 1.0] }));
    json["scenes"][0]["nodes"] = json!([0, 1]);
    fs::write(directory.path().join("whole.glb"), glb::container(&json, &bin)).unwrap();
    let picture = |name: &str, words: &[&str]| {
        render(directory.path(), name, &[]).expect(0, words);
        open_image(&directory.path().join("out.png")).into_rgba8()
    };
    let words = ["warning: whole", "meshes[1] \"gone\".primitives[0]", "gone.bin", "left out. Put it there or export"];
    assert!(picture("whole.glb", &words) == picture("rest.glb", &[]), "the rest looks different");
    fs::write(directory.path().join("gone.bin"), &bin).unwrap();
    assert!(picture("whole.glb", &[]) != picture("rest.glb", &[]), "the mesh is never shown");
}

#[test]
fn a_path_out_of_the_models_folder() {
    let directory = directory();
    let (folder, outside) = (directory.path().join("model"), directory.path().join("outside.bin"));
    fs::create_dir(&folder).unwrap();
    for uri in ["../outside.bin", outside.to_str().unwrap()] {
        let (text, bin) = with_buffer_at(uri);
        fs::write(folder.join("bad.gltf"), text).unwrap();
        fs::write(&outside, bin).unwrap();
        render(&folder, "bad.gltf", &[]).expect(1, &["bad.gltf", "outside.bin", "--allow-outside"]);
        assert!(!folder.join("out.png").exists());
    }
    render(&folder, "bad.gltf", &["--allow-outside"]).expect(0, &[]);
    assert!(folder.join("out.png").exists());
}

#[test]
fn usage_errors_have_code_2() {
    let directory = directory();
    for args in [
        &["render", "--size", "0x0"][..],
        &["render", "--size", "64x0"],
        &["render", "--size", "wide"],
        &["view", "--size", "0x0"],
        &["render", "--no-such-option"],
        &["render", "--tonemap", "filmic"],
        &["render", "--eye", "1,2"],
        &["new"],
    ] {
        let finished = run(directory.path(), args);
        assert_eq!(finished.code, Some(2), "{args:?}: {finished:#?}");
        assert!(finished.stderr.contains("error"), "{finished:#?}");
    }
    run(directory.path(), &["render", "--size", "0x0"]).expect(2, &["at least 1"]);
}

#[test]
fn no_vulkan_device() {
    let directory = directory();
    let nothing = directory.path().join("no-driver.json");
    let mut command = specula(directory.path());
    command.env("VK_DRIVER_FILES", &nothing).env("VK_ICD_FILENAMES", &nothing);
    finish(command.args(["render", "--out", "out.png"])).expect(3, &["no driver. Install the"]);
    let finished = run(directory.path(), &["render", "--device", "No Such Device 9000"]);
    finished.expect(3, &["No Such Device 9000"]);
}

#[test]
fn no_display() {
    let directory = directory();
    let mut command = specula(directory.path());
    command.env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY").env_remove("WAYLAND_SOCKET");
    finish(command.arg("view")).expect(3, &["no display", "render --watch"]);
}

/// Without the library of keys, winit would panic.
#[test]
#[cfg(target_os = "linux")]
fn no_library_of_keys() {
    let directory = directory();
    let view = |libraries: &Path| {
        let mut command = specula(directory.path());
        command.env_remove("WAYLAND_DISPLAY").env_remove("WAYLAND_SOCKET").env("LD_LIBRARY_PATH", libraries);
        finish(command.arg("view").env("DISPLAY", ":nothing"))
    };
    let there = view(directory.path());
    there.expect(3, &["no display"]);
    assert!(!there.stderr.contains("libxkbcommon-x11"), "{}", there.stderr);
    // The loader of libraries takes the first file of the name, and refuses an empty one.
    for name in ["libxkbcommon-x11.so.0", "libxkbcommon-x11.so"] {
        fs::write(directory.path().join(name), "").unwrap();
    }
    view(directory.path()).expect(3, &["no display", "libxkbcommon-x11.so.0 is missing", "apt install"]);
}

#[test]
fn an_out_that_cannot_be_written() {
    let directory = directory();
    let out = |path: &str| {
        run(directory.path(), &["render", "sphere-grid", "--env", "none", "--out", path, SMALL[0], SMALL[1]])
    };
    out("no/such/folder/x.png").expect(1, &["no/such/folder/x.png", "no folder"]);
    out("x.bmp").expect(2, &["x.bmp", ".exr or .npy"]);
    fs::create_dir(directory.path().join("folder.png")).unwrap();
    out("folder.png").expect(1, &["folder.png", "is a folder"]);
    // Not even root can write there, and the error appears only after rendering.
    out("/proc/x.png").expect(1, &["cannot write /proc/x.png"]);
}

#[test]
fn unknown_names_are_told_with_those_that_exist() {
    let directory = directory();
    let render = |more: &[&str]| render(directory.path(), "sphere-grid", more);
    render(&["--mode", "metal-ness"]).expect(2, &["metal-ness", "Did you mean `metal", "specula modes"]);
    render(&["--set", "no_such_name=1"]).expect(2, &["no_such_name", "rim_strength", "TOON_BANDS"]);
    render(&["--set", "view.exposure=1"]).expect(2, &["view.exposure", "ev"]);
    render(&["--set", "TOON_BANDS=Nine"]).expect(2, &["TOON_BANDS", "Nine", "Two"]);
    render(&["--set", "rim_strength=8"]).expect(2, &["rim_strength is 8; it can be 0 to 1"]);
    render(&["--background", "blue"]).expect(2, &["blue", "#rrggbb"]);
    render(&["--set", "view.msaa=3"]).expect(2, &["view.msaa", "1 or 4"]);
    render(&["--look", "nowhere.toml"]).expect(1, &["nowhere.toml"]);
    render(&["--shaders", "nowhere"]).expect(1, &["nowhere", "specula new"]);
    assert!(!directory.path().join("out.png").exists());
}

#[test]
fn options_that_change_nothing_are_told_of() {
    let directory = directory();
    fs::write(directory.path().join("quad.glb"), glb::model(&glb::quad(1.0), &glb::gray())).unwrap();
    let options = ["--lights", "model", "--mode", "measured", "--set", "material.roughness=1"];
    let finished = render(directory.path(), "quad.glb", &options);
    finished.expect(0, &["specula: warning:"]);
    for part in ["has no lights of its own", "mode measured shows nothing", "without --set material.enabled=true"] {
        assert_eq!(finished.stderr.matches(part).count(), 1, "{part}: {finished:#?}");
    }
}

#[test]
fn modes_as_json() {
    let directory = directory();
    let finished = run(directory.path(), &["modes", "--json"]);
    let json = finished.expect(0, &[]).json();
    let modes = json.as_array().unwrap();
    assert!(modes.len() > 40, "{} modes", modes.len());
    for mode in modes {
        let text = |key: &str| mode[key].as_str().is_some_and(|text| !text.is_empty());
        assert!(mode["id"].is_u64() && ["name", "slug", "group", "doc"].into_iter().all(text), "{mode}");
        assert!(["color", "data", "vector"].iter().any(|encode| mode["encode"] == *encode), "{mode}");
    }
    assert_eq!(modes[0]["slug"], "final");
    let plain = run(directory.path(), &["modes"]);
    for part in ["base-color", "rim_strength", "Masking-shadowing: HeightCorrelated | Separable"] {
        assert!(plain.stdout.contains(part), "no {part}: {plain:#?}");
    }
}

#[test]
fn info_as_json() {
    let directory = directory();
    let finished = run(directory.path(), &["info", "sphere-grid", "--json"]);
    let json = finished.expect(0, &[]).json();
    assert_eq!(json["version"], env!("CARGO_PKG_VERSION"));
    assert_eq!(json["shaders"], "built in");
    assert!(json["devices"].as_array().is_some_and(|devices| devices[0]["name"].is_string()), "{json}");
    assert_eq!((&json["model"]["model"], &json["model"]["materials"]), (&json!("sphere-grid"), &json!(35)), "{json}");
    assert!(json["model"]["vertices"].as_u64() > Some(1000), "{json}");
}

#[test]
fn info_counts_what_is_in_a_file() {
    let directory = directory();
    let (mut json, bin) = glb::document(&glb::quad(1.0), &glb::gray());
    json["scenes"].as_array_mut().unwrap().push(json!({ "nodes": [2] }));
    json["nodes"].as_array_mut().unwrap().push(json!({ "camera": 0, "name": "Top" }));
    json["nodes"].as_array_mut().unwrap().push(json!({ "mesh": 0 }));
    json["extensionsUsed"] = json!(["KHR_materials_ior"]);
    json["scenes"][0]["nodes"] = json!([0, 1]);
    json["cameras"] =
        json!([{ "type": "orthographic", "orthographic": { "xmag": 1, "ymag": 1, "znear": 0, "zfar": 9 } }]);
    json["skins"] = json!([{ "joints": [0] }]);
    json["animations"] =
        json!([{ "channels": [], "samplers": [], "name": "Walk" }, { "channels": [], "samplers": [] }]);
    std::fs::write(directory.path().join("m.glb"), glb::container(&json, &bin)).unwrap();
    let info = run(directory.path(), &["info", "m.glb"]);
    info.expect(0, &[]);
    for line in
        ["scenes      2", "nodes       2", "meshes      1", "UV sets     none", "animations  2: Walk", "Top (2 m)"]
    {
        assert!(info.stdout.contains(line), "no {line}: {}", info.stdout);
    }
    let json = run(directory.path(), &["info", "m.glb", "--json"]).expect(0, &[]).json();
    let count = |name: &str| json["model"][name].as_u64().unwrap();
    assert_eq!(["scenes", "nodes", "uv_sets", "animations", "skins"].map(count), [2, 2, 0, 2, 1]);
    assert_eq!(
        (&json["model"]["clips"][0], &json["model"]["extensions"][0]),
        (&json!("Walk"), &json!("KHR_materials_ior"))
    );
    let second = run(directory.path(), &["info", "m.glb", "--scene", "1", "--json"]).expect(0, &[]).json();
    assert_eq!((&second["model"]["nodes"], &second["model"]["cameras"]), (&json!(1), &json!(0)));
    run(directory.path(), &["info", "m.glb", "--scene", "2"]).expect(2, &["m has 2 scenes; the first is 0"]);
    // Four vertices, six indices, and two textures of one pixel.
    assert_eq!(count("memory_bytes"), 4 * size_of::<specula::interface::Vertex>() as u64 + 6 * 4 + 2 * 4);
    let json = run(directory.path(), &["info", "anisotropy", "--json"]).expect(0, &[]).json();
    let uses = json["model"]["textures"].as_array().unwrap();
    assert!(uses.iter().flat_map(|uses| uses.as_array().unwrap()).any(|name| name == "anisotropy"), "{json}");
    assert_eq!(json["model"]["srgb"].as_array().unwrap().len(), uses.len());
}

#[test]
fn check_fails_with_file_and_line() {
    let tree = Tree::new();
    let here = tree.beside("");
    let text = tree.edited("brdf/ndf.glsl", "alpha * alpha", "alpha * alfa");
    tree.write("brdf/ndf.glsl", &text);
    // A library that compiles only if another file has included its dependencies.
    tree.write("common/loose.glsl", "float loose() { return PI; }\n");
    let bad = run(&here, &["check", "--shaders", "shaders"]);
    let place = format!("shaders/brdf/ndf.glsl:{}:", line_of(&text, "alfa"));
    bad.expect(1, &[&place, "error:", "'alfa'", "^^^^", "shaders/common/loose.glsl:1:", "'PI'"]);
    // `./shaders` is the default.
    run(&here, &["check"]).expect(1, &[&place]);

    let json = run(&here, &["check", "--json"]).expect(1, &[]).json();
    let found = json.as_array().unwrap().iter().find(|d| d["message"].as_str().unwrap().contains("alfa")).unwrap();
    assert_eq!((&found["severity"], &found["line"]), (&json!("error"), &json!(line_of(&text, "alfa"))), "{found}");
    for key in ["file", "column", "message", "excerpt"] {
        assert!(!found[key].is_null(), "{key} in {found}");
    }
    let events = run(&here, &["check", "--events", "json"]);
    let first: Value = serde_json::from_str(events.expect(1, &[]).stdout.lines().next().unwrap()).unwrap();
    assert_eq!(first["event"], "diagnostic", "{first}");
}

#[test]
fn new_writes_a_tree_that_passes_check_and_never_overwrites() {
    let directory = directory();
    run(directory.path(), &["new", "mine"]).expect(0, &[]);
    let good = run(directory.path(), &["check", "--shaders", "mine"]);
    assert!(good.expect(0, &[]).stdout.contains("no errors"), "{good:#?}");
    fs::write(directory.path().join("mine/user.glsl"), "precious").unwrap();
    run(directory.path(), &["new", "mine"]).expect(1, &["mine", "not empty"]);
    assert_eq!(fs::read_to_string(directory.path().join("mine/user.glsl")).unwrap(), "precious");
}

#[test]
fn a_shader_error_is_printed_for_editors_and_ends_render_with_1() {
    let tree = Tree::new();
    let text = tree.edited("user.glsl", "    return radiance;", "    return radiance * nope;");
    tree.write("user.glsl", &text);
    let place = format!("shaders/user.glsl:{}:", line_of(&text, "nope"));
    let finished = run(&tree.beside(""), &["render", "--out", "out.png", SMALL[0], SMALL[1]]);
    finished.expect(1, &[&place, "error: 'nope'", "^^^^"]);
}

#[test]
fn render_mode_all_writes_each_file() {
    let directory = directory();
    fs::write(directory.path().join("quad.glb"), glb::model(&glb::quad(1.0), &glb::gray())).unwrap();
    let modes = run(directory.path(), &["modes", "--json"]).json();
    let modes = modes.as_array().unwrap();
    let all = ["--mode", "all", "--set", "view.msaa=1", "--set", "view.frames=2"];
    let files = || fs::read_dir(directory.path()).unwrap().count();
    let has = |mode: &str| directory.path().join(format!("out.{mode}.png")).exists();
    // A tree that declares few modes beside the images of its passes.
    let tree = Tree::new();
    let few = ["final", "depth", "roughness", "path-traced", "monte-carlo"];
    let is_kept = |line: &&str| {
        let slug = line.strip_prefix("//@mode ").and_then(|rest| rest.split(' ').next());
        slug.is_none_or(|slug| few.contains(&slug))
    };
    let text = tree.read("debug/modes.glsl").lines().filter(is_kept).collect::<Vec<_>>().join("\n");
    tree.write("debug/modes.glsl", &text);
    let root = tree.root();
    let without_paths =
        render(directory.path(), "quad.glb", &[&all[..], &["--shaders", root.to_str().unwrap()]].concat());
    without_paths.expect(0, &["left out 2 modes of random paths; add --paths"]);
    let of_passes = modes.iter().filter(|mode| mode["slug"].as_str().unwrap().starts_with("pass:")).count();
    assert_eq!((files(), has("roughness"), has("path-traced")), (3 + of_passes + 1, true, false));
    let finished = render(directory.path(), "quad.glb", &[&all[..], &["--paths"]].concat());
    assert!(!finished.expect(0, &[]).stderr.contains("left out"), "{finished:#?}");
    assert_eq!((files(), has("path-traced")), (modes.len() + 1, true), "files beside the modes and the model");
    for mode in modes {
        let path = directory.path().join(format!("out.{}.png", mode["slug"].as_str().unwrap().replace(':', "-")));
        assert_eq!(open_image(&path).into_rgba8().dimensions(), (48, 32));
    }
    render(directory.path(), "quad.glb", &["--mode", "d", "--paths"]).expect(2, &["--paths", "--mode all"]);
}

#[test]
fn render_takes_a_list_of_modes() {
    let directory = directory();
    fs::write(directory.path().join("quad.glb"), glb::model(&glb::quad(1.0), &glb::gray())).unwrap();
    let render = |more: &[&str]| render(directory.path(), "quad.glb", more);
    render(&["--mode", "roughness, final"]).expect(0, &[]);
    let has = |file: &str| directory.path().join(file).exists();
    assert_eq!(["out.roughness.png", "out.final.png", "out.png", "out.d.png"].map(has), [true, true, false, false]);
    assert_eq!(open_image(&directory.path().join("out.roughness.png")).into_rgba8().dimensions(), (48, 32));
    // A wrong name leaves no files.
    render(&["--mode", "d,metal-ness"]).expect(2, &["metal-ness", "Did you mean `metal"]);
    assert!(!has("out.d.png"));
    render(&["--mode", "final,d", "--sheet", "modes"]).expect(2, &["--sheet final,d"]);
}

#[test]
fn each_of_many_models_has_a_picture_of_its_own() {
    let directory = directory();
    let write = |name: &str, bytes: &[u8]| {
        let path = directory.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, bytes).unwrap();
    };
    let quad = |half: f32| glb::model(&glb::quad(half), &glb::gray());
    write("models/a.glb", &quad(1.0));
    write("models/b.glb", b"no model");
    write("models/c.glb", &quad(0.5));
    write("packs/d/scene.glb", &quad(1.0));
    write("packs/e/scene.glb", &quad(1.0));
    let render = |more: &[&str]| run(directory.path(), &[&["render", "--each"], more, &SMALL].concat());
    // One that cannot be read does not keep the others away, and is named in the end.
    let told = ["b.glb", "1 of 3 models have no picture: models/b.glb"];
    render(&["models", "--out", "{name}.small.png"]).expect(1, &told);
    let has = |file: &str| directory.path().join(file).exists();
    assert_eq!(["a.small.png", "b.small.png", "c.small.png"].map(has), [true, false, true]);
    render(&["models/c.glb", "packs"]).expect(0, &[]);
    assert_eq!(["c.png", "d.png", "e.png"].map(has), [true; 3]);
    render(&["models/c.glb", "--out", "one.png"]).expect(2, &["{name}"]);
    render(&["models/a.glb", "packs/d", "packs/d"]).expect(2, &["the same name"]);
    render(&[]).expect(2, &["--each needs models"]);
}

#[test]
fn an_exr_holds_raw_floats() {
    let directory = directory();
    let mesh = glb::sphere(16, 32);
    fs::write(directory.path().join("ball.glb"), glb::model(&mesh, &glb::gray())).unwrap();
    let args = ["render", "ball.glb", "--mode", "depth", "--out", "depth.exr", "--eye", "0,0,5", "--target", "0,0,0"];
    run(directory.path(), &[&args[..], &SMALL, &["--env", "none", "--set", "view.msaa=1"]].concat()).expect(0, &[]);
    let exr = open_image(&directory.path().join("depth.exr")).into_rgba32f();
    let pixel = exr.get_pixel(24, 16).0;
    // The front of a unit sphere, 5 m away. The value is in meters, which a PNG could not hold.
    assert!((pixel[0] - 4.0).abs() < 0.02 && pixel[3] == 1.0, "{pixel:?}");
    assert_eq!(exr.get_pixel(0, 0).0[3], 0.0);
}

/// A PNG holds the settings that made it, and gives the same picture again.
#[test]
fn a_picture_is_a_look_file() {
    let directory = directory();
    let here = directory.path();
    fs::write(here.join("ball.glb"), glb::model(&glb::sphere(16, 32), &glb::gray())).unwrap();
    let options = ["--background", "#102030", "--set", "camera.azimuth=70", "--set", "NDF=Beckmann"];
    render(here, "ball.glb", &options).expect(0, &[]);
    let first = fs::read(here.join("out.png")).unwrap();
    fs::rename(here.join("out.png"), here.join("first.png")).unwrap();
    render(here, "ball.glb", &["--look", "first.png"]).expect(0, &[]);
    assert!(fs::read(here.join("out.png")).unwrap() == first, "not the same file again");
    render(here, "ball.glb", &["--look", "first.png", "--background", "#ff0000"]).expect(0, &[]);
    assert_eq!(open_image(&here.join("out.png")).into_rgba8().get_pixel(0, 0).0, [255, 0, 0, 255]);
    // It finds its model, also after both have moved together.
    let of_look = |look: &str| run(here, &["render", "--look", look, "--out", "again.png", SMALL[0], SMALL[1]]);
    fs::create_dir(here.join("moved")).unwrap();
    for name in ["ball.glb", "first.png"] {
        fs::rename(here.join(name), here.join("moved").join(name)).unwrap();
    }
    of_look("moved/first.png").expect(0, &[]);
    assert!(open_image(&here.join("again.png")) == open_image(&here.join("moved/first.png")), "another picture");
    fs::rename(here.join("moved/first.png"), here.join("first.png")).unwrap();
    of_look("first.png").expect(1, &["first.png: its model ball.glb is not there; name it with MODEL"]);
    fs::rename(here.join("moved/ball.glb"), here.join("ball.glb")).unwrap();
    image::RgbaImage::new(2, 2).save(here.join("photo.png")).unwrap();
    render(here, "ball.glb", &["--look", "photo.png"]).expect(1, &["photo.png: this PNG holds no settings of Specula"]);
    run(here, &["render", "first.png"]).expect(2, &["first.png is a look file; use `--look first.png`"]);
}

#[test]
fn without_a_background_alpha_is_coverage() {
    let directory = directory();
    fs::write(directory.path().join("ball.glb"), glb::model(&glb::sphere(16, 32), &glb::gray())).unwrap();
    render(directory.path(), "ball.glb", &["--background", "none"]).expect(0, &[]);
    let png = open_image(&directory.path().join("out.png")).into_rgba8();
    assert_eq!((png.get_pixel(0, 0).0, png.get_pixel(24, 16).0[3]), ([0; 4], 255));
    let edges = png.pixels().filter(|pixel| !matches!(pixel.0[3], 0 | 255)).count();
    assert!(edges > 10, "4x MSAA leaves {edges} pixels in between");
    render(directory.path(), "ball.glb", &["--background", "#102030"]).expect(0, &[]);
    let png = open_image(&directory.path().join("out.png")).into_rgba8();
    assert_eq!(png.get_pixel(0, 0).0, [0x10, 0x20, 0x30, 255]);
}

#[test]
fn a_look_file_and_options_and_sets_add_up() {
    let directory = directory();
    fs::write(directory.path().join("quad.glb"), glb::model(&glb::quad(9.0), &glb::gray())).unwrap();
    fs::write(directory.path().join("red.toml"), "[view]\nbackground = '#ff0000'\n[camera]\nelevation = -90.0\n")
        .unwrap();
    let look = ["--look", "red.toml", "--set", "camera.eye=[0, 0, -50]", "--set", "camera.target=[0, 0, -99]"];
    render(directory.path(), "quad.glb", &look).expect(0, &[]);
    let pixel = |x| open_image(&directory.path().join("out.png")).into_rgba8().get_pixel(x, 9).0;
    assert_eq!(pixel(20), [255, 0, 0, 255], "the camera looks away from the quad");
    render(directory.path(), "quad.glb", &[&look[..], &["--background", "#00ff00"]].concat()).expect(0, &[]);
    assert_eq!(pixel(20), [0, 255, 0, 255], "an option beats the look file");
}
