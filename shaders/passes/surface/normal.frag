//@pass normal "Surface: normal" draw=model also=velocity:rg16f,base_color,roughness_metallic:rg16f doc="Shading normal of the nearest surface, world space, unit"
#version 460
#include "interface.glsl"
#include "common/fragment.glsl"
#include "common/math.glsl"
#include "common/moved.glsl"
#include "material/material.glsl"
#include "material/user_surface.glsl"

// The model's surface at each pixel, for passes that read these images by name. Nothing is drawn unless one does.
//
// Limits: one sample a pixel. The velocity knows the camera and the pose; a surface that user_vertex moves counts as still.
// Blended and transmissive surfaces hide what lies behind them.

layout(location = 0) in Fragment fragment;
layout(location = 0) out vec4 color;              // `normal`; a: 1, or 0 where there is nothing
layout(location = 1) out vec4 velocity;           // rg: from the place one frame ago to the place now, 0..1 of the picture
layout(location = 2) out vec4 base_color;         // linear RGB; a: coverage
layout(location = 3) out vec4 roughness_metallic; // r: perceptual roughness; g: 0 dielectric .. 1 metal

// The place of a point in a picture, 0..1 from the upper left corner.
vec2 place_in_picture(mat4 clip_from_world, vec3 position_ws) {
    vec4 clip = clip_from_world * vec4(position_ws, 1.0);
    return 0.5 + 0.5 * clip.xy / clip.w;
}

void main() {
    vec3 v = safe_normalize(fragment.to_eye_ws, vec3(0.0, 0.0, 1.0));
    Surface s = make_surface(fragment, v);
    apply_user_surface(s, fragment, v);
    if (ALPHA_MODE == ALPHA_MASK && s.coverage < material.alpha_cutoff) discard;
    color = vec4(s.n, 1.0);
    vec3 p = fragment.position_ws, p_before = position_before_ws(p);
    // Behind the camera of the frame before, a point had no place in the picture.
    float before_w = (frame.clip_from_world_before * vec4(p_before, 1.0)).w;
    vec2 moved = before_w <= 0.0
        ? vec2(0.0) : place_in_picture(frame.clip_from_world, p) - place_in_picture(frame.clip_from_world_before, p_before);
    velocity = vec4(moved, 0.0, 0.0);
    base_color = vec4(s.base_color, s.coverage);
    roughness_metallic = vec4(s.roughness, s.metallic, 0.0, 0.0);
}
