//! Several models side by side, by the command line and in pictures.

use std::path::Path;

use serde_json::json;

use crate::support::process::{Finished, run};
use crate::support::{glb, open_image};

/// Quads of one color, seen from the front.
fn write(folder: &Path, name: &str, color: [f32; 3]) {
    let [r, g, b] = color;
    let material = json!({ "name": name, "pbrMetallicRoughness": { "baseColorFactor": [r, g, b, 1.0] } });
    std::fs::write(folder.join(format!("{name}.glb")), glb::model(&glb::quad(1.0), &material)).unwrap();
}

/// Renders the base colors of these models to `out.png`.
fn render(folder: &Path, args: &[&str]) -> Finished {
    let all = ["render", "--mode", "base-color", "--env", "none", "--size", "96x32", "--validate", "--out", "out.png"];
    run(folder, &[&all[..], args].concat())
}

/// How many red and how many green pixels a picture has, and the mean column of each.
fn colors(folder: &Path) -> [(usize, f32); 2] {
    let picture = open_image(&folder.join("out.png")).into_rgba8();
    [0, 1].map(|channel| {
        let of = picture.enumerate_pixels().filter(|(_, _, pixel)| pixel[channel] > 200 && pixel[1 - channel] < 50);
        let columns: Vec<f32> = of.map(|(x, _, _)| x as f32).collect();
        (columns.len(), columns.iter().sum::<f32>() / columns.len().max(1) as f32)
    })
}

#[test]
fn each_model_stands_beside_the_one_before_and_is_moved_by_itself() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    write(folder, "red", [1.0, 0.0, 0.0]);
    write(folder, "green", [0.0, 1.0, 0.0]);
    let front = ["--eye", "1.2,0,8", "--target", "1.2,0,0"];
    let both = ["red.glb", "green.glb"];
    render(folder, &[&both[..], &front].concat()).expect(0, &[]);
    let [red, green] = colors(folder);
    assert!(red.0 > 100 && red.0.abs_diff(green.0) < red.0 / 10, "{red:?} {green:?}");
    assert!(red.1 < 44.0 && green.1 > 52.0, "{red:?} {green:?}");
    // All of it is framed.
    render(folder, &both).expect(0, &[]);
    let framed = colors(folder);
    assert!(framed.iter().all(|color| color.0 > 100), "{framed:?}");
    // The place of the second, and of the first.
    let smaller = [&both[..], &front, &["--set", "added.0.place.scale=0.5"]].concat();
    render(folder, &smaller).expect(0, &[]);
    let after = colors(folder);
    assert!(after[0] == red && after[1].0.abs_diff(green.0 / 4) < green.0 / 10, "{after:?}");
    let apart = [&both[..], &front, &["--set", "model.translation=-1,0,0"]].concat();
    render(folder, &apart).expect(0, &[]);
    let after = colors(folder);
    assert!(after[0].1 < red.1 - 3.0 && after[1] == green, "{after:?}");
    // A model as a part of the scene: hidden by its name.
    render(folder, &[&both[..], &front, &["--set", "scene.hidden=green"]].concat()).expect(0, &[]);
    let after = colors(folder);
    assert!(after[0] == red && after[1].0 == 0, "{after:?}");
    let info = run(folder, &["info", "red.glb", "green.glb", "red.glb", "--json"]).json();
    assert_eq!(info["model"]["model"], "red + green + red", "{info}");
}

#[test]
fn a_picture_holds_all_models_and_a_missing_one_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    write(folder, "red", [1.0, 0.0, 0.0]);
    write(folder, "green", [0.0, 1.0, 0.0]);
    render(folder, &["red.glb", "green.glb", "--set", "added.0.place.scale=0.5"]).expect(0, &[]);
    let both = colors(folder);
    std::fs::rename(folder.join("out.png"), folder.join("both.png")).unwrap();
    let moved = folder.join("moved");
    std::fs::create_dir(&moved).unwrap();
    for name in ["red.glb", "green.glb", "both.png"] {
        std::fs::rename(folder.join(name), moved.join(name)).unwrap();
    }
    render(folder, &["--look", "moved/both.png"]).expect(0, &[]);
    assert_eq!(colors(folder), both);
    // Another model takes the place of all.
    render(folder, &["moved/red.glb", "--look", "moved/both.png"]).expect(0, &[]);
    let [red, green] = colors(folder);
    assert!(red.0 > 100 && green.0 == 0, "{red:?} {green:?}");
    render(folder, &["moved/red.glb", "nowhere.glb"]).expect(1, &["nowhere.glb", "no such file"]);
    std::fs::write(folder.join("bad.glb"), b"").unwrap();
    render(folder, &["moved/red.glb", "bad.glb"]).expect(1, &["bad.glb", "is empty"]);
    render(folder, &["moved/red.glb", "sky.hdr"]).expect(2, &["sky.hdr", "--env"]);
}
