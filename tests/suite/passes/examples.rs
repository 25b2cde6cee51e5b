//! The examples: each compiles without a message, changes the picture, and is drawn the same at each run.

use crate::support::process::run;
use crate::support::{
    SIZE, assert_differ, assert_same, assert_validated, compiler, gpu, lines, model, render, settings,
};
use specula::headless::{Headless, HeadlessError, Sequence};
use specula::render::Capture;
use specula::shader::embedded::Example;
use specula::shader::{Library, Source, check};

fn draw_with(more: &[&str], example: Option<Example>, frames: u32) -> Capture {
    render(&mut open(more, example, frames), "final")
}

fn open(more: &[&str], example: Option<Example>, frames: u32) -> Headless {
    let ball = model("shader-ball");
    let settings = settings(&[&["view.msaa=1"], more].concat());
    let opened = Headless::new(gpu(), compiler(), Source::example(example), ball, settings, SIZE);
    let Ok((mut headless, _)) = opened else { panic!("an example does not open") };
    headless.set_sequence(Sequence { frames, start_s: 1.0, fps: 10.0, ..Sequence::default() });
    headless
}

#[test]
fn examples_change_the_picture_and_repeat_themselves() {
    let plain = draw_with(&[], None, 1);
    let names = Example::names();
    assert_eq!(
        names,
        [
            "deferred",
            "displacement",
            "fluid",
            "fur",
            "hatching",
            "hull",
            "life",
            "meshlets",
            "normals",
            "particles",
            "raymarch",
            "reaction",
            "swarm",
            "toy"
        ]
    );
    for name in names {
        let example = Example::named(name);
        if name == "meshlets" && gpu().optional_stages().mesh.is_none() {
            assert_refused(example);
            continue;
        }
        let mut headless = open(&[], example, 8);
        let [first, second] = [(); 2].map(|()| render(&mut headless, "final"));
        assert_differ(&plain, &first, name);
        assert_same(&first, &second, name);
        assert!(first.raw_at(SIZE.0 / 2, SIZE.1 / 2).unwrap().iter().all(|v| v.is_finite()), "{name}");
    }
    assert_validated();
}

/// Fails unless the device refuses the example, which has a mesh stage.
#[track_caller]
fn assert_refused(example: Option<Example>) {
    let (ball, source) = (model("shader-ball"), Source::example(example));
    match Headless::new(gpu(), compiler(), source, ball, settings(&["view.msaa=1"]), SIZE).map(|_| ()) {
        Err(HeadlessError::Shaders(told)) => {
            let told = lines(&told).join("\n");
            let expected =
                "meshlets.mesh:11:6: error: this device lacks VK_EXT_mesh_shader, which this mesh stage needs";
            assert!(told.contains(expected), "{told}");
            println!("the picture of the example `meshlets` is skipped: the device lacks VK_EXT_mesh_shader");
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn the_deferred_renderer_lights_as_the_model_pass_does() {
    // The gold in the middle, under a rim that hides a part of the sky.
    let radiance = |example: Option<Example>, more: &[&str]| {
        let capture = draw_with(more, example, 1);
        let (x, y) = (SIZE.0 / 2, SIZE.1 / 2);
        let pixels = (y - 8..y + 8).flat_map(|y| (x - 8..x + 8).map(move |x| (x, y)));
        pixels.map(|(x, y)| capture.raw_at(x, y).unwrap()[1]).sum::<f32>()
    };
    let deferred = Example::named("deferred");
    let mut before = f32::INFINITY;
    for more in [&["lights.source=none"][..], &["lights.source=none", "AMBIENT_OCCLUSION=true"]] {
        let (expected, found) = (radiance(None, more), radiance(deferred, more));
        assert!((found / expected - 1.0).abs() < 0.02, "{more:?}: {found}, not {expected}");
        assert!(expected < 0.98 * before, "{more:?} changes nothing");
        before = expected;
    }
}

#[test]
fn examples_pass_check() {
    for name in Example::names() {
        let stages = specula::frame::stages::stages();
        let mut library = Library::new(Source::example(Example::named(name)), compiler().clone(), &stages);
        let found = check::check(&mut library);
        assert!(found.is_empty(), "{name}: {}", lines(&found).join("\n"));
    }
}

#[test]
fn examples_are_found_by_name_on_the_command_line() {
    let folder = tempfile::tempdir().unwrap();
    let new = run(folder.path(), &["new", "mine", "--template", "life"]);
    assert!(new.expect(0, &[]).stdout.contains("specula --shaders mine, then edit a file in passes/"), "{new:#?}");
    assert!(folder.path().join("mine/passes/life.frag").is_file() && folder.path().join("mine/pbr.frag").is_file());
    let modes = run(folder.path(), &["modes", "--shaders", "examples:life"]);
    assert!(modes.expect(0, &[]).stdout.contains("pass:life"), "{modes:#?}");
    let wrong = run(folder.path(), &["modes", "--shaders", "examples:live"]);
    wrong.expect(
        1,
        &["there is no example `live`. Did you mean `life`? There are deferred, displacement, fluid, fur, hatching, hull, life"],
    );
    run(folder.path(), &["new", "other", "--template", "live"]).expect(1, &["there is no example `live`."]);
    assert!(!folder.path().join("other").exists(), "nothing is written");
}
