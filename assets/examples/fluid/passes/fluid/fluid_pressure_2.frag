//@pass fluid_pressure_2 "Fluid: pressure, steps 3 and 4" size=256x160 format=r32f doc="Pressure after 4 steps of Jacobi's method"
#version 460
uniform sampler2D fluid_pressure_1;
#define PRESSURE_BEFORE fluid_pressure_1
#include "passes/fluid/jacobi.glsl"

// Continues from the pass before it.

void main() { color = vec4(after_two_steps(ivec2(gl_FragCoord.xy)), 0.0, 0.0, 0.0); }
