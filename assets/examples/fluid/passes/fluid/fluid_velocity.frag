//@pass fluid_velocity "Fluid: velocity" size=256x160 format=rg16f keep doc="Velocity of the fluid, nearly free of divergence, in texels per second"
#version 460
#include "pass.glsl"

// Projects the velocity onto fields without divergence (Stam 1999, step 4; Chorin 1968): u = u* - grad p.
//
// Limits: eight Jacobi steps leave some divergence, mostly at long wavelengths. The model stops the fluid, but the pressure ignores
// it, so some fluid seeps through.

uniform sampler2D fluid_advected;
uniform sampler2D fluid_pressure_4;

float pressure_at(ivec2 at) { return texelFetch(fluid_pressure_4, clamp(at, ivec2(0), ivec2(pass.size_px) - 1), 0).r; }

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    float x = pressure_at(at + ivec2(1, 0)) - pressure_at(at - ivec2(1, 0));
    float y = pressure_at(at + ivec2(0, 1)) - pressure_at(at - ivec2(0, 1));
    color = vec4(texelFetch(fluid_advected, at, 0).xy - 0.5 * vec2(x, y), 0.0, 0.0);
}
