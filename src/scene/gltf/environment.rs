//! `EXT_lights_image_based`: the environment that a scene names. A light that cannot be used costs a warning, never the model.

use std::sync::Arc;

use glam::Quat;
use gltf::json;
use serde::Deserialize;

use super::file::buffers::{Buffers, Files};
use super::materials::images;
use super::materials::textures::Origin;
use crate::scene::environment::ModelEnvironment;
use crate::scene::model::Image;

/// The extension's name.
pub const EXTENSION: &str = "EXT_lights_image_based";

/// Largest side of a face, pixels. The bake takes 1 GiB for such a cube.
const MAX_SIDE: u32 = 2048;

#[derive(Deserialize)]
struct Lights {
    lights: Vec<json::Value>,
}

#[derive(Deserialize)]
struct Used {
    light: usize,
}

/// The members that Specula reads. The file's prefiltered levels and its irradiance are for one BRDF; Specula's bake makes
/// both of the first level, for the BRDF in use.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Light {
    #[serde(default)]
    name: String,
    rotation: Option<[f32; 4]>,
    intensity: Option<f32>,
    specular_images: Vec<Vec<usize>>,
}

/// The light that a scene names, if it can be used.
pub fn read(
    root: &json::Root,
    buffers: &Buffers<'_>,
    files: &mut Files<'_>,
    scene: usize,
    warnings: &mut Vec<String>,
) -> Option<Arc<ModelEnvironment>> {
    let light = light(root, used(root, scene)?).and_then(|light| environment(root, buffers, files, light));
    let say = |problem: String| {
        warnings.push(format!(
            "{EXTENSION}: {problem}; the environment of the settings lights the model. Export the light again, or choose a map \
             in the panel Environment (`--env FILE`)."
        ));
    };
    light.map_err(say).ok().map(Arc::new)
}

/// The index of the light that a scene names.
pub fn index(root: &json::Root, scene: usize) -> Option<usize> {
    Used::deserialize(used(root, scene)?).ok().map(|used| used.light)
}

/// The entry of the extension in a scene.
fn used(root: &json::Root, scene: usize) -> Option<&json::Value> {
    root.scenes.get(scene)?.extensions.as_ref()?.others.get(EXTENSION)
}

/// The light that a scene uses.
fn light(root: &json::Root, used: &json::Value) -> Result<Light, String> {
    let Used { light } = read_as(used, "its entry in the scene")?;
    let lights = root.extensions.as_ref().and_then(|extensions| extensions.others.get(EXTENSION));
    let Lights { lights } = read_as(lights.ok_or("the file has no lights")?, "its entry in the file")?;
    let value = lights.get(light).ok_or_else(|| format!("the scene names light {light} of {}", lights.len()))?;
    read_as(value, &format!("light {light}"))
}

fn read_as<T: for<'a> Deserialize<'a>>(value: &json::Value, what: &str) -> Result<T, String> {
    T::deserialize(value).map_err(|error| format!("{what} cannot be read ({error})"))
}

fn environment(
    root: &json::Root,
    buffers: &Buffers<'_>,
    files: &mut Files<'_>,
    light: Light,
) -> Result<ModelEnvironment, String> {
    let (intensity, most) = (light.intensity.unwrap_or(1.0), ModelEnvironment::MAX_INTENSITY);
    if !(0.0..=most).contains(&intensity) {
        return Err(format!("the intensity is {intensity}, expected 0 to {most}"));
    }
    let rotation = Quat::from_array(light.rotation.unwrap_or([0.0, 0.0, 0.0, 1.0]));
    if !rotation.is_finite() || !(0.5..2.0).contains(&rotation.length()) {
        return Err(format!("the rotation is {rotation}, expected a unit quaternion"));
    }
    let first = light.specular_images.first().map(Vec::as_slice).unwrap_or_default();
    let indices: &[usize; 6] = first.try_into().map_err(|_| {
        format!("the first level of specularImages has {} images, expected the 6 faces of a cube", first.len())
    })?;
    let encoded = indices.map(|index| images::find(root, buffers, files, Origin::Image(index))).into();
    let decoded = images::decode(encoded, &files.memory, files.canceled);
    if let Some(failure) = decoded.iter().find_map(|face| face.failure.as_ref()) {
        return Err(failure.reason.clone());
    }
    let faces: Vec<Image> = decoded.into_iter().map(|face| face.image).collect();
    let faces: [Image; 6] = faces.try_into().map_err(|_| "the load was canceled".to_owned())?;
    let side = faces[0].width;
    for face in &faces {
        let (width, height) = (face.width, face.height);
        if (width, height) != (side, side) || side > MAX_SIDE {
            let expected = format!("expected six squares of one size, at most {MAX_SIDE} a side");
            return Err(format!("face '{}' has {width}x{height} pixels, {expected}", face.name.escape_debug()));
        }
        if face.texels.is_hdr() {
            return Err(format!("face '{}' has floats, expected PNG (RGBD) or JPEG", face.name.escape_debug()));
        }
    }
    let pixels = faces.map(|face| face.pixels().into_owned());
    Ok(ModelEnvironment::new(light.name, side, (rotation.normalize(), intensity), pixels))
}
