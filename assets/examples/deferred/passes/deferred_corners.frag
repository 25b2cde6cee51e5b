//@pass deferred_corners "Deferred: corners" to=picture after=deferred doc="The images of the G-buffer in the corners of the picture"
#version 460
#include "pass.glsl"
#include "common/color.glsl"
#include "common/math.glsl"

uniform sampler2D picture;
uniform sampler2D gbuffer;
uniform sampler2D gbuffer_normal;
uniform sampler2D gbuffer_emission;
uniform sampler2D gbuffer_distance;

uniform DeferredCorners {
    float deferred_views;      //@ui "G-buffer in the corners, part of the picture" 0..0.5 = 0.28
};

// Color of the view in a corner at `at`, 0..1 across the view, linear RGB. Upper left: base color; upper right: normal; lower
// left: occlusion, roughness and metallic as red, green and blue; lower right: distance, white at the front of the model's bounds
// and black a third of their radius behind the center.
vec3 view_at(bvec2 corner, vec2 at) {
    vec4 normal = textureLod(gbuffer_normal, at, 0.0);
    vec4 base = textureLod(gbuffer, at, 0.0);
    if (normal.xyz == vec3(0.0)) return vec3(0.01);
    if (!corner.x && !corner.y) return base.rgb;
    if (!corner.y) return linear_from_srgb(0.5 + 0.5 * normal.xyz);
    if (!corner.x) return linear_from_srgb(vec3(textureLod(gbuffer_emission, at, 0.0).a, normal.a, base.a));
    float to_center = distance(frame.eye_ws, frame.scene_center_ws);
    float beyond = (textureLod(gbuffer_distance, at, 0.0).r - to_center) / frame.scene_radius;
    return linear_from_srgb(vec3(0.25 - 0.75 * beyond));
}

void main() {
    color = texelFetch(picture, ivec2(gl_FragCoord.xy), 0);
    bvec2 corner = greaterThan(uv, vec2(0.5));
    vec2 from_corner = mix(uv, 1.0 - uv, vec2(corner));
    if (all(lessThan(from_corner, vec2(deferred_views)))) {
        vec2 at = mix(uv, uv - (1.0 - deferred_views), vec2(corner)) / deferred_views;
        // Divided by the exposure, so that the tone map gets the view's own values.
        color = vec4(saturate(view_at(corner, at)) / frame.exposure, 1.0);
    }
}
