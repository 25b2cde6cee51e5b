//@pass occlusion_raw "Ambient occlusion: horizons" size=1/2 format=r32f when=AMBIENT_OCCLUSION doc="Hidden part of the sky in each pixel, with noise"
#version 460
#include "pass.glsl"
#include "common/math.glsl"
#include "lighting/shadows/occlusion_texel.glsl"

// Ambient occlusion from the horizons around a pixel (Jimenez, Wu, Pesce & Jarabo 2016, "Practical Real-Time Strategies for
// Accurate Indirect Occlusion"). Limits: it sees only the nearest surface of each pixel, and
// treats everything as infinitely thick.
//
// pack_occlusion() of the hidden part of the cosine-weighted hemisphere, 0 open .. 1 hidden in the mean over the directions; 0 where
// there is nothing.

uniform sampler2D geometry;

uniform OcclusionRaw {
    float occlusion_radius;    //@ui "Occlusion radius" 0.02..2 = 0.5
};

const int SLICES = 1;
const int STEPS = 3;

// Half the picture's width and height at 1 m: a row of the projection divides by it.
vec2 half_size_at_1m() {
    mat4 m = frame.clip_from_world;
    vec3 x = vec3(m[0].x, m[1].x, m[2].x);
    vec3 y = vec3(m[0].y, m[1].y, m[2].y);
    return inversesqrt(vec2(dot(x, x), dot(y, y)));
}

// The point of the picture at `at`, 0..1 from the upper left corner. View space, meters: x right, y up, the camera looks along -z.
vec3 point_at(vec2 half_size, vec2 at, float distance_m) {
    return distance_m * vec3((2.0 * at - 1.0) * vec2(half_size.x, -half_size.y), -1.0);
}

// From the point to the neighbor on the side where the surface goes on: where the distance changes less. `before`, `after`: distances
// of the neighbors, 0 where there is nothing. View space, meters.
vec3 along(vec2 half_size, vec3 position, vec2 step, float before, float after) {
    float here_m = -position.z;
    bool is_after = after > 0.0 && (before <= 0.0 || abs(after - here_m) < abs(before - here_m));
    float near_m = is_after ? after : before;
    float sign_of = is_after ? 1.0 : -1.0;
    // Without a neighbor the surface faces the eye.
    return sign_of * (point_at(half_size, uv + sign_of * step, near_m > 0.0 ? near_m : here_m) - position);
}

// Normal of the surface without normal maps, view space, unit: what hides the sky is the geometry. Points and lines face the eye.
// Distances around the pixel at (0, 0): `before` at (-1, 0), (0, 0), (0, -1), (-1, -1); `after` at (0, 1), (1, 1), (1, 0), (0, 0).
vec3 normal_at(vec2 half_size, vec3 position, vec4 before, vec4 after) {
    // Beyond the border there is nothing.
    vec2 pixel = floor(gl_FragCoord.xy);
    vec2 has_before = vec2(greaterThan(pixel, vec2(0.0)));
    vec2 has_after = vec2(lessThan(pixel + 1.0, pass.size_px));
    vec3 x = along(half_size, position, vec2(1.0 / pass.size_px.x, 0.0), before.x * has_before.x, after.z * has_after.x);
    vec3 y = along(half_size, position, vec2(0.0, 1.0 / pass.size_px.y), before.z * has_before.y, after.x * has_after.y);
    return safe_normalize(cross(y, x), safe_normalize(-position, vec3(0.0, 0.0, 1.0)));
}

// Cosine of the angle between `v` and the surface that the picture shows at `at`. From half the radius to the radius it fades to -1: beyond,
// nothing hides.
float horizon_cosine(vec2 at, vec2 half_size, vec3 position, vec3 v, float radius_m) {
    vec2 place = clamp(at, 0.0, 1.0) * (pass.size_px - 1.0) + 0.5;
    float distance_m = texelFetch(geometry, ivec2(place), 0).r;
    vec3 to = point_at(half_size, at, distance_m) - position;
    float per_m = inversesqrt(max(dot(to, to), 1e-12));
    float near = distance_m > 0.0 ? saturate(2.0 - 2.0 / (per_m * radius_m)) : 0.0;
    return mix(-1.0, dot(to, v) * per_m, near);
}

