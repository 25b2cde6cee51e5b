//! An independent implementation of the shading model, from its papers, against the renderer's raw values.
//!
//! Covers Lambert, GGX (Walter et al. 2007), height-correlated Smith (Heitz 2014), Schlick 1994, metallic-roughness as
//! a blend of two results, one punctual light (KHR_lights_punctual), ambient light, emission, and multiple scattering
//! (Kulla & Conty 2017), which the other tests turn off. Computes in f64 from the eye, the light and the factors in the
//! file; the renderer provides only the position of each pixel.

use std::f64::consts::PI;

use crate::support::{Renderer, SIZE, glb, load, render, renderer, settings};
use glam::{DVec3, Mat4, Vec3};
use serde_json::{Value, json};
use specula::headless::Headless;

/// Tolerance relative to the value, or to 1 for values that are smaller.
const TOLERANCE: f64 = 1e-3;

const EYE: DVec3 = DVec3::new(0.6, 0.9, 2.6);
const AMBIENT: [f64; 3] = [0.05, 0.07, 0.09];

/// A material with factors only.
#[derive(Clone, Copy, Debug)]
struct Material {
    base_color: [f64; 3],
    metallic: f64,
    roughness: f64,
    emissive: [f64; 3],
}

impl Material {
    fn json(&self) -> Value {
        let [r, g, b] = self.base_color;
        json!({ "emissiveFactor": self.emissive, "pbrMetallicRoughness": { "baseColorFactor": [r, g, b, 1.0],
            "metallicFactor": self.metallic, "roughnessFactor": self.roughness } })
    }
}

/// A light: the direction towards it and the irradiance on a plane perpendicular to it, at a point.
struct Lamp {
    name: &'static str,
    json: Value,
    node: Value,
    at: fn(DVec3) -> (DVec3, f64),
}

const COLOR: [f64; 3] = [1.0, 0.8, 0.6];
const PLACE: DVec3 = DVec3::new(1.5, 1.2, 2.0);
const SPOT: DVec3 = DVec3::new(0.2, 0.3, 3.0);

fn lamps() -> [Lamp; 4] {
    let place = json!({ "translation": [PLACE.x, PLACE.y, PLACE.z] });
    [
        Lamp {
            name: "point",
            json: json!({ "type": "point", "color": COLOR, "intensity": 12.0 }),
            node: place.clone(),
            at: |p| ((PLACE - p).normalize(), 12.0 / (PLACE - p).length_squared()),
        },
        Lamp {
            name: "point with a range",
            json: json!({ "type": "point", "color": COLOR, "intensity": 12.0, "range": 2.5 }),
            node: place,
            at: |p| {
                let d = (PLACE - p).length();
                ((PLACE - p).normalize(), 12.0 * (1.0 - (d / 2.5).powi(4)).clamp(0.0, 1.0) / (d * d))
            },
        },
        Lamp {
            name: "directional",
            json: json!({ "type": "directional", "color": COLOR, "intensity": 3.0 }),
            // Rotated by 90 degrees around Y, so it shines along -X instead of -Z.
            node: json!({ "rotation": [0.0, 0.5_f64.sqrt(), 0.0, 0.5_f64.sqrt()] }),
            at: |_| (DVec3::X, 3.0),
        },
        Lamp {
            name: "spot",
            json: json!({ "type": "spot", "color": COLOR, "intensity": 12.0,
                "spot": { "innerConeAngle": 0.1, "outerConeAngle": 0.3 } }),
            // Not rotated, so it shines along -Z. The outer cone ends on the sphere.
            node: json!({ "translation": [SPOT.x, SPOT.y, SPOT.z] }),
            at: |p| {
                let l = (SPOT - p).normalize();
                let ramp = ((l.z - 0.3_f64.cos()) / (0.1_f64.cos() - 0.3_f64.cos())).clamp(0.0, 1.0);
                (l, 12.0 * ramp * ramp / (SPOT - p).length_squared())
            },
        },
    ]
}

/// Every BRDF term at a point, as the modes of the same names show it.
struct Terms {
    n_dot_l: f64,
    n_dot_v: f64,
    n_dot_h: f64,
    v_dot_h: f64,
    d: f64,
    v: f64,
    f: [f64; 3],
    k_d: f64,
    diffuse: [f64; 3],
    specular: [f64; 3],
}

