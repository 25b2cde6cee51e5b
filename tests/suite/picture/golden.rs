//! Compares a few pictures of the shader ball, and one of each material extension, with those in `tests/golden/`, by
//! perceived difference.
//!
//! FLIP (Andersson et al. 2020) gives each pixel an error of 0..1, as seen from 0.7 m on a 4K screen; these tests use
//! the mean. Measured on these pictures: one sample a pixel instead of four, or a camera moved by 1 cm, 0.006 to 0.023;
//! a tenth of a stop of exposure 0.04; roughness times 0.7 0.07; a light or the ambient light missing 0.09 to 0.14.
//! Drivers differ in the last bit of a color, in filtering, and in which samples an edge covers, which is below the
//! first of these. So the threshold is 0.02. `light/shading.rs` finds errors of BRDF terms that are not visible.

use std::path::{Path, PathBuf};

use crate::support::{model, render, renderer};
use image::{DynamicImage, RgbImage};
use specula::picture_difference::{Comparison, Picture};
use specula::render::Capture;
use specula::scene::BUILT_IN;
use specula::settings::Settings;

const SIZE: (u32, u32) = (160, 120);
/// Charts of balls.
const CHART: (u32, u32) = (320, 180);
const MOST_MEAN: f64 = 0.02;
const BLESS: &str = "SPECULA_BLESS=1 cargo test --release --test suite golden";

#[test]
fn pictures_are_as_they_were() {
    // A fixed camera, so that a change of framing changes no golden; everything else is the default.
    let settings = with_defaults(&[
        "camera.eye=[2.0, 2.0, 3.4]",
        "camera.target=[0, 1.0, 0]",
        "camera.fovy=35",
        "view.background='#1b1d21'",
    ]);
    let mut headless = renderer(model("shader-ball"), settings, SIZE);
    let mut wrong = Vec::new();
    for slug in ["final", "shading-normal", "metallic", "light-2", "diffuse-lobe"] {
        // The picture with all light; its parts with the lamps alone.
        let environment = if slug == "final" { "studio" } else { "none" };
        headless.settings_mut().environment.name = environment.into();
        wrong.extend(bless_or_compare(slug, &render(&mut headless, slug)));
    }
    assert!(wrong.is_empty(), "{}\nIf the change is meant: {BLESS}", wrong.join("\n"));
}

#[test]
fn extensions_are_as_they_were() {
    // In the studio, as the program shows them by default. The lanterns of one chart contain lamps.
    let mut wrong = Vec::new();
    for name in BUILT_IN.into_iter().filter(|name| is_chart(name)) {
        let lights = if name == "diffuse-transmission" { "lights.source=model" } else { "lights.source=orbit" };
        let mut headless = renderer(model(name), with_defaults(&[lights]), CHART);
        wrong.extend(bless_or_compare(name, &render(&mut headless, "final")));
    }
    assert!(wrong.is_empty(), "{}\nIf the change is meant: {BLESS}", wrong.join("\n"));
}

/// Settings as the program has them, with its tone map and exposure.
fn with_defaults(assignments: &[&str]) -> Settings {
    let mut settings = Settings::default();
    assignments.iter().for_each(|assignment| settings.assign(assignment).unwrap());
    settings
}

/// Whether a built-in model is a chart of a material extension.
fn is_chart(name: &str) -> bool {
    !["shader-ball", "sphere-grid", "metal-grid", "material-override", "many-lights"].contains(&name)
}

/// Returns what is wrong with a picture. When blessing, writes the golden instead.
fn bless_or_compare(name: &str, capture: &Capture) -> Option<String> {
    let picture = picture(capture);
    if std::env::var_os("SPECULA_BLESS").is_none() {
        return compare(name, &picture).err();
    }
    picture.save(golden(name)).unwrap();
    None
}

fn golden(slug: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("tests/golden/{slug}.png"))
}

fn picture(capture: &Capture) -> RgbImage {
    let rgb = capture.rgba8.chunks_exact(4).flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
    RgbImage::from_raw(capture.width, capture.height, rgb).unwrap()
}

/// Compares with the golden. On failure, writes the actual picture and the difference to cargo's folder for tests.
fn compare(slug: &str, actual: &RgbImage) -> Result<(), String> {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("golden");
    std::fs::create_dir_all(&folder).unwrap();
    let keep = |image: &RgbImage, kind: &str| {
        let path = folder.join(format!("{slug}.{kind}.png"));
        image.save(&path).unwrap();
        path.display().to_string()
    };
    let expected = image::open(golden(slug)).map_err(|error| {
        let kept = keep(actual, "actual");
        format!("{slug}: there is no golden {} ({error}); the picture is {kept}", golden(slug).display())
    })?;
    let display = |image: DynamicImage| Picture::Display(image.into_rgba8());
    let found = Comparison::new(&display(expected), &display(actual.clone().into()))
        .map_err(|error| format!("{slug}: the golden and the picture, {error}"))?;
    let mean = found.error;
    if mean <= MOST_MEAN {
        return Ok(());
    }
    let (kept, difference) = (keep(actual, "actual"), keep(&found.map().to_rgb8(), "difference"));
    Err(format!("{slug}: FLIP mean {mean:.4}, at most {MOST_MEAN}; see {kept} and {difference}"))
}
