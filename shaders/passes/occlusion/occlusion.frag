//@pass occlusion "Ambient occlusion" size=1/2 format=rg32f when=AMBIENT_OCCLUSION doc="Hidden part of the sky: 0 open, 1 hidden"
#version 460
#include "pass.glsl"
#include "common/math.glsl"

// Averages the 4 x 4 pattern of occlusion_raw.frag over the pixels of the same surface. r: hidden part; g: distance.

uniform sampler2D occlusion_raw;

void main() {
    vec2 here = texelFetch(occlusion_raw, ivec2(gl_FragCoord.xy), 0).rg;
    color = vec4(here, 0.0, 0.0);
    if (here.g <= 0.0) return;
    vec2 sum = vec2(0.0);
    // Pixels without a surface take no round, which a software device would compute all the same.
    int corners = here.g > 0.0 ? 4 : 0;
    for (int i = 0; i < corners; ++i) {
        vec2 corner = uv + (vec2(2 * (i & 1), 2 * (i >> 1)) - 0.5) / pass.size_px;
        vec4 hidden = textureGather(occlusion_raw, corner, 0);
        vec4 apart = abs(textureGather(occlusion_raw, corner, 1) / here.g - 1.0);
        vec4 weight = vec4(lessThan(apart, vec4(0.02)));
        sum += vec2(dot(hidden, weight), dot(weight, vec4(1.0)));
    }
    color.r = saturate(sum.y > 0.0 ? sum.x / sum.y : here.r);
}
