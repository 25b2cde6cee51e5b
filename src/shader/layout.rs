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
        scene_radius viewport_px viewport_origin_px near far light_count chosen_light tonemap encode mode largest_value
    }),
    layout!(Light { position_ws kind direction_ws range intensity cos_inner cos_outer }),
    layout!(Material {
        base_color_factor emissive_factor metallic_factor roughness_factor normal_scale occlusion_strength alpha_cutoff
        texture_mask uv1_mask id uv_from_texture
    }),
    layout!(Vertex { position normal tangent uv0 uv1 color }),
    layout!(Draw { vertices world_from_object normal_ws_from_object attributes primitive_id node_id }),
];

/// The layout of a struct by name.
pub fn layout(name: &str) -> Option<&'static Layout> {
    LAYOUTS.iter().find(|layout| layout.name == name)
}
