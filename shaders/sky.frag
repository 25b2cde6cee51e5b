#version 460
#include "interface.glsl"
#include "common/pixel.glsl"
#include "lighting/environment.glsl"

// The environment behind the model. Scene-referred linear RGB, opaque.

layout(location = 0) out vec4 out_color;

// From the eye through the pixel. A point at infinity has w = 0, and its coordinates are the direction; for a far plane
// at a distance w is above 0, and the eye is subtracted as often.
vec3 direction_ws() {
    vec2 clip = gl_FragCoord.xy / frame.viewport_px * 2.0 - 1.0;
    vec4 far = frame.world_from_clip * vec4(clip, 0.0, 1.0);
    return far.xyz - far.w * frame.eye_ws;
}

void main() {
    out_color = hdr_pixel(background_radiance(direction_ws()), 1.0, false);
}
