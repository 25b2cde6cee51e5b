//@pass light_views "Views of the lights" size=4x16 format=rgba32f when=SHADOWS doc="World to the clip space of each light, as user_light leaves the light: a row for each light, a pixel for each column of the matrix"
#version 460
#include "pass.glsl"
#include "lighting/shadows/light_view.glsl"

// For passes/shadows/shadow_map.vert, which cannot call user_light itself: user.glsl may use what only fragment stages have.

void main() {
    uint light = uint(gl_FragCoord.y);
    color = light_view(light, shadow_light(light))[int(gl_FragCoord.x)];
}
