//@pass occlusion "Ambient occlusion" size=1/2 format=r32f when=AMBIENT_OCCLUSION doc="Hidden part of the sky: 0 open, 1 hidden"
#version 460
#include "pass.glsl"
#include "common/math.glsl"
#include "lighting/shadows/occlusion_texel.glsl"

// Averages the 4 x 4 pattern of occlusion_raw.frag over the pixels of the same surface. Both images hold occlusion_texel.

uniform sampler2D occlusion_raw;

// Adds the four pixels around a corner as far as they are at about the distance `here`. x: sum of the hidden parts; y: number.
void add(inout vec2 sum, vec4 hidden, float here) {
    vec4 apart = abs(occlusion_distances(hidden) / here - 1.0);
    vec4 weight = vec4(lessThan(apart, vec4(0.02)));
    sum += vec2(dot(hidden, weight), dot(weight, vec4(1.0)));
}

void main() {
    // A gather holds (0, 1), (1, 1), (1, 0), (0, 0), around a corner of four texels: y is the pixel itself.
    vec4 hidden = textureGather(occlusion_raw, uv - 0.5 / pass.size_px);
    color = vec4(0.0);
    if (hidden.y == 0.0) return;
    float here = occlusion_distances(hidden).y;
    vec2 sum = vec2(0.0);
    add(sum, hidden, here);
    add(sum, textureGather(occlusion_raw, uv + vec2(1.5, -0.5) / pass.size_px), here);
    add(sum, textureGather(occlusion_raw, uv + vec2(-0.5, 1.5) / pass.size_px), here);
    add(sum, textureGather(occlusion_raw, uv + 1.5 / pass.size_px), here);
    // The pixel itself always counts.
    color.r = occlusion_texel(saturate(sum.x / sum.y), here * frame.scene_radius);
}
