//! The glTF BRDF with all of its extensions, written a second time from the specifications, against the program.
//!
//! Of the program only the inputs are taken, pixel by pixel, from its modes: positions, normals, and the material with its
//! textures read. `reference/` redoes the rest in f64: what the lamps send to the eye must be the same to 1e-3.

mod reference {
    pub mod brdf;
    pub mod film;
    pub mod inputs;
    pub mod sheen;
}
mod support;

use glam::DVec3;
use reference::brdf::{self, Lobes, Masking};
use reference::inputs::Inputs;
use serde_json::json;
use specula::headless::Headless;
use specula::interface::LIGHT_POINT;
use specula::scene::Model;
use support::{glb, load, model, render, renderer, settings};

/// Relative to the value, or to 1 % of the brightest channel at the pixel, or to 1e-3, which is all but black.
const TOLERANCE: f64 = 1e-3;

/// Large enough for a hundred pixels on each ball of a chart.
const SIZE: (u32, u32) = (160, 90);

/// Every so many pixels is compared: some hundred in all.
const STRIDE: usize = 11;

/// A part of the picture: the mode that shows it, and what it is here.
type Part = (&'static str, fn(&Lobes) -> DVec3);

const ALL: Part = ("final", Lobes::all);
const DIFFUSE: Part = ("direct-diffuse", |lobes| lobes.diffuse);
const SPECULAR: Part = ("direct-specular", |lobes| lobes.specular);
const TRANSMITTED: Part = ("transmitted-light", |lobes| lobes.transmitted);
const SHEEN: Part = ("sheen-light", |lobes| lobes.sheen);
const COAT: Part = ("clearcoat-light", |lobes| lobes.coat);

/// The three lamps around the model, nothing else; what the specification has no word on is off.
fn open(model: Model) -> Headless {
    let settings = settings(&[
        "view.msaa=1",
        "view.background=none",
        "environment.name=none",
        "lights.source=orbit",
        "lights.ambient_strength=0",
        "MULTI_SCATTER=None",
    ]);
    renderer(model, settings, SIZE)
}

fn vector(value: [f32; 3]) -> DVec3 {
    DVec3::new(value[0].into(), value[1].into(), value[2].into())
}

/// A part of the picture by the lamps alone.
fn shown(headless: &mut Headless, slug: &str) -> Vec<DVec3> {
    let mut values = |chosen: u32| {
        headless.settings_mut().lights.chosen = chosen;
        render(headless, slug).raw.into_iter().map(|[r, g, b, _]| vector([r, g, b])).collect::<Vec<_>>()
    };
    let mut all = values(0);
    if slug == TRANSMITTED.0 {
        // The mode has what is seen through the surface as well: all that is left when a lamp is chosen that is not there.
        let behind = values(4);
        all.iter_mut().zip(behind).for_each(|(value, behind)| *value -= behind);
    }
    headless.settings_mut().lights.chosen = 0;
    all
}

/// A pixel and what the lamps send from it to the eye.
struct Point {
    pixel: usize,
    lobes: Lobes,
}

fn points(headless: &Headless, inputs: &Inputs, masking: Masking) -> Vec<Point> {
    let shot = headless.shot();
    assert!(shot.lights.len() == 3 && shot.lights.iter().all(|light| light.kind == LIGHT_POINT));
    let at = |pixel: usize| {
        let position = inputs.shown(pixel, "position");
        let (surface, v) = (inputs.surface(pixel), (shot.view.eye.as_dvec3() - position).normalize());
        // Where a normal texture turns the surface away from the eye there is no BRDF.
        if surface.n.dot(v).min(surface.coat.n.dot(v)) < 0.02 {
            return None;
        }
        let lobes = shot.lights.iter().fold(Lobes::default(), |sum, light| {
            let to_light = vector(light.position_ws) - position;
            let irradiance = vector(light.intensity) / to_light.length_squared();
            sum.plus(brdf::shade(&surface, to_light.normalize(), v, masking), irradiance)
        });
        Some(Point { pixel, lobes })
    };
    inputs.covered().step_by(STRIDE).filter_map(at).collect()
}

/// Compares parts of the picture under one masking, and names the worst pixel.
#[track_caller]
fn compare(headless: &mut Headless, inputs: &Inputs, parts: &[Part], masking: Masking) {
    headless.settings_mut().assign(&format!("MASKING_SHADOWING={masking:?}")).unwrap();
    let points = points(headless, inputs, masking);
    let name = headless.model().name.clone();
    assert!(points.len() > 200, "{name}: {} pixels only", points.len());
    for (slug, of) in parts {
        let found = shown(headless, slug);
        let lit = points.iter().filter(|point| of(&point.lobes).max_element() > 1e-2).count();
        assert!(lit > 50, "{name}: {slug} is lit in {lit} pixels only");
        let (mut worst, mut words) = (0.0, String::new());
        let mut beyond = 0;
        for Point { pixel, lobes } in &points {
            let (found, expected) = (found[*pixel], of(lobes));
            let scale = expected.max(DVec3::splat((0.01 * expected.max_element()).max(1e-3)));
            let error = ((found - expected).abs() / scale).max_element();
            if error > TOLERANCE || error.is_nan() { beyond += 1; }
            if error > worst || error.is_nan() {
                let (x, y) = (pixel % SIZE.0 as usize, pixel / SIZE.0 as usize);
                let surface = inputs.surface(*pixel);
                worst = if error.is_nan() { f64::INFINITY } else { error };
                words = format!("pixel ({x}, {y}): found {found}, expected {expected}, {surface:?}");
            }
        }
        eprintln!("{name} {slug} {masking:?}: {} points, worst {worst:.2e}, beyond {beyond}, lit {lit}", points.len());
        if worst >= TOLERANCE { eprintln!("   {words}"); }
    }
}

/// A built-in model.
#[track_caller]
fn check(name: &str, extensions: &[&'static str], parts: &[Part], maskings: &[Masking]) {
    let mut headless = open(model(name));
    let inputs = Inputs::render(&mut headless, extensions);
    maskings.iter().for_each(|masking| compare(&mut headless, &inputs, parts, *masking));
}

const BOTH: [Masking; 2] = [Masking::Separable, Masking::HeightCorrelated];

#[test]
fn metallic_roughness() {
    check("sphere-grid", &[], &[ALL], &BOTH);
}

#[test]
fn clearcoat() {
    check("clearcoat", &["clearcoat", "clearcoat-roughness", "clearcoat-normal"], &[ALL, COAT], &BOTH);
}

#[test]
fn anisotropy() {
    check("anisotropy", &["anisotropy", "anisotropy-direction"], &[ALL], &BOTH);
}

#[test]
fn sheen() {
    check("sheen", &["sheen-color", "sheen-roughness"], &[ALL, SHEEN], &BOTH[..1]);
}

#[test]
fn specular() {
    check("specular", &["specular-factor"], &[ALL], &BOTH[..1]);
}

#[test]
fn iridescence() {
    check("iridescence", &["iridescence", "iridescence-thickness"], &[ALL], &BOTH[..1]);
}

#[test]
fn specular_glossiness() {
    check("specular-glossiness", &[], &[ALL], &BOTH[..1]);
}

#[test]
fn ior_and_transmission() {
    let parts = [DIFFUSE, SPECULAR, TRANSMITTED];
    check("ior", &["transmission", "thickness", "attenuation-color"], &parts[..2], &BOTH[..1]);
    check("transmission", &["transmission"], &parts, &BOTH);
}

#[test]
fn diffuse_transmission() {
    let inputs = ["diffuse-transmission", "diffuse-transmission-color"];
    check("diffuse-transmission", &inputs, &[DIFFUSE, SPECULAR, TRANSMITTED], &BOTH[..1]);
}
