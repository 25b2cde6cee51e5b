//! Variants of a model, and the material override.

use crate::support::process::run;
use crate::support::{Renderer, SIZE, assert_differ, assert_same, glb, load, model, render, renderer, settings};
use specula::headless::Headless;
use specula::render::Capture;

fn open(name: &str, more: &[&str]) -> Renderer {
    let direct = ["environment.name=none", "view.msaa=1", "view.background=none"];
    renderer(model(name), settings(&[&direct[..], more].concat()), SIZE)
}

#[test]
fn each_variant_looks_different_and_none_is_the_model_as_it_comes() {
    let mut headless = open("variants", &[]);
    let as_it_comes = render(&mut headless, "final");
    let names = headless.model().variants.clone();
    assert_eq!(*names, ["Porcelain", "Bronze", "Lacquer"]);
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

/// Perceptual roughness to the power of four: alpha^2.
fn alpha2(roughness: f32) -> f32 {
    roughness.powi(4)
}

#[test]
fn specular_antialiasing_widens_a_lobe_by_the_normals_of_a_pixel() {
    let gray = load(&glb::model(&glb::sphere(64, 128), &glb::gray()));
    let direct = ["environment.name=none", "view.msaa=1", "view.background=none", "material.enabled=true"];
    let mut headless = renderer(gray, settings(&[&direct[..], &["material.roughness=0.2"]].concat()), SIZE);
    let plain = render(&mut headless, "roughness");
    assert!(plain.raw.iter().filter(|v| v[3] == 1.0).all(|v| (v[0] - 0.2).abs() < 1e-6), "off by default");
    headless.settings_mut().assign("SPECULAR_ANTIALIASING=true").unwrap();
    let (wide, normals) = (render(&mut headless, "roughness"), render(&mut headless, "shading-normal"));
    let at = |x: usize, y: usize| y * normals.width as usize + x;
    let mut widened = 0;
    // Derivatives are differences within quads, which start at even pixels. Towards the silhouette a quad has several
    // triangles, whose normals are extrapolated.
    for (x, y) in (10..22).flat_map(|y| (18..30).map(move |x| (2 * x, 2 * y))) {
        let quad = [at(x, y), at(x + 1, y), at(x, y + 1), at(x + 1, y + 1)];
        assert!(quad.iter().all(|i| normals.raw[*i][3] == 1.0), "{x}, {y} shows the sphere");
        let squared = |a: usize, b: usize| (0..3).map(|c| (normals.raw[a][c] - normals.raw[b][c]).powi(2)).sum::<f32>();
        let variance = 0.25 * (squared(quad[0], quad[1]) + squared(quad[0], quad[2]));
        let expected = alpha2(0.2) + (2.0 * variance).min(0.18);
        let found = alpha2(wide.raw[quad[0]][0]);
        assert!((found - expected).abs() < 0.05 * expected, "{x}, {y}: {found}, expected {expected}");
        widened += usize::from(found > 1.2 * alpha2(0.2));
    }
    assert!(widened > 50, "{widened} quads have a wider lobe");
    // A flat surface keeps its roughness.
    let flat = load(&glb::model(&glb::quad(1.0), &glb::gray()));
    let mut headless = renderer(flat, settings(&[&direct[..], &["SPECULAR_ANTIALIASING=true"]].concat()), SIZE);
    let values = shown(&mut headless, "roughness");
    assert!(values.iter().all(|v| (v[0] - values[0][0]).abs() < 1e-5 && v[0] > 0.0), "{:?}", values[0]);
}

/// With multisampling, an edge pixel's center may lie outside of its triangle, where vertex colors are extrapolated.
#[test]
fn no_vertex_color_is_negative_at_an_edge() {
    let settings = settings(&["view.msaa=4", "view.background=none", "environment.name=none"]);
    let mut headless = renderer(model("shader-ball"), settings, (960, 474));
    let capture = render(&mut headless, "base-color");
    let least = capture.raw.iter().flatten().copied().fold(f32::INFINITY, f32::min);
    assert!(least >= 0.0, "the base color reaches {least}");
}
