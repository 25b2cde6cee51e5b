//@pass fluid "Fluid" to=picture after=tonemap doc="Dye in a fluid that flows around the model; the mouse stirs it"
#version 460
#include "pass.glsl"
#include "common/color.glsl"
#include "passes/fluid/fluid.glsl"

// A fluid without viscosity (Stam 1999, "Stable Fluids"). Each frame is one step:
//
//   fluid_advected     the velocity carries itself, and forces act: emitters, mouse, vorticity confinement
//   fluid_divergence   what flows out of each texel
//   fluid_pressure_*   the pressure that balances it, by Jacobi's method
//   fluid_velocity     without the gradient of the pressure: free of divergence
//   fluid_dye          dye, carried by the velocity
//
// The dye is behind the model, as light that adds to the background. Limits: the fluid is flat, and its cells are square only in a
// picture of 16:10; the model is an obstacle with the outline that the camera sees.

uniform sampler2D picture;
uniform sampler2D depth;
uniform sampler2D fluid_dye;

void main() {
    vec4 scene = texelFetch(picture, ivec2(gl_FragCoord.xy), 0);
    color = scene;
    if (texelFetch(depth, ivec2(gl_FragCoord.xy), 0).r > 0.0) return;
    vec3 light = 1.0 - exp(-fluid_strength * texture(fluid_dye, uv).rgb);
    // Screen: neither the background nor the dye darkens the other.
    vec3 shown = 1.0 - (1.0 - linear_from_srgb(scene.rgb)) * (1.0 - light);
    color = vec4(srgb_from_linear(shown), max(scene.a, max(light.r, max(light.g, light.b))));
}