fn terms(material: &Material, n: DVec3, l: DVec3, v: DVec3) -> Terms {
    let h = (l + v).normalize();
    let (n_dot_l, n_dot_v) = (n.dot(l).max(0.0), n.dot(v).max(1e-4));
    let (n_dot_h, v_dot_h) = (n.dot(h).max(0.0), v.dot(h).max(0.0));
    let alpha2 = material.roughness.powi(4);
    // Walter et al. 2007, eq. 33, in the form with tan^2 of the angle between n and h.
    let cos2 = n_dot_h * n_dot_h;
    let tan2 = (1.0 - cos2) / cos2;
    let d = alpha2 / (PI * cos2 * cos2 * (alpha2 + tan2).powi(2));
    // Heitz 2014, eq. 72 and 99, with the Lambda function written out.
    let lambda = |cosine: f64| ((1.0 + alpha2 * (1.0 - cosine * cosine) / (cosine * cosine)).sqrt() - 1.0) / 2.0;
    let g = 1.0 / (1.0 + lambda(n_dot_l) + lambda(n_dot_v));
    // A light behind the surface contributes nothing.
    let above = if n_dot_l > 0.0 { 1.0 } else { 0.0 };
    let (d, v) = if n_dot_l > 0.0 { (d, g / (4.0 * n_dot_l * n_dot_v)) } else { (0.0, 0.0) };
    let schlick = |f0: f64| f0 + (1.0 - f0) * (1.0 - v_dot_h).powi(5);
    let dielectric = schlick(0.04);
    let mix = |a: f64, b: f64| a + (b - a) * material.metallic;
    let f = material.base_color.map(|f0| mix(dielectric, schlick(f0)));
    let k_d = (1.0 - material.metallic) * (1.0 - dielectric);
    let diffuse = material.base_color.map(|albedo| above * k_d * albedo / PI);
    let specular = f.map(|f| f * d * v);
    Terms { n_dot_l, n_dot_v, n_dot_h, v_dot_h, d, v, f, k_d, diffuse, specular }
}

/// Radiance towards the eye: the light, ambient light as its mode shows it, and emission.
fn radiance(material: &Material, terms: &Terms, irradiance: f64, ambient: [f32; 4]) -> [f64; 3] {
    std::array::from_fn(|c| {
        let direct = (terms.diffuse[c] + terms.specular[c]) * irradiance * COLOR[c] * terms.n_dot_l;
        direct + f64::from(ambient[c]) + material.emissive[c]
    })
}

const MATERIALS: [Material; 4] = [
    Material { base_color: [0.8, 0.3, 0.1], metallic: 0.0, roughness: 0.3, emissive: [0.0; 3] },
    Material { base_color: [0.9, 0.6, 0.3], metallic: 1.0, roughness: 0.5, emissive: [0.0; 3] },
    Material { base_color: [0.2, 0.5, 0.9], metallic: 0.5, roughness: 0.8, emissive: [0.1, 0.2, 0.4] },
    Material { base_color: [0.6, 0.6, 0.6], metallic: 0.25, roughness: 1.0, emissive: [0.0; 3] },
];

/// One sample a pixel and no tone map, so that raw values are what the shader wrote.
fn open(bytes: &[u8]) -> Renderer {
    let [r, g, b] = AMBIENT;
    let settings = settings(&[
        "view.msaa=1",
        "environment.name=none",
        "MULTI_SCATTER=None",
        "DIFFUSE_COUPLING=GltfSample",
        "lights.source=model",
        "lights.ambient_strength=1",
        &format!("lights.ambient_color=[{r}, {g}, {b}]"),
        &format!("camera.eye=[{}, {}, {}]", EYE.x, EYE.y, EYE.z),
        "camera.target=[0, 0, 0]",
        "camera.fovy=45",
    ]);
    renderer(load(bytes), settings, SIZE)
}

fn model(material: &Material, lamp: &Lamp) -> Vec<u8> {
    glb::model_with_light(&glb::sphere(48, 96), &material.json(), &lamp.json, &lamp.node)
}

