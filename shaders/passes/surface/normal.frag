//@pass normal "Surface: normal" draw=model also=velocity:rg16f,base_color,roughness_metallic:rg16f doc="Shading normal of the nearest surface, world space; images beside it: velocity, base color, roughness and metallic"
#version 460
#include "interface.glsl"
#include "common/fragment.glsl"
#include "common/math.glsl"
#include "material/material.glsl"
#include "user.glsl"

// What the model is at each pixel, for passes that read these images by name. Nothing is drawn unless one does.
//
// color (`normal`): shading normal, world space, unit; a: 1. 0 where there is nothing.
// velocity: from the pixel's place one frame ago to its place now, 0..1 of the picture. It knows the camera; a surface that
// user_vertex moves counts as still.
// base_color: linear RGB; a: alpha. roughness_metallic: perceptual roughness, and 0 dielectric .. 1 metal.

layout(location = 0) in Fragment fragment;
layout(location = 0) out vec4 color;
layout(location = 1) out vec4 velocity;
layout(location = 2) out vec4 base_color;
layout(location = 3) out vec4 roughness_metallic;

// The place of a point in a picture, 0..1 from the upper left corner.
vec2 place_in_picture(mat4 clip_from_world, vec3 position_ws) {
    vec4 clip = clip_from_world * vec4(position_ws, 1.0);
    return 0.5 + 0.5 * clip.xy / clip.w;
}

void main() {
    vec3 v = safe_normalize(fragment.to_eye_ws, vec3(0.0, 0.0, 1.0));
    Surface s = make_surface(fragment, v);
    user_surface(s);
    if (ALPHA_MODE == ALPHA_MASK && s.coverage < material.alpha_cutoff) discard;
    color = vec4(s.n, 1.0);
    vec3 p = fragment.position_ws;
    vec2 moved = place_in_picture(frame.clip_from_world, p) - place_in_picture(frame.clip_from_world_before, p);
    velocity = vec4(moved, 0.0, 0.0);
    base_color = vec4(s.base_color, s.coverage);
    roughness_metallic = vec4(s.roughness, s.metallic, 0.0, 0.0);
}
