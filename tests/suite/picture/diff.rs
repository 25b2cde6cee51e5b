//! `specula diff` as a process: printed lines, JSON, maps and exit codes.

use std::fs;
use std::path::Path;

use crate::support::process::{Finished, run};
use image::{Rgb32FImage, Rgba, Rgba32FImage, RgbaImage};
use serde_json::json;
use tempfile::TempDir;

const SIDE: u32 = 32;

fn directory() -> TempDir {
    tempfile::tempdir().unwrap()
}

/// Writes a gray picture with a 4 x 4 square of another color at 8,16.
fn png(folder: &Path, name: &str, square: [u8; 4]) {
    let inside = |x: u32, y: u32| (8..12).contains(&x) && (16..20).contains(&y);
    let color = |x, y| Rgba(if inside(x, y) { square } else { [128, 128, 128, 255] });
    fs::create_dir_all(folder).unwrap();
    RgbaImage::from_fn(SIDE, SIDE, color).save(folder.join(name)).unwrap();
}

/// Writes a picture of 2 everywhere with alpha 1, except for the red value at 3,5.
fn exr(folder: &Path, name: &str, red: f32) {
    let color = |x, y| Rgba([if (x, y) == (3, 5) { red } else { 2.0 }, 2.0, 2.0, 1.0]);
    Rgba32FImage::from_fn(SIDE, SIDE, color).save(folder.join(name)).unwrap();
}

fn diff(folder: &Path, args: &[&str]) -> Finished {
    run(folder, &[&["diff"], args].concat())
}

#[test]
fn the_same_picture() {
    let folder = directory();
    let here = folder.path();
    png(here, "a.png", [200, 0, 0, 255]);
    png(here, "b.png", [200, 0, 0, 255]);
    let told = diff(here, &["a.png", "b.png"]);
    told.expect(0, &[]);
    assert_eq!(told.stdout.split_whitespace().collect::<Vec<_>>(), ["same", "b.png"]);
}

#[test]
fn what_an_eye_sees_and_where() {
    let folder = directory();
    let here = folder.path();
    png(here, "a.png", [128, 128, 128, 255]);
    png(here, "b.png", [230, 128, 128, 255]);
    let told = diff(here, &["a.png", "b.png", "--json", "--out", "map.png"]);
    told.expect(1, &[]);
    let found = &told.json()["pictures"][0];
    assert_eq!((&found["measure"], &found["differing"], &found["pixels"]), (&json!("flip"), &json!(16), &json!(1024)));
    assert_eq!((&found["largest_at"], &found["passes"]), (&json!([8, 16]), &json!(false)));
    assert!((found["largest"].as_f64().unwrap() - 102.0 / 255.0).abs() < 1e-6, "{found}");
    let error = found["error"].as_f64().unwrap();
    assert!(error > 0.002 && error < 0.2, "{error}");
    // The map is bright in the square and black far from it.
    let map = image::open(here.join("map.png")).unwrap().into_rgb8();
    let sum = |x, y| map.get_pixel(x, y).0.iter().map(|c| u32::from(*c)).sum::<u32>();
    assert!(sum(9, 17) > 250 && sum(30, 2) < 20, "{} {}", sum(9, 17), sum(30, 2));
    // Only the limit determines the exit code.
    let limit = |max: f64| diff(here, &["a.png", "b.png", "--max", &max.to_string()]);
    limit(error * 1.01).expect(0, &[]);
    limit(error * 0.99).expect(1, &[]);
}

#[test]
fn alpha_alone_and_one_step_are_differences() {
    let folder = directory();
    let here = folder.path();
    png(here, "a.png", [128, 128, 128, 255]);
    png(here, "step.png", [129, 128, 128, 255]);
    // Over middle gray the difference would not be visible.
    png(here, "clear.png", [128, 128, 128, 0]);
    for other in ["step.png", "clear.png"] {
        let told = diff(here, &["a.png", other]);
        told.expect(1, &[]);
        assert!(told.stdout.contains("16 of 1024 pixels differ"), "{told:?}");
        diff(here, &["a.png", other, "--max", "0.01"]).expect(0, &[]);
    }
}

#[test]
fn raw_pictures_are_compared_as_numbers() {
    let folder = directory();
    let here = folder.path();
    exr(here, "a.exr", 2.0);
    exr(here, "b.exr", 10.0);
    let told = diff(here, &["a.exr", "b.exr", "--json", "--out", "map.exr"]);
    told.expect(1, &[]);
    let found = &told.json()["pictures"][0];
    // One of 4 x 1024 values differs by 8.
    assert!((found["error"].as_f64().unwrap() - 8.0 / 64.0).abs() < 1e-9, "{found}");
    assert_eq!((&found["measure"], &found["largest"]), (&json!("rmse"), &json!(8.0)));
    assert_eq!((&found["largest_at"], &found["differing"]), (&json!([3, 5]), &json!(1)));
    let map: Rgb32FImage = image::open(here.join("map.exr")).unwrap().into_rgb32f();
    assert_eq!((map.get_pixel(3, 5).0, map.get_pixel(4, 5).0), ([8.0, 0.0, 0.0], [0.0; 3]));
}

#[test]
fn nan_passes_no_limit_but_is_itself() {
    let folder = directory();
    let here = folder.path();
    exr(here, "a.exr", 2.0);
    exr(here, "nan.exr", f32::NAN);
    exr(here, "infinite.exr", f32::INFINITY);
    for other in ["nan.exr", "infinite.exr"] {
        diff(here, &["a.exr", other, "--max", "1e30"]).expect(1, &[]);
        diff(here, &[other, "a.exr", "--max", "1e30"]).expect(1, &[]);
        diff(here, &[other, other]).expect(0, &[]);
    }
}

