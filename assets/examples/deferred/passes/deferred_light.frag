//@pass deferred_light "Deferred: light" doc="Radiance of the surfaces in the G-buffer, in cd/m^2; alpha is 1 where there is one"
#version 460
#include "pass.glsl"
#include "passes/deferred.glsl"
#include "user.glsl"

// Deferred shading (Deering et al. 1988, "The Triangle Processor and Normal Vector Shader"; Saito & Takahashi 1990,
// "Comprehensible Rendering of 3-D Shapes"): the model is drawn to images of its material first, then each pixel is lit once,
// however many surfaces lie behind it. The light is that of lighting/shade.glsl. Six passes: gbuffer, deferred_environment,
// deferred_lamps, this sum of all light, deferred, deferred_corners.
//
// Limits: half floats round the normal to 0.0005, so sharp reflections shift by as much. Derivatives of the model are gone.

uniform sampler2D deferred_environment;
uniform sampler2D deferred_lamps;

void main() {
    color = vec4(0.0);
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    if (!has_surface(pixel)) return;
    vec3 direction = view_direction(uv);
    Surface s = surface_at(pixel, direction);
    vec3 reflected = texelFetch(deferred_environment, pixel, 0).rgb + texelFetch(deferred_lamps, pixel, 0).rgb;
    color = vec4(user_radiance(s, -direction, s.emissive + reflected), 1.0);
}
