//@pass background "Background" draw=background to=picture doc="The environment where the model does not cover it"
#version 460
#include "interface.glsl"
#include "common/pixel.glsl"
#include "common/picture_px.glsl"
#include "lighting/environment.glsl"
#include "user/background.glsl"

// Draws the environment behind the model: scene-referred linear RGB, opaque.

layout(location = 0) out vec4 out_color;

// The direction from the eye through the pixel, not normalized. With an infinite far plane the unprojected point has
// w = 0, and its xyz is the direction. With a finite one w > 0, and xyz - w eye is the direction.
vec3 direction_ws() {
    vec2 clip = picture_px() / frame.viewport_px * 2.0 - 1.0;
    vec4 far = frame.world_from_clip * vec4(clip, 0.0, 1.0);
    return far.xyz - far.w * frame.eye_ws;
}

void main() {
    vec3 direction = direction_ws();
    vec3 radiance = user_background(normalize(direction), background_radiance(direction));
    out_color = hdr_pixel(radiance, 1.0, false);
}
