//! Every debug mode shows what it says: data where there are some, a checkerboard where there are none, encoded as
//! promised.

mod support;

use serde_json::json;
use specula::headless::Headless;
use specula::render::Capture;
use specula::scene::{BUILT_IN, Model};
use specula::settings::Settings;
use specula::shader::Encode;
use support::{SIZE, glb, load, model, render, renderer, settings, srgb};

/// The slugs that programs outside rely on.
const FIXED: &str = "final base-color alpha metallic roughness occlusion emissive normal-texture geometric-normal \
    shading-normal tangent bitangent uv0 uv1 vertex-color position d g v f diffuse-lobe specular-lobe dielectric metal \
    ambient light-1 light-2 light-3 n-dot-l n-dot-v n-dot-h v-dot-h nan";

/// What these show is the same all over a closed, opaque, unmirrored model: 1, or the color for "good".
const SAME_ALL_OVER: [&str; 4] = ["alpha", "f90", "face-orientation", "tangent-sign"];

/// One sample, so that no pixel mixes the model and what is behind it.
fn sharp(model: Model, more: &[&str]) -> Headless {
    let mut settings: Settings = settings(&["view.msaa=1", "view.background=none"]);
    more.iter().for_each(|assignment| settings.assign(assignment).unwrap());
    renderer(model, settings, SIZE)
}

fn slugs(headless: &Headless) -> Vec<String> {
    headless.pipelines().shaders.modes.iter().map(|mode| mode.slug.clone()).collect()
}

/// The raw values on the model.
fn covered(capture: &Capture) -> Vec<[f32; 3]> {
    let values: Vec<_> = capture.raw.iter().filter(|v| v[3] == 1.0).map(|v| [v[0], v[1], v[2]]).collect();
    assert!(values.len() > 300, "the model covers {} pixels only", values.len());
    values
}

/// One of the two grays that stand for "no such data".
fn is_absent(value: &[f32; 3]) -> bool {
    [[0.18_f32; 3], [0.26; 3]].contains(value)
}

#[test]
fn the_fixed_slugs_exist() {
    let headless = sharp(load(&glb::model(&glb::quad(1.0), &glb::gray())), &[]);
    let slugs = slugs(&headless);
    let missing: Vec<&str> = FIXED.split_whitespace().filter(|slug| !slugs.iter().any(|s| s == slug)).collect();
    assert!(missing.is_empty(), "no mode {missing:?} among {slugs:?}");
    let mut ids: Vec<u32> = headless.pipelines().shaders.modes.iter().map(|mode| mode.id).collect();
    ids.dedup();
    assert_eq!(ids.len(), slugs.len(), "ids are not unique");
    for mode in &headless.pipelines().shaders.modes {
        assert!(!mode.doc.is_empty() && !mode.name.is_empty() && !mode.group.is_empty(), "{mode:?}");
    }
}

