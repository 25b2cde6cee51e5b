//! Words on the command line: a wrong name or value ends with exit code 2 and is answered with what can be given.

use std::fs;
use std::path::Path;

use super::{SMALL, directory, render};
use crate::support::process::{Finished, run};
use crate::support::{Tree, glb};

/// Runs `render sphere-grid` with these options.
fn with(directory: &Path, options: &[&str]) -> Finished {
    render(directory, "sphere-grid", options)
}

#[test]
fn a_misspelled_command_or_model_gets_the_nearest() {
    let directory = directory();
    let here = directory.path();
    let told = "there is neither a command nor a file 'rendr'. Did you mean 'render'?";
    run(here, &["rendr"]).expect(2, &[told]);
    run(here, &["rendr", "model.glb", "--out", "out.png"]).expect(2, &[told]);
    run(here, &[SMALL[0], SMALL[1], "rendr"]).expect(2, &[told]);
    run(here, &["shader-bal"]).expect(2, &["'shader-bal'", "Did you mean 'shader-ball'?"]);
    run(here, &["qqqqqqqq"]).expect(2, &["'qqqqqqqq'", "specula --help", "sphere-grid"]);
    for command in ["render", "info", "view"] {
        run(here, &[command, "Shader-Bal"]).expect(2, &["'Shader-Bal'", "Did you mean 'shader-ball'?"]);
    }
    run(here, &["--siez", SMALL[1]]).expect(2, &["unexpected argument '--siez'", "'--size'"]);
    // A name with an ending is a file that is missing, not a word.
    run(here, &["nowhere.glb"]).expect(1, &["nowhere.glb", "no such file"]);
    fs::write(here.join("helmet.glb"), glb::model(&glb::quad(1.0), &glb::gray())).unwrap();
    run(here, &["info", "helmt.glb"]).expect(1, &["helmt.glb", "no such file", "Did you mean 'helmet.glb'?"]);
}

#[test]
fn a_misspelled_environment_gets_the_nearest() {
    let directory = directory();
    let here = directory.path();
    let told = ["unknown environment 'studo'", "Did you mean 'studio'?", "sky", "furnace", "none", ".hdr or .exr"];
    run(here, &["render", "--env", "studo"]).expect(2, &told);
    run(here, &["view", "--env", "studo"]).expect(2, &told);
    run(here, &["brdf", "split-sum", "--env", "studo"]).expect(2, &told);
    with(here, &["--set", "environment.name=Studio"]).expect(2, &["'Studio'", "Did you mean 'studio'?"]);
    run(here, &["render", "--env", "nowhere.hdr", SMALL[0], SMALL[1]])
        .expect(1, &["nowhere.hdr", "studio, furnace, sky"]);
}

#[test]
fn a_misspelled_setting_gets_the_nearest() {
    let directory = directory();
    let set = |assignment: &str| with(directory.path(), &["--set", assignment]);
    for (assignment, nearest) in [
        ("ndf=Beckmann", "Did you mean `NDF`"),
        ("NFD=Beckmann", "Did you mean `NDF`"),
        ("ndf=", "Did you mean `NDF`, which takes GGX or Beckmann"),
        ("rim_strenght=0.5", "Did you mean `rim_strength`, which takes a number, 0 to 1"),
        ("exposre=1", "Did you mean `view.ev`"),
        ("foo=1", "Shader parameters: `"),
        ("tonemap=agx", "Did you mean `view.tonemap`"),
        ("view.e=1", "Did you mean `view.ev`"),
        ("views.ev=1", "Did you mean `view.ev`"),
        ("lights.orbit.0.strenth=1", "Did you mean `lights.orbit.0.strength`"),
    ] {
        let name = format!("unknown setting `{}`", assignment.split('=').next().unwrap());
        let told = set(assignment);
        told.expect(2, &[&name, nearest, "specula help set"]);
        // The list of all would hide the one that was meant.
        let has_list = told.stderr.contains("Shader parameters: `") || told.stderr.contains(" there are ");
        assert_eq!(has_list, !nearest.starts_with("Did you mean"), "{told:#?}");
    }
    set("no_such_name=1").expect(2, &["`rim_strength`", "`TOON_BANDS`", "Settings: `view.ev`, "]);
    set("view.ev=").expect(2, &["view.ev", "no value", "it takes a number, -30 to 30"]);
    set("NDF=").expect(2, &["NDF", "it takes GGX or Beckmann"]);
    fs::write(directory.path().join("look.toml"), "[view]\nevv = 1\n").unwrap();
    let told = ["look.toml:2:1: ", "unknown setting `evv`", "Did you mean `ev`?"];
    with(directory.path(), &["--look", "look.toml"]).expect(2, &told);
    assert!(!directory.path().join("out.png").exists(), "a picture with a setting that does not exist");
}

