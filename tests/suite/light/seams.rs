//! The BRDF where its parts meet: normals that face away, coats over films, anisotropy beside tables of isotropic lobes,
//! indices of refraction beside colors of F0, objects of uneven scale, and numbers at the end of a float's range.

use crate::support::{SIZE, Session, assert_differ, glb, load, model, ready, render, renderer, settings};
use glam::{DMat3, DQuat, DVec3};
use serde_json::{Value, json};
use specula::headless::Headless;
use specula::render::Capture;

const BARE: [&str; 3] = ["view.msaa=1", "view.background=none", "environment.name=none"];

fn vector([x, y, z, _]: [f32; 4]) -> DVec3 {
    DVec3::new(x.into(), y.into(), z.into())
}

/// The values on the model.
fn covered(capture: &Capture) -> Vec<(usize, DVec3)> {
    let on = capture.raw.iter().enumerate().filter(|(_, value)| value[3] == 1.0);
    let values: Vec<_> = on.map(|(i, value)| (i, vector(*value))).collect();
    assert!(values.len() > 300, "the model covers {} pixels only", values.len());
    values
}

fn extended(base: &Value, extensions: &Value) -> Value {
    json!({ "pbrMetallicRoughness": base, "extensions": extensions })
}

/// A square in the plane z = 0 whose normals are tilted towards +X by 35 degrees.
fn tilted() -> glb::Mesh {
    let (sin, cos) = 35_f32.to_radians().sin_cos();
    glb::Mesh { normals: vec![[sin, 0.0, cos]; 4], ..glb::quad(1.0) }
}

/// Where the eye is at 70 degrees, on the far side of that normal, and at 40 degrees, its mirror image at the normal's plane.
const BEHIND: f64 = 70.0;
const MIRRORED: f64 = 40.0;

fn eye(degrees: f64) -> String {
    let (sin, cos) = degrees.to_radians().sin_cos();
    format!("camera.eye=[{}, 0, {}]", -3.0 * sin, 3.0 * cos)
}

/// A value in the middle of the picture, seen from both eyes.
fn from_both(headless: &mut Headless, mode: &str) -> [DVec3; 2] {
    [BEHIND, MIRRORED].map(|degrees| {
        headless.settings_mut().assign(&eye(degrees)).unwrap();
        vector(render(headless, mode).raw_at(16, 16).unwrap())
    })
}

/// A normal texture turns normals away from the eye at silhouettes. All lobes are shaded there as for the mirror image of v.
#[test]
fn a_normal_that_faces_away_is_shaded_as_its_mirror_image() {
    let base = json!({ "baseColorFactor": [0.8, 0.5, 0.3, 1.0], "metallicFactor": 0.5, "roughnessFactor": 0.4 });
    let layers = json!({
        "KHR_materials_clearcoat": { "clearcoatFactor": 0.7, "clearcoatRoughnessFactor": 0.3 },
        "KHR_materials_sheen": { "sheenColorFactor": [0.2, 0.5, 0.4], "sheenRoughnessFactor": 0.5 },
    });
    let stretched = json!({ "KHR_materials_anisotropy": { "anisotropyStrength": 0.7, "anisotropyRotation": 0.5 } });
    let lamp = json!({ "type": "point", "intensity": 12.0 });
    let place = json!({ "translation": [1.5, 1.0, 1.5] });
    let rect = ["lights.source=none", "lights.rect.enabled=true", "lights.rect.azimuth=40", "lights.rect.polar=50"];
    let sky = ["lights.source=none", "environment.name=studio"];
    let lights: [(&str, &[&str], f64); 4] = [
        ("lamp", &["lights.source=model"], 1e-3),
        ("rectangle", &rect, 1e-3),
        ("environment", &sky, 2e-3),
        // The samples turn with the camera.
        ("samples", &["lights.source=none", "environment.name=studio", "REFLECTION_SAMPLES=Sampled128"], 0.05),
    ];
    for (what, extensions) in [("layers", &layers), ("anisotropy", &stretched)] {
        let bytes = glb::model_with_light(&tilted(), &extended(&base, extensions), &lamp, &place);
        for (light, more, tolerance) in &lights {
            let chosen = [&BARE[..], &["camera.target=[0, 0, 0]"], more].concat();
            let mut headless = renderer(load(&bytes), settings(&chosen), (33, 33));
            let [behind, mirrored] = from_both(&mut headless, "final");
            let apart = (behind - mirrored).abs().max_element();
            assert!(mirrored.min_element() > 1e-3, "{what}, {light}: {mirrored} is dark");
            assert!(apart < tolerance * mirrored.max_element(), "{what}, {light}: {behind}, not {mirrored}");
        }
    }
}

