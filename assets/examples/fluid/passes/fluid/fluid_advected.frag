//@pass fluid_advected "Fluid: advection and forces" size=256x160 format=rg16f doc="Velocity after advection and forces, before it is made free of divergence"
#version 460
#include "pass.glsl"
#include "passes/fluid/fluid.glsl"

// Forces and self-advection (Stam 1999, "Stable Fluids", steps 1 and 2). A texel takes the velocity of the place where its fluid
// was one step before, so a step of any length is stable. Vorticity confinement (Fedkiw, Stam & Jensen 2001, "Visual Simulation of
// Smoke") gives back the small eddies that interpolation smooths away:
//
//   force = swirl (N x curl)      N = grad |curl| / |grad |curl||

uniform sampler2D before_fluid_velocity;
uniform sampler2D fluid_mouse;
uniform sampler2D depth;

vec2 velocity_at(ivec2 at) { return texelFetch(before_fluid_velocity, clamp(at, ivec2(0), ivec2(FLUID_SIZE) - 1), 0).xy; }

// Along z, 1/s.
float curl_at(ivec2 at) {
    float x = velocity_at(at + ivec2(1, 0)).y - velocity_at(at - ivec2(1, 0)).y;
    float y = velocity_at(at + ivec2(0, 1)).x - velocity_at(at - ivec2(0, 1)).x;
    return 0.5 * (x - y);
}

vec2 confinement(ivec2 at) {
    float x = abs(curl_at(at + ivec2(1, 0))) - abs(curl_at(at - ivec2(1, 0)));
    float y = abs(curl_at(at + ivec2(0, 1))) - abs(curl_at(at - ivec2(0, 1)));
    vec2 n = vec2(x, y) / max(length(vec2(x, y)), 1e-3);
    return fluid_swirl * curl_at(at) * vec2(n.y, -n.x);
}

void main() {
    color = vec4(0.0);
    // The model and the border of the picture hold the fluid still.
    vec2 to_border = min(gl_FragCoord.xy, FLUID_SIZE - gl_FragCoord.xy);
    if (min(to_border.x, to_border.y) < 1.0 || texture(depth, uv).r > 0.0) return;

    float step_s = fluid_step_s();
    ivec2 texel = ivec2(gl_FragCoord.xy);
    // The midpoint method: half a step back, then a whole one with the velocity there.
    vec2 middle = uv - 0.5 * step_s * velocity_at(texel) / FLUID_SIZE;
    vec2 back = uv - step_s * texture(before_fluid_velocity, middle).xy / FLUID_SIZE;
    vec2 velocity = texture(before_fluid_velocity, back).xy * exp(-0.15 * step_s) + step_s * confinement(texel);

    for (int i = 0; i < 2; ++i) {
        Emitter emitter = fluid_emitter(i);
        velocity = mix(velocity, emitter.velocity, fluid_splat(uv, emitter.center, 0.05) * min(12.0 * step_s, 1.0));
    }
    if (frame.mouse_px.z > 0.0) {
        vec2 mouse = texelFetch(fluid_mouse, ivec2(0), 0).xy * FLUID_SIZE / frame.viewport_px;
        float weight = fluid_splat(uv, frame.mouse_px.xy / frame.viewport_px, 0.06) * min(0.1 * length(mouse), 1.0);
        velocity = mix(velocity, mouse, weight);
    }
    // Confinement adds energy. The limit keeps it bounded, whatever the sliders say.
    color = vec4(clamp(velocity, -400.0, 400.0), 0.0, 0.0);
}
