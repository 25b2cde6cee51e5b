//! The environment that a glTF file brings along (`EXT_lights_image_based`), against the same cube as an EXR file.

use std::fs;
use std::io::Cursor;
use std::path::Path;

use exr::prelude::{Image, SpecificChannels, Vec2, WritableImage as _};
use serde_json::json;

use super::{folder, lit_by};
use crate::support::process::run;
use crate::support::{glb, open_image};

/// Columns and rows of a face.
const SIDE: usize = 8;
/// Alpha of the face +Y, whose PNG is RGBD.
const DIVISOR: u8 = 51;
/// A power of two: the bake's rounding is the same with it and without.
const INTENSITY: f64 = 2.0;

/// sRGB-encoded color of a texel in the file of a face, counted from the upper left.
fn code(face: usize, x: usize, y: usize) -> [u8; 3] {
    [40 + 30 * face as u8, 20 + 25 * x as u8, 20 + 25 * y as u8]
}

/// Linear light of such a texel (IEC 61966-2-1).
fn light(face: usize, x: usize, y: usize) -> [f64; 3] {
    let factor = INTENSITY * if face == 2 { 255.0 / f64::from(DIVISOR) } else { 1.0 };
    code(face, x, y).map(|code| {
        let value = f64::from(code) / 255.0;
        factor * if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
    })
}

/// The direction of a point of a face of OpenGL's cube map, from -1 to 1 rightwards and downwards (OpenGL 4.6, table 8.19).
fn direction(face: usize, s: f64, t: f64) -> [f64; 3] {
    [[1.0, -t, -s], [-1.0, -t, s], [s, 1.0, t], [s, -1.0, -t], [s, -t, 1.0], [-s, -t, -1.0]][face]
}

/// The texel in the files of the faces that lights from a direction, according to the text of the extension: faces of OpenGL around the
/// axes of glTF, whose rows are flipped.
fn texel([x, y, z]: [f64; 3]) -> (usize, usize, usize) {
    let near = |of: f64, face: usize, s: f64, t: f64| (of, face, s / of, t / of);
    let faces = [
        near(x, 0, -z, -y),
        near(-x, 1, z, -y),
        near(y, 2, x, z),
        near(-y, 3, x, -z),
        near(z, 4, x, -y),
        near(-z, 5, -x, -y),
    ];
    let (_, face, s, t) = faces.into_iter().max_by(|a, b| a.0.total_cmp(&b.0)).unwrap();
    let at = |value: f64| ((value + 1.0) * 0.5 * SIDE as f64).floor() as usize;
    (face, at(s), SIDE - 1 - at(t))
}

/// The same cube as Specula reads a strip of six faces, whose front, glTF's -Z, is the fifth. The extension turns the cube by 90 degrees
/// around +Y: +Z comes to +X.
fn strip() -> Vec<u8> {
    let channels = SpecificChannels::rgb(|at: Vec2<usize>| {
        let center = |index: usize| (index as f64 + 0.5) / SIDE as f64 * 2.0 - 1.0;
        let [x, y, z] = direction(at.x() / SIDE, center(at.x() % SIDE), center(at.y()));
        let (x, z) = (x, -z);
        let (face, column, row) = texel([-z, y, x]);
        let [r, g, b] = light(face, column, row).map(|value| value as f32);
        (r, g, b)
    });
    let mut bytes = Cursor::new(Vec::new());
    Image::from_channels((6 * SIDE, SIDE), channels).write().to_buffered(&mut bytes).unwrap();
    bytes.into_inner()
}

/// A rotation around +Y, as glTF writes it.
fn around_y(degrees: f32) -> [f32; 4] {
    let (sin, cos) = (degrees.to_radians() / 2.0).sin_cos();
    [0.0, sin, 0.0, cos]
}

/// Intensity and rotation of a light, degrees around +Y.
type Lit = (f32, f32);

