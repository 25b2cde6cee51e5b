//! A picture whose model is drawn in parts is the same, bit by bit, as one that is drawn at once.

use crate::support::{Session, assert_differ, assert_same, assert_validated, glb, load, settings};

/// A sphere of a material before a slab, both in the picture's middle.
fn model(material: &serde_json::Value) -> specula::scene::Model {
    let slab = glb::cuboid([-1.5, -1.5, -0.4], [1.5, 1.5, -0.3], true);
    load(&glb::scene(&[(glb::sphere(24, 48), material.clone()), (slab, glb::gray())]))
}

#[test]
fn parts_make_the_same_picture_as_one_draw() {
    let glass = serde_json::json!({"pbrMetallicRoughness": {"roughnessFactor": 0.3},
        "extensions": {"KHR_materials_transmission": {"transmissionFactor": 0.8}}});
    let blended =
        serde_json::json!({"alphaMode": "BLEND", "pbrMetallicRoughness": {"baseColorFactor": [0.8, 0.2, 0.1, 0.5]}});
    let reads_neighbors = &["AMBIENT_OCCLUSION=true", "BLOOM=true", "passes.ground=true", "SHADOWS=Hard"][..];
    for (name, material, more) in [
        ("multisampled", &glb::gray(), &["view.msaa=4"][..]),
        ("passes that read other pixels and depth", &glb::gray(), reads_neighbors),
        ("transmission", &glass, &["view.msaa=4", "passes.ground=true"]),
        ("transmission without multisampling", &glass, &["view.msaa=1"]),
        ("sorted layers", &blended, &["view.blend_layers=3"]),
        ("a wireframe", &glb::gray(), &["view.wireframe=true", "view.msaa=1"]),
        ("path tracing", &glb::gray(), &["mode=path-traced", "view.frames=2", "view.msaa=1"]),
    ] {
        let mut session = Session::new(model(material), settings(more));
        let whole = session.render();
        for rows in [5, 1000] {
            let parts = session.headless.render_in_parts(rows).unwrap_or_else(|error| panic!("{name}: {error}"));
            assert_same(&parts, &whole, &format!("{name} in parts of {rows} rows"));
        }
        session.set("camera.azimuth=80");
        assert_differ(&session.headless.render_in_parts(7).unwrap(), &whole, &format!("{name} from another place"));
    }
    assert_validated();
}

/// Commands draw it in parts by themselves, since a software device would not answer in time for the whole.
#[test]
fn a_large_picture_of_random_paths_is_the_same_in_parts() {
    let mut session =
        Session::new(model(&glb::gray()), settings(&["mode=path-traced", "view.frames=1", "view.msaa=1"]));
    session.headless.set_size((640, 240)).unwrap();
    let picture = session.render();
    assert_same(&picture, &session.headless.render_in_parts(1000).unwrap(), "in parts and at once");
    assert_validated();
}
