//! Blended surfaces that intersect: sorted in each pixel, they blend in the order of their depths.

use crate::support::{Session, assert_same, failed, glb, lines, load, model, ready, settings};
use serde_json::{Value, json};
use specula::scene::Model;

/// Half the width and height of each surface, meters.
const HALF: [f32; 2] = [0.8, 0.6];
/// Depth of the opaque wall, which cuts through the surfaces.
const WALL: f32 = -0.35;
/// Height of the view, meters.
const HEIGHT: f64 = 2.0;

/// A surface z = slope x + offset.
struct Pane {
    slope: f32,
    offset: f32,
    color: [f32; 4],
}

/// Panes that cross each other before and behind the wall. No order of whole panes is right.
const PANES: [Pane; 5] = [
    Pane { slope: -0.8, offset: 0.05, color: [0.9, 0.1, 0.1, 0.5] },
    Pane { slope: 0.7, offset: 0.1, color: [0.1, 0.8, 0.2, 0.4] },
    Pane { slope: -0.3, offset: -0.1, color: [0.1, 0.2, 0.9, 0.6] },
    Pane { slope: 0.25, offset: 0.0, color: [0.9, 0.8, 0.1, 0.3] },
    Pane { slope: 0.05, offset: 0.2, color: [0.2, 0.7, 0.8, 0.7] },
];

impl Pane {
    fn mesh(&self) -> glb::Mesh {
        let [x, y] = HALF;
        let corners = [[-x, -y], [x, -y], [x, y], [-x, y]];
        let positions = corners.map(|[x, y]| [x, y, self.slope * x + self.offset]).to_vec();
        glb::Mesh { positions, ..glb::quad(1.0) }
    }
}

fn unlit(color: [f32; 4], mode: &str) -> Value {
    json!({ "pbrMetallicRoughness": { "baseColorFactor": color }, "alphaMode": mode, "doubleSided": true,
        "extensions": { "KHR_materials_unlit": {} } })
}

fn wall() -> (glb::Mesh, Value) {
    let mut wall = glb::quad(2.0);
    wall.positions.iter_mut().for_each(|position| position[2] = WALL);
    (wall, unlit([1.0; 4], "OPAQUE"))
}

/// The panes and the wall, each a primitive with its own material.
fn primitives() -> Model {
    let panes = PANES.iter().map(|pane| (pane.mesh(), unlit(pane.color, "BLEND")));
    load(&glb::scene(&panes.chain([wall()]).collect::<Vec<_>>()))
}

/// The panes as one primitive whose vertices have their colors, and the wall.
fn one_primitive() -> Model {
    let mut all = glb::Mesh::default();
    for pane in &PANES {
        let first = all.positions.len() as u32;
        let mesh = pane.mesh();
        all.indices.extend(mesh.indices.iter().map(|index| first + index));
        all.positions.extend(mesh.positions);
        all.normals.extend(mesh.normals);
    }
    let colors: Vec<u8> = PANES.iter().flat_map(|pane| [pane.color; 4]).flatten().flat_map(f32::to_le_bytes).collect();
    let (mut json, mut bin) = glb::parts(&glb::scene(&[(all, unlit([1.0; 4], "BLEND")), wall()]));
    let list = |json: &mut Value, name: &str, entry: Value| {
        let list = json[name].as_array_mut().unwrap();
        list.push(entry);
        list.len() - 1
    };
    let offset = bin.len();
    let view = list(&mut json, "bufferViews", json!({ "buffer": 0, "byteOffset": offset, "byteLength": colors.len() }));
    let accessor = json!({ "bufferView": view, "componentType": 5126, "count": 4 * PANES.len(), "type": "VEC4" });
    json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = json!(list(&mut json, "accessors", accessor));
    bin.extend(colors);
    json["buffers"][0]["byteLength"] = json!(bin.len());
    load(&glb::container(&json, &bin))
}

/// A session that looks at the panes from the front, without perspective.
fn session(model: Model, msaa: u32) -> Session {
    let (height, msaa) = (format!("camera.height={HEIGHT}"), format!("view.msaa={msaa}"));
    let camera = ["camera.eye=[0, 0, 5]", "camera.target=[0, 0, 0]", &height, &msaa];
    Session::new(model, settings(&[&camera[..], &["environment.name=none", "view.background=none"]].concat()))
}

