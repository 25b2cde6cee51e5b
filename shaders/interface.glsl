// Printed by src/interface.rs. Do not edit: Rust writes this memory, and a test compares this file with what Rust prints.
// The sets, bindings, specialization constants and structs that every shader may use, all in scalar layout.
#ifndef SPECULA_INTERFACE_GLSL
#define SPECULA_INTERFACE_GLSL

#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_control_flow_attributes : require

const uint INTERFACE_VERSION = 11u;
const int SET_FRAME = 0;
const int SET_MATERIAL = 1;
const int SET_PASS = 2;
const int SET_TASK = 3;
const int BINDING_FRAME = 0;
const int BINDING_FEW_LIGHTS = 1;
const int BINDING_PARAMS = 2;
const int BINDING_ENVIRONMENT = 3;
const int BINDING_PREFILTERED = 4;
const int BINDING_PREFILTERED_SHEEN = 5;
const int BINDING_IRRADIANCE = 6;
const int BINDING_DFG = 7;
const int BINDING_LTC = 8;
const int BINDING_MEASURED = 9;
const int BINDING_SHEEN_ALBEDO = 10;
const int BINDING_DIFFUSE_ALBEDO = 12;
const int BINDING_LAMP_DFG = 13;
const int BINDING_BVH = 14;
const int BINDING_TRACED_TRIANGLES = 15;
const int BINDING_TRACED_CORNERS = 16;
const int BINDING_TRACED_MATERIALS = 17;
const int BINDING_TRACED_TEXTURES = 18;
const int BINDING_ENVIRONMENT_CELLS = 19;
const int BINDING_LOOPS = 20;
const int BINDING_LIGHTS = 21;
const int BINDING_LIGHT_GRID = 22;
const int BINDING_MATERIAL = 0;
const int BINDING_TASK = 0;
const int BINDING_SOURCE = 1;
const int BINDING_SOURCE_CUBE = 2;
const int BINDING_TARGET = 3;
const int BINDING_LEVEL_ABOVE = 4;
const int BINDING_RESULTS = 5;
const int BINDING_LOBE_TARGET = 6;
const int BINDING_LOBE = 7;
const int BINDING_SMALL_LIGHTS = 9;
const int BINDING_PACKED = 10;
const int BINDING_DEFORMATIONS = 11;
const int BINDING_TASK_LOOPS = 8;
const int BINDING_BASE_COLOR_TEXTURE = 1;
const int BINDING_METALLIC_ROUGHNESS_TEXTURE = 2;
const int BINDING_NORMAL_TEXTURE = 3;
const int BINDING_OCCLUSION_TEXTURE = 4;
const int BINDING_EMISSIVE_TEXTURE = 5;
const int BINDING_CLEARCOAT_TEXTURE = 6;
const int BINDING_CLEARCOAT_ROUGHNESS_TEXTURE = 7;
const int BINDING_CLEARCOAT_NORMAL_TEXTURE = 8;
const int BINDING_ANISOTROPY_TEXTURE = 9;
const int BINDING_SHEEN_COLOR_TEXTURE = 10;
const int BINDING_SHEEN_ROUGHNESS_TEXTURE = 11;
const int BINDING_SPECULAR_TEXTURE = 12;
const int BINDING_SPECULAR_COLOR_TEXTURE = 13;
const int BINDING_IRIDESCENCE_TEXTURE = 14;
const int BINDING_IRIDESCENCE_THICKNESS_TEXTURE = 15;
const int BINDING_TRANSMISSION_TEXTURE = 16;
const int BINDING_THICKNESS_TEXTURE = 17;
const int BINDING_DIFFUSE_TRANSMISSION_TEXTURE = 18;
const int BINDING_DIFFUSE_TRANSMISSION_COLOR_TEXTURE = 19;
const int USER_CONSTANTS = 32;
const uint EDGES_MODE = 0x3fffffffu;
const uint PASS_MODES = 0x40000000u;
const uint ALPHA_OPAQUE = 0u;
const uint ALPHA_MASK = 1u;
const uint ALPHA_BLEND = 2u;
const uint FEATURE_UNLIT = 1u;
const uint FEATURE_NORMAL_TEXTURE = 2u;
const uint FEATURE_CLEARCOAT = 4u;
const uint FEATURE_CLEARCOAT_NORMAL = 8u;
const uint FEATURE_ANISOTROPY = 16u;
const uint FEATURE_SHEEN = 32u;
const uint FEATURE_SPECULAR = 64u;
const uint FEATURE_IRIDESCENCE = 128u;
const uint FEATURE_TRANSMISSION = 256u;
const uint FEATURE_VOLUME = 512u;
const uint FEATURE_DISPERSION = 1024u;
const uint FEATURE_DIFFUSE_TRANSMISSION = 2048u;
const uint FEATURE_SPECULAR_GLOSSINESS = 4096u;
const uint FEATURE_CONDUCTOR = 8192u;
const uint FEATURE_PACKED_OCCLUSION = 16384u;
const uint FEATURE_ENVIRONMENT = 32768u;
const uint FEATURE_RECT_LIGHTS = 0x10000u;
const uint FEATURE_TEXTURE_COORDINATES = 0x20000u;
const uint FEATURE_UV1 = 0x40000u;
const uint FEATURE_VERTEX_COLOR = 0x80000u;
const uint ATTRIBUTE_NORMAL = 1u;
const uint ATTRIBUTE_TANGENT = 2u;
const uint ATTRIBUTE_UV0 = 4u;
const uint ATTRIBUTE_UV1 = 8u;
const uint ATTRIBUTE_COLOR = 16u;
const uint ATTRIBUTE_TANGENT_FRAME = 32u;
const uint ATTRIBUTE_MOVED = 64u;
const uint LIGHT_DIRECTIONAL = 0u;
const uint LIGHT_POINT = 1u;
const uint LIGHT_SPOT = 2u;
const uint LIGHT_RECT = 3u;
const uint MEASURED_NONE = 0u;
const uint MEASURED_MERL = 1u;
const uint MEASURED_UTIA = 2u;
const uint ENCODE_COLOR = 0u;
const uint ENCODE_DATA = 1u;
const uint ENCODE_VECTOR = 2u;
const uint FLAG_NO_DATA = 16u;
const uint FLAG_NOT_FINITE = 256u;
const uint MAX_BVH_DEPTH = 64u;
const uint NO_TEXTURE = 0xffffffffu;
const uint IRRADIANCE_SIDE = 68u;
const uint SPECULAR_LEVELS = 16u;
const uint MIRROR_SIDE = 640u;
const uint SPECULAR_SIDE = 320u;
const uint SPECULAR_WIDTH = 648u;
const uint SPECULAR_HEIGHT = 1792u;
const uint TONEMAP_OFF = 0xffffffffu;
const uint TEXTURE_BASE_COLOR = 0u;
const uint TEXTURE_METALLIC_ROUGHNESS = 1u;
const uint TEXTURE_NORMAL = 2u;
const uint TEXTURE_OCCLUSION = 3u;
const uint TEXTURE_EMISSIVE = 4u;
const uint TEXTURE_CLEARCOAT = 5u;
const uint TEXTURE_CLEARCOAT_ROUGHNESS = 6u;
const uint TEXTURE_CLEARCOAT_NORMAL = 7u;
const uint TEXTURE_ANISOTROPY = 8u;
const uint TEXTURE_SHEEN_COLOR = 9u;
const uint TEXTURE_SHEEN_ROUGHNESS = 10u;
const uint TEXTURE_SPECULAR = 11u;
const uint TEXTURE_SPECULAR_COLOR = 12u;
const uint TEXTURE_IRIDESCENCE = 13u;
const uint TEXTURE_IRIDESCENCE_THICKNESS = 14u;
const uint TEXTURE_TRANSMISSION = 15u;
const uint TEXTURE_THICKNESS = 16u;
const uint TEXTURE_DIFFUSE_TRANSMISSION = 17u;
const uint TEXTURE_DIFFUSE_TRANSMISSION_COLOR = 18u;
const int TEXTURE_COUNT = 19;
const int MAX_LIGHTS = 32768;
const int FEW_LIGHTS = 96;
const int MAX_SUNS = 4;
const int MAX_LIGHT_VIEWS = 16;
const int COLORMAP_STEPS = 17;

