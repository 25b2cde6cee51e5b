//! The sheen of Zeltner, Burley & Chiang 2022 against their matrix and albedo, and edits of sheen in every light.

use std::f64::consts::PI;

use crate::support::{SIZE, Session, glb, load, ready, render, renderer, settings, stages};
use glam::{DMat3, DVec3};
use serde_json::{Value, json};
use specula::render::Capture;
use specula::scene::Model;
use specula::settings::Settings;

const EYE: DVec3 = DVec3::new(1.0, 0.5, 2.5);
const PLACE: DVec3 = DVec3::new(1.5, 1.2, 2.0);

/// A black dielectric with white sheen.
fn velvet(roughness: f64) -> Value {
    json!({ "pbrMetallicRoughness": { "baseColorFactor": [0.0, 0.0, 0.0, 1.0], "metallicFactor": 0.0 },
        "extensions": { "KHR_materials_sheen": { "sheenColorFactor": [1, 1, 1], "sheenRoughnessFactor": roughness } } })
}

/// A sphere of velvet under a lamp.
fn sphere(roughness: f64) -> Model {
    let light = json!({ "type": "point", "intensity": 20.0 });
    let node = json!({ "translation": [PLACE.x, PLACE.y, PLACE.z] });
    load(&glb::model_with_light(&glb::sphere(64, 128), &velvet(roughness), &light, &node))
}

/// The lamp alone, seen from [`EYE`], unless `more` says otherwise.
fn lit(more: &[&str]) -> Settings {
    let plain = ["view.msaa=1", "view.background=none", "lights.source=model", "environment.name=none"];
    let mut settings = settings(&[&plain[..], more].concat());
    settings.assign(&format!("camera.eye=[{}, {}, {}]", EYE.x, EYE.y, EYE.z)).unwrap();
    settings.assign("camera.target=[0, 0, 0]").unwrap();
    settings
}

/// The values on the model.
fn covered(capture: &Capture) -> Vec<DVec3> {
    let values = capture.raw.iter().filter(|v| v[3] == 1.0);
    let found: Vec<_> = values.map(|v| DVec3::new(v[0].into(), v[1].into(), v[2].into())).collect();
    assert!(found.len() > 300, "{} pixels", found.len());
    found
}

/// The authors' fit of the albedo in the cosine `c` and the roughness `r`: a Gaussian and an offset.
fn albedo(c: f64, r: f64) -> f64 {
    let width = r * (0.020_660_7 + 1.584_91 * r) / (0.037_942_4 + r * (1.322_27 + r));
    let mean = r * (-0.193_854 + r * (-1.148_85 + r * (1.7932 - 0.959_43 * r * r))) / (0.046_391 + r);
    let offset = r * (0.000_654_023 + (-0.020_781_8 + 0.119_681 * r) * r) / (1.262_64 + r * (-1.920_21 + r));
    (-0.5 * ((c - mean) / width).powi(2)).exp() / (width * (2.0 * PI).sqrt()) + offset
}

/// f: the density of a cosine lobe under the inverse matrix (Heitz et al. 2016, eq. 1), times the albedo, over NoL.
fn lobe(n: DVec3, l: DVec3, v: DVec3, r: f64) -> f64 {
    let c = n.dot(v);
    let a = (2.581_26 * c + 0.813_703 * r) * r / (1.0 + 0.310_327 * c * c + 2.609_94 * c * r);
    let below = 0.000_025_405_3 + 1.712_28 * c - 1.715_06 * c * r + 1.341_74 * r * r;
    let b = (1.0 - c).sqrt() * (r - 1.0) * r.powi(3) / below;
    let x = (v - n * c).normalize();
    let inverse = DMat3::from_cols(DVec3::new(a, 0.0, 0.0), DVec3::new(0.0, a, 0.0), DVec3::new(b, 0.0, 1.0));
    let original = inverse * DVec3::new(l.dot(x), l.dot(n.cross(x)), l.dot(n));
    let jacobian = inverse.determinant() / original.length().powi(3);
    albedo(c, r) * original.normalize().z / PI * jacobian / n.dot(l)
}

#[test]
fn the_zeltner_lobe_is_a_transformed_cosine_times_its_albedo() {
    for roughness in [0.2, 0.5, 1.0] {
        let mut headless = renderer(sphere(roughness), lit(&["SHEEN=ZeltnerLTC"]), SIZE);
        let [lobes, normals, positions] =
            ["sheen-lobe", "shading-normal", "position"].map(|mode| covered(&render(&mut headless, mode)));
        let mut count = 0;
        for ((found, n), p) in lobes.iter().zip(&normals).zip(&positions) {
            let (l, v) = ((PLACE - *p).normalize(), (EYE - *p).normalize());
            if n.dot(l) > 0.02 && (0.02..0.9999).contains(&n.dot(v)) {
                let expected = lobe(*n, l, v, roughness);
                let error = (found.x - expected).abs() / expected.max(0.01);
                assert!(error < 2e-3, "roughness {roughness}, n {n}: {}, expected {expected}", found.x);
                count += 1;
            }
        }
        assert!(count > 300, "{count} pixels compared");
    }
}

