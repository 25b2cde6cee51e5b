//! Models that move on the command line: `--animation`, `--time`, frames of a video, turntables, and what `info` tells of them.

use std::path::Path;

use crate::support::process::{Finished, run};
use crate::support::{glb, open_image};
use image::codecs::gif::GifDecoder;
use image::{AnimationDecoder as _, RgbaImage};
use serde_json::json;

fn write_model(path: &Path) {
    std::fs::write(path.join("moving.glb"), glb::moving_quad()).unwrap();
}

/// Arguments of a picture of 4 m by 4 m that is fast.
const QUICK: &str = "render moving.glb --mode base-color --background none --env none --lights none --set view.msaa=1 --size 80x80 \
                     --set camera.height=4 --eye 0,0,9 --target 0,0,0 --out";

fn render(path: &Path, out: &str, args: &str) -> Finished {
    let words: Vec<&str> = QUICK.split_whitespace().chain([out]).chain(args.split_whitespace()).collect();
    run(path, &words)
}

/// The center of what covers the picture, meters.
fn center(picture: &RgbaImage) -> [f64; 2] {
    let covered = || picture.enumerate_pixels().filter(|(_, _, pixel)| pixel[3] > 127);
    let count = covered().count() as f64;
    assert!((300.0..500.0).contains(&count), "{count} pixels of a square of 20 pixels");
    let (x, y) = covered().fold((0.0, 0.0), |(x, y), (at_x, at_y, _)| (x + f64::from(at_x), y + f64::from(at_y)));
    [(x / count + 0.5 - 40.0) / 20.0, (40.0 - 0.5 - y / count) / 20.0]
}

#[track_caller]
fn is_at(picture: &RgbaImage, expected: [f64; 2]) {
    let found = center(picture);
    let apart = (found[0] - expected[0]).hypot(found[1] - expected[1]);
    assert!(apart < 0.06, "the square is at {found:?}, expected {expected:?}");
}

#[test]
fn clips_are_chosen_mixed_and_played_by_the_time() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path();
    write_model(path);
    for (args, expected) in [
        ("", [-1.0, 0.0]),
        ("--time 0.75", [0.5, 0.0]),
        ("--time 2.25", [-0.5, 0.0]),
        ("--time 2.25 --set animation.loop=false", [1.0, 0.0]),
        ("--time 0.5 --set animation.speed=0.5", [-0.5, 0.0]),
        ("--set animation.time=0.5", [0.0, 0.0]),
        ("--frames 4 --fps 4", [0.5, 0.0]),
        ("--animation none", [0.0, 0.0]),
        ("--animation jump --time 0.3", [0.0, 1.0]),
        ("--animation 1", [0.0, 1.0]),
        ("--animation go --animation jump:0.5 --time 0.5", [0.0, 0.5]),
        ("--animation all", [0.0, 1.0]),
        ("--time 0.75 --set model.translation=1,0,0", [1.5, 0.0]),
    ] {
        render(path, "a.png", args).expect(0, &[]);
        is_at(&open_image(&path.join("a.png")).into_rgba8(), expected);
    }
    render(path, "a.png", "--time 0.4").expect(0, &[]);
    render(path, "b.png", "--time 0.4").expect(0, &[]);
    assert!(std::fs::read(path.join("a.png")).unwrap() == std::fs::read(path.join("b.png")).unwrap());
    render(path, "a.png", "--animation jmp").expect(2, &["no animation 'jmp'", "go, jump", "Did you mean"]);
}

#[test]
fn frames_and_turntables_move() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path();
    write_model(path);
    render(path, "a.gif", "--frames 4 --fps 4").expect(0, &[]);
    let file = std::io::BufReader::new(std::fs::File::open(path.join("a.gif")).unwrap());
    let frames = GifDecoder::new(file).unwrap().into_frames().collect_frames().unwrap();
    assert_eq!(frames.len(), 4);
    for (index, frame) in frames.iter().enumerate() {
        is_at(frame.buffer(), [-1.0 + 0.5 * index as f64, 0.0]);
    }
    render(path, "turn.png", "--turntable 3 --turn light --fps 4").expect(0, &[]);
    for (index, time) in ["0", "0.25", "0.5"].iter().enumerate() {
        render(path, "still.png", &format!("--time {time}")).expect(0, &[]);
        let turned = open_image(&path.join(format!("turn.{:04}.png", index + 1))).into_rgba8();
        assert!(turned == open_image(&path.join("still.png")).into_rgba8(), "frame {index}");
    }
}

#[test]
fn info_lists_what_moves() {
    let directory = tempfile::tempdir().unwrap();
    write_model(directory.path());
    let info = run(directory.path(), &["info", "moving.glb", "--json"]).json();
    let clip = |name: &str| json!({ "name": name, "duration_s": 1.0, "channels": 1, "switched_nodes": 0 });
    let expected = json!({ "clips": [clip("go"), clip("jump")], "skins": [], "targets": [], "cameras": [] });
    assert_eq!(info["model"]["motion"], expected);
    let text = run(directory.path(), &["info", "moving.glb"]).stdout;
    assert!(text.contains("animations  2: go, jump\n    go: 1.000 s, 1 channel\n"), "{text}");
}