void main() {
    // A gather holds (0, 1), (1, 1), (1, 0), (0, 0), around a corner of four texels.
    vec4 before = textureGather(geometry, uv - 0.5 / pass.size_px);
    float here_m = before.y;
    color = vec4(0.0);
    if (here_m <= 0.0) return;

    vec2 half_size = half_size_at_1m();
    vec3 position = point_at(half_size, uv, here_m);
    vec3 v = normalize(-position);
    vec3 n = normal_at(half_size, position, before, textureGather(geometry, uv + 0.5 / pass.size_px));
    float radius_m = occlusion_radius * frame.scene_radius;
    // Radius in the image, 0..1 of its height.
    float radius = min(radius_m / (2.0 * here_m * half_size.y), 0.5);
    vec2 scale = vec2(pass.size_px.y / pass.size_px.x, 1.0) * radius;

    // Each pixel of a pattern of 4 x 4 has a direction of its own. The next pass averages them.
    ivec2 pixel = ivec2(gl_FragCoord.xy) & 3;
    float turn = float(4 * ((pixel.x + 2 * pixel.y) & 3) + pixel.y) / 16.0;
    float shift = (float((pixel.x ^ pixel.y) & 3) + 0.5) / 4.0;

    float open = 0.0;
    for (int slice = 0; slice < SLICES; ++slice) {
        float angle = PI * (float(slice) + turn) / float(SLICES);
        vec2 direction = vec2(cos(angle), sin(angle));
        // The slice is the plane of v and the direction. The normal is projected into it; gamma is its angle from v.
        vec3 axis = normalize(cross(vec3(direction.x, -direction.y, 0.0), v));
        vec3 tangent = cross(v, axis);
        vec2 projected = vec2(dot(n, v), dot(n, tangent));
        float weight = length(projected);
        float cos_gamma = projected.x / max(weight, 1e-6);
        float sin_gamma = projected.y / max(weight, 1e-6);
        // Cosines of the horizons' angles from v, on both sides. They stay within the hemisphere around the normal.
        vec2 horizons = vec2(sin_gamma, -sin_gamma);
        // Pixels without a surface take no step, which a software device would compute all the same.
        int steps = here_m > 0.0 ? STEPS : 0;
        for (int i = 0; i < steps; ++i) {
            float part = (float(i) + shift) / float(STEPS);
            // Not nearer than the neighboring pixel.
            vec2 offset = direction * scale * part * part + direction / pass.size_px;
            float first = horizon_cosine(uv - offset, half_size, position, v, radius_m);
            horizons = max(horizons, vec2(first, horizon_cosine(uv + offset, half_size, position, v, radius_m)));
        }
        horizons = min(horizons, 1.0);
        // Integral of max(cos(angle - gamma), 0) |sin(angle)| between the horizons h (eq. 7 there): for each,
        // (cos(gamma) + 2 h sin(gamma) - cos(2 h - gamma)) / 4, where the first side's h is negative.
        vec2 h = acos(horizons);
        vec2 sine = sqrt(1.0 - horizons * horizons);
        vec2 cos_2h = 2.0 * horizons * horizons - 1.0;
        float across = sin_gamma * (2.0 * (h.y - h.x) - 2.0 * (sine.y * horizons.y - sine.x * horizons.x));
        open += weight * 0.25 * (cos_gamma * (2.0 - cos_2h.x - cos_2h.y) + across);
    }
    // One direction alone may be above 1; the mean over all directions of an open point is 1.
    color.r = pack_occlusion(1.0 - open / float(SLICES), here_m / frame.scene_radius);
}