#[test]
fn a_choice_takes_its_names_and_their_numbers_only() {
    let directory = directory();
    let set = |assignment: &str| with(directory.path(), &["--set", assignment]);
    set("NDF=7").expect(2, &["NDF cannot be 7", "it takes GGX or Beckmann", "0 or 1"]);
    set("NDF=true").expect(2, &["NDF cannot be true", "GGX or Beckmann"]);
    set("NDF=Bekman").expect(2, &["NDF cannot be 'Bekman'", "Did you mean `Beckmann`?", "GGX or Beckmann"]);
    set("TOON_BANDS=1").expect(2, &["TOON_BANDS cannot be 1", "Off, Two, Three or Four", "0, 2, 3 or 4"]);
    set("rim_strength=true").expect(2, &["rim_strength cannot be true", "a number"]);
    set("view.tonemap=acess").expect(2, &["view.tonemap", "Did you mean `aces`?", "reinhard-luminance"]);
    set("lights.source=orbits").expect(2, &["lights.source", "Did you mean `orbit`?", "model"]);
    set("view.background=evn").expect(2, &["'evn'", "Did you mean `env`?", "#rrggbb"]);
    set("mode=roughnes").expect(2, &["'roughnes'", "Did you mean `roughness`?", "specula modes"]);
    with(directory.path(), &["--tonemap", "acess"]).expect(2, &["--tonemap", "'aces'", "reinhard-luminance"]);
    with(directory.path(), &["--lights", "orbits"]).expect(2, &["--lights", "'orbit'", "model"]);
    assert!(!directory.path().join("out.png").exists(), "a picture with a value that does not exist");
    set("NDF=1").expect(0, &[]);
    set("NDF=beckmann").expect(0, &[]);
    with(directory.path(), &["--tonemap", "ACES", "--lights", "None"]).expect(0, &[]);
}

#[test]
fn a_device_that_is_not_here_has_code_3() {
    let directory = directory();
    let device = |name: &str| with(directory.path(), &["--device", name]);
    let name = crate::support::gpu().info().name.clone();
    let word: String = name.split_whitespace().next().unwrap().to_owned();
    let misspelled = format!("{}x{}", &word[..2], &word[2..]);
    device(&misspelled).expect(3, &[&misspelled, &format!("Did you mean `{word}`?"), &name]);
}

