//@pass particles "Particles" draw=quads instances=16384 to=picture blend doc="Glowing particles around the model"
#version 460
#include "interface.glsl"

// A round glow. Alpha is coverage: it hides what lies behind as far as the glow is bright, and shows where there is no background.

layout(location = 0) in vec2 corner;
layout(location = 1) in flat float age;
layout(location = 0) out vec4 color;

uniform ParticlesColor {
    vec3 particles_young;      //@ui "Young" color = 1 0.3 0.04
    vec3 particles_old;        //@ui "Old" color = 0.06 0.2 1
    float particles_glow;      //@ui "Glow" 0..10 doc="Brightness at the middle; 1 is white" = 1.4
};

void main() {
    float fade = smoothstep(0.0, 0.1, age) * (1.0 - smoothstep(0.6, 1.0, age));
    // A Gaussian of which e^-4 is left at the edge.
    float glow = exp(-4.0 * dot(corner, corner)) * fade * particles_glow;
    color = vec4(mix(particles_young, particles_old, age) * glow / frame.exposure, min(glow, 1.0));
}
