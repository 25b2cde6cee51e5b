//@pass fur_over "Fur: over the picture" to=picture doc="The fur hides what lies under it"
#version 460
#include "pass.glsl"

uniform sampler2D picture;
uniform sampler2D fur;

void main() {
    vec4 scene = texelFetch(picture, ivec2(gl_FragCoord.xy), 0);
    vec4 over = texelFetch(fur, ivec2(gl_FragCoord.xy), 0);
    color = over.a > 0.0 ? over : scene;
}
