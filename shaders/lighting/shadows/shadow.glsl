// Shadows of punctual and rectangular lights, by shadow maps (Williams 1978). passes/shadows/shadow_map.frag draws the map.
#ifndef LIGHTING_SHADOW_GLSL
#define LIGHTING_SHADOW_GLSL

#include "interface.glsl"
#include "common/math.glsl"
#include "common/sampling.glsl"
#include "lighting/shadows/shadow_view.glsl"
#include "user/params.glsl"

const uint NO_SHADOWS = 0u;
const uint HARD_SHADOWS = 1u;
const uint SOFT_SHADOWS = 2u;
//@ui "Shadows" choice Off=0 Hard=1 Soft=2
layout(constant_id = USER_CONSTANTS + 10) const uint SHADOWS = NO_SHADOWS;

// Depth of what is nearest to each light. 0: nothing, as where the pass is off.
uniform sampler2D shadow_map;

// Part of 2 x 2 texels that do not hide the point, blended (percentage-closer filtering: Reeves, Salesin, Cook 1987).
float hard_visibility(vec2 uv, float depth) {
    vec2 texel = uv * SHADOW_MAP_PX - 0.5;
    vec2 corner = floor(texel);
    vec2 f = texel - corner;
    // A gather holds (0, 1), (1, 1), (1, 0), (0, 0), around a corner of four texels.
    vec4 lit = vec4(lessThanEqual(textureGather(shadow_map, (corner + 1.0) / SHADOW_MAP_PX), vec4(depth)));
    return mix(mix(lit.w, lit.z, f.x), mix(lit.x, lit.y, f.x), f.y);
}

// Samples of a disk of radius 1, at equal distances along a spiral (Vogel 1979). `turn`: 0..1, another for each pixel.
vec2 disk_sample(int i, int count, float turn) {
    float angle = (float(i) * 0.381966 + turn) * 2.0 * PI;
    return sqrt((float(i) + 0.5) / float(count)) * vec2(cos(angle), sin(angle));
}

// Interleaved gradient noise, 0..1 (Jimenez 2014).
float pixel_noise(vec2 pixel) { return fract(52.9829189 * fract(dot(pixel, vec2(0.06711056, 0.00583715)))); }

// Part of the light that reaches the point, 0..1. The edge of its shadow is as wide as the penumbra: the wider, the farther the
// point is from what hides it (percentage-closer soft shadows, Fernando 2005). `per_meter`: of the map's width. `angle`: width
// of the light / its distance. `low`, `high`: corners of the tile.
float soft_visibility(vec2 uv, vec2 low, vec2 high, float depth, float meters_per_depth, float per_meter, float angle) {
    const int BLOCKERS = 8;
    const int TAPS = 16;
    float turn = pixel_noise(gl_FragCoord.xy);
    // Blockers lie within the cone towards the light, up to the front of the model.
    float reach = clamp(angle * (1.0 - depth) * meters_per_depth * per_meter, 0.0, 0.1 * (high.x - low.x));
    vec2 blockers = vec2(0.0);
    for (int i = 0; i < BLOCKERS; ++i) {
        vec2 at = clamp(uv + reach * disk_sample(i, BLOCKERS, turn), low, high);
        float blocker = textureLod(shadow_map, at, 0.0).r;
        if (blocker > depth) blockers += vec2(blocker, 1.0);
    }
    if (blockers.y == 0.0) return 1.0;
    float apart_m = (blockers.x / blockers.y - depth) * meters_per_depth;
    float radius = max(min(angle * apart_m * per_meter, reach), 1.5 / SHADOW_MAP_PX);
    float lit = 0.0;
    for (int i = 0; i < TAPS; ++i) {
        vec2 at = clamp(uv + radius * disk_sample(i, TAPS, turn), low, high);
        lit += textureLod(shadow_map, at, 0.0).r <= depth ? 1.0 : 0.0;
    }
    return lit / float(TAPS);
}

// Part of light `i` that reaches a point with this normal, 0..1. The point is moved along the normal, by what a texel of the map
// spans on the surface, so that the surface does not hide itself. `l`: unit, towards the light.
float shadow_visibility(uint i, vec3 position_ws, vec3 n, vec3 l) {
    if (SHADOWS == NO_SHADOWS || i >= MAX_SHADOWS) return 1.0;
    Light light = lights[i];
    ShadowView view = shadow_view(light);
    vec3 seen = seen_from(view, position_ws);
    float tile_size = 1.0 / float(shadow_tiles());
    float texel_m = 2.0 * half_width_at(view, seen) / (tile_size * SHADOW_MAP_PX);
    float n_dot_l = dot(n, l);
    float slope = sqrt(saturate(1.0 - n_dot_l * n_dot_l));
    seen += (texel_m * (0.5 + 3.0 * slope) * sign(n_dot_l)) * (n * view.axes);
    vec2 in_tile = 0.5 + 0.5 * seen.xy / half_width_at(view, seen);
    if ((!view.is_parallel && seen.z <= 0.0) || clamp(in_tile, 0.0, 1.0) != in_tile) return 1.0;
    vec2 low = shadow_tile(i);
    vec2 uv = low + tile_size * in_tile;
    float depth = shadow_depth(view, seen) + 0.5 * texel_m / view.meters_per_depth;
    if (SHADOWS == SOFT_SHADOWS) {
        float to_light_m = view.is_parallel ? 1.0 : length(seen);
        float size_m = light.kind == LIGHT_RECT ? length(light.half_x_ws + light.half_y_ws) : shadow_softness * to_light_m;
        float per_meter = 0.5 * tile_size / half_width_at(view, seen);
        float angle = size_m / max(to_light_m, 1e-6);
        return soft_visibility(uv, low, low + tile_size, depth, view.meters_per_depth, per_meter, angle);
    }
    return hard_visibility(uv, depth);
}

#endif