/// A ball with this cube as the light of its scene, and with a clip of a second in which the light becomes another.
fn write_ball(folder: &Path, (intensity, degrees): Lit, end: Option<Lit>) {
    let metal = json!({ "pbrMetallicRoughness": { "roughnessFactor": 0.2 } });
    let (mut json, mut bin) = glb::document(&glb::sphere(16, 32), &metal);
    let mut images = Vec::new();
    for face in 0..6 {
        let mut png = Cursor::new(Vec::new());
        let rgba = image::RgbaImage::from_fn(SIDE as u32, SIDE as u32, |x, y| {
            let [r, g, b] = code(face, x as usize, y as usize);
            image::Rgba([r, g, b, DIVISOR])
        });
        let picture = image::DynamicImage::ImageRgba8(rgba);
        let picture = if face == 2 { picture } else { picture.into_rgb8().into() };
        picture.write_to(&mut png, image::ImageFormat::Png).unwrap();
        let views = json["bufferViews"].as_array_mut().unwrap();
        images.push(json!({ "bufferView": views.len(), "mimeType": "image/png" }));
        views.push(json!({ "buffer": 0, "byteOffset": bin.len(), "byteLength": png.get_ref().len() }));
        bin.extend(png.into_inner());
    }
    json["images"] = json!(images);
    json["buffers"][0]["byteLength"] = json!(bin.len());
    json["extensionsUsed"] = json!(["EXT_lights_image_based"]);
    json["extensions"]["EXT_lights_image_based"]["lights"] = json!([{ "intensity": intensity,
        "rotation": around_y(degrees), "specularImageSize": SIDE,
        "specularImages": [[0, 1, 2, 3, 4, 5]], "irradianceCoefficients": vec![[0.0; 3]; 9] }]);
    json["scenes"][0]["extensions"]["EXT_lights_image_based"]["light"] = json!(0);
    if let Some((to_intensity, to_degrees)) = end {
        let input = glb::accessor(&mut json, &mut bin, "SCALAR", &[0.0, 1.0]);
        let outputs = [
            glb::accessor(&mut json, &mut bin, "SCALAR", &[intensity, to_intensity]),
            glb::accessor(&mut json, &mut bin, "VEC4", &[around_y(degrees), around_y(to_degrees)].concat()),
        ];
        let channel = |(sampler, member): (usize, &str)| {
            let pointer = json!({ "pointer": format!("/extensions/EXT_lights_image_based/lights/0/{member}") });
            let target = json!({ "path": "pointer", "extensions": { "KHR_animation_pointer": pointer } });
            json!({ "sampler": sampler, "target": target })
        };
        let members = [(0, "intensity"), (1, "rotation")];
        json["animations"] = json!([{
            "samplers": outputs.map(|output| json!({ "input": input, "output": output })),
            "channels": members.map(channel),
        }]);
        json["extensionsUsed"].as_array_mut().unwrap().push(json!("KHR_animation_pointer"));
    }
    fs::write(folder.join("ball.glb"), glb::container(&json, &bin)).unwrap();
}

/// A clip changes the light without baking it anew, and the picture is that of a file whose light is so.
#[test]
fn a_clip_dims_and_turns_the_light_of_a_gltf_file() {
    let directory = folder();
    let folder = directory.path();
    let picture = |start: Lit, end: Option<Lit>, time: &str| {
        write_ball(folder, start, end);
        lit_by(folder, "model", &["--background", "env", "--time", time]).expect(0, &[]);
        open_image(&folder.join("out.exr")).into_rgb32f().into_raw()
    };
    // Turned by 90 degrees, the bake samples the same directions.
    let clip = Some((0.75, 270.0));
    let half = picture((0.0, 90.0), clip, "0.5");
    let still = picture((0.375, 180.0), None, "0");
    let mean = |a: &[f32], b: &[f32]| {
        let sum: f32 = a.iter().zip(b).map(|(a, b)| (a - b).abs()).sum();
        sum / b.iter().sum::<f32>()
    };
    assert!(mean(&half, &still) < 0.005, "the picture differs by {} of its mean", mean(&half, &still));
    let early = picture((0.0, 90.0), clip, "0.25");
    assert!(mean(&early, &still) > 0.2, "the time changes nothing: {}", mean(&early, &still));
}

#[test]
fn the_light_of_a_gltf_file_is_that_of_the_same_cube_as_a_map() {
    let directory = folder();
    let folder = directory.path();
    lit_by(folder, "model", &[]).expect(1, &["EXT_lights_image_based", "this model has none", "studio, furnace, sky"]);
    write_ball(folder, (INTENSITY as f32, 90.0), None);
    fs::write(folder.join("strip.exr"), strip()).unwrap();
    let picture = |environment: &str, more: &[&str]| {
        lit_by(folder, environment, &[&["--background", "env"], more].concat()).expect(0, &[]);
        open_image(&folder.join("out.exr")).into_rgb32f().into_raw()
    };
    let (own, map) = (picture("model", &[]), picture("strip.exr", &[]));
    let worst = own.iter().zip(&map).map(|(a, b)| (a - b).abs() / b.max(0.01)).fold(0.0, f32::max);
    assert!(worst < 2e-3, "the pictures differ by up to {worst} of their values");
    let studio = picture("studio", &[]);
    assert!(own.iter().zip(&studio).any(|(a, b)| (a - b).abs() > 0.1 * b), "the studio gives another picture");

    // A saved picture restores its light, since its model brings that along.
    run(folder, &["render", "ball.glb", "--env", "model", "--background", "env", "--size", "48x32", "--out", "a.png"])
        .expect(0, &[]);
    run(folder, &["render", "--look", "a.png", "--size", "48x32", "--out", "b.png"]).expect(0, &[]);
    let [a, b] = ["a.png", "b.png"].map(|name| open_image(&folder.join(name)).into_rgba8());
    assert!(a == b, "the picture of the look differs");
    let info = run(folder, &["info", "ball.glb"]);
    assert!(info.stdout.contains("environment a cube of 8 x 8, intensity 2 (--env model)"), "{info:#?}");
}