layout(constant_id = 0) const uint MODE = 0u; // debug mode, one of MODE_* in debug/modes.glsl
layout(constant_id = 1) const uint ALPHA_MODE = 0u; // glTF alphaMode, one of ALPHA_*
layout(constant_id = 2) const uint FEATURES = 0u; // what the material uses, FEATURE_* bits
layout(constant_id = 3) const uint TONEMAP = 0u; // tone map, one of TONEMAP_* in common/tonemap.glsl
layout(constant_id = 4) const uint ENCODE = 0u; // how the picture stores values, one of ENCODE_*
layout(constant_id = 5) const uint LIGHT_COUNT = 0u; // lights, if they are few; 0: see frame.light_count
layout(constant_id = 6) const uint MAPS_VALUES = 0u; // not 0: the display maps values by range, channels or colormap
layout(constant_id = 7) const uint SUN_COUNT = 0u; // suns of the environment, which its irradiance and specular levels leave out
layout(constant_id = 8) const uint SAMPLES = 0u; // samples of a pixel; for the passes with to=resolve and to=peel
layout(constant_id = 9) const uint MANY_LIGHTS = 0u; // not 0: more than FEW_LIGHTS lights; see lighting/light_grid.glsl

layout(set = SET_FRAME, binding = BINDING_FRAME, scalar) uniform Frame {
    mat4 clip_from_world;              // World (meters, +Y up) to clip space (+Y down); depth is reversed: 1 near, 0 at infinity.
    mat4 world_from_clip;              // Inverse of clip_from_world.
    mat4 view_from_world;              // World to view space; the camera looks along -Z.
    vec3 eye_ws;                       // Camera position, world space.
    float exposure;                    // Factor from luminance (cd/m^2) to the display's 0..1: 1 / (1.2 * 2^EV100).
    vec3 ambient;                      // Light from everywhere, linear RGB times cd/m^2.
    float time_s;                      // Seconds since the start, or `--time`.
    vec4 background;                   // Linear RGB behind the model, and its alpha.
    vec3 scene_center_ws;              // Center of the model's bounds, world space.
    float scene_radius;                // Radius of the model's bounds, meters.
    vec3 scene_min_ws;                 // Smallest corner of the model's bounds, world space.
    vec3 scene_max_ws;                 // Largest corner of the model's bounds, world space.
    vec2 viewport_px;                  // Width and height of the picture, pixels.
    vec2 viewport_origin_px;           // Upper left corner of the picture in the output image, pixels.
    float near;                        // Near plane distance, meters.
    float far;                         // Far plane distance for debug modes, meters; the projection is infinite.
    uint light_count;                  // Number of lights in `lights`; the suns follow them.
    uint chosen_light;                 // The light that the BRDF term modes show: 0 all, else 1-based.
    uint mode;                         // Debug mode on screen, for passes that are not specialized by mode.
    float largest_value;               // Largest value that the HDR target holds: 65504 for half floats.
    vec2 environment_rotation;         // Cosine and sine of the environment's rotation around +Y; at 0 the map's center column is seen looking down -Z.
    float environment_intensity;       // Factor from the values of the environment's images to cd/m^2.
    float environment_blur;            // Blur of the environment behind the model: 0 sharp .. 1, as a roughness.
    float sun_variance[MAX_SUNS];      // Variance of each sun's directions along one axis, radians squared.
    uint sample_index;                 // Accumulating modes: frames since the picture changed.
    uint sample_count;                 // Accumulating modes: random paths a pixel in each frame.
    uint path_bounces;                 // Modes that trace the model: number of times that a path goes on from the surface that it has hit.
    float delta_s;                     // Seconds since the frame before; 0 in the first.
    uint frame_index;                  // Frames drawn before this one. Stays while nothing moves.
    vec4 mouse_px;                     // Pixels from the upper left corner: xy last place of the mouse while the left button was down, zw where it went down; z < 0 once it is up, w < 0 after the first frame of a click.
    mat4 clip_from_world_before;       // clip_from_world of the last picture before this one; in the first the same as now.
    mat4 light_clip_from_world[MAX_LIGHT_VIEWS]; // The first lights, with the suns after them: world to the clip space of a light that sees the model's bounds; depth is reversed: 1 near, 0 far.
    vec4 date;                         // Year, month from 0, day from 1, seconds of the day: local time in a window, in `render` that of `--date`.
    uint keys[24];                     // Keys, 32 in an element: 8 elements tell which are down, 8 which went down in this frame, 8 which are toggled. See common/keys.glsl.
    float range_low;                   // The value that the display shows as 0, if range_scale is not 0.
    float range_scale;                 // 1 / the range of values that the display shows; 0: values are stored as the mode says.
    uint channels;                     // The channels that the display shows: 0 RGB, 1 to 3 one of them, 4 coverage.
    uint has_colormap;                 // Whether colors stand for a number: 0 or 1.
    float dither;                      // Amplitude of the dither in steps of 8 bits: 0 or 1.
    vec3 colormap[COLORMAP_STEPS];     // The colors that stand for the numbers from 0 to 1, at equal steps. Linear RGB.
    uint gives_numbers;                // Whether modes that show a color for each number give the number itself: 1 where a single pixel is read, else 0.
    vec2 cursor_px;                    // Pixels from the upper left corner: where the mouse is, with or without a button; -1, -1 beyond the picture.
    uint mouse_buttons;                // The mouse buttons that went down over the picture and are still down: 1 left, 2 right, 4 middle.
} frame;

