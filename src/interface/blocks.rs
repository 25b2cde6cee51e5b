//! The structs that both sides read, in the order of their sets.

use bytemuck::{Pod, Zeroable};

use super::{PUSH_CONSTANT_SIZE, TEXTURE_COUNT};

/// What a frame shares: camera, output, counts. `SET_FRAME`, `BINDING_FRAME`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Frame {
    /// World (meters, +Y up) to Vulkan clip space (+Y down, depth 0 far to 1 near: reversed).
    pub clip_from_world: [[f32; 4]; 4],
    /// Inverse of `clip_from_world`.
    pub world_from_clip: [[f32; 4]; 4],
    /// World to view space (camera looks along -Z).
    pub view_from_world: [[f32; 4]; 4],
    /// Camera position, world space.
    pub eye_ws: [f32; 3],
    /// Factor from luminance (cd/m^2) to the display's 0..1: 1 / (1.2 * 2^EV100).
    pub exposure: f32,
    /// Radiance that arrives from everywhere, linear RGB.
    pub ambient: [f32; 3],
    /// Seconds since the start; 0 in headless renderings.
    pub time_s: f32,
    /// Linear RGB behind the model, and its alpha.
    pub background: [f32; 4],
    /// Center of the model's bounds, world space.
    pub scene_center_ws: [f32; 3],
    /// Radius of the model's bounds, meters.
    pub scene_radius: f32,
    /// Width and height of the picture in pixels.
    pub viewport_px: [f32; 2],
    /// Upper left corner of the picture in the output image, pixels.
    pub viewport_origin_px: [f32; 2],
    /// Near plane distance, meters.
    pub near: f32,
    /// Far plane distance, meters (debug views only: the projection is infinite).
    pub far: f32,
    /// Lights in `BINDING_LIGHTS`.
    pub light_count: u32,
    /// Which light the BRDF term modes show: 0 all, else 1-based.
    pub chosen_light: u32,
    /// Debug mode on screen, for passes that are not specialized by mode.
    pub mode: u32,
    /// Largest value that the HDR target holds: 65504 for half floats.
    pub largest_value: f32,
    /// Cosine and sine of the environment's rotation around +Y: its map's center column is seen looking down -Z turned by it.
    pub environment_rotation: [f32; 2],
    /// Factor from what the environment's images hold to radiance.
    pub environment_intensity: f32,
    /// Blur of the environment behind the model: 0 sharp .. 1, as a roughness.
    pub environment_blur: f32,
    /// For modes that accumulate: number of this frame since the picture changed.
    pub sample_index: u32,
    /// For modes that accumulate: paths a pixel in each frame.
    pub sample_count: u32,
}

/// A light, in world space. `SET_FRAME`, `BINDING_LIGHTS`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Light {
    /// World position, and 1. Of a directional light the direction towards it, unit, and 0: a place at infinity.
    pub position_ws: [f32; 4],
    /// Where the light shines to, unit.
    pub direction_ws: [f32; 3],
    /// `LIGHT_*`.
    pub kind: u32,
    /// Linear RGB times candela (point, spot), lux (directional) or radiance (rectangle).
    pub intensity: [f32; 3],
    /// 1 / the distance at which it ends, 1/m; 0 is without end.
    pub inverse_range: f32,
    /// Spot: the falloff is the square of scale x cosine + offset, held within 0..1. Scale; 0 for what is no spot.
    pub angle_scale: f32,
    /// Offset; 1 for what is no spot.
    pub angle_offset: f32,
    /// Rectangle: from its center to the middle of one edge, meters.
    pub half_x_ws: [f32; 3],
    /// Rectangle: from its center to the middle of a neighboring edge, meters.
    pub half_y_ws: [f32; 3],
}

