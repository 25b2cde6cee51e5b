// Shadows of punctual and rectangular lights and of suns, by shadow maps (Williams 1978). passes/shadows/shadow_map.frag draws the map.
//
// Limits: a light sees the model from its middle, and the mean distance of what hides a point from there decides how wide the penumbra is,
// so penumbras that overlap are only about right. Soft shadows take 24 samples, whose noise shows in wide penumbras.
// Only the first MAX_LIGHT_VIEWS lights throw shadows.
#ifndef LIGHTING_SHADOW_GLSL
#define LIGHTING_SHADOW_GLSL

#include "interface.glsl"
#include "common/math.glsl"
#include "common/picture_px.glsl"
#include "common/sampling.glsl"
#include "lighting/shadows/light_view.glsl"
#include "lighting/shadows/tiles.glsl"
#include "user/params.glsl"

const uint NO_SHADOWS = 0u;
const uint HARD_SHADOWS = 1u;
const uint SOFT_SHADOWS = 2u;
//@ui "Shadows" choice Off=0 "Lamps shine through the model" Hard=1 "One shadow map for each lamp, with a sharp border (Williams 1978)" Soft=2 "A penumbra that grows with the distance from what casts it (Fernando 2005)" doc="Shadows of lamps: hard, or soft with a penumbra that grows with the distance (shadow maps; Fernando 2005)"
layout(constant_id = USER_CONSTANTS + 10) const uint SHADOWS = NO_SHADOWS;

// Reversed depth of what is nearest to each light. 0: nothing, as where the pass is off.
uniform sampler2D shadow_map;

// Part of 2 x 2 texels that do not hide the point, blended (percentage-closer filtering: Reeves, Salesin, Cook 1987).
float hard_visibility(vec2 uv, float depth) {
    vec2 texel = uv * SHADOW_MAP_PX - 0.5;
    vec2 corner = floor(texel);
    vec2 part = texel - corner;
    // A gather holds (0, 1), (1, 1), (1, 0), (0, 0), around a corner of four texels.
    vec4 lit = vec4(lessThanEqual(textureGather(shadow_map, (corner + 1.0) / SHADOW_MAP_PX), vec4(depth)));
    return mix(mix(lit.w, lit.z, part.x), mix(lit.x, lit.y, part.x), part.y);
}

// Samples of a disk of radius 1, at equal distances along a spiral (Vogel 1979). `turn`: 0..1, another for each pixel.
vec2 disk_sample(int i, int count, float turn) {
    float angle = (float(i) * 0.381966 + turn) * 2.0 * PI;
    return sqrt((float(i) + 0.5) / float(count)) * vec2(cos(angle), sin(angle));
}

// Interleaved gradient noise, 0..1 (Jimenez 2014).
float pixel_noise(vec2 pixel) { return fract(52.9829189 * fract(dot(pixel, vec2(0.06711056, 0.00583715)))); }

// Meters along a light's axis from its reversed depth, for differences. `view`: clip from world.
struct LightDepth {
    float scale;               // perspective: w of a point times (its depth - offset); parallel: meters from depth 1 to depth 0
    float offset;
};

LightDepth light_depth(mat4 view, bool is_parallel) {
    vec4 z = vec4(view[0].z, view[1].z, view[2].z, view[3].z);
    if (is_parallel) return LightDepth(inversesqrt(dot(z.xyz, z.xyz)), 0.0);
    vec4 w = vec4(view[0].w, view[1].w, view[2].w, view[3].w);
    float offset = dot(z.xyz, w.xyz);
    return LightDepth(z.w - offset * w.w, offset);
}

float along_axis_m(LightDepth of, bool is_parallel, float depth) {
    return is_parallel ? -depth * of.scale : of.scale / (depth - of.offset);
}

// Change of depth across the map on the plane through the point with this normal: depth per width of the map along u and v. A plane has
// depths that are linear in the map, in perspective too. `ndc`: the point in the light's view.
vec2 depth_slope(mat4 view, vec3 ndc, vec3 n, bool faces_light, float tile_size) {
    mat3 plane = basis_around(n);
    vec4 along_t = view * vec4(plane[0], 0.0);
    vec4 along_b = view * vec4(plane[1], 0.0);
    vec3 t = along_t.xyz - ndc * along_t.w;
    vec3 b = along_b.xyz - ndc * along_b.w;
    float area = t.x * b.y - t.y * b.x;
    // Clamps the slope at 87 degrees. A plane that faces away from the middle of a large light gets that slope too, since the light's
    // border still reaches it.
    float least = 0.05 * (dot(t.xy, t.xy) + dot(b.xy, b.xy));
    float sign_of_area = area < 0.0 ? -1.0 : 1.0;
    area = sign_of_area * (faces_light ? max(abs(area), least) : -least);
    return vec2(t.z * b.y - b.z * t.y, b.z * t.x - t.z * b.x) * (2.0 / (tile_size * area));
}

