//@pass raymarch "Ray marching" to=picture doc="Spheres that flow together, seen by the same camera as the model"
#version 460
#include "pass.glsl"
#include "common/math.glsl"
#include "lighting/environment.glsl"

// A distance field drawn by sphere tracing (Hart 1996, "Sphere Tracing"): a ray may always go as far as the nearest surface is
// away. It is lit by the environment, and hides the model or is hidden by it.

uniform sampler2D picture;
uniform sampler2D depth;

uniform Raymarch {
    float raymarch_blend;      //@ui "Blend" 0.01..1 = 0.35
    vec3 raymarch_color;       //@ui "Field color" color = 0.9 0.3 0.1
};

// Union with a smooth seam of width k (Quilez, "Smooth minimum", the quadratic one).
float smooth_min(float a, float b, float k) {
    float h = max(k - abs(a - b), 0.0) / k;
    return min(a, b) - 0.25 * h * h * k;
}

// Distance to the field, in units of the model's radius.
float field(vec3 p) {
    float d = 1e9;
    for (int i = 0; i < 5; ++i) {
        float angle = 2.0 * PI * float(i) / 5.0 + 0.5 * frame.time_s;
        vec3 center = vec3(1.1 * cos(angle), 0.3 * sin(3.0 * angle + frame.time_s), 1.1 * sin(angle));
        d = smooth_min(d, length(p - center) - 0.22, raymarch_blend);
    }
    return d;
}

vec3 normal_of(vec3 p) {
    const vec2 e = vec2(1e-3, -1e-3);
    return normalize(e.xyy * field(p + e.xyy) + e.yyx * field(p + e.yyx) + e.yxy * field(p + e.yxy) + e.xxx * field(p + e.xxx));
}

void main() {
    color = texelFetch(picture, ivec2(gl_FragCoord.xy), 0);
    vec4 far = frame.world_from_clip * vec4(2.0 * uv - 1.0, 0.0, 1.0);
    vec3 direction = normalize(far.xyz - far.w * frame.eye_ws);
    vec3 eye = (frame.eye_ws - frame.scene_center_ws) / frame.scene_radius;
    float t = max(length(eye) - 2.0, 0.0);
    float d = 1.0;
    for (int i = 0; i < 64 && d > 1e-3 && t < length(eye) + 2.0; ++i) {
        d = field(eye + t * direction);
        t += d;
    }
    if (d > 2e-3) return;
    vec3 p = eye + t * direction;
    vec4 clip = frame.clip_from_world * vec4(frame.scene_center_ws + frame.scene_radius * p, 1.0);
    if (texelFetch(depth, ivec2(gl_FragCoord.xy), 0).r > clip.z / clip.w) return;
    vec3 n = normal_of(p);
    float fresnel = 0.04 + 0.96 * pow(1.0 - saturate(dot(n, -direction)), 5.0);
    vec3 radiance = raymarch_color * irradiance_over_pi(n) + fresnel * prefiltered_radiance(reflect(direction, n), 0.2);
    color = vec4(radiance, 1.0);
}