/// World positions of the pixels on the model, by pixel index.
fn positions(headless: &mut Headless) -> Vec<(usize, DVec3)> {
    let capture = render(headless, "position");
    let on = capture.raw.iter().enumerate().filter(|(_, value)| value[3] == 1.0);
    let out: Vec<_> = on.map(|(i, v)| (i, DVec3::new(v[0].into(), v[1].into(), v[2].into()))).collect();
    assert!(out.len() > 1000, "the sphere covers {} pixels only", out.len());
    out
}

#[track_caller]
fn near(what: &str, found: f32, expected: f64, at: DVec3) {
    let found = f64::from(found);
    let allowed = TOLERANCE * expected.abs().max(1e-2);
    assert!((found - expected).abs() < allowed, "{what} at {at}: found {found}, expected {expected}");
}

#[test]
fn every_term_follows_its_equation() {
    let lamp = &lamps()[0];
    let mut headless = open(&model(&MATERIALS[0], lamp));
    for material in &MATERIALS {
        headless.set_model(load(&model(material, lamp))).unwrap();
        let places = positions(&mut headless);
        let points: Vec<(usize, DVec3, Terms)> = places
            .into_iter()
            .map(|(i, p)| (i, p, terms(material, p.normalize(), (lamp.at)(p).0, (EYE - p).normalize())))
            // Skip grazing angles, where the sphere's facets dominate.
            .filter(|(_, _, terms)| terms.n_dot_v > 0.05 && !(1e-6..0.02).contains(&terms.n_dot_l))
            .collect();
        type Term = fn(&Terms) -> [f64; 3];
        let modes: [(&str, Term); 12] = [
            ("n-dot-l", |t| [t.n_dot_l; 3]),
            ("n-dot-v", |t| [t.n_dot_v; 3]),
            ("n-dot-h", |t| [t.n_dot_h; 3]),
            ("v-dot-h", |t| [t.v_dot_h; 3]),
            ("d", |t| [t.d; 3]),
            ("g", |t| [4.0 * t.n_dot_l * t.n_dot_v * t.v; 3]),
            ("v", |t| [t.v; 3]),
            ("f", |t| t.f),
            ("k-d", |t| [t.k_d; 3]),
            ("k-s", |t| t.f),
            ("diffuse-lobe", |t| t.diffuse),
            ("specular-lobe", |t| t.specular),
        ];
        for (slug, of) in modes {
            let capture = render(&mut headless, slug);
            for (i, p, terms) in &points {
                (0..3).for_each(|c| near(&format!("{slug} of {material:?}"), capture.raw[*i][c], of(terms)[c], *p));
            }
        }
    }
}

#[test]
fn the_picture_is_the_sum_over_light_ambient_and_emission() {
    let mut headless = open(&model(&MATERIALS[0], &lamps()[0]));
    for lamp in &lamps() {
        for material in &MATERIALS {
            headless.set_model(load(&model(material, lamp))).unwrap();
            let places = positions(&mut headless);
            let ambient = render(&mut headless, "ambient");
            let capture = render(&mut headless, "final");
            let mut brightest = 0.0_f64;
            for (i, p) in places {
                let (l, irradiance) = (lamp.at)(p);
                let terms = terms(material, p.normalize(), l, (EYE - p).normalize());
                if terms.n_dot_v < 0.05 || (1e-6..0.02).contains(&terms.n_dot_l) {
                    continue;
                }
                let expected = radiance(material, &terms, irradiance, ambient.raw[i]);
                brightest = brightest.max(expected[0]);
                let what = format!("{} light on {material:?}", lamp.name);
                (0..3).for_each(|c| near(&what, capture.raw[i][c], expected[c], p));
            }
            assert!(brightest > 0.2, "{}: the light must reach the sphere", lamp.name);
        }
    }
}

