//! What a material shows in place of an image that cannot be read or decoded: a checkerboard as the base color, and
//! in every other slot what the material would show if the file had no texture there.

use glam::Vec3;

use super::super::model::{Image, Material, Texture};
use crate::interface as contract;

/// Pixels along a side of the checkerboard.
const SIDE: u32 = 256;
/// Pixels along a side of one of its squares: 32 squares across, small enough to show on the pieces of a texture atlas.
const SQUARE: u32 = 8;
/// Its two grays around the middle, sRGB-encoded.
const GRAYS: [u8; 2] = [72, 184];
/// Most materials that a warning names.
const MOST_NAMES: usize = 3;

/// The placeholder for a base color: an opaque checkerboard in mid-gray.
pub fn checkerboard(name: String) -> Image {
    let gray = |pixel: u32| GRAYS[((pixel % SIDE / SQUARE + pixel / SIDE / SQUARE) % 2) as usize];
    let rgba8 = (0..SIDE * SIDE).flat_map(|pixel| [gray(pixel), gray(pixel), gray(pixel), 255]).collect();
    Image { name, width: SIDE, height: SIDE, rgba8 }
}

/// Takes failed images away from the materials, except for base colors, which show the checkerboard. Returns a warning
/// for each image and slot. `failures` has an entry for each of the model's images, `None` for those that are good.
/// The default material comes first and has no textures.
pub fn replace(materials: &mut [Material], textures: &[Texture], failures: &[Option<String>]) -> Vec<String> {
    let mut warnings = Vec::new();
    for (image, failure) in failures.iter().enumerate() {
        let Some(failure) = failure else { continue };
        for slot in 0..contract::TEXTURE_COUNT {
            let uses_it =
                |material: &Material| material.textures[slot].is_some_and(|used| textures[used.texture].image == image);
            let users: Vec<usize> = (0..materials.len()).filter(|&index| uses_it(&materials[index])).collect();
            let Some(&first) = users.first() else { continue };
            let (title, instead) = words(slot as u32, &materials[first]);
            warnings.push(format!("{}, {title} texture: {failure}; {instead}.", names(&users, materials)));
            for material in users {
                clear(&mut materials[material], slot as u32);
            }
        }
    }
    warnings
}

fn clear(material: &mut Material, slot: u32) {
    match slot {
        contract::TEXTURE_BASE_COLOR => return,
        // Emissive textures are dark but for a few lamps: the factor alone would make everything shine.
        contract::TEXTURE_EMISSIVE => material.emissive_factor = Vec3::ZERO,
        _ => {}
    }
    material.textures[slot as usize] = None;
}

/// The name of a slot, and what is shown in it.
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

/// Materials as a message names them: `material 'Visor'`, or a few and how many more. One without a name has its index
/// in the file.
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