#[test]
fn folders_by_name() {
    let folder = directory();
    let (a, b) = (folder.path().join("a"), folder.path().join("b"));
    for side in [&a, &b] {
        png(side, "same.png", [0, 0, 0, 255]);
        fs::write(side.join("notes.txt"), "no picture").unwrap();
    }
    png(&a, "other.png", [128, 128, 128, 255]);
    png(&b, "other.png", [255, 128, 128, 255]);
    png(&b, "new.png", [0, 0, 0, 255]);
    let told = diff(folder.path(), &["a", "b", "--out", "maps"]);
    told.expect(1, &["2 of 3 pictures fail at --max 0"]);
    let lines: Vec<&str> = told.stdout.lines().collect();
    assert!(lines.len() == 3 && lines[0].contains("new.png  only in b"), "{lines:?}");
    assert!(lines[1].contains("other.png  FLIP") && lines[2].starts_with("same "), "{lines:?}");
    let maps: Vec<_> = fs::read_dir(folder.path().join("maps")).unwrap().map(|e| e.unwrap().file_name()).collect();
    assert_eq!(maps, ["other.png"]);
    // A missing picture exceeds every limit.
    diff(folder.path(), &["a", "b", "--max", "1"]).expect(1, &["1 of 3"]);
    fs::remove_file(b.join("new.png")).unwrap();
    diff(folder.path(), &["a", "b", "--max", "1"]).expect(0, &[]);
    // The worst comes first, and what is the same is only counted.
    for side in [&a, &b] {
        png(side, "equal.png", [7, 7, 7, 255]);
    }
    png(&a, "worst.png", [0, 0, 0, 255]);
    png(&b, "worst.png", [255, 255, 255, 255]);
    let told = diff(folder.path(), &["a", "b"]);
    let lines: Vec<&str> = told.stdout.lines().collect();
    assert!(lines.len() == 3 && lines[0].contains("worst.png") && lines[1].contains("other.png"), "{lines:?}");
    assert_eq!(lines[2].split_whitespace().collect::<Vec<_>>(), ["same", "2", "pictures"]);
}

#[test]
fn what_cannot_be_compared_is_told() {
    let folder = directory();
    let here = folder.path();
    png(here, "a.png", [0, 0, 0, 255]);
    exr(here, "a.exr", 0.0);
    RgbaImage::new(SIDE, SIDE + 1).save(here.join("tall.png")).unwrap();
    fs::write(here.join("text.png"), "no picture").unwrap();
    fs::create_dir(here.join("empty")).unwrap();
    for (code, args, part) in [
        (1, &["a.png", "tall.png"][..], "32x32 and 32x33 pixels"),
        (1, &["a.png", "a.exr"], "cannot be compared"),
        (1, &["a.png", "text.png"], "cannot read text.png"),
        (1, &["a.png", "none.png"], "none.png: there is no such file"),
        (2, &["a.png", "a.png", "--max", "-1"], "expected 0 or more"),
        (2, &["a.png", "a.png", "--out", "./a.png"], "would overwrite"),
        (2, &["a.png", "empty"], "a folder and a file"),
        (1, &["empty", "empty"], "no .png or .exr in empty"),
        (2, &["a.png", "a.png", "--max", "nan"], "expected 0 or more"),
        (2, &["a.png", "a.png", "--out", "map.exr"], "ends in .png"),
        (1, &["a.png", "a.png", "--out", "nowhere/map.png"], "cannot write nowhere/map.png"),
    ] {
        diff(here, args).expect(code, &[part]);
    }
}

/// The page is one file with all pictures, the worst first, and a channel has a limit of its own.
#[test]
fn a_report_and_a_limit_for_a_channel() {
    let folder = directory();
    let here = folder.path();
    for (name, values) in [("a", [100, 100]), ("b", [101, 160])] {
        let [near, far] = values.map(|value| [value, 100, 100, 255]);
        png(&here.join(name), "near.png", near);
        png(&here.join(name), "far.png", far);
    }
    let told = diff(here, &["a", "b", "--max", "1", "--max-channel", "0.1", "--report", "out.html"]);
    told.expect(1, &["1 of 2 pictures fail at --max 1 --max-channel 0.1"]);
    diff(here, &["a", "b", "--max", "1", "--max-channel", "0.3"]).expect(0, &[]);
    let page = fs::read_to_string(here.join("out.html")).unwrap();
    assert!(!page.contains("://") && page.contains("data:image/png;base64,"), "it is not in one file");
    let data = page.split("id=\"data\">").nth(1).unwrap().split("</script>").next().unwrap();
    let data: serde_json::Value = serde_json::from_str(data).unwrap();
    let rows: Vec<_> =
        data["pairs"].as_array().unwrap().iter().map(|pair| (pair["name"].clone(), pair["passes"].clone())).collect();
    assert_eq!(rows, [(json!("far.png"), json!(false)), (json!("near.png"), json!(true))]);
    for wrong in [&["--max-channel", "-1"][..], &["--report", "a/near.png"]] {
        let told = diff(here, &[&["a/near.png", "b/near.png"], wrong].concat());
        assert_eq!(told.code, Some(2), "{told:?}");
    }
}