#[test]
fn every_mode_shows_data_of_the_shader_ball() {
    let mut headless = sharp(model("shader-ball"), &[]);
    let mut wrong = Vec::new();
    for slug in slugs(&headless) {
        let capture = render(&mut headless, &slug);
        let values = covered(&capture);
        let shown: Vec<_> = values.iter().filter(|value| !is_absent(value)).collect();
        let black = shown.iter().all(|value| value.iter().all(|c| *c == 0.0));
        let uniform = shown.iter().all(|value| *value == shown[0]);
        let bad = values.iter().flatten().any(|c| !c.is_finite());
        if bad || shown.len() < 20 || black || (uniform && !SAME_ALL_OVER.contains(&slug.as_str())) {
            let count = shown.len();
            wrong.push(format!("{slug}: {count} pixels with data, black {black}, uniform {uniform}, not finite {bad}"));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn absent_data_is_a_checkerboard() {
    // No normals: flat ones are made. No coordinates, colors or textures.
    let mesh = glb::Mesh { normals: Vec::new(), ..glb::quad(1.0) };
    let mut headless = sharp(load(&glb::model(&mesh, &glb::gray())), &["camera.azimuth=0", "camera.elevation=0"]);
    let data = ["uv0", "uv1", "vertex-color", "normal-texture", "tangent", "bitangent", "tangent-sign", "mip-level"];
    let check = |headless: &mut Headless, slug: &str| {
        let values = covered(&render(headless, slug));
        assert!(values.iter().all(is_absent), "{slug} shows more than the checkerboard");
        assert!(values.iter().any(|v| v[0] == 0.18) && values.iter().any(|v| v[0] == 0.26), "{slug} has no squares");
    };
    for slug in data.into_iter().chain(["texel-density"]) {
        check(&mut headless, slug);
    }
    headless.settings_mut().assign("lights.source=none").unwrap();
    for slug in ["light-1", "light-2", "light-3", "d", "g", "v", "f", "n-dot-l", "diffuse-lobe", "direct-specular"] {
        check(&mut headless, slug);
    }
    // Of two lights there is no third.
    headless.settings_mut().assign("lights.source=orbit").unwrap();
    headless.settings_mut().lights.chosen = 4;
    check(&mut headless, "specular-lobe");
}

#[test]
fn a_light_that_is_missing_leaves_the_others() {
    let light = json!({ "type": "point", "intensity": 20.0 });
    let node = json!({ "translation": [0.5, 0.5, 2.0] });
    let bytes = glb::model_with_light(&glb::quad(1.0), &glb::gray(), &light, &node);
    let mut headless = sharp(load(&bytes), &["lights.source=model", "camera.azimuth=0"]);
    assert!(covered(&render(&mut headless, "light-1")).iter().all(|value| !is_absent(value) && value[0] > 0.1));
    assert!(covered(&render(&mut headless, "light-2")).iter().all(is_absent));
}

#[test]
fn the_built_in_models_have_no_nan_anywhere() {
    for name in BUILT_IN {
        let mut headless = sharp(model(name), &[]);
        for lights in ["orbit", "model", "none"] {
            headless.settings_mut().assign(&format!("lights.source={lights}")).unwrap();
            // The warnings are pure magenta, yellow and cyan; what is well is gray.
            let values = covered(&render(&mut headless, "nan"));
            assert!(values.iter().all(|[r, g, b]| r == g && g == b), "{name}, lights {lights}");
        }
        let values = covered(&render(&mut headless, "final"));
        assert!(values.iter().flatten().all(|c| c.is_finite() && *c >= 0.0), "{name}");
    }
}

#[test]
fn a_png_stores_colors_in_srgb_data_as_they_are_and_vectors_shifted() {
    let mut headless = sharp(model("shader-ball"), &[]);
    let modes = headless.pipelines().shaders.modes.clone();
    for (slug, encode) in [
        ("base-color", Encode::Color),
        ("metallic", Encode::Data),
        ("roughness", Encode::Data),
        ("position", Encode::Data),
        ("shading-normal", Encode::Vector),
    ] {
        assert_eq!(modes.iter().find(|mode| mode.slug == slug).unwrap().encode, encode, "{slug}");
        let stored = |value: f64| match encode {
            Encode::Color => srgb(value),
            Encode::Data => value.clamp(0.0, 1.0),
            Encode::Vector => (value * 0.5 + 0.5).clamp(0.0, 1.0),
        };
        assert_encoded(&render(&mut headless, slug), slug, stored);
    }
}

#[test]
fn the_picture_is_exposed_tone_mapped_and_encoded() {
    let mut headless = sharp(model("shader-ball"), &["view.ev=1"]);
    type Curve = fn(f64) -> f64;
    let curves: [(&str, Curve); 3] = [
        ("none", |x| x),
        ("reinhard", |x| x / (1.0 + x)),
        // Narkowicz 2015, ACES Filmic Tone Mapping Curve.
        ("aces", |x| x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14)),
    ];
    for (name, curve) in curves {
        headless.settings_mut().assign(&format!("view.tonemap={name}")).unwrap();
        let exposure = 1.0 / (1.2 * 2.0);
        assert_encoded(&render(&mut headless, "final"), name, |radiance| srgb(curve(radiance * exposure)));
    }
}

/// Fails unless the picture's bytes are `stored` of its raw values, to one step.
fn assert_encoded(capture: &Capture, what: &str, stored: impl Fn(f64) -> f64) {
    for (raw, bytes) in capture.raw.iter().zip(capture.rgba8.chunks_exact(4)) {
        let expected_alpha = if raw[3] == 1.0 { 255 } else { 0 };
        assert_eq!(bytes[3], expected_alpha, "{what}: alpha of {raw:?}");
        for channel in (0..3).filter(|_| raw[3] == 1.0) {
            let expected = stored(f64::from(raw[channel])) * 255.0;
            let found = f64::from(bytes[channel]);
            assert!((expected - found).abs() <= 0.6, "{what}: {raw:?} is stored as {bytes:?}, expected {expected}");
        }
    }
}

#[test]
fn light_adds_up_and_materials_mix() {
    let mut headless = sharp(model("shader-ball"), &[]);
    let mut raw = |slug: &str| render(&mut headless, slug).raw;
    let whole = raw("final");
    let lights = [raw("light-1"), raw("light-2"), raw("light-3")];
    let (ambient, emitted) = (raw("ambient"), raw("emissive-only"));
    let (dielectric, metal, metallic) = (raw("dielectric"), raw("metal"), raw("metallic"));
    for i in (0..whole.len()).filter(|i| whole[*i][3] == 1.0) {
        for c in 0..3 {
            let near = |found: f32, what: &str| {
                let tolerance = 1e-4 * whole[i][c].abs() + 1e-6;
                assert!((found - whole[i][c]).abs() < tolerance, "{what}: {found}, not {} in pixel {i}", whole[i][c]);
            };
            // Each light comes with ambient light, which must count once.
            let lit: f32 = lights.iter().map(|light| light[i][c]).sum();
            near(lit - 2.0 * ambient[i][c] + emitted[i][c], "lights");
            let m = metallic[i][c];
            near(dielectric[i][c] * (1.0 - m) + metal[i][c] * m, "dielectric and metal");
        }
    }
}