/// KHR_materials_clearcoat: `1 - abs(NdotV)`.
#[test]
fn a_coat_that_faces_away_dims_what_is_below_as_one_that_faces_the_eye() {
    let mut material = extended(&json!({}), &json!({ "KHR_materials_clearcoat": { "clearcoatFactor": 1.0 } }));
    material["emissiveFactor"] = json!([1.0, 1.0, 1.0]);
    let chosen = [&BARE[..], &["lights.source=none", "camera.target=[0, 0, 0]"]].concat();
    let mut headless = renderer(load(&glb::model(&tilted(), &material)), settings(&chosen), (33, 33));
    let expected = 1.0 - (0.04 + 0.96 * (1.0 - 75_f64.to_radians().cos()).powi(5));
    for found in from_both(&mut headless, "emissive-only") {
        assert!((found - DVec3::splat(expected)).abs().max_element() < 1e-3, "{found}, not {expected}");
    }
}

/// Fresnel 1823 for unpolarized light, from Snell's law.
fn fresnel(n: f64, cosine: f64) -> f64 {
    let inside = (1.0 - (1.0 - cosine * cosine) / (n * n)).sqrt();
    let s = (cosine - n * inside) / (cosine + n * inside);
    let p = (inside - n * cosine) / (inside + n * cosine);
    0.5 * (s * s + p * p)
}

/// F0 = 0.04, given in each way that glTF has. Converted specular-glossiness materials have an index of 0 or 1000.
#[test]
fn exact_fresnel_rises_however_f0_is_given() {
    let base = json!({ "metallicFactor": 0.0, "roughnessFactor": 0.5 });
    let with_color = |ior: f64, color: f64| {
        let specular = json!({ "specularColorFactor": [color, color, color] });
        extended(&base, &json!({ "KHR_materials_ior": { "ior": ior }, "KHR_materials_specular": specular }))
    };
    let glossy = json!({ "specularFactor": [0.04, 0.04, 0.04], "glossinessFactor": 0.5 });
    let of_thousand = 0.04 / (999.0_f64 / 1001.0).powi(2);
    let ways = [
        ("the index", extended(&base, &json!({ "KHR_materials_ior": { "ior": 1.5 } }))),
        ("an infinite index", with_color(0.0, 0.04)),
        ("an index of 1000", with_color(1000.0, of_thousand)),
        ("specular-glossiness", extended(&json!({}), &json!({ "KHR_materials_pbrSpecularGlossiness": glossy }))),
    ];
    let lamp = json!({ "type": "directional", "intensity": 3.0 });
    // It shines along -X, so that light grazes the sphere where the eye sees it.
    let node = json!({ "rotation": [0.0, 0.5_f64.sqrt(), 0.0, 0.5_f64.sqrt()] });
    let bytes = |material: &Value| glb::model_with_light(&glb::sphere(48, 96), material, &lamp, &node);
    let chosen = [&BARE[..], &["lights.source=model", "FRESNEL_DIELECTRIC=Exact", "camera.azimuth=-80"]].concat();
    let mut headless = renderer(load(&bytes(&ways[0].1)), settings(&chosen), SIZE);
    for (what, material) in &ways {
        headless.set_model(load(&bytes(material))).unwrap();
        let (found, cosines) = (render(&mut headless, "f"), render(&mut headless, "v-dot-h"));
        let mut most = 0.0_f64;
        for (i, found) in covered(&found) {
            let expected = fresnel(1.5, cosines.raw[i][0].into());
            most = most.max(expected);
            assert!((found.x - expected).abs() < 1e-3, "{what}: F is {}, not {expected}", found.x);
        }
        assert!(most > 0.5, "{what}: F does not rise, {most}");
    }
}

