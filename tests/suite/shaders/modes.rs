//! Every debug mode shows what its documentation says: data, or a checkerboard where there is none, in the declared encoding.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use crate::support::{
    Renderer, SIZE, Session, assert_validated, glb, load, model, ready, render, renderer, settings, srgb,
};
use serde_json::json;
use specula::headless::Headless;
use specula::render::Capture;
use specula::scene::{BUILT_IN, Model};
use specula::settings::Settings;
use specula::shader::{Encode, Mode, PixelValue};

/// Slugs that other programs rely on.
const FIXED: &str = "final base-color alpha metallic roughness occlusion emissive normal-texture geometric-normal \
    shading-normal tangent bitangent uv0 uv1 vertex-color position d g v f diffuse-lobe specular-lobe dielectric metal \
    ambient light-1 light-2 light-3 n-dot-l n-dot-v n-dot-h v-dot-h nan";

/// Modes that are uniform on a closed, opaque, unmirrored model: 1, 1.5, or the color of a valid pixel.
const SAME_ALL_OVER: [&str; 5] = ["alpha", "f90", "ior", "face-orientation", "tangent-sign"];

/// Modes without data on the shader ball: a model that has the data, more settings, and the modes.
const ELSEWHERE: [(&str, &[&str], &[&str]); 12] = [
    ("clearcoat", &[], &["clearcoat", "clearcoat-roughness", "clearcoat-normal", "clearcoat-lobe", "clearcoat-light"]),
    ("anisotropy", &[], &["anisotropy", "anisotropy-direction"]),
    ("sheen", &[], &["sheen-color", "sheen-roughness", "sheen-lobe", "sheen-light"]),
    ("specular", &[], &["specular-factor", "specular-color"]),
    ("iridescence", &[], &["iridescence", "iridescence-thickness"]),
    ("transmission", &[], &["transmission", "transmitted-light"]),
    ("volume", &[], &["thickness", "attenuation-color"]),
    ("dispersion", &[], &["dispersion"]),
    ("diffuse-transmission", &["lights.source=model"], &["diffuse-transmission", "diffuse-transmission-color"]),
    ("sphere-grid", &["lights.rect.enabled=true"], &["area-light"]),
    (
        "sphere-grid",
        &["environment.name=studio"],
        &["ibl-diffuse", "ibl-specular", "irradiance", "prefiltered", "environment"],
    ),
    ("sphere-grid", &["environment.name=studio"], &BY_PATHS),
];
/// Modes of random paths that compare with image-based light.
const BY_PATHS: [&str; 5] = ["monte-carlo", "ibl-error", "prefilter-error", "split-sum-error", "occlusion-error"];
/// Modes that need a file: see `the_measured_modes_show_the_file`.
const MEASURED: [&str; 3] = ["measured", "measured-split", "measured-error"];

/// Direct light, and one sample per pixel, so that no pixel mixes the model with the background.
fn sharp(model: Model, more: &[&str]) -> Renderer {
    let mut settings: Settings =
        settings(&["view.msaa=1", "view.frames=2", "view.background=none", "environment.name=none"]);
    more.iter().for_each(|assignment| settings.assign(assignment).unwrap());
    renderer(model, settings, SIZE)
}

fn slugs(headless: &Headless) -> Vec<String> {
    headless.shaders().modes.iter().map(|mode| mode.slug.clone()).collect()
}

/// The raw values on the model.
fn covered(capture: &Capture) -> Vec<[f32; 3]> {
    let values: Vec<_> = capture.raw.iter().filter(|v| v[3] == 1.0).map(|v| [v[0], v[1], v[2]]).collect();
    assert!(values.len() > 300, "the model covers {} pixels only", values.len());
    values
}

/// The "no data" flag of each pixel on the model, in the order of [`covered`].
fn no_data(capture: &Capture) -> Vec<bool> {
    capture.raw.iter().zip(&capture.no_data).filter(|(value, _)| value[3] == 1.0).map(|(_, flag)| *flag).collect()
}

