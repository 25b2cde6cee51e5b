//! Where Rust puts the members of the contract's structs, so that a shader's offsets can be held against them.

use std::mem::offset_of;

use crate::interface;

/// A struct as Rust lays it out.
#[derive(Debug)]
pub struct Layout {
    /// Its name, the same in Rust and GLSL.
    pub name: &'static str,
    /// Bytes.
    pub size: u32,
    /// Names and byte offsets, in order.
    pub fields: &'static [(&'static str, u32)],
}

macro_rules! layout {
    ($name:ident { $($field:ident)* }) => {
        Layout {
            name: stringify!($name),
            size: size_of::<interface::$name>() as u32,
            fields: &[$((stringify!($field), offset_of!(interface::$name, $field) as u32)),*],
        }
    };
}

/// All structs of the contract. A test holds them against what interface.rs prints as GLSL.
pub const LAYOUTS: &[Layout] = &[
    layout!(Frame {
        clip_from_world world_from_clip view_from_world eye_ws exposure ambient time_s background scene_center_ws
        scene_radius viewport_px viewport_origin_px near far light_count chosen_light mode largest_value
        environment_rotation environment_intensity environment_blur sample_index sample_count
    }),
    layout!(Light {
        position_ws direction_ws kind intensity inverse_range angle_scale angle_offset half_x_ws half_y_ws
    }),
    layout!(Material {
        base_color_factor emissive_factor metallic_factor roughness_factor normal_scale occlusion_strength alpha_cutoff
        texture_mask uv1_mask id clearcoat_factor clearcoat_roughness clearcoat_normal_scale anisotropy_strength
        anisotropy_rotation sheen_roughness sheen_color specular_factor specular_color ior iridescence_factor
        iridescence_ior iridescence_thickness_nm transmission_factor thickness attenuation_color attenuation_distance
        dispersion diffuse_transmission_factor diffuse_transmission_color conductor_n conductor_k uv_from_texture
    }),
    layout!(Vertex { position normal tangent uv0 uv1 color }),
    layout!(Task {
        size level levels samples radiance_scale roughness_first roughness_last theta_first theta_last base_color metallic
    }),
    layout!(Draw { vertices world_from_object normal_ws_from_object attributes primitive_id node_id }),
];

/// The layout of a struct by name.
pub fn layout(name: &str) -> Option<&'static Layout> {
    LAYOUTS.iter().find(|layout| layout.name == name)
}
