//! An independent implementation of glTF's BRDF with all extensions, from the specifications, against the renderer.
//!
//! The renderer provides only the inputs per pixel, from its debug modes: positions, normals, and the sampled material.
//! `reference/` computes the rest in f64. The radiance from the lamps must agree to 1e-3.

mod brdf;
mod film;
mod glass;
mod inputs;
mod sheen;

use crate::support::{Renderer, glb, load, model, render, renderer, settings};
use brdf::{Lobes, Masking};
use exr::prelude::{Image, SpecificChannels, WritableImage as _};
use glam::DVec3;
use glass::Glass;
use inputs::Inputs;
use serde_json::json;
use specula::headless::Headless;
use specula::interface::LIGHT_POINT;
use specula::scene::Model;

/// Tolerance, relative to the value, to 1 % of the pixel's brightest channel, or to 1e-3 (almost black).
const TOLERANCE: f64 = 1e-3;

/// Gives each ball of a chart about a hundred pixels.
const SIZE: (u32, u32) = (160, 90);

/// Compares every so many pixels: some hundred in all.
const STRIDE: usize = 11;

/// A pixel and its reference radiance.
struct Point {
    pixel: usize,
    lobes: Lobes,
    emitted: DVec3,
}

/// A part of the picture: the mode that shows it and its reference.
type Part = (&'static str, fn(&Point) -> DVec3);

const ALL: Part = ("final", |point| point.lobes.all() + point.emitted);
const DIFFUSE: Part = ("direct-diffuse", |point| point.lobes.diffuse);
const SPECULAR: Part = ("direct-specular", |point| point.lobes.specular);
const TRANSMITTED: Part = ("transmitted-light", |point| point.lobes.transmitted);
const SHEEN: Part = ("sheen-light", |point| point.lobes.sheen);
const COAT: Part = ("clearcoat-light", |point| point.lobes.coat);
const EMITTED: Part = ("emissive-only", |point| point.emitted);

/// Lights the model with three lamps only, and turns off what the specification does not define.
fn open(model: Model) -> Renderer {
    let settings = settings(&[
        "view.msaa=1",
        "view.background=none",
        "environment.name=none",
        "lights.source=orbit",
        "lights.ambient_strength=0",
        "MULTI_SCATTER=None",
        "DIFFUSE_COUPLING=GltfSample",
    ]);
    renderer(model, settings, SIZE)
}

fn vector([x, y, z]: [f32; 3]) -> DVec3 {
    DVec3::new(x.into(), y.into(), z.into())
}

/// The part of the picture that a mode shows, lit by the lamps alone.
fn shown(headless: &mut Headless, slug: &str) -> Vec<DVec3> {
    let mut values = |chosen: u32| {
        headless.settings_mut().lights.chosen = chosen;
        render(headless, slug).raw.into_iter().map(|[r, g, b, _]| vector([r, g, b])).collect::<Vec<_>>()
    };
    let mut all = values(0);
    if slug == TRANSMITTED.0 {
        // The mode also includes what is seen through the surface. Selecting a lamp that does not exist leaves only
        // that.
        let behind = values(4);
        all.iter_mut().zip(behind).for_each(|(value, behind)| *value -= behind);
    }
    headless.settings_mut().lights.chosen = 0;
    all
}

/// The sampled pixels with their reference.
fn points(headless: &Headless, inputs: &Inputs, masking: Masking) -> Vec<Point> {
    let state = headless.frame_state().unwrap();
    assert!(state.lights.len() == 3 && state.lights.iter().all(|light| light.kind == LIGHT_POINT));
    let at = |pixel: usize| {
        let position = inputs.shown(pixel, "position");
        let (surface, v) = (inputs.surface(pixel), (state.camera.eye.as_dvec3() - position).normalize());
        // No BRDF is defined where a normal texture turns the surface away from the eye.
        if surface.n.dot(v).min(surface.coat.n.dot(v)) < 0.02 {
            return None;
        }
        let lobes = state.lights.iter().fold(Lobes::default(), |sum, light| {
            let [x, y, z, _] = light.position_ws;
            let to_light = vector([x, y, z]) - position;
            let irradiance = vector(light.intensity) / to_light.length_squared();
            sum.plus(brdf::shade(&surface, to_light.normalize(), v, masking), irradiance)
        });
        Some(Point { pixel, lobes, emitted: brdf::emission(&surface, v) })
    };
    inputs.covered().step_by(STRIDE).filter_map(at).collect()
}

/// Compares parts of the picture under one masking-shadowing model, and reports the worst pixel.
#[track_caller]
fn compare(headless: &mut Headless, inputs: &Inputs, parts: &[Part], masking: Masking) {
    headless.settings_mut().assign(&format!("MASKING_SHADOWING={masking:?}")).unwrap();
    let points = points(headless, inputs, masking);
    let name = headless.model().name.clone();
    assert!(points.len() > 200, "{name}: {} pixels only", points.len());
    for (slug, of) in parts {
        let found = shown(headless, slug);
        let lit = points.iter().filter(|point| of(point).max_element() > 1e-2).count();
        assert!(lit > 50, "{name}: {slug} is lit in {lit} pixels only");
        let error = |point: &Point| {
            let (found, expected) = (found[point.pixel], of(point));
            let scale = expected.max(DVec3::splat((0.01 * expected.max_element()).max(1e-3)));
            let error = ((found - expected).abs() / scale).max_element();
            if found.is_finite() { error } else { f64::INFINITY }
        };
        let worst = points.iter().max_by(|a, b| error(a).total_cmp(&error(b))).unwrap();
        let (pixel, allowed) = (worst.pixel, TOLERANCE);
        let (x, y) = (pixel % SIZE.0 as usize, pixel / SIZE.0 as usize);
        assert!(
            error(worst) < allowed,
            "{name}, {slug}, {masking:?}: off by {:.2e}, allowed {allowed}, at pixel ({x}, {y}): found {}, \
             expected {}\nthere: {:?}",
            error(worst),
            found[pixel],
            of(worst),
            inputs.surface(pixel),
        );
    }
}

/// A built-in model.
#[track_caller]
fn check(name: &str, extensions: &[&'static str], parts: &[Part]) {
    let model = model(name);
    let mut headless = open(model.clone());
    let inputs = Inputs::render(&mut headless, &model, extensions);
    compare(&mut headless, &inputs, parts, Masking::Separable);
}

#[test]
fn metallic_roughness() {
    let model = model("sphere-grid");
    let mut headless = open(model.clone());
    let inputs = Inputs::render(&mut headless, &model, &[]);
    compare(&mut headless, &inputs, &[ALL], Masking::Separable);
    compare(&mut headless, &inputs, &[ALL], Masking::HeightCorrelated);
}

#[test]
fn clearcoat() {
    check("clearcoat", &["clearcoat", "clearcoat-roughness", "clearcoat-normal"], &[ALL]);
}

#[test]
fn anisotropy() {
    let model = model("anisotropy");
    let mut headless = open(model.clone());
    let inputs = Inputs::render(&mut headless, &model, &["anisotropy", "anisotropy-direction", "tangent", "bitangent"]);
    compare(&mut headless, &inputs, &[ALL], Masking::Separable);
    compare(&mut headless, &inputs, &[ALL], Masking::HeightCorrelated);
    // Counterclockwise from the tangent, by up to 135 degrees.
    let mut turned = 0;
    for pixel in inputs.covered() {
        let material = inputs.material(pixel);
        let plain = material.textures.iter().all(Option::is_none);
        let Some(found) = inputs.extra(pixel, "anisotropy-direction").filter(|_| plain) else { continue };
        let [cos, sin] = material.numbers.anisotropy_rotation.map(f64::from);
        let expected = inputs.shown(pixel, "tangent") * cos + inputs.shown(pixel, "bitangent") * sin;
        // Interpolated tangents are not exactly unit, nor exactly perpendicular to the normal.
        assert!(found.dot(expected) > 1.0 - 1e-3, "pixel {pixel}: found {found}, expected {expected}");
        turned += usize::from(sin != 0.0);
    }
    assert!(turned > 200, "only {turned} pixels have a direction other than the tangent");
}

#[test]
fn sheen() {
    check("sheen", &["sheen-color", "sheen-roughness"], &[ALL]);
}

#[test]
fn specular() {
    check("specular", &["specular-factor", "specular-color"], &[ALL]);
}

#[test]
fn specular_glossiness() {
    check("specular-glossiness", &["specular-color"], &[ALL]);
}

#[test]
fn iridescence() {
    check("iridescence", &["iridescence", "iridescence-thickness"], &[ALL]);
}

#[test]
fn ior() {
    // In this chart the lamps' transmitted light is a point, unlike in the chart of transmission.
    check("ior", &["transmission", "thickness", "attenuation-color"], &[DIFFUSE, SPECULAR]);
}

#[test]
fn transmission() {
    check("transmission", &["transmission"], &[DIFFUSE, SPECULAR, TRANSMITTED]);
}

#[test]
fn diffuse_transmission() {
    let inputs = ["diffuse-transmission", "diffuse-transmission-color"];
    check("diffuse-transmission", &inputs, &[DIFFUSE, SPECULAR, TRANSMITTED]);
}

#[test]
fn every_layer_over_every_other() {
    let material = json!({
        "emissiveFactor": [0.3, 0.2, 0.1],
        "pbrMetallicRoughness":
            { "baseColorFactor": [0.8, 0.5, 0.3, 1.0], "metallicFactor": 0.3, "roughnessFactor": 0.45 },
        "extensions": {
            "KHR_materials_clearcoat": { "clearcoatFactor": 0.7, "clearcoatRoughnessFactor": 0.3 },
            "KHR_materials_sheen": { "sheenColorFactor": [0.2, 0.5, 0.4], "sheenRoughnessFactor": 0.5 },
            "KHR_materials_ior": { "ior": 1.4 },
            "KHR_materials_specular": { "specularFactor": 0.8, "specularColorFactor": [1.0, 3.0, 2.0] },
            "KHR_materials_iridescence":
                { "iridescenceFactor": 0.6, "iridescenceIor": 1.7, "iridescenceThicknessMaximum": 350.0 },
            "KHR_materials_transmission": { "transmissionFactor": 0.4 },
            "KHR_materials_diffuse_transmission":
                { "diffuseTransmissionFactor": 0.6, "diffuseTransmissionColorFactor": [0.5, 0.9, 0.7] },
            "KHR_materials_volume":
                { "thicknessFactor": 0.4, "attenuationDistance": 0.5, "attenuationColor": [0.9, 0.6, 0.3] },
        },
    });
    let modes = [
        "clearcoat",
        "clearcoat-roughness",
        "clearcoat-normal",
        "sheen-color",
        "sheen-roughness",
        "iridescence",
        "iridescence-thickness",
        "transmission",
        "diffuse-transmission",
        "diffuse-transmission-color",
        "thickness",
        "attenuation-color",
    ];
    let model = load(&glb::model(&glb::sphere(48, 96), &material));
    let mut headless = open(model.clone());
    let inputs = Inputs::render(&mut headless, &model, &modes);
    let parts = [DIFFUSE, SPECULAR, TRANSMITTED, SHEEN, COAT, EMITTED];
    compare(&mut headless, &inputs, &parts, Masking::Separable);
}

/// An environment that is brighter towards +Y: 1 + 0.8 y.
fn light_from_above() -> Vec<u8> {
    const ROWS: usize = 256;
    let radiance = |at: exr::prelude::Vec2<usize>| {
        let polar = std::f64::consts::PI * (at.y() as f64 + 0.5) / ROWS as f64;
        let value = (1.0 + 0.8 * polar.cos()) as f32;
        (value, value, value)
    };
    let mut bytes = std::io::Cursor::new(Vec::new());
    Image::from_channels((2 * ROWS, ROWS), SpecificChannels::rgb(radiance)).write().to_buffered(&mut bytes).unwrap();
    bytes.into_inner()
}

/// The glTF material of the glass.
fn material_of(glass: &Glass) -> serde_json::Value {
    json!({
        "pbrMetallicRoughness": {
            "baseColorFactor": [glass.base_color.x, glass.base_color.y, glass.base_color.z, 1.0],
            "metallicFactor": 0.0,
            "roughnessFactor": 0.0,
        },
        "extensions": {
            "KHR_materials_transmission": { "transmissionFactor": 1.0 },
            "KHR_materials_ior": { "ior": glass.ior },
            "KHR_materials_dispersion": { "dispersion": glass.dispersion },
            "KHR_materials_volume": {
                "thicknessFactor": glass.thickness,
                "attenuationColor": glass.attenuation_color.to_array(),
                "attenuationDistance": glass.attenuation_distance,
            },
        },
    })
}

/// Compares what is seen through `glass` at each sampled pixel with `expected`, a function of position, normal and v.
/// Requires that the reference varies, so that the comparison means something.
#[track_caller]
fn compare_glass(headless: &mut Headless, what: &str, expected: impl Fn(DVec3, DVec3, DVec3) -> DVec3) {
    let mut shown = |slug: &str| render(headless, slug).raw;
    let (positions, normals, found) = (shown("position"), shown("shading-normal"), shown("transmitted-light"));
    let is_glass = shown("transmission");
    let eye = headless.frame_state().unwrap().camera.eye.as_dvec3();
    // Half a step of the prefiltered maps, which hold mantissas of 9 bits.
    const SHARED_EXPONENT: f64 = 1.0 / 512.0;
    let (mut least, mut most, mut count) = (f64::INFINITY, 0.0_f64, 0);
    for pixel in (0..positions.len()).filter(|i| is_glass[*i][0] == 1.0 && is_glass[*i][3] == 1.0) {
        let at = |values: &[[f32; 4]]| vector([values[pixel][0], values[pixel][1], values[pixel][2]]);
        let (position, n) = (at(&positions), at(&normals).normalize());
        let v = (eye - position).normalize();
        // Tolerance for the steps of the albedo table, in which F rises fast near the rim, and for half floats.
        if n.dot(v) < 0.15 {
            continue;
        }
        let (found, expected) = (at(&found), expected(position, n, v));
        let error = ((found - expected).abs() / expected).max_element();
        assert!(
            error < TOLERANCE + SHARED_EXPONENT,
            "{what}, pixel {pixel}: found {found}, expected {expected}, off by {error:.2e}"
        );
        (least, most, count) = (least.min(expected.min_element()), most.max(expected.max_element()), count + 1);
    }
    assert!(count > 200 && most > 1.3 * least, "{what}: {count} pixels from {least} to {most}");
}

/// A drop of glass in front of an environment whose radiance encodes the direction of each color's ray.
#[test]
fn glass_bends_swallows_and_spreads() {
    let directory = tempfile::tempdir().unwrap();
    let sky = directory.path().join("above.exr");
    std::fs::write(&sky, light_from_above()).unwrap();
    let pane = Glass {
        base_color: DVec3::new(0.9, 0.8, 0.7),
        ior: 1.5,
        dispersion: 0.0,
        thickness: 0.0,
        attenuation_color: DVec3::ONE,
        attenuation_distance: 1.0,
    };
    let body = Glass { thickness: 0.4, ior: 1.33, ..pane };
    let colored = Glass { attenuation_color: DVec3::new(0.2, 0.9, 0.5), attenuation_distance: 0.3, ..body };
    let prism = Glass { ior: 1.8, dispersion: 12.0, ..colored };
    for (what, glass) in [("pane", pane), ("body", body), ("colored", colored), ("prism", prism)] {
        let settings = settings(&[
            "view.msaa=1",
            "view.background=none",
            "lights.source=none",
            "camera.elevation=25",
            &format!("environment.name={}", sky.display()),
        ]);
        let model = load(&glb::model(&glb::sphere(48, 96), &material_of(&glass)));
        let mut headless = renderer(model, settings, SIZE);
        let radiance = |direction: DVec3| 1.0 + 0.8 * direction.y;
        compare_glass(&mut headless, what, |_, n, v| {
            let seen = glass.iors().map(|ior| radiance(glass.refracted(n, v, ior)));
            glass.passes(n, v) * DVec3::from_array(seen)
        });
    }
}

/// A wall 1 m behind a slab of glass encodes x in red and y in green: it must appear where the refracted ray exits.
#[test]
fn glass_shifts_what_is_behind_it() {
    const REACH: f64 = 4.0;
    let glass = Glass {
        base_color: DVec3::ONE,
        ior: 1.6,
        dispersion: 8.0,
        thickness: 0.5,
        attenuation_color: DVec3::new(0.7, 0.8, 0.9),
        attenuation_distance: 1.0,
    };
    let (mut json, mut bin) = glb::document(&glb::quad(0.4), &material_of(&glass));
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let of_corners = |value: fn(f64, f64) -> [f32; 3]| corners.map(|(x, y)| value(x, y));
    let walls = [
        of_corners(|x, y| [(REACH * x) as f32, (REACH * y) as f32, -1.0]),
        of_corners(|x, y| [(0.5 + 0.5 * x) as f32, (0.5 + 0.5 * y) as f32, 0.5]),
    ];
    let list = |name: &str, json: &serde_json::Value| json[name].as_array().unwrap().len();
    let first = list("accessors", &json);
    for values in walls {
        let bytes: Vec<u8> = values.as_flattened().iter().flat_map(|value| value.to_le_bytes()).collect();
        let view = json!({ "buffer": 0, "byteOffset": bin.len(), "byteLength": bytes.len() });
        let accessor = json!({ "bufferView": list("bufferViews", &json), "componentType": 5126, "count": 4, "type": "VEC3",
            "min": [-REACH, -REACH, -1.0], "max": [REACH, REACH, 1.0] });
        json["bufferViews"].as_array_mut().unwrap().push(view);
        json["accessors"].as_array_mut().unwrap().push(accessor);
        bin.extend(bytes);
    }
    json["buffers"][0]["byteLength"] = json!(bin.len());
    let indices = json["meshes"][0]["primitives"][0]["indices"].clone();
    let attributes = json!({ "POSITION": first, "COLOR_0": first + 1 });
    let wall = json!({ "primitives": [{ "attributes": attributes, "indices": indices, "material": 1 }] });
    json["meshes"].as_array_mut().unwrap().push(wall);
    json["materials"].as_array_mut().unwrap().push(json!({ "extensions": { "KHR_materials_unlit": {} } }));
    json["nodes"] = json!([{ "mesh": 0 }, { "mesh": 1 }]);
    json["scenes"] = json!([{ "nodes": [0, 1] }]);

    let settings = settings(&[
        "view.msaa=1",
        "view.background=none",
        "lights.source=none",
        "lights.ambient_strength=0",
        "environment.name=none",
        "camera.eye=[0.6, 0.4, 2.5]",
        "camera.target=[0.0, 0.0, 0.0]",
    ]);
    let mut headless = renderer(load(&glb::container(&json, &bin)), settings, SIZE);
    let eye = headless.frame_state().unwrap().camera.eye.as_dvec3();
    compare_glass(&mut headless, "slab", |position, n, v| {
        let seen = glass.iors().map(|ior| {
            let exit = position + glass.refracted(n, v, ior) * glass.thickness;
            let ray = exit - eye;
            let wall = eye + ray * ((-1.0 - eye.z) / ray.z);
            0.5 + 0.5 * wall / REACH
        });
        glass.passes(n, v) * DVec3::new(seen[0].x, seen[1].y, 0.5)
    });
}