#[test]
fn the_fixed_slugs_exist() {
    let headless = sharp(load(&glb::model(&glb::quad(1.0), &glb::gray())), &[]);
    let slugs = slugs(&headless);
    let missing: Vec<&str> = FIXED.split_whitespace().filter(|slug| !slugs.iter().any(|s| s == slug)).collect();
    assert!(missing.is_empty(), "no mode {missing:?} among {slugs:?}");
    let mut ids: Vec<u32> = headless.shaders().modes.iter().map(|mode| mode.id).collect();
    ids.dedup();
    assert_eq!(ids.len(), slugs.len(), "ids are not unique");
    for mode in &headless.shaders().modes {
        assert!(!mode.doc.is_empty() && !mode.name.is_empty() && !mode.group.is_empty(), "{mode:?}");
    }
}

/// Pixels on the model that stand for all of them.
const PIXELS: usize = 40;

/// Pixels all over the model.
fn pixels(headless: &mut Headless) -> Vec<(u32, u32)> {
    let capture = render(headless, "alpha");
    let step = covered(&capture).len() / PIXELS;
    let on_model = (0..).zip(&capture.raw).filter(|(_, value)| value[3] == 1.0);
    on_model.map(|(at, _)| (at % SIZE.0, at / SIZE.0)).step_by(step).collect()
}

/// The values of each mode at pixels all over the model. Modes are drawn in sets, a pipeline each, as the inspector of the window draws
/// them; those that cannot be in a set are rendered.
fn values(headless: &mut Headless, slugs: &[&str]) -> BTreeMap<String, Vec<PixelValue>> {
    let pixels = pixels(headless);
    headless.settings_mut().mode = "final".to_owned();
    // The inspector reads numbers where the picture has colors for them.
    let is_in_set = |mode: &&Mode| slugs.contains(&&*mode.slug) && mode.numbers.is_none();
    let modes: Vec<Mode> = headless.shaders().modes.iter().filter(is_in_set).cloned().collect();
    let mut values = BTreeMap::<String, Vec<PixelValue>>::new();
    for at in &pixels {
        for (slug, value) in headless.inspect(*at, &modes).unwrap() {
            values.entry(slug).or_default().push(value);
        }
    }
    assert_validated();
    for slug in slugs.iter().filter(|slug| !values.contains_key(**slug)).copied().collect::<Vec<_>>() {
        let capture = render(headless, slug);
        let of = |(x, y): &(u32, u32)| {
            let at = (y * SIZE.0 + x) as usize;
            PixelValue { value: capture.raw[at], no_data: capture.no_data[at], not_finite: capture.not_finite[at] }
        };
        values.insert(slug.to_owned(), pixels.iter().map(of).collect());
    }
    values
}

/// The faults of modes whose data the model has.
fn faults(headless: &mut Headless, slugs: &[&str]) -> Vec<String> {
    let fault = |(slug, values): (String, Vec<PixelValue>)| {
        let shown: Vec<_> = values.iter().filter(|pixel| !pixel.no_data).map(|pixel| &pixel.value[..3]).collect();
        let black = shown.iter().all(|value| value.iter().all(|c| *c == 0.0));
        let uniform = shown.iter().all(|value| *value == shown[0]);
        let bad = values.iter().any(|pixel| pixel.not_finite);
        let is_wrong = bad || shown.len() < 2 || black || (uniform && !SAME_ALL_OVER.contains(&&*slug));
        let count = shown.len();
        is_wrong
            .then(|| format!("{slug}: {count} pixels with data, black {black}, uniform {uniform}, not finite {bad}"))
    };
    values(headless, slugs).into_iter().filter_map(fault).collect()
}

