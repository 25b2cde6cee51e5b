// Draws directions in which the environment is bright.
//
// Each face of the environment's cube map is divided into cells. Rust builds an alias table (Walker 1977; Vose 1991), in
// which a cell is as likely as its mean luminance times its solid angle (src/scene/environment/importance.rs). Within a
// cell all points are equally likely.
#ifndef PATHS_ENVIRONMENT_SAMPLING_GLSL
#define PATHS_ENVIRONMENT_SAMPLING_GLSL

#include "interface.glsl"
#include "ibl/maps/cube_map.glsl"
#include "lighting/environment.glsl"
#include "paths/lobe_sampling.glsl"

layout(set = SET_FRAME, binding = BINDING_ENVIRONMENT_CELLS, scalar) readonly buffer EnvironmentCells {
    uint cells_a_side;         // of a face; 0: the environment is black, or there is none
    EnvironmentCell cells[];
};

bool environment_has_light() { return (FEATURES & FEATURE_ENVIRONMENT) != 0u && cells_a_side > 0u; }

// Radiance from outside the model. Without an environment, uniform ambient light.
vec3 sky_radiance(vec3 direction) {
    return (FEATURES & FEATURE_ENVIRONMENT) != 0u ? environment_radiance(direction, 0.0) : frame.ambient;
}

// Requires environment_has_light().
DirectionSample sample_environment(vec3 u) {
    uint count = 6u * cells_a_side * cells_a_side;
    uint index = min(uint(u.z * float(count)), count - 1u);
    // u.y decides whether to stay there. Rescaled to 0..1, it is as good as new.
    float keep = cells[index].keep;
    bool stays = u.y < keep;
    u.y = stays ? u.y / keep : (u.y - keep) / (1.0 - keep);
    if (!stays) index = cells[index].other;

    uint face = index / (cells_a_side * cells_a_side);
    uvec2 cell = uvec2(index % cells_a_side, index / cells_a_side % cells_a_side);
    vec2 st = (vec2(cell) + u.xy) * (2.0 / float(cells_a_side)) - 1.0;
    vec3 l = normalize(world_from_map(cube_position(st, face)));
    return DirectionSample(l, cells[index].density / solid_angle_density(st));
}

// Density with which sample_environment draws l, 1/sr.
float pdf_environment(vec3 l) {
    if (!environment_has_light()) return 0.0;
    vec2 st;
    uint face = cube_face(map_from_world(l), st);
    uvec2 cell = min(uvec2((st * 0.5 + 0.5) * float(cells_a_side)), uvec2(cells_a_side - 1u));
    uint index = (face * cells_a_side + cell.y) * cells_a_side + cell.x;
    return cells[index].density / solid_angle_density(st);
}

#endif
