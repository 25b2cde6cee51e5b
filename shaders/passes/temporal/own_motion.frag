//@pass own_motion "Temporal antialiasing: motion of the model" draw=model when=TEMPORAL_ANTIALIASING doc="How far a pose has moved the surface since the frame before, 0..1 of the picture, with the camera's motion; a: 1 where it has moved"
#version 460
#include "interface.glsl"
#include "common/fragment.glsl"
#include "common/moved.glsl"
#include "material/opaque.glsl"

// Surfaces that a pose has moved, for temporal_mean.frag, which finds all others by their depth. `velocity` says the same of all surfaces,
// but draws their whole material.

layout(location = 0) in Fragment fragment;
layout(location = 0) out vec4 color;

void main() {
    discard_see_through(fragment);
    color = vec4(0.0);
    if ((draw.attributes & ATTRIBUTE_MOVED) == 0u) return;
    vec3 p = fragment.position_ws;
    vec4 now = frame.clip_from_world * vec4(p, 1.0);
    vec4 before = frame.clip_from_world_before * vec4(position_before_ws(p), 1.0);
    // Behind the camera, a point had no place in the picture.
    if (before.w > 0.0) color = vec4(0.5 * (now.xy / now.w - before.xy / before.w), 0.0, 1.0);
}
