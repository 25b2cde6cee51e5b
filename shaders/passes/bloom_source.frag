//@pass bloom_source "Bloom: light" size=1/2 mips doc="Exposed light at half size, and its mip levels"
#version 460
#include "pass.glsl"
#include "common/color.glsl"

// The source of the blurs in bloom.frag: exposed light. Each mip level is a wider blur than the one before.

uniform sampler2D picture;

// Averages four pixels. The weight 1 / (1 + luminance) keeps a single very bright pixel from flickering as a square
// (Karis 2013, "Real Shading in Unreal Engine 4", tone-mapped average).
void main() {
    vec2 texel = 0.5 / pass.size_px;
    vec3 sum = vec3(0.0);
    float weights = 0.0;
    for (int i = 0; i < 4; ++i) {
        vec2 offset = vec2(i & 1, i >> 1) - 0.5;
        vec3 light = texture(picture, uv + offset * texel).rgb * frame.exposure;
        float weight = 1.0 / (1.0 + luminance(light));
        sum += weight * light;
        weights += weight;
    }
    color = vec4(sum / weights, 1.0);
}