/// The albedo under uniform light, with lamps' own lobes. The mode flags what gains energy; the edit shows the number.
#[test]
fn anisotropic_metals_keep_their_light_in_every_direction() {
    let white = ["material.enabled=true", "material.metallic=1", "material.base_color=[1, 1, 1]"];
    let chosen = [&BARE[..], &white, &["lights.source=none", "camera.elevation=25"]].concat();
    let mut session = Session::new(model("material-override"), settings(&chosen));
    let flagged = "return max_component(albedo) > 1.005 ? vec3(1.0, 0.06, 0.03) : albedo;";
    ready(&session.edit("debug/paths.glsl", flagged, "return albedo;"));
    for (roughness, strength) in [(0.3, 0.5), (0.3, 1.0), (0.2, 0.7), (0.5, 1.0)] {
        session.set(&format!("material.roughness={roughness}"));
        session.set(&format!("material.anisotropy={strength}"));
        let albedo: Vec<f64> = covered(&session.mode("energy")).iter().map(|(_, value)| value.x).collect();
        let (least, most) = albedo.iter().fold((f64::MAX, 0.0_f64), |(a, b), x| (a.min(*x), b.max(*x)));
        println!("roughness {roughness}, strength {strength}: {least:.3} to {most:.3}");
        assert!(least > 0.94 && most < 1.06, "roughness {roughness}, strength {strength}: {least} to {most}");
    }
}

/// Meters along the refracted ray, for a thickness of 0.25 in the space of an object that is stretched and turned.
#[test]
fn thickness_is_scaled_along_the_ray() {
    let extensions = json!({
        "KHR_materials_transmission": { "transmissionFactor": 1.0 },
        "KHR_materials_ior": { "ior": 1.4 },
        "KHR_materials_volume": { "thicknessFactor": 0.25 },
    });
    let (mut json, bin) = glb::document(&glb::sphere(24, 48), &extended(&json!({}), &extensions));
    let rotation = DQuat::from_euler(glam::EulerRot::YXZ, 0.7, 0.4, 0.2);
    let mut headless = renderer(
        load(&glb::container(&json, &bin)),
        settings(&[&BARE[..], &["lights.source=none", "camera.eye=[0, 0, 9]", "camera.target=[0, 0, 0]"]].concat()),
        SIZE,
    );
    for scale in [DVec3::splat(2.0), DVec3::new(1.0, 1.0, 4.0), DVec3::new(-1.0, 0.5, 2.0)] {
        json["nodes"][0]["scale"] = json!(scale.to_array());
        json["nodes"][0]["rotation"] = json!(rotation.to_array());
        headless.set_model(load(&glb::container(&json, &bin))).unwrap();
        let world_from_object = DMat3::from_quat(rotation) * DMat3::from_diagonal(scale);
        let thickness = render(&mut headless, "thickness");
        let (positions, normals) = (render(&mut headless, "position"), render(&mut headless, "shading-normal"));
        for (i, thickness) in covered(&thickness) {
            let v = (DVec3::new(0.0, 0.0, 9.0) - vector(positions.raw[i])).normalize();
            let n = vector(normals.raw[i]).normalize();
            let across = -(v - n * n.dot(v)) / 1.4;
            let ray = across - n * (1.0 - across.length_squared()).sqrt();
            let expected = 0.25 * (world_from_object * (world_from_object.inverse() * ray).normalize()).length();
            assert!((thickness.x - expected).abs() < 1e-3, "{scale}: {} m, not {expected}", thickness.x);
        }
    }
}

/// L / (1 + L) rounds to 1 for the brightest light, which is not one band more.
#[test]
fn toon_has_a_brightest_band() {
    let chosen =
        [&BARE[..], &["lights.ambient_strength=0", "lights.orbit.0.strength=1e9", "view.ev=-10", "TOON_BANDS=Three"]]
            .concat();
    let mut headless = renderer(load(&glb::model(&glb::sphere(24, 48), &glb::gray())), settings(&chosen), SIZE);
    let luminances: Vec<f64> = covered(&render(&mut headless, "luminance")).iter().map(|(_, value)| value.x).collect();
    let (least, most) = luminances.iter().fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(*x), b.max(*x)));
    // Of three bands, the brightest is at L / (1 + L) = 5 / 6.
    let exposure = f64::from(headless.frame_state().unwrap().exposure());
    assert!(least >= 0.0 && (most * exposure - 5.0).abs() < 0.01, "{least} to {most} at exposure {exposure}");
}