/// Wrong values are usage errors wherever they are found; wrong files are not.
#[test]
fn a_wrong_value_has_code_2_and_a_wrong_file_code_1() {
    let directory = directory();
    let here = directory.path();
    let tree = Tree::new();
    tree.write("user.glsl", "nonsense");
    for (name, text) in [
        ("value.toml", "[camera]\nfovy = 500\n"),
        ("kind.toml", "[view]\nev = 'bright'\n"),
        ("choice.toml", "[view]\ntonemap = 'filmic'\n"),
        ("syntax.toml", "[view\nev = 1\n"),
        ("bad.glb", "no model"),
        ("bad.hdr", "no light"),
        ("bad.binary", "not measured"),
    ] {
        fs::write(here.join(name), text).unwrap();
    }
    fs::create_dir(here.join("full")).unwrap();
    fs::write(here.join("full/file"), "").unwrap();
    let shaders = tree.root();
    let shaders = shaders.to_str().unwrap();
    let render = |options: &[&'static str]| [&["render", "sphere-grid", "--env", "none"], options].concat();
    for (code, arguments, part) in [
        (2, render(&["--size", "99999999x1"]), "at most"),
        (2, render(&["--fovy", "500"]), "1 to 170"),
        (2, render(&["--ev", "nan"]), "-30 to 30"),
        (2, render(&["--mode", "metal-ness"]), "metal"),
        (2, render(&["--mode", "d", "--mode", "g"]), "more than once"),
        (2, render(&["--out", "out.bmp"]), ".exr or .npy"),
        (2, render(&["--set", "view.msaa=3"]), "1 or 4"),
        (2, render(&["--set", "variant=Gold"]), "Gold"),
        (2, render(&["--set", "view.ev"]), "path=value"),
        (2, render(&["--look", "value.toml"]), "value.toml: camera.fovy is 500; it can be 1 to 170"),
        (2, render(&["--look", "kind.toml"]), "kind.toml:2:6: "),
        (2, render(&["--look", "choice.toml"]), "choice.toml:2:11: "),
        (2, vec!["brdf", "furnace", "--set", "view.ev=2"], "specula modes"),
        (2, vec!["probe", "--at", "5000,1"], "1279,719"),
        (2, vec!["bench", "bake", "--env", "none", "--samples", "1"], "--env"),
        (2, vec!["diff", "bad.glb", "bad.glb", "--max", "-1"], "0 or more"),
        (1, render(&["--look", "syntax.toml"]), "syntax.toml:1:"),
        (1, render(&["--look", "nowhere.toml"]), "nowhere.toml"),
        (1, render(&["--shaders", "nowhere"]), "specula new"),
        (1, vec!["render", "--env", "bad.hdr"], "bad.hdr"),
        (1, render(&["--measured", "bad.binary", "--mode", "measured"]), "bad.binary"),
        (1, render(&["--measured", "nowhere.binary", "--mode", "measured"]), "nowhere.binary"),
        (1, render(&["--out", "nowhere/out.png"]), "no folder"),
        (1, vec!["render", "bad.glb"], "bad.glb"),
        (1, vec!["new", "full"], "not empty"),
        (1, vec!["check", "--shaders", shaders], "user.glsl"),
    ] {
        let finished = run(here, &arguments);
        assert_eq!(finished.code, Some(code), "{arguments:?}: {finished:#?}");
        finished.expect(code, &[part]);
    }
    let help = run(here, &["--help"]);
    assert!(help.expect(0, &[]).stdout.contains("Exit codes"), "{help:#?}");
}

#[test]
fn a_negative_number_is_a_value() {
    let directory = directory();
    for (arguments, option, part) in [
        (&["render", "--fovy", "-10"][..], "--fovy", "1 to 170"),
        (&["render", "--ev", "-31"], "--ev", "-30 to 30"),
        (&["render", "--size", "-5x3"], "--size", "at least 1"),
        (&["render", "--size", "-5"], "--size", "at least 1"),
        (&["bench", "load", "--samples", "-1"], "--samples", "1..=1000"),
        (&["probe", "--at", "-1,5"], "--at", "X,Y"),
        (&["brdf", "furnace", "--metallic", "-1"], "--metallic", "0 to 1"),
        (&["brdf", "furnace", "--base-color", "-1,0,0"], "--base-color", "0 to 1"),
        (&["brdf", "split-sum", "--frames", "-1"], "--frames", "1..=10000"),
        (&["brdf", "plot", "--angle", "-5"], "--angle", "0 to 89"),
        (&["brdf", "plot", "--roughness", "-0.5,1"], "--roughness", "0 to 1"),
    ] {
        run(directory.path(), arguments).expect(2, &["invalid value", option, part]);
    }
}

#[test]
fn another_kind_of_file_is_answered_with_its_option() {
    let tree = Tree::new();
    let here = tree.beside("");
    for name in ["sky.hdr", "sky.EXR", "look.toml", "paint.binary"] {
        fs::write(here.join(name), "").unwrap();
    }
    fs::create_dir(here.join("folder")).unwrap();
    for (name, told) in [
        ("sky.hdr", "is an environment; use `--env sky.hdr`"),
        ("sky.EXR", "is an environment; use `--env sky.EXR`"),
        ("missing.hdr", "is an environment; use `--env missing.hdr`"),
        ("look.toml", "is a look file; use `--look look.toml`"),
        ("paint.binary", "is a measured BRDF; use `--measured paint.binary`"),
        ("shaders", "is a shader tree; use `--shaders shaders`"),
        ("shaders/pbr.frag", "is a shader; use `--shaders shaders`"),
        ("folder", "has no .gltf or .glb file in it"),
    ] {
        for arguments in [&[name][..], &["render", name], &["info", name]] {
            run(&here, arguments).expect(2, &[name, told]);
        }
    }
}

#[test]
fn help_set_lists_every_setting() {
    let directory = directory();
    let help = run(directory.path(), &["help", "set"]);
    help.expect(0, &[]);
    let row = |path: &str| {
        let mut lines = help.stdout.lines().skip_while(|line| line.split_whitespace().next() != Some(path));
        let first = lines.next().unwrap_or_else(|| panic!("no {path}: {help:#?}"));
        // The meaning goes on in lines without a path.
        std::iter::once(first).chain(lines.take_while(|line| line.starts_with(' '))).collect::<String>()
    };
    for (path, parts) in [
        ("view.ev", &["number", "0.7", "-30 to 30", "EV100"][..]),
        ("camera.fovy", &["number", "35", "1 to 170", "degrees"]),
        ("lights.orbit.1.color", &["3 numbers", "0.45,0.65,1", "0 to 1e6", "linear RGB"]),
        ("lights.rect.enabled", &["true or false", "false"]),
        ("view.msaa", &["whole number", "4", "1 or 4"]),
        ("view.tonemap", &["name", "neutral", "reinhard-luminance"]),
        ("environment.name", &["studio", "furnace", "sky", "none"]),
        ("camera.eye", &["3 numbers", "meters"]),
    ] {
        let row = row(path);
        assert!(parts.iter().all(|part| row.contains(part)), "{row} lacks one of {parts:?}");
    }
    assert!(help.stdout.contains("specula modes"), "the shader's own are listed elsewhere: {help:#?}");
    run(directory.path(), &["new", "shaders", "--template", "life"]).expect(0, &[]);
    for more in [&["help", "set"][..], &["help", "set", "--shaders", "shaders"]] {
        let help = run(directory.path(), more);
        help.expect(0, &[]);
        let rows: Vec<&str> = help.stdout.lines().collect();
        let place = |path: &str, parts: &[&str]| {
            let is_row = |row: &&str| row.split_whitespace().next() == Some(path);
            let at = rows.iter().position(is_row).unwrap_or_else(|| panic!("no {path}: {help:#?}"));
            assert!(parts.iter().all(|part| rows[at].contains(part)), "{} lacks one of {parts:?}", rows[at]);
            at
        };
        let last = place("view.bounces", &[]);
        assert!(place("NDF", &["name", "GGX", "Beckmann"]) > last);
        assert!(place("TEMPORAL_ANTIALIASING", &["true or false", "false"]) > last);
        assert!(place("bloom_strength", &["number", "0 to 1"]) > last);
        assert!(place("passes.outline", &["true or false", "false"]) > last);
    }
    std::fs::write(directory.path().join("shaders/user.glsl"), "broken").unwrap();
    let help = run(directory.path(), &["help", "set"]);
    assert!(help.expect(0, &[]).stdout.contains("does not compile"), "{help:#?}");
    std::fs::remove_dir_all(directory.path().join("shaders")).unwrap();
    let render = run(directory.path(), &["help", "render"]);
    assert!(render.expect(0, &[]).stdout.contains("Usage: specula render"), "{render:#?}");
    let plot = run(directory.path(), &["help", "brdf", "plot"]);
    assert!(plot.expect(0, &[]).stdout.contains("Usage: specula brdf plot"), "{plot:#?}");
    assert!(run(directory.path(), &["help"]).expect(0, &[]).stdout.contains("Commands:"));
    run(directory.path(), &["help", "rendr"]).expect(2, &["'rendr'", "Did you mean 'render'?"]);
}

#[test]
fn help_writes_man_pages_and_completions() {
    let directory = tempfile::tempdir().unwrap();
    let help = |words: &[&str]| run(directory.path(), &[&["help"], words].concat());
    let page = help(&["man", "brdf", "plot"]).expect(0, &[]).stdout.clone();
    assert!(page.contains(".TH specula-brdf-plot 1"), "{page}");
    help(&["man", "--out", "man1"]).expect(0, &[]);
    for name in ["specula", "specula-render", "specula-brdf-plot"] {
        let page = std::fs::read_to_string(directory.path().join(format!("man1/{name}.1"))).unwrap();
        assert!(page.contains(&format!(".TH {name} 1")), "{page}");
    }
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = help(&["completions", shell]).expect(0, &[]).stdout.clone();
        assert!(script.contains("specula") && script.contains("tonemap"), "{shell}: {script}");
    }
    help(&["completions", "csh"]).expect(2, &["bash, elvish, fish, powershell, zsh"]);
    help(&["render", "--out", "man1"]).expect(2, &["specula help man --out DIR"]);
}

#[test]
fn help_commands_lists_what_a_window_takes() {
    let directory = tempfile::tempdir().unwrap();
    let help = run(directory.path(), &["help", "commands"]);
    help.expect(0, &[]);
    for command in specula::app::described() {
        assert!(help.stdout.contains(&format!("\"command\": \"{}\"", command.command)), "{help:#?}");
    }
}
