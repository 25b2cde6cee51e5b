//! Variants of a model, and the material override.

mod support;

use specula::headless::Headless;
use specula::render::Capture;
use support::process::run;
use support::{SIZE, assert_differ, assert_same, model, render, renderer, settings};

fn open(name: &str, more: &[&str]) -> Headless {
    let direct = ["environment.name=none", "view.msaa=1", "view.background=none"];
    renderer(model(name), settings(&[&direct[..], more].concat()), SIZE)
}

#[test]
fn each_variant_looks_different_and_none_is_the_model_as_it_comes() {
    let mut headless = open("variants", &[]);
    let as_it_comes = render(&mut headless, "final");
    let names = headless.model().variants.clone();
    assert_eq!(names, ["Porcelain", "Bronze", "Lacquer"]);
    let pictures: Vec<Capture> = names
        .iter()
        .map(|name| {
            headless.settings_mut().assign(&format!("variant={name}")).unwrap();
            render(&mut headless, "final")
        })
        .collect();
    for (a, b) in [(0, 1), (1, 2), (2, 0)] {
        assert_differ(&pictures[a], &pictures[b], &format!("{} and {}", names[a], names[b]));
    }
    headless.settings_mut().variant.clear();
    assert_same(&as_it_comes, &render(&mut headless, "final"), "no variant");
    headless.settings_mut().variant = "Gold".into();
    let error = headless.render().unwrap_err().to_string();
    assert!(["Gold", "Porcelain, Bronze, Lacquer"].iter().all(|part| error.contains(part)), "{error}");
}

#[test]
fn an_unknown_variant_is_told_with_those_that_exist() {
    let directory = tempfile::tempdir().unwrap();
    let render = |model: &str| {
        let args = ["render", model, "--env", "none", "--size", "48x32", "--set", "variant=Gold", "--out", "out.png"];
        run(directory.path(), &args)
    };
    render("variants").expect(2, &["Gold", "Porcelain, Bronze, Lacquer"]);
    render("material-override").expect(2, &["Gold", "it has none"]);
    assert!(!directory.path().join("out.png").exists());
}

/// The values of a mode on the model.
fn shown(headless: &mut Headless, slug: &str) -> Vec<[f32; 3]> {
    let capture = render(headless, slug);
    capture.raw.iter().filter(|value| value[3] == 1.0).map(|value| [value[0], value[1], value[2]]).collect()
}

#[test]
fn a_material_of_ones_own_stands_in_for_all_of_the_models() {
    let mut headless = open("clearcoat", &[]);
    let own = render(&mut headless, "final");
    for assignment in [
        "material.enabled=true",
        "material.base_color=[0.25, 0.5, 0.75]",
        "material.metallic=0.5",
        "material.roughness=0.75",
        "material.anisotropy=0.5",
    ] {
        headless.settings_mut().assign(assignment).unwrap();
    }
    for (slug, expected) in [
        ("base-color", [0.25, 0.5, 0.75]),
        ("metallic", [0.5; 3]),
        ("roughness", [0.75; 3]),
        ("anisotropy", [0.5; 3]),
        ("occlusion", [1.0; 3]),
        ("emissive", [0.0; 3]),
    ] {
        let values = shown(&mut headless, slug);
        let near = |value: &[f32; 3]| value.iter().zip(expected).all(|(a, b): (&f32, f32)| (a - b).abs() < 1e-5);
        assert!(values.len() > 300 && values.iter().all(near), "{slug}: {} of {:?}", values.len(), values.first());
    }
    assert!(
        shown(&mut headless, "clearcoat").iter().all(|value| [0.180017, 0.260017].contains(&value[0])),
        "a coat is left"
    );
    // The shading normals are the mesh's, without the bumps of textures.
    assert_eq!(shown(&mut headless, "shading-normal"), shown(&mut headless, "geometric-normal"));
    headless.settings_mut().material.enabled = false;
    assert_same(&own, &render(&mut headless, "final"), "the model's own materials again");
}

#[test]
fn the_axis_of_anisotropy_turns() {
    let mut headless = open("material-override", &["material.enabled=true", "material.anisotropy=1"]);
    let along = shown(&mut headless, "anisotropy-direction");
    let tangent = shown(&mut headless, "tangent");
    headless.settings_mut().material.anisotropy_rotation = 90.0;
    let across = shown(&mut headless, "anisotropy-direction");
    let dot = |a: &[f32; 3], b: &[f32; 3]| (0..3).map(|c| a[c] * b[c]).sum::<f32>();
    // The tangent is interpolated; the axis is perpendicular to the normal.
    assert!(along.iter().zip(&tangent).all(|(a, t)| dot(a, t) > 0.99), "0 degrees is the tangent");
    assert!(along.iter().zip(&across).all(|(a, b)| dot(a, b).abs() < 0.01), "90 degrees is at right angles to it");
}