/// The shader unrolls the loop over up to four lights, and uses a dynamic count for more.
#[test]
fn many_lights_are_as_bright_as_one_that_has_their_light() {
    let (material, lamp) = (&MATERIALS[0], &lamps()[0]);
    let mut headless = open(&model(material, lamp));
    let one = render(&mut headless, "final");
    let brightest = one.raw.iter().map(|value| value[0]).fold(0.0, f32::max);
    assert!(brightest > 0.2, "{brightest}");
    for count in [2, 4, 5, 9] {
        let mut light = lamp.json.clone();
        light["intensity"] = json!(12.0 / count as f64);
        let bytes = glb::model_with_lights(&glb::sphere(48, 96), &material.json(), &light, &lamp.node, count);
        headless.set_model(load(&bytes)).unwrap();
        let many = render(&mut headless, "final");
        let apart = one.raw.iter().flatten().zip(many.raw.iter().flatten()).map(|(a, b)| (a - b).abs());
        let most = apart.fold(0.0, f32::max);
        assert!(most < 1e-4 * brightest, "{count} lights are off by {most}");
    }
}

/// The albedo towards v of a metal with F = 1 after one reflection, integrated over the hemisphere.
fn white_albedo(n_dot_v: f64, roughness: f64) -> f64 {
    let white = Material { base_color: [1.0; 3], metallic: 1.0, roughness, emissive: [0.0; 3] };
    let v = DVec3::new((1.0 - n_dot_v * n_dot_v).sqrt(), 0.0, n_dot_v);
    // Rings of equal solid angle. The lobe is symmetric to the plane of n and v.
    let (rings, sectors) = (200, 100);
    let sum: f64 = (0..rings * sectors)
        .map(|i| {
            let z = (f64::from(i / sectors) + 0.5) / f64::from(rings);
            let (sin, cos) = (PI * (f64::from(i % sectors) + 0.5) / f64::from(sectors)).sin_cos();
            let r = (1.0 - z * z).sqrt();
            let terms = terms(&white, DVec3::Z, DVec3::new(r * cos, r * sin, z), v);
            terms.d * terms.v * z
        })
        .sum();
    sum * 2.0 * PI / f64::from(rings * sectors)
}

#[test]
fn what_is_scattered_more_than_once_follows_kulla_and_conty() {
    let material = Material { base_color: [0.9, 0.6, 0.3], metallic: 0.75, roughness: 0.9, emissive: [0.0; 3] };
    let lamp = &lamps()[0];
    let mut headless = open(&model(&material, lamp));
    headless.settings_mut().assign("MULTI_SCATTER=KullaConty").unwrap();
    let lobe = render(&mut headless, "multi-scatter-lobe");
    // 2 integral of E(mu) mu dmu
    let mu = |i: i32| (f64::from(i) + 0.5) / 50.0;
    let e_avg = (0..50).map(|i| 2.0 * white_albedo(mu(i), material.roughness) * mu(i) / 50.0).sum::<f64>();
    // F of all orders, from the cosine-weighted mean of Schlick's F.
    let f_ms = |f0: f64| {
        let f_avg = (20.0 * f0 + 1.0) / 21.0;
        f_avg * f_avg * e_avg / (1.0 - f_avg * (1.0 - e_avg))
    };
    let mut count = 0;
    for (i, p) in positions(&mut headless).into_iter().step_by(29) {
        let (n, l, v) = (p.normalize(), (lamp.at)(p).0, (EYE - p).normalize());
        if n.dot(l) < 0.1 || n.dot(v) < 0.1 {
            continue;
        }
        let lost = |cosine: f64| 1.0 - white_albedo(cosine, material.roughness);
        let white = lost(n.dot(l)) * lost(n.dot(v)) / (PI * (1.0 - e_avg));
        for c in 0..3 {
            let f = f_ms(0.04) * (1.0 - material.metallic) + f_ms(material.base_color[c]) * material.metallic;
            let (found, expected) = (f64::from(lobe.raw[i][c]), f * white);
            // The renderer looks E up in a table of half floats.
            assert!((found - expected).abs() < 0.01 * expected, "at {p}: found {found}, expected {expected}");
        }
        count += 1;
    }
    assert!(count > 20, "{count} points are lit and seen");
}

