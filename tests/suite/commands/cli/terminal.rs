//! Text for a terminal: names from files without their control characters, and tables that people read.

use std::fs;

use serde_json::json;

use super::{SMALL, directory, document, render};
use crate::support::process::{Finished, run};
use crate::support::{Tree, glb};

/// Turns the text red, sets the window's title, and is a control character outside of ASCII.
const EVIL: &str = "a\u{1b}[31m\u{1b}]0;title\u{7}\u{9b}1m";
const ESCAPED: &str = "a\\u{1b}[31m\\u{1b}]0;title\\u{7}\\u{9b}1m";

/// Fails when anything printed holds a control character that is no line break or tab.
#[track_caller]
fn assert_plain(finished: &Finished) {
    for text in [&finished.stdout, &finished.stderr] {
        assert!(!text.contains(|c: char| c.is_control() && c != '\n' && c != '\t'), "{finished:#?}");
    }
}

#[test]
fn names_from_a_model_are_escaped() {
    let directory = directory();
    let here = directory.path();
    let (mut model, bin) = document();
    for list in ["materials", "meshes", "nodes"] {
        model[list][0]["name"] = json!(EVIL);
    }
    model["materials"][0]["pbrMetallicRoughness"]["metallicFactor"] = json!(7);
    let pixel = image::RgbaImage::new(1, 1);
    let mut png = std::io::Cursor::new(Vec::new());
    pixel.write_to(&mut png, image::ImageFormat::Png).unwrap();
    fs::write(here.join("pixel.png"), png.into_inner()).unwrap();
    model["images"] = json!([{ "uri": "pixel.png", "name": EVIL }]);
    model["textures"] = json!([{ "source": 0 }]);
    model["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = json!({ "index": 0 });
    model["extensionsUsed"] = json!(["KHR_materials_variants", format!("EXT_{EVIL}")]);
    model["extensions"] = json!({ "KHR_materials_variants": { "variants": [{ "name": EVIL }, { "name": EVIL }] } });
    let name = format!("{EVIL}.glb");
    fs::write(here.join(&name), glb::container(&model, &bin)).unwrap();

    let info = run(here, &["info", &name]);
    assert_plain(info.expect(0, &[&format!("warning: {ESCAPED}: "), &format!("variant '{ESCAPED}'")]));
    for part in ["Model ", "1 x 1 ", "variants "] {
        let has = |line: &str| line.contains(part) && line.contains(ESCAPED);
        assert!(info.stdout.lines().any(has), "no {part}: {info:#?}");
    }
    let json = run(here, &["info", &name, "--json"]);
    assert_plain(&json);
    assert_eq!(json.json()["model"]["model"], EVIL);
    assert_plain(render(here, &name, &["--set", "variant=x"]).expect(2, &[ESCAPED]));

    model["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = json!({ "index": 9 });
    fs::write(here.join(&name), glb::container(&model, &bin)).unwrap();
    assert_plain(run(here, &["info", &name]).expect(0, &[&format!("\"{ESCAPED}\".pbrMetallicRoughness"), "found 9"]));
    model["scenes"][0]["nodes"] = json!([9]);
    fs::write(here.join(&name), glb::container(&model, &bin)).unwrap();
    assert_plain(run(here, &["info", &name]).expect(1, &[ESCAPED, "9"]));
}

#[test]
fn names_of_files_are_escaped() {
    let directory = directory();
    let here = directory.path();
    for (option, ending) in [("--look", "toml"), ("--env", "hdr"), ("--shaders", "d"), ("--measured", "binary")] {
        let name = format!("{EVIL}.{ending}");
        assert_plain(run(here, &["render", "sphere-grid", SMALL[0], SMALL[1], option, &name]).expect(1, &[ESCAPED]));
    }
    fs::write(here.join("look.toml"), format!("[view]\nev = \"{EVIL}\"\n")).unwrap();
    assert_plain(render(here, "sphere-grid", &["--look", "look.toml"]).expect(1, &["look.toml:2:"]));
    image::RgbaImage::new(1, 1).save(here.join(format!("{EVIL}.png"))).unwrap();
    let name = format!("{EVIL}.png");
    let diff = run(here, &["diff", &name, &name]);
    assert_plain(diff.expect(0, &[]));
    assert!(diff.stdout.contains(ESCAPED), "{diff:#?}");
}

#[test]
fn text_of_shaders_is_escaped_and_the_caret_stays_under_its_word() {
    let tree = Tree::new();
    let text = tree.edited("user.glsl", "    return radiance;", &format!("    /*{EVIL}*/ return radiance * nope;"));
    tree.write("user.glsl", &text);
    let finished = run(&tree.beside(""), &["render", "--out", "out.png", SMALL[0], SMALL[1]]);
    assert_plain(finished.expect(1, &["'nope'", ESCAPED]));
    let lines: Vec<&str> = finished.stderr.lines().collect();
    let row = lines.iter().position(|line| line.contains("^^^^")).unwrap();
    assert_eq!(lines[row].find("^^^^"), lines[row - 1].find("nope"), "{}", finished.stderr);
}

#[test]
fn info_is_a_table() {
    let directory = directory();
    let info = run(directory.path(), &["info", "variants"]);
    info.expect(0, &[]);
    for part in [
        "shaders     built in",
        "\nDevices\n",
        "\nModel variants\n",
        "size        1.591 x 2.140 x 1.600 m, center 0.000, 0.930, 0.000",
        "triangles   3780",
        "vertices    2108",
        "variants    Porcelain, Bronze, Lacquer",
        "images      none",
    ] {
        assert!(info.stdout.contains(part), "no `{part}`: {info:#?}");
    }
    let info = run(directory.path(), &["info"]);
    assert!(info.stdout.contains("1024 x 1024  shell base color"), "{info:#?}");
    assert!(!info.stdout.contains(['[', ']', '"', '{']), "raw JSON in: {info:#?}");
}
