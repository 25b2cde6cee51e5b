//@pass bloom_light "Bloom: light" size=1/4 mips when=BLOOM doc="Exposed light at a quarter of the size, and its mip levels"
#version 460
#include "pass.glsl"
#include "common/color.glsl"

// The light that bloom.frag and bloom_wide.frag blur. Its mip levels are ever wider means.

uniform sampler2D picture;

// Sixteen pixels make one. Weighted by 1 / (1 + luminance), a single very bright pixel does not flicker as a square
// (Karis 2013, "Real Shading in Unreal Engine 4", tone-mapped average). The price is light: one pixel of 1000 among
// fifteen black ones gives 0.33 instead of the mean of 62.5.
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
