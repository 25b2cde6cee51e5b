// For stages between the vertex stage and the rasterizer: where a point of the model is in the picture.
#ifndef COMMON_PLACE_GLSL
#define COMMON_PLACE_GLSL

#include "interface.glsl"
#include "common/fragment.glsl"
#include "common/jitter.glsl"

// The clip position of f.position_ws, as pbr.vert computes it. Sets f.to_eye_ws.
vec4 place(inout Fragment f) {
    f.to_eye_ws = frame.eye_ws - f.position_ws;
    vec4 clip = frame.clip_from_world * vec4(f.position_ws, 1.0);
    if (MODE == 0u) clip.xy += 2.0 * jitter_px() / frame.viewport_px * clip.w;
    return clip;
}

#endif
