//@pass fluid_mouse "Fluid: mouse" size=1x1 format=rgba32f keep doc="Velocity of the mouse in pixels per second, and its last place"
#version 460
#include "pass.glsl"

// rg: velocity of the mouse, pixels per second. b: its last x, 0 while it is up. a: its last y.

uniform sampler2D before_fluid_mouse;

void main() {
    vec4 before = texelFetch(before_fluid_mouse, ivec2(0), 0);
    bool is_down = frame.mouse_px.z > 0.0;
    bool moves = is_down && before.b > 0.0 && frame.delta_s > 0.0;
    vec2 velocity = moves ? (frame.mouse_px.xy - before.ba) / max(frame.delta_s, 1e-3) : vec2(0.0);
    color = vec4(velocity, is_down ? frame.mouse_px.xy : vec2(0.0));
}
