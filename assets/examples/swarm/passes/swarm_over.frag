//@pass swarm_over "Swarm: in the picture" to=picture doc="What is nearer: the swarm or the model"
#version 460
#include "pass.glsl"

uniform sampler2D picture;
uniform sampler2D depth;
uniform sampler2D swarm;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec4 copy = texelFetch(swarm, at, 0);
    // Depth is reversed: the greater is the nearer, and 0 is nothing.
    bool is_nearer = copy.a > 0.0 && copy.a >= texelFetch(depth, at, 0).r;
    color = is_nearer ? vec4(copy.rgb, 1.0) : texelFetch(picture, at, 0);
}