#[test]
fn every_mode_shows_data_of_the_shader_ball() {
    let elsewhere: Vec<&str> = ELSEWHERE.iter().flat_map(|(_, _, slugs)| *slugs).copied().chain(MEASURED).collect();
    let mut headless = sharp(model("shader-ball"), &[]);
    // Images of the depth of field have blur in alpha, not coverage, and those of lights a number of a matrix. Nothing moves here.
    let others = ["pass:velocity", "pass:own_motion", "pass:light_views"];
    let is_other = |slug: &str| slug.starts_with("pass:dof_") || others.contains(&slug);
    let all = slugs(&headless);
    let own: Vec<&str> =
        all.iter().map(String::as_str).filter(|slug| !elsewhere.contains(slug) && !is_other(slug)).collect();
    let wrong = faults(&mut headless, &own);
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn modes_of_what_the_shader_ball_lacks_show_data_elsewhere() {
    let mut wrong = Vec::new();
    for (name, more, slugs) in ELSEWHERE {
        let mut headless = sharp(model(name), more);
        wrong.extend(faults(&mut headless, slugs));
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// A MERL file of a matte surface with this albedo: the same BRDF value for all pairs of directions.
fn matte_merl(albedo: f64) -> Vec<u8> {
    let counts = [90_i32, 90, 180];
    let pairs = counts.iter().product::<i32>() as usize;
    // MERL's reader multiplies the stored values by these (Matusik et al. 2003).
    let scales = [1.0 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0];
    let value = |scale: f64| (albedo / PI / scale).to_le_bytes().repeat(pairs);
    counts.iter().flat_map(|count| count.to_le_bytes()).chain(scales.into_iter().flat_map(value)).collect()
}

#[test]
fn the_measured_modes_show_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("matte.binary");
    std::fs::write(&path, matte_merl(0.5)).unwrap();
    let light = json!({ "type": "point", "intensity": 20.0 });
    let bytes =
        glb::model_with_light(&glb::quad(1.0), &glb::gray(), &light, &json!({ "translation": [0.5, 0.5, 2.0] }));
    let mut headless =
        sharp(load(&bytes), &["lights.source=model", "camera.azimuth=0", "camera.elevation=0", "MULTI_SCATTER=None"]);
    assert!(MEASURED.iter().all(|slug| !no_data(&render(&mut headless, slug)).contains(&false)), "no file");
    headless.settings_mut().measured = path.display().to_string();
    let mut raw = |slug: &str| covered(&render(&mut headless, slug));
    // `lambert` is base color / pi times irradiance, without the cosine. File and material both have albedo 0.5.
    let (measured, lambert, cosine) = (raw("measured"), raw("lambert"), raw("n-dot-l"));
    for ((measured, lambert), cosine) in measured.iter().zip(&lambert).zip(&cosine) {
        let expected = lambert[0] * cosine[0];
        assert!(measured.iter().all(|c| (c - expected).abs() < 2e-3 * expected), "{measured:?}, not {expected}");
    }
    // Left of the middle the measured BRDF, right of it the material with its highlight, between them a line of two pixels.
    let (split, diffuse, specular) = (raw("measured-split"), raw("direct-diffuse"), raw("direct-specular"));
    let equal = |a: f32, b: f32| (a - b).abs() < 1e-4;
    let left = (0..split.len()).filter(|i| equal(split[*i][0], measured[*i][0])).count();
    let right = (0..split.len()).filter(|i| equal(split[*i][0], diffuse[*i][0] + specular[*i][0])).count();
    assert!(left.abs_diff(right) < split.len() / 20 && left + right >= split.len() - 2 * SIZE.1 as usize);
    // The shaded surface is brighter in its highlight and darker elsewhere, since Fresnel reduces the diffuse lobe.
    let error = raw("measured-error");
    assert!(error.iter().any(|[r, _, b]| r > b) && error.iter().any(|[r, _, b]| b > r));
}

#[test]
fn absent_data_is_a_checkerboard() {
    // Without normals, the loader generates flat ones. No coordinates, colors or textures.
    let mesh = glb::Mesh { normals: Vec::new(), ..glb::quad(1.0) };
    let mut headless = sharp(load(&glb::model(&mesh, &glb::gray())), &["camera.azimuth=0", "camera.elevation=0"]);
    let data = [
        "uv0",
        "uv1",
        "vertex-color",
        "normal-texture",
        "tangent",
        "bitangent",
        "tangent-sign",
        "mip-level",
        // Extensions, the environment, a rectangle.
        "clearcoat-normal",
        "clearcoat-light",
        "anisotropy-direction",
        "sheen-roughness",
        "sheen-lobe",
        "specular-color",
        "iridescence-thickness",
        "transmission",
        "transmitted-light",
        "attenuation-color",
        "dispersion",
        "diffuse-transmission-color",
        "ibl-specular",
        "irradiance",
        "environment",
        "area-light",
    ];
    let check = |headless: &mut Headless, slugs: &[&str]| {
        for (slug, values) in values(headless, slugs) {
            assert!(values.iter().all(|pixel| pixel.no_data), "{slug} has data");
        }
        let squares = covered(&render(headless, slugs[0]));
        assert!(squares.iter().any(|v| v[0] == 0.180017) && squares.iter().any(|v| v[0] == 0.260017));
    };
    check(&mut headless, &[&data[..], &BY_PATHS, &["texel-density"]].concat());
    headless.settings_mut().assign("lights.source=none").unwrap();
    let of_lights = ["light-1", "light-2", "light-3", "d", "g", "v", "f", "n-dot-l", "diffuse-lobe", "direct-specular"];
    check(&mut headless, &of_lights);
    // Three orbiting lights: there is no fourth.
    headless.settings_mut().assign("lights.source=orbit").unwrap();
    headless.settings_mut().lights.chosen = 4;
    check(&mut headless, &["specular-lobe"]);
}

/// In a debug mode, blended surfaces are opaque: they have the flag, and hide the surfaces behind them.
#[test]
fn blended_surfaces_without_data_have_the_flag() {
    let mut material = glb::gray();
    material["alphaMode"] = json!("BLEND");
    let mut headless = sharp(load(&glb::model(&glb::quad(1.0), &material)), &["camera.azimuth=0"]);
    assert!(!no_data(&render(&mut headless, "clearcoat")).contains(&false));
    assert!(!no_data(&render(&mut headless, "roughness")).contains(&true));
}

/// A material whose gray equals the checkerboard's still has data.
#[test]
fn the_gray_of_the_checkerboard_is_not_a_flag() {
    let mut material = glb::gray();
    material["pbrMetallicRoughness"]["baseColorFactor"] = json!([0.180017, 0.180017, 0.180017, 1.0]);
    let mut headless = sharp(load(&glb::model(&glb::quad(1.0), &material)), &["camera.azimuth=0"]);
    let capture = render(&mut headless, "base-color");
    assert_eq!(covered(&capture)[0], [0.180017; 3]);
    assert!(!capture.no_data.contains(&true));
}

/// A flag of one sample survives the mean of four samples, and changes neither coverage nor neighboring pixels.
#[test]
fn flags_survive_multisampling() {
    let mut session = Session::new(model("shader-ball"), settings(&["environment.name=none", "view.background=none"]));
    // Plain means, in which no channel depends on another.
    session.headless.set_linear(true);
    let before = session.mode("final");
    assert!(before.raw.iter().any(|value| value[3] > 0.0 && value[3] < 1.0), "no edge");
    assert!(!before.not_finite.contains(&true) && !before.no_data.contains(&true));
    // The compiler cannot fold an expression that depends on a parameter.
    let nan = "if (s.position_ws.x > 0.0) radiance.g = sqrt(-1.0 - rim_strength);\n    return radiance;\n}\n\n#endif";
    ready(&session.edit("user.glsl", "return radiance;\n}\n\n#endif", nan));
    let after = session.mode("final");
    let mut counts = [0, 0];
    for i in 0..before.raw.len() {
        let ([r, g, b, a], [r0, g0, b0, a0]) = (after.raw[i], before.raw[i]);
        counts[usize::from(after.not_finite[i])] += usize::from(a0 > 0.0);
        assert_eq!(a, a0, "coverage of pixel {i}");
        // NaN counts as 0, and the other channels are unchanged.
        assert!((r, b) == (r0, b0) && (0.0..=g0).contains(&g), "{:?} was {:?}", after.raw[i], before.raw[i]);
        assert!(after.not_finite[i] || g == g0, "pixel {i} changed without a flag");
    }
    assert!(counts.iter().all(|count| *count > 300), "finite and not: {counts:?}");
    let clearcoat = session.mode("clearcoat");
    for (value, flag) in clearcoat.raw.iter().zip(&clearcoat.no_data) {
        assert_eq!(*flag, value[3] > 0.0, "{value:?}");
    }
    assert!(clearcoat.raw.iter().zip(&before.raw).all(|(a, b)| a[3] == b[3]), "coverage");
}

/// If one of many frames is NaN, the mean has the flag and is not NaN.
#[test]
fn a_frame_that_is_not_finite_is_remembered_by_the_mean() {
    let view = ["environment.name=studio", "view.msaa=1", "view.frames=4", "view.background=none"];
    let mut session = Session::new(model("sphere-grid"), settings(&view));
    let before = session.mode("monte-carlo");
    let nan =
        "if (frame.sample_index == 1u) radiance = vec3(sqrt(-1.0 - rim_strength));\n    return radiance;\n}\n\n#endif";
    ready(&session.edit("user.glsl", "return radiance;\n}\n\n#endif", nan));
    let after = session.mode("monte-carlo");
    for i in (0..before.raw.len()).filter(|i| before.raw[*i][3] == 1.0) {
        assert!(after.not_finite[i] && !before.not_finite[i], "pixel {i}");
        assert_eq!(after.raw[i][3], 1.0);
        assert!((0..3).all(|c| after.raw[i][c] <= before.raw[i][c]), "{:?} {:?}", after.raw[i], before.raw[i]);
    }
}

#[test]
fn a_light_that_is_missing_leaves_the_others() {
    let light = json!({ "type": "point", "intensity": 20.0 });
    let node = json!({ "translation": [0.5, 0.5, 2.0] });
    let bytes = glb::model_with_light(&glb::quad(1.0), &glb::gray(), &light, &node);
    let mut headless = sharp(load(&bytes), &["lights.source=model", "camera.azimuth=0"]);
    let first = render(&mut headless, "light-1");
    assert!(covered(&first).iter().all(|value| value[0] > 0.1) && !no_data(&first).contains(&true));
    assert!(!no_data(&render(&mut headless, "light-2")).contains(&false));
}

#[test]
fn the_built_in_models_have_no_nan_anywhere() {
    // The warnings are pure magenta, yellow and cyan. Valid pixels are gray.
    let is_well = |headless: &mut Headless| {
        let values = covered(&render(headless, "nan"));
        values.iter().all(|[r, g, b]| r == g && g == b)
    };
    for name in BUILT_IN {
        let lights = if name == "many-lights" { "model" } else { "orbit" };
        let lights = format!("lights.source={lights}");
        let mut headless = sharp(model(name), &["environment.name=studio", "lights.rect.enabled=true", &lights]);
        assert!(is_well(&mut headless), "{name}");
    }
    let mut headless = sharp(model(BUILT_IN[0]), &[]);
    for lights in ["orbit", "none"] {
        headless.settings_mut().assign(&format!("lights.source={lights}")).unwrap();
        assert!(is_well(&mut headless), "{lights}, by flat ambient light");
    }
}

#[test]
fn a_png_stores_colors_in_srgb_data_as_they_are_and_vectors_shifted() {
    let mut headless = sharp(model("shader-ball"), &[]);
    let modes = headless.shaders().modes.clone();
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

/// Fails unless each byte of the picture is `stored` of its raw value, rounded.
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
    let mut headless = sharp(model("shader-ball"), &["environment.name=studio"]);
    let mut raw = |slug: &str| render(&mut headless, slug).raw;
    let whole = raw("final");
    let lights = [raw("light-1"), raw("light-2"), raw("light-3")];
    let (ambient, emitted) = (raw("ambient"), raw("emissive-only"));
    let (dielectric, metal, metallic) = (raw("dielectric"), raw("metal"), raw("metallic"));
    let (once, more) = (raw("single-scattering"), raw("multiple-scattering"));
    for i in (0..whole.len()).filter(|i| whole[*i][3] == 1.0) {
        for c in 0..3 {
            let near = |found: f32, what: &str| {
                let tolerance = 1e-4 * whole[i][c].abs() + 1e-6;
                assert!((found - whole[i][c]).abs() < tolerance, "{what}: {found}, not {} in pixel {i}", whole[i][c]);
            };
            let lit: f32 = lights.iter().map(|light| light[i][c]).sum();
            near(lit + ambient[i][c] + emitted[i][c], "lights");
            let m = metallic[i][c];
            near(dielectric[i][c] * (1.0 - m) + metal[i][c] * m, "dielectric and metal");
            near(once[i][c] + more[i][c], "scattered once and more often");
        }
    }
}

/// A material may read TEXCOORD_1 of a mesh that has only TEXCOORD_0, and then gets TEXCOORD_0.
#[test]
fn a_second_set_of_coordinates_that_is_not_there_is_the_first() {
    let mut session = Session::new(model("sphere-grid"), settings(&["environment.name=none"]));
    let first = session.mode("uv0");
    let show = "out_color = vec4(fragment.uv1, 0.0, 1.0);";
    ready(&session.edit("debug.frag", "out_color = hdr_pixel(value, 1.0, no_data);", show));
    let second = session.mode("uv0");
    let spread = first.raw.iter().map(|value| value[0]).fold(0.0, f32::max);
    assert!(spread > 0.5 && first.raw == second.raw, "{spread}");
}

/// The view direction is computed from the position that an edited vertex shader has moved.
#[test]
fn moved_vertices_are_seen_from_where_they_are() {
    let eye = glam::Vec3::new(2.0, 2.0, 3.4);
    let view = ["environment.name=none", "camera.eye=[2.0, 2.0, 3.4]", "view.msaa=1"];
    let mut session = Session::new(model("shader-ball"), settings(&view));
    let made = "    fragment = fragment_of(vertex);\n";
    let moved = format!("{made}    fragment.position_ws += 0.2 * vertex.normal;\n");
    ready(&session.edit("pbr.vert", made, &moved));
    let [positions, normals, found] = ["position", "shading-normal", "n-dot-v"].map(|slug| session.mode(slug).raw);
    let on = (0..positions.len()).filter(|i| positions[*i][3] == 1.0).collect::<Vec<_>>();
    assert!(on.len() > 500, "{}", on.len());
    for i in on {
        let [position, normal] = [positions[i], normals[i]].map(|[x, y, z, _]| glam::Vec3::new(x, y, z));
        // Where the normal faces away from the eye, the view is mirrored to its side.
        let expected = normal.dot((eye - position).normalize()).abs().clamp(1e-4, 1.0);
        assert!((found[i][0] - expected).abs() < 1e-4, "{position}: {} instead of {expected}", found[i][0]);
    }
}

/// Reflectance of a conductor at normal incidence (Born & Wolf 1999, section 14.4).
fn conductor_f0(n: f64, k: f64) -> f64 {
    ((n - 1.0).powi(2) + k * k) / ((n + 1.0).powi(2) + k * k)
}

#[test]
fn f0_is_that_of_the_selected_fresnel_equation() {
    let (n, k) = ([0.18, 0.42, 1.37], [3.42, 2.35, 1.77]);
    let metal = |n: [f64; 3], k: [f64; 3]| {
        json!({ "pbrMetallicRoughness": { "baseColorFactor": [0.8, 0.8, 0.8, 1.0] },
            "extras": { "specula": { "conductor_n": n, "conductor_k": k } } })
    };
    let mut headless = sharp(load(&glb::model(&glb::quad(1.0), &metal(n, k))), &[]);
    let by_ior = std::array::from_fn(|i| conductor_f0(n[i], k[i]));
    for (choice, expected) in [("Schlick", [0.8; 3]), ("Conductor", by_ior), ("F82", by_ior)] {
        headless.settings_mut().assign(&format!("FRESNEL_METAL={choice}")).unwrap();
        let found = covered(&render(&mut headless, "f0"))[0];
        let near = found.iter().zip(expected).all(|(a, b): (&f32, f64)| (f64::from(*a) - b).abs() < 1e-4);
        assert!(near, "{choice}: {found:?}, expected {expected:?}");
    }
    // The base color is a plausible metal; n and k are not: F0 = 0.29.
    let dull = metal([2.0; 3], [1.5; 3]);
    for (choice, is_red) in [("Schlick", false), ("Conductor", true)] {
        let choice = format!("FRESNEL_METAL={choice}");
        let mut headless = sharp(load(&glb::model(&glb::quad(1.0), &dull)), &[&choice]);
        let [r, g, _] = covered(&render(&mut headless, "f0-range"))[0];
        assert_eq!(r == 1.0 && g < 0.1, is_red, "{choice}: {r}, {g}");
    }
}