#[test]
fn what_a_material_does_not_say_is_gltfs_default() {
    // glTF 2.0, section 3.9 and its schema: white, metallic, rough. A dielectric has index 1.5, so F0 is 0.04.
    let bare = json!({});
    let dielectric = json!({ "pbrMetallicRoughness": { "metallicFactor": 0.0 } });
    let mut headless = open(&glb::model(&glb::quad(1.0), &bare));
    let mut center = |slug: &str| render(&mut headless, slug).raw_at(SIZE.0 / 2, SIZE.1 / 2).unwrap();
    let ones = ["base-color", "metallic", "roughness", "alpha", "occlusion", "f0", "f90"];
    for (slug, expected) in ones.map(|slug| (slug, 1.0)).into_iter().chain([("emissive", 0.0)]) {
        assert_eq!(center(slug), [expected, expected, expected, 1.0], "{slug}");
    }
    headless.set_model(load(&glb::model(&glb::quad(1.0), &dielectric))).unwrap();
    let mut center = |slug: &str| render(&mut headless, slug).raw_at(SIZE.0 / 2, SIZE.1 / 2).unwrap();
    near("ior", center("ior")[0], 1.5, DVec3::ZERO);
    near("F0", center("f0")[1], 0.04, DVec3::ZERO);
    assert_eq!(center("diffuse-color"), [1.0; 4]);
}

#[test]
fn normals_and_positions_are_where_the_camera_sees_them() {
    let mut headless = open(&model(&MATERIALS[0], &lamps()[0]));
    let places = positions(&mut headless);
    let normals = render(&mut headless, "shading-normal");
    let (width, height) = (SIZE.0 as f32, SIZE.1 as f32);
    // An independent camera: look-at and perspective, with y down on the screen.
    let view = view_from_world(EYE.as_vec3());
    let tan = (45_f32.to_radians() * 0.5).tan();
    for (i, p) in places {
        let n = normals.raw[i];
        (0..3).for_each(|c| near("normal", n[c], p.normalize()[c], p));
        let seen = view.transform_point3(p.as_vec3());
        let (x, y) = (seen.x / (-seen.z * tan * width / height), seen.y / (-seen.z * tan));
        let pixel = [(x + 1.0) * 0.5 * width, (1.0 - y) * 0.5 * height];
        let expected = [(i % SIZE.0 as usize) as f32 + 0.5, (i / SIZE.0 as usize) as f32 + 0.5];
        let off = (pixel[0] - expected[0]).abs().max((pixel[1] - expected[1]).abs());
        assert!(off < 0.01, "{p} is seen in pixel {expected:?}, expected {pixel:?}");
    }
}

/// World to view space for an eye that looks at the origin.
fn view_from_world(eye: Vec3) -> Mat4 {
    let back = eye.normalize();
    let right = Vec3::Y.cross(back).normalize();
    let up = back.cross(right);
    Mat4::from_cols(right.extend(0.0), up.extend(0.0), back.extend(0.0), eye.extend(1.0)).inverse()
}

#[test]
fn straight_down_the_normal_the_terms_have_closed_forms() {
    // With an odd number of pixels, one lies on the axis. Eye and light are both on the axis, 3 m away.
    let light = json!({ "type": "point", "intensity": 9.0 });
    let node = json!({ "translation": [0.0, 0.0, 3.0] });
    for roughness in [0.2, 0.5, 1.0] {
        let material = Material { base_color: [0.8, 0.3, 0.1], metallic: 0.0, roughness, emissive: [0.0; 3] };
        let bytes = glb::model_with_light(&glb::quad(1.0), &material.json(), &light, &node);
        let settings = settings(&[
            "view.msaa=1",
            "environment.name=none",
            "MULTI_SCATTER=None",
            "DIFFUSE_COUPLING=GltfSample",
            "lights.source=model",
            "lights.ambient_strength=0",
            "camera.eye=[0, 0, 3]",
            "camera.target=[0, 0, 0]",
        ]);
        let mut headless = renderer(load(&bytes), settings, (33, 33));
        let mut center = |slug: &str| render(&mut headless, slug).raw_at(16, 16).unwrap();
        let alpha = roughness * roughness;
        let (d, f) = (1.0 / (PI * alpha * alpha), 0.04);
        near("D", center("d")[0], d, DVec3::ZERO);
        near("V", center("v")[0], 0.25, DVec3::ZERO);
        near("F", center("f")[0], f, DVec3::ZERO);
        // 9 cd at 3 m is an irradiance of 1.
        near("L", center("final")[0], (1.0 - f) * 0.8 / PI + d * 0.25 * f, DVec3::ZERO);
    }
}