struct Light {
    vec4 position_ws;                  // Position and 1; directional: unit vector towards the light and 0.
    vec3 direction_ws;                 // Direction in which the light shines, unit.
    uint kind;                         // LIGHT_*.
    vec3 intensity;                    // Linear RGB times candela (point, spot), lux (directional) or cd/m^2 (rectangle).
    float inverse_range;               // 1 / the distance at which the light ends, 1/m; 0: no end.
    float angle_scale;                 // Spot: falloff is the square of scale * cosine + offset, clamped to 0..1; other kinds: 0.
    float angle_offset;                // The offset in that falloff; other kinds: 1.
    vec3 half_x_ws;                    // Rectangle: from its center to the middle of an edge, meters.
    vec3 half_y_ws;                    // Rectangle: from its center to the middle of a neighboring edge, meters.
};

layout(set = SET_FRAME, binding = BINDING_LIGHTS, scalar) readonly buffer Lights {
    Light lights[]; // frame.light_count lights, then SUN_COUNT suns
};

layout(set = SET_FRAME, binding = BINDING_FEW_LIGHTS, scalar) uniform FewLights {
    Light few_lights[FEW_LIGHTS + MAX_SUNS]; // the same, if MANY_LIGHTS is 0
};

struct LightGrid {
    vec3 min_ws;                       // Smallest corner of the grid, world space.
    uint everywhere;                   // Place of the list of the lights that reach every point.
    vec3 cells_per_m;                  // Cells for each meter along the axes, 1/m.
    uint everywhere_count;             // Number of lights in that list.
    uvec3 cells;                       // Cells along the axes; 0: there is no grid.
};

