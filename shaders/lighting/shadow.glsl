// Shadows of punctual and rectangular lights, by shadow maps (Williams 1978). passes/shadow_map.frag draws the map.
#ifndef LIGHTING_SHADOW_GLSL
#define LIGHTING_SHADOW_GLSL

#include "interface.glsl"
#include "common/math.glsl"
#include "common/sampling.glsl"
#include "lighting/shadow_view.glsl"
#include "user/params.glsl"

//@ui "Shadows"
layout(constant_id = USER_CONSTANTS + 10) const bool SHADOWS = false;

const uint HARD_SHADOWS = 0u;
const uint SOFT_SHADOWS = 1u;
//@ui "Shadow edges" choice Hard=0 Soft=1
layout(constant_id = USER_CONSTANTS + 11) const uint SHADOW_EDGES = HARD_SHADOWS;

// Depth of what is nearest to each light. 0: nothing, as where the pass is off.
uniform sampler2D shadow_map;

// Part of 4 x 4 texels that do not hide the point, weighted by a tent (percentage-closer filtering: Reeves, Salesin,
// Cook 1987). One gather reads 2 x 2 texels.
float lit_part(vec2 uv, float depth) {
    vec2 size = vec2(textureSize(shadow_map, 0));
    vec2 texel = uv * size - 0.5;
    vec2 corner = floor(texel);
    vec2 f = texel - corner;
    vec2 low = 1.0 - f;
    vec4 a = vec4(lessThanEqual(textureGather(shadow_map, corner / size), vec4(depth)));
    vec4 b = vec4(lessThanEqual(textureGather(shadow_map, (corner + vec2(2.0, 0.0)) / size), vec4(depth)));
    vec4 c = vec4(lessThanEqual(textureGather(shadow_map, (corner + vec2(0.0, 2.0)) / size), vec4(depth)));
    vec4 d = vec4(lessThanEqual(textureGather(shadow_map, (corner + vec2(2.0, 2.0)) / size), vec4(depth)));
    // A gather holds (0, 1), (1, 1), (1, 0), (0, 0). The weights of a row are 1 - f, 1, 1, f.
    float rows_a = low.y * (a.w * low.x + a.z) + a.x * low.x + a.y;
    float rows_b = low.y * (b.w + b.z * f.x) + b.x + b.y * f.x;
    float rows_c = c.w * low.x + c.z + f.y * (c.x * low.x + c.y);
    float rows_d = d.w + d.z * f.x + f.y * (d.x + d.y * f.x);
    return (rows_a + rows_b + rows_c + rows_d) / 9.0;
}

// Samples of a disk of radius 1, at equal distances along a spiral (Vogel 1979). `turn`: 0..1, another for each pixel.
vec2 disk_sample(int i, int count, float turn) {
    float angle = (float(i) * 0.381966 + turn) * 2.0 * PI;
    return sqrt((float(i) + 0.5) / float(count)) * vec2(cos(angle), sin(angle));
}

// Interleaved gradient noise, 0..1 (Jimenez 2014).
float pixel_noise(vec2 pixel) { return fract(52.9829189 * fract(dot(pixel, vec2(0.06711056, 0.00583715)))); }

// Part of the light that reaches the point, 0..1. Its edge is as wide as the light's penumbra: the wider, the farther the point
// is from what hides it (percentage-closer soft shadows, Fernando 2005). `angle`: width of the light / its distance.
float soft_visibility(vec2 uv, vec2 tile, float tile_size, ShadowPoint point, float angle) {
    const int BLOCKERS = 8;
    const int TAPS = 16;
    float turn = pixel_noise(gl_FragCoord.xy);
    float per_meter = tile_size / point.tile_m;
    vec2 low = tile;
    vec2 high = tile + tile_size;
    // What may hide the point lies within the cone towards the light, up to the front of the model.
    float reach = min(angle * (1.0 - point.depth) * point.meters_per_depth * per_meter, 0.1 * tile_size);
    vec2 blockers = vec2(0.0);
    for (int i = 0; i < BLOCKERS; ++i) {
        vec2 at = clamp(uv + reach * disk_sample(i, BLOCKERS, turn), low, high);
        float depth = textureLod(shadow_map, at, 0.0).r;
        if (depth > point.depth) blockers += vec2(depth, 1.0);
    }
    if (blockers.y == 0.0) return 1.0;
    float apart = (blockers.x / blockers.y - point.depth) * point.meters_per_depth;
    float radius = clamp(angle * apart * per_meter, 1.5 / float(textureSize(shadow_map, 0).x), reach);
    float lit = 0.0;
    for (int i = 0; i < TAPS; ++i) {
        vec2 at = clamp(uv + radius * disk_sample(i, TAPS, turn), low, high);
        lit += textureLod(shadow_map, at, 0.0).r <= point.depth ? 1.0 : 0.0;
    }
    return lit / float(TAPS);
}

// Part of light `i` that reaches a point with this normal, 0..1. Points are moved along the normal, by as much as a texel of
// the map spans on the surface, so that the surface does not hide itself. `l`: unit, towards the light.
float shadow_visibility(uint i, vec3 position_ws, vec3 n, vec3 l) {
    if (!SHADOWS || i >= MAX_SHADOWS) return 1.0;
    Light light = lights[i];
    float tile_size = 1.0 / float(shadow_tiles());
    float texel = 1.0 / (tile_size * float(textureSize(shadow_map, 0).x));
    float slope = sqrt(saturate(1.0 - dot(n, l) * dot(n, l)));
    float side = dot(n, l) < 0.0 ? -1.0 : 1.0;
    ShadowPoint here = shadow_point(light, position_ws);
    float offset_m = here.tile_m * texel * (0.5 + 3.0 * slope);
    ShadowPoint point = shadow_point(light, position_ws + offset_m * side * n);
    vec2 in_tile = 0.5 + 0.5 * point.clip.xy / point.clip.w;
    bool is_outside = point.clip.w <= 0.0 || any(lessThan(in_tile, vec2(0.0))) || any(greaterThan(in_tile, vec2(1.0)));
    if (is_outside) return 1.0;
    vec2 tile = shadow_tile(i);
    vec2 margin = vec2(2.0 * texel * tile_size);
    vec2 uv = clamp(tile + in_tile * tile_size, tile + margin, tile + tile_size - margin);
    point.depth += 0.5 * texel * point.tile_m / point.meters_per_depth;
    if (SHADOW_EDGES == SOFT_SHADOWS) {
        float to_light_m = light.position_ws.w == 0.0 ? 1.0 : distance(light.position_ws.xyz, position_ws);
        float size_m = light.kind == LIGHT_RECT ? length(light.half_x_ws + light.half_y_ws) : shadow_softness * to_light_m;
        return soft_visibility(uv, tile, tile_size, point, size_m / max(to_light_m, 1e-6));
    }
    return lit_part(uv, point.depth);
}

#endif
