//! Passes of a beginner: what is missing is said with the lines to write.

use super::SMALL;
use crate::support::Tree;
use crate::support::process::{Finished, finish, run, specula};

/// Compiles the tree on a machine without a device, which builds no pipelines.
fn check(tree: &Tree) -> Finished {
    let mut command = specula(&tree.beside(""));
    let nothing = tree.beside("no-driver.json");
    command.env("VK_DRIVER_FILES", &nothing).env("VK_ICD_FILENAMES", &nothing);
    finish(command.args(["check", "--shaders", "shaders"]))
}

/// Renders a model with the tree.
fn render(tree: &Tree, more: &[&str]) -> Finished {
    let args = ["render", "metal-grid", "--shaders", "shaders", "--out", "out.png", SMALL[0], SMALL[1]];
    run(tree.beside("").as_path(), &[&args[..], more].concat())
}

#[test]
fn a_number_outside_a_block_becomes_a_slider() {
    let tree = Tree::new();
    let text = "//@pass tint to=picture\n#version 460\n#include \"pass.glsl\"\nuniform highp float tint_strength;\n\
        void main() { color = vec4(tint_strength); }\n";
    tree.write("passes/tint.frag", text);
    let told = "tint.frag:4:21: error: `tint_strength` is a float outside a block";
    let slider = "    uniform Sliders {\n              float tint_strength;   //@ui \"Tint strength\" 0..1 = 0.5";
    let told = render(&tree, &["--env", "none"]).expect(1, &[told, "uniform Sliders {", "};"]).stderr.clone();
    let plain = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(plain(&told).contains(&plain(slider)), "{told}");
    tree.write(
        "passes/tint.frag",
        &text.replace(
            "uniform highp float tint_strength;",
            "uniform Sliders {\nfloat tint_strength;   //@ui \"Tint strength\" 0..1 = 0.5\n};",
        ),
    );
    render(&tree, &["--env", "none", "--set", "tint_strength=0.25"]).expect(0, &[]);
    // The stages of the picture share a block.
    std::fs::remove_file(tree.path("passes/tint.frag")).unwrap();
    tree.write("user.glsl", &format!("uniform vec3 rim_color;\n{}", tree.read("user.glsl")));
    let told = ["user.glsl:1:14: error: `rim_color` is a vec3 outside a block", "`Params` of user/params.glsl"];
    render(&tree, &["--env", "none"])
        .expect(1, &told)
        .expect(1, &["vec3 rim_color;   //@ui \"Rim color\" color = 1 1 1"]);
}

#[test]
fn a_pass_that_draws_the_model_includes_no_pass_glsl() {
    let tree = Tree::new();
    let text = "//@pass glow draw=model to=picture\n#version 460\n#include \"pass.glsl\"\nvoid main() { color = vec4(uv, 0.0, 1.0); }\n";
    tree.write("passes/glow.frag", text);
    let told = "glow.frag:3:11: error: pass.glsl is for passes that cover their image: it reads `uv`, which pbr.vert does not write";
    render(&tree, &["--env", "none"]).expect(1, &[told, "#include \"common/fragment.glsl\"", "in Fragment fragment;"]);
}

