// Include this in a pass whose shader has Shadertoy's form: `void mainImage(out vec4 fragColor, in vec2 fragCoord)`.
// Specula's picture has its origin in the upper left corner; fragCoord and iMouse have it in the lower left, as there.
#ifndef TOY_GLSL
#define TOY_GLSL

#include "pass.glsl"

#define iResolution vec3(pass.size_px, 1.0)
#define iTime (frame.time_s)
#define iTimeDelta (frame.delta_s)
#define iFrameRate (1.0 / max(frame.delta_s, 1e-6))
#define iFrame (int(frame.frame_index))
#define iMouse toy_mouse()

// xy: last place of the mouse while it was down; zw: where it went down, z negative once it is up.
vec4 toy_mouse() {
    vec4 mouse = frame.mouse_px;
    return vec4(mouse.x, frame.viewport_px.y - mouse.y, mouse.z, frame.viewport_px.y - mouse.w);
}

// `specula check` compiles this file alone, in a stage that has its own main and no mainImage.
#ifndef LIBRARY_ALONE
void mainImage(out vec4 fragColor, in vec2 fragCoord);

void main() {
    vec4 shown = vec4(0.0, 0.0, 0.0, 1.0);
    mainImage(shown, vec2(gl_FragCoord.x, pass.size_px.y - gl_FragCoord.y));
    color = vec4(shown.rgb, 1.0);
}
#endif

#endif