/// A material's numbers. `SET_MATERIAL`, `BINDING_MATERIAL`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Material {
    /// Linear RGBA factor.
    pub base_color_factor: [f32; 4],
    /// Linear RGB factor, KHR_materials_emissive_strength multiplied in.
    pub emissive_factor: [f32; 3],
    /// 0 dielectric .. 1 metal.
    pub metallic_factor: f32,
    /// Perceptual roughness 0..1.
    pub roughness_factor: f32,
    /// Scale of the normal texture's x and y.
    pub normal_scale: f32,
    /// 0 no occlusion .. 1 as in the texture.
    pub occlusion_strength: f32,
    /// ALPHA_MASK: below this a fragment is discarded.
    pub alpha_cutoff: f32,
    /// Bit `TEXTURE_*`: the texture exists (else a default one is bound).
    pub texture_mask: u32,
    /// Bit `TEXTURE_*`: the texture reads TEXCOORD_1.
    pub uv1_mask: u32,
    /// Index of the material, for the id view.
    pub id: u32,
    /// Clear coat factor 0..1.
    pub clearcoat_factor: f32,
    /// Perceptual roughness of the clear coat.
    pub clearcoat_roughness: f32,
    /// Scale of the clear coat normal texture's x and y.
    pub clearcoat_normal_scale: f32,
    /// Anisotropy strength 0..1.
    pub anisotropy_strength: f32,
    /// Cosine and sine of the anisotropy's rotation from the tangent towards the bitangent.
    pub anisotropy_rotation: [f32; 2],
    /// Perceptual roughness of the sheen.
    pub sheen_roughness: f32,
    /// Linear RGB.
    pub sheen_color: [f32; 3],
    /// KHR_materials_specular: weight of the dielectric's specular reflection, 0..1.
    pub specular_factor: f32,
    /// Linear RGB, tints the dielectric's F0; specular-glossiness: F0 itself.
    pub specular_color: [f32; 3],
    /// Index of refraction, at least 1; 0 stands for infinity.
    pub ior: f32,
    /// Iridescence factor 0..1.
    pub iridescence_factor: f32,
    /// Index of refraction of the thin film.
    pub iridescence_ior: f32,
    /// Thickness of the film where its texture is 0 and 1, nanometers.
    pub iridescence_thickness_nm: [f32; 2],
    /// Transmission factor 0..1.
    pub transmission_factor: f32,
    /// Thickness of the volume beneath the surface, meters in object space; 0 is a thin wall.
    pub thickness: f32,
    /// Color that white light has after `attenuation_distance`.
    pub attenuation_color: [f32; 3],
    /// Meters; infinite without attenuation.
    pub attenuation_distance: f32,
    /// KHR_materials_dispersion: 20 / Abbe number.
    pub dispersion: f32,
    /// Part of the diffuse light that is transmitted, 0..1.
    pub diffuse_transmission_factor: f32,
    /// Linear RGB.
    pub diffuse_transmission_color: [f32; 3],
    /// Real part of the metal's index of refraction at about 650, 550 and 450 nm.
    pub conductor_n: [f32; 3],
    /// Imaginary part (extinction), positive.
    pub conductor_k: [f32; 3],
    /// KHR_texture_transform of each texture: columns of a mat3x2 applied to (u, v, 1).
    pub uv_from_texture: [[[f32; 2]; 3]; TEXTURE_COUNT],
}

/// Push constants of one draw. Vertices are read by address (`buffer_reference`).
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Draw {
    /// Device address of the first [`Vertex`].
    pub vertices: u64,
    /// Columns of the object-to-world matrix, without the last row.
    pub world_from_object: [[f32; 3]; 4],
    /// Inverse transpose of its upper 3x3.
    pub normal_ws_from_object: [[f32; 3]; 3],
    /// `ATTRIBUTE_*` bits of the mesh.
    pub attributes: u32,
    /// Index of the primitive, for the id views.
    pub primitive_id: u32,
    /// Index of the node, for the id views.
    pub node_id: u32,
}

/// What one compute dispatch works on. `SET_TASK`, `BINDING_TASK`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Task {
    /// Width and height of what is written: texels, or columns and rows of `BINDING_RESULTS`.
    pub size: [u32; 2],
    /// Mip level that is written.
    pub level: u32,
    /// How many levels the image has.
    pub levels: u32,
    /// Samples for each texel or result.
    pub samples: u32,
    /// What radiance is multiplied by to fit into half floats.
    pub radiance_scale: f32,
    /// Roughness of the first row.
    pub roughness_first: f32,
    /// Roughness of the last row.
    pub roughness_last: f32,
    /// Angle to the normal of the first column, degrees.
    pub theta_first: f32,
    /// Angle to the normal of the last column, degrees.
    pub theta_last: f32,
    /// Linear RGB of the measured surface.
    pub base_color: [f32; 3],
    /// 0 dielectric .. 1 metal.
    pub metallic: f32,
}

/// A vertex as the shader reads it.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq)]
pub struct Vertex {
    /// Object space, meters.
    pub position: [f32; 3],
    /// Object space, unit.
    pub normal: [f32; 3],
    /// Object space, unit; w is the bitangent's sign.
    pub tangent: [f32; 4],
    /// TEXCOORD_0, or 0.
    pub uv0: [f32; 2],
    /// TEXCOORD_1, or `uv0`.
    pub uv1: [f32; 2],
    /// COLOR_0, linear RGBA, or 1.
    pub color: [f32; 4],
}

const _: () = assert!(size_of::<Draw>() <= PUSH_CONSTANT_SIZE as usize);