layout(set = SET_MATERIAL, binding = BINDING_MATERIAL, scalar) uniform Material {
    vec4 base_color_factor;            // Linear RGBA.
    vec3 emissive_factor;              // Linear RGB times cd/m^2, KHR_materials_emissive_strength included.
    float metallic_factor;             // 0 dielectric .. 1 metal.
    float roughness_factor;            // Perceptual roughness 0..1.
    float normal_scale;                // Scale of the normal texture's x and y.
    float occlusion_strength;          // 0 no occlusion .. 1 as in the texture.
    float alpha_cutoff;                // ALPHA_MASK: a fragment with less coverage is discarded.
    uint texture_mask;                 // Bit TEXTURE_*: the material has this texture; else a default one is bound.
    uint uv1_mask;                     // Bit TEXTURE_*: the texture is read at TEXCOORD_1.
    uint id;                           // Index of the material, for the id mode.
    float clearcoat_factor;            // Clear coat factor 0..1.
    float clearcoat_roughness;         // Perceptual roughness of the clear coat.
    float clearcoat_normal_scale;      // Scale of the clear coat normal texture's x and y.
    float anisotropy_strength;         // Anisotropy strength 0..1.
    vec2 anisotropy_rotation;          // Cosine and sine of the rotation from the tangent towards the bitangent.
    float sheen_roughness;             // Perceptual roughness of the sheen.
    vec3 sheen_color;                  // Linear RGB.
    float specular_factor;             // Weight of the dielectric's specular reflection 0..1 (KHR_materials_specular).
    vec3 specular_color;               // Linear RGB, tints the dielectric's F0; specular-glossiness: F0 itself.
    float ior;                         // Index of refraction, at least 1; 0 stands for infinity.
    float iridescence_factor;          // Iridescence factor 0..1.
    float iridescence_ior;             // Index of refraction of the thin film.
    vec2 iridescence_thickness_nm;     // Thickness of the film where its texture is 0 and where it is 1, nanometers.
    float transmission_factor;         // Transmission factor 0..1.
    float thickness;                   // Thickness of the volume below the surface, meters in object space; 0: thin wall.
    vec3 attenuation_color;            // Color of white light after attenuation_distance.
    float attenuation_distance;        // Meters; infinite without attenuation.
    float dispersion;                  // 20 / Abbe number (KHR_materials_dispersion).
    float diffuse_transmission_factor; // Part of the diffuse light that is transmitted, 0..1.
    vec3 diffuse_transmission_color;   // Linear RGB.
    vec3 conductor_n;                  // Real part of the metal's index of refraction at about 650, 550 and 450 nm.
    vec3 conductor_k;                  // Imaginary part (extinction coefficient), positive.
    mat3x2 uv_from_texture[TEXTURE_COUNT]; // KHR_texture_transform of each texture, applied to (u, v, 1).
} material;

