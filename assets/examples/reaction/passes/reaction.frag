//@pass reaction "Reaction and diffusion" size=256x256 format=rg32f keep doc="Two chemicals that spread and react"
#version 460
#include "pass.glsl"

// The Gray-Scott model (Pearson 1993, "Complex Patterns in a Simple System", Science 261): u feeds the reaction u + 2 v -> 3 v,
// v dies. One step of Euler's method in each frame, with the nine-point stencil of the Laplacian.
//
//   du = 0.256 laplacian(u) - u v^2 + feed (1 - u)        dv = 0.128 laplacian(v) + u v^2 - (feed + kill) v
//
// Pearson's rates are 0.16 and 0.08 for his grid; 1.6 of them let the pattern grow in a minute, and the step is still stable.

uniform sampler2D before_reaction;

uniform Reaction {
    float reaction_feed;       //@ui "Feed" 0.01..0.1 = 0.037
    float reaction_kill;       //@ui "Kill" 0.03..0.07 = 0.06
};

vec2 at(ivec2 texel) {
    ivec2 size = textureSize(before_reaction, 0);
    return texelFetch(before_reaction, (texel + size) % size, 0).rg;
}

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    vec2 here = at(texel);
    if (frame.frame_index == 0u) {
        // Full of u, with a square of v.
        float seed = all(lessThan(abs(uv - 0.5), vec2(0.04))) ? 1.0 : 0.0;
        color = vec4(1.0 - 0.5 * seed, 0.25 * seed, 0.0, 0.0);
        return;
    }
    vec2 sum = -3.0 * here;
    for (int i = -1; i <= 1; i += 2) {
        sum += 0.5 * (at(texel + ivec2(i, 0)) + at(texel + ivec2(0, i)));
        sum += 0.25 * (at(texel + ivec2(i, i)) + at(texel + ivec2(i, -i)));
    }
    float reacts = here.x * here.y * here.y;
    vec2 change = vec2(0.16, 0.08) * 1.6 * sum + vec2(-reacts, reacts);
    change += vec2(reaction_feed * (1.0 - here.x), -(reaction_feed + reaction_kill) * here.y);
    color = vec4(clamp(here + change, 0.0, 1.0), 0.0, 0.0);
}
