//! `EXT_lights_image_based`: the light that the scene names, and lights that cannot be used.

use std::io::Cursor;

use super::motion::{animate, at};
use super::*;
use crate::scene::moved_environment;

const NAME: &str = "EXT_lights_image_based";

fn png(side: u32) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    image::RgbaImage::from_pixel(side, side, image::Rgba([90, 80, 70, 51]))
        .write_to(&mut bytes, image::ImageFormat::Png)
        .unwrap();
    bytes.into_inner()
}

/// A triangle in a scene that names a light of six faces.
fn lit() -> Builder {
    let mut builder = Builder::triangle();
    for _ in 0..6 {
        let view = builder.view(&png(4));
        builder.push("images", json!({ "bufferView": view, "mimeType": "image/png" }));
    }
    builder.json["extensionsUsed"] = json!([NAME]);
    builder.json["extensionsRequired"] = json!([NAME]);
    let light = json!({ "name": "hall", "intensity": 2.0, "rotation": [0.0, 1.0, 0.0, 0.0], "specularImageSize": 4,
        "specularImages": [[0, 1, 2, 3, 4, 5]], "irradianceCoefficients": [] });
    builder.json["extensions"][NAME]["lights"] = json!([light]);
    builder.json["scenes"][0]["extensions"][NAME]["light"] = json!(0);
    builder
}

#[test]
fn the_light_that_the_scene_names_is_the_environment_of_the_model() {
    let mut builder = lit();
    let model = builder.model();
    assert!(model.warnings.is_empty(), "{:?}", model.warnings);
    let environment = model.environment.as_ref().unwrap();
    assert_eq!((environment.name.as_str(), environment.side, environment.intensity), ("hall", 4, 2.0));
    assert_eq!(environment.rotation, glam::Quat::from_xyzw(0.0, 1.0, 0.0, 0.0));
    let same = builder.model().environment;
    assert_eq!(model.environment, same);
    builder.json["extensions"][NAME]["lights"][0]["intensity"] = json!(3.0);
    assert_eq!(builder.model().environment.unwrap().intensity, 3.0);
    builder.json["extensions"][NAME]["lights"][0]["rotation"] = json!([0.0, 0.0, 0.0, 1.0]);
    assert_ne!(model.environment, builder.model().environment);
    builder.json["scenes"][0]["extensions"] = json!({});
    let model = builder.model();
    assert!(model.environment.is_none() && model.warnings.is_empty(), "no scene names the light");
}

/// Damages a file.
type Damage = fn(&mut Builder);

#[test]
fn a_light_that_cannot_be_used_costs_a_warning() {
    let damages: [(Damage, &str); 8] = [
        (|b| b.json["extensions"][NAME]["lights"][0]["specularImages"][0] = json!([0, 1, 2, 3, 4]), "has 5 images"),
        (|b| b.json["extensions"][NAME]["lights"][0]["specularImages"] = json!([]), "has 0 images"),
        (|b| b.json["extensions"][NAME]["lights"][0]["specularImages"][0][3] = json!(99), "image 99 cannot be read"),
        (|b| b.json["extensions"][NAME]["lights"][0]["rotation"] = json!([0, 0, 0, 0]), "expected a unit quaternion"),
        (|b| b.json["extensions"][NAME]["lights"][0]["intensity"] = json!(-1), "intensity is -1, expected 0 to"),
        (|b| b.json["scenes"][0]["extensions"][NAME]["light"] = json!(1), "the scene names light 1 of 1"),
        (
            |b| {
                let view = b.view(&png(8));
                b.json["images"][5]["bufferView"] = json!(view);
            },
            "has 8x8 pixels, expected six squares of one size",
        ),
        (
            |b| {
                let view = b.view(b"nonsense");
                b.json["images"][0]["bufferView"] = json!(view);
            },
            "image 0 cannot be decoded (it is not PNG, JPEG, WebP or KTX2)",
        ),
    ];
    for (damage, words) in damages {
        let mut builder = lit();
        damage(&mut builder);
        let model = builder.model();
        assert!(model.environment.is_none(), "{words}");
        let [warning] = &model.warnings[..] else { panic!("{:?}", model.warnings) };
        assert!(warning.starts_with(NAME) && warning.contains(words) && warning.contains("--env FILE"), "{warning}");
    }
}

/// A channel for a member of a light.
fn channel<'a>(light: usize, member: &str, kind: &'a str, values: &'a [f32]) -> (Value, &'a str, &'a str, &'a [f32]) {
    let pointer = json!({ "pointer": format!("/extensions/{NAME}/lights/{light}/{member}") });
    let target = json!({ "path": "pointer", "extensions": { "KHR_animation_pointer": pointer } });
    (target, "LINEAR", kind, values)
}

#[test]
fn a_clip_moves_the_light_that_the_scene_names() {
    // From the half turn of the file by 90 degrees more.
    let (sin, cos) = 135_f32.to_radians().sin_cos();
    let turns = [0.0, 1.0, 0.0, 0.0, 0.0, sin, 0.0, cos];
    let mut builder = lit();
    animate(
        &mut builder,
        &[0.0, 1.0],
        &[channel(0, "intensity", "SCALAR", &[1.0, 5.0]), channel(0, "rotation", "VEC4", &turns)],
    );
    let model = builder.model();
    assert!(model.warnings.is_empty(), "{:?}", model.warnings);
    let environment = model.environment.as_deref().unwrap();
    let moved = |time_s| moved_environment(environment, &at(&model, time_s).pose.values);
    let (intensity, angle) = moved(0.25);
    assert!(intensity == 2.0 && (angle.to_degrees() - 22.5).abs() < 1e-3, "{intensity}, {angle}");
    assert_eq!(moved_environment(environment, &model.pose.values), (2.0, 0.0), "without a clip");

    // A light that is not shown moves nothing.
    let lights = builder.json["extensions"][NAME]["lights"].as_array_mut().unwrap();
    lights.insert(0, json!({ "specularImages": [] }));
    builder.json["scenes"][0]["extensions"][NAME]["light"] = json!(1);
    let model = builder.model();
    assert!(model.warnings.is_empty(), "{:?}", model.warnings);
    assert_eq!(moved_environment(model.environment.as_deref().unwrap(), &at(&model, 0.25).pose.values), (2.0, 0.0));
}

#[test]
fn a_clip_that_tilts_the_light_costs_a_warning() {
    let mut builder = lit();
    let tilted = [0.0, 1.0, 0.0, 0.0, 0.0, 0.8, 0.6, 0.0];
    animate(&mut builder, &[0.0, 1.0], &[channel(0, "rotation", "VEC4", &tilted)]);
    let model = builder.model();
    let [warning] = &model.warnings[..] else { panic!("{:?}", model.warnings) };
    assert!(warning.contains("around +Y") && warning.contains("tilts it by 74 degrees"), "{warning}");
    assert_eq!(moved_environment(model.environment.as_deref().unwrap(), &at(&model, 0.5).pose.values), (2.0, 0.0));
}
