//! Replaces images that cannot be read or decoded: by a checkerboard as the base color, and in every other slot as if the
//! material had no texture there.

use crate::interface as contract;
use crate::scene::model::{Image, Material, Model, Texture};

/// Side of the checkerboard, in pixels.
const SIDE: u32 = 256;
/// Side of one of its squares, in pixels: small enough that the pieces of a texture atlas show several squares.
const SQUARE: u32 = 8;
/// Its two grays, sRGB-encoded.
const GRAYS: [u8; 2] = [72, 184];
/// Maximum number of materials that a warning names.
const MOST_NAMES: usize = 3;

/// Why an image cannot be shown.
#[derive(Clone, Debug)]
pub struct Failure {
    /// The image and the reason, as part of a sentence.
    pub reason: String,
    /// The remedy, as a sentence.
    pub remedy: &'static str,
}

/// The placeholder for a base color: an opaque checkerboard in mid-gray.
pub fn checkerboard(name: String) -> Image {
    let gray = |pixel: u32| GRAYS[((pixel % SIDE / SQUARE + pixel / SIDE / SQUARE) % 2) as usize];
    let rgba8 = (0..SIDE * SIDE).flat_map(|pixel| [gray(pixel), gray(pixel), gray(pixel), 255]).collect();
    Image::rgba8(name, SIDE, SIDE, rgba8)
}

/// A pixel that stands for an image while it is being decoded, so that a material looks as if it had no texture there. Like a failed
/// image, it emits nothing.
pub fn pixel(name: String, model: &Model, image: usize) -> Image {
    let is_in = |slot: usize| {
        let uses = model.materials.iter().filter_map(|material| material.textures[slot]);
        uses.into_iter().any(|used| model.textures[used.texture].image == image)
    };
    let is_normal = |slot: &usize| contract::TEXTURES[*slot].content == contract::TextureContent::Normal;
    let rgba8 = match (0..contract::TEXTURE_COUNT).filter(is_normal).any(is_in) {
        _ if is_in(contract::TEXTURE_EMISSIVE as usize) => [0, 0, 0, 255],
        true => [128, 128, 255, 255],
        false => [255; 4],
    };
    Image::rgba8(name, 1, 1, rgba8.to_vec())
}

/// Removes failed images from the materials, except for base colors, which show the checkerboard. Returns a warning for each
/// image and slot. `failures` has an entry for each image of the model, `None` if it is good. The default material, which
/// comes first, has no textures.
pub fn replace(materials: &mut [Material], textures: &[Texture], failures: &[Option<Failure>]) -> Vec<String> {
    let mut warnings = Vec::new();
    for (image, failure) in failures.iter().enumerate() {
        let Some(failure) = failure else { continue };
        for slot in 0..contract::TEXTURE_COUNT {
            let uses_it =
                |material: &Material| material.textures[slot].is_some_and(|used| textures[used.texture].image == image);
            let users: Vec<usize> = (0..materials.len()).filter(|&index| uses_it(&materials[index])).collect();
            let Some(&first) = users.first() else { continue };
            let (title, instead) = words(slot as u32, &materials[first]);
            let Failure { reason, remedy } = failure;
            warnings.push(format!("{}, {title} texture: {reason}; {instead}. {remedy}", names(&users, materials)));
            // A base color shows the checkerboard.
            for material in users.into_iter().filter(|_| slot != contract::TEXTURE_BASE_COLOR as usize) {
                clear(&mut materials[material], slot as u32);
            }
        }
    }
    warnings
}

/// Removes the texture of a slot.
pub fn clear(material: &mut Material, slot: u32) {
    // Most of an emissive texture is black. The factor alone would make the whole surface emit.
    if slot == contract::TEXTURE_EMISSIVE {
        material.numbers.emissive_factor = [0.0; 3];
    }
    material.textures[slot as usize] = None;
}

/// The name of a slot, and what replaces its texture.
fn words(slot: u32, material: &Material) -> (&'static str, &'static str) {
    const FACTOR: &str = "its factor is used alone";
    const NORMAL: &str = "the normals of the mesh are used";
    match slot {
        contract::TEXTURE_BASE_COLOR if material.specular_glossiness => ("diffuse", CHECKERBOARD),
        contract::TEXTURE_BASE_COLOR => ("base color", CHECKERBOARD),
        contract::TEXTURE_METALLIC_ROUGHNESS if material.specular_glossiness => ("specular-glossiness", FACTOR),
        contract::TEXTURE_METALLIC_ROUGHNESS => ("metallic-roughness", "its factors are used alone"),
        contract::TEXTURE_NORMAL => ("normal", NORMAL),
        contract::TEXTURE_OCCLUSION => ("occlusion", "nothing is occluded"),
        contract::TEXTURE_EMISSIVE => ("emissive", "no light is emitted"),
        contract::TEXTURE_CLEARCOAT => ("clearcoat", FACTOR),
        contract::TEXTURE_CLEARCOAT_ROUGHNESS => ("clearcoat roughness", FACTOR),
        contract::TEXTURE_CLEARCOAT_NORMAL => ("clearcoat normal", NORMAL),
        contract::TEXTURE_ANISOTROPY => ("anisotropy", FACTOR),
        contract::TEXTURE_SHEEN_COLOR => ("sheen color", FACTOR),
        contract::TEXTURE_SHEEN_ROUGHNESS => ("sheen roughness", FACTOR),
        contract::TEXTURE_SPECULAR => ("specular", FACTOR),
        contract::TEXTURE_SPECULAR_COLOR => ("specular color", FACTOR),
        contract::TEXTURE_IRIDESCENCE => ("iridescence", FACTOR),
        contract::TEXTURE_IRIDESCENCE_THICKNESS => ("iridescence thickness", FACTOR),
        contract::TEXTURE_TRANSMISSION => ("transmission", FACTOR),
        contract::TEXTURE_THICKNESS => ("thickness", FACTOR),
        contract::TEXTURE_DIFFUSE_TRANSMISSION => ("diffuse transmission", FACTOR),
        contract::TEXTURE_DIFFUSE_TRANSMISSION_COLOR => ("diffuse transmission color", FACTOR),
        _ => ("other", FACTOR),
    }
}

const CHECKERBOARD: &str = "a checkerboard is shown in its place";

/// Materials in a message: `material 'Visor'`, or a few names and the number of others. A material without a name is
/// given by its index in the file.
fn names(users: &[usize], materials: &[Material]) -> String {
    let name = |&index: &usize| match materials[index].name.as_str() {
        "" => index.saturating_sub(1).to_string(),
        name => format!("'{}'", name.escape_debug()),
    };
    let listed: Vec<String> = users.iter().take(MOST_NAMES).map(name).collect();
    let kind = if users.len() == 1 { "material" } else { "materials" };
    match users.len().saturating_sub(MOST_NAMES) {
        0 => format!("{kind} {}", listed.join(", ")),
        more => format!("{kind} {} and {more} more", listed.join(", ")),
    }
}