#[test]
fn in_a_furnace_the_zeltner_sheen_returns_its_albedo() {
    for roughness in [0.3, 0.7, 1.0] {
        let in_furnace = lit(&["SHEEN=ZeltnerLTC", "lights.source=none", "environment.name=furnace"]);
        let mut headless = renderer(sphere(roughness), in_furnace, SIZE);
        let [light, cosines] = ["sheen-light", "n-dot-v"].map(|mode| covered(&render(&mut headless, mode)));
        for (found, c) in light.iter().zip(&cosines) {
            let expected = albedo(c.x, roughness);
            assert!((found.x - expected).abs() < 0.006, "roughness {roughness}, NoV {}: {found}, {expected}", c.x);
        }
    }
}

/// A floor seen at a grazing angle: where the mode `energy` is red, and the largest albedo elsewhere.
fn energy(roughness: f64, sheen: &str) -> (usize, f64) {
    let bytes = glb::model(&glb::quad(40.0), &velvet(roughness));
    let plain = ["view.msaa=1", "view.background=none", "environment.name=none", "camera.eye=[0, -8, 0.4]"];
    let settings = settings(&[&plain[..], &[sheen, "camera.target=[0, 0, 0]"]].concat());
    let values = covered(&render(&mut renderer(load(&bytes), settings, SIZE), "energy"));
    let is_red = |v: &DVec3| v.x == 1.0 && v.y < 0.1;
    let plain = values.iter().filter(|v| !is_red(v)).map(|v| v.max_element());
    (values.iter().filter(|v| is_red(v)).count(), plain.fold(0.0, f64::max))
}

#[test]
fn the_zeltner_sheen_gains_no_energy_where_charlie_does() {
    assert!(energy(0.15, "SHEEN=Charlie").0 > 50, "Charlie gains energy at grazing angles");
    for roughness in [0.15, 0.3, 0.6, 1.0] {
        let (red, largest) = energy(roughness, "SHEEN=ZeltnerLTC");
        assert_eq!(red, 0, "roughness {roughness}");
        assert!((0.3..0.95).contains(&largest), "roughness {roughness}: {largest}");
    }
}

#[test]
fn under_a_sun_sheen_is_as_bright_as_random_paths() {
    for sheen in ["SHEEN=Charlie", "SHEEN=ZeltnerLTC"] {
        for roughness in [0.2, 0.5, 1.0] {
            let in_sun = lit(&[sheen, "lights.source=none", "environment.name=sky", "view.frames=24"]);
            let mut headless = renderer(sphere(roughness), in_sun, SIZE);
            let [picture, paths] = ["final", "monte-carlo"]
                .map(|mode| covered(&render(&mut headless, mode)).iter().map(|light| light.element_sum()).sum::<f64>());
            let error = picture / paths - 1.0;
            println!("{sheen}, roughness {roughness}: {:.1} %", 100.0 * error);
            assert!(error.abs() < 0.05, "{sheen}, roughness {roughness}: {:.1} % off", 100.0 * error);
        }
    }
}

#[test]
fn an_edit_of_sheen_reaches_lamps_table_and_prefiltered_light() {
    let mut session = Session::new(sphere(0.5), lit(&[]));
    let lamp = covered(&session.mode("sheen-lobe"));
    session.set("lights.source=none");
    let mean_light = |session: &mut Session| {
        let [by_studio, albedo] = ["studio", "furnace"].map(|name| {
            session.set(&format!("environment.name={name}"));
            covered(&session.mode("sheen-light"))
        });
        (by_studio.iter().zip(&albedo).map(|(a, b)| a.x / b.x).collect::<Vec<_>>(), albedo)
    };
    let (prefiltered, table) = mean_light(&mut session);
    // Half of the light, gathered from around the normal.
    let charlie = "return d_charlie(n_dot_h, alpha)";
    let reload =
        session.edit("brdf/layers/sheen.glsl", charlie, "return 0.5 * pow(n_dot_l, 4.0) * d_charlie(n_dot_h, alpha)");
    ready(&reload);
    assert_eq!(
        stages(&reload),
        ["debug.frag", "ibl/prefilter_sheen.comp", "ibl/sheen_albedo.comp", "paths.frag", "pbr.frag"]
    );
    let (narrower, less) = mean_light(&mut session);
    session.set("lights.source=model");
    session.set("environment.name=none");
    let weaker = covered(&session.mode("sheen-lobe"));
    let sum = |values: &[DVec3]| values.iter().map(|v| v.x).sum::<f64>();
    assert!(sum(&weaker) < 0.5 * sum(&lamp) && sum(&less) < 0.3 * sum(&table));
    let changed = prefiltered.iter().zip(&narrower).filter(|(a, b)| (*a - *b).abs() > 0.05 * *a).count();
    assert!(changed > 100, "the prefiltered light of {changed} pixels followed");
}