layout(set = SET_TASK, binding = BINDING_TASK, scalar) uniform Task {
    uvec2 size;                        // Width and height of the output: texels, or columns and rows of BINDING_RESULTS.
    uint level;                        // Mip level that is written.
    uint levels;                       // Number of mip levels of the image.
    uint samples;                      // Samples for each texel or result.
    float radiance_scale;              // Factor that fits radiance into half floats.
    uint separates_suns;               // 1: suns are taken out of the list of small lights. Else 0.
    float roughness_first;             // Roughness of the first row.
    float roughness_last;              // Roughness of the last row.
    float theta_first;                 // Angle to the normal of the first column, degrees.
    float theta_last;                  // Angle to the normal of the last column, degrees.
    vec3 base_color;                   // Linear RGB of the measured surface.
    float metallic;                    // 0 dielectric .. 1 metal.
} task;

struct Vertex {
    vec3 position;                     // Object space, meters.
    vec3 normal;                       // Object space, unit.
    vec4 tangent;                      // Object space, unit; w is the sign of the bitangent.
    vec2 uv0;                          // TEXCOORD_0, or 0.
    vec2 uv1;                          // TEXCOORD_1, or uv0.
    vec4 color;                        // COLOR_0, linear RGBA, or 1.
};

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Vertices {
    Vertex at[];
};

// Vertices of a triangle. A struct: of two arrays of plain uint in one module, an edit could not tell which is meant.
struct Corners {
    uint vertex[3];
};

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Indices {
    Corners at[];
};

struct Influence {
    uint joint;                        // Index of the joint in its skin; in range.
    float weight;                      // Its weight. Those of a vertex add up to 1.
};

struct Displacement {
    vec3 position;                     // Added to the position, object space, meters.
    vec3 normal;                       // Added to the normal, before it is normalized.
    vec3 tangent;                      // Added to the tangent's direction.
    vec2 uv0;                          // Added to the first texture coordinates.
    vec2 uv1;                          // Added to the second texture coordinates.
    vec4 color;                        // Added to the color.
};

layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer MovedVertices {
    Vertex at[];
};

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Influences {
    Influence at[];
};

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Displacements {
    Displacement at[];
};

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Joints {
    mat4 at[];
};

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Weights {
    float at[];
};

