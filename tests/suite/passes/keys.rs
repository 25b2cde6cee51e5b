//! Keys and the date as an input of shaders.

use crate::support::process::run;
use crate::support::{SIZE, Session, assert_validated, glb, load, ready, settings};
use specula::frame::Keys;
use specula::headless::Sequence;

/// A gray sphere and a pass that covers it with this color.
fn session(color: &str) -> Session {
    let model = load(&glb::model(&glb::sphere(8, 16), &glb::gray()));
    let mut session = Session::new(model, settings(&["view.msaa=1", "environment.name=none"]));
    ready(&session.save("passes/keys.frag", &pass("keys to=picture after=tonemap", "", color)));
    session
}

fn pass(annotation: &str, uniforms: &str, color: &str) -> String {
    let head = format!("//@pass {annotation}\n#version 460\n#include \"pass.glsl\"\n{uniforms}\n");
    format!("{head}void main() {{ color = vec4({color}, 1.0); }}\n")
}

/// The first pixel of the last of `frames` frames in which these keys are down.
fn shown(session: &mut Session, keys: &str, frames: u32) -> [u8; 3] {
    let keys = if keys.is_empty() { Keys::default() } else { keys.parse().unwrap() };
    session.headless.set_sequence(Sequence { frames, keys, ..Sequence::default() });
    session.render().rgba8[..3].try_into().unwrap()
}

#[test]
fn a_pass_reads_keys() {
    let mut session = session("key_down(KEY_LEFT), key_pressed(KEY_SPACE), key_toggled(KEY_QUOTE)");
    assert_eq!(shown(&mut session, "", 1), [0, 0, 0]);
    assert_eq!(shown(&mut session, "Left", 1), [255, 0, 0]);
    assert_eq!(shown(&mut session, "Left,Space,Quote", 1), [255, 255, 255]);
    assert_eq!(shown(&mut session, "Left,Space,Quote", 3), [255, 0, 255], "pressed in the first frame only");
    assert_eq!(shown(&mut session, "A,Right", 1), [0, 0, 0]);
    assert!(!session.headless.is_animated().unwrap(), "keys are no animation");
    // No number reaches beyond the keys.
    ready(
        &session.save("passes/keys.frag", &pass("keys to=picture after=tonemap", "", "vec3(key_down(256u + KEY_A))")),
    );
    assert_eq!(shown(&mut session, "A", 1), [0, 0, 0]);
}

#[test]
fn the_model_reads_keys() {
    let mut session = session("vec3(0.0)");
    session.set("passes.keys=false");
    let center = |session: &mut Session, keys: &str| {
        shown(session, keys, 1);
        session.render().raw_at(SIZE.0 / 2, SIZE.1 / 2).unwrap()[0]
    };
    let hook = "void user_surface(";
    let text = session.tree.edited("user.glsl", hook, &format!("#include \"common/keys.glsl\"\n\n{hook}"));
    session.tree.write("user.glsl", &text);
    let at = text.find(hook).and_then(|at| Some(at + text[at..].find('{')? + 1)).unwrap();
    let edited = format!("{}\n    if (key_down(KEY_W)) s.emissive = vec3(7.0);{}", &text[..at], &text[at..]);
    ready(&session.save("user.glsl", &edited));
    let (without, with) = (center(&mut session, ""), center(&mut session, "W"));
    assert!(with > without + 5.0, "{without} {with}");
}

/// The image of a pass that reads keys is kept until one of them changes; that of a pass that reads none stays.
#[test]
fn kept_passes_notice_keys() {
    let mut session = session("vec3(0.0)");
    let uniforms = "uniform sampler2D reads;\nuniform sampler2D other;";
    ready(&session.save("passes/reads.frag", &pass("reads size=2x2", "", "vec3(key_down(KEY_A))")));
    ready(
        &session.save("passes/other.frag", &pass("other size=2x2", "", "frame.light_clip_from_world[0][0].xyz * 0.0")),
    );
    let color = "texture(reads, uv).rgb + texture(other, uv).rgb";
    ready(&session.save("passes/keys.frag", &pass("keys to=picture after=tonemap", uniforms, color)));
    let kept = |session: &Session| {
        ["reads", "other"].map(|name| session.headless.pass_times().iter().find(|pass| pass.name == name).unwrap().kept)
    };
    assert_eq!(shown(&mut session, "", 1), [0; 3]);
    assert_eq!(shown(&mut session, "", 1), [0; 3]);
    assert_eq!(kept(&session), [true, true]);
    assert_eq!(shown(&mut session, "A", 1), [255; 3]);
    assert_eq!(kept(&session), [false, true]);
    assert_eq!(shown(&mut session, "A,B", 1), [255; 3]);
    assert_eq!(shown(&mut session, "", 1), [0; 3]);
    assert_validated();
}

#[test]
fn the_date_is_an_animation() {
    let mut session = session("frame.date.x / 2550.0, frame.date.yz / 255.0");
    let date = "2040-11-23T16:00:00".parse().unwrap();
    session.headless.set_sequence(Sequence { date, ..Sequence::default() });
    assert_eq!(session.render().rgba8[..3], [204, 10, 23]);
    assert!(session.headless.is_animated().unwrap());
}

/// A tree of before there were keys ends the block with the views of lights. Reading them is no animation.
#[test]
fn an_older_tree_reads_what_it_declares() {
    let mut session = session("vec3(0.0)");
    let text = session.tree.read("interface.glsl");
    let (before, rest) = text.split_once("    vec4 date;").unwrap();
    let (_, after) = rest.split_once("\n} frame;").unwrap();
    session.tree.write("interface.glsl", &format!("{}\n}} frame;{after}", before.trim_end()));
    session.tree.write("common/keys.glsl", "");
    // Nor did its tone map know ranges, and its modes numbers.
    session.tree.write(
        "common/range.glsl",
        "bool has_range() { return false; }\nvec3 in_range(vec3 value) { return value; }\n\
         vec3 chosen_channels(vec3 value, float coverage) { return value; }\n\
         vec3 color_of_number(float t) { return vec3(t); }\nfloat dither_noise(vec2 pixel) { return 0.0; }\n",
    );
    let tonemap = session.tree.edited("tonemap.frag", "frame.has_colormap != 0u", "false");
    session.tree.write("tonemap.frag", &tonemap);
    let modes = session.tree.edited("debug/modes.glsl", "frame.gives_numbers != 0u", "false");
    session.tree.write("debug/modes.glsl", &modes);
    let files = ["interface.glsl", "common/keys.glsl", "common/range.glsl", "tonemap.frag", "debug/modes.glsl"];
    ready(&session.changed(&files));
    let reads = "frame.light_clip_from_world[int(pass.size_px.x) % 2][0].xyz";
    ready(&session.save("passes/keys.frag", &pass("keys to=picture after=tonemap", "", reads)));
    assert!(!session.headless.is_animated().unwrap());
}

#[test]
fn names_of_keys_are_checked() {
    let folder = tempfile::tempdir().unwrap();
    run(folder.path(), &["render", "--keys", "A,Rihgt"])
        .expect(2, &["--keys", "no key is named `Rihgt`. Did you mean `Right`?"]);
    run(folder.path(), &["render", "--keys", ""]).expect(2, &["--keys"]);
}
