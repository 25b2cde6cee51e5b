// The ground: a horizontal plane through the lowest point of the model.
#ifndef LIGHTING_GROUND_GLSL
#define LIGHTING_GROUND_GLSL

#include "interface.glsl"

// Height of the ground, world space, meters.
float ground_height() { return frame.scene_min_ws.y; }

// Side of the square that has images of its own, meters.
float ground_width() { return 4.0 * frame.scene_radius; }

// Place in these images, 0..1 within the square. Seen from below: -z is down, so that front faces stay front faces.
vec2 ground_uv(vec3 position_ws) {
    vec2 offset = position_ws.xz - frame.scene_center_ws.xz;
    return 0.5 + vec2(offset.x, -offset.y) / ground_width();
}

// The point of the ground at this place, world space, meters.
vec3 ground_position(vec2 uv) {
    vec2 offset = vec2(uv.x - 0.5, 0.5 - uv.y) * ground_width();
    return vec3(frame.scene_center_ws.x + offset.x, ground_height(), frame.scene_center_ws.z + offset.y);
}

#endif
