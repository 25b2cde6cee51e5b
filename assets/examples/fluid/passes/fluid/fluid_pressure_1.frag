//@pass fluid_pressure_1 "Fluid: pressure, steps 1 and 2" size=256x160 format=r32f doc="Pressure after 2 steps of Jacobi's method"
#version 460
uniform sampler2D before_fluid_pressure_4;
#define PRESSURE_BEFORE before_fluid_pressure_4
#include "passes/fluid/jacobi.glsl"

// Starts with the pressure of the frame before. It changes little in a frame, so eight steps are enough.

void main() { color = vec4(after_two_steps(ivec2(gl_FragCoord.xy)), 0.0, 0.0, 0.0); }
