//@pass trail "Trail: mean" doc="The moving mean of the last pictures"
#version 460
#include "pass.glsl"

uniform sampler2D picture;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec3 newest = texelFetch(picture, pixel, 0).rgb;
    color = vec4(newest, 1.0);
}
