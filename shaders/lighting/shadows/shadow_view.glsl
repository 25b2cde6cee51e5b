// Where a light sees a point: the projections of the shadow map, an image with a tile for each light.
#ifndef LIGHTING_SHADOW_VIEW_GLSL
#define LIGHTING_SHADOW_VIEW_GLSL

#include "interface.glsl"
#include "common/sampling.glsl"

// Lights with a tile. Others throw no shadow.
const uint MAX_SHADOWS = 16u;

// Side of the shadow map, pixels: the size in passes/shadows/shadow_map.frag. textureSize takes longer on a software device.
const float SHADOW_MAP_PX = 2048.0;

// Tiles in a row of the shadow map, and rows.
uint shadow_tiles() {
    uint lights = LIGHT_COUNT != 0u ? LIGHT_COUNT : frame.light_count;
    return lights <= 1u ? 1u : lights <= 4u ? 2u : lights <= 9u ? 3u : 4u;
}

// How a light sees the sphere around the model: a directional light by a parallel projection, another by a perspective one
// towards the sphere's center. A light inside the sphere sees at most 143 degrees of it: tangent = 3.
struct ShadowView {
    mat3 axes;                 // columns: right, up, and away from the light; world space
    vec3 origin_ws;            // the light, or the sphere's center if parallel
    bool is_parallel;
    float half_width;          // of the tile: meters if parallel, otherwise at 1 m
    float near_m;              // distance along the axis where depth is 1
    float meters_per_depth;    // meters from depth 1 to depth 0
};

ShadowView shadow_view(Light light) {
    ShadowView view;
    float radius = 1.02 * frame.scene_radius;
    view.is_parallel = light.position_ws.w == 0.0;
    if (view.is_parallel) {
        view.axes = basis_around(-light.position_ws.xyz);
        view.origin_ws = frame.scene_center_ws;
        view.half_width = radius;
        view.near_m = -radius;
        view.meters_per_depth = 2.0 * radius;
    } else {
        vec3 offset = frame.scene_center_ws - light.position_ws.xyz;
        float center_m = max(length(offset), 1e-6);
        view.axes = basis_around(offset / center_m);
        view.origin_ws = light.position_ws.xyz;
        view.half_width = min(radius * inversesqrt(max(center_m * center_m - radius * radius, 1e-6)), 3.0);
        view.near_m = max(center_m - radius, 0.02 * radius);
        view.meters_per_depth = center_m + radius - view.near_m;
    }
    return view;
}

// A point in the view: right, up and away from the origin, meters.
vec3 seen_from(ShadowView view, vec3 position_ws) { return (position_ws - view.origin_ws) * view.axes; }

// Half of the tile's width at a point, meters.
float half_width_at(ShadowView view, vec3 seen) { return view.is_parallel ? view.half_width : view.half_width * seen.z; }

// Depth of a point: 1 nearest to the light .. 0 behind the model, linear in meters along the axis.
float shadow_depth(ShadowView view, vec3 seen) { return 1.0 - (seen.z - view.near_m) / view.meters_per_depth; }

// Lower left corner of the light's tile in the map, 0..1.
vec2 shadow_tile(uint light) { return vec2(light % shadow_tiles(), light / shadow_tiles()) / float(shadow_tiles()); }

#endif
