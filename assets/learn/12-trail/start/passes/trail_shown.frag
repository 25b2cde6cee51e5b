//@pass trail_shown "Trail" to=picture doc="The moving mean in place of the picture"
#version 460
#include "pass.glsl"

uniform sampler2D picture;
uniform sampler2D trail;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    color = vec4(texelFetch(trail, pixel, 0).rgb, texelFetch(picture, pixel, 0).a);
}
