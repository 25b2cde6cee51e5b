// The surface that the G-buffer holds at a pixel.
#ifndef PASSES_DEFERRED_GLSL
#define PASSES_DEFERRED_GLSL

#include "brdf/energy/multiscatter.glsl"
#include "brdf/fresnel.glsl"
#include "common/math.glsl"
#include "ibl/maps/octahedral.glsl"
#include "lighting/shadows/ambient_occlusion.glsl"

uniform sampler2D gbuffer;
uniform sampler2D gbuffer_normal;
uniform sampler2D gbuffer_emission;
uniform sampler2D gbuffer_distance;

// Whether the G-buffer holds a surface at this pixel.
bool has_surface(ivec2 pixel) { return texelFetch(gbuffer_normal, pixel, 0).xyz != vec3(0.0); }

// Unit, from the eye through `uv`, 0..1 in the picture.
vec3 view_direction(vec2 uv) {
    vec4 far = frame.world_from_clip * vec4(2.0 * uv - 1.0, 0.0, 1.0);
    return normalize(far.xyz - far.w * frame.eye_ws);
}

// The surface at this pixel. `direction`: view_direction() of the pixel.
Surface surface_at(ivec2 pixel, vec3 direction) {
    vec4 base = texelFetch(gbuffer, pixel, 0);
    vec4 normal = texelFetch(gbuffer_normal, pixel, 0);
    vec4 emission = texelFetch(gbuffer_emission, pixel, 0);
    vec4 place = texelFetch(gbuffer_distance, pixel, 0);
    Surface s;
    s.position_ws = frame.eye_ws + place.x * direction;
    s.n = normalize(normal.xyz);
    s.ng = octahedral_direction(place.zw);
    s.base_color = base.rgb;
    s.coverage = 1.0;
    s.metallic = base.a;
    s.roughness = normal.a;
    s.emissive = emission.rgb;
    s.ior = place.y;
    s.f0 = vec3(f0_from_ior(s.ior));
    s.f90 = 1.0;
    clear_extensions(s);
    complete_surface(s, -direction);
    s.occlusion = emission.a * screen_visibility(-(frame.view_from_world * vec4(s.position_ws, 1.0)).z);
    return s;
}

#endif
