//@pass last_picture "Picture of the last frame" doc="The picture before the tone map, for passes that read before_picture"
#version 460
#include "pass.glsl"

// Keeps the picture for the next frame, in which passes read it as before_picture. Nothing is drawn unless one does.
//
// Limits: the picture before the tone map only; a pass after it can keep the displayed one in the same way.

uniform sampler2D picture;

void main() { color = texelFetch(picture, ivec2(gl_FragCoord.xy), 0); }
