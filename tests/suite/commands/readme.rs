//! The snippets of README.md and shaders/README.md, saved into a tree, do what these pages say.

use crate::support::{Session, assert_differ, assert_same, model, passes_check, ready, settings};
use specula::scene::BUILT_IN;

/// The code of the first GLSL block that contains `part`, indented or not.
fn snippet(part: &str) -> String {
    let readmes = crate::support::readmes();
    let mut blocks = readmes.split("```glsl\n").skip(1).map(|rest| rest.split("```").next().unwrap());
    blocks.find(|block| block.contains(part)).unwrap_or_else(|| panic!("no README has a block with {part}")).to_owned()
}

fn session() -> Session {
    Session::new(model(BUILT_IN[0]), settings(&["environment.name=none"]))
}

/// Adds a member to `Params`.
fn declare(session: &mut Session, member: &str) {
    let params = session.tree.edited("user/params.glsl", "};", &format!("{}\n}};", member.trim_end()));
    ready(&session.save("user/params.glsl", &params));
}

#[test]
fn the_slider_of_the_readme() {
    let mut session = Session::new(model(BUILT_IN[0]), settings(&["environment.name=studio"]));
    let before = session.render();
    declare(&mut session, &snippet("//@ui \"Unsquared\""));
    let (ndf, squared) = ("brdf/ndf.glsl", "    float a2 = alpha * alpha;\n");
    let text = session.tree.edited(ndf, squared, &snippet("mix(alpha * alpha, alpha, unsquared)"));
    let last = "#include \"common/math.glsl\"\n";
    assert!(text.contains(last));
    ready(&session.save(ndf, &text.replace(last, &format!("{last}#include \"user/params.glsl\"\n"))));
    assert_same(&before, &session.render(), "at its default the slider changes nothing");
    let generation = session.headless.shaders().generation;
    session.set("unsquared=1.0");
    let unsquared = session.render();
    assert_differ(&before, &unsquared, "the slider reaches the picture");
    assert_eq!(session.headless.shaders().generation, generation, "moving a slider compiles nothing");
    passes_check(&session);
    ready(&session.edit(ndf, "mix(alpha * alpha, alpha, unsquared)", "alpha"));
    assert_same(&unsquared, &session.render(), "lamps and the light of the environment are those of the edit");
}

#[test]
fn the_hook_of_the_readme() {
    let mut session = session();
    let before = session.render();
    declare(&mut session, "    float snow; //@ui \"Snow\" 0..1 = 0.0");
    let hook = "void user_surface(inout Surface s, Fragment f, vec3 v) {";
    ready(&session.edit("user.glsl", hook, &format!("{hook}\n{}", snippet("snow * smoothstep"))));
    assert_same(&before, &session.render(), "without snow");
    session.set("snow=1.0");
    assert_differ(&before, &session.render(), "snow");
    passes_check(&session);
}

#[test]
fn the_debug_mode_of_the_readme() {
    let mut session = session();
    let modes = session.tree.read("debug/modes.glsl");
    let at = modes.find("bool your_mode(").unwrap();
    ready(&session.save("debug/modes.glsl", &format!("{}{}\n#endif\n", &modes[..at], snippet("MODE_HEIGHT"))));
    let (height, position) = (session.mode("height"), session.mode("position"));
    let inside = position.raw.iter().zip(&height.raw).filter(|(p, h)| p[3] == 1.0 && h[3] == 1.0);
    let mut count = 0;
    for (position, height) in inside {
        let expected = (position[1] * 4.0).rem_euclid(1.0);
        // Multisampling averages across the edges of bands, so those pixels do not match a band.
        count += usize::from((height[0] - expected).abs() < 0.02);
    }
    assert!(count > 200, "only {count} pixels show their height in bands of 25 cm");
    passes_check(&session);
}

#[test]
fn the_edit_of_the_readme() {
    let mut session = session();
    let before = session.render();
    ready(&session.edit("brdf/ndf.glsl", "float a2 = alpha * alpha;", "float a2 = alpha;"));
    assert_differ(&before, &session.render(), "the roughness forgot to be squared");
}

#[test]
fn the_geometry_stage_of_the_readme() {
    let mut session = session();
    let before = session.render();
    ready(&session.save("passes/glow.frag", &snippet("//@pass glow")));
    let glow = session.render();
    assert_differ(&before, &glow, "the glow");
    ready(&session.save("passes/glow.geom", &snippet("model.geom.glsl")));
    assert_differ(&glow, &session.render(), "the glow, taken apart");
    passes_check(&session);
}

/// It compiles and fits the pass of the page. `shaders/stages.rs` draws the same stage, where the device can.
#[test]
fn the_mesh_stage_of_the_readme() {
    let session = session();
    session.tree.write("passes/glow.frag", &snippet("//@pass glow"));
    session.tree.write("passes/glow.mesh", &snippet("model.mesh.glsl"));
    passes_check(&session);
}

#[test]
fn the_parameters_and_constants_of_the_shader_readme() {
    let mut session = session();
    let before = session.render();
    let params = session.tree.edited("user/params.glsl", "};", &format!("{}\n}};", snippet("dust_size").trim_end()));
    ready(&session.save("user/params.glsl", &params));
    let hook = "void user_surface(inout Surface s, Fragment f, vec3 v) {";
    let user = session.tree.edited("user.glsl", hook, &format!("{}\n{hook}", snippet("PATTERN = 0u")));
    let body =
        "if (INVERT) s.base_color = 1.0 - s.base_color;\n    s.emissive += float(PATTERN) * dust_size * dust_color;";
    ready(&session.save("user.glsl", &user.replace(hook, &format!("{hook}\n    {body}"))));
    assert_same(&before, &session.render(), "at their defaults they change nothing");
    session.set("INVERT=true");
    let inverted = session.render();
    assert_differ(&before, &inverted, "the switch");
    session.set("PATTERN=Dots");
    let dots = session.render();
    assert_differ(&inverted, &dots, "the choice");
    session.set("dust_color=0,0,1");
    assert_differ(&dots, &session.render(), "the color");
    passes_check(&session);
}