#[test]
fn files_that_nothing_draws_are_told_once() {
    let tree = Tree::new();
    let body = "#version 460\n#include \"pass.glsl\"\nvoid main() { color = vec4(1.0); }\n";
    tree.write("passes/forgotten.frag", body);
    tree.write("passes/spaced.frag", &format!("// @pass spaced to=picture\n{body}"));
    tree.write("passes/alone.vert", "#version 460\nvoid main() { gl_Position = vec4(0.0); }\n");
    tree.write("passes/lone.comp", "#version 460\nlayout(local_size_x = 8) in;\nvoid main() {}\n");
    let told = [
        "forgotten.frag: warning: nothing draws this file, since no line of it says //@pass",
        "begin it with the line `//@pass forgotten to=picture`",
        "spaced.frag:1:1: warning: nothing draws this file: this line is a comment",
        "alone.vert: warning: nothing draws with this file, since there is no passes/alone.frag",
        "`//@pass alone draw=model to=picture`",
        "begin it with the line `//@pass lone`",
    ];
    for told_by in [render(&tree, &["--env", "none"]), check(&tree)] {
        let stderr = &told_by.expect(0, &told).stderr;
        assert_eq!(stderr.matches("forgotten.frag: warning").count(), 1, "{stderr}");
        assert_eq!(stderr.matches(": warning: ").count(), 4, "{stderr}");
    }
    // A file that a stage includes is in use.
    tree.write("passes/shared.frag", "float half_of(float x) { return 0.5 * x; }\n");
    tree.write(
        "passes/forgotten.frag",
        &format!("//@pass forgotten to=picture\n{}", body.replace("void", "#include \"shared.frag\"\nvoid")),
    );
    let stderr = render(&tree, &["--env", "none"]).expect(0, &[]).stderr.clone();
    assert!(!stderr.contains("shared.frag") && !stderr.contains("forgotten.frag"), "{stderr}");
}

#[test]
fn a_background_of_ones_own_that_is_not_shown_is_told() {
    let tree = Tree::new();
    let hint = "shaders/user/background.glsl changes the background, which `--background env` shows";
    let stderr = render(&tree, &[]).expect(0, &[]).stderr.clone();
    assert!(!stderr.contains("hint"), "{stderr}");
    let own = tree.edited("user/background.glsl", "return ", "return 0.5 * ");
    tree.write("user/background.glsl", &own);
    render(&tree, &[]).expect(0, &[hint]);
    for more in [&["--background", "env"][..], &["--env", "none"], &["--set", "passes.background=false"]] {
        let stderr = render(&tree, more).expect(0, &[]).stderr.clone();
        assert!(!stderr.contains("hint"), "{more:?}: {stderr}");
    }
}

#[test]
fn annotations_mark_the_wrong_word() {
    let tree = Tree::new();
    let body = "#version 460\n#include \"pass.glsl\"\nvoid main() { color = vec4(1.0); }\n";
    for (annotation, told, marked) in [
        ("//@pass glow to=picture after=tonemapp", "no pass is named `tonemapp`. Did you mean `tonemap`?", "tonemapp"),
        ("//@pass Glow to=picture", "found `Glow`. Did you mean `glow`?", "Glow"),
        ("//@pass 9glow to=picture", "a letter a-z and then a-z, 0-9 or _; found `9glow`", "9glow"),
        ("//@pass", "found the end of the line", ""),
        ("//@pass glow to=", "expected a value after `to=`", ""),
        ("//@pass glow mipz", "found `mipz`. Did you mean `mips`?", "mipz"),
        ("//@pass glow size=-1", "found `-1`", "-1"),
        ("//@pass glow size=99999999999x1", "found `99999999999x1`", "99999999999x1"),
        ("//@pass glow also=tonemap", "`tonemap` is given twice", "tonemap"),
        ("//@pass glow when=GLOWS", "no constant with //@ui is named `GLOWS`", "GLOWS"),
        ("//@pass glow\n//@texture t \"\"", "expected the name of the image's file in the quotes", "\"\""),
        ("//@pass glow\n//@texture t t.png", "expected the image's file in quotes, found `t.png`", "t.png"),
        ("//@pass glow\n//@texture t \"t.png\" layers=-3", "found `-3`", "-3"),
        ("//@pass glow\n//@buffer B 64", "a buffer needs no annotation", "//@buffer"),
        ("//@pass \"Glow\" to=picture", "found `\"Glow\"`", "\"Glow\""),
    ] {
        tree.write("passes/glow.frag", &format!("{annotation}\n{body}"));
        let stderr = render(&tree, &["--env", "none"]).expect(1, &[told]).stderr.clone();
        let line = annotation.lines().last().unwrap();
        let column = if marked.is_empty() { line.len() } else { line.rfind(marked).unwrap() };
        let carets = format!("| {}{}\n", " ".repeat(column), "^".repeat(marked.len().max(1)));
        assert!(stderr.contains(&format!("{line}\n")) && (stderr.clone() + "\n").contains(&carets), "{stderr}");
    }
}
