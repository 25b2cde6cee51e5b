//@pass deferred_environment "Deferred: environment" doc="Light of the environment that the surfaces in the G-buffer reflect, cd/m^2"
#version 460
#include "pass.glsl"
#include "lighting/albedo.glsl"
#include "lighting/image_based.glsl"
#include "passes/deferred.glsl"

void main() {
    color = vec4(0.0);
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    if (!has_surface(pixel)) return;
    vec3 direction = view_direction(uv);
    Surface s = surface_at(pixel, direction);
    Albedo albedo = directional_albedo(s, -direction);
    color = vec4(with_sum(environment_light(s, -direction, albedo)).all, 1.0);
}
