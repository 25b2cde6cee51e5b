//@pass lens "Lens" to=picture doc="Darker corners, by the cos^4 law"
#version 460
#include "pass.glsl"

uniform sampler2D picture;

// E = E0 cos^4(theta), with tan(theta) from 0 in the middle of the picture to 1 in its corners.
void main() {
    vec4 scene = texelFetch(picture, ivec2(gl_FragCoord.xy), 0);
    color = scene;
}
