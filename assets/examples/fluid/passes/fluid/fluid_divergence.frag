//@pass fluid_divergence "Fluid: divergence" size=256x160 format=r16f doc="Divergence of the velocity, 1/s: what flows out of each texel"
#version 460
#include "pass.glsl"

// div u = du/dx + dv/dy, by central differences (Stam 1999). Limit: they do not see a pattern that alternates from texel to texel.

uniform sampler2D fluid_advected;

vec2 velocity_at(ivec2 at) { return texelFetch(fluid_advected, clamp(at, ivec2(0), ivec2(pass.size_px) - 1), 0).xy; }

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    float x = velocity_at(at + ivec2(1, 0)).x - velocity_at(at - ivec2(1, 0)).x;
    float y = velocity_at(at + ivec2(0, 1)).y - velocity_at(at - ivec2(0, 1)).y;
    color = vec4(0.5 * (x + y), 0.0, 0.0, 0.0);
}
