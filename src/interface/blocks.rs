//! The structs that Rust writes and GLSL reads, in the order of their sets.
//!
//! Each member is declared once. The declaration makes a field of the Rust struct, a line of `shaders/interface.glsl` with the
//! doc as its comment, and the offset that the contract check compares with every compiled shader.

use std::mem::offset_of;

use bytemuck::{Pod, Zeroable};

use super::limits::{COLORMAP_STEPS, MAX_LIGHT_VIEWS, MAX_SUNS, PUSH_CONSTANT_SIZE};

/// A struct of the contract.
#[derive(Debug)]
pub struct Block {
    /// Its name, the same in Rust and GLSL.
    pub name: &'static str,
    /// GLSL before the opening brace, and after the closing one.
    pub around: [&'static str; 2],
    /// Bytes.
    pub size: u32,
    /// In order.
    pub members: &'static [Member],
}

/// A member of a [`Block`].
#[derive(Debug)]
pub struct Member {
    /// Its name, the same in Rust and GLSL.
    pub name: &'static str,
    /// Its type: a GLSL type, or an array of one as Rust writes it.
    pub type_name: &'static str,
    /// Its content: unit, space, range.
    pub doc: &'static str,
    /// Bytes from the start of the struct.
    pub offset: u32,
}

/// GLSL's types as Rust writes them in scalar layout. Matrices are arrays of columns.
#[expect(non_camel_case_types, reason = "these are the names in GLSL")]
pub(super) mod types {
    pub type float = f32;
    pub type uint = u32;
    pub type vec2 = [f32; 2];
    pub type vec3 = [f32; 3];
    pub type vec4 = [f32; 4];
    pub type uvec2 = [u32; 2];
    pub type uvec3 = [u32; 3];
    pub type mat3 = [[f32; 3]; 3];
    pub type mat4 = [[f32; 4]; 4];
    pub type mat3x2 = [[f32; 2]; 3];
    pub type mat4x3 = [[f32; 3]; 4];
    /// A `buffer_reference`: a device address.
    pub type Vertices = u64;
    /// The same for indices.
    pub type Indices = u64;
    /// The same for vertices that a stage writes.
    pub type MovedVertices = u64;
    /// The same for influences of joints.
    pub type Influences = u64;
    /// The same for displacements.
    pub type Displacements = u64;
    /// The same for matrices of joints.
    pub type Joints = u64;
    /// The same for weights of morph targets.
    pub type Weights = u64;
    /// The same for places of draws in the frame before.
    pub type Befores = u64;
}
use types::*;

/// Declares structs, and a table of them.
macro_rules! blocks {
    ($(#[doc = $table_doc:literal])+ $table:ident: $($(#[$attribute:meta])* $name:ident: $before:literal, $after:literal {
        $(#[doc = $doc:literal] $member:ident: $type:ty,)+
    })+) => {
        $(
            $(#[$attribute])*
            #[repr(C)]
            #[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
            pub struct $name {
                $(#[doc = $doc] pub $member: $type,)+
            }
        )+

        $(#[doc = $table_doc])+
        pub const $table: &[Block] = &[$(Block {
            name: stringify!($name),
            around: [$before, $after],
            size: size_of::<$name>() as u32,
            members: &[$(Member {
                name: stringify!($member),
                type_name: stringify!($type),
                doc: $doc.trim_ascii(),
                offset: offset_of!($name, $member) as u32,
            },)+],
        },)+];
    };
}

pub(super) use blocks;

blocks! {
    /// The blocks of a frame.
    FRAME_BLOCKS:

    /// Values that all draws of a frame share: camera, output, counts.
    Frame: "layout(set = SET_FRAME, binding = BINDING_FRAME, scalar) uniform Frame", "frame" {
        /// World (meters, +Y up) to clip space (+Y down); depth is reversed: 1 near, 0 at infinity.
        clip_from_world: mat4,
        /// Inverse of clip_from_world.
        world_from_clip: mat4,
        /// World to view space; the camera looks along -Z.
        view_from_world: mat4,
        /// Camera position, world space.
        eye_ws: vec3,
        /// Factor from luminance (cd/m^2) to the display's 0..1: 1 / (1.2 * 2^EV100).
        exposure: float,
        /// Light from everywhere, linear RGB times cd/m^2.
        ambient: vec3,
        /// Seconds since the start, or `--time`.
        time_s: float,
        /// Linear RGB behind the model, and its alpha.
        background: vec4,
        /// Center of the model's bounds, world space.
        scene_center_ws: vec3,
        /// Radius of the model's bounds, meters.
        scene_radius: float,
        /// Smallest corner of the model's bounds, world space.
        scene_min_ws: vec3,
        /// Largest corner of the model's bounds, world space.
        scene_max_ws: vec3,
        /// Width and height of the picture, pixels.
        viewport_px: vec2,
        /// Upper left corner of the picture in the output image, pixels.
        viewport_origin_px: vec2,
        /// Near plane distance, meters.
        near: float,
        /// Far plane distance for debug modes, meters; the projection is infinite.
        far: float,
        /// Number of lights in `lights`; the suns follow them.
        light_count: uint,
        /// The light that the BRDF term modes show: 0 all, else 1-based.
        chosen_light: uint,
        /// Debug mode on screen, for passes that are not specialized by mode.
        mode: uint,
        /// Largest value that the HDR target holds: 65504 for half floats.
        largest_value: float,
        /// Cosine and sine of the environment's rotation around +Y; at 0 the map's center column is seen looking down -Z.
        environment_rotation: vec2,
        /// Factor from the values of the environment's images to cd/m^2.
        environment_intensity: float,
        /// Blur of the environment behind the model: 0 sharp .. 1, as a roughness.
        environment_blur: float,
        /// Variance of each sun's directions along one axis, radians squared.
        sun_variance: [float; MAX_SUNS],
        /// Accumulating modes: frames since the picture changed.
        sample_index: uint,
        /// Accumulating modes: random paths a pixel in each frame.
        sample_count: uint,
        /// Modes that trace the model: number of times that a path goes on from the surface that it has hit.
        path_bounces: uint,
        /// Seconds since the frame before; 0 in the first.
        delta_s: float,
        /// Frames drawn before this one. Stays while nothing moves.
        frame_index: uint,
        /// Pixels from the upper left corner: xy last place of the mouse while the left button was down, zw where it went down; z < 0 once it is up, w < 0 after the first frame of a click.
        mouse_px: vec4,
        /// clip_from_world of the last picture before this one; in the first the same as now.
        clip_from_world_before: mat4,
        /// The first lights, with the suns after them: world to the clip space of a light that sees the model's bounds; depth is reversed: 1 near, 0 far.
        light_clip_from_world: [mat4; MAX_LIGHT_VIEWS],
        /// Year, month from 0, day from 1, seconds of the day: local time in a window, in `render` that of `--date`.
        date: vec4,
        /// Keys, 32 in an element: 8 elements tell which are down, 8 which went down in this frame, 8 which are toggled. See common/keys.glsl.
        keys: [uint; 24],
        /// The value that the display shows as 0, if range_scale is not 0.
        range_low: float,
        /// 1 / the range of values that the display shows; 0: values are stored as the mode says.
        range_scale: float,
        /// The channels that the display shows: 0 RGB, 1 to 3 one of them, 4 coverage.
        channels: uint,
        /// Whether colors stand for a number: 0 or 1.
        has_colormap: uint,
        /// Amplitude of the dither in steps of 8 bits: 0 or 1.
        dither: float,
        /// The colors that stand for the numbers from 0 to 1, at equal steps. Linear RGB.
        colormap: [vec3; COLORMAP_STEPS],
        /// Whether modes that show a color for each number give the number itself: 1 where a single pixel is read, else 0.
        gives_numbers: uint,
        /// Pixels from the upper left corner: where the mouse is, with or without a button; -1, -1 beyond the picture.
        cursor_px: vec2,
        /// The mouse buttons that went down over the picture and are still down: 1 left, 2 right, 4 middle.
        mouse_buttons: uint,
    }

    /// A light, in world space. `BINDING_LIGHTS` holds an array of them.
    Light: "struct Light", "" {
        /// Position and 1; directional: unit vector towards the light and 0.
        position_ws: vec4,
        /// Direction in which the light shines, unit.
        direction_ws: vec3,
        /// LIGHT_*.
        kind: uint,
        /// Linear RGB times candela (point, spot), lux (directional) or cd/m^2 (rectangle).
        intensity: vec3,
        /// 1 / the distance at which the light ends, 1/m; 0: no end.
        inverse_range: float,
        /// Spot: falloff is the square of scale * cosine + offset, clamped to 0..1; other kinds: 0.
        angle_scale: float,
        /// The offset in that falloff; other kinds: 1.
        angle_offset: float,
        /// Rectangle: from its center to the middle of an edge, meters.
        half_x_ws: vec3,
        /// Rectangle: from its center to the middle of a neighboring edge, meters.
        half_y_ws: vec3,
    }

    /// The head of the grid of lights. The words of lighting/light_grid.glsl follow it in `BINDING_LIGHT_GRID`.
    LightGrid: "struct LightGrid", "" {
        /// Smallest corner of the grid, world space.
        min_ws: vec3,
        /// Place of the list of the lights that reach every point.
        everywhere: uint,
        /// Cells for each meter along the axes, 1/m.
        cells_per_m: vec3,
        /// Number of lights in that list.
        everywhere_count: uint,
        /// Cells along the axes; 0: there is no grid.
        cells: uvec3,
    }
}

blocks! {
    /// All other blocks.
    OTHER_BLOCKS:

    /// The parameters of one compute dispatch.
    Task: "layout(set = SET_TASK, binding = BINDING_TASK, scalar) uniform Task", "task" {
        /// Width and height of the output: texels, or columns and rows of BINDING_RESULTS.
        size: uvec2,
        /// Mip level that is written.
        level: uint,
        /// Number of mip levels of the image.
        levels: uint,
        /// Samples for each texel or result.
        samples: uint,
        /// Factor that fits radiance into half floats.
        radiance_scale: float,
        /// 1: suns are taken out of the list of small lights. Else 0.
        separates_suns: uint,
        /// Roughness of the first row.
        roughness_first: float,
        /// Roughness of the last row.
        roughness_last: float,
        /// Angle to the normal of the first column, degrees.
        theta_first: float,
        /// Angle to the normal of the last column, degrees.
        theta_last: float,
        /// Linear RGB of the measured surface.
        base_color: vec3,
        /// 0 dielectric .. 1 metal.
        metallic: float,
    }

    /// A vertex. Shaders read vertices by address.
    #[derive(PartialEq)]
    Vertex: "struct Vertex", "" {
        /// Object space, meters.
        position: vec3,
        /// Object space, unit.
        normal: vec3,
        /// Object space, unit; w is the sign of the bitangent.
        tangent: vec4,
        /// TEXCOORD_0, or 0.
        uv0: vec2,
        /// TEXCOORD_1, or uv0.
        uv1: vec2,
        /// COLOR_0, linear RGBA, or 1.
        color: vec4,
    }

    /// A joint that moves a vertex.
    #[derive(PartialEq)]
    Influence: "struct Influence", "" {
        /// Index of the joint in its skin; in range.
        joint: uint,
        /// Its weight. Those of a vertex add up to 1.
        weight: float,
    }

    /// The change of a vertex by a morph target with a weight of 1.
    #[derive(PartialEq)]
    Displacement: "struct Displacement", "" {
        /// Added to the position, object space, meters.
        position: vec3,
        /// Added to the normal, before it is normalized.
        normal: vec3,
        /// Added to the tangent's direction.
        tangent: vec3,
        /// Added to the first texture coordinates.
        uv0: vec2,
        /// Added to the second texture coordinates.
        uv1: vec2,
        /// Added to the color.
        color: vec4,
    }

    /// An instance whose vertices joints or morph targets move. `BINDING_DEFORMATIONS` holds an array of them.
    Deformation: "struct Deformation", "" {
        /// The vertices of the mesh.
        vertices: Vertices,
        /// The moved vertices.
        moved: MovedVertices,
        /// Influences of all vertices, influences_per_vertex for each.
        influences: Influences,
        /// Displacements of all morph targets, vertex_count for each.
        displacements: Displacements,
        /// Matrices of the joints: world space from the object space of the mesh.
        joints: Joints,
        /// Weights of the morph targets.
        weights: Weights,
        /// Number of vertices.
        vertex_count: uint,
        /// Influences of each vertex; 0 without a skin.
        influences_per_vertex: uint,
        /// Number of morph targets.
        target_count: uint,
        /// ATTRIBUTE_* bits of the mesh.
        attributes: uint,
    }

    /// A node of the bounding volume hierarchy that random paths trace. The root is node 0.
    BvhNode: "struct BvhNode", "" {
        /// Smallest corner, world space.
        min_ws: vec3,
        /// Leaf: its first triangle. Otherwise the first of its two children, which are neighbors.
        first: uint,
        /// Largest corner, world space.
        max_ws: vec3,
        /// Leaf: its number of triangles. Otherwise 0.
        count: uint,
    }

    /// A triangle that random paths can hit.
    TracedTriangle: "struct TracedTriangle", "" {
        /// Its first corner, world space.
        corner_ws: vec3,
        /// From the first corner to the second.
        edge_1_ws: vec3,
        /// From the first corner to the third.
        edge_2_ws: vec3,
    }

    /// Attributes at the corners of a traced triangle. A triangle has the same index in both buffers.
    TracedCorners: "struct TracedCorners", "" {
        /// Each corner's normal, world space: octahedral, packSnorm2x16.
        normals_ws: uvec3,
        /// Each corner's COLOR_0, linear RGBA: packUnorm4x8.
        colors: uvec3,
        /// Texture coordinates of the first corner.
        uv_0: vec2,
        /// Texture coordinates of the second corner.
        uv_1: vec2,
        /// Texture coordinates of the third corner.
        uv_2: vec2,
        /// Index into the materials.
        material: uint,
    }

    /// A material as random paths see it after the first hit.
    TracedMaterial: "struct TracedMaterial", "" {
        /// Linear RGBA.
        base_color_factor: vec4,
        /// Linear RGB. Unlit materials: 0.
        emissive_factor: vec3,
        /// 0 dielectric .. 1 metal.
        metallic_factor: float,
        /// Perceptual roughness 0..1.
        roughness_factor: float,
        /// ALPHA_MASK: a hit with less coverage does not count.
        alpha_cutoff: float,
        /// ALPHA_*.
        alpha_mode: uint,
        /// 1: KHR_materials_unlit, the base color is emitted and nothing reflected; otherwise 0.
        unlit: uint,
        /// Fraction of the rays that pass straight through: transmission of a dielectric, 0..1.
        transmission: float,
        /// Index of refraction of the dielectric.
        ior: float,
        /// Its reflectance at normal incidence, linear RGB.
        f0: vec3,
        /// Its reflectance at grazing incidence.
        f90: float,
        /// Layers of base color, metallic-roughness and emissive texture in BINDING_TRACED_TEXTURES, or NO_TEXTURE.
        layers: uvec3,
        /// KHR_texture_transform of these textures, applied to (u, v, 1).
        uv_from_texture: [mat3x2; 3],
    }

    /// A cell of the environment's cube map, as an entry of an alias table. A face has cells x cells of them, row by row.
    EnvironmentCell: "struct EnvironmentCell", "" {
        /// Probability of staying in this cell instead of going on to `other`.
        keep: float,
        /// The other cell.
        other: uint,
        /// Probability density of a point of the cell, per unit of area of a face that spans -1..1.
        density: float,
    }

    /// Where a draw was in the frame before. `Draw::before` points to it.
    Before: "struct Before", "" {
        /// Device address of the first vertex.
        vertices: Vertices,
        /// Object to world space, without the matrix's last row.
        world_from_object: mat4x3,
    }

    /// The draw that a stage runs for.
    Draw: "layout(push_constant, scalar) uniform Draw", "draw" {
        /// Device address of the first vertex.
        vertices: Vertices,
        /// Object to world space, without the matrix's last row.
        world_from_object: mat4x3,
        /// Inverse transpose of its upper 3x3.
        normal_ws_from_object: mat3,
        /// ATTRIBUTE_* bits of the mesh.
        attributes: uint,
        /// Index of the primitive, for the id modes.
        primitive_id: uint,
        /// Index of the node, for the id modes.
        node_id: uint,
        /// Device address of the first index, for mesh stages.
        indices: Indices,
        /// Mesh stages: triangles of the primitive.
        triangle_count: uint,
        /// Mesh stages: number of the first triangle that this draw gives. Not 0 if the primitive takes several draws.
        first_triangle: uint,
        /// `before.at[0]`: where it was in the frame before, if `attributes` has ATTRIBUTE_MOVED.
        before: Befores,
    }
}

const _: () = assert!(size_of::<Draw>() <= PUSH_CONSTANT_SIZE as usize);