// Part of the light that reaches the point, 0..1. The edge of its shadow is as wide as the penumbra: the wider, the farther the
// point is from what hides it (percentage-closer soft shadows, Fernando 2005). `seen`: the point in the light's clip space.
// `low`, `high`: corners of the tile. `slope`: depth_slope(): the surface itself rises towards the light within the samples, and must not
// hide the point (receiver plane depth bias, Isidoro 2006). `per_meter`: of the map's width, at the point. `angle`: width of the light / its distance.
float soft_visibility(mat4 view, vec4 seen, vec2 uv, vec2 low, vec2 high, vec2 slope, float per_meter, float angle) {
    const int BLOCKERS = 8;
    const int TAPS = 16;
    float turn = pixel_noise(picture_px());
    float depth = max(seen.z / seen.w, 0.0);
    bool is_parallel = view[0].w == 0.0 && view[1].w == 0.0 && view[2].w == 0.0;
    LightDepth of = light_depth(view, is_parallel);
    float here_m = along_axis_m(of, is_parallel, seen.z / seen.w);
    // Blockers lie within the cone towards the light, up to the front of the model.
    float reach = clamp(angle * (here_m - along_axis_m(of, is_parallel, 1.0)) * per_meter, 0.0, 0.1 * (high.x - low.x));
    vec2 blockers = vec2(0.0);
    for (int i = 0; i < BLOCKERS; ++i) {
        vec2 at = clamp(uv + reach * disk_sample(i, BLOCKERS, turn), low, high);
        float blocker = textureLod(shadow_map, at, 0.0).r;
        if (blocker > depth + max(dot(slope, at - uv), 0.0)) blockers += vec2(along_axis_m(of, is_parallel, blocker), 1.0);
    }
    if (blockers.y == 0.0) return 1.0;
    float apart_m = here_m - blockers.x / blockers.y;
    float radius = max(min(angle * apart_m * per_meter, reach), 1.5 / SHADOW_MAP_PX);
    float lit = 0.0;
    for (int i = 0; i < TAPS; ++i) {
        vec2 at = clamp(uv + radius * disk_sample(i, TAPS, turn), low, high);
        lit += textureLod(shadow_map, at, 0.0).r <= depth + max(dot(slope, at - uv), 0.0) ? 1.0 : 0.0;
    }
    return lit / float(TAPS);
}

// Part of light `i` that reaches a point of a surface with the geometric normal n, 0..1; suns follow the lights. The point is moved
// along the normal and towards the light, by what a texel of the map spans on the surface, so that the surface does not hide itself.
// The map holds the mesh without normal textures, so a shading normal would offset the point wrongly. `l`: unit, towards the light.
float shadow_visibility(uint i, vec3 position_ws, vec3 n, vec3 l) {
    if (SHADOWS == NO_SHADOWS || i >= MAX_LIGHT_VIEWS) return 1.0;
    Light light = shadow_light(i);
    mat4 view = light_view(i, light);
    vec4 x_axis = vec4(view[0].x, view[1].x, view[2].x, view[3].x);
    vec4 w_axis = vec4(view[0].w, view[1].w, view[2].w, view[3].w);
    float tile_size = 1.0 / float(shadow_tiles());
    // Widths of the map to a meter, where w is 1.
    float per_meter = 0.5 * tile_size * length(x_axis.xyz);
    float texel_m = dot(w_axis, vec4(position_ws, 1.0)) / (per_meter * SHADOW_MAP_PX);
    // The offset along the normal must be at least 1.5 texels times the sine of the angle to the light. 0.5 + 3 sin^2 is, at every angle,
    // and needs no root.
    float n_dot_l = dot(n, l);
    float sin2 = 1.0 - n_dot_l * n_dot_l;
    // Light from behind has passed through the surface, but that of a large light may come from its border.
    float side = n_dot_l < 0.0 && light.kind != LIGHT_RECT ? -1.0 : 1.0;
    position_ws += texel_m * ((0.5 + 3.0 * sin2) * side * n + 0.5 * l);
    vec4 seen = view * vec4(position_ws, 1.0);
    if (seen.w <= 0.0 || any(greaterThan(abs(seen.xy), vec2(seen.w)))) return 1.0;
    vec3 light_ndc = seen.xyz / vec3(seen.w);
    vec2 low = shadow_tile(i);
    vec2 uv = (low + 0.5 * tile_size) + 0.5 * tile_size * light_ndc.xy;
    if (SHADOWS == SOFT_SHADOWS) {
        bool is_distant = light.position_ws.w == 0.0;
        vec3 to_light_ws = is_distant ? l : light.position_ws.xyz - position_ws;
        float to_light_m = length(to_light_ws);
        float size_m = light.kind == LIGHT_RECT ? length(light.half_x_ws + light.half_y_ws) : shadow_softness * to_light_m;
        float angle = size_m / max(to_light_m, 1e-6);
        // The radius of a disk is twice the root of its variance along one axis.
        if (SUN_COUNT != 0u && i >= frame.light_count) angle = 2.0 * sqrt(frame.sun_variance[i - frame.light_count]);
        vec2 slope = depth_slope(view, light_ndc, n, side * dot(n, to_light_ws) > 0.0, tile_size);
        return soft_visibility(view, seen, uv, low, low + tile_size, slope, per_meter / seen.w, angle);
    }
    // Points behind the model's bounds have a depth below 0.
    return hard_visibility(uv, max(light_ndc.z, 0.0));
}

#endif