/// The environment follows every edit of the diffuse lobe, also one that equals Lambert in most directions.
#[test]
fn an_edit_of_the_diffuse_lobe_reaches_the_environment() {
    let matte = json!({ "pbrMetallicRoughness": { "metallicFactor": 0.0, "roughnessFactor": 0.95 } });
    let chosen = [&BARE[..2], &["environment.name=studio", "lights.source=none"]].concat();
    let mut session = Session::new(load(&glb::model(&glb::sphere(24, 48), &matte)), settings(&chosen));
    let lambert = session.mode("ibl-diffuse");
    let shipped = "    return f_lambert(base_color);\n}";
    let mut text = shipped.to_owned();
    for (what, condition) in [
        ("retroreflection", "x.l_dot_v > 0.9"),
        ("the mirror direction", "x.n_dot_h > 0.98"),
        ("a grazing eye", "x.n_dot_v < 0.15"),
        ("rough surfaces", "roughness > 0.85"),
    ] {
        let edited = format!("    return f_lambert(base_color) * ({condition} ? 3.0 : 1.0);\n}}");
        ready(&session.edit("brdf/diffuse.glsl", &text, &edited));
        text = edited;
        assert_differ(&lambert, &session.mode("ibl-diffuse"), what);
    }
    ready(&session.edit("brdf/diffuse.glsl", &text, shipped));
    crate::support::assert_same(&lambert, &session.mode("ibl-diffuse"), "Lambert again");
}

/// What an expression of the shaders is, as a picture of one value: it replaces the mode `energy`.
fn numbers(session: &mut Session, include: &str, expression: &str) -> DVec3 {
    let shipped = session.tree.read("debug/paths.glsl");
    let text = shipped
        .replace(
            "#include \"debug/absent.glsl\"\n",
            &format!("#include \"{include}\"\n#include \"debug/absent.glsl\"\n"),
        )
        .replace("if_present(!has_feature(FEATURE_UNLIT), energy_color(s, v));", &format!("{expression};"));
    assert!(text.contains(expression), "debug/paths.glsl has no such line");
    ready(&session.save("debug/paths.glsl", &text));
    let found = vector(session.mode("energy").raw_at(SIZE.0 / 2, SIZE.1 / 2).unwrap());
    ready(&session.save("debug/paths.glsl", &shipped));
    found
}

#[test]
fn formulas_hold_at_the_end_of_their_range() {
    let quad = load(&glb::model(&glb::quad(1.0), &glb::gray()));
    let mut session = Session::new(quad, settings(&[&BARE[..], &["lights.source=none"]].concat()));
    // `zero` is not known before the shader runs.
    let zero = "(s.coverage - 1.0)";

    // At a grazing light and roughness 1 the albedo E(l) of EON's polynomial exceeds 1, and multiple scattering must not be
    // negative: the lobe is that of single scattering alone.
    let eon = format!("PI * f_oren_nayar(vec3(1.0), {zero}, 1.0, {zero}, 1.0) * (1.5 - 2.0 / (3.0 * PI))");
    let found = numbers(&mut session, "brdf/diffuse.glsl", &eon);
    assert!((found.x - 1.0).abs() < 1e-6, "single scattering is {}", found.x);

    // A ray from a face of a box, along it, hits the box 1 m away, whichever face.
    let at = |x: &str, y: f64| {
        let node = "BvhNode(vec3(-1.0), 0u, vec3(1.0), 0u)";
        format!(
            "box_distance({node}, vec3({x} + {zero}, {y:.1} + {zero}, 2.0), inverse_of(vec3({zero}, {zero}, -1.0)), 1e30)"
        )
    };
    let faces = format!("vec3({}, {}, {})", at("1.0", 1.0), at("-1.0", 0.0), at("1.0", -1.0));
    let found = numbers(&mut session, "paths/bvh.glsl", &faces);
    assert_eq!(found, DVec3::ONE, "the box is hit at {found} m");

    // GGX's density of half vectors, where a float's 1 - NoH^2 has lost its digits.
    for slope in [0.0005_f64, 0.001, 0.0025, 0.005] {
        let pdf = format!(
            "vec3(pdf_kernel(Kernel(normalize(vec3(0.3, 0.5, 0.8)), 0.0025, 1.0), \
             reflect(-normalize(vec3(0.3, 0.5, 0.8)), normalize(normalize(vec3(0.3, 0.5, 0.8)) + \
             {slope:.4} * normalize(cross(vec3(0.3, 0.5, 0.8), vec3(1.0, {zero}, 0.0)))))))"
        );
        let found = numbers(&mut session, "paths/exact_lookups.glsl", &pdf).x;
        let (a2, cos2) = (0.0025_f64.powi(2), 1.0 / (1.0 + slope * slope));
        // D NoH / (4 VoH) with v = n (Walter et al. 2007, eq. 14 and 33).
        let expected = a2 / (std::f64::consts::PI * (cos2 * (a2 + slope * slope)).powi(2)) / 4.0;
        assert!((found / expected - 1.0).abs() < 2e-3, "slope {slope}: {found}, not {expected}");
    }
}
