//@pass occlusion_raw "Ambient occlusion: horizons" size=1/2 format=rg32f when=AMBIENT_OCCLUSION doc="Hidden part of the sky in each pixel, with noise"
#version 460
#include "pass.glsl"
#include "common/math.glsl"

// Ambient occlusion from the horizons around a pixel (Jimenez, Wu, Pesce & Jarabo 2016, "Practical Real-Time Strategies for
// Accurate Indirect Occlusion"). Limits: it knows only what the camera sees, and takes everything for as thick as it looks.
//
// r: hidden part of the cosine-weighted hemisphere, 0 open .. 1 hidden in the mean over the directions. g: distance, as in `geometry`.

uniform sampler2D geometry;

uniform OcclusionRaw {
    float occlusion_radius;    //@ui "Occlusion radius" 0.02..2 = 0.5
};

const int SLICES = 1;
const int STEPS = 3;

// Rays through the picture: the point at clip-space xy and this distance is eye + distance (center + x right + y down).
struct Rays {
    vec3 center;
    vec3 right;
    vec3 down;
};

vec3 at_near(vec2 clip) {
    vec4 point = frame.world_from_clip * vec4(clip, 1.0, 1.0);
    return (point.xyz / point.w - frame.eye_ws) / frame.near;
}

Rays rays() {
    vec3 center = at_near(vec2(0.0));
    return Rays(center, at_near(vec2(1.0, 0.0)) - center, at_near(vec2(0.0, 1.0)) - center);
}

// Point from the eye, meters.
vec3 point_at(Rays rays, vec2 at, float distance_m) {
    vec2 clip = 2.0 * at - 1.0;
    return distance_m * (rays.center + clip.x * rays.right + clip.y * rays.down);
}

// Integral of max(cos(angle - n), 0) |sin(angle)| from the view direction to the horizon, times 4 (eq. 7 there).
float arc(float horizon, float n) { return -cos(2.0 * horizon - n) + cos(n) + 2.0 * horizon * sin(n); }

void main() {
    vec4 here = texelFetch(geometry, ivec2(gl_FragCoord.xy), 0);
    color = vec4(0.0, here.a, 0.0, 0.0);
    if (here.a <= 0.0) return;

    Rays rays = rays();
    vec3 position = point_at(rays, uv, here.a);
    vec3 v = normalize(-position);
    // Points and lines have no normal.
    vec3 n = dot(here.xyz, here.xyz) > 0.0 ? here.xyz : v;
    float radius_m = occlusion_radius * frame.scene_radius;
    // Radius in the image, 0..1 of its height.
    float radius = min(radius_m / (2.0 * here.a * length(rays.down)), 0.5);
    vec2 scale = vec2(pass.size_px.y / pass.size_px.x, 1.0) * radius;

    // Each pixel of a pattern of 4 x 4 has a direction of its own. The next pass averages them.
    ivec2 pixel = ivec2(gl_FragCoord.xy) & 3;
    float turn = float(4 * ((pixel.x + 2 * pixel.y) & 3) + pixel.y) / 16.0;
    float shift = (float((pixel.x ^ pixel.y) & 3) + 0.5) / 4.0;

    float open = 0.0;
    for (int slice = 0; slice < SLICES; ++slice) {
        float angle = PI * (float(slice) + turn) / float(SLICES);
        vec2 direction = vec2(cos(angle), sin(angle));
        vec3 along = normalize(direction.x * rays.right / length(rays.right) + direction.y * rays.down / length(rays.down));
        // The slice is the plane of v and `along`. The normal is projected into it.
        vec3 axis = normalize(cross(along, v));
        vec3 tangent = cross(v, axis);
        vec3 projected = n - dot(n, axis) * axis;
        float weight = length(projected);
        float gamma = atan(dot(projected, tangent), dot(projected, v));
        vec2 horizons = vec2(-1.0);
        for (int i = 0; i < STEPS; ++i) {
            float part = (float(i) + shift) / float(STEPS);
            vec2 offset = direction * scale * part * part;
            // Not nearer than the neighboring pixel.
            offset += sign(direction) * min(abs(direction), 1.0) / pass.size_px;
            for (int side = 0; side < 2; ++side) {
                vec2 at = uv + (side == 0 ? -offset : offset);
                vec2 place = clamp(at, 0.0, 1.0) * (pass.size_px - 1.0) + 0.5;
                float distance_m = texelFetch(geometry, ivec2(place), 0).a;
                if (distance_m <= 0.0) continue;
                vec3 to = point_at(rays, at, distance_m) - position;
                float length_m = length(to);
                float cosine = dot(to, v) / max(length_m, 1e-6);
                // Beyond the radius nothing hides; between, it fades.
                cosine = mix(-1.0, cosine, saturate(2.0 - 2.0 * length_m / radius_m));
                horizons[side] = max(horizons[side], cosine);
            }
        }
        horizons = clamp(horizons, -1.0, 1.0);
        // Angles from v: negative on the first side. They stay within the hemisphere around the normal.
        float low = gamma + max(-acos(horizons.x) - gamma, -0.5 * PI);
        float high = gamma + min(acos(horizons.y) - gamma, 0.5 * PI);
        open += weight * 0.25 * (arc(low, gamma) + arc(high, gamma));
    }
    // One direction alone may be above 1; the mean over all directions of an open point is 1.
    color.r = 1.0 - open / float(SLICES);
}
