//@pass last_depth "Depth of the last frame" format=r32f doc="Depth of the model, for passes that read before_depth"
#version 460
#include "pass.glsl"

// Keeps the depth for the next frame, in which passes read it as before_depth. Nothing is drawn unless one does.
//
// Limits: one sample a pixel, as `depth`.

uniform sampler2D depth;

void main() { color = vec4(texelFetch(depth, ivec2(gl_FragCoord.xy), 0).r, 0.0, 0.0, 1.0); }
