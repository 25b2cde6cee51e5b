//@pass trail "Trail: mean" keep doc="The moving mean of the last pictures"
#version 460
#include "pass.glsl"

uniform sampler2D picture;
uniform sampler2D before_trail;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec3 newest = texelFetch(picture, pixel, 0).rgb;
    vec4 mean = texelFetch(before_trail, pixel, 0);
    color = vec4(mean.a == 0.0 ? newest : mix(mean.rgb, newest, 0.2), 1.0);
}
