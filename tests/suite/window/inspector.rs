//! The inspector: a click pins a pixel, whose values are those of `specula probe`; an edit changes them; Esc unpins.

use image::RgbaImage;
use serde_json::Value;

use super::NDF;
use super::controls::{ACCENT, ERROR, choose, is_about};
use crate::support::process::run;
use crate::support::window::Viewer;
use crate::support::{Tree, line_of};

/// The place of the clicked pixel in the window: on the model, left of all panels.
const AT: (u32, u32) = (420, 330);
/// The mark in the picture covers this pixel of the window, right of the clicked one.
const MARK: (u32, u32) = (AT.0 + 5, AT.1);
/// The button that shows the page BRDF.
const BRDF: (u32, u32) = (760, 108);

/// The button that shows the page Values.
const VALUES: (u32, u32) = (715, 108);

/// Whether the row under the buttons of the pages has the color of errors.
fn has_red_text(screen: &RgbaImage) -> bool {
    (690..980).any(|x| (140..170).any(|y| is_about(screen.get_pixel(x, y), ERROR)))
}

fn numbers(value: &Value) -> Vec<f64> {
    value
        .as_array()
        .unwrap_or_else(|| panic!("no array: {value}"))
        .iter()
        .map(|number| number.as_f64().unwrap())
        .collect()
}

#[test]
fn a_click_pins_a_pixel_whose_values_are_those_of_probe_and_follow_edits() {
    let mut viewer = Viewer::open(Tree::new(), &["--size", "1000x700", "shader-ball", "--set", "lights.chosen=2"]);
    viewer.running.event("ready");
    choose(&viewer, "panel inspector");
    let before = viewer.screenshot();
    viewer.click(AT);
    let found = viewer.running.event("inspected");
    assert_eq!((&found["hit"], &found["generation"]), (&true.into(), &1.into()), "{found}");
    assert!(found["node"].is_string() && found["material"].is_string(), "{found}");
    viewer.until_screen("the mark", |screen| is_about(screen.get_pixel(MARK.0, MARK.1), ACCENT));
    assert!(viewer.screenshot() == before, "the mark is no part of the picture");

    // The same pixel of the same picture on the command line.
    let pixel = numbers(&found["pixel"]);
    let (at, size) = (format!("{},{}", pixel[0], pixel[1]), format!("{}x{}", before.width(), before.height()));
    let slugs = ["position", "shading-normal", "base-color", "roughness", "n-dot-l", "d", "specular-lobe"];
    let modes = slugs.iter().flat_map(|slug| ["--mode", slug]);
    let args = ["probe", "shader-ball", "--json", "--at", &at, "--size", &size, "--env", "none"];
    let args: Vec<&str> = args.into_iter().chain(["--set", "lights.chosen=2"]).chain(modes).collect();
    let probed = run(&viewer.tree.beside(""), &args).expect(0, &[]).json();
    for slug in slugs {
        let (value, probed) = (numbers(&found["modes"][slug]), numbers(&probed["modes"][slug]));
        let is_close = value.iter().zip(&probed).all(|(a, b)| (a - b).abs() <= 1e-4 * b.abs().max(1.0));
        assert!(is_close, "{slug}: the window {value:?}, probe {probed:?}");
    }

    // The curves of its material, and those before an edit.
    viewer.click(BRDF);
    let curves = viewer.running.event("curves");
    assert_eq!((&curves["before"], &curves["generation"]), (&false.into(), &1.into()), "{curves}");
    let albedo = numbers(&curves["albedo"]);
    let ndf = viewer.tree.read(NDF);
    viewer.tree.write(NDF, &ndf.replace("float a2 = alpha * alpha;", "float a2 = 4.0 * alpha * alpha;"));
    let curves = viewer.running.event("curves");
    assert_eq!((&curves["before"], &curves["generation"]), (&true.into(), &2.into()), "{curves}");
    assert_ne!(numbers(&curves["albedo"]), albedo);

    // NaN of an edit is told.
    let surface = viewer.tree.read("debug/surface.glsl");
    let line = "else if (MODE == MODE_ROUGHNESS) value = vec3(s.roughness);";
    let broken = "else if (MODE == MODE_ROUGHNESS) value = vec3(sqrt(-1.0 - s.roughness));";
    assert!(surface.contains(line));
    viewer.tree.write("debug/surface.glsl", &surface.replace(line, broken));
    let is_edited = |event: &Value| event["event"] == "inspected" && event["generation"] == 3;
    let edited = viewer.running.until("the values of the edit", is_edited);
    assert_eq!(edited["modes"]["roughness"], "NaN", "{edited}");
    assert_eq!(edited["modes"]["position"], found["modes"]["position"]);
    let first = viewer.running.event("not-finite")["not_finite"].clone();
    assert_eq!((&first["line"], &first["mode"]), (&line_of(&surface, line).into(), &"roughness".into()), "{first}");
    viewer.click(VALUES);
    viewer.until_screen("the red line", has_red_text);

    viewer.key("Escape");
    viewer.until_screen("no mark", |screen| !is_about(screen.get_pixel(MARK.0, MARK.1), ACCENT));
    viewer.quit();
}