struct Deformation {
    Vertices vertices;                 // The vertices of the mesh.
    MovedVertices moved;               // The moved vertices.
    Influences influences;             // Influences of all vertices, influences_per_vertex for each.
    Displacements displacements;       // Displacements of all morph targets, vertex_count for each.
    Joints joints;                     // Matrices of the joints: world space from the object space of the mesh.
    Weights weights;                   // Weights of the morph targets.
    uint vertex_count;                 // Number of vertices.
    uint influences_per_vertex;        // Influences of each vertex; 0 without a skin.
    uint target_count;                 // Number of morph targets.
    uint attributes;                   // ATTRIBUTE_* bits of the mesh.
};

struct BvhNode {
    vec3 min_ws;                       // Smallest corner, world space.
    uint first;                        // Leaf: its first triangle. Otherwise the first of its two children, which are neighbors.
    vec3 max_ws;                       // Largest corner, world space.
    uint count;                        // Leaf: its number of triangles. Otherwise 0.
};

struct TracedTriangle {
    vec3 corner_ws;                    // Its first corner, world space.
    vec3 edge_1_ws;                    // From the first corner to the second.
    vec3 edge_2_ws;                    // From the first corner to the third.
};

struct TracedCorners {
    uvec3 normals_ws;                  // Each corner's normal, world space: octahedral, packSnorm2x16.
    uvec3 colors;                      // Each corner's COLOR_0, linear RGBA: packUnorm4x8.
    vec2 uv_0;                         // Texture coordinates of the first corner.
    vec2 uv_1;                         // Texture coordinates of the second corner.
    vec2 uv_2;                         // Texture coordinates of the third corner.
    uint material;                     // Index into the materials.
};

struct TracedMaterial {
    vec4 base_color_factor;            // Linear RGBA.
    vec3 emissive_factor;              // Linear RGB. Unlit materials: 0.
    float metallic_factor;             // 0 dielectric .. 1 metal.
    float roughness_factor;            // Perceptual roughness 0..1.
    float alpha_cutoff;                // ALPHA_MASK: a hit with less coverage does not count.
    uint alpha_mode;                   // ALPHA_*.
    uint unlit;                        // 1: KHR_materials_unlit, the base color is emitted and nothing reflected; otherwise 0.
    float transmission;                // Fraction of the rays that pass straight through: transmission of a dielectric, 0..1.
    float ior;                         // Index of refraction of the dielectric.
    vec3 f0;                           // Its reflectance at normal incidence, linear RGB.
    float f90;                         // Its reflectance at grazing incidence.
    uvec3 layers;                      // Layers of base color, metallic-roughness and emissive texture in BINDING_TRACED_TEXTURES, or NO_TEXTURE.
    mat3x2 uv_from_texture[3];         // KHR_texture_transform of these textures, applied to (u, v, 1).
};

struct EnvironmentCell {
    float keep;                        // Probability of staying in this cell instead of going on to `other`.
    uint other;                        // The other cell.
    float density;                     // Probability density of a point of the cell, per unit of area of a face that spans -1..1.
};

struct Before {
    Vertices vertices;                 // Device address of the first vertex.
    mat4x3 world_from_object;          // Object to world space, without the matrix's last row.
};

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer Befores {
    Before at[];
};

layout(push_constant, scalar) uniform Draw {
    Vertices vertices;                 // Device address of the first vertex.
    mat4x3 world_from_object;          // Object to world space, without the matrix's last row.
    mat3 normal_ws_from_object;        // Inverse transpose of its upper 3x3.
    uint attributes;                   // ATTRIBUTE_* bits of the mesh.
    uint primitive_id;                 // Index of the primitive, for the id modes.
    uint node_id;                      // Index of the node, for the id modes.
    Indices indices;                   // Device address of the first index, for mesh stages.
    uint triangle_count;               // Mesh stages: triangles of the primitive.
    uint first_triangle;               // Mesh stages: number of the first triangle that this draw gives. Not 0 if the primitive takes several draws.
    Befores before;                    // `before.at[0]`: where it was in the frame before, if `attributes` has ATTRIBUTE_MOVED.
} draw;

#endif