/// The pixels of a frame that lie inside all panes and not at an edge where two of them cross, each with the panes before the wall from
/// back to front.
fn pixels((width, height): (u32, u32)) -> Vec<([u32; 2], Vec<&'static Pane>)> {
    let meters = HEIGHT / f64::from(height);
    let middle = |at: u32, size: u32| (f64::from(at) + 0.5 - f64::from(size) / 2.0) * meters;
    let mut out = Vec::new();
    for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
        let [at_x, at_y] = [middle(x, width), middle(y, height)];
        let is_inside =
            at_x.abs() < f64::from(HALF[0]) - 2.0 * meters && at_y.abs() < f64::from(HALF[1]) - 2.0 * meters;
        let mut depths: Vec<f64> =
            PANES.iter().map(|pane| f64::from(pane.slope) * at_x + f64::from(pane.offset)).collect();
        let mut order: Vec<usize> = (0..PANES.len()).filter(|index| depths[*index] > f64::from(WALL)).collect();
        order.sort_by(|a, b| depths[*a].total_cmp(&depths[*b]));
        depths.push(WALL.into());
        depths.sort_by(f64::total_cmp);
        let is_clear = depths.windows(2).all(|pair| pair[1] - pair[0] > meters);
        if is_inside && is_clear {
            out.push(([x, y], order.into_iter().map(|index| &PANES[index]).collect()));
        }
    }
    assert!(out.len() > 300, "{} pixels", out.len());
    out
}

/// The largest difference of a channel from what the panes make of the wall's light.
fn error(session: &mut Session, layers: u32) -> f64 {
    session.set(&format!("view.blend_layers={layers}"));
    let picture = session.render();
    let white = f64::from(picture.raw_at(1, 1).unwrap()[0]);
    let of_pixel = |([x, y], panes): &([u32; 2], Vec<&Pane>)| {
        let blend = |behind: f64, pane: &&Pane, channel: usize| {
            let alpha = f64::from(pane.color[3]);
            f64::from(pane.color[channel]) * alpha + behind * (1.0 - alpha)
        };
        let value = picture.raw_at(*x, *y).unwrap();
        let difference = |channel: usize| {
            let expected = panes.iter().fold(1.0, |behind, pane| blend(behind, pane, channel));
            (f64::from(value[channel]) / white - expected).abs()
        };
        (0..3).map(difference).fold(0.0, f64::max)
    };
    pixels((picture.width, picture.height)).iter().map(of_pixel).fold(0.0, f64::max)
}

#[test]
fn intersecting_surfaces_blend_by_their_depths() {
    for (name, model) in [("primitives", primitives()), ("one primitive", one_primitive())] {
        for msaa in [1, 4] {
            let mut session = session(model.clone(), msaa);
            let found = [0, 2, 5, 64].map(|layers| error(&mut session, layers));
            let [unsorted, some, all, more] = found;
            assert!(unsorted > 0.1 && some > 0.01, "{name}, {msaa} samples: {found:?}");
            assert!(all < 2e-3 && more < 2e-3, "{name}, {msaa} samples: {found:?}");
        }
    }
}

#[test]
fn a_mode_that_shows_data_shows_the_nearest_surface() {
    let mut session = session(one_primitive(), 1);
    session.set("view.blend_layers=8");
    let picture = session.mode("base-color");
    for ([x, y], panes) in pixels((picture.width, picture.height)) {
        let (value, expected) = (picture.raw_at(x, y).unwrap(), panes.last().map_or([1.0; 4], |pane| pane.color));
        assert!((0..3).all(|i| (value[i] - expected[i]).abs() < 2e-3), "{x}, {y}: {value:?} is not {expected:?}");
    }
}

#[test]
fn a_decal_on_an_opaque_surface_stays() {
    let decal = |color| {
        let (mesh, _) = wall();
        (mesh, unlit(color, "BLEND"))
    };
    let parts = [wall(), decal([0.2, 0.4, 0.6, 0.5]), decal([0.9, 0.1, 0.3, 0.25])];
    let mut session = session(load(&glb::scene(&parts)), 1);
    let plain = session.render();
    session.set("view.blend_layers=4");
    assert_same(&plain, &session.render(), "decals");
}

#[test]
fn layers_change_nothing_without_blended_surfaces_or_their_pass() {
    let mut session = Session::new(model("sphere-grid"), settings(&[]));
    let plain = session.render();
    session.set("view.blend_layers=8");
    assert_same(&plain, &session.render(), "an opaque model");

    let mut session = self::session(primitives(), 4);
    let plain = session.render();
    session.set("view.blend_layers=8");
    let sorted = session.render();
    // An edit of the stage acts at once, and an error in it keeps the picture.
    ready(&session.edit("peel.frag", "gl_FragCoord.z <= last", "gl_FragCoord.z <= last + 0.0"));
    assert_same(&sorted, &session.render(), "an edit that changes nothing");
    let told = lines(failed(&session.edit("peel.frag", "peeled_samples, pixel", "samples, pixel"))).join("\n");
    assert!(told.contains("peel.frag"), "{told}");
    assert_same(&sorted, &session.render(), "a broken stage");
    ready(&session.delete(&["peel.frag"]));
    assert_same(&plain, &session.render(), "a tree without the stage");
}
