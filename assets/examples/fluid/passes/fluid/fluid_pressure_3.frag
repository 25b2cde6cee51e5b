//@pass fluid_pressure_3 "Fluid: pressure, steps 5 and 6" size=256x160 format=r32f doc="Pressure after 6 steps of Jacobi's method"
#version 460
uniform sampler2D fluid_pressure_2;
#define PRESSURE_BEFORE fluid_pressure_2
#include "passes/fluid/jacobi.glsl"

// Continues from the pass before it.

void main() { color = vec4(after_two_steps(ivec2(gl_FragCoord.xy)), 0.0, 0.0, 0.0); }
