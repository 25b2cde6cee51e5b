//@pass occlusion "Ambient occlusion" size=1/2 format=r32f when=AMBIENT_OCCLUSION doc="Hidden part of the sky: 0 open, 1 hidden"
#version 460
#include "pass.glsl"
#include "common/math.glsl"
#include "lighting/shadows/occlusion_texel.glsl"

// Averages the 4 x 4 pattern of occlusion_raw.frag over the pixels of the same surface. Both images hold pack_occlusion().

uniform sampler2D occlusion_raw;

// Adds four pixels, as far as they are at the distance `radii`. x: sum of their hidden parts; y: their number.
void add(inout vec2 sum, vec4 texels, float radii) {
    vec4 error = abs(unpack_radii(texels) / radii - 1.0);
    vec4 weight = vec4(lessThan(error, vec4(0.02))) * vec4(notEqual(texels, vec4(0.0)));
    sum += vec2(dot(texels, weight), dot(weight, vec4(1.0)));
}

void main() {
    // A gather holds (0, 1), (1, 1), (1, 0), (0, 0), around a corner of four texels: y is the pixel itself.
    vec4 texels = textureGather(occlusion_raw, uv - 0.5 / pass.size_px);
    color = vec4(0.0);
    if (texels.y == 0.0) return;
    float radii = unpack_radii(texels).y;
    vec2 sum = vec2(0.0);
    add(sum, texels, radii);
    add(sum, textureGather(occlusion_raw, uv + vec2(1.5, -0.5) / pass.size_px), radii);
    add(sum, textureGather(occlusion_raw, uv + vec2(-0.5, 1.5) / pass.size_px), radii);
    add(sum, textureGather(occlusion_raw, uv + 1.5 / pass.size_px), radii);
    // The pixel itself always counts, so the number is never 0.
    color.r = pack_occlusion(saturate(sum.x / sum.y), radii);
}
