// Where a light sees a point: the projections of the shadow map, an image with a tile for each light.
#ifndef LIGHTING_SHADOW_VIEW_GLSL
#define LIGHTING_SHADOW_VIEW_GLSL

#include "interface.glsl"
#include "common/sampling.glsl"

// Lights with a tile. Others throw no shadow.
const uint MAX_SHADOWS = 16u;

// Tiles in a row of the shadow map, and rows.
uint shadow_tiles() { return uint(ceil(sqrt(float(clamp(frame.light_count, 1u, MAX_SHADOWS))))); }

struct ShadowPoint {
    vec4 clip;                 // in the light's tile: clip space, depth reversed
    float depth;               // 1 nearest to the light .. 0 behind the model, linear in meters along the light's axis
    float meters_per_depth;    // meters from depth 0 to depth 1
    float tile_m;              // width of the tile at this distance, meters
};

// A light sees the sphere around the model. A directional light sees it by a parallel projection, another by a
// perspective one towards the sphere's center. A light inside the sphere sees at most 143 degrees of it: tan = 3.
ShadowPoint shadow_point(Light light, vec3 position_ws) {
    float radius = 1.02 * frame.scene_radius;
    vec3 offset = frame.scene_center_ws - light.position_ws.xyz;
    float center_m = length(offset);
    bool is_parallel = light.position_ws.w == 0.0;
    mat3 axes = basis_around(is_parallel ? -light.position_ws.xyz : offset / max(center_m, 1e-6));
    ShadowPoint point;
    if (is_parallel) {
        vec3 seen = (position_ws - frame.scene_center_ws) * axes / radius;
        point.depth = 0.5 - 0.5 * seen.z;
        point.clip = vec4(seen.xy, point.depth, 1.0);
        point.meters_per_depth = point.tile_m = 2.0 * radius;
    } else {
        vec3 seen = (position_ws - light.position_ws.xyz) * axes;
        float tangent = min(radius * inversesqrt(max(center_m * center_m - radius * radius, 1e-6)), 3.0);
        float near = max(center_m - radius, 0.02 * radius);
        point.meters_per_depth = center_m + radius - near;
        point.depth = 1.0 - (seen.z - near) / point.meters_per_depth;
        point.clip = vec4(seen.xy / tangent, near, seen.z);
        point.tile_m = 2.0 * max(seen.z, 0.0) * tangent;
    }
    return point;
}

// Lower left corner of the light's tile in the map, 0..1.
vec2 shadow_tile(uint light) { return vec2(light % shadow_tiles(), light / shadow_tiles()) / float(shadow_tiles()); }

#endif
