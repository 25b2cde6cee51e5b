#version 460
#include "interface.glsl"
#include "common/jitter.glsl"
#include "lighting/shadows/ground.glsl"

// The triangle of the ground around the circle in which its shadow ends. Its circumscribed circle has twice the radius.

// World space, meters.
layout(location = 0) out vec3 position_ws;

void main() {
    float angle = radians(120.0 * float(gl_VertexIndex));
    vec2 corner = ground_width() * vec2(sin(angle), cos(angle));
    position_ws = vec3(frame.scene_center_ws.x + corner.x, ground_height(), frame.scene_center_ws.z + corner.y);
    gl_Position = frame.clip_from_world * vec4(position_ws, 1.0);
    gl_Position.xy += 2.0 * jitter_px() / frame.viewport_px * gl_Position.w;
    // A little farther away: a model that lies on the ground covers it.
    gl_Position.z *= 0.999;
    // From below there is no ground.
    if (frame.eye_ws.y <= ground_height()) gl_Position = vec4(0.0, 0.0, 0.0, 1.0);
}
