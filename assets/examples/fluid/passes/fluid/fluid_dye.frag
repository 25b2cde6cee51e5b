//@pass fluid_dye "Fluid: dye" size=512x320 format=rgba16f keep doc="Dye that the fluid carries, linear RGB"
#version 460
#include "pass.glsl"
#include "passes/fluid/fluid.glsl"

// The fluid carries dye as it carries its own velocity: semi-Lagrangian advection (Stam 1999). Interpolation blurs the dye a
// little in each step; the image is finer than that of the velocity, so that less of this shows.

uniform sampler2D before_fluid_dye;
uniform sampler2D fluid_velocity;

void main() {
    float step_s = fluid_step_s();
    vec2 middle = uv - 0.5 * step_s * texture(fluid_velocity, uv).xy / FLUID_SIZE;
    vec2 back = uv - step_s * texture(fluid_velocity, middle).xy / FLUID_SIZE;
    vec3 dye = texture(before_fluid_dye, back).rgb * pow(max(1.0 - fluid_fade, 1e-3), step_s);
    for (int i = 0; i < 2; ++i) {
        Emitter emitter = fluid_emitter(i);
        dye += step_s * 9.0 * emitter.color * fluid_splat(uv, emitter.center, 0.04);
    }
    if (frame.mouse_px.z > 0.0) {
        dye += step_s * 6.0 * vec3(1.0, 0.8, 0.4) * fluid_splat(uv, frame.mouse_px.xy / frame.viewport_px, 0.03);
    }
    color = vec4(min(dye, 8.0), 1.0);
}
