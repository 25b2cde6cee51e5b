//@pass deferred_light "Deferred: lighting" doc="Radiance of the surfaces in the G-buffer, in cd/m^2; alpha is 1 where there is one"
#version 460
#include "pass.glsl"
#include "brdf/energy/multiscatter.glsl"
#include "brdf/evaluate.glsl"
#include "brdf/fresnel.glsl"
#include "common/math.glsl"
#include "lighting/albedo.glsl"
#include "lighting/image_based.glsl"
#include "lighting/punctual.glsl"
#include "lighting/rectangle.glsl"
#include "lighting/shadows/shadow.glsl"
#include "user.glsl"

// Deferred shading (Deering et al. 1988, "The Triangle Processor and Normal Vector Shader"; Saito & Takahashi 1990,
// "Comprehensible Rendering of 3-D Shapes"): the model is drawn to images of its material first, then each pixel is lit once,
// however many surfaces lie behind it. The light is that of lighting/shade.glsl.
//
// Limits: half floats round the normal to 0.0005, so sharp reflections shift by as much. Derivatives of the model are gone.

uniform sampler2D gbuffer;
uniform sampler2D gbuffer_normal;
uniform sampler2D gbuffer_emission;
uniform sampler2D gbuffer_distance;

// The surface at this pixel. `direction`: unit, from the eye through the pixel.
Surface surface_at(ivec2 pixel, vec3 direction) {
    vec4 base = texelFetch(gbuffer, pixel, 0);
    vec4 normal = texelFetch(gbuffer_normal, pixel, 0);
    vec4 emission = texelFetch(gbuffer_emission, pixel, 0);
    vec2 place = texelFetch(gbuffer_distance, pixel, 0).rg;
    Surface s;
    s.position_ws = frame.eye_ws + place.x * direction;
    s.n = normalize(normal.xyz);
    s.base_color = base.rgb;
    s.coverage = 1.0;
    s.metallic = base.a;
    s.roughness = normal.a;
    s.occlusion = emission.a;
    s.emissive = emission.rgb;
    s.ior = place.y;
    s.f0 = vec3(f0_from_ior(s.ior));
    s.f90 = 1.0;
    clear_extensions(s);
    complete_surface(s, -direction);
    return s;
}

// Radiance towards the eye by light `i`.
vec3 radiance_by_light(uint i, Surface s, vec3 v, Albedo albedo) {
    Light light = light_at(i, s.position_ws);
    if ((FEATURES & FEATURE_RECT_LIGHTS) != 0u && light.kind == LIGHT_RECT) {
        vec3 to_center = safe_normalize(light.position_ws.xyz - s.position_ws, s.n);
        return rectangle_light(s, v, albedo, light).all * shadow_visibility(i, s.position_ws, s.n, to_center);
    }
    Illumination from = illuminate(light, s.position_ws);
    float n_dot_l = dot(s.n, from.l);
    if (n_dot_l <= 0.0) return vec3(0.0);
    float visible = shadow_visibility(i, s.position_ws, s.n, from.l);
    return evaluate_brdf(s, from.l, v).value * from.irradiance * (n_dot_l * visible);
}

void main() {
    color = vec4(0.0);
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    if (texelFetch(gbuffer_normal, pixel, 0).xyz == vec3(0.0)) return;
    vec4 far = frame.world_from_clip * vec4(2.0 * uv - 1.0, 0.0, 1.0);
    vec3 direction = normalize(far.xyz - far.w * frame.eye_ws);
    Surface s = surface_at(pixel, direction);
    s.occlusion *= screen_visibility(-(frame.view_from_world * vec4(s.position_ws, 1.0)).z);
    Albedo albedo = directional_albedo(s, -direction);
    vec3 radiance = s.emissive + with_sum(environment_light(s, -direction, albedo)).all;
    for (uint i = 0u; i < min(frame.light_count, uint(MAX_LIGHTS)); ++i) radiance += radiance_by_light(i, s, -direction, albedo);
    color = vec4(user_radiance(s, -direction, radiance), 1.0);
}
