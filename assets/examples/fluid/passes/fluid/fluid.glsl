// Shared by the passes of the fluid: sliders, the time step, and the two emitters.
//
// The fluid fills the picture. Velocities are in texels of the velocity image a second: x to the right, y down.
#ifndef PASSES_FLUID_GLSL
#define PASSES_FLUID_GLSL

#include "interface.glsl"

uniform Fluid {
    float fluid_speed;         //@ui "Speed of the emitters, texels per second" 0..300 = 150
    float fluid_swirl;         //@ui "Vorticity confinement" 0..20 = 6
    float fluid_fade;          //@ui "Part of the dye that fades in a second" 0..1 = 0.2
    float fluid_strength;      //@ui "Strength of the dye" 0..3 = 1.2
};

// Size of the velocity image, texels.
const vec2 FLUID_SIZE = vec2(256.0, 160.0);

// Seconds of a step. A longer frame would move the fluid too far at once.
float fluid_step_s() { return min(frame.delta_s, 1.0 / 20.0); }

struct Emitter {
    vec2 center;               // 0..1 in the picture
    vec2 velocity;             // of the fluid that it emits
    vec3 color;                // linear RGB
};

// Emitter 0 is at the left, 1 at the right. They rise and sink, and turn their jets, slowly and not in step.
Emitter fluid_emitter(int i) {
    float side = i == 0 ? 1.0 : -1.0;
    float phase = 0.9 * frame.time_s + (i == 0 ? 0.0 : 2.2);
    float turn = 0.6 * sin(1.7 * phase + 0.5);
    // The left emitter goes from orange to magenta and back, the right one from green to blue.
    float shade = 0.5 + 0.5 * sin(1.3 * phase);
    vec3 color = mix(vec3(1.0, 0.35, 0.05), vec3(0.9, 0.1, 0.5), shade);
    if (i == 1) color = mix(vec3(0.1, 0.8, 0.6), vec3(0.1, 0.3, 1.0), shade);
    return Emitter(vec2(0.5 - 0.43 * side, 0.5 + 0.3 * sin(phase)), fluid_speed * vec2(side * cos(turn), sin(turn)), color);
}

// Weight of a splat at `uv` around `center`, 1 in its middle. `radius`: of the picture's height.
float fluid_splat(vec2 uv, vec2 center, float radius) {
    vec2 offset = (uv - center) * vec2(FLUID_SIZE.x / FLUID_SIZE.y, 1.0) / radius;
    return exp(-dot(offset, offset));
}

#endif
